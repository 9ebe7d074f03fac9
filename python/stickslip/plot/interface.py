"""Contact maps: what the nodes of an interface do, in its plane."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from stickslip.fe.surface import CORNERS
from stickslip.plot.figure import figure
from stickslip.plot.options import ContactMapOptions
from stickslip.plot.style import GREY, Prefixed, prefix_of, prefixed, unit_of
from stickslip.results.contact_map import ContactMap

_LABELS = {
    "pressure": "mean pressure [Pa]",
    "least_pressure": "least pressure [Pa]",
    "greatest_pressure": "greatest pressure [Pa]",
    "stick": "share of the period that sticks",
    "slip": "share of the period that slips",
    "open": "share of the period that is open",
    "work": "work per cycle and area [J/m²]",
}
_LARGE = 0.1
"""Area from which square metres are easier to read [m2]."""
_SHARES = ("stick", "slip", "open")


@figure
def contact_map(ax: Axes, /, result: ContactMap, **options: Unpack[ContactMapOptions]) -> None:
    """Draw a field of an interface over the plane that lies nearest to its nodes.

    A face has the mean of its nodes; nodes without a partner leave faces empty.
    """
    surface, name = result.interface.surface, options["field"]
    values = np.full(len(surface.labels), np.nan)
    values[result.interface.places] = result[name]
    places, directions = _in_plane(surface.points)
    corners = [faces[:, : CORNERS[faces.shape[1]]] for faces in surface.faces]
    shapes = [polygon for faces in corners for polygon in places[faces]]
    colours = np.concatenate([values[faces].mean(axis=1) for faces in surface.faces])
    drawn = PolyCollection(shapes, array=np.ma.masked_invalid(colours), cmap="viridis")
    if name in _SHARES:
        drawn.set_clim(0.0, 1.0)
    drawn.set(edgecolor=GREY, linewidth=0.2)
    ax.add_collection(drawn)
    bar = ax.figure.colorbar(drawn, ax=ax, label=_LABELS[name])
    unit = unit_of(_LABELS[name])
    if unit:
        scale = prefix_of(float(np.abs(drawn.get_clim()).max()), unit)
        bar.ax.yaxis.set_major_formatter(Prefixed(scale.factor))
        bar.set_label(_LABELS[name].replace(f"[{unit}]", f"[{scale.label}]"))
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set(xlabel=f"{directions[0]} [m]", ylabel=f"{directions[1]} [m]")
    areas = f"slips {_area(result.slip_area)}, open {_area(result.open_area)}"
    ax.set_title(f"{areas}, {prefixed(result.work, 'J')}", fontsize="medium")


def _area(area: float) -> str:
    """Return an area with its unit; a prefix counts twice in it."""
    return f"{area:.3g} m²" if area >= _LARGE else f"{1e6 * area:.3g} mm²"


def _in_plane(
    points: NDArray[np.float64],
) -> tuple[NDArray[np.float64], tuple[str, str]]:
    """Return coordinates in the plane, those of the axes where it is normal to one, and names."""
    middle = points.mean(axis=0)
    _, _, ways = np.linalg.svd(points - middle, full_matrices=False)
    normal = np.abs(ways[2])
    across = int(normal.argmax())
    if normal[across] > 1.0 - 1e-6:
        kept = [way for way in range(3) if way != across]
        return points[:, kept], ("xyz"[kept[0]], "xyz"[kept[1]])
    return (points - middle) @ ways[:2].T, ("length", "width")

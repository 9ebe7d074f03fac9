"""Dampers as they were modelled: bodies, faces, contact points and loads."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from stickslip.damper import Damper, RigidBody
from stickslip.damper.damper import LEFT, RIGHT, Face
from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Drawing
from stickslip.results.fields import Float

_BELOW = 1.1
"""Depth of a body below its faces, over its size."""


@figure
def damper_drawing(ax: Axes, /, damper: Damper, **options: Unpack[Drawing]) -> None:
    """Draw the bodies of a damper in a plane, with contact points, normals and loads.

    Where a body has no positions its contact points stand where its faces look; the size is then
    no measure. Neighbours are hatched.

    Parameters
    ----------
    damper : Damper
        The damper.
    """
    if any(body.axes != 2 for body in damper.bodies.values()):
        raise ModelError("damper_drawing: a damper in space; only those in a plane are drawn")
    size, measured = _size(damper)
    shifts = _shifts(damper, size)
    corners: dict[str, list[Float]] = {name: [] for name in damper.bodies}
    for face in damper.faces:
        ends = _face(ax, face, shifts, size)
        corners[face.body] += ends
        if face.to in corners:
            corners[face.to] += ends
    for name, body in damper.bodies.items():
        hull = _hull([*corners[name], shifts[name] - [0.0, _BELOW * size]])
        ax.add_patch(Polygon(hull, fc="0.9", ec=style.GREY, zorder=0))
        forces = list(body.forces.values()) if isinstance(body, RigidBody) else []
        if any(forces):
            load = np.array(forces[:2])
            start = shifts[name]
            tip = start + 0.7 * size * load / np.linalg.norm(load)
            shape = {"arrowstyle": "-|>", "color": style.ORANGE}
            ax.annotate("", _at(tip), _at(start), arrowprops=shape)
            said = f"{np.linalg.norm(load):.4g} N"
            middle = _at(0.5 * (tip + start))
            ax.annotate(said, middle, (5, 0), textcoords="offset points", color=style.ORANGE)
            ax.plot(*start, "+", color=style.ORANGE)
        mass = f"\n{body.mass:.3g} kg" if isinstance(body, RigidBody) else ""
        place = _at(shifts[name] - [0.0, 0.4 * size])
        ax.annotate(f"{style.named(name)}{mass}", place, ha="center", va="center")
    ax.set_aspect("equal")
    ax.margins(0.3, 0.15)  # what stands beside a face counts in no limit
    if measured:
        ax.set(xlabel="x [m]", ylabel="y [m]")
    else:
        ax.set(xlabel="x", ylabel="y", xticks=[], yticks=[])


def _size(damper: Damper) -> tuple[float, bool]:
    """Return the size of a damper, and whether it is one."""
    places = [
        np.linalg.norm(point.position)
        for face in damper.faces
        for point in face.points
        if point.position is not None
    ]
    largest = float(max(places, default=0.0))
    return (largest, True) if largest else (1.0, False)


def _shifts(damper: Damper, size: float) -> dict[str, Float]:
    """Return where the bodies stand: side by side."""
    count = len(damper.bodies)
    return {
        name: np.array([(place - 0.5 * (count - 1)) * 1.6 * size, 0.0])
        for place, name in enumerate(damper.bodies)
    }


def _face(ax: Axes, face: Face, shifts: dict[str, Float], size: float) -> list[Float]:
    """Draw a face; return its ends."""
    places = []
    for point in face.points:
        normal = np.array(point.normal) / np.linalg.norm(point.normal)
        place = normal * 0.8 * size if point.position is None else np.array(point.position)
        places.append((shifts[face.body] + place, normal))
    normal = places[0][1]
    along = np.array([normal[1], -normal[0]])
    listed = sorted((place for place, _ in places), key=lambda one: float(one @ along))
    ends = [listed[0] - 0.45 * size * along, listed[-1] + 0.45 * size * along]
    sides = {LEFT: style.BLUE, RIGHT: "#35b779"}
    colour = sides.get(face.to, style.GREY)
    ax.plot(*np.array(ends).T, color=colour, lw=2.0)
    if face.to in (LEFT, RIGHT):
        block = [*ends, *(end + 0.3 * size * normal for end in reversed(ends))]
        ax.add_patch(Polygon(np.array(block), fc="none", ec=colour, hatch="///", lw=0.0, zorder=0))
    for place, own in places:
        ax.plot(*place, "o", color=colour, ms=5)
        shape = {"arrowstyle": "->", "color": colour}
        ax.annotate("", _at(place + 0.35 * size * own), _at(place), arrowprops=shape)
    name = face.name or face.to
    label = places[len(places) // 2][0] + 0.6 * size * normal
    if face.to not in sides:  # between two bodies: above them
        label = ends[0] + np.array([0.0, 0.9 * size])
    said = f"{style.named(name)}, µ = {face.friction:g}"
    ax.annotate(said, _at(label), ha="center", va="center", color=colour)
    return ends


def _at(place: Float) -> tuple[float, float]:
    x, y = place.tolist()
    return x, y


def _hull(points: list[Float]) -> Float:
    """Return the convex hull of points, in order."""
    from scipy.spatial import ConvexHull, QhullError

    listed = np.array(points)
    try:
        return listed[ConvexHull(listed).vertices]
    except QhullError:
        return listed

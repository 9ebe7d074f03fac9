"""Natural frequencies with contact points slipping: of one set of them, and of every set."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import members
from stickslip.errors import ModelError
from stickslip.model.model import Model, PointRef, from_core, require_model

_MOST = 12
"""Points whose sets, 4096 of them, are still a table."""
_SHOWN = 6


def natural_frequencies(
    model: Model, slipping: Iterable[PointRef] = (), *, nodal_diameter: int | None = None
) -> NDArray[np.float64]:
    """Natural frequencies with some contact points slipping and all others stuck.

    Parameters
    ----------
    model : Model
        Its forces and damping play no part.
    slipping : iterable of int, str or (int or str, int), optional
        The contact points that slip: contact, or (contact, point). Default: all stick.
    nodal_diameter : int, optional
        Nodal diameter of a `BladedDisk`, 0 to n-1. Default: the one its engine order excites.

    Returns
    -------
    ndarray of float64, shape (N,)
        Angular frequencies in ascending order [rad/s].

    Raises
    ------
    ModelError
        If `model` is no `Model`; if there is no such contact, point or nodal diameter.
    """
    require_model(model)
    refs = members(slipping, "slipping", "slipping=[...]")
    points = sorted({model.point(ref) for ref in refs})
    return from_core(model.frequencies, points, nodal_diameter)


@dataclass(frozen=True, eq=False, repr=False)
class SlipConfigurations(Mapping[tuple[tuple[str, int], ...], NDArray[np.float64]]):
    """Natural frequencies by the set of contact points that slip; printed, a table."""

    frequencies: Mapping[tuple[tuple[str, int], ...], NDArray[np.float64]]
    """From sets ((contact, point), ...) to angular frequencies [rad/s], shape (N,)."""

    def __getitem__(self, slipping: tuple[tuple[str, int], ...]) -> NDArray[np.float64]:
        return self.frequencies[slipping]

    def __iter__(self) -> Iterator[tuple[tuple[str, int], ...]]:
        return iter(self.frequencies)

    def __len__(self) -> int:
        return len(self.frequencies)

    def __str__(self) -> str:
        names = {
            slipping: ", ".join(f"{contact}[{point}]" for contact, point in slipping) or "none"
            for slipping in self
        }
        width = max(len("slipping"), *map(len, names.values()))
        lines = [f"{'slipping':<{width}}  natural frequencies [rad/s]"]
        for slipping, omega in self.items():
            shown = "  ".join(f"{value:10.4f}" for value in omega[:_SHOWN])
            lines.append(f"{names[slipping]:<{width}}  {shown}{' ...' * (omega.size > _SHOWN)}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"SlipConfigurations({len(self)} sets)"


def every_point(model: Model, *, finite: bool = False) -> list[tuple[int, int]]:
    """Return all contact points as positions, see `Model.point`; or those of finite slip limit."""
    return [
        (number, point)
        for number, contact in enumerate(model.contacts)
        for point in range(contact.points)
        if not finite or np.isfinite(contact.limits[point])
    ]


def slip_configurations(
    model: Model, points: Iterable[PointRef] | None = None, *, nodal_diameter: int | None = None
) -> SlipConfigurations:
    """Natural frequencies with every set of contact points slipping, all others stuck.

    Parameters
    ----------
    model : Model
        Its forces and damping play no part.
    points : iterable of int, str or (int or str, int), optional
        The points that may slip. Default: all of finite slip limit.
    nodal_diameter : int, optional
        As of `natural_frequencies`.

    Returns
    -------
    SlipConfigurations
        By set, the smallest sets first.

    Raises
    ------
    ModelError
        If there is no such point, or more than 12 may slip.

    References
    ----------
    Guillen (1999), Table 6.4, whose slipping contacts are deleted instead of condensed.
    """
    require_model(model)
    if points is None:
        chosen = every_point(model, finite=True)
    else:
        chosen = sorted({model.point(ref) for ref in points})
    if len(chosen) > _MOST:
        raise ModelError(
            f"points: {len(chosen)} may slip, in {2 ** len(chosen)} sets; name at most {_MOST} of "
            "them, points=[...]"
        )
    names = model.contact_names
    table = {
        tuple((names[number], point) for number, point in slipping): natural_frequencies(
            model, slipping, nodal_diameter=nodal_diameter
        )
        for size in range(len(chosen) + 1)
        for slipping in combinations(chosen, size)
    }
    return SlipConfigurations(MappingProxyType(table))

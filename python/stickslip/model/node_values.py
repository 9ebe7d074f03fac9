"""Numbers of contact nodes: one for all of them, or one for each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.units import physical_number

Each: TypeAlias = float | tuple[float, ...]
"""One number for all nodes, or one per node."""


def number_of_each(
    value: object, unit: str, shape: tuple[int, ...], entry: str, *, negative: bool
) -> Each:
    """Return the number of all nodes, or one per node."""
    if not (isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim)):
        return _number(value, unit, entry, negative=negative)
    listed = tuple(value)
    if len(shape) == 1 or len(listed) != shape[0]:
        nodes = "one node" if len(shape) == 1 else f"{shape[0]} nodes"
        expected = "one number" if len(shape) == 1 else "one number, or one per node"
        raise ModelError(f"{entry}: {len(listed)} numbers for {nodes}; give {expected}")
    return tuple(
        _number(one, unit, f"{entry}[{place}]", negative=negative)
        for place, one in enumerate(listed)
    )


def _number(value: object, unit: str, entry: str, *, negative: bool) -> float:
    number = physical_number(value, unit, entry)
    if number < 0.0 and not negative:
        raise ModelError(f"{entry} {number:g} is negative; give a number from zero, in SI units")
    return number


def times_areas(
    each: Mapping[str, Each | None], areas: object, shape: tuple[int, ...], entry: str
) -> dict[str, Each | None]:
    """Return numbers that are given per area, multiplied by the areas of the nodes."""
    if len(shape) == 1:
        raise ModelError(
            f"{entry}: areas {brief(areas)} of one node; give its stiffness in N/m, or a list of "
            "nodes"
        )
    sizes = np.asarray(number_of_each(areas, "m^2", shape, f"{entry}: areas", negative=False))
    return {
        key: None if one is None else tuple((sizes * np.asarray(one) * np.ones(shape[0])).tolist())
        for key, one in each.items()
    }

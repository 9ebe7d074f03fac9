"""What contact nodes have, one for all or one for each: normals with frames, and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np

from stickslip.checks import Matrix, brief
from stickslip.errors import ModelError
from stickslip.units import from_zero, physical_number

Vectors: TypeAlias = tuple[float, ...] | tuple[tuple[float, ...], ...]
"""One vector for all nodes, or one per node."""

_STEEP = 0.9
"""Component of the normal from which on the tangent is laid along the next axis."""


def unit_normals(value: object, shape: tuple[int, ...], entry: str) -> Vectors | None:
    """Return unit normals, one or one per node."""
    size = shape[-1]
    if value is None:
        if size > 2:
            raise ModelError(
                f"{entry}: no normal, a constant load, with 3 dofs per node; give the one or two "
                "tangential ones, or the normal"
            )
        return None
    try:
        vectors = np.array(value)
    except ValueError:
        vectors = np.array(None)
    fits = (size,) if len(shape) == 1 or vectors.ndim < 2 else shape
    if vectors.dtype.kind not in "fiu" or vectors.shape != fits or size == 1:
        many = "" if len(shape) == 1 else ", or one such list per node"
        raise ModelError(
            f"{entry}: normal: {brief(value)}; give {max(size, 2)} numbers, as many as a node has "
            f"dofs{many}, or leave it out for a constant load"
        )
    vectors = vectors.astype(np.float64)
    # Numbers far from 1 would overflow when squared.
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    if not (np.isfinite(largest) & (largest > 0.0)).all():
        raise ModelError(
            f"{entry}: normal: {brief(value)} has no direction; give a finite vector that is not "
            "zero"
        )
    length = np.linalg.norm(vectors / largest, axis=-1, keepdims=True) * largest
    # What has unit length already stays as it is, bit by bit.
    near = np.abs(length - 1.0) <= 4.0 * np.finfo(np.float64).eps
    unit = np.where(near, vectors, vectors / largest / (length / largest))
    if unit.ndim == 1:
        return tuple(unit.tolist())
    return tuple(map(tuple, unit.tolist()))


def frame_of(normal: Matrix | int) -> Matrix:
    """Return rows t1, t2, n of a unit normal, or t, n; the axes where there is none."""
    if isinstance(normal, int):
        return np.eye(normal)
    if normal.size == 2:
        return np.array([[normal[1], -normal[0]], normal])
    axis = np.eye(3)[int(abs(normal[0]) > _STEEP)]
    first = axis - (axis @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])


Each: TypeAlias = float | tuple[float, ...]
"""One number for all nodes, or one per node."""


def number_of_each(
    value: object, unit: str, shape: tuple[int, ...], entry: str, *, negative: bool
) -> Each:
    """Return the number of all nodes, or one per node."""
    number = physical_number if negative else from_zero
    if not (isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim)):
        return number(value, unit, entry)
    listed = tuple(value)
    if len(shape) == 1 or len(listed) != shape[0]:
        nodes = "one node" if len(shape) == 1 else f"{shape[0]} nodes"
        expected = "one number" if len(shape) == 1 else "one number, or one per node"
        raise ModelError(f"{entry}: {len(listed)} numbers for {nodes}; give {expected}")
    return tuple(number(one, unit, f"{entry}[{place}]") for place, one in enumerate(listed))


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

"""Units in which matrices come from finite elements: mass, length and time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief
from stickslip.errors import EntryError, ModelError
from stickslip.units import quantity

Units: TypeAlias = str | None
"""Mass, length and time, "t-mm-s"; None is SI."""

_PARTS = (("kg", "mass"), ("m", "length"), ("s", "time"))
_POWERS = {"mass": 0, "damping": 1, "stiffness": 2}
"""Of the time, by which the work of unit displacements is divided."""
_ROTATIONS = ("rx", "ry", "rz", "rotx", "roty", "rotz", "rotation")
_NUMBERED_ROTATIONS = ("4", "5", "6")
"""Directions of "node.direction"."""


@dataclass(frozen=True)
class MatrixUnits:
    """What one unit of mass, of length and of time is in SI."""

    mass: float
    length: float
    time: float

    @classmethod
    def of(cls, units: object) -> MatrixUnits:
        """Return the units that a text names: "t-mm-s" are tonne, millimetre and second."""
        parts = units.split("-") if isinstance(units, str) else []
        if len(parts) != len(_PARTS):
            raise ModelError(
                f'units: {brief(units)}; give mass, length and time, "t-mm-s" or "kg-m-s"'
            )
        try:
            sizes = [
                quantity(f"1 {part}", unit, "units")
                for part, (unit, _) in zip(parts, _PARTS, strict=True)
            ]
        except EntryError as error:
            raise ModelError(
                f"units: {brief(units)}: {error.said.removeprefix(' = ')}; write mass, length and "
                'time, "t-mm-s"'
            ) from None
        return cls(*sizes)

    def in_si(self, matrix: Any, kind: str, dofs: Iterable[str]) -> Any:
        """Return a mass, damping or stiffness matrix in SI units, dense or sparse.

        Rotations stay radians; modal coordinates count as displacements.
        """
        work = self.mass * self.length**2 / self.time ** _POWERS[kind]
        scale = [1.0 if is_rotation(dof) else 1.0 / self.length for dof in dofs]
        if len(scale) != max(matrix.shape):
            return matrix  # of another size, which is refused elsewhere
        if len(set(scale)) == 1:
            return work * scale[0] ** 2 * matrix
        if isinstance(matrix, np.ndarray):
            steps: NDArray[np.float64] = np.array(scale)
            return work * steps[:, None] * matrix * steps
        from scipy.sparse import diags_array

        steps_of = diags_array(np.array(scale))
        return work * (steps_of @ matrix @ steps_of)


def is_rotation(dof: str) -> bool:
    """Return whether a degree of freedom is an angle by its name: "12.4", "tip.rx"."""
    owner, _, way = dof.rpartition(".")
    return way.lower() in _ROTATIONS or (bool(owner) and way in _NUMBERED_ROTATIONS)

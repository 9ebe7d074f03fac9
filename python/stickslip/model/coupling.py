"""Linear springs between two degrees of freedom."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from stickslip.checks import Matrix, brief, require_keys, text
from stickslip.errors import ModelError
from stickslip.model.dofs import Dofs
from stickslip.units import from_zero


@dataclass(frozen=True)
class Coupling:
    """A linear spring, and a dashpot beside it, between two degrees of freedom.

    Of a `BladedDisk` it goes from each sector to the next one, the last to the first; of `join`
    from one part to another, or within a part.

    Parameters
    ----------
    dof : str
        Degree of freedom at one end; of a disk, of a sector.
    other : str, optional
        Degree of freedom at the other end; of a disk, of the next sector, by default the same.
    stiffness : float
        Stiffness [N/m].
    damping : float, optional
        Viscous damping [kg/s].

    Raises
    ------
    ModelError
        If stiffness or damping is negative or not a finite number.
    """

    dof: str
    other: str | None = None
    stiffness: float = field(kw_only=True)
    damping: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        text(self.dof, "coupling: dof")
        if self.other is not None:
            text(self.other, "coupling: other")
        for name, unit in (("stiffness", "N/m"), ("damping", "kg/s")):
            entry = f"coupling at {brief(self.dof)}: {name}"
            value = from_zero(getattr(self, name), unit, entry, f"{unit} above zero")
            object.__setattr__(self, name, value)

    @property
    def ends(self) -> tuple[str, str]:
        """Degrees of freedom of a sector and of the next one."""
        return self.dof, self.dof if self.other is None else self.other

    def blocks(self, dofs: Dofs) -> tuple[Matrix, Matrix]:
        """Return what a spring of unit stiffness adds to the matrices of a sector, twice (N, N).

        The first is what it adds to the sector itself, its ends at both sides; the second what
        couples the sector, by rows, to the next one, by columns.
        """
        start, end = (dofs.index(dof) for dof in self.ends)
        own, following = np.zeros((2, len(dofs), len(dofs)))
        own[start, start] += 1.0
        own[end, end] += 1.0
        following[start, end] -= 1.0
        return own, following

    def within(self, dofs: Dofs) -> Matrix:
        """Return what a spring of unit stiffness adds to the matrix of one structure, (N, N).

        Raises
        ------
        ModelError
            If a degree of freedom is unknown, or both ends are the same.
        """
        if self.other is None or self.other == self.dof:
            raise ModelError(
                f"both ends at dof {brief(self.dof)}; name the other end: "
                f"Coupling({brief(self.dof)}, other, stiffness=...)",
                study=f"both ends at dof {brief(self.dof)}; name the 'other' end",
            )
        own, following = self.blocks(dofs)
        return own + following + following.T

    def to_spec(self) -> dict[str, object]:
        """Return the coupling in plain values; see `coupling_from_spec`."""
        return asdict(self)


def coupling_from_spec(spec: Mapping[str, Any]) -> Coupling:
    """Build a coupling from the plain values of `Coupling.to_spec`."""
    known = ("dof", "other", "stiffness", "damping")
    require_keys(spec, "coupling", known, ("dof", "stiffness"))
    return Coupling(**spec)

"""Contacts of one point, between two degrees of freedom or one and the ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from stickslip.checks import Matrix, brief, text
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.dofs import Dofs


@dataclass(frozen=True)
class TwoEnds(Contact):
    """A contact of one point, between two degrees of freedom or one and the ground."""

    dof: str
    other: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        entry = f"{self.law} contact"
        text(self.dof, f"{entry}: dof")
        if self.other is not None:
            text(self.other, f"{entry}: other")
        if self.dof == self.other:
            raise ModelError(
                f"{entry}: both ends at dof {brief(self.dof)}; name another dof, or leave `other` "
                "out for the ground"
            )

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom it acts on, one (to ground) or two."""
        return (self.dof,) if self.other is None else (self.dof, self.other)

    @property
    def points(self) -> int:
        """Number of contact points: one."""
        return 1

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x, shape (1, N): +1 at `dof`, -1 at `other`; see `Contact.rows`."""
        rows = np.zeros((1, len(dofs)))
        rows[0, dofs.index(self.dof)] = 1.0
        if self.other is not None:
            rows[0, dofs.index(self.other)] = -1.0
        return rows

    @classmethod
    def _placed(cls, dofs: tuple[str | None, ...]) -> tuple[Any, ...]:
        if not 1 <= len(dofs) <= 2:
            raise ModelError(f"{cls.law} contact: {len(dofs)} dofs; give one (to ground) or two")
        return dofs

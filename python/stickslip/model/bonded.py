"""A contact that neither slips nor opens: what others are in the limit of small amplitudes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from stickslip.checks import Matrix
from stickslip.model.contact import Contact
from stickslip.model.dofs import Dofs


@dataclass(frozen=True, eq=False)
class Bonded(Contact):
    """Another contact with all that it holds without motion stuck for ever: a linear spring.

    Parameters
    ----------
    of : Contact
        The contact, whose displacements it has.
    held : ndarray of float64, shape (n_u, n_u)
        Its stiffness [N/m].
    """

    law: ClassVar[str] = "structural"

    of: Contact
    held: Matrix

    @property
    def dofs(self) -> tuple[str | None, ...]:
        """Names of the degrees of freedom it acts on."""
        return self.of.dofs

    @property
    def points(self) -> int:
        """Number of relative displacements."""
        return self.of.displacements

    @property
    def stuck_stiffness(self) -> Matrix:
        """Its stiffness [N/m], shape (n_u, n_u)."""
        return self.held

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of the contact; see `Contact.rows`."""
        return self.of.rows(dofs)

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return the stiffness, row by row [N/m], and that nothing slips."""
        limits = [np.inf] * self.points
        return [{"stiffness": self.held.ravel().tolist(), "slip_forces": limits}]

    def named(self, name: str) -> Self:
        """Return the contact with another name."""
        return replace(self, name=name)

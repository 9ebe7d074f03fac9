"""Degrees of freedom by their names."""

from __future__ import annotations

from collections.abc import Iterable

from stickslip.checks import unknown
from stickslip.errors import ModelError


class Dofs:
    """Names of the degrees of freedom of a structure, in the order of its matrices."""

    def __init__(self, names: Iterable[str]) -> None:
        self.dofs = tuple(names)

    def __len__(self) -> int:
        return len(self.dofs)

    def index(self, name: str) -> int:
        """Return the position of a degree of freedom, its row in the matrices."""
        try:
            return self.dofs.index(name)
        except ValueError:
            raise ModelError(unknown("dof", name, self.dofs)) from None

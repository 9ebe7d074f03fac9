"""Degrees of freedom by their names."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from stickslip.checks import unknown
from stickslip.errors import ModelError


class Dofs:
    """Names of the degrees of freedom of a structure, in the order of its matrices."""

    def __init__(self, names: Iterable[str]) -> None:
        self.dofs = tuple(names)

    def __len__(self) -> int:
        return len(self.dofs)

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: place for place, name in enumerate(self.dofs)}

    def index(self, name: str) -> int:
        """Return the position of a degree of freedom, its row in the matrices."""
        try:
            return self._places[name]
        except (KeyError, TypeError):
            raise ModelError(unknown("dof", name, self.dofs)) from None

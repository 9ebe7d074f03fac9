"""Names that tables of pandas give the rows and columns of matrices."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from stickslip.checks import as_list, brief
from stickslip.errors import ModelError

__all__ = ["names_of_tables"]


def names_of_tables(
    dofs: Iterable[str] | None, matrices: tuple[object, object, object]
) -> Iterable[str] | None:
    """Return the names of the dofs: those given, else those of the columns of tables.

    Rows and columns by the same names in another order, from table to table, or than `dofs` says,
    would put numbers at other dofs, and are refused.
    """
    known: tuple[Any, ...] | None = None
    if dofs is not None:
        given = as_list(dofs)
        if given is None:
            return dofs
        dofs = known = given
    for entry, matrix in zip(("mass", "stiffness", "damping"), matrices, strict=True):
        for axis in ("columns", "index"):
            names = _names(matrix, axis)
            if names is None:
                continue
            known = known or names
            if names != known and (dofs is None or set(names) == set(known)):
                raise ModelError(
                    f"{entry}: its {axis} are {brief(list(names))}, beside {brief(list(known))}; "
                    "give all matrices and dofs in one order, as table.loc[dofs, dofs]"
                )
    return dofs if dofs is not None else known


def _names(matrix: object, axis: str) -> tuple[str, ...] | None:
    """Return names of rows or columns; None if they are numbers, or there are none."""
    names = as_list(getattr(matrix, axis, None))
    return names if names and all(isinstance(one, str) for one in names) else None

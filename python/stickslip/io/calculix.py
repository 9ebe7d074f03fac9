"""Matrices of CalculiX, written by *FREQUENCY, SOLVER=MATRIXSTORAGE."""

from __future__ import annotations

import re
from pathlib import Path

from stickslip.checks import is_file
from stickslip.io.label import Labelled, counted, entry_table, square_matrix
from stickslip.io.source import read_text

__all__ = ["read_calculix", "read_calculix_dofs"]

_NAME = re.compile(r"[1-9][0-9]*\.[0-6]")


def read_calculix(path: Path) -> Labelled:
    """Read job.sti (stiffness) or job.mas (mass), with the names in job.dof beside it.

    Parameters
    ----------
    path : Path
        The file of entries.

    Returns
    -------
    Labelled
        The whole matrix; its rows are "node.direction", directions from 1.

    Raises
    ------
    ValueError
        With the reason, if the file or the one of the names is damaged or missing.

    References
    ----------
    Dhondt, "CalculiX CrunchiX User's Manual", keyword *FREQUENCY.
    """
    names = read_calculix_dofs(path.with_suffix(".dof"))
    table = entry_table(read_text(path), 3)
    rows, columns = counted(table[:, 0], "row") - 1, counted(table[:, 1], "column") - 1
    largest = int(max(rows.max(), columns.max())) + 1
    if largest != len(names):
        raise ValueError(f"{largest} rows, but {path.stem}.dof names {len(names)}")
    return Labelled(square_matrix(rows, columns, table[:, 2], len(names)), names)


def read_calculix_dofs(path: Path) -> tuple[str, ...]:
    """Read the names of the rows.

    Parameters
    ----------
    path : Path
        job.dof.

    Returns
    -------
    tuple of str
        "node.direction", one per row.

    Raises
    ------
    ValueError
        If the file is missing or damaged.
    """
    if not is_file(path):
        raise ValueError(f"{path.name} must lie beside it: it names the rows")
    text = read_text(path)
    names = tuple(text.split())
    wrong = next((name for name in names if not _NAME.fullmatch(name)), None)
    if wrong is not None or not text.endswith("\n") or not names:
        raise ValueError(f"{path.name} is damaged: node.direction expected, found {wrong!r}")
    if len(set(names)) < len(names):
        raise ValueError(f"{path.name} names a row twice")
    return names

"""Matrices of Abaqus as text, and of CalculiX: entries line by line, and substructures."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import is_file
from stickslip.io.entries import Labelled, Sparse, node_names, square_matrix, whole_matrix
from stickslip.io.numbers import counted, entry_table, real_field
from stickslip.io.source import Key, read_text

_MATRIX = re.compile(r"\*MATRIX,\s*TYPE\s*=\s*(\w+)", re.I).match
_NAME = re.compile(r"[1-9][0-9]*\.[0-6]")


def read_abaqus(path: Path, key: Key) -> Labelled:
    """Read a matrix of *MATRIX OUTPUT or *SUBSTRUCTURE MATRIX OUTPUT.

    A substructure has several, "stiffness" or "mass". FORMAT=COORDINATE does not name its rows;
    FORMAT=MATRIX INPUT does, and they come sorted by node and direction.

    References
    ----------
    Dassault Systemes, "Abaqus Analysis User's Guide", "Generating structural matrices" and
    "Defining substructures".
    """
    text = read_text(path, ended=True)
    lines = text.splitlines()
    starts = [(found[1].lower(), at) for at, line in enumerate(lines) if (found := _MATRIX(line))]
    if len(dict(starts)) < len(starts):
        raise ValueError("a matrix is given twice")
    if starts:
        return _substructure(lines, dict(starts), key.among(name for name, _ in starts))
    key.refuse()
    # Lines keep their numbers in the file.
    body = "\n".join("" if line.startswith("*") else line for line in lines)
    words = len(body.lstrip().partition("\n")[0].replace(",", " ").split())
    if not words:
        raise ValueError("the file holds no entries")
    heads = "".join(line.upper().replace(" ", "") for line in lines if line.startswith("*"))
    make = _whole if "TYPE=UNSYMMETRIC" in heads else square_matrix
    if words == 3:
        return Labelled(_of_places(body, make), None)
    if words == 5:
        return _of_nodes(entry_table(body, 5), make)
    raise ValueError(f"a line holds {words} numbers; 3 or 5 are known, and MatrixMarket files")


_Make: TypeAlias = Callable[[Any, Any, NDArray[np.float64], int], Sparse]
"""What makes a matrix of rows, columns, values and its size."""


def _whole(rows: Any, columns: Any, values: NDArray[np.float64], size: int) -> Sparse:
    """Return a matrix that is said not to be given by a triangle."""
    return whole_matrix((size, size), rows, columns, values, "general")


def _of_places(text: str, make: _Make = square_matrix) -> Sparse:
    """Return the matrix of lines of row, column, value."""
    table = entry_table(text, 3)
    rows, columns = counted(table[:, 0], "row") - 1, counted(table[:, 1], "column") - 1
    size = int(max(rows.max(), columns.max())) + 1
    return make(rows, columns, table[:, 2], size)


def _of_nodes(
    table: np.ndarray[tuple[int, int], np.dtype[np.float64]], make: _Make = square_matrix
) -> Labelled:
    """Return the matrix of lines of row node, direction, column node, direction, value."""
    # Abaqus numbers the internal nodes of its elements 0 and below.
    if (table[:, [0, 2]] < 1).any():
        raise ValueError("internal nodes (numbered 0 and below); write FORMAT=COORDINATE instead")
    labels = counted(table[:, :4].ravel(), "node or direction").reshape(-1, 2)
    names, place = np.unique(labels, axis=0, return_inverse=True)
    rows, columns = place.reshape(-1, 2).T
    matrix = make(rows, columns, table[:, 4], len(names))
    return Labelled(matrix, node_names(names[:, 0], names[:, 1]))


def _substructure(lines: list[str], starts: dict[str, int], key: str) -> Labelled:
    """Return the lower triangle by rows below *MATRIX, mirrored."""
    names = _retained(lines[: min(starts.values())])
    below = lines[starts[key] + 1 :]
    body = below[: next((at for at, line in enumerate(below) if line[:1] == "*"), len(below))]
    words = [word.strip() for line in body for word in line.rstrip().removesuffix(",").split(",")]
    values = np.array([real_field(word) for word in words])
    size = len(names)
    if values.size != size * (size + 1) // 2:
        raise ValueError(
            f"{values.size} entries for {size} retained dofs; {size * (size + 1) // 2} are needed"
        )
    rows, columns = np.tril_indices(size)
    kept = values != 0.0
    return Labelled(square_matrix(rows[kept], columns[kept], values[kept], size), names)


def _retained(lines: list[str]) -> tuple[str, ...]:
    """Return "node.direction" of the rows from the head of a substructure."""
    nodes = [word for line in lines if line.startswith("**") for word in re.findall(r"\d+", line)]
    written = [line.split(",") for line in lines if not line.startswith("*")]
    rows = [[word.strip() for word in words if word.strip()] for words in written]
    # One line per retained dof, a bare direction for the first.
    ways = [row[-1] for row in rows if row]
    if len(nodes) != len(ways) or not all(way.isdigit() for way in ways):
        raise ValueError(f"{len(nodes)} nodes and {len(ways)} directions in the head")
    return node_names(nodes, ways)


def read_calculix(path: Path) -> Labelled:
    """Read job.sti (stiffness) or job.mas (mass), with the names in job.dof beside it.

    References
    ----------
    Dhondt, "CalculiX CrunchiX User's Manual", keyword *FREQUENCY.
    """
    names = read_calculix_dofs(path.with_suffix(".dof"))
    matrix = _of_places(read_text(path, ended=True))
    if matrix.shape[0] != len(names):
        raise ValueError(f"{matrix.shape[0]} rows, but {path.stem}.dof names {len(names)}")
    return Labelled(matrix, names)


def read_calculix_dofs(path: Path) -> tuple[str, ...]:
    """Read the names of the rows, "node.direction", from job.dof."""
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

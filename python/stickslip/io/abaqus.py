"""Matrices of Abaqus as text: coordinate format, matrix input format and substructures."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from stickslip.io.fields import real_field
from stickslip.io.label import Labelled, counted, entry_table, node_names, square_matrix
from stickslip.io.source import plain, read_text

__all__ = ["abaqus_keys", "read_abaqus"]

_MATRIX = re.compile(r"^\*MATRIX,\s*TYPE\s*=\s*(\w+)", re.I)


def read_abaqus(path: Path, key: str | None = None) -> Labelled:
    """Read a matrix of *MATRIX OUTPUT or *SUBSTRUCTURE MATRIX OUTPUT.

    Parameters
    ----------
    path : Path
        The file.
    key : str, optional
        "stiffness" or "mass", which of the matrices of a substructure.

    Returns
    -------
    Labelled
        The whole matrix. FORMAT=COORDINATE does not name its rows; FORMAT=MATRIX INPUT does, and
        they come sorted by node and direction.

    Raises
    ------
    ValueError
        With the reason, if the file is none of these, or damaged.

    References
    ----------
    Dassault Systemes, "Abaqus Analysis User's Guide", "Generating structural matrices" and
    "Defining substructures".
    """
    text = read_text(path)
    lines = text.splitlines(keepends=True)
    if key is not None or any(_MATRIX.match(line) for line in lines):
        return _substructure(lines, key)
    body = "".join(line for line in lines if not line.startswith("*"))
    first = body.partition("\n")[0]
    if not first.strip():
        raise ValueError("the file holds no entries")
    words = len(first.replace(",", " ").split())
    if words == 3:
        table = entry_table(body, 3)
        rows, columns = counted(table[:, 0], "row") - 1, counted(table[:, 1], "column") - 1
        size = int(max(rows.max(), columns.max())) + 1
        return Labelled(square_matrix(rows, columns, table[:, 2], size), None)
    if words == 5:
        return _of_nodes(entry_table(body, 5))
    raise ValueError(f"a line holds {words} numbers; 3 or 5 are known, and MatrixMarket files")


def abaqus_keys(path: Path) -> tuple[str, ...]:
    """Return the names of the matrices of a substructure; of other files none."""
    lines = plain(path.read_bytes(), "latin-1").splitlines()
    return tuple(match[1].lower() for match in map(_MATRIX.match, lines) if match)


def _of_nodes(table: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> Labelled:
    """Return the matrix of lines of row node, direction, column node, direction, value."""
    # Abaqus numbers the internal nodes of its elements 0 and below.
    if (table[:, [0, 2]] < 1).any():
        raise ValueError("internal nodes (numbered 0 and below); write FORMAT=COORDINATE instead")
    labels = counted(table[:, :4].ravel(), "node or direction").reshape(-1, 2)
    names, place = np.unique(labels, axis=0, return_inverse=True)
    rows, columns = place.reshape(-1, 2).T
    matrix = square_matrix(rows, columns, table[:, 4], len(names))
    return Labelled(matrix, node_names(names[:, 0], names[:, 1]))


def _substructure(lines: list[str], key: str | None) -> Labelled:
    """Return the lower triangle by rows below *MATRIX, mirrored."""
    found = [
        (match[1].lower(), at) for at, line in enumerate(lines) if (match := _MATRIX.match(line))
    ]
    starts = dict(found)
    if len(starts) < len(found):
        raise ValueError("a matrix is given twice")
    if key is None and len(starts) == 1:
        key = next(iter(starts))
    if key not in starts:
        raise ValueError(f"no matrix {key!r}; it holds {', '.join(starts) or 'none'}")
    names = _retained(lines[: min(starts.values())])
    body = []
    for line in lines[starts[key] + 1 :]:
        if line.startswith("*"):
            break
        body.append(line)
    if not body or not body[-1].endswith("\n"):
        raise ValueError("the last line does not end; the file was cut short")
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

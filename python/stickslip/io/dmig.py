"""Matrices that Nastran punches as bulk data, DMIG."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from stickslip.io.bulk_data import cards
from stickslip.io.entries import Labelled, Sparse, node_names, square_matrix, whole_matrix
from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import Key, at_line, read_text

_Place = tuple[int, int]
"""Grid point and component."""


@dataclass
class _Entries:
    """The cards of one matrix, collected."""

    form: int
    kind: int
    rows: list[_Place] = field(default_factory=list)
    columns: list[_Place] = field(default_factory=list)
    values: list[float] = field(default_factory=list)


def read_dmig(path: Path, key: Key) -> Labelled:
    """Read a square matrix of a punch file; a triangle is mirrored, other cards are passed over.

    All matrices of a file have the same rows: every grid point and component that one of them
    names, sorted. Names are in capitals.

    References
    ----------
    MSC Software, "MSC Nastran Quick Reference Guide", bulk data entry DMIG.
    """
    text = read_text(path, ended=True)
    matrices: dict[str, _Entries] = {}
    for card in cards(text.split("\n"), ("DMIG", "INCLUDE")):
        with at_line(card.line):
            if card.name == "INCLUDE":
                raise ValueError("INCLUDE: write the matrices into one file")
            _take(matrices, card.fields)
    if not matrices:
        raise ValueError("no DMIG card")
    used = sorted({place for one in matrices.values() for place in (*one.rows, *one.columns)})
    index = {place: row for row, place in enumerate(used)}
    made = {name: _matrix(name, entries, index) for name, entries in matrices.items()}
    chosen = replace(key, name=key.name and key.name.upper()).among(made)
    return Labelled(made[chosen], node_names(*zip(*used, strict=True)) if used else ())


def _take(matrices: dict[str, _Entries], fields: list[str]) -> None:
    """Take over the first card of a matrix, or one of its columns."""
    name = fields[0].upper()
    if fields[1] == "0":
        if any(fields[8:]):
            raise ValueError(f"matrix {name!r}: its first card has entries; a column is missing")
        if name in matrices:
            raise ValueError(f"matrix {name!r} is given twice")
        matrices[name] = _Entries(whole_field(fields[2]), whole_field(fields[3]))
    elif name not in matrices:
        raise ValueError(f"matrix {name!r} has columns, but no first card")
    else:
        _add_column(matrices[name], fields)


def _add_column(entries: _Entries, fields: list[str]) -> None:
    # Scalar points have no component.
    column = whole_field(fields[1]), whole_field(fields[2] or "0")
    if fields[3]:
        raise ValueError(f"{fields[3]!r} stands where column {column[0]}.{column[1]} is blank")
    body = fields[4:]
    for at in range(0, len(body), 4):
        grid, component, real, imaginary = (*body[at : at + 4], *[""] * 4)[:4]
        if not (grid or component or real or imaginary):
            continue
        if imaginary and real_field(imaginary) != 0.0:
            raise ValueError("the matrix is complex; export real matrices")
        entries.rows.append((whole_field(grid), whole_field(component or "0")))
        entries.columns.append(column)
        entries.values.append(real_field(real))


def _matrix(name: str, entries: _Entries, index: dict[_Place, int]) -> Sparse:
    if entries.kind not in (1, 2):
        raise ValueError(f"matrix {name!r} is complex (type {entries.kind}); export real matrices")
    if entries.form not in (1, 6):
        raise ValueError(f"matrix {name!r} is not square (form {entries.form})")
    if not entries.values:
        raise ValueError(f"matrix {name!r} has no columns; the file is not whole")
    rows = np.array([index[place] for place in entries.rows], dtype=np.int64)
    columns = np.array([index[place] for place in entries.columns], dtype=np.int64)
    values = np.array(entries.values)
    if entries.form == 6:
        made = square_matrix(rows, columns, values, len(index))
        if (made - made.T).count_nonzero():
            raise ValueError(
                f"matrix {name!r} is symmetric (form 6), but its mirror entries differ"
            )
        return made
    return whole_matrix((len(index),) * 2, rows, columns, values, "general")

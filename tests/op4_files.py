"""OUTPUT4 files in all their forms, written from the description of the format.

References
----------
MSC Software, "MSC Nastran DMAP Programmer's Guide", module OUTPUT4.
"""

import itertools
import struct
from dataclasses import dataclass

import numpy as np

SQUARE, SYMMETRIC = 1, 6
_LARGE = 65536


@dataclass(frozen=True)
class Form:
    """How a file is written.

    Parameters
    ----------
    layout : {"dense", "bigmat", "nonbigmat"}
        Of the columns.
    words : {1, 2}
        Per number: single or double precision.
    order : {"<", ">", ""}
        Of the bytes; of text empty.
    width : {4, 8}
        Bytes of an integer; in text the sizes have 8 or 16 characters.
    """

    layout: str
    words: int
    order: str = ""
    width: int = 4

    @property
    def real(self):
        size = 8 if self.words == 2 else self.width
        return np.dtype(f"{self.order or '<'}f{size}")

    @property
    def count(self):
        """Words of an integer's width per number."""
        return self.real.itemsize // self.width if self.order else self.words

    def __str__(self):
        return f"{self.layout}{self.words}{self.order or 't'}{self.width}"


FORMS = [
    Form(*one)
    for one in itertools.product(("dense", "bigmat", "nonbigmat"), (1, 2), ("<", ">", ""), (4, 8))
]


def written(matrix, form, name="K", symmetry=SYMMETRIC):
    """Return the content of a file."""
    return (_binary if form.order else _text)(matrix, form, name, symmetry)


def _strings(column):
    """Return the first row, from 1, and the values of each piece without a zero."""
    places = np.flatnonzero(column)
    parts = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    return [(part[0] + 1, column[part]) for part in parts if part.size]


def _address(form, size, row):
    """Return the words that precede a string."""
    return [size + 1, row] if form.layout == "bigmat" else [row + _LARGE * (size + 1)]


def _header(matrix, form, symmetry):
    rows, columns = matrix.shape
    return [columns, -rows if form.layout == "bigmat" else rows, symmetry, form.words]


def _binary(matrix, form, name, symmetry):
    def integers(*numbers):
        return np.array(numbers, f"{form.order}i{form.width}").tobytes()

    def record(body):
        mark = struct.pack(f"{form.order}i", len(body))
        return mark + body + mark

    head = integers(*_header(matrix, form, symmetry))
    pieces = [record(head + name.ljust(2 * form.width).encode("ascii"))]
    for column, values in enumerate(matrix.T, 1):
        strings = _strings(values)
        if form.layout == "dense":
            first, last = strings[0][0], strings[-1][0] + len(strings[-1][1])
            row, body = first, values[first - 1 : last - 1].astype(form.real).tobytes()
        else:
            row, body = (
                0,
                b"".join(
                    integers(*_address(form, len(part) * form.count, first))
                    + part.astype(form.real).tobytes()
                    for first, part in strings
                ),
            )
        pieces.append(record(integers(column, row, len(body) // form.width) + body))
    end = integers(len(matrix.T) + 1, 1, form.count) + np.ones(1, form.real).tobytes()
    pieces.append(record(end))
    return b"".join(pieces)


def _text(matrix, form, name, symmetry):
    digits, per_line = (16, 3) if form.words == 2 else (9, 5)

    def integers(*numbers, width=8):
        return "".join(f"{number:{width}d}" for number in numbers)

    def reals(values):
        written = [f"{value:{digits + 7}.{digits}E}" for value in values]
        return ["".join(written[at : at + per_line]) for at in range(0, len(written), per_line)]

    head = _header(matrix, form, symmetry)
    first = integers(*head[:2], width=2 * form.width) + integers(*head[2:])
    lines = [f"{first}{name:8s}1P,{per_line}E{digits + 7}.{digits}{'|I16' * (form.width == 8)}"]
    for column, values in enumerate(matrix.T, 1):
        strings = _strings(values)
        if form.layout == "dense":
            start, last = strings[0][0], strings[-1][0] + len(strings[-1][1])
            part = values[start - 1 : last - 1]
            # Numbers, not words, are counted here.
            lines += [integers(column, start, len(part)), *reals(part)]
            continue
        body, total = [], 0
        for start, part in strings:
            address = _address(form, len(part) * form.words, start)
            body += [integers(*address), *reals(part)]
            total += len(part) * form.words + len(address)
        lines += [integers(column, 0, total), *body]
    lines += [integers(len(matrix.T) + 1, 1, 1), *reals([1.0])]
    return "".join(f"{line}\n" for line in lines).encode("ascii")

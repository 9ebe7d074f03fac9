"""The .mapping file that ANSYS' HBMAT writes: which degree of freedom each row of a matrix is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from stickslip.checks import is_file
from stickslip.io.entries import Labelled, Sparse, node_names
from stickslip.io.numbers import whole_field
from stickslip.io.source import at_line, read_text

_WAYS = {"UX": "1", "UY": "2", "UZ": "3", "ROTX": "4", "ROTY": "5", "ROTZ": "6"}
_ENDINGS = (".mapping", ".MAPPING")


def with_mapping(read: Callable[[Path], Sparse]) -> Callable[[Path], Labelled | Sparse]:
    """Return a reader of matrices that names the rows if a .mapping lies beside the file."""

    def reader(path: Path) -> Labelled | Sparse:
        matrix = read(path)
        beside = next((one for end in _ENDINGS if is_file(one := path.with_suffix(end))), None)
        if beside is None:
            return matrix
        names = read_mapping(beside)
        if matrix.shape[0] != len(names):
            raise ValueError(f"{matrix.shape[0]} rows, but {beside.name} names {len(names)}")
        return Labelled(matrix, names)

    return reader


def read_mapping(path: Path) -> tuple[str, ...]:
    """Read the names of the rows, "node.direction"; other quantities keep the name of ANSYS.

    References
    ----------
    ANSYS, Inc., "Mechanical APDL Command Reference", HBMAT, Mapping.
    """
    lines = read_text(path, ended=True).splitlines()
    nodes: list[int] = []
    ways: list[str] = []
    for number, line in enumerate(lines[1:], 2):
        with at_line(number, path.name):
            row, node, quantity = _words(line)
            if row != len(nodes) + 1:
                raise ValueError(f"row {row} follows row {len(nodes)}")
            nodes.append(node)
            ways.append(_WAYS.get(quantity.upper(), quantity.upper()))
    names = node_names(nodes, ways)
    if not names or len(set(names)) < len(names):
        raise ValueError(f"{path.name} names {'a row twice' if names else 'no row'}")
    return names


def _words(line: str) -> tuple[int, int, str]:
    words = line.split()
    if len(words) != 3 or not words[2].isalnum():
        raise ValueError(f"row, node and quantity expected, found {line.strip()[:40]!r}")
    return whole_field(words[0]), whole_field(words[1]), words[2]

"""The .full and .mapping files of ANSYS.

The first is read by ansys-mapdl-reader in a process of its own.

Its compiled reader trusts the addresses in the file: a damaged one takes the process down, and
another process is all it may take.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from stickslip.checks import is_file
from stickslip.errors import ModelError
from stickslip.io.entries import Labelled, Sparse, node_names, whole_matrix
from stickslip.io.numbers import whole_field
from stickslip.io.source import Key, at_line, read_text

_PATIENCE = 600
"""Seconds; the largest sound files take one or two minutes."""

_READ = """
import sys
import numpy as np
from ansys.mapdl import reader
full = reader.read_binary(sys.argv[1])
dofs, stiffness, mass = full.load_km(as_sparse=True, sort=False)
chosen = {"stiffness": stiffness, "mass": mass}[sys.argv[3]]
if chosen is None:
    sys.exit("the file holds no such matrix")
chosen.sum_duplicates()
chosen = chosen.tocoo()
np.savez(sys.argv[2], dofs=dofs, held=full.const, rows=chosen.row, columns=chosen.col,
         values=chosen.data, size=len(dofs))
"""
_WAYS = {"UX": "1", "UY": "2", "UZ": "3", "ROTX": "4", "ROTY": "5", "ROTZ": "6"}
_ENDINGS = (".mapping", ".MAPPING")


def read_ansys(path: Path, key: Key) -> Labelled:
    """Read a matrix of a .full file, "stiffness" or "mass", without its constrained rows.

    The reader refuses unsymmetric matrices and lumped masses. Directions count from 1.
    """
    chosen = key.among(("stiffness", "mass"))
    if importlib.util.find_spec("ansys") is None or importlib.util.find_spec("vtk") is None:
        raise ModelError(
            f"{path}: a .full file needs ansys-mapdl-reader, some 600 MB with VTK: "
            "pip install 'stickslip[ansys]'; or export with ANSYS' HBMAT to a .hb file"
        )
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "matrix.npz"
        command = [sys.executable, "-c", _READ, str(path), str(target), chosen]
        try:
            made = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=False)
        except subprocess.TimeoutExpired:
            raise ValueError(f"no answer within {_PATIENCE} s; the file is damaged") from None
        if made.returncode or not target.is_file():
            told = made.stderr.decode(errors="replace").strip().splitlines()
            raise ValueError(told[-1] if told and made.returncode > 0 else "its reader crashed")
        with np.load(target) as read:
            return _labelled(dict(read))


def _labelled(read: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.generic]]]) -> Labelled:
    dofs, size = np.asarray(read["dofs"], np.int64), int(read["size"])
    rows, columns = np.asarray(read["rows"], np.int64), np.asarray(read["columns"], np.int64)
    values = np.asarray(read["values"], np.float64)
    if not size or (dofs[:, 0] < 1).any() or len(np.unique(dofs, axis=0)) < size:
        raise ValueError("its degrees of freedom are not named once each")
    matrix = whole_matrix((size, size), rows, columns, values, "symmetric").tocsr()
    held = np.asarray(read["held"], np.int64).reshape(-1, 2)
    free = ~(dofs[:, None] == held[None]).all(axis=2).any(axis=1) if len(held) else dofs[:, 0] > 0
    diagonal = matrix.diagonal()[free]
    if not (diagonal > 0.0).all():
        raise ValueError("a diagonal entry is not positive; the file is damaged")
    names = node_names(dofs[free, 0], dofs[free, 1] + 1)
    return Labelled(matrix[free][:, free].tocoo(), names)


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

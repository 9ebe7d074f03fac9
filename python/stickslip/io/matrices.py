"""Matrices from files: one reader per format, chosen by the ending of the name.

NumPy's files are looked at before NumPy makes room for what they announce.
"""

from __future__ import annotations

import math
import os
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Literal, TypeAlias, overload

import numpy as np

from stickslip.checks import (
    Matrix,
    SparseMatrix,
    brief,
    file_path,
    real_matrix,
    require_finite,
    text,
    unknown,
)
from stickslip.errors import ModelError
from stickslip.io import source
from stickslip.io.abaqus import read_abaqus, read_calculix, read_calculix_dofs
from stickslip.io.ansys import read_ansys, read_mapping, with_mapping
from stickslip.io.curve import read_table
from stickslip.io.dmig import read_dmig
from stickslip.io.entries import Labelled, require_size
from stickslip.io.harwell_boeing import read_harwell_boeing
from stickslip.io.matlab import read_matlab
from stickslip.io.matrix_market import read_matrix_market
from stickslip.io.op4 import read_op4
from stickslip.io.source import Key, plain, readable

if TYPE_CHECKING:
    from scipy.sparse import csc_array


_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def read_numpy(file: Path, key: Key) -> object:
    """Read a matrix of `.npy` or `.npz`, of NumPy or of SciPy's sparse matrices.

    An array must have the bytes that its header announces, and a name of its own.
    """
    with file.open("rb") as stream:
        _require_sound(stream)
        loaded = np.load(stream, allow_pickle=False)
        if isinstance(loaded, np.ndarray):
            key.refuse()
            return loaded
        if {"format", "shape", "data"} <= set(loaded.files):
            from scipy.sparse import load_npz

            key.refuse()
            stream.seek(0)
            return load_npz(stream)
        return loaded[key.among(loaded.files)]


def _require_sound(stream: IO[bytes]) -> None:
    """Check `.npy` and `.npz`, and go back to the beginning."""
    if stream.read(2) == b"PK":
        with zipfile.ZipFile(stream) as archive:
            if len(set(archive.namelist())) < len(archive.namelist()):
                raise ValueError("two arrays have the same name")
            for member in archive.infolist():
                name, size = member.filename, member.file_size
                packed = member.compress_type != zipfile.ZIP_STORED
                if size > source.LARGEST_UNPACKED and packed:
                    raise ValueError(f"{name!r} unpacks to {size} bytes; save it unpacked")
                if name.endswith(".npy"):
                    with archive.open(member) as array:
                        count = _require_held(array, size)
                    if packed:
                        source.require_room(name, count)
    else:
        size = stream.seek(0, os.SEEK_END)
        stream.seek(0)
        _require_held(stream, size)
    stream.seek(0)


def _require_held(stream: IO[bytes], size: int) -> int:
    """Compare the header of an array with the bytes that follow; return how many numbers it has."""
    version = np.lib.format.read_magic(stream)
    if version not in _HEADERS:
        raise ValueError(f"an array of format {version}")
    shape, _, dtype = _HEADERS[version](stream)
    if any(isinstance(one, bool) or one < 0 for one in shape):
        raise ValueError(f"an array of shape {shape}; the file is damaged")
    announced, held = math.prod(shape) * dtype.itemsize, size - stream.tell()
    # NumPy refuses objects by itself.
    if not dtype.hasobject and announced != held:
        raise ValueError(f"shape {shape} takes {announced} bytes, {held} are there")
    return math.prod(shape)


_Reader: TypeAlias = Callable[[Path, Key], object]


@overload
def read_matrix(
    path: str | os.PathLike[str], key: str | None = None, *, sparse: Literal[False] = False
) -> Matrix: ...


@overload
def read_matrix(
    path: str | os.PathLike[str], key: str | None = None, *, sparse: Literal[True]
) -> csc_array: ...


def read_matrix(
    path: str | os.PathLike[str], key: str | None = None, *, sparse: bool = False
) -> Matrix | csc_array:
    """Read one real matrix from a file.

    Parameters
    ----------
    path : str or path-like
        The file. Its ending says what it is: `.npy`, `.npz` (of `numpy.savez` or
        `scipy.sparse.save_npz`), `.mat` (MATLAB), `.mtx` or
        `.mtx.gz` (MatrixMarket, or Abaqus' text), `.hb`, `.rb`, `.rua`, `.rsa`, `.hbf`, `.psa`,
        `.matrix` (Harwell-Boeing and Rutherford-Boeing, as of ANSYS' HBMAT, whose `.mapping` may
        lie beside it to name the rows), `.mmf` (MatrixMarket of ANSYS' EXPORT), `.op4` (Nastran's
        OUTPUT4), `.pch`, `.dmig` (Nastran's DMIG), `.sti`, `.mas` (CalculiX, with the `.dof` beside
        it), `.full` (ANSYS, with the package ansys-mapdl-reader), `.csv` (rows of numbers,
        between commas, semicolons, tabs or spaces).
    key : str, optional
        Name of the matrix in a file that holds several (`.npz`, `.mat`, `.op4`, `.pch`; "stiffness"
        or "mass" in `.full` and substructures of Abaqus); it may be left out if there is only one.
    sparse : bool, optional
        Return a sparse matrix: the way to read finite-element models for `craig_bampton`.

    Returns
    -------
    ndarray of float64, shape (rows, columns), or scipy.sparse.csc_array
        The matrix. Symmetric storage of one triangle has been mirrored.

    Raises
    ------
    ModelError
        If the file is missing, damaged or of an unknown kind; if `key` is unknown, or needed and
        missing; if the matrix is complex, not finite, not two-dimensional, or sparse and too large
        to be made dense.

    See Also
    --------
    read_dofs : the names of its rows.
    """
    file = file_path(path, "path")
    loaded, entry = _load(file, key).matrix, _entry(file, key)
    with readable(file, _ending(file)):
        if sparse:
            return _sparse(loaded, entry)
        matrix = real_matrix(loaded, entry)
    require_finite(matrix, entry)
    return matrix


def read_dofs(path: str | os.PathLike[str], key: str | None = None) -> tuple[str, ...]:
    """Read the names of the rows of a matrix, "node.direction", where the file has them.

    Directions count from 1.

    Parameters
    ----------
    path, key
        As of `read_matrix`, and `key` may be left out: all matrices of a file have the same rows.
        CalculiX (`.sti`, `.mas`, `.dof`), Nastran's DMIG, Abaqus' matrix input format and
        substructures, ANSYS' `.full` and HBMAT (`.mapping`, or a matrix beside it).

    Raises
    ------
    ModelError
        If the file cannot be read, or does not name its rows.
    """
    file = file_path(path, "path")
    by_itself = {".dof": read_calculix_dofs, ".mapping": read_mapping}.get(_ending(file))
    if by_itself:
        with readable(file, _ending(file)):
            return by_itself(file)
    names = _load(file, key, any_will_do=True).dofs
    if names is None:
        raise ModelError(f"{file}: it does not name its rows; count them, from 0")
    return names


def _load(file: Path, key: str | None, *, any_will_do: bool = False) -> Labelled:
    """Return what the reader of the format makes of the file."""
    if key is not None:
        text(key, f"{file}: key")
    reader = _READERS.get(_ending(file))
    if reader is None:
        raise ModelError(f"{file}: {unknown('file ending', _ending(file), _READERS)}")
    with readable(file, _ending(file)):
        loaded = reader(file, Key(file, key, any_will_do))
        if not isinstance(loaded, Labelled):
            loaded = Labelled(loaded, None)
        if isinstance(loaded.matrix, SparseMatrix):
            require_size(*loaded.matrix.shape)
        if hasattr(loaded.matrix, "check_format"):
            # Damaged sparse indices would write outside the dense array.
            loaded.matrix.check_format(full_check=True)
    return loaded


def _sparse(matrix: object, entry: str) -> csc_array:
    """Return a matrix of real, finite numbers without making it dense."""
    from scipy.sparse import coo_array, issparse

    given: Any = matrix if issparse(matrix) else real_matrix(matrix, entry)
    found = coo_array(given)
    if found.dtype.kind not in "fiu":
        raise ModelError(f"{entry}: entries of type {found.dtype}; give real matrices")
    wrong = np.flatnonzero(~np.isfinite(found.data))
    if wrong.size:
        place = f"({found.row[wrong[0]]}, {found.col[wrong[0]]})"
        raise ModelError(f"{entry}: {found.data[wrong[0]]} at {place}; every entry must be finite")
    return found.astype(np.float64).tocsc()


def _ending(file: Path) -> str:
    name = file.name.lower()
    return ".mtx.gz" if name.endswith(".mtx.gz") else Path(name).suffix


def _entry(file: Path, key: str | None) -> str:
    return f"{file}" if key is None else f"{file}: {brief(key)}"


def _only(read: Callable[[Path], object]) -> _Reader:
    """Return the reader of a format with one matrix per file."""

    def reader(file: Path, key: Key) -> object:
        key.refuse()
        return read(file)

    return reader


def _read_mtx(file: Path, key: Key) -> object:
    """Read MatrixMarket, or what Abaqus calls .mtx."""
    with file.open("rb") as stream:
        start = plain(stream.read(512), "latin-1").lstrip()
    read = read_abaqus if start[:1] in (*"0123456789", "*") else _only(read_matrix_market)
    return read(file, key)


_READERS: dict[str, _Reader] = {
    **dict.fromkeys((".npy", ".npz"), read_numpy),
    ".mat": read_matlab,
    ".mtx": _read_mtx,
    ".mtx.gz": _only(read_matrix_market),
    **dict.fromkeys(
        (".hb", ".rb", ".rua", ".rsa", ".hbf", ".psa", ".matrix"),
        _only(with_mapping(read_harwell_boeing)),
    ),
    ".mmf": _only(with_mapping(read_matrix_market)),
    ".op4": read_op4,
    **dict.fromkeys((".pch", ".dmig"), read_dmig),
    **dict.fromkeys((".sti", ".mas"), _only(read_calculix)),
    ".full": read_ansys,
    ".csv": _only(read_table),
}

"""Matrices from files: one reader per format, chosen by the ending of the name."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from stickslip.checks import (
    Matrix,
    SparseMatrix,
    brief,
    file_path,
    is_file,
    listed,
    real_matrix,
    text,
    unknown,
)
from stickslip.errors import ModelError
from stickslip.io.abaqus import abaqus_keys, read_abaqus
from stickslip.io.ansys import ANSYS_KEYS, read_ansys
from stickslip.io.calculix import read_calculix, read_calculix_dofs
from stickslip.io.dmig import read_dmig
from stickslip.io.harwell_boeing import read_harwell_boeing
from stickslip.io.hdf5 import require_held, require_own
from stickslip.io.label import Labelled
from stickslip.io.matlab import require_sound
from stickslip.io.matrix_market import read_matrix_market
from stickslip.io.npz import require_sound_npy
from stickslip.io.op4 import read_op4
from stickslip.io.source import plain
from stickslip.io.triangle import columns_of, require_size

if TYPE_CHECKING:
    import h5py  # type: ignore[import-untyped, unused-ignore]
    from scipy.sparse import csc_array

__all__ = ["read_dofs", "read_matrix"]

_LONGEST = 80
_HDF5 = b"\x89HDF\r\n\x1a\n"
_MATLAB_NUMBERS = {"double", "single", "sparse", "logical"} | {
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}


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
        `scipy.sparse.save_npz`), `.mat` (MATLAB; -v7.3 files need the package h5py), `.mtx` or
        `.mtx.gz` (MatrixMarket, or Abaqus' text), `.hb`, `.rb`, `.rua`, `.rsa`, `.hbf`, `.psa`
        (Harwell-Boeing and Rutherford-Boeing, as of ANSYS' HBMAT), `.op4` (Nastran's OUTPUT4),
        `.pch`, `.dmig` (Nastran's DMIG), `.sti`, `.mas` (CalculiX, with the `.dof` beside it),
        `.full` (ANSYS, with the package ansys-mapdl-reader).
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
    loaded = _load(file, key)
    if sparse:
        with _readable(file):
            return _sparse(loaded.matrix, _entry(file, key))
    with _readable(file):
        matrix = real_matrix(loaded.matrix, _entry(file, key))
    if not np.isfinite(matrix).all():
        row, column = np.argwhere(~np.isfinite(matrix))[0]
        raise _not_finite(_entry(file, key), matrix[row, column], row, column)
    return matrix


def read_dofs(path: str | os.PathLike[str], key: str | None = None) -> tuple[str, ...]:
    """Read the names of the rows of a matrix, where the file has them.

    Parameters
    ----------
    path, key
        As of `read_matrix`: CalculiX (`.sti`, `.mas`, `.dof`), Nastran's DMIG, Abaqus' matrix input
        format and substructures, ANSYS' `.full`.

    Returns
    -------
    tuple of str
        "node.direction", one per row; directions count from 1.

    Raises
    ------
    ModelError
        If the file cannot be read, or does not name its rows.
    """
    file = file_path(path, "path")
    if _ending(file) == ".dof":
        if not is_file(file):
            raise ModelError(f"{file}: no such file; check the path")
        with _readable(file):
            return read_calculix_dofs(file)
    names = _load(file, key).dofs
    if names is None:
        raise ModelError(f"{file}: it does not name its rows; count them, from 0")
    return names


def _load(file: Path, key: str | None) -> Labelled:
    """Return what the reader of the format makes of the file."""
    if key is not None:
        text(key, f"{file}: key")
    reader = _READERS.get(_ending(file))
    if reader is None:
        raise ModelError(f"{file}: {unknown('file ending', _ending(file), _READERS)}")
    if not is_file(file):
        raise ModelError(f"{file}: no such file; check the path")
    with _readable(file):
        loaded = reader(file, key)
        if not isinstance(loaded, Labelled):
            loaded = Labelled(loaded, None)
        if isinstance(loaded.matrix, SparseMatrix):
            require_size(*loaded.matrix.shape)
        if hasattr(loaded.matrix, "check_format"):
            # Damaged sparse indices would write outside the dense array.
            loaded.matrix.check_format(full_check=True)
    return loaded


@contextmanager
def _readable(file: Path) -> Iterator[None]:
    """Word whatever a reader stumbles over."""
    # The readers' libraries raise whatever they stumble over in a damaged file, struct.error and
    # MemoryError among it.
    try:
        yield
    except ModelError:
        raise
    except Exception as error:
        cause = " ".join(str(error).split())[:_LONGEST] or type(error).__name__
        raise ModelError(
            f"{file}: cannot be read as {_ending(file)}: {cause}; write the file again"
        ) from error


def _sparse(matrix: object, entry: str) -> csc_array:
    """Return a matrix of real, finite numbers without making it dense."""
    from scipy.sparse import coo_array, issparse

    given: Any = matrix if issparse(matrix) else real_matrix(matrix, entry)
    found = coo_array(given)
    if found.dtype.kind not in "fiu":
        raise ModelError(f"{entry}: entries of type {found.dtype}; give real matrices")
    wrong = np.flatnonzero(~np.isfinite(found.data))
    if wrong.size:
        at = wrong[0]
        raise _not_finite(entry, found.data[at], int(found.row[at]), int(found.col[at]))
    return found.astype(np.float64).tocsc()


def _not_finite(entry: str, value: float, row: int, column: int) -> ModelError:
    return ModelError(
        f"{entry}: {value} in row {row}, column {column}, counted from 0; "
        "every entry must be finite"
    )


def _ending(file: Path) -> str:
    name = file.name.lower()
    return ".mtx.gz" if name.endswith(".mtx.gz") else Path(name).suffix


def _entry(file: Path, key: str | None) -> str:
    return f"{file}" if key is None else f"{file}: {brief(key)}"


def _choose(file: Path, key: str | None, known: Iterable[str]) -> str:
    names = list(known)
    if key is None:
        if len(names) == 1:
            return names[0]
        raise ModelError(f"{file}: it holds {listed(names) or 'nothing'}; choose one with key")
    if key not in names:
        raise ModelError(f"{file}: {unknown('key', key, names)}")
    return key


def _refuse_key(file: Path, key: str | None) -> None:
    if key is not None:
        raise ModelError(f"{file}: key {brief(key)}, but the file holds one matrix; leave key out")


def _read_numpy(file: Path, key: str | None) -> object:
    with file.open("rb") as stream:
        require_sound_npy(stream)
        loaded = np.load(stream, allow_pickle=False)
        if isinstance(loaded, np.ndarray):
            _refuse_key(file, key)
            return loaded
        if {"format", "shape", "data"} <= set(loaded.files):
            from scipy.sparse import load_npz

            _refuse_key(file, key)
            stream.seek(0)
            return load_npz(stream)
        return loaded[_choose(file, key, loaded.files)]


def _read_matlab(file: Path, key: str | None) -> object:
    with file.open("rb") as stream:
        start = stream.read(512 + len(_HDF5))
    # MATLAB puts its own 512 bytes in front of the HDF5 file.
    if start.startswith(_HDF5) or start[512:] == _HDF5:
        return _read_matlab_hdf5(file, key)
    from scipy.io import loadmat, whosmat

    require_sound(file)
    found = whosmat(file)
    kinds = {name: kind for name, _, kind in found}
    if len(kinds) < len(found):
        raise ValueError("two matrices have the same name")
    name = _choose(file, key, kinds)
    if kinds[name] not in _MATLAB_NUMBERS:
        raise ModelError(f"{file}: {brief(name)} is a {kinds[name]}; save the matrix by itself")
    return loadmat(file, variable_names=[name])[name]


def _read_matlab_hdf5(file: Path, key: str | None) -> object:
    try:
        import h5py
    except ImportError:
        raise ModelError(
            f"{file}: a MATLAB 7.3 file needs the package h5py; install it, or save with -v7"
        ) from None
    with h5py.File(file, "r") as variables:
        name = _choose(file, key, (name for name in variables if not name.startswith("#")))
        require_own(variables, name)
        variable = variables[name]
        if isinstance(variable, h5py.Group):
            return _read_matlab_sparse(file, name, variable)
        kind = variable.attrs.get("MATLAB_class", b"double").decode()
        if kind not in _MATLAB_NUMBERS:
            raise ModelError(f"{file}: {brief(name)} is a {kind}; save the matrix by itself")
        if variable.dtype.names:
            raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
        require_held(variable)
        # HDF5 counts in rows, MATLAB in columns.
        return np.asarray(variable[()]).T


def _read_matlab_sparse(file: Path, name: str, group: h5py.Group) -> object:
    from scipy.sparse import csc_array

    if "MATLAB_sparse" not in group.attrs:
        raise ModelError(f"{file}: {brief(name)} is a struct; save the matrix by itself")
    parts = {}
    for part in ("jc", "ir", "data"):
        if part in group:
            require_own(group, part)
            require_held(group[part])
            parts[part] = group[part][()]
    rows, pointers = int(group.attrs["MATLAB_sparse"]), parts["jc"].astype(np.int64)
    if "data" not in parts:
        if pointers.any():
            raise ValueError(f"{pointers.max()} entries announced, 0 present")
        return csc_array((rows, len(pointers) - 1))
    values, places = parts["data"], parts["ir"].astype(np.int64)
    if values.dtype.names:
        raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
    columns_of(pointers, places)
    return csc_array((values, places, pointers), shape=(rows, len(pointers) - 1))


def _read_mtx(file: Path, key: str | None) -> object:
    """Read MatrixMarket, or what Abaqus calls .mtx."""
    if _ending(file) == ".mtx":
        with file.open("rb") as stream:
            start = plain(stream.read(512), "latin-1").lstrip()
        if start[:1] in (*"0123456789", "*"):
            keys = abaqus_keys(file)
            if keys:
                return read_abaqus(file, _choose(file, key, keys))
            _refuse_key(file, key)
            return read_abaqus(file)
    _refuse_key(file, key)
    return read_matrix_market(file)


def _read_op4(file: Path, key: str | None) -> object:
    matrices = read_op4(file)
    return matrices[_choose(file, key and key.upper(), matrices)]()


def _read_dmig(file: Path, key: str | None) -> object:
    matrices = read_dmig(file)
    return matrices[_choose(file, key and key.upper(), matrices)]


def _read_calculix(file: Path, key: str | None) -> object:
    _refuse_key(file, key)
    return read_calculix(file)


def _read_ansys(file: Path, key: str | None) -> object:
    return read_ansys(file, _choose(file, key, ANSYS_KEYS))


def _read_harwell_boeing(file: Path, key: str | None) -> object:
    _refuse_key(file, key)
    return read_harwell_boeing(file)


_READERS: dict[str, Callable[[Path, str | None], object]] = {
    ".npy": _read_numpy,
    ".npz": _read_numpy,
    ".mat": _read_matlab,
    ".mtx": _read_mtx,
    ".mtx.gz": _read_mtx,
    **dict.fromkeys((".hb", ".rb", ".rua", ".rsa", ".hbf", ".psa"), _read_harwell_boeing),
    ".op4": _read_op4,
    **dict.fromkeys((".pch", ".dmig"), _read_dmig),
    **dict.fromkeys((".sti", ".mas"), _read_calculix),
    ".full": _read_ansys,
}

"""Matrices from files: NumPy, MATLAB, MatrixMarket and Harwell-Boeing."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import Matrix, brief, file_path, listed, real_matrix, text, unknown
from stickslip.errors import ModelError
from stickslip.io.harwell_boeing import read_harwell_boeing
from stickslip.io.matlab import require_sound
from stickslip.io.matrix_market import read_matrix_market

if TYPE_CHECKING:
    import h5py  # type: ignore[import-untyped, unused-ignore]

__all__ = ["read_matrix"]

_LONGEST = 80
_HDF5 = b"\x89HDF\r\n\x1a\n"
_MATLAB_NUMBERS = {"double", "single", "sparse", "logical"} | {
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}


def read_matrix(path: str | os.PathLike[str], key: str | None = None) -> Matrix:
    """Read one real matrix from a file.

    Parameters
    ----------
    path : str or path-like
        The file. Its ending says what it is: `.npy`, `.npz` (of `numpy.savez` or
        `scipy.sparse.save_npz`), `.mat` (MATLAB; -v7.3 files need the package h5py), `.mtx` or
        `.mtx.gz` (MatrixMarket), `.hb`, `.rb`, `.rua`, `.rsa`, `.hbf`, `.psa` (Harwell-Boeing and
        Rutherford-Boeing, as of ANSYS' HBMAT).
    key : str, optional
        Name of the matrix in a `.npz` or `.mat` file; it may be left out if there is only one.

    Returns
    -------
    ndarray of float64, shape (rows, columns)
        The dense matrix. Symmetric storage of one triangle has been mirrored.

    Raises
    ------
    ModelError
        If the file is missing, damaged or of an unknown kind; if `key` is unknown, or needed and
        missing; if the matrix is complex, not finite, not two-dimensional, or sparse and too large.
    """
    file = file_path(path, "path")
    if key is not None:
        text(key, f"{file}: key")
    reader = _READERS.get(_ending(file))
    if reader is None:
        raise ModelError(f"{file}: {unknown('file ending', _ending(file), _READERS)}")
    if not os.path.isfile(file):
        raise ModelError(f"{file}: no such file; check the path")
    # The readers' libraries raise whatever they stumble over in a damaged file, struct.error and
    # MemoryError among it.
    try:
        loaded = reader(file, key)
        if hasattr(loaded, "check_format"):
            # Damaged sparse indices would write outside the dense array.
            loaded.check_format(full_check=True)
        matrix = real_matrix(loaded, _entry(file, key))
    except ModelError:
        raise
    except Exception as error:
        cause = " ".join(str(error).split())[:_LONGEST] or type(error).__name__
        raise ModelError(
            f"{file}: cannot be read as {_ending(file)}: {cause}; write the file again"
        ) from error
    if not np.isfinite(matrix).all():
        row, column = np.argwhere(~np.isfinite(matrix))[0]
        raise ModelError(
            f"{_entry(file, key)}: {matrix[row, column]} in row {row}, column {column}, counted "
            "from 0; every entry must be finite"
        )
    return matrix


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
    kinds = {name: kind for name, _, kind in whosmat(file)}
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
        variable = variables[name]
        if isinstance(variable, h5py.Group):
            return _read_matlab_sparse(file, name, variable)
        kind = variable.attrs.get("MATLAB_class", b"double").decode()
        if kind not in _MATLAB_NUMBERS:
            raise ModelError(f"{file}: {brief(name)} is a {kind}; save the matrix by itself")
        if variable.dtype.names:
            raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
        # HDF5 counts in rows, MATLAB in columns.
        return np.asarray(variable[()]).T


def _read_matlab_sparse(file: Path, name: str, group: h5py.Group) -> object:
    from scipy.sparse import csc_array

    if "MATLAB_sparse" not in group.attrs:
        raise ModelError(f"{file}: {brief(name)} is a struct; save the matrix by itself")
    pointers = group["jc"][()]
    rows = int(group.attrs["MATLAB_sparse"])
    if "data" not in group:
        return csc_array((rows, len(pointers) - 1))
    values = group["data"][()]
    if values.dtype.names:
        raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
    return csc_array((values, group["ir"][()], pointers), shape=(rows, len(pointers) - 1))


def _read_matrix_market(file: Path, key: str | None) -> object:
    _refuse_key(file, key)
    return read_matrix_market(file)


def _read_harwell_boeing(file: Path, key: str | None) -> object:
    _refuse_key(file, key)
    return read_harwell_boeing(file)


_READERS: dict[str, Callable[[Path, str | None], object]] = {
    ".npy": _read_numpy,
    ".npz": _read_numpy,
    ".mat": _read_matlab,
    ".mtx": _read_matrix_market,
    ".mtx.gz": _read_matrix_market,
    **dict.fromkeys((".hb", ".rb", ".rua", ".rsa", ".hbf", ".psa"), _read_harwell_boeing),
}

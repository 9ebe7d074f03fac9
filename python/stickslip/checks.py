"""Checks of every number, name and matrix that a user gives."""

from __future__ import annotations

import difflib
import os
import re
import stat
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from importlib import import_module
from numbers import Complex, Integral, Real
from pathlib import Path
from typing import Any, Protocol, TypeAlias, TypeVar, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.errors import EntryError, ModelError

MAX_DENSE = 5000
"""Largest sparse matrix, in rows, that is made dense."""

MAX_SPARSE = 20_000_000
"""Largest sparse matrix, in rows or columns: no model of this size is reduced on one machine."""

MAX_COUNT = 2**31 - 1
"""Largest number that counts something."""

Matrix: TypeAlias = NDArray[np.float64]
_SHOWN = 24
_FEW = 3
# Unicode's control characters, line ends and halves of characters.
_NO_TEXT = frozenset({"Cc", "Cs", "Zl", "Zp"})
_LONGEST = 60
_LONGEST_PATH = 4096
# A sign, zeros and a point before a digit that is none: the mantissa of a number that is not 0.
_NOT_ZERO = re.compile(r"\s*[+-]?[0._]*[1-9]")
_Member = TypeVar("_Member")
_Scalar = TypeVar("_Scalar", bound=np.generic)
_RESERVED = re.compile(r"con|prn|aux|nul|(com|lpt)[0-9¹²³]|conin\$|conout\$", re.I)


@runtime_checkable
class SparseMatrix(Protocol):
    """What is needed of a `scipy.sparse` array or matrix, so that SciPy need not be imported."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""

    def toarray(self) -> NDArray[np.generic]:
        """Return the dense array."""


MatrixLike: TypeAlias = ArrayLike | SparseMatrix


def brief(value: object) -> str:
    """Return what `repr` says, on one line and cut to 60 characters; it never raises."""
    try:
        shown = repr(value)
    except Exception:
        # Foreign classes may fail in any way, and Python refuses to write very long integers.
        shown = f"<{type(value).__name__}>"
    line = " ".join(part.strip() for part in shown.splitlines())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3]}..."


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Word an unknown name: ``unknown dof 'tpi'; did you mean 'tip'?``, or the list of names."""
    names = list(known)
    near = _near(name, names) if isinstance(name, str) else []
    if near:
        return f"unknown {kind} {brief(name)}; did you mean {' or '.join(map(brief, near))}?"
    if not names:
        return f"unknown {kind} {brief(name)}; there is none"
    return f"unknown {kind} {brief(name)}; known: {listed(names)}"


def _near(name: str, names: Sequence[str]) -> list[str]:
    """Return the names that may have been meant.

    Names such as "left.tip" and "next.ps.z" say in their first parts to which body they belong: a
    misspelt one is never taken for that of another body.
    """
    *body, last = name.split(".")
    same = [one for one in names if _same_body(body, one.split(".")[:-1])]
    # "exact-response" is rather "exact" than "forced-response".
    parts = [one for one in same if f"{name}-".startswith(f"{one}-")]
    near = parts or close(name, same)
    if near or body:
        return near
    ends = [one for one in names if one.endswith(f".{last}")]
    return ends if len(ends) <= _FEW else []


def close(name: str, names: Iterable[str], cutoff: float = 0.6) -> list[str]:
    """Return the name that is meant, by its letters rather than by their case; none if none is."""
    known = list(names)
    near = [one for one in known if one.casefold() == name.casefold()]
    return near or difflib.get_close_matches(name, known, 1, cutoff)


def _same_body(given: Sequence[str], known: Sequence[str]) -> bool:
    """Return whether parts are the same but for a slip of the pen, which changes no number."""
    return len(given) == len(known) and all(
        re.sub(r"\D", "", one) == re.sub(r"\D", "", other)
        and difflib.get_close_matches(one, [other])
        for one, other in zip(given, known, strict=True)
    )


def listed(names: Sequence[str]) -> str:
    """Return the first names in quotes, and how many there are if that is not all."""
    more = f", ... ({len(names)} in all)" if len(names) > _SHOWN else ""
    return ", ".join(map(brief, names[:_SHOWN])) + more


def text(value: object, entry: str, lines: bool = False) -> str:
    """Return a name that is text, not blank, and that a file can hold, on a line or on several."""
    if not isinstance(value, str):
        raise EntryError(entry, f": {brief(value)} is not text; give a name in quotes")
    if not value.strip():
        raise EntryError(entry, f": {brief(value)} is empty; give a name")
    shown = "".join(value.split()) if lines else value
    if any(unicodedata.category(character) in _NO_TEXT for character in shown):
        raise EntryError(entry, f": {brief(value)} has a control character; give a name without")
    return value


def choice(value: object, entry: str, choices: Iterable[str]) -> str:
    """Return one of the names in `choices`."""
    names = list(choices)
    if not isinstance(value, str):
        raise EntryError(entry, f": {brief(value)} is not text; known: {listed(names)}")
    if value not in names:
        raise EntryError(entry, f": {unknown('choice', value, names)}")
    return str(value)


def members(value: Iterable[_Member], entry: str, remedy: str) -> tuple[_Member, ...]:
    """Return the members of a list, or of anything else that can be gone through."""
    found = as_list(value)
    if found is None:
        raise ModelError(f"{entry}: {brief(value)} is not a list; write {remedy}")
    return found


def as_list(value: object) -> tuple[Any, ...] | None:
    """Return the members of anything but text that can be gone through; None if it cannot.

    What an iterator raises on the way is the caller's own. An array without dimensions and a sparse
    matrix have iterators that fail.
    """
    if isinstance(value, Iterator):
        return tuple(value)
    try:
        return None if isinstance(value, str | bytes) else tuple(value)  # type: ignore[arg-type]
    except (TypeError, LookupError):
        return None


def real_array(value: object, entry: str, remedy: str) -> NDArray[np.float64]:
    """Return an array of real numbers, of any shape, as a copy."""
    with suppress(TypeError, ValueError, OverflowError):
        array = np.asarray(value)
        if array.dtype.kind in "iuf":
            return array.astype(np.float64)
    raise ModelError(f"{entry}: {brief(value)} holds no real numbers; give {remedy}")


def whole_array(value: object, entry: str, remedy: str) -> NDArray[np.int64]:
    """Return an array of whole numbers, of any shape, as a copy."""
    with suppress(TypeError, ValueError, OverflowError):
        array = np.asarray(value)
        # The empty list is one of real numbers, and tables of numbers read from text are.
        whole = array.dtype.kind == "f" and bool((array == np.rint(array)).all())
        if array.dtype.kind in "iu" or whole:
            return array.astype(np.int64)
    raise ModelError(f"{entry}: {brief(value)} holds no whole numbers; give {remedy}")


def optional_package(module: str, entry: str, package: str = "", extra: str = "fe") -> Any:
    """Return a module that not every installation has; `entry` says what needs it."""
    try:
        return import_module(module)
    except ImportError:
        raise ModelError(
            f"{entry} need the package {package or module}: pip install 'stickslip[{extra}]'"
        ) from None


def file_path(path: object, entry: str) -> Path:
    """Return the path of a file, of characters that a file name can have."""
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"{entry}: {brief(path)} is not a path; give text or a pathlib.Path")
    name = os.fspath(path)
    if not isinstance(name, str) or not name or "\0" in name:
        raise ModelError(f"{entry}: {brief(path)} is no file name; give one in quotes")
    if len(name) > _LONGEST_PATH:
        raise ModelError(
            f"{entry}: {brief(path)} cannot be read or written; give a name of at most "
            f"{_LONGEST_PATH} characters"
        )
    if any(unicodedata.category(character) == "Cc" for character in name):
        raise ModelError(f"{entry}: {brief(path)} has a control character; give a name without")
    try:
        os.fsencode(name)
    except UnicodeEncodeError:
        raise ModelError(
            f"{entry}: {brief(path)} has characters that no file name can have; give another"
        ) from None
    return Path(name)


def is_file(file: Path) -> bool:
    """Return whether there is a file to read.

    A folder is refused, and a pipe, a device or a socket, of which reading may never end.
    """
    try:
        mode = file.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError as error:
        raise ModelError(f"{brief(str(file))}: cannot be read ({error.strerror})") from None
    if stat.S_ISDIR(mode):
        raise ModelError(f"{file}: is a folder; give the name of a file in it")
    if not stat.S_ISREG(mode):
        raise ModelError(f"{file}: is a pipe, a device or a socket; give a file")
    return True


def is_reserved(name: str) -> bool:
    """Return whether Windows takes a file name for a device, whatever its ending: nul.nc."""
    return _RESERVED.fullmatch(name.partition(".")[0].strip()) is not None


def vanished(text: str, number: float) -> bool:
    """Return whether a text that does not say zero was read as zero: 1e-400."""
    return number == 0.0 and _NOT_ZERO.match(text) is not None


def real_number(value: object, entry: str, *, finite: bool = True) -> float:
    """Return a real number as a float: of Python or NumPy, or an array without dimensions."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, complex | np.complexfloating):
        raise EntryError(entry, f": {brief(value)} is complex; give a real number")
    if isinstance(value, bool) or not isinstance(value, Real):
        several = isinstance(value, list | tuple | np.ndarray)
        remedy = "a single one, no list" if several else "a real number in SI units"
        raise EntryError(entry, f": {brief(value)} is not a number; give {remedy}")
    try:
        number = float(value)
    except OverflowError:
        raise EntryError(
            entry, f": {brief(value)} is too large; give a number below 1e308"
        ) from None
    if number == 0.0 and value != 0:
        raise EntryError(entry, f": {brief(value)} is too small for a number; write 0")
    if np.isnan(number) or (finite and np.isinf(number)):
        kind = "finite number" if finite else "number"
        raise EntryError(entry, f": {number} is not a {kind}; give a real number in SI units")
    return number


def finite_complex(value: object) -> complex | None:
    """Return a finite number as a complex one; None of anything else."""
    if isinstance(value, bool) or not isinstance(value, Complex):
        return None
    with suppress(OverflowError):
        number = complex(value)
        return number if np.isfinite(number) else None
    return None


def whole_number(value: object, entry: str, *, smallest: int = 0, largest: int = MAX_COUNT) -> int:
    """Return an integer from `smallest` to `largest`; 1.0 and True are none."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise EntryError(
            entry, f": {brief(value)} is not an integer; give {smallest}, {smallest + 1}, ..."
        )
    number = int(value)
    if number < smallest:
        raise EntryError(entry, f": {brief(value)} lies below {smallest}; give at least {smallest}")
    if number > largest:
        raise EntryError(entry, f": {brief(value)} is too large; give at most {largest}")
    return number


_NO_UNITS = '; give numbers alone, in SI units, or in those that units= names: units="t-mm-s"'


def real_matrix(value: object, entry: str) -> Matrix:
    """Return a two-dimensional array of real numbers, dense, in rows, as a copy.

    Sparse matrices are made dense up to `MAX_DENSE` rows. Entries may still be infinite.
    """
    if isinstance(value, SparseMatrix):
        rows = max(value.shape)
        if rows > MAX_DENSE:
            raise ModelError(
                f"{entry}: {rows} rows are too many for dense modes (at most {MAX_DENSE}); "
                "reduce the model first (Craig-Bampton, keeping contact, force and output dofs)"
            )
        value = value.toarray()
    try:
        array = np.asarray(value)
    except ValueError:
        raise ModelError(f"{entry}: rows of unequal length; give one square table") from None
    if array.dtype.kind == "c":
        raise ModelError(
            f"{entry}: complex entries; give real matrices (put structural damping into damping)"
        )
    if array.dtype.kind not in "fiu":
        remedy = _NO_UNITS if array.dtype.kind == "U" else ""
        raise ModelError(f"{entry}: entries of type {array.dtype} are not real numbers{remedy}")
    if array.ndim != 2:
        raise ModelError(
            f"{entry}: {array.ndim} dimension(s), shape {array.shape}; give rows and columns, "
            "a diagonal as np.diag(values)"
        )
    # Long doubles beyond 1e308 become infinite, which is refused where entries are checked.
    with np.errstate(over="ignore"):
        return np.array(array, dtype=np.float64, order="C")


def require_square(
    matrix: Matrix, entry: str, size: int | None = None, other: str = ", but the mass matrix is"
) -> None:
    """Refuse a matrix that is not square, or of another size than another one is."""
    rows, columns = matrix.shape
    if rows != columns:
        raise ModelError(f"{entry}: {rows} x {columns} is not square; give N x N for N dofs")
    if size is not None and rows != size:
        raise ModelError(f"{entry}: {rows} x {columns}{other} {size} x {size}")


def require_finite(matrix: Matrix, entry: str, names: Sequence[str] | None = None) -> None:
    """Refuse a matrix with an entry that is not finite; `names` are those of its rows."""
    if not np.isfinite(matrix).all():
        row, column = np.argwhere(~np.isfinite(matrix))[0]
        one, other = (row, column) if names is None else (brief(names[row]), brief(names[column]))
        raise ModelError(
            f"{entry}: {matrix[row, column]} at ({one}, {other}); every entry must be finite"
        )


def require_keys(
    given: Iterable[str],
    entry: str,
    known: Collection[str],
    needed: Iterable[str],
    kind: str = "key",
) -> None:
    """Refuse a key that is not known, and that one is missing which is needed."""
    keys = list(given)
    for key in keys:
        if key not in known:
            raise ModelError(f"{entry}: {unknown(kind, key, known)}")
    for key in needed:
        if key not in keys:
            raise ModelError(f"{entry}: {key} is missing; give {key}")


def set_fields(owner: object, **values: object) -> None:
    """Set the fields of an immutable object; arrays become read-only."""
    for name, value in values.items():
        if isinstance(value, np.ndarray):
            constant(value)
        object.__setattr__(owner, name, value)


def constant(array: NDArray[_Scalar]) -> NDArray[_Scalar]:
    """Make an array read-only, in place, and return it."""
    array.flags.writeable = False
    return array

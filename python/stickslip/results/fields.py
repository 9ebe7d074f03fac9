"""The columns of results: each number once, with its dimensions, unit, meaning and limits.

From a column follow its array, taken over from the core and read-only, its variable in datasets and
files, the check of what a file holds, and its documentation.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields
from functools import partial
from inspect import cleandoc
from math import inf
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Generic,
    NamedTuple,
    Protocol,
    Self,
    TypeAlias,
    TypeVar,
    dataclass_transform,
    overload,
)

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import set_fields
from stickslip.results.dataset import Stored

Bool: TypeAlias = NDArray[np.bool_]
Code: TypeAlias = NDArray[np.uint8]
Complex: TypeAlias = NDArray[np.complex128]
Float: TypeAlias = NDArray[np.float64]
Int: TypeAlias = NDArray[np.int64]
Numbers: TypeAlias = NDArray[Any]
"""Real or complex."""
Array = TypeVar("Array", covariant=True)

_TYPES: Mapping[str, tuple[type[np.generic], ...]] = {
    "Bool": (np.bool_,),
    "Code": (np.uint8,),
    "Complex": (np.complex128,),
    "Float": (np.float64,),
    "Int": (np.int64,),
    "Numbers": (np.float64, np.complex128),
}
"""Types of the entries, by the annotation of a column."""


Absent: TypeAlias = float | str | Callable[[Stored], NDArray[Any]]
"""What stands for a column that older files do not have."""


class _Column(NamedTuple):
    """What is known of a column; see `column`."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    least: float
    most: float | str
    file_name: str | None
    codes: Sequence[str]
    absent: Absent | None
    optional: bool


class Computed(Protocol):
    """What the core returns: arrays by name."""

    @property
    def columns(self) -> Mapping[str, NDArray[Any]]: ...  # noqa: D102


def column(
    dims: str,
    unit: str,
    meaning: str,
    *,
    least: float = -inf,
    most: float | str = inf,
    file_name: str | None = None,
    codes: Iterable[str] = (),
    absent: Absent | None = None,
    optional: bool = False,
) -> Any:
    """Return a field of `Columns`.

    Parameters
    ----------
    dims : str
        Names of the dimensions, by spaces; ``*`` stands for `Columns.along`.
    unit, meaning : str
        What datasets say; ``{name}`` in braces stands for a word of the result, see `Result.words`.
    least, most : float, optional
        Between which the entries of files lie; not-a-number is allowed where there are fractions.
        `most` may be a dimension in which they are positions.
    file_name : str, optional
        Name of the variable. Default: that of the field.
    codes : iterable of str, optional
        What the entries stand for, counted from 0.
    absent : float, str or callable, optional
        What all entries of an older file without the variable are, a number or one of the codes; or
        what makes them of its other variables.
    optional : bool, optional
        Whether the first dimension may be missing.
    """
    names = tuple(codes)
    low, high = (0.0, len(names) - 1.0) if names else (least, most)
    entry = _Column(
        tuple(dims.split()), unit, meaning, low, high, file_name, names, absent, optional
    )
    return field(metadata={"column": entry})


@dataclass_transform(
    eq_default=False, frozen_default=True, kw_only_default=True, field_specifiers=(column,)
)
class Columns:
    """The numbers of a kind of result, as read-only arrays.

    A subclass names its columns and nothing else:
    ``amplitude: Float = column("value", "m", "amplitude of the peak", least=0.0)``.
    """

    prefix: ClassVar[str] = ""
    """Put before the names in files."""
    along: ClassVar[str] = ""
    """The dimension that columns call ``*``."""
    labels: ClassVar[Mapping[str, Sequence[str]]] = MappingProxyType({})
    """Names along dimensions."""

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __init_subclass__(cls) -> None:
        dataclass(frozen=True, eq=False, kw_only=True)(cls)
        listed = "\n".join(f"{name} : {_shape(cls, name)}" for name in cls.table())
        cls.__doc__ = f"{cleandoc(cls.__doc__ or '')}\n\nAttributes\n----------\n{listed}"

    def __post_init__(self) -> None:
        for name in self.table():
            set_fields(self, **{name: np.ascontiguousarray(getattr(self, name))})

    def __reduce__(self) -> tuple[Callable[[], Self], tuple[()]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        values = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        return partial(type(self), **values), ()

    @classmethod
    def table(cls) -> dict[str, _Column]:
        """Return what is known of every column."""
        known = cls.__dataclass_fields__.items()
        entries = {name: one.metadata["column"] for name, one in known if "column" in one.metadata}
        dims = {"*": cls.along}
        return {
            name: entry._replace(dims=tuple(dims.get(one, one) for one in entry.dims))
            for name, entry in entries.items()
        }

    @classmethod
    def of(cls, solution: Computed, **more: NDArray[Any]) -> Self:
        """Take over what the core returns, with further columns, or others in their place."""
        given = {**solution.columns, **more}
        return cls(**{name: given[name] for name in cls.table()})

    def variables(self, words: Mapping[str, str] = MappingProxyType({})) -> dict[Hashable, Any]:
        """Return the variables of a dataset, as copies."""
        made: dict[Hashable, Any] = {}
        for name, entry in self.table().items():
            values = getattr(self, name).copy()
            about: dict[str, Any] = {
                "units": entry.unit.format_map(words),
                "long_name": entry.meaning.format_map(words),
            }
            if entry.codes:
                about |= {
                    "flag_values": np.arange(len(entry.codes), dtype=values.dtype),
                    "flag_meanings": " ".join(code.replace(" ", "_") for code in entry.codes),
                }
            dims = entry.dims[len(entry.dims) - values.ndim :]
            made[self.prefix + (entry.file_name or name)] = (dims, values, about)
        return made

    @classmethod
    def read(cls, dataset: Stored, **more: Any) -> Self:
        """Return the columns that a dataset holds, with fields that are no columns.

        A variable that is missing is a KeyError; other dimensions, or numbers that no result has,
        as a negative frequency or the blade 99999, are a ValueError.
        """
        arrays: dict[str, Any] = {}
        for name, entry in cls.table().items():
            kinds = _TYPES[str(cls.__dataclass_fields__[name].type)]
            stored = cls.prefix + (entry.file_name or name)
            # xarray would count the entries of a dimension without numbers.
            if stored in dataset.variables:
                variable = dataset[stored]
                dims = tuple(map(str, variable.dims))
                if dims != entry.dims and not (entry.optional and dims == entry.dims[1:]):
                    raise ValueError(f"{stored} has dimensions {dims} instead of {entry.dims}")
                _require(stored, variable.values, entry, kinds, dataset.sizes)
                arrays[name] = variable.values
            elif entry.absent is not None:
                arrays[name] = _stand_in(entry, entry.absent, kinds[0], dataset)
            else:
                raise KeyError(stored)
        return cls(**arrays, **more)


class Shown(Generic[Array]):
    """A column of a result as its attribute: ``omega = Shown[Float]()``.

    Parameters
    ----------
    name : str, optional
        The column. Default: that of the name of the attribute.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name

    def __set_name__(self, owner: Any, name: str) -> None:
        self.name = self.name or name

    def document(self, columns: type[Columns]) -> None:
        """Say what the column says."""
        self.__doc__ = _about(columns, self.name)

    @overload
    def __get__(self, result: None, owner: Any) -> Self: ...
    @overload
    def __get__(self, result: object, owner: Any) -> Array: ...
    def __get__(self, result: Any, owner: Any) -> Any:
        return self if result is None else getattr(result.arrays, self.name)


def _shape(cls: type[Columns], name: str) -> str:
    kind = _TYPES[str(cls.__dataclass_fields__[name].type)][0].__name__
    dims = ", ".join(cls.table()[name].dims)
    return f"ndarray of {kind}, shape ({dims})\n    {_about(cls, name)}"


def _about(cls: type[Columns], name: str) -> str:
    entry = cls.table()[name]
    unit = "" if entry.unit == "1" or "{" in entry.unit else f" [{entry.unit}]"
    return f"{entry.meaning[0].upper()}{entry.meaning[1:]}{unit}."


def _stand_in(
    entry: _Column, absent: Absent, kind: type[np.generic], dataset: Stored
) -> NDArray[Any]:
    """Return the entries of a column that an older file does not have."""
    if callable(absent):
        return absent(dataset)
    value = entry.codes.index(absent) if isinstance(absent, str) else absent
    return np.full([dataset.sizes[name] for name in entry.dims], value, kind)


def _require(
    name: str,
    values: NDArray[Any],
    entry: _Column,
    kinds: tuple[type[np.generic], ...],
    sizes: Mapping[Hashable, int],
) -> None:
    """Refuse entries of another type, or outside the limits."""
    if values.dtype not in kinds:
        raise ValueError(f"{name} holds {values.dtype.name} instead of {kinds[0].__name__}")
    if values.dtype.kind == "c":
        return
    most = sizes.get(entry.most, 0) - 1 if isinstance(entry.most, str) else entry.most
    outside = values[(values < entry.least) | (values > most)]
    if outside.size and entry.codes:
        raise ValueError(f"{name} {outside.flat[0]} is unknown")
    if outside.size:
        raise ValueError(f"{name} = {outside.flat[0]:.6g}, outside {entry.least:g} to {most:g}")

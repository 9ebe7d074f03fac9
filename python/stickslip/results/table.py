"""Tidy tables of a dataset: one row per place along its dimensions, one column per quantity.

Variables with the same dimensions make one table, so that a further column of a result is a further
column of its tables. What stands along one of these dimensions only, as the status of a point of a
curve, is repeated in every row to which it belongs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.results.dataset import Dataset

if TYPE_CHECKING:
    import pandas as pd

Frame: TypeAlias = "pd.DataFrame"
"""Of pandas, which takes long to load."""

SINGLE = "values"
"""The table of what has no dimension."""


class Tables(Mapping[str, Frame]):
    """The tables of a dataset by their names, the dimensions with hyphens: "omega-dof".

    Each is made when it is asked for.
    """

    def __init__(self, dataset: Dataset) -> None:
        self._dataset = dataset
        several = {tuple(map(str, variable.dims)): None for variable in dataset.data_vars.values()}
        self._dims = {"-".join(dims) or SINGLE: dims for dims in several}

    def __iter__(self) -> Iterator[str]:
        return iter(self._dims)

    def __len__(self) -> int:
        return len(self._dims)

    def __getitem__(self, name: str) -> Frame:
        return _frame(self._dataset, self._dims[name])

    def holding(self, variable: str) -> str:
        """Return the name of the table of a variable; without such a variable the first table."""
        if variable not in self._dataset.data_vars:
            return next(iter(self._dims))
        return "-".join(map(str, self._dataset[variable].dims)) or SINGLE

    def rows(self, name: str) -> int:
        """Return the number of rows of a table."""
        return int(np.prod([self._dataset.sizes[one] for one in self._dims[name]], dtype=np.int64))


class Family(Tables):
    """The tables of results along a parameter, one below the other, with its value in front."""

    def __init__(
        self, members: Sequence[Tables], parameter: str, unit: str, values: Sequence[float]
    ) -> None:
        self._members, self._values = members, values
        self._parameter, self._unit = parameter, unit

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(name for member in self._members for name in member))

    def __len__(self) -> int:
        return len(list(iter(self)))

    def __getitem__(self, name: str) -> Frame:
        import pandas as pd

        frames = []
        for value, member in zip(self._values, self._members, strict=True):
            if name in member:
                frame = member[name]
                taken = self._parameter in frame
                parameter = f"swept_{self._parameter}" if taken else self._parameter
                frame.insert(0, parameter, value)
                frames.append(frame)
        if not frames:
            raise KeyError(name)
        units, meanings = (frames[0].attrs[told] for told in ("units", "meanings"))
        whole = pd.concat(frames, ignore_index=True)
        whole.attrs = {
            "units": {parameter: self._unit, **units},
            "meanings": {parameter: self._parameter.replace("_", " "), **meanings},
        }
        return whole

    def holding(self, variable: str) -> str:
        """Return the name of the table of a variable; without such a variable the first table."""
        return self._members[0].holding(variable)

    def rows(self, name: str) -> int:
        """Return the number of rows of a table."""
        return sum(member.rows(name) for member in self._members if name in member)


def _frame(dataset: Dataset, dims: tuple[str, ...]) -> Frame:
    """Return the table of the variables with these dimensions."""
    import pandas as pd

    shape = tuple(dataset.sizes[name] for name in dims)
    columns: dict[str, NDArray[Any]] = {}
    units: dict[str, str] = {}
    meanings: dict[str, str] = {}

    def add(name: str, values: NDArray[Any], unit: str, meaning: str) -> None:
        columns[name], units[name], meanings[name] = values.reshape(-1), unit, meaning

    for name in (*dims, *_variables(dataset, dims)):
        if name not in dataset.variables:
            axis = dims.index(name)
            places = _along(np.arange(shape[axis]), axis, shape)
            add(name, places, "1", f"position along {name}, counted from 0")
            continue
        variable = dataset[name]
        unit, meaning = variable.attrs["units"], variable.attrs["long_name"]
        values = _in_words(variable.values, variable.attrs)
        if variable.dims != dims:
            values = _along(values, dims.index(str(variable.dims[0])), shape)
        if values.dtype.kind == "c":
            add(f"{name}_real", values.real, unit, f"real part of the {meaning}")
            add(f"{name}_imag", values.imag, unit, f"imaginary part of the {meaning}")
        else:
            add(name, values, unit, meaning)
    frame = pd.DataFrame(columns)
    frame.attrs |= {"units": units, "meanings": meanings}
    return frame


def _variables(dataset: Dataset, dims: tuple[str, ...]) -> list[str]:
    """Return what is in a table beside its dimensions: lists along one of them, its own numbers."""
    lists = [
        str(name)
        for one in dims
        for name, variable in dataset.variables.items()
        if variable.dims == (one,) and name not in dims
    ]
    own = [str(name) for name, variable in dataset.data_vars.items() if variable.dims == dims]
    return list(dict.fromkeys(lists + own))


def _along(values: NDArray[Any], axis: int, shape: tuple[int, ...]) -> NDArray[Any]:
    """Return a list repeated along all dimensions but its own."""
    own = [1] * len(shape)
    own[axis] = -1
    return np.broadcast_to(values.reshape(own), shape)


def _in_words(values: NDArray[Any], about: Mapping[str, Any]) -> NDArray[Any]:
    """Return codes as the words that they stand for, and everything else as it is."""
    if "flag_meanings" not in about:
        return values
    words = dict(zip(about["flag_values"].tolist(), about["flag_meanings"].split(), strict=True))
    return np.array([words[code] for code in values.ravel().tolist()], np.str_).reshape(
        values.shape
    )

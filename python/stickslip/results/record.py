"""What a dataset of xarray holds, without xarray, which takes long to load."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr


class Variable(NamedTuple):
    """Numbers or texts with the names of their dimensions, and what is said of them."""

    dims: tuple[str, ...]
    values: NDArray[Any]
    attrs: Mapping[str, Any]

    @classmethod
    def of(cls, dims: str | tuple[str, ...], values: object, about: Any = None) -> Self:
        """Return a variable of what xarray makes one of: dimensions, values, attributes."""
        return cls(
            (dims,) if isinstance(dims, str) else tuple(dims), np.asarray(values), about or {}
        )


@dataclass(frozen=True)
class Record:
    """Variables by name, with attributes of the whole; read like a dataset of xarray.

    Attributes
    ----------
    variables : mapping of Variable
        The numbers. A variable that has the name of its only dimension is its coordinate.
    attrs : mapping
        What is said of all.
    coordinates : frozenset of str
        Further variables that are coordinates.
    """

    variables: Mapping[str, Variable] = field(default_factory=dict)
    attrs: Mapping[str, Any] = field(default_factory=dict)
    coordinates: frozenset[str] = frozenset()

    def __getitem__(self, name: str) -> Variable:
        if name not in self.variables:
            raise KeyError(f"No variable named {name!r}")
        return self.variables[name]

    def __contains__(self, name: object) -> bool:
        return name in self.variables

    def __iter__(self) -> Iterator[str]:
        return iter(self.variables)

    @property
    def sizes(self) -> Mapping[Hashable, int]:
        """Length of every dimension, in the order of their first use."""
        found: dict[Hashable, int] = {}
        for name, (dims, values, _) in self.variables.items():
            for dim, size in zip(dims, values.shape, strict=True):
                if found.setdefault(dim, size) != size:
                    raise ValueError(f"{name} has {size} entries of {dim!r}, others {found[dim]}")
        return found

    def assign(self, variables: Mapping[Any, Any]) -> Record:
        """Return the record with further variables, or others in their place."""
        made = {str(name): Variable.of(*one) for name, one in variables.items()}
        return replace(self, variables={**self.variables, **made})

    def assign_coords(self, variables: Mapping[Any, Any]) -> Record:
        """Return the record with further variables that are coordinates."""
        named = self.coordinates | {str(name) for name in variables}
        return replace(self.assign(variables), coordinates=named)

    def assign_attrs(self, attrs: Mapping[str, Any]) -> Record:
        """Return the record with further attributes."""
        return replace(self, attrs={**self.attrs, **attrs})

    def to_dataset(self) -> xr.Dataset:
        """Return it as a dataset of xarray."""
        import xarray as xr

        return xr.Dataset(dict(self.variables), attrs=self.attrs).set_coords(self.coordinates)

"""What datasets hold, without xarray, which takes long to load, and names along dimensions."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.model import Model

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

    A variable that has the name of its only dimension is its coordinate; further ones are
    `coordinates`.
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


Dataset: TypeAlias = "xr.Dataset"
"""Of xarray, which takes long to load."""
Stored: TypeAlias = "xr.Dataset | Record"
"""What results are read from."""
Coordinate: TypeAlias = tuple[str, NDArray[np.generic], dict[str, str]]


def require_fit(dataset: Stored, model: Model, states: Sequence[str]) -> tuple[str, ...]:
    """Return the observed dofs of a dataset, or refuse one that belongs to another model."""
    for dimension, noun, names in (
        ("point", "contact points in the arrays", displacement_names(model)),
        ("state_entry", "entries per state", states),
    ):
        size = dataset.sizes.get(dimension, len(names))
        if size != len(names):
            raise ValueError(f"{size} {noun}, {len(names)} in the model")
    dofs = tuple(map(str, dataset["dof"].values))
    for dof in dofs:
        model.structure.index(dof)
    return dofs


def labels(dimension: str, values: object, meaning: str) -> Coordinate:
    """Return a coordinate of texts."""
    return dimension, np.array(values, dtype=np.str_), {"units": "1", "long_name": meaning}


def point_names(model: Model) -> list[str]:
    """Return a name for every contact point: that of its contact, numbered if it has several."""
    return _numbered(model, [contact.points for contact in model.contacts])


def displacement_names(model: Model) -> list[str]:
    """Return a name for every relative displacement: that of its point, with its component."""
    parts = [one.components for one in model.contacts for _ in range(one.points)]
    named = zip(point_names(model), parts, strict=True)
    return [f"{name}.{part}" if part else name for name, own in named for part in own or [""]]


def slider_names(model: Model) -> list[str]:
    """Return a name for every part that sticks or slips by itself, with its direction."""
    counts = [one.sliders for one in model.contacts]
    parts = [one.components[: one.tangential] for one in model.contacts for _ in range(one.sliders)]
    named = zip(_numbered(model, counts), parts, strict=True)
    return [f"{name}.{part}" if part else name for name, own in named for part in own or [""]]


def _numbered(model: Model, counts: Sequence[int]) -> list[str]:
    return [
        name if count == 1 else f"{name}[{position}]"
        for name, count in zip(model.contact_names, counts, strict=True)
        for position in range(count)
    ]


def state_names(model: Model) -> list[str]:
    """Return a name for every entry of a state: displacements, velocities, forces, reversals."""
    dofs = model.structure.dofs
    moved = [f"{letter} {dof}" for letter in "xv" for dof in dofs]
    sliders = iter(slider_names(model))
    names = []
    for name, one in zip(model.contact_names, model.contacts, strict=True):
        own = [f"f {next(sliders)}" for _ in one.slider_limits]
        reversals = [f"r {name}[{place}]" for place in range(len(one.remembered))]
        names += own if len(own) == len(reversals) else reversals
    return moved + names

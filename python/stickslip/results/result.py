"""What every result has: its model, its degrees of freedom, and what was assumed."""

from __future__ import annotations

import json
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import fields
from functools import partial
from os import PathLike
from types import MappingProxyType
from typing import Any, ClassVar, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.checks import constant, text, unknown
from stickslip.drawn import InNotebooks
from stickslip.errors import ModelError
from stickslip.model import Model, PointRef
from stickslip.results.dataset import (
    Dataset,
    Record,
    Stored,
    displacement_names,
    labels,
    require_fit,
    state_names,
)
from stickslip.results.diagnostic import Diagnostic, from_attributes, to_json
from stickslip.results.documented import Frozen
from stickslip.results.fields import Columns, Float, Shown
from stickslip.results.table import Frame, Tables
from stickslip.settings.settings import Settings

Kind = TypeVar("Kind", bound=np.generic)
Attributes: TypeAlias = Mapping[str, Callable[[Any], object]]
"""Attributes of a result that are attributes of its dataset, with their types."""


_NUMBERED = {"harmonic": "multiple of omega", "pattern": "number of the pattern"}
"""Dimensions along which positions are counted, with the meaning of the number."""

_LABELLED = {
    "side": "end of the range",
    "turn_entry": "entry of the place",
    "mode_entry": "frequency and damping",
}
"""Dimensions that have `Columns.labels`, with the meaning of a label."""


class Result(Frozen, InNotebooks, ABC):
    """A computed motion: immutable, with what it belongs to and what it took for granted.

    A further kind of result is a subclass of `ColumnResult` and a line in
    `stickslip.results.store.KINDS`; `to_dataset`, `save` and `load` then work.

    Attributes
    ----------
    model : Model
        What was computed.
    dofs : tuple of str
        The observed degrees of freedom.
    interrupted : bool
        Whether the run was stopped before its end.
    timings : mapping of float
        Seconds by stage.
    counters : mapping of int
        Evaluations by kind.
    diagnostics : tuple of Diagnostic
        What was taken for granted, what puts the numbers in doubt, and what is missing.
    """

    kind: ClassVar[str]
    """Name of this kind of result in files."""
    headline: ClassVar[str] = ""
    """Variable whose table is the main one; by default the first of the dataset."""

    model: Model
    dofs: tuple[str, ...]
    interrupted: bool
    timings: Mapping[str, float]
    counters: Mapping[str, int]
    diagnostics: tuple[Diagnostic, ...]

    def __post_init__(self) -> None:
        for name in ("timings", "counters"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def assumptions(self) -> tuple[str, ...]:
        """The texts of the diagnostics."""
        return tuple(one.text for one in self.diagnostics)

    def __reduce__(self) -> tuple[Callable[[], Self], tuple[()]]:
        # What is only kept to save time stays behind, and a mapping proxy cannot be pickled.
        values = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        values |= {"timings": dict(self.timings), "counters": dict(self.counters)}
        return partial(type(self), **values), ()

    @abstractmethod
    def record(self, *, derived: bool = True) -> Record:
        """Return everything, of which `to_dataset` is the dataset."""

    def to_dataset(self, *, derived: bool = True) -> Dataset:
        """Return everything as an xarray dataset with units on every variable.

        Numbers as variables, everything else as attributes; all numbers are copies.

        Parameters
        ----------
        derived : bool, optional
            Whether to add what follows from the other variables, as amplitudes.
        """
        return self.record(derived=derived).to_dataset()

    @classmethod
    @abstractmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the result that a dataset holds.

        Equal to the one that made the dataset, bit by bit.

        Parameters
        ----------
        dataset : xarray.Dataset
            As `to_dataset` makes it; derived variables are not needed.
        model : Model
            What was computed.

        Raises
        ------
        KeyError, ValueError
            If the dataset is incomplete, or belongs to another model.
        """

    def save(self, path: str | PathLike[str]) -> None:
        """Write the result with its model to a NetCDF file, whole or not at all.

        Raises ModelError if the file cannot be written.

        Parameters
        ----------
        path : path-like
            The file; an existing one is replaced. Read it with `stickslip.load`.
        """
        from stickslip.results.store import save

        save(path, self.kind, self.record(derived=False), self.model)

    def tables(self) -> Tables:
        """Return the numbers as tidy tables by name, each a pandas DataFrame.

        Variables with the same dimensions make one table, of which these are the name: "omega-dof"
        has one row per frequency and degree of freedom. Complex numbers are two columns, codes are
        words. ``attrs["units"]`` and ``attrs["meanings"]`` of a table tell of its columns.
        """
        return Tables(self.to_dataset())

    def to_pandas(self, table: str | None = None) -> Frame:
        """Return one of the `tables` as a pandas DataFrame.

        Parameters
        ----------
        table : str, optional
            Its name. Default: that of the main numbers, as the amplitudes of a curve.

        Raises
        ------
        ModelError
            If there is no such table.
        """
        from stickslip.results.export import table_of

        tables = self.tables()
        return tables[table_of(self, tables, table)]

    def export(self, path: str | PathLike[str], table: str | None = None) -> None:
        """Write the numbers for another program, whole or not at all.

        The ending says for which: `.csv` and `.parquet` hold one of the `tables`, `.xlsx` all of
        them as sheets, with units in the headers; `.mat` (MATLAB) holds the variables of
        `to_dataset` as arrays; `.uff` and `.unv` (Universal Files) the receptances of a forced
        response. Files of `save` alone can be loaded again. Parquet needs the package pyarrow,
        Excel XlsxWriter, Universal Files pyuff.

        Parameters
        ----------
        path : path-like
            The file; an existing one is replaced.
        table : str, optional
            The table. Default: as of `to_pandas`, of Excel all of them.

        Raises
        ------
        ModelError
            If the format or the table is unknown, cannot hold the result, or needs a package that
            is missing, or the file cannot be written.
        """
        from stickslip.results.export import export

        export(self, path, table)

    def locate(self, contact: PointRef) -> tuple[int, int | None]:
        """Return the position of a contact, and of its point; None for the whole contact."""
        if isinstance(contact, tuple | list):
            return self.model.point(contact)
        return self.model.contact_index(contact), None

    def _column(self, dof: str) -> int:
        if text(dof, "dof") in self.dofs:
            return self.dofs.index(dof)
        if dof in self.model.structure.dofs:
            raise ModelError(f"dof {dof!r}: it was not observed; add it to observe and run again")
        raise ModelError(unknown("dof", dof, self.dofs))

    def _columns(self, contact: int, point: int | None) -> slice:
        """Return where the displacements of a contact, or of one of its points, stand in arrays."""
        start = sum(one.displacements for one in self.model.contacts[:contact])
        own = self.model.contacts[contact]
        first, end, _ = own.place(point).indices(own.displacements)
        return slice(start + first, start + end)

    def _select(self, values: NDArray[Kind], contact: PointRef) -> NDArray[Kind]:
        """Return what belongs to the displacements of a contact: see `Contact.shape`."""
        number, point = self.locate(contact)
        return self._shaped(values[..., self._columns(number, point)], number, point)

    def _with_balanced(self, forces: Float, contact: PointRef) -> Float:
        """Return forces of a contact, in its shape, with what is in balance without motion."""
        number, point = self.locate(contact)
        own = self.model.contacts[number]
        if not own.components:
            return forces
        rest = self._shaped(own.balanced[own.place(point)], number, point)
        return constant(forces + rest)

    def _shaped(self, values: NDArray[Kind], contact: int, point: int | None) -> NDArray[Kind]:
        """Return displacements side by side in the shape of their contact, or of its point."""
        own = self.model.contacts[contact]
        if point is None:
            return values.reshape(*values.shape[:-1], *own.shape)
        return values if own.components else values[..., 0]


class ColumnResult(Result):
    """A result whose numbers are columns, from which its dataset and its file follow.

    A kind of result annotates `settings` and `arrays` with their classes.

    Attributes
    ----------
    settings : Settings
        How it was computed.
    arrays : Columns
        Every number by its name.
    """

    title: ClassVar[str]
    """What datasets of this kind are called."""
    columns: ClassVar[type[Columns]]
    """The columns of this kind."""
    settings_class: ClassVar[type[Settings]]
    """The class of its settings."""
    attributes: ClassVar[Attributes] = {"interrupted": bool}

    settings: Settings
    arrays: Columns

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        known = vars(sys.modules[cls.__module__])
        for name, derived in (("arrays", "columns"), ("settings", "settings_class")):
            if cls.__annotations__.get(name) in known:
                setattr(cls, derived, known[cls.__annotations__[name]])
        for one in vars(cls).values():
            if isinstance(one, Shown):
                one.document(cls.columns)

    @classmethod
    def of(cls, solution: object, **given: Any) -> Self:
        """Return a result with the attributes, timings and counters that the core tells."""
        names = {"timings", "counters", *cls.attributes} - set(given)
        return cls(**{name: getattr(solution, name) for name in names}, **given)

    def record(self, *, derived: bool = True) -> Record:
        """Return everything, of which `to_dataset` is the dataset.

        The columns of `arrays` are the variables, with names along their dimensions; everything
        else are attributes, of which `settings`, `diagnostics`, `timings` and `counters` are JSON
        texts.
        """
        variables = self.arrays.variables(self._words()) | self._further_variables(derived=derived)
        made = Record(attrs=_attributes(self)).assign(variables)
        half_wave = bool(getattr(self, "half_wave", False))
        states = self._states(self.model, half_wave=half_wave)
        return made.assign_coords(_coordinates(self, made.sizes, states))

    @classmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the result that a dataset holds."""
        told = dataset.attrs
        states = cls._states(model, half_wave=bool(told.get("half_wave", False)))
        arguments: dict[str, Any] = {name: of(told[name]) for name, of in cls.attributes.items()}
        return cls(
            model=model,
            arrays=cls.columns.read(dataset),
            dofs=require_fit(dataset, model, states),
            settings=_settings_of(cls, dataset),
            timings=json.loads(told["timings"]),
            counters=json.loads(told["counters"]),
            diagnostics=from_attributes(told),
            **arguments,
            **cls._further_arguments(dataset),
        )

    @classmethod
    def _states(cls, model: Model, *, half_wave: bool) -> list[str]:
        """Return a name for every entry of a state."""
        return state_names(model)

    def _words(self) -> Mapping[str, str]:
        """Return the words that units and meanings of columns leave open."""
        return {}

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        """Return the variables that are no columns, with or without those that can be derived."""
        return {}

    def _amplitude_variable(
        self, amplitude: Callable[[str], Float], along: str = "", of: str = "of the displacement"
    ) -> dict[Hashable, Any]:
        """Return the amplitudes of the observed degrees of freedom as a variable."""
        values = np.stack([amplitude(dof) for dof in self.dofs], axis=1)
        about = {"units": "m", "long_name": f"half peak-to-peak amplitude {of}"}
        return {"amplitude": ((along or self.arrays.along, "dof"), values, about)}

    @classmethod
    def _further_arguments(cls, dataset: Stored) -> dict[str, Any]:
        """Return what `_further_variables` wrote and cannot be derived."""
        return {}


def _attributes(result: ColumnResult) -> dict[str, object]:
    """Return what every dataset says of its result, tables as JSON texts."""
    return {
        "title": result.title,
        "Conventions": "CF-1.11",
        "stickslip_version": _core.__version__,
        "settings": json.dumps(result.settings.model_dump()),
        "diagnostics": to_json(result.diagnostics),
        "timings": json.dumps(dict(result.timings)),
        "counters": json.dumps(dict(result.counters)),
        # NetCDF has no truth values.
        **{name: 1 * getattr(result, name) for name in result.attributes},
    }


def _settings_of(kind: type[ColumnResult], dataset: Stored) -> Settings:
    """Return the settings that `attributes` wrote."""
    values = json.loads(dataset.attrs["settings"])
    if values.get("samples", 0) is None:
        # The first files had no name for what is automatic.
        values["samples"] = "auto"
    if "span" in set(kind.settings_class.model_fields) - set(values):
        # No default stands for the frequencies of a result.
        raise KeyError("span")
    return kind.settings_class.stored(values)


def _coordinates(
    result: ColumnResult, sizes: Mapping[Hashable, int], states: Sequence[str]
) -> dict[str, Any]:
    """Return the names along the dimensions of a dataset."""
    model = result.model
    made: dict[str, Any] = {"dof": labels("dof", result.dofs, "observed degree of freedom")}
    for dimension, meaning in _NUMBERED.items():
        if dimension in sizes:
            about = {"units": "1", "long_name": meaning}
            made[dimension] = (dimension, np.arange(sizes[dimension]), about)
    if "point" in sizes:
        owners = [
            name
            for name, contact in zip(model.contact_names, model.contacts, strict=True)
            for _ in range(contact.displacements)
        ]
        made["point"] = labels(
            "point", displacement_names(model), "contact point, with the component if it has some"
        )
        made["contact"] = labels("point", owners, "contact of the point")
    if "state_entry" in sizes:
        made["state_entry"] = labels("state_entry", states, "entry of the state")
    for dimension, names in result.arrays.labels.items():
        made[dimension] = labels(dimension, names, _LABELLED[dimension])
    return made

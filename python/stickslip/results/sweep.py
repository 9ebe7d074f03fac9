"""Results along a parameter of the model, as one."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from typing import Any, ClassVar, Self

import numpy as np

from stickslip import _core
from stickslip.checks import constant
from stickslip.drawn import Axes, Drawn, plots
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.dataset import Dataset, Record, Stored, Variable
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.fields import Float
from stickslip.results.result import Result
from stickslip.results.stored_model import model_of, model_variables
from stickslip.results.table import Family, Tables
from stickslip.settings.sweep import SweepSettings
from stickslip.units import physical_number

_SEVERAL = ("curves", "damper", "limit_cycles", "backbone")
"""Figures of several results."""
_NAMED = 3
"""So many results at most are named by their values."""


class Sweep(Result):
    """The results of one analysis along a parameter of the model: slip force, preload, speed.

    Attributes
    ----------
    results : tuple of Result
        One per value, each with its own model.
    settings : SweepSettings
        The parameter, its unit and its values.
    """

    kind: ClassVar[str] = "sweep"

    settings: SweepSettings
    results: tuple[Result, ...]

    def __repr__(self) -> str:
        values, of = self.values, type(self.results[0]).__name__
        return (
            f"Sweep({values.size} values of {self.parameter} from {values.min():g} to "
            f"{values.max():g} {self.unit}".removesuffix(" 1")
            + f", a {of} each)"
        )

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.settings.parameter

    @property
    def unit(self) -> str:
        """Unit of the parameter."""
        return self.settings.unit

    @cached_property
    def values(self) -> Float:
        """Values of the parameter, shape (n,)."""
        return constant(np.array(self.settings.values[: len(self.results)]))

    @property
    def labels(self) -> tuple[str, ...]:
        """What tells the results from one another, "preload = 120 N"."""
        return tuple(f"{self.parameter.replace('_', ' ')} = {text}" for text in self.written)

    @property
    def written(self) -> tuple[str, ...]:
        """The values with their unit; of a speed in rpm."""
        return _written(self.settings, len(self.results))

    @property
    def drawn_together(self) -> bool:
        """Whether a figure shows all results, as response curves."""
        return _figure_of(self.results[0]) in _SEVERAL

    def at(self, value: float | str) -> Result:
        """Return the result at the value nearest to one.

        Parameters
        ----------
        value : float or str
            The value in the sweep's `unit`, of a speed in rad/s; or a text with its unit, as
            "3000 rpm".

        Raises
        ------
        ModelError
            If it lies beyond all values by more than half of the widest step between them.
        """
        near = physical_number(value, "" if self.unit == "1" else self.unit, "value")
        distances, steps = np.abs(self.values - near), np.abs(np.diff(np.sort(self.values)))
        nearest = int(distances.argmin())
        if distances[nearest] > 0.5 * steps.max(initial=0.0 if steps.size else abs(near)):
            raise ModelError(
                f"value: {near:g} lies outside the sweep, whose nearest is {self.labels[nearest]}; "
                "give a value within, in SI units or with its unit"
            )
        return self.results[nearest]

    def plot(self, *args: Any, **options: Any) -> Axes:
        """Draw the family of curves; the arguments are those of the results' own `plot`."""
        name = _figure_of(self.results[0])
        if not self.drawn_together:
            raise ModelError(
                f"plot: results of kind {self.results[0].kind.replace('_', ' ')} are drawn one at "
                "a time; write sweep.results[0].plot(...)"
            )
        options.setdefault("labels", self.labels)
        drawn: Axes = getattr(plots, name)(list(self.results), *args, **options)
        return drawn

    def to_dataset(self, *, derived: bool = True) -> Dataset:
        """Return the numbers along the parameter, a dimension with its values and its unit.

        Results with frequencies of their own are put side by side: the dimension is then
        "position", and "omega" a variable. Of shorter results what is missing is not-a-number, so
        that whole numbers and codes along such dimensions are floating-point numbers.
        """
        return self._family() if derived else self.record().to_dataset()

    def tables(self) -> Tables:
        """Return the tables of all results, one below the other, the parameter in front."""
        members = [one.tables() for one in self.results]
        return Family(members, self.parameter, self.unit, self.values.tolist())

    @property
    def headline(self) -> str:  # type: ignore[override]
        """Variable whose table is the main one: that of the results."""
        return self.results[0].headline

    def _family(self) -> Dataset:
        import xarray as xr

        members = [one.to_dataset() for one in self.results]
        coordinate = xr.Variable(
            self.parameter,
            self.values,
            {"units": self.unit, "long_name": self.parameter.replace("_", " ")},
        )
        family = xr.concat(
            _aligned(members),
            dim=self.parameter,
            data_vars="all",
            coords="minimal",
            compat="override",
            join="outer",
            combine_attrs="drop_conflicts",
        )
        return family.assign_coords({self.parameter: coordinate})

    def record(self, *, derived: bool = False) -> Record:
        """Return all members with their models, each under names of its own."""
        whole = Record(
            attrs={
                "title": "Results along a parameter of the model",
                "stickslip_version": _core.__version__,
                "settings": json.dumps(self.settings.model_dump()),
                "interrupted": int(self.interrupted),
                "member_kind": self.results[0].kind,
            }
        )
        for number, member in enumerate(self.results):
            own = member.record(derived=derived).assign(model_variables(member.model))
            told = json.dumps({str(key): _plain(value) for key, value in own.attrs.items()})
            prefix = _prefix(number)
            whole = whole.assign(
                {
                    prefix + name: (tuple(prefix + dim for dim in one.dims), *one[1:])
                    for name, one in own.assign({"attributes": ((), told)}).variables.items()
                }
            )
        return whole

    @classmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the sweep that a dataset holds."""
        from stickslip.results.store import KINDS

        module, name = KINDS[dataset.attrs["member_kind"]]
        kind = getattr(import_module(module), name)
        settings = SweepSettings.stored(json.loads(dataset.attrs["settings"]))
        results: list[Result] = []
        while f"{_prefix(len(results))}attributes" in dataset:
            own = _unpacked(dataset, _prefix(len(results)))
            results.append(kind.from_dataset(own, model_of(own)))
        interrupted = bool(dataset.attrs["interrupted"])
        return cls.of(settings, tuple(results), model, interrupted=interrupted)

    @classmethod
    def of(
        cls,
        settings: SweepSettings,
        results: tuple[Result, ...],
        model: Model,
        *,
        interrupted: bool = False,
    ) -> Self:
        """Return the sweep of some results."""
        if not results:
            raise ValueError("no result")
        return cls(
            model=model,
            dofs=results[0].dofs,
            interrupted=interrupted,
            timings=_summed([one.timings for one in results]),
            counters={
                name: int(count)
                for name, count in _summed([one.counters for one in results]).items()
            },
            diagnostics=told(results, _written(settings, len(results))),
            settings=settings,
            results=results,
        )


def _written(settings: SweepSettings, count: int) -> tuple[str, ...]:
    """Return the values of the results with their unit."""
    values = settings.values[:count]
    if settings.parameter == "speed":
        return tuple(f"{value * 30.0 / np.pi:.6g} rpm" for value in values)
    unit = "" if settings.unit == "1" else f" {settings.unit}"
    return tuple(f"{value:.6g}{unit}" for value in values)


def _figure_of(result: Result) -> str:
    """Return the name of the figure of a result."""
    for owner in type(result).__mro__:
        if isinstance(drawn := vars(owner).get("plot"), Drawn):
            return drawn.name
    return ""


def told(results: Sequence[Result], names: Sequence[str]) -> tuple[Diagnostic, ...]:
    """Return what is said of the results: once what has the same code and data, and of which."""
    found: dict[tuple[Any, ...], dict[int, Diagnostic]] = {}
    for number, one in enumerate(results):
        for said in one.diagnostics:
            # What has no data is told by its words.
            key = (said.code, *sorted(said.data.items())) if said.data else (said.code, said.text)
            found.setdefault(key, {}).setdefault(number, said)
    return tuple(_of_members(same, names) for same in found.values())


def _of_members(said: Mapping[int, Diagnostic], names: Sequence[str]) -> Diagnostic:
    """Return what is said of some of the results, with their number or, if few, their values."""
    first, total = next(iter(said.values())), len(names)
    if total == 1:
        return first
    who = f"all {total}" if len(said) == total else f"{len(said)} of {total}"
    few = len(said) < total and len(said) <= _NAMED
    where = f" At {', '.join(names[number] for number in said)}" if few else ""
    text, data = f"{first.text}{where} ({who} results)", {**first.data, "results": len(said)}
    return replace(first, text=text, data=data)


def _summed(parts: list[Mapping[str, Any]]) -> dict[str, float]:
    names = dict.fromkeys(name for part in parts for name in part)
    return {name: sum(part.get(name, 0) for part in parts) for name in names}


def _prefix(number: int) -> str:
    return f"member{number}_"


def _plain(value: object) -> object:
    return value.item() if isinstance(value, np.generic) else value


def _unpacked(dataset: Stored, prefix: str) -> Record:
    """Return one member."""
    own = {
        str(name).removeprefix(prefix): Variable(
            tuple(str(dim).removeprefix(prefix) for dim in one.dims), one.values, one.attrs
        )
        for name, one in dataset.variables.items()
        if str(name).startswith(prefix)
    }
    return Record(own, json.loads(str(own.pop("attributes").values)))


def _aligned(members: Sequence[Dataset]) -> list[Dataset]:
    """Return members of which shorter ones can be filled up with not-a-number.

    Frequencies of their own become a variable along positions, and whole numbers such that may be
    missing.
    """
    if not _unequal(members):
        return list(members)
    members = [_by_position(one) for one in members]
    unequal, aligned = _unequal(members), list[Dataset]()
    for one in members:
        counted = {dim: np.arange(one.sizes[dim]) for dim in unequal - set(one.indexes)}
        own = one.assign_coords({dim: counted[dim] for dim in counted if dim in one.dims})
        whole = {
            name: data.astype(np.float64, keep_attrs=True)
            for name, data in own.data_vars.items()
            if data.dtype.kind in "biu" and unequal.intersection(data.dims)
        }
        aligned.append(own.assign(whole))
    return aligned


def _unequal(members: Sequence[Dataset]) -> set[Hashable]:
    """Return the dimensions along which members differ."""
    axes = [
        {dim: one.indexes[dim].values if dim in one.indexes else size for dim, size in own}
        for one in members
        for own in [one.sizes.items()]
    ]
    every = dict.fromkeys(dim for own in axes for dim in own)
    return {
        dim
        for dim in every
        if not all(np.array_equal(own.get(dim, 0), axes[0].get(dim, 0)) for own in axes)
    }


def _by_position(one: Dataset) -> Dataset:
    """Return a member whose frequencies are a variable along positions."""
    if "omega" not in one.dims:
        return one
    omega = one["omega"]
    own = one.drop_vars("omega").rename_dims(omega="position")
    own = own.assign(omega=("position", omega.values, omega.attrs))
    return own.assign_coords(position=np.arange(omega.size))

"""What is asked of a model whose parameters are uncertain: numbers that follow the resonance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Annotated, Any, ClassVar, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, PlainSerializer

from stickslip.checks import brief, choice, members, set_fields, text, whole_number
from stickslip.errors import EntryError, ModelError
from stickslip.settings.entries import (
    ByKey,
    Dof,
    Factor,
    Index,
    Measure,
    Quantified,
    Some,
    Table,
    span_of,
)
from stickslip.settings.ranges import Or, PeakSpan, numbers, positive
from stickslip.settings.variation import Parameter, unit_of
from stickslip.units import physical_number

_MEASURES = get_args(get_args(Measure)[0])

FIXED = (
    "a resonance moves across a fixed frequency as parameters change, so that the amplitude there "
    "jumps from below to above it, says little of the vibration, and has no polynomial surrogate"
)


@dataclass(frozen=True)
class HighestPeak:
    """The highest point of a response over a range of frequencies.

    Its numbers are "amplitude" [m] and "omega" [rad/s].

    Parameters
    ----------
    dof : str
        The degree of freedom; with "mistuning" one of a sector, of which the highest blade counts.
    omega : (float, float)
        Range of frequencies [rad/s], wide enough for the peak to stay inside: one at its ends is no
        peak, and counts as failed.
    measure : {"half_range", "max", "fundamental"}, optional
        Measure of the amplitude; see `ForcedResponse.amplitude`.

    Raises
    ------
    ModelError
        If the range has no width.
    """

    kind: ClassVar[str] = "highest-peak"

    dof: str
    omega: tuple[float, float]
    measure: Measure = "half_range"

    def __post_init__(self) -> None:
        text(self.dof, "highest peak: dof")
        choice(self.measure, "highest peak: measure", _MEASURES)
        set_fields(self, omega=_range(self.omega, "highest peak"))

    @property
    def numbers(self) -> Mapping[str, str]:
        """Units of the numbers by their names."""
        return {"amplitude": "m", "omega": "rad/s"}


@dataclass(frozen=True)
class Optimum:
    """The value of a parameter at which a peak is least, as `optimal_damper` finds it.

    Its numbers are "value", "amplitude" [m] and "omega" [rad/s].

    Parameters
    ----------
    dof : str
        The degree of freedom whose peak is made least.
    parameter : str, optional
        What is varied; see `optimal_damper`.
    bounds : (float, float), optional
        Values to look between; an optimum at one of them counts as failed.
    omega : (float, float), optional
        Range of frequencies [rad/s]. Default: around the resonance of the first mode.
    measure : {"half_range", "max", "fundamental"}, optional
        Measure of the amplitude; see `ForcedResponse.amplitude`.

    Raises
    ------
    ModelError
        If a range has no width, or the parameter is unknown.
    """

    kind: ClassVar[str] = "optimum"

    dof: str
    parameter: Parameter = "slip_force"
    bounds: tuple[float, float] | None = None
    omega: tuple[float, float] | None = None
    measure: Measure = "half_range"

    def __post_init__(self) -> None:
        text(self.dof, "optimum: dof")
        choice(self.parameter, "optimum: parameter", get_args(Parameter))
        choice(self.measure, "optimum: measure", _MEASURES)
        if self.omega is not None:
            set_fields(self, omega=_range(self.omega, "optimum"))
        if self.bounds is not None:
            given = members(self.bounds, "optimum: bounds", "(lowest, highest)")
            if len(given) != 2:
                raise ModelError(f"optimum: bounds: {brief(self.bounds)}; give (lowest, highest)")
            unit = unit_of(self.parameter)
            low, high = (physical_number(one, unit, "optimum: bounds") for one in given)
            if not 0.0 < low < high:
                raise ModelError(f"optimum: bounds: ({low:g}, {high:g}); give 0 < lowest < highest")
            set_fields(self, bounds=(low, high))

    @property
    def numbers(self) -> Mapping[str, str]:
        """Units of the numbers by their names."""
        return {"value": "SI", "amplitude": "m", "omega": "rad/s"}


@dataclass(frozen=True, init=False)
class Backbone:
    """Frequency and damping of a nonlinear mode at given amplitudes.

    Its numbers are "omega[i]" [rad/s] and "damping_ratio[i]" at the amplitude of position i.

    Parameters
    ----------
    amplitude : array_like, shape (n,)
        Modal amplitudes [m kg^(1/2)], in rising order.
    mode : int, optional
        The mode, counted from 0; see `nonlinear_modes`.

    Raises
    ------
    ModelError
        If an amplitude is not positive.
    """

    kind: ClassVar[str] = "backbone"

    amplitude: tuple[float, ...]
    mode: int = 0

    def __init__(self, amplitude: ArrayLike, mode: int = 0) -> None:
        try:
            found = np.unique(numbers(amplitude, "give finite amplitudes above 0", positive))
        except EntryError as error:
            raise ModelError(f"backbone: amplitude{error}") from None
        set_fields(self, amplitude=tuple(found.tolist()), mode=whole_number(mode, "backbone: mode"))

    @property
    def numbers(self) -> Mapping[str, str]:
        """Units of the numbers by their names."""
        places = range(len(self.amplitude))
        return {f"omega[{at}]": "rad/s" for at in places} | {
            f"damping_ratio[{at}]": "1" for at in places
        }


Quantity: TypeAlias = HighestPeak | Optimum | Backbone
_KINDS: Mapping[str, Any] = {one.kind: one for one in (HighestPeak, Optimum, Backbone)}


def _range(omega: object, entry: str) -> tuple[float, float]:
    if not isinstance(omega, tuple | list) or len(omega) != 2:
        raise ModelError(
            f"{entry}: omega: {brief(omega)} is no range; give (lowest, highest), for {FIXED}"
        )
    try:
        low, high = span_of(tuple(omega))
    except EntryError as error:
        raise ModelError(f"{entry}: omega{error}; give a range, for {FIXED}") from None
    return min(low, high), max(low, high)


# ------------------------------------------------------------------------------------- study files


class HighestPeakTable(Table):
    """The highest point of a response over a range of frequencies."""

    kind: Literal["highest-peak"] = Field(description="What is asked.")
    dof: Dof = Field(description="The degree of freedom.")
    omega: PeakSpan = Field(description="Range of frequencies in which the peak stays.")
    measure: Measure = Field(default="half_range", description="Measure of the amplitude.")


class OptimumTable(Table):
    """The value of a parameter at which a peak is least."""

    kind: Literal["optimum"] = Field(description="What is asked.")
    dof: Dof = Field(description="The degree of freedom.")
    parameter: Parameter = Field(default="slip_force", description="What is varied.")
    bounds: Some[Quantified] | None = Field(
        default=None, description="Values to look between, in SI units or with one."
    )
    omega: PeakSpan | None = Field(default=None, description="Range of frequencies.")
    measure: Measure = Field(default="half_range", description="Measure of the amplitude.")


class BackboneTable(Table):
    """Frequency and damping of a nonlinear mode at given amplitudes."""

    kind: Literal["backbone"] = Field(description="What is asked.")
    amplitude: Some[Factor] = Field(description="Modal amplitudes [m kg^(1/2)].")
    mode: Index = Field(default=0, description="The mode, counted from 0.")


def _quantity(given: Any) -> Quantity:
    """Return a quantity, also from a table, or from what `spec` made of it."""
    if isinstance(given, HighestPeak | Optimum | Backbone):
        return given
    values = given.model_dump() if isinstance(given, Table) else given
    if isinstance(values, Mapping) and values.get("kind") in _KINDS:
        own = {key: one for key, one in values.items() if key != "kind"}
        made: Quantity = _KINDS[values["kind"]](**own)
        return made
    raise EntryError(
        "",
        f": {brief(given)}; give ss.HighestPeak(...), ss.Optimum(...) or ss.Backbone(...). A fixed "
        f"frequency is none of them: {FIXED}",
    )


AnyQuantity = Annotated[
    Quantity,
    Or(
        Annotated[Table, ByKey("kind", HighestPeakTable, OptimumTable, BackboneTable)],
        "HighestPeak | Optimum | Backbone",
        "HighestPeak, Optimum or Backbone",
        _quantity,
    ),
    PlainSerializer(lambda one: {"kind": one.kind, **asdict(one)}),
]

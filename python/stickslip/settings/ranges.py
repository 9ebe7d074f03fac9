"""Lists and ranges, as a function takes them and as a study file writes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import inf
from numbers import Real
from typing import Annotated, Any, Generic, Literal, Self, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import core_schema

from stickslip.checks import brief, text
from stickslip.errors import EntryError
from stickslip.settings.entries import (
    CALL,
    ONE_OF,
    Dof,
    Factor,
    Friction,
    Length,
    ListOr,
    NormalLoad,
    Omega,
    SlipForce,
    Some,
    Span,
    Speed,
    StiffnessValue,
    Table,
    Whole,
    quantity_of,
    span_of,
)
from stickslip.units import physical_number, without_units

Float: TypeAlias = NDArray[np.float64]
_T = TypeVar("_T")
_R = TypeVar("_R")


@dataclass(frozen=True)
class Or:
    """What a study file writes in one form, and a call gives in another, read by `call`."""

    written: Any
    takes: str
    """Type of what a call gives."""
    said: str
    """The same in words."""
    call: Callable[[Any], Any] = lambda value: value

    def __get_pydantic_core_schema__(
        self, _: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        def read(value: Any, inner: Callable[[Any], Any], info: ValidationInfo) -> Any:
            if info.context == CALL:
                return self.call(value)
            found = inner(value)
            if isinstance(found, _Ends):
                found = found.values()
            elif isinstance(found, tuple) and found and isinstance(found[0], float):
                found = np.array(found)
            # Tuples are ranges and names, which have been checked.
            return found if isinstance(found, tuple) else self.call(found)

        return core_schema.with_info_wrap_validator_function(
            read,
            handler.generate_schema(self.written),
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda value: value.tolist() if isinstance(value, np.ndarray) else value
            ),
        )


def by_parameter(read: Callable[[str, object], Any], example: str, takes: str, said: str) -> Or:
    """Take something of each of several parameters, by their names."""

    def read_all(given: object) -> dict[str, Any]:
        if not isinstance(given, Mapping) or not given:
            raise EntryError("", f": {brief(given)}; give {{{example}, ...}}")
        found = {}
        for name, one in given.items():
            text(name, "parameters: name")
            try:
                found[str(name)] = read(name, one)
            except EntryError as error:
                raise EntryError("", f"[{name!r}]{error}") from None
        return found

    written = Annotated[dict[str, Any], BeforeValidator(read_all)]
    return Or(written, f"Mapping[str, {takes}]", f"mapping of str to {said}", read_all)


# ------------------------------------------------------------------------------------------- calls


def positive(values: Float) -> Any:
    """Tell which numbers are finite and above 0."""
    return np.isfinite(values) & (values > 0.0)


def numbers(
    values: object, remedy: str, allowed: Callable[[Float], Any] = np.isfinite, unit: str = ""
) -> Float:
    """Return one real number or a list of them, each allowed, as a list; texts have a unit."""
    values = without_units(values, unit, "")
    try:
        given = np.atleast_1d(np.asarray(values))
    except ValueError:
        raise EntryError("", f": a ragged list; {remedy} in one list") from None
    if given.dtype.kind not in "fiu" and given.size:
        raise EntryError("", f": {brief(values)} holds no real numbers; {remedy}")
    if given.ndim != 1:
        raise EntryError("", f": shape {given.shape} instead of (n,); {remedy} in one list")
    if not given.size:
        raise EntryError("", f": empty; {remedy}")
    found = np.array(given, dtype=np.float64)
    bad = np.flatnonzero(~allowed(found))
    if bad.size:
        raise EntryError("", f"[{bad[0]}] is {found[bad[0]]:g}; {remedy}")
    return found


def _grid(omega: object) -> Float | Span:
    if isinstance(omega, tuple) and len(omega) == 2:
        return span_of(omega)
    if isinstance(omega, Real | str):
        one = physical_number(omega, "rad/s", "")
        raise EntryError("", f": shape () instead of (n,); write [{one:g}]")
    return numbers(omega, "give finite frequencies above 0 rad/s", positive, "rad/s")


def _branch(unit: str) -> Callable[[object], Float | Span]:
    """Return what reads a range, or values, of a unit."""

    def read(values: object) -> Float | Span:
        if isinstance(values, tuple) and len(values) == 2:
            return _span(values, unit)
        remedy = "give finite values above 0, or (from, to)"
        return np.unique(numbers(values, remedy, positive, unit))

    return read


def _span(ends: Iterable[object], unit: str = "") -> Span:
    low, high = sorted(physical_number(end, unit, "", finite=False) for end in ends)
    if not 0.0 < low < high:
        raise EntryError("", f": the range ({low:g}, {high:g}) must have two ends above 0")
    return low, high


def _names(given: object) -> tuple[str, ...]:
    if not isinstance(given, Iterable):
        raise EntryError("", f": {brief(given)} is not a list of names; write [...]")
    names = (given,) if isinstance(given, str) else tuple(given)
    if not names:
        raise EntryError("", ": no dof; name at least one, or leave it out for all")
    for position, name in enumerate(names):
        if not isinstance(name, str):
            raise EntryError("", f"[{position}]: {brief(name)} is not text; give a name in quotes")
        if name in names[:position]:
            raise EntryError("", f": {name!r} is given more than once; name each dof once")
    return names


# ------------------------------------------------------------------------------------- study files


_Spacing = Annotated[Literal["linear", "log"], ONE_OF]


class _Ends(Table, Generic[_T]):
    """The two ends of a range."""

    begin: _T = Field(alias="from", description="First value.")
    end: _T = Field(alias="to", description="Last value.")

    def values(self) -> Any:
        """Return what a call would give."""
        return span_of((self.begin, self.end))


class _Range(_Ends[_T], Generic[_T]):
    """A range, or values in it."""

    points: Annotated[int, Whole(2, 100_000)] | None = Field(
        default=None, description="Number of values; left out: the whole range, to be followed."
    )
    spacing: _Spacing | None = Field(
        default=None, description="Spacing of the values; left out: logarithmic."
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        if self.points is None:
            if self.spacing is not None:
                raise ValueError("'spacing' needs 'points'; without points the range is followed")
            return self
        begin, end = self._ends
        if begin == end:
            raise ValueError(f"'from' and 'to' are both {begin:g}; for one value write [{begin:g}]")
        if inf in (begin, end):
            raise ValueError(
                "a range to inf has no values in between; give a finite 'to', or a list that "
                "holds inf"
            )
        if self.spacing != "linear" and 0.0 in (begin, end):
            raise ValueError(
                "the range holds 0, and its spacing is logarithmic; begin above 0, or write "
                "spacing = 'linear'"
            )
        return self

    @property
    def _ends(self) -> Span:
        begin, end = cast("tuple[float, float | None]", (self.begin, self.end))
        return begin, inf if end is None else end

    def values(self) -> Any:
        """Return what a call would give."""
        if self.points is None:
            return _span(self._ends)
        space = np.linspace if self.spacing == "linear" else np.geomspace
        return space(*self._ends, self.points)


class PeakRange(_Ends[Omega]):
    """The range of frequencies in which peaks are looked for."""


class OmegaRange(_Ends[Omega]):
    """A range of angular frequencies: a grid, or left to the step control."""

    points: Annotated[int, Whole(2, 10_000_000)] | None = Field(
        default=None,
        description="Number of points; left out: chosen to the tolerance.",
        examples=[400],
    )
    spacing: _Spacing | None = Field(
        default=None, description="Spacing of the points; left out: linear."
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        if self.begin == self.end:
            raise ValueError("'from' and 'to' are equal; for one frequency write omega = [...]")
        if self.points is None and self.spacing is not None:
            raise ValueError("'spacing' needs 'points'; without points the steps are adaptive")
        return self

    def values(self) -> Any:
        """Return the grid, or the two ends of an adaptive range."""
        if self.points is None:
            return self.begin, self.end
        space = np.geomspace if self.spacing == "log" else np.linspace
        return space(self.begin, self.end, self.points)


class SpeedRange(OmegaRange):
    """A range of speeds of rotation."""

    begin: Speed = Field(alias="from", description="First speed.")
    end: Speed = Field(alias="to", description="Last speed.")

    @model_validator(mode="after")
    def _require_ratio(self) -> Self:
        if self.spacing == "log" and 0.0 in (self.begin, self.end):
            raise ValueError("spacing = 'log' has no 0; begin above it")
        return self


def _omega_form(value: object) -> str | None:
    if isinstance(value, Mapping | OmegaRange):
        return "<range>"
    return "<list>" if isinstance(value, list | tuple) else None


def _form(value: object) -> str:
    return _omega_form(value) or "<number>"


_Rigid = Annotated[
    float,
    quantity_of("N/m", "not be negative", finite=False),
    WithJsonSchema({"type": ["number", "string"]}),
]


class SlipForceRange(_Range[SlipForce]):
    """A range of slip forces."""


class StiffnessRange(_Range[_Rigid]):
    """A range of contact stiffnesses."""


class FrictionRange(_Range[Friction]):
    """A range of coefficients of friction."""


class LoadRange(_Range[NormalLoad]):
    """A range of normal loads."""


class SpringRange(_Range[StiffnessValue]):
    """A range of stiffnesses that are finite."""


class LevelRange(_Range[Factor]):
    """A range of levels of the forces."""


class RatioRange(_Range[Factor]):
    """A range of the ratio r."""

    end: Factor | None = Field(  # type: ignore[assignment]
        default=None, alias="to", description="Highest ratio; left out: no limit."
    )


# ----------------------------------------------------------------------------------------- entries

_LIST = "ArrayLike", "array_like, shape (n,)"
_BOTH = "ArrayLike | tuple[float, float]", "array_like, shape (n,), or (float, float)"


def _listed(
    unit: str, remedy: str, allowed: Callable[[Float], Any] = np.isfinite
) -> Callable[[object], Float]:
    """Return what reads one number or a list of them, of a unit."""
    return lambda values: numbers(values, f"give {remedy}", allowed, unit)


def _from_zero(unit: str) -> Callable[[object], Float]:
    return _listed(unit, "values from 0 on", lambda x: x >= 0.0)


def _not_negative(unit: str) -> Callable[[object], Float]:
    return _listed(unit, "finite values from 0 on", lambda x: np.isfinite(x) & (x >= 0.0))


def _above_zero(unit: str) -> Callable[[object], Float]:
    return _listed(unit, "finite values above 0", positive)


_Omegas = Annotated[
    Annotated[OmegaRange, Tag("<range>")] | Annotated[Some[Omega], Tag("<list>")],
    Discriminator(
        _omega_form,
        custom_error_type="omega_form",
        custom_error_message="is neither {from = ..., to = ..., points = ...} nor a list",
    ),
]
_Values: TypeAlias = Annotated[
    Annotated[_R, Tag("<range>")]
    | Annotated[Some[_T], Tag("<list>")]
    | Annotated[_T, Tag("<number>")],
    Discriminator(_form),
]
"""A range, a list, or one number."""
_Ratios = _Values[RatioRange, Factor]
_Stiffnesses = _Values[StiffnessRange, _Rigid]
_SlipForces = _Values[SlipForceRange, SlipForce]
_Levels = _Values[LevelRange, Factor]

Frequencies = Annotated[Float | Span, Or(_Omegas, *_BOTH, _grid)]
PeakSpan = Annotated[Span, Or(PeakRange, "tuple[float, float]", "(float, float)", span_of)]
SlipForces = Annotated[Float | Span, Or(_SlipForces, *_LIST, _from_zero("N"))]
Stiffnesses = Annotated[Float | Span, Or(_Stiffnesses, *_LIST, _from_zero("N/m"))]
Frictions = Annotated[Float | Span, Or(_Values[FrictionRange, Friction], *_LIST, _not_negative(""))]
Preloads = Annotated[Float | Span, Or(_Values[LoadRange, NormalLoad], *_LIST, _not_negative("N"))]
Springs = Annotated[
    Float | Span, Or(_Values[SpringRange, StiffnessValue], *_LIST, _not_negative("N/m"))
]
Gaps = Annotated[Float, Or(ListOr[Length, Length], *_LIST, _listed("m", "finite values"))]
Levels = Annotated[Float | Span, Or(_Levels, *_LIST, _above_zero(""))]
Amplitudes = Annotated[Float | Span, Or(_Levels, *_BOTH, _branch(""))]
Ratios = Annotated[Float | Span, Or(_Ratios, *_BOTH, _branch(""))]
BranchStiffnesses = Annotated[Float | Span, Or(_Stiffnesses, *_BOTH, _branch("N/m"))]
BranchSlipForces = Annotated[Float | Span, Or(_SlipForces, *_BOTH, _branch("N"))]
Speeds = Annotated[Float | Span, Or(_Values[SpeedRange, Speed], *_LIST, _not_negative("rad/s"))]
SlipForceList = Annotated[Float, Or(Some[SlipForce], *_LIST, _above_zero("N"))]
StiffnessList = Annotated[Float, Or(Some[StiffnessValue], *_LIST, _above_zero("N/m"))]
Dofs = Annotated[tuple[str, ...], Or(Some[Dof], "Iterable[str] | str", "iterable of str", _names)]

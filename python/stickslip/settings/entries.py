"""What one entry may be, given to a function or written in a study file: numbers, names, tables."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import Annotated, Any, Literal, TypeAlias, TypeVar, get_args

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    PlainValidator,
    Strict,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError
from pydantic_core.core_schema import CoreSchema, int_schema, no_info_before_validator_function

from stickslip.checks import MAX_COUNT, brief, choice, real_number, unknown, whole_number
from stickslip.errors import EntryError
from stickslip.units import physical_number, quantity

CALL = "call"
"""Context of the validation of a function's arguments."""

# ----------------------------------------------------------------------------------------- numbers


def _number(value: Any, info: ValidationInfo, unit: str, *, finite: bool = True) -> float:
    """Return a number in SI units, or what a text with a unit says in them."""
    if info.context == CALL:
        return physical_number(value, unit, "", finite=finite)
    return quantity(value, unit, "", finite=finite)


def quantity_of(unit: str, bound: str = "", *, finite: bool = True) -> BeforeValidator:
    """Read a number in SI units, or a text with a unit."""

    def read(value: object, info: ValidationInfo) -> float:
        number = _number(value, info, unit, finite=finite)
        if (bound == "be positive" and number <= 0) or (bound == "not be negative" and number < 0):
            raise EntryError("", f" = {brief(value)} must {bound}")
        return number

    return BeforeValidator(read)


def _quantity_schema(*examples: str) -> WithJsonSchema:
    # Pydantic knows of numbers only, and editors have to know of texts as well.
    return WithJsonSchema({"type": ["number", "string"], "examples": list(examples)})


def Within(low: float, high: float) -> BeforeValidator:
    """Refuse a fraction outside a range."""

    def read(value: object, info: ValidationInfo) -> float:
        number = _number(value, info, "")
        least = f"{low:g}".replace("e-0", "e-")
        if not low <= number <= high:
            raise EntryError("", f": {number:g}; give a fraction from {least} to {high:g}")
        return number

    return BeforeValidator(read)


@dataclass(frozen=True)
class Whole:
    """A whole number from `smallest` to `largest`, of Python or NumPy."""

    smallest: int = 0
    largest: int = MAX_COUNT

    def __get_pydantic_core_schema__(self, _: Any, __: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_before_validator_function(
            lambda value: whole_number(value, "", smallest=self.smallest, largest=self.largest),
            int_schema(ge=self.smallest, le=self.largest),
        )


class _OneOf:
    """One of the names of a `Literal`."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        names = get_args(source)
        return no_info_before_validator_function(
            lambda value: choice(value, "", names), handler(source)
        )


def _flag(value: object) -> bool:
    if not isinstance(value, bool | np.bool_):
        raise EntryError("", f": {brief(value)}; give True or False")
    return bool(value)


ONE_OF = _OneOf()

_T = TypeVar("_T")
_R = TypeVar("_R")
Many: TypeAlias = Annotated[tuple[_T, ...], Strict(False)]
Some: TypeAlias = Annotated[tuple[_T, ...], Strict(False), Field(min_length=1)]

Newtons = Annotated[float, quantity_of("N"), _quantity_schema("20.3 N", "1.2 kN")]
SlipForce = Annotated[
    float, quantity_of("N", "not be negative", finite=False), _quantity_schema("246 N", "1.2 kN")
]
NormalLoad = Annotated[
    float, quantity_of("N", "not be negative"), _quantity_schema("120 N", "1.2 kN")
]
StiffnessValue = Annotated[
    float, quantity_of("N/m", "not be negative"), _quantity_schema("24 kN/mm", "1e6 N/m")
]
CubicStiffness = Annotated[float, quantity_of("N/m^3"), _quantity_schema("1e9 N/m^3", "-2 N/mm^3")]
Length = Annotated[float, quantity_of("m"), _quantity_schema("1 mm", "1e-3 m")]
Angle = Annotated[float, quantity_of("rad"), _quantity_schema("90 deg", "1.57 rad")]
Omega = Annotated[
    float, quantity_of("rad/s", "be positive"), _quantity_schema("20 rad/s", "25 Hz", "1500 rpm")
]
Speed = Annotated[
    float, quantity_of("rad/s", "not be negative"), _quantity_schema("3000 rpm", "50 Hz")
]
Ratio = Annotated[float, quantity_of(""), _quantity_schema("0.1 %")]
Friction = Annotated[float, quantity_of("", "not be negative"), _quantity_schema("30 %")]
percent = _quantity_schema("0.1 %")
Tolerance = Annotated[float, Within(1e-8, 0.5), percent]
Factor = Annotated[float, quantity_of("", "be positive"), WithJsonSchema({"type": "number"})]
Rate = Annotated[float, quantity_of("1/s"), _quantity_schema("7.49 1/s")]
Time = Annotated[float, quantity_of("s"), _quantity_schema("2.6e-5 s")]
Mass = Annotated[float, quantity_of("kg", "not be negative"), _quantity_schema("12 g", "0.3 kg")]
Inertia = Annotated[float, quantity_of("kg*m^2", "not be negative"), _quantity_schema("3 kg mm^2")]
Dashpot = Annotated[
    float, quantity_of("kg/s", "not be negative"), _quantity_schema("7.5 N s/m", "7.5 kg/s")
]
Number = Annotated[
    float, BeforeValidator(lambda value: real_number(value, "")), WithJsonSchema({"type": "number"})
]
Quantified = Annotated[
    float | str,
    PlainValidator(lambda one: one if isinstance(one, str) else real_number(one, "")),
    _quantity_schema(),
]
"""A number, or a text whose unit is read where it is known which it has to be."""
Flag = Annotated[bool, BeforeValidator(_flag)]
Count = Annotated[int, Whole(1)]
Index = Annotated[int, Whole(0)]

# ------------------------------------------------------------------------------------------- names


def _dof(value: object) -> object:
    # the DOFs of a structure without names are called "0", "1", ...
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _contact(value: object) -> str | tuple[str, int]:
    if isinstance(value, str) and value:
        return value
    if isinstance(value, list | tuple) and [type(part) for part in value] == [str, int]:
        return value[0], value[1]
    raise EntryError(
        "",
        f" = {brief(value)}; give the name of a contact, or [name, point] for one of its points, "
        "counted from 0",
    )


Dof = Annotated[
    str, BeforeValidator(_dof), WithJsonSchema({"type": ["string", "integer"], "examples": ["tip"]})
]
Text = Annotated[str, Field(min_length=1)]
NamedContact = Annotated[
    str | tuple[str, int],
    PlainValidator(_contact),
    WithJsonSchema({"type": ["string", "array"], "examples": ["blade", ["structural", 0]]}),
]

# ------------------------------------------------------------------------- numbers or words, ranges


def _count_or_auto(value: object) -> int | str:
    if isinstance(value, str):
        if value == "auto":
            return value
        raise EntryError("", f": {unknown('choice', value, ['auto'])}, or a whole number")
    return whole_number(value, "", smallest=1)


def _residual(value: object, info: ValidationInfo, names: Sequence[str] = ()) -> float | str:
    known = [*RESIDUALS, *names]
    written = isinstance(value, str) and value[:1] in "+-.0123456789"
    if not isinstance(value, str) or written:
        return _number(value, info, "N")
    if value not in known:
        raise EntryError("", f": {unknown('choice', value, known)}, or a force in N")
    return value


def span_of(span: object) -> tuple[float, float]:
    """Return the two ends of a range of frequencies, checked."""
    if not isinstance(span, tuple):
        raise EntryError("", ": give a range (from, to) in rad/s")
    if len(span) != 2:
        raise EntryError("", f": a range has two ends, not {len(span)}; write (start, end)")
    try:
        start, end = (physical_number(value, "rad/s", "") for value in span)
    except EntryError as error:
        raise EntryError("", f": end of the range{error.said}") from None
    if not (start > 0.0 and end > 0.0 and start != end):
        raise EntryError(
            "",
            f": the range ({start:g}, {end:g}) must have two different ends above 0 rad/s; write a "
            "list for single frequencies",
        )
    return start, end


RESIDUALS = ("centred", "from_rest")
"""Named assumptions on the mean force of a contact that never slips."""

Harmonics = Annotated[
    int | Literal["auto"],
    BeforeValidator(_count_or_auto),
    WithJsonSchema({"anyOf": [{"type": "integer", "minimum": 1}, {"const": "auto"}]}),
]
Residual = Annotated[
    Literal["centred", "from_rest"] | float,
    BeforeValidator(_residual),
    WithJsonSchema({"anyOf": [{"enum": list(RESIDUALS)}, {"type": ["number", "string"]}]}),
]
ResidualOrBounds = Annotated[
    Literal["centred", "from_rest", "bounds"] | float,
    BeforeValidator(lambda value, info: _residual(value, info, ["bounds"])),
    WithJsonSchema({"anyOf": [{"enum": [*RESIDUALS, "bounds"]}, {"type": ["number", "string"]}]}),
]
Measure = Annotated[Literal["half_range", "max", "fundamental"], ONE_OF]
Span = Annotated[tuple[float, float], BeforeValidator(span_of)]

# ------------------------------------------------------------------------------------------ tables


class Table(BaseModel):
    """Entries by their names: known ones only, immutable once read."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        frozen=True,
        field_title_generator=lambda name, field: field.alias or name,
    )

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: object) -> object:
        if isinstance(data, Mapping):
            keys = [field.alias or name for name, field in cls.model_fields.items()]
            for key in data:
                if key not in keys:
                    message = unknown("key", key, keys)
                    raise PydanticCustomError("unknown_key", "{text}", {"text": message})
        return data


class ByKey:
    """One of several tables, which the value of one of their keys chooses."""

    def __init__(self, key: str, *tables: type[Table], default: str | None = None) -> None:
        self.key, self.default = key, default
        self.tables = {get_args(one.model_fields[key].annotation)[0]: one for one in tables}

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        tables: Any = (Annotated[one, Tag(f"<{name}>")] for name, one in self.tables.items())
        chosen = Discriminator(
            self._choice,
            custom_error_type="unknown_choice",
            custom_error_message="unknown",
            custom_error_context={"key": self.key, "choices": " ".join(self.tables)},
        )
        return handler.generate_schema(Annotated[reduce(or_, tables), chosen])

    def _choice(self, table: object) -> Hashable:
        if isinstance(table, Mapping):
            return f"<{table.get(self.key, self.default)}>"
        return f"<{getattr(table, self.key, None)}>"


def _form(value: object) -> Hashable:
    return "<list>" if isinstance(value, list | tuple) else "<number>"


ListOr: TypeAlias = Annotated[
    Annotated[Some[_T], Tag("<list>")] | Annotated[_R, Tag("<number>")], Discriminator(_form)
]
"""A list of some, or something else; messages are those of the form that was given."""

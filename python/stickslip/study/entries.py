"""What one entry of a study file may be: quantities with units, names, numbers, strict tables."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Annotated

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    PlainValidator,
    Strict,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError

from stickslip.checks import MAX_COUNT, brief, real_number, unknown
from stickslip.errors import ModelError
from stickslip.units import quantity

__all__ = [
    "HERE",
    "Angle",
    "Contacts",
    "Count",
    "Dof",
    "Factor",
    "Length",
    "Newtons",
    "Number",
    "Omega",
    "Rate",
    "Ratio",
    "SlipForce",
    "StiffnessValue",
    "Table",
    "Text",
    "Time",
    "Tolerance",
    "chosen_by",
    "number_or",
]

HERE = "\0"
"""Stands for the entry in messages raised below the place that knows its full path in the file."""


def _quantity(unit: str, bound: str = "", *, finite: bool = True) -> BeforeValidator:
    def read(value: float | str) -> float:
        number = quantity(value, unit, HERE, finite=finite)
        if (bound == "be positive" and number <= 0) or (bound == "not be negative" and number < 0):
            raise ModelError(f"{HERE} = {brief(value)} must {bound}")
        return number

    return BeforeValidator(read)


def _quantity_schema(*examples: str) -> WithJsonSchema:
    # editors need to know that the text is welcome too: pydantic would see a number only
    return WithJsonSchema({"type": ["number", "string"], "examples": list(examples)})


def _dof(value: object) -> object:
    # the DOFs of a structure without names are called "0", "1", ...
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _contact(value: object) -> str | tuple[str, int]:
    if isinstance(value, str) and value:
        return value
    if isinstance(value, list | tuple) and [type(part) for part in value] == [str, int]:
        return value[0], value[1]
    raise ModelError(
        f"{HERE} = {brief(value)}; give the name of a contact, or [name, point] for one of its "
        "points, counted from 0"
    )


Newtons = Annotated[float, _quantity("N"), _quantity_schema("20.3 N", "1.2 kN")]
SlipForce = Annotated[
    float, _quantity("N", "not be negative", finite=False), _quantity_schema("246 N", "1.2 kN")
]
StiffnessValue = Annotated[
    float, _quantity("N/m", "not be negative"), _quantity_schema("24 kN/mm", "1e6 N/m")
]
Length = Annotated[float, _quantity("m"), _quantity_schema("1 mm", "1e-3 m")]
Angle = Annotated[float, _quantity("rad"), _quantity_schema("90 deg", "1.57 rad")]
Omega = Annotated[
    float, _quantity("rad/s", "be positive"), _quantity_schema("20 rad/s", "25 Hz", "1500 rpm")
]
Ratio = Annotated[float, _quantity(""), _quantity_schema("0.1 %")]
Tolerance = Annotated[float, _quantity("", "be positive"), _quantity_schema("0.1 %")]
Factor = Annotated[float, _quantity("", "be positive"), WithJsonSchema({"type": "number"})]
Rate = Annotated[float, _quantity("1/s"), _quantity_schema("7.49 1/s")]
Time = Annotated[float, _quantity("s"), _quantity_schema("2.6e-5 s")]
Number = Annotated[
    float,
    BeforeValidator(lambda value: real_number(value, HERE)),
    WithJsonSchema({"type": "number"}),
]
Dof = Annotated[
    str, BeforeValidator(_dof), WithJsonSchema({"type": ["string", "integer"], "examples": ["tip"]})
]
Text = Annotated[str, Field(min_length=1)]
_Contact = Annotated[
    str | tuple[str, int],
    PlainValidator(_contact),
    WithJsonSchema({"type": ["string", "array"], "examples": ["blade", ["structural", 0]]}),
]
Contacts = Annotated[tuple[_Contact, ...], Strict(False), Field(min_length=1)]
Count = Annotated[int, Field(ge=1, le=MAX_COUNT)]


class Table(BaseModel):
    """A table of the file: known keys only, immutable once read."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

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


def chosen_by(key: str, *choices: str, default: str | None = None) -> Discriminator:
    """Let the value of one key choose the class of a table."""

    def choose(table: object) -> Hashable:
        value = table.get(key, default) if isinstance(table, Mapping) else getattr(table, key, None)
        return f"<{value}>"

    return Discriminator(
        choose,
        custom_error_type="unknown_choice",
        custom_error_message="unknown",
        custom_error_context={"key": key, "choices": " ".join(choices)},
    )


def number_or(*others: str) -> Discriminator:
    """Tell a number from a text or a list by its type, so that each is complained of as itself."""
    kinds: dict[str, tuple[type, ...]] = {"<text>": (str,), "<list>": (list, tuple)}

    def form(value: object) -> Hashable:
        return next((other for other in others if isinstance(value, kinds[other])), "<number>")

    return Discriminator(form)

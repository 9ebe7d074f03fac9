"""What is wrong with settings or a study file: what pydantic found, worded in one line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from stickslip.checks import brief, unknown
from stickslip.errors import EntryError, ModelError
from stickslip.interruption import Interruption
from stickslip.model.laws import unknown_law

_PHRASES = {
    "string_type": "is not a text",
    "string_too_short": "is empty",
    "string_pattern_mismatch": 'is no file name; give letters, none of / \\ : * ? " < > |',
    "bool_type": "is neither true nor false",
    "tuple_type": "is not a list",
    "list_type": "is not a list",
    "model_type": "is not a table",
    "model_attributes_type": "is not a table",
    "dict_type": "is not a table",
    "greater_than_equal": "is below the least allowed, {ge}",
    "too_short": "has too few entries; give at least {min_length}",
    "too_long": "has too many entries; give at most {max_length}",
}

_REPEATED = ("contact", "force", "coupling")
_TABLES = (*_REPEATED, "structure", "disk", "output")

_Table = TypeVar("_Table", bound=BaseModel)


def validated(table: type[_Table], content: Mapping[str, object], context: object = None) -> _Table:
    """Return a table of checked entries, or raise `ModelError` with what is wrong."""
    try:
        # To pydantic an interrupted check is a refused value.
        with Interruption():
            return table.model_validate(content, context=context)
    except ValidationError as error:
        raise refusal(error) from None


def refusal(error: ValidationError) -> ModelError:
    """Word the first finding of a validation in one line, and count the others.

    The entry as it stands in the call or the file, its value and the remedy, for example
    ``contact 2: unknown key 'stifness'; did you mean 'stiffness'?``. Contacts, forces and positions
    in lists are counted from 1.
    """
    found = error.errors(include_url=False)
    # To pydantic a list lacks the entries that it has refused.
    whole = [one for one in found if not (one["type"] == "too_short" and _within(one, found))]
    first, *others = whole
    cause = first.get("ctx", {}).get("error")
    more = f" (and {len(others)} more)" if others else ""
    study = f"{_worded(first, study=True)}{more}" if isinstance(cause, ModelError) else None
    return ModelError(f"{_worded(first)}{more}", study=study)


def _within(one: ErrorDetails, found: Sequence[ErrorDetails]) -> bool:
    """Return whether another finding is about a part of the entry of one."""
    place = one["loc"]
    return any(len(f["loc"]) > len(place) and f["loc"][: len(place)] == place for f in found)


def _worded(finding: ErrorDetails, *, study: bool = False) -> str:
    entry, value = _entry(finding["loc"]), finding["input"]
    context = finding.get("ctx", {})
    match finding["type"]:
        case "missing":
            *table, key = _path(finding["loc"])
            return f"{_entry(table)}: '{key}' is missing" if table else f"[{key}] is missing"
        case "unknown_key":
            return f"{entry}: {finding['msg']}" if entry else finding["msg"]
        case "value_error":
            cause = context["error"]
            if isinstance(cause, EntryError):
                return f"{entry}{cause.said}"
            said = cause.study if study and isinstance(cause, ModelError) else str(cause)
            return f"{entry}: {said}" if entry else said
        case "unknown_choice" if isinstance(value, Mapping):
            return f"{entry}: {_choice(value, context['key'], context['choices'].split())}"
        case "unknown_choice":
            return _brackets(entry, value)
        case "tuple_type" | "model_type" if entry in _TABLES:
            return _brackets(entry, value)
        case kind:
            phrase = _PHRASES[kind].format(**context) if kind in _PHRASES else finding["msg"]
            return f"{entry} = {brief(value)} {phrase}"


def _choice(table: Mapping[str, object], key: str, choices: Sequence[str]) -> str:
    if key == "law" and key in table:
        return unknown_law(table[key])
    if key in table:
        return unknown(key, table[key], choices)
    return f"'{key}' is missing; known: {', '.join(map(repr, choices))}"


def _brackets(entry: str, value: object) -> str:
    name = entry.split()[0]
    header = f"[[{name}]]" if name in _REPEATED else f"[{name}]"
    return f"{entry} = {brief(value)} is not written as a table; begin it with {header}"


def _path(location: Sequence[int | str]) -> list[int | str]:
    # parts in angle brackets name the alternative that was read, not an entry of the file
    return [part for part in location if not str(part).startswith("<")]


def _entry(location: Sequence[int | str]) -> str:
    """Name an entry: ``contact 2: stiffness``, ``analysis: omega.from``, ``output: dofs[3]``."""
    match _path(location):
        case []:
            return ""
        case [str(table), int(number), *keys]:
            head = f"{table} {number + 1}"
        case [table, *keys]:
            head = str(table)
    steps = (f"[{key + 1}]" if isinstance(key, int) else f".{key}" for key in keys)
    return f"{head}: {''.join(steps).lstrip('.')}" if keys else head

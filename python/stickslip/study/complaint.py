"""What is wrong with a study file: the finding of pydantic, worded in one line for its author."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from stickslip.checks import brief, unknown
from stickslip.model.laws import unknown_law
from stickslip.study.entries import HERE

__all__ = ["complaint"]

_PHRASES = {
    "int_type": "is not a whole number",
    "int_from_float": "is not a whole number",
    "string_type": "is not a text",
    "string_too_short": "is empty",
    "string_pattern_mismatch": 'is no file name; give letters, none of / \\ : * ? " < > |',
    "tuple_type": "is not a list",
    "list_type": "is not a list",
    "model_type": "is not a table",
    "model_attributes_type": "is not a table",
    "dict_type": "is not a table",
    "greater_than_equal": "is below the least allowed, {ge}",
    "less_than_equal": "is above the most allowed, {le}",
    "too_short": "has too few entries; give at least {min_length}",
    "too_long": "has too many entries; give at most {max_length}",
}

_REPEATED = ("contact", "force", "coupling")
_TABLES = (*_REPEATED, "structure", "disk", "output")


def complaint(error: ValidationError) -> str:
    """Word the first finding of a validation, and count the others.

    Parameters
    ----------
    error : pydantic.ValidationError
        What reading the tables of a study file raised.

    Returns
    -------
    str
        One line: the entry as it stands in the file, its value and the remedy, for example
        ``contact 2: unknown key 'stifness'; did you mean 'stiffness'?``. Contacts, forces and
        positions in lists are counted from 1.
    """
    first, *others = error.errors(include_url=False)
    more = f" (and {len(others)} more)" if others else ""
    return _worded(first) + more


def _worded(finding: ErrorDetails) -> str:
    entry, value = _entry(finding["loc"]), finding["input"]
    context = finding.get("ctx", {})
    match finding["type"]:
        case "missing":
            *table, key = _path(finding["loc"])
            return f"{_entry(table)}: '{key}' is missing" if table else f"[{key}] is missing"
        case "unknown_key":
            return f"{entry}: {finding['msg']}" if entry else finding["msg"]
        case "value_error":
            text = str(context["error"])
            return text.replace(HERE, entry) if HERE in text or not entry else f"{entry}: {text}"
        case "literal_error":
            choices = re.findall(r"'([^']*)'", context["expected"])
            return f"{entry}: {unknown('choice', value, choices)}"
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

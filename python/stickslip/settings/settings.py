"""Settings of an analysis, and how a function takes them as its keywords."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Self, TypeVar, Union, get_args, get_origin

from pydantic import ValidationError
from pydantic.fields import FieldInfo

from stickslip.calls import misfit
from stickslip.errors import CallError
from stickslip.settings.entries import CALL, Table
from stickslip.settings.refusal import refusal

__all__ = ["Settings", "configured", "described", "type_in_words"]

_Result = TypeVar("_Result")
_INDENT = 4 * " "
_WIDTH = 100
_SECTION = re.compile(r"( *)Parameters\n *-+\n(.*?)\n(?=\n *\w+\n *---)", re.S)


class Settings(Table):
    """How an analysis is computed: every key with its default, bounds and meaning."""

    @classmethod
    def of(cls, **values: Any) -> Self:
        """Return checked settings.

        Raises
        ------
        ModelError
            If a value is of the wrong type or outside its range.
        """
        try:
            return cls.model_validate(values, context=CALL)
        except ValidationError as error:
            raise refusal(error) from None

    @classmethod
    def stored(cls, values: Mapping[str, Any]) -> Self:
        """Return the settings that a file holds; keys of other versions are passed over."""
        known = {name: _frozen(values[name]) for name in cls.model_fields if name in values}
        if not known:
            raise KeyError("settings")
        return cls.of(**known)

    def part(self, kind: type[Settings]) -> dict[str, Any]:
        """Return the values of those keys that other settings have as well."""
        return {name: getattr(self, name) for name in kind.model_fields}


def _frozen(value: Any) -> Any:
    """Return what a JSON text holds with tuples in place of lists."""
    if isinstance(value, dict):
        return {name: _frozen(one) for name, one in value.items()}
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


_COMMON = {
    "model": "model : Model\n    Structure, contacts and forces.",
    "observe": """observe : iterable of str, optional
    Degrees of freedom whose motion is kept. Default: all but modal coordinates
    ("mode-1", ...).""",
    "progress": """progress : callable, optional
    Called about ten times per second with the fraction of the work that is done.""",
}
"""What arguments mean that most analyses have."""


def configured(
    kind: type[Settings], *placed: str
) -> Callable[[Callable[..., _Result]], Callable[..., _Result]]:
    """Let a function take settings as its keywords.

    Parameters
    ----------
    kind : type of Settings
        The settings, which the function itself takes as one argument of this name.
    *placed : str
        Keys that may be given by position as well, after the function's own.

    Returns
    -------
    callable
        Decorator. Signature and documentation of the function have a parameter for every key.
    """

    def decorate(function: Callable[..., _Result]) -> Callable[..., _Result]:
        written = inspect.signature(function)
        own = [one for one in written.parameters.values() if one.name != "settings"]
        keys = kind.model_fields
        ordered = sorted(keys, key=lambda name: not keys[name].is_required())

        def of_kind(which: Any) -> list[inspect.Parameter]:
            return [one for one in own if one.kind is which]

        signature = inspect.Signature(
            [
                *of_kind(inspect.Parameter.POSITIONAL_OR_KEYWORD),
                *(_parameter(name, keys[name], placed=True) for name in placed),
                *(_parameter(name, keys[name]) for name in ordered if name not in placed),
                *of_kind(inspect.Parameter.KEYWORD_ONLY),
            ],
            return_annotation=written.return_annotation,
        )

        @wraps(function)
        def call(*args: Any, **keywords: Any) -> _Result:
            try:
                given = signature.bind(*args, **keywords).arguments
            except TypeError:
                raise CallError(str(misfit(call, args, keywords))) from None
            settings = kind.of(**{name: given.pop(name) for name in keys if name in given})
            return function(**given, settings=settings)

        call.__signature__ = signature  # type: ignore[attr-defined]
        call.__settings__ = kind  # type: ignore[attr-defined]
        call.__doc__ = _documented(function.__doc__ or "", signature, keys)
        return call

    return decorate


def _parameter(name: str, field: FieldInfo, *, placed: bool = False) -> inspect.Parameter:
    which = inspect.Parameter.POSITIONAL_OR_KEYWORD if placed else inspect.Parameter.KEYWORD_ONLY
    default = inspect.Parameter.empty if field.is_required() else field.default
    return inspect.Parameter(name, which, default=default, annotation=field.annotation)


def _documented(text: str, signature: inspect.Signature, keys: Mapping[str, FieldInfo]) -> str:
    """Complete the section "Parameters" by the keys, in the order of the signature."""
    section = _SECTION.search(text)
    if section is None:
        return text
    indent = section[1]
    entries = {name: textwrap.indent(said, indent) for name, said in _COMMON.items()}
    for block in re.split(rf"\n(?={indent}\S)", section[2]):
        names = block.split(" : ")[0].replace("*", "").split(", ")
        entries |= dict.fromkeys((name.strip() for name in names), block)
    entries |= {name: described(name, field, indent) for name, field in keys.items()}
    blocks = dict.fromkeys(entries[name] for name in signature.parameters if name in entries)
    head = text[: section.start(2)]
    return head + "\n".join(blocks) + text[section.end(2) :]


def described(name: str, field: FieldInfo, indent: str) -> str:
    """Return what numpydoc says of a key."""
    optional = "" if field.is_required() else ", optional"
    first = f"{indent}{name} : {type_in_words(field.annotation, field.metadata)}{optional}"
    inner = indent + _INDENT
    said = textwrap.wrap(
        field.description or "", _WIDTH, initial_indent=inner, subsequent_indent=inner
    )
    return "\n".join((first, *said))


def type_in_words(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    """Return a type as numpydoc writes it: ``int or "auto"``, ``{"newton", "broyden"}``."""
    for one in metadata:
        if isinstance(one, str):
            return one
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return type_in_words(parts[0], parts[1:])
    if origin in (Union, UnionType):
        return " or ".join(type_in_words(part) for part in parts if part is not NoneType)
    if origin is Literal:
        names = ", ".join(f'"{part}"' for part in parts)
        return f"{{{names}}}" if len(parts) > 1 else names
    if origin is tuple and parts[-1] is Ellipsis:
        return f"sequence of {type_in_words(parts[0])}"
    if origin is tuple:
        return f"({', '.join(map(type_in_words, parts))})"
    return str(getattr(annotation, "__name__", annotation))

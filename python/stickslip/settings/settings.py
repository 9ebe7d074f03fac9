"""Settings of an analysis, and how a function takes them as its keywords."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Self, TypeVar, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from stickslip import numpydoc
from stickslip.calls import misfit
from stickslip.checks import brief
from stickslip.errors import CallError, ModelError
from stickslip.model.model import Model, require_model
from stickslip.settings.entries import CALL, Table
from stickslip.settings.ranges import Or
from stickslip.settings.refusal import validated

_Result = TypeVar("_Result")
_INDENT = 4 * " "
_WIDTH = 100


class Settings(Table):
    """How an analysis is computed: every key with its default, bounds and meaning."""

    @classmethod
    def of(cls, **values: Any) -> Self:
        """Return settings of checked values."""
        return validated(cls, values, CALL)

    @classmethod
    def stored(cls, values: Mapping[str, Any]) -> Self:
        """Return the settings that a file holds; keys of other versions are passed over."""
        known = {name: _frozen(values[name]) for name in cls.model_fields if name in values}
        if cls.model_fields and not known:
            raise KeyError("settings")
        return cls.of(**known)

    def suited(self, model: Model) -> Self:
        """Return the settings with what a model decides, where they leave it to it."""
        return self

    def part(self, kind: type[Settings]) -> dict[str, Any]:
        """Return the values of those keys that other settings have as well."""
        return {name: getattr(self, name) for name in kind.model_fields}


def _frozen(value: Any) -> Any:
    """Return what a JSON text holds with tuples in place of lists."""
    if isinstance(value, dict):
        return {name: _frozen(one) for name, one in value.items()}
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def _require_progress(progress: object) -> None:
    if progress is not None and not callable(progress):
        raise ModelError(
            f"progress: {brief(progress)} cannot be called; give a function of a fraction"
        )


_CHECKS: dict[str, Callable[[object], None]] = {
    "model": require_model,
    "progress": _require_progress,
}
_SAID = {
    "model": "model : Model\n    Structure, contacts and forces.",
    "progress": """progress : callable, optional
    Called about ten times per second with the fraction of the work that is done.""",
}
_RAISED = {
    "ModelError": """
    If an argument is of the wrong type or outside its range, or the result would not fit into
    the memory.""",
    "Interrupted": """
    On Ctrl-C; its `result` holds what had been computed.""",
}


def configured(
    kind: type[Settings], *placed: str
) -> Callable[[Callable[..., _Result]], Callable[..., _Result]]:
    """Let an analysis take settings as its keywords.

    The function itself takes them as one argument, ``settings``; a table of a study file, whose
    keys are checked, is passed on as it is. Keys that are `placed` may be given by position as
    well, after the function's own. Signature and documentation have a parameter for every key;
    `model` and `progress` are checked, and documented like what most analyses raise.
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
            known = keywords.get("settings")
            if isinstance(known, kind):
                suited = known.suited(args[0]) if args and isinstance(args[0], Model) else known
                return function(*args, **keywords | {"settings": suited})
            try:
                given = signature.bind(*args, **keywords).arguments
            except TypeError:
                raise CallError(str(misfit(call, args, keywords))) from None
            for name, check in _CHECKS.items():
                if name in given:
                    check(given[name])
            settings = kind.of(**{name: given.pop(name) for name in keys if name in given})
            first = next(iter(given.values()))
            suited = settings.suited(first) if isinstance(first, Model) else settings
            return function(**given, settings=suited)

        call.__signature__ = signature  # type: ignore[attr-defined]
        call.__settings__ = kind  # type: ignore[attr-defined]
        call.__doc__ = _documented(function.__doc__ or "", signature, keys)
        return call

    return decorate


def _parameter(name: str, field: FieldInfo, *, placed: bool = False) -> inspect.Parameter:
    which = inspect.Parameter.POSITIONAL_OR_KEYWORD if placed else inspect.Parameter.KEYWORD_ONLY
    default = inspect.Parameter.empty if field.is_required() else field.default
    taken = _taken(field.annotation, field.metadata)
    return inspect.Parameter(name, which, default=default, annotation=taken)


def _taken(annotation: Any, metadata: Iterable[Any] = ()) -> Any:
    """Return the type of what a call gives; a text where study files write it otherwise."""
    for one in metadata:
        if isinstance(one, Or):
            return one.takes
    parts = get_args(annotation)
    if get_origin(annotation) is Annotated:
        return _taken(parts[0], parts[1:])
    taken = _taken(parts[0]) if NoneType in parts else annotation
    return f"{taken} | None" if isinstance(taken, str) else annotation


def _documented(text: str, signature: inspect.Signature, keys: Mapping[str, FieldInfo]) -> str:
    """Complete "Parameters" by the keys, in the order of the signature, and "Raises"."""
    sections = dict.fromkeys(("Parameters", "Returns", "Raises"), "") | numpydoc.sections(text)
    said = _SAID | numpydoc.entries(sections["Parameters"])
    said |= {name: described(name, field) for name, field in keys.items()}
    sections["Parameters"] = "\n".join(
        dict.fromkeys(said[name] for name in signature.parameters if name in said)
    )
    raised = numpydoc.entries(sections["Raises"])
    sections["Raises"] = "\n".join(
        f"{name}{common}{raised.get(name, '').removeprefix(name)}"
        for name, common in _RAISED.items()
    )
    return numpydoc.written(sections)


def described(name: str, field: FieldInfo) -> str:
    """Return what numpydoc says of a key."""
    optional = "" if field.is_required() else ", optional"
    first = f"{name} : {type_in_words(field.annotation, field.metadata)}{optional}"
    said = textwrap.fill(
        field.description or "", _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT
    )
    return f"{first}\n{said}"


def type_in_words(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    """Return a type as numpydoc writes it: ``int or "auto"``, ``{"newton", "broyden"}``."""
    for one in metadata:
        if isinstance(one, Or):
            return one.said
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

"""Functions that draw: their signatures, documentation and axes, from what is written once."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from types import NoneType, UnionType
from typing import (
    Any,
    Concatenate,
    Literal,
    ParamSpec,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from matplotlib import pyplot
from matplotlib.axes import Axes

from stickslip import numpydoc
from stickslip.calls import misfit
from stickslip.checks import choice, real_number
from stickslip.errors import CallError, ModelError
from stickslip.plot.arguments import of_kind
from stickslip.plot.style import finish, new_axes
from stickslip.settings.settings import type_in_words

P = ParamSpec("P")
Result = TypeVar("Result")
_MEANINGS = {
    "result": "What is drawn.",
    "results": "One or several of the same parameter, a line each.",
    "dof": "An observed degree of freedom.",
    "contact": "The contact, or one of its points.",
    "index": "Position of a solved point of the sweep; see `ForcedResponse.index`.",
    "table": "What `BladedDisk.nodal_diameters` returned, or the disk.",
}
"""What those parameters mean that several functions have beside their keywords."""
_RETURNS = "matplotlib.axes.Axes\n    The axes."
_RAISES = "ModelError\n    If an argument is of the wrong type, unknown, or has nothing to draw."


def figure(draw: Callable[Concatenate[Axes, P], None]) -> Callable[P, Axes]:
    """Let a function draw on the axes `ax`, those of a new figure by default, and return them."""

    def framed(ax: Axes | None, **arguments: Any) -> Axes:
        drawn = new_axes(ax)
        try:
            draw(drawn, **arguments)  # type: ignore[call-arg]
        except ModelError:
            if ax is None:
                pyplot.close()
            raise
        finish(drawn, made=ax is None, lengths=arguments.get("length_unit", "auto") == "auto")
        return drawn

    return _derived(framed, draw)


def keywords(function: Callable[P, Result]) -> Callable[P, Result]:
    """Let a function take its keywords with their defaults."""
    return _derived(function, function)


def _derived(call: Callable[..., Result], written: Callable[..., object]) -> Callable[..., Result]:
    """Return a call with the keywords of the options that a function is written with."""
    hints = get_type_hints(written)
    source = inspect.signature(written)
    *placed, starred = source.parameters.values()
    own = [one for one in placed if one.kind is not one.POSITIONAL_ONLY]
    (options,) = get_args(hints[starred.name])
    keys = get_type_hints(options, include_extras=True)
    which = inspect.Parameter.KEYWORD_ONLY
    returned = source.return_annotation if call is written else "Axes"
    signature = inspect.Signature(
        [one.replace(annotation=hints[one.name]) for one in own]
        + [
            inspect.Parameter(name, which, default=key.__metadata__[0], annotation=key.__origin__)
            for name, key in keys.items()
        ],
        return_annotation=returned,
    )
    kinds = {name: one.annotation for name, one in signature.parameters.items()}
    first, choices = own[0].name, {name: _texts(kind) for name, kind in kinds.items()}

    @wraps(written)
    def drawing(*args: Any, **given: Any) -> Result:
        try:
            bound = signature.bind(*args, **given)
        except TypeError:
            raise CallError(str(misfit(drawing, args, given))) from None
        for name, known in choices.items():
            default = signature.parameters[name].default
            value = bound.arguments.get(name, default)
            if known and value is not default:
                choice(value, name, known)
            if kinds[name] in (float, float | None) and value is not default and value is not None:
                real_number(value, name)
        if isinstance(kinds[first], type):
            of_kind(kinds[first], bound.arguments[first], first)
        bound.apply_defaults()
        return call(**bound.arguments)

    meanings = _MEANINGS | {name: key.__metadata__[1] for name, key in keys.items()}
    drawing.__signature__ = signature  # type: ignore[attr-defined]
    drawing.__doc__ = _documented(written.__doc__, signature, meanings)
    return drawing


def _texts(kind: Any) -> list[str]:
    """Return the texts among which a keyword chooses."""
    if get_origin(kind) in (Union, UnionType):
        return [text for part in get_args(kind) for text in _texts(part)]
    return list(get_args(kind)) if get_origin(kind) is Literal else []


def _documented(
    text: str | None, signature: inspect.Signature, meanings: Mapping[str, str]
) -> str | None:
    """Complete the sections of a text; its own are for what means more than elsewhere."""
    if text is None:  # python -OO
        return None
    sections = numpydoc.sections(text)
    own = numpydoc.entries(sections.pop("Parameters", ""))
    blocks = []
    for name, one in signature.parameters.items():
        optional = "" if one.default is one.empty else ", optional"
        said = textwrap.indent(textwrap.fill(meanings.get(name, ""), 96), "    ")
        block = f"{name} : {_in_words(one.annotation)}{optional}\n{said}"
        blocks.append(own.get(name, block))
    listed = "\n".join(dict.fromkeys(blocks))
    derived = {"": "", "Parameters": listed, "Returns": _RETURNS, "Raises": _RAISES}
    return numpydoc.written(derived | sections)


def _in_words(kind: Any) -> str:
    parts = [part for part in get_args(kind) if part is not NoneType]
    if get_origin(kind) in (Union, UnionType):
        return " or ".join(map(_in_words, parts))
    if get_origin(kind) is Sequence:
        return f"sequence of {_in_words(*parts)}"
    return "matplotlib.axes.Axes" if kind is Axes else type_in_words(kind)

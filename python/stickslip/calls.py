"""Calls that do not fit a signature: one line that names the keyword, instead of a TypeError.

Arrays of which entries are masked fit none: the numbers below the mask would be taken for given.
"""

from __future__ import annotations

import inspect
import sys
from abc import ABCMeta
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from types import FunctionType
from typing import Any

import numpy as np

from stickslip.checks import listed, unknown
from stickslip.errors import CallError, ModelError
from stickslip.misuse import FOREIGN, flags, misuse, passes_by_caller, require_flag

_PACKAGE = __name__.partition(".")[0]
_WRAPPED = "__stickslip_checked__"
_FEW, _DEEP = 100, 3
"""Members of a list, and lists in lists, in which masked arrays are looked for."""
_done: set[type] = set()


def checked_names(module: dict[str, Any], names: Iterable[str]) -> None:
    """Have all public functions and classes of a module checked, in place."""
    for name in names:
        module[name] = checked(module[name])


def checked(value: Any) -> Any:
    """Return a function that words what does not fit its signature; a class is changed in place.

    What it returns is checked as well, so that it holds for the methods of results. Signatures and
    documentation stay those of the function.
    """
    if isinstance(value, type):
        _check_class(value)
        return value
    if not isinstance(value, FunctionType) or hasattr(value, _WRAPPED):
        return value
    wrapper, name = _checked_function(value), value.__qualname__
    home = sys.modules[value.__module__]
    if getattr(home, name, None) is value:
        # Pickling finds functions there, and must find the same.
        setattr(home, name, wrapper)
    return wrapper


def _check_class(owner: type) -> None:
    ours = owner.__module__.partition(".")[0] == _PACKAGE
    if owner in _done or not ours or type(owner) not in (type, ABCMeta):
        return
    _done.add(owner)
    for base in owner.__bases__:
        _check_class(base)
    for name, value in list(vars(owner).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(value, FunctionType) and not hasattr(value, _WRAPPED):
            setattr(owner, name, _checked_function(value))
        elif isinstance(value, classmethod) and isinstance(value.__func__, FunctionType):
            setattr(owner, name, classmethod(_checked_function(value.__func__)))


def _checked_function(function: FunctionType) -> Callable[..., Any]:
    switches = flags(function)

    @wraps(function)
    def call(*args: Any, **keywords: Any) -> Any:
        for value in (*args, *keywords.values()):
            if _has_mask(value):
                raise _masked(function, args, keywords)
        for place, name in switches:
            require_flag(args[place] if place < len(args) else keywords.get(name), name)
        try:
            result = function(*args, **keywords)
        except FOREIGN as error:
            refused = isinstance(error, ModelError)
            reason = None if refused else _reason(function, args, keywords, error)
            if reason is None:
                raise
            raise reason from (None if isinstance(reason, CallError) else error)
        if type(result) not in _done:
            _check_class(type(result))
        return result

    setattr(call, _WRAPPED, True)
    return call


def _reason(
    function: FunctionType,
    args: tuple[object, ...],
    keywords: Mapping[str, object],
    error: Exception,
) -> ModelError | None:
    """Return what is wrong with a call that failed; None if nothing is found."""
    trace = error.__traceback__
    # Only the call itself has no frame of its own.
    if isinstance(error, TypeError) and trace is not None and trace.tb_next is None:
        message = misfit(function, args, keywords)
        return None if message is None else CallError(message)
    return None if passes_by_caller(trace) else misuse(function, args, keywords)


def _has_mask(value: object, depth: int = 0) -> bool:
    """Return whether entries of an array, or of one in a list, are masked."""
    if isinstance(value, np.ndarray):
        return type(value) is not np.ndarray and bool(np.ma.is_masked(value))
    if depth == _DEEP or not isinstance(value, list | tuple | dict) or len(value) > _FEW:
        return False
    members = value.values() if isinstance(value, dict) else value
    return any(_has_mask(one, depth + 1) for one in members)


def _masked(
    function: FunctionType, args: tuple[object, ...], keywords: Mapping[str, object]
) -> ModelError:
    names = list(inspect.signature(function).parameters)
    given = {**dict(zip(names, args, strict=False)), **keywords}
    name = next((name for name, value in given.items() if _has_mask(value)), "arguments")
    return ModelError(
        f"{name}: masked entries, which have no value; give numpy.ma.compressed(...) of a list, or "
        "numpy.ma.filled(..., value)"
    )


def misfit(
    function: Callable[..., Any], args: tuple[object, ...], keywords: Mapping[str, object]
) -> str | None:
    """Word what of a call does not fit; None if nothing is found."""
    parameters = list(inspect.signature(function).parameters.values())
    name = function.__name__
    if parameters and parameters[0].name in ("self", "cls") and args:
        kind = args[0] if isinstance(args[0], type) else type(args[0])
        name = kind.__name__ if name == "__init__" else f"{kind.__name__}.{name}"
        parameters, args = parameters[1:], args[1:]
    fixed = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    known = [one for one in parameters if one.kind not in fixed]
    names = [one.name for one in known]
    placed = [one.name for one in known if one.kind is not inspect.Parameter.KEYWORD_ONLY]
    for keyword in keywords:
        if keyword not in names:
            return f"{name}: {unknown('keyword', keyword, names)}"
        if keyword in placed[: len(args)]:
            return f"{name}: {keyword} is given twice, by position and by name; give it once"
    if len(args) > len(placed):
        others = [one for one in names if one not in placed and one not in keywords]
        remedy = f"give the others by name: {listed(others)}" if others else "leave the others out"
        return f"{name}: {len(args)} arguments without a name, and it takes {len(placed)}; {remedy}"
    given = {*placed[: len(args)], *keywords}
    for one in known:
        if one.default is inspect.Parameter.empty and one.name not in given:
            return f"{name}: {one.name} is missing; give {one.name}=..."
    return None


def outside() -> int:
    """Return how far up the caller of this package is, for a warning of the function that asks."""
    frame, level = sys._getframe(1), 1
    while frame.f_back and frame.f_globals["__name__"].partition(".")[0] == "stickslip":
        frame, level = frame.f_back, level + 1
    return level

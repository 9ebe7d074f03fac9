"""Arguments that are not what their function says that it takes, for the line that refuses them.

Most arguments are checked where they are used, in words of their own. Where one is not and the call
fails, what it was given is compared with its annotation: if it cannot be that, the line says so
instead of what Python stumbled over. A failure of which no argument is to blame stays as it is.
"""

from __future__ import annotations

import ast
import inspect
import sys
import sysconfig
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from itertools import islice
from numbers import Integral
from os import PathLike
from types import TracebackType
from typing import Any

import numpy as np

from stickslip.checks import brief, real_number
from stickslip.errors import ModelError

FOREIGN = (TypeError, ValueError, AttributeError, LookupError, ArithmeticError)
"""What Python raises where an argument is not what it should be."""

_MANY = 1000
"""Members of a list that are looked at."""
_PACKAGE = __name__.partition(".")[0]
_PATHS = ("PathLike",)
_LISTS = ("Iterable", "Sequence", "Collection", "list", "tuple")
_TABLES = ("Mapping", "dict")
_ARRAYS = ("ArrayLike", "MatrixLike", "NDArray", "Matrix", "Float", "Places")
_WORDS = {
    "bool": "True or False",
    "int": "a whole number",
    "float": "a number",
    "str": "text",
    **dict.fromkeys(_PATHS, "a path"),
    **dict.fromkeys(_LISTS, "a list"),
    **dict.fromkeys(_TABLES, "a table, {name: ...}"),
    **dict.fromkeys(_ARRAYS, "numbers in a list or an array"),
    "Callable": "a function",
}
_LIBRARIES = (*{sysconfig.get_path(one) for one in ("stdlib", "purelib", "platlib")}, "<")
"""Where code lies that is not the caller's; what is made while it runs has a name in brackets."""
_Scope = Callable[[str], Any]
"""What a name of an annotation stands for."""


def misuse(
    function: Callable[..., Any], args: tuple[object, ...], keywords: Mapping[str, object]
) -> ModelError | None:
    """Return the error that names the first argument which is not what it should be."""
    plain = inspect.unwrap(function)
    try:
        signature = inspect.signature(function)
        given = signature.bind(*args, **keywords).arguments
    except TypeError:
        return None

    def scope(name: str) -> Any:
        return plain.__globals__.get(name, getattr(sys.modules[_PACKAGE], name, None))

    texts: list[ModelError] = []
    for name, value in given.items():
        parameter = signature.parameters[name]
        variable = parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
        if variable or value is parameter.default or not isinstance(parameter.annotation, str):
            continue
        node = _tree(parameter.annotation)
        if node is None or (fits := _fits(value, node, scope)):
            continue
        error = ModelError(f"{name}: {brief(value)} cannot be used; give {_words(node)}")
        if fits is False:
            return error
        # A text may be a number with its unit, but not everywhere.
        if isinstance(value, str) and parameter.annotation in ("float", "float | None"):
            texts.append(error)
    return texts[0] if texts else None


def passes_by_caller(trace: TracebackType | None) -> bool:
    """Return whether an error comes from a function that was given.

    Methods such as `__getitem__` are no function of their own: what fails in them is their object.
    """
    while trace is not None:
        frame, trace = trace.tb_frame, trace.tb_next
        name = str(frame.f_globals.get("__name__", "")).partition(".")[0]
        code = frame.f_code
        foreign = name != _PACKAGE and not code.co_filename.startswith(_LIBRARIES)
        if foreign and not code.co_name.startswith("__"):
            return True
    return False


def flags(function: Callable[..., Any]) -> tuple[tuple[int, str], ...]:
    """Return position and name of the parameters that are True or False."""
    parameters = inspect.signature(function).parameters.values()
    return tuple(
        (place, one.name)
        for place, one in enumerate(parameters)
        if one.annotation in ("bool", "bool | None", bool, bool | None)
    )


def require_flag(value: object, entry: str) -> None:
    """Refuse what is neither True nor False: "no" would be taken for True."""
    if value is not None and not isinstance(value, bool | np.bool_):
        raise ModelError(f"{entry}: {brief(value)}; give True or False")


@cache
def _tree(annotation: str) -> ast.expr | None:
    try:
        return ast.parse(annotation, mode="eval").body
    except SyntaxError:
        return None


def _fits(value: Any, node: ast.expr, scope: _Scope) -> bool | None:
    """Return whether a value is of a type; None if that cannot be told."""
    if isinstance(node, ast.BinOp):
        sides = _fits(value, node.left, scope), _fits(value, node.right, scope)
        return True if True in sides else None if None in sides else False
    try:
        return _is(value, node, scope)
    except Exception:
        # Foreign classes may fail in any way.
        return False


def _is(value: Any, node: ast.expr, scope: _Scope) -> bool | None:
    name, parts = _parted(node)
    if name in ("Any", "object"):
        return None
    if name == "None":
        return value is None
    if name == "bool":
        return isinstance(value, bool | np.bool_)
    if name == "int":
        return isinstance(value, Integral) and not isinstance(value, bool)
    if name == "float":
        return _is_number(value)
    if name == "Literal":
        return any(isinstance(one, ast.Constant) and one.value == value for one in parts)
    if name == "Callable":
        return callable(value)
    if name in _TABLES:
        return isinstance(value, Mapping) and _all(value.values(), parts[1:], scope)
    if name in _LISTS:
        return not isinstance(value, str | bytes) and _all(
            value, parts, scope, fixed=name == "tuple"
        )
    if name in _ARRAYS:
        return (name == "MatrixLike" and hasattr(value, "toarray")) or _is_array(value)
    known = str if name == "str" else PathLike if name in _PATHS else scope(name)
    if not isinstance(known, type) or getattr(known, "_is_protocol", False):
        return None
    return isinstance(value, known)


def _parted(node: ast.expr) -> tuple[str, list[ast.expr]]:
    """Return the name of a type and what stands in its brackets."""
    parts: list[ast.expr] = []
    if isinstance(node, ast.Subscript):
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        node = node.value
    if isinstance(node, ast.Constant):
        return str(node.value), parts
    return node.attr if isinstance(node, ast.Attribute) else ast.unparse(node), parts


def _all(
    values: Iterable[Any], kinds: list[ast.expr], scope: _Scope, *, fixed: bool = False
) -> bool | None:
    """Return whether the members of a list are of a type, or each of its own if they are fixed."""
    walk = iter(values)
    # A generator can be gone through but once.
    if walk is values or not kinds:
        return None if walk is values else True
    members = list(islice(walk, _MANY))
    if len(kinds) == 1 or not fixed or ast.unparse(kinds[-1]) == "...":
        kinds = [kinds[0]] * len(members)
    if len(kinds) != len(members):
        return False
    found = [_fits(*pair, scope) for pair in zip(members, kinds, strict=True)]
    return False if False in found else None if None in found else True


def _is_number(value: object) -> bool | None:
    if isinstance(value, str):
        return None
    real_number(value, "", finite=False)
    return True


def _is_array(value: object) -> bool:
    if isinstance(value, str | bytes):
        return False
    return np.asarray(value).dtype.kind in "biufc"


def _words(node: ast.expr) -> str:
    """Say what is taken."""
    if isinstance(node, ast.BinOp):
        sides = [_words(one) for one in (node.left, node.right)]
        return " or ".join(dict.fromkeys(one for one in sides if one != "None"))
    name, parts = _parted(node)
    if name == "Literal":
        return " or ".join(ast.unparse(one) for one in parts)
    if name in _WORDS or name == "None":
        return _WORDS.get(name, name)
    public = name in getattr(sys.modules[_PACKAGE], "__all__", ())
    return f"ss.{name}(...)" if public else f"a {name}"

"""Writes `python/stickslip/__init__.pyi`: what the package exports, with all keys of all settings.

Editors and type checkers read signatures from there; at run time they are made from the settings.
"""

from __future__ import annotations

import ast
import inspect
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import stickslip as ss

STUB = Path(ss.__file__).with_suffix(".pyi")
_PLAIN = {
    "ArrayLike": "numpy.typing",
    "Contacts": "stickslip.settings.variation",
    "Iterable": "collections.abc",
    "Literal": "typing",
    "Mapping": "collections.abc",
    "PathLike": "os",
    "Sequence": "collections.abc",
}
"""Where types of keys come from."""
_HEAD = '"""What the package exports; written by `docs/make_stub.py`."""\n\n'


def stub() -> str:
    """Return the stub as it should be."""
    imports = {f"from stickslip import {name} as {name}" for name in ss._MODULES}
    functions = []
    for name, home in ss._HOMES.items():
        value = getattr(ss, name)
        if hasattr(value, "__settings__"):
            needed, text = _function(name, value)
            imports |= needed
            functions.append(text)
        else:
            imports.add(f"from stickslip.{home} import {name} as {name}")
    plain = _HEAD + "\n".join(sorted(imports)) + "\n\n" + "\n".join(sorted(functions))
    sorted_imports = _ruff(plain, "check", "--fix", "--quiet", "--exit-zero", "--select", "I")
    return _ruff(sorted_imports, "format")


def _function(name: str, function: Any) -> tuple[set[str], str]:
    """Return what a function of settings imports, and its signature."""
    module = sys.modules[function.__module__]
    origins = _origins(ast.parse(Path(inspect.getfile(module)).read_text("utf-8")))
    signature = inspect.signature(function)
    given, returned = [], signature.return_annotation
    starred = False
    for one in signature.parameters.values():
        if one.kind is one.KEYWORD_ONLY and not starred:
            given.append("*")
            starred = True
        kind = one.annotation if isinstance(one.annotation, str) else code(one.annotation)
        default = "" if one.default is one.empty else f" = {one.default!r}"
        given.append(f"{one.name}: {kind}{default}")
    text = f"def {name}({', '.join(given)}, ) -> {returned}: ..."
    known = {node.id for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name)}
    plain = _PLAIN | origins
    needed = known & plain.keys() - {*ss.__all__}
    return {f"from {plain[one]} import {one}" for one in needed}, text


def _origins(tree: ast.AST) -> dict[str, str]:
    """Return the modules that the names of a module come from."""
    return {
        alias.asname or alias.name: str(node.module)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }


def code(annotation: Any) -> str:
    """Return a type as it is written; where tuples are kept, any sequence may be given."""
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return code(parts[0])
    if origin in (Union, UnionType):
        return " | ".join(code(part) for part in parts)
    if origin is Literal:
        return f"Literal[{', '.join(map(repr, parts))}]"
    if origin is tuple and parts[-1] is Ellipsis:
        return f"Sequence[{code(parts[0])}]"
    if origin is tuple:
        return f"tuple[{', '.join(map(code, parts))}]"
    return "None" if annotation is NoneType else str(annotation.__name__)


def _ruff(text: str, *command: str) -> str:
    arguments: Iterable[str] = (*command, f"--stdin-filename={STUB}", "-")
    done = subprocess.run(
        [sys.executable, "-m", "ruff", *arguments],
        input=text,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


if __name__ == "__main__":
    STUB.write_text(stub(), "utf-8")

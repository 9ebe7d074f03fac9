"""Shows in the pages what is derived at run time: parameters of functions, keys of settings."""

from __future__ import annotations

import inspect
import re
from importlib import import_module
from inspect import formatannotation
from typing import Any

import griffe

from stickslip.settings.settings import Settings, described


class Derived(griffe.Extension):
    """Takes signatures, keys and what is said of them from the objects themselves."""

    def on_function_instance(self, *, func: griffe.Function, **_: Any) -> None:
        """Document a function as `help` does."""
        derived = {"configured", "figure", "keywords"}
        if derived.isdisjoint(str(one.value).partition("(")[0] for one in func.decorators):
            return
        value = getattr(import_module(func.module.path), func.name)
        signature = inspect.signature(value)
        func.docstring = _docstring(inspect.cleandoc(value.__doc__), func)
        if str(func.returns) == "None":  # a function that draws is written without its axes
            func.returns = _annotation(signature.return_annotation)
        func.parameters = griffe.Parameters(
            *(
                griffe.Parameter(
                    one.name,
                    kind=getattr(griffe.ParameterKind, one.kind.name.lower()),
                    annotation=_annotation(one.annotation),
                    default=None if one.default is one.empty else repr(one.default),
                )
                for one in signature.parameters.values()
            )
        )

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        """Document the keys of settings, with those of their bases."""
        if not cls.module.path.startswith("stickslip.settings."):
            return
        kind = getattr(import_module(cls.module.path), cls.name, None)
        if not (isinstance(kind, type) and issubclass(kind, Settings)) or kind is Settings:
            return
        keys = "\n".join(described(name, one) for name, one in kind.model_fields.items())
        said = f"{inspect.cleandoc(kind.__doc__ or '')}\n\nAttributes\n----------\n{keys}"
        cls.docstring = _docstring(said, cls)
        for name in kind.model_fields:
            cls.members.pop(name, None)


def _annotation(kind: Any) -> str:
    """Return a type as it is written, without the modules it comes from."""
    return kind if isinstance(kind, str) else re.sub(r"(\w+\.)+", "", formatannotation(kind))


def _docstring(text: str, parent: Any) -> griffe.Docstring:
    return griffe.Docstring(text, parent=parent, parser="numpy")

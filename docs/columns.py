"""What the pages say of results: what columns, and methods by their parameters, say themselves."""

from __future__ import annotations

from typing import Any

import griffe


class Columns(griffe.Extension):
    """Gives results, their columns and what shows one the documentation that they have."""

    def on_class_instance(self, *, cls: griffe.Class, **_: Any) -> None:
        """List the columns of a class, or the attributes of a result."""
        if cls.bases and cls.path.startswith("stickslip.results."):
            _document(cls)

    def on_function_instance(self, *, func: griffe.Function, **_: Any) -> None:
        """Document a method of a result as `help` does."""
        of_class = func.parent is not None and func.parent.is_class
        if of_class and func.docstring and func.path.startswith("stickslip.results."):
            _document(func)

    def on_attribute_instance(self, *, attr: griffe.Attribute, **_: Any) -> None:
        """Say what a property says, what the column of an attribute is, or which function draws."""
        if (
            "property" in attr.labels
            and attr.docstring
            and attr.path.startswith("stickslip.results.")
        ):
            _document(attr)
        if not isinstance(attr.value, griffe.ExprCall):
            return
        kind = str(attr.value.function)
        if kind.startswith("Shown"):
            attr.annotation = attr.value.function.slice
            attr.value, attr.labels = None, {"property"}
            _document(attr)
        elif kind == "Drawn":
            name = griffe.dynamic_import(attr.path).__name__
            text = f"Draw it: the method is the function [`{name}`][stickslip.plot.{name}]."
            attr.value, attr.labels = None, {"method"}
            attr.docstring = griffe.Docstring(text, parent=attr)


def _document(what: griffe.Object) -> None:
    if text := griffe.dynamic_import(what.path).__doc__:
        what.docstring = griffe.Docstring(text, parent=what)

"""What the pages say of result columns: what the columns themselves say."""

from __future__ import annotations

from typing import Any

import griffe


class Columns(griffe.Extension):
    """Gives classes of columns, and attributes that show one, the documentation that they have."""

    def on_class_instance(self, *, cls: griffe.Class, **_: Any) -> None:
        """List the columns of a class."""
        if any(str(base).endswith(("Columns", "Arrays")) for base in cls.bases):
            _document(cls)

    def on_attribute_instance(self, *, attr: griffe.Attribute, **_: Any) -> None:
        """Say what the column of an attribute is."""
        if isinstance(attr.value, griffe.ExprCall) and str(attr.value.function).startswith("Shown"):
            attr.annotation = attr.value.function.slice
            attr.value, attr.labels = None, {"property"}
            _document(attr)


def _document(what: griffe.Object) -> None:
    text = griffe.dynamic_import(what.path).__doc__
    what.docstring = griffe.Docstring(text, parent=what)

"""Functions that draw, as methods of what they draw.

`stickslip.plot` and `stickslip.views` stand above the results and need Matplotlib and Rich: they
are loaded when something is drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import MethodType
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from matplotlib import axes

Axes: TypeAlias = "axes.Axes"
"""Of Matplotlib, which takes long to load."""


class _Plots:
    """The functions of `stickslip.plot`."""

    def __getattr__(self, name: str) -> Callable[..., Axes]:
        function: Callable[..., Axes] = getattr(import_module(__package__).plot, name)
        return function


plots = _Plots()


class InNotebooks:
    """A result, of which notebooks show the tables."""

    def _repr_html_(self) -> str | None:
        views = import_module(f"{__package__}.views.notebook")
        shown: str | None = views.html_of(self)
        return shown


class Drawn:
    """A function of `stickslip.plot` as a method: ``plot = Drawn("curves")``.

    It has the signature and the documentation of the function.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, drawn: object, owner: object) -> Callable[..., Axes]:
        function = getattr(plots, self.name)
        return function if drawn is None else MethodType(function, drawn)

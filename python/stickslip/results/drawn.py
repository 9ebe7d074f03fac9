"""Functions that draw results, as methods of these results."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import MethodType
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, overload

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip import plot as plots
else:

    class _Plots:
        def __getattr__(self, name):
            return getattr(import_module("stickslip.plot"), name)

    plots = _Plots()
    """`stickslip.plot`, which is loaded when something is drawn."""

__all__ = ["Drawn", "plots"]

Options = ParamSpec("Options")


class Drawn(Generic[Options]):
    """A function of `stickslip.plot` as a method: ``plot = Drawn(lambda: plots.curves)``.

    It has the signature and the documentation of the function.
    """

    def __init__(self, function: Callable[[], Callable[Concatenate[Any, Options], Axes]]) -> None:
        self.function = function

    @overload
    def __get__(self, result: None, owner: Any) -> Callable[Concatenate[Any, Options], Axes]: ...
    @overload
    def __get__(self, result: object, owner: Any) -> Callable[Options, Axes]: ...
    def __get__(self, result: Any, owner: Any) -> Any:
        function = self.function()
        return function if result is None else MethodType(function, result)

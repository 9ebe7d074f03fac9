"""One table or figure of the dissertation, and the function that reproduces it."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import CodeType, FunctionType
from typing import TypeAlias

from stickslip_reproduce.numbers import Numbers
from stickslip_reproduce.resolution import Resolution

__all__ = ["Compute", "Item", "reproduces"]

Compute: TypeAlias = Callable[[Resolution], Numbers]


@dataclass(frozen=True, kw_only=True)
class Item:
    """One table or figure of the dissertation.

    Parameters
    ----------
    name : str
        "table-2.3", "fig-4.22".
    see : str
        What to see in it.
    compute : callable
        Computes its numbers at a resolution.
    corrected : tuple of str, optional
        What is wrong in print, one line each.
    inferred : tuple of str, optional
        What the text leaves open and how it was chosen, one line each.
    """

    name: str
    see: str
    compute: Compute
    corrected: tuple[str, ...] = ()
    inferred: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """How the dissertation calls it: "Table 2.3", "Fig. 4.22"."""
        return heading(self.name)

    @property
    def code(self) -> str:
        """The source of the function, with what it calls in its own module."""
        functions = _with_helpers(inspect.unwrap(self.compute))
        return "\n\n".join(_source(function) for function in functions)


def heading(name: str) -> str:
    """Return how the dissertation calls it: "Table 2.3", "Fig. 4.22", "Section 7.2, wedge"."""
    kind, _, number = name.partition("-")
    if kind not in ("table", "fig"):
        return f"Section {kind}, {number.replace('-', ' ')}"
    return f"{'Table' if kind == 'table' else 'Fig.'} {number}"


def reproduces(
    name: str, see: str, *, corrected: tuple[str, ...] = (), inferred: tuple[str, ...] = ()
) -> Callable[[Compute], Item]:
    """Make an item of the function that computes its numbers; see `Item`."""

    def make(compute: Compute) -> Item:
        return Item(
            name=name,
            see=" ".join(see.split()),
            compute=compute,
            corrected=corrected,
            inferred=inferred,
        )

    return make


def _with_helpers(function: Compute) -> list[FunctionType]:
    """Return a function and those of its module that it calls, directly or not, in this order."""
    if not isinstance(function, FunctionType):
        return []
    found = [function]
    for one in found:
        for name in _names(one.__code__):
            # What keeps its results is shown like any other function.
            other = inspect.unwrap(one.__globals__.get(name))  # type: ignore[arg-type]
            if (
                isinstance(other, FunctionType)
                and other.__module__ == function.__module__
                and other not in found
            ):
                found.append(other)
    return found


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for part in code.co_consts:
        if isinstance(part, CodeType):
            yield from _names(part)


def _source(function: FunctionType) -> str:
    """Return the source without the decorator, which holds the texts."""
    text = textwrap.dedent(inspect.getsource(function))
    return text[text.index("def ") :].rstrip()

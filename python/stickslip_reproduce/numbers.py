"""What a reproduction computes: curves, tables and the few numbers that matter, without looks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from stickslip_reproduce.resolution import Float

__all__ = ["Axis", "Cell", "Fact", "Kind", "Numbers", "Panel", "Plot", "Series", "Table"]

Cell: TypeAlias = str | float | None
"""A word, a number, or nothing."""
Kind: TypeAlias = Literal["line", "marks", "dots", "limit"]
"""How a series is drawn."""


@dataclass(frozen=True)
class Axis:
    """A quantity, the SI unit it is stored in, and the unit it is drawn in.

    Parameters
    ----------
    quantity : str
        What it is.
    unit : str, optional
        SI unit; none for pure numbers.
    drawn : str, optional
        Unit on the axis. Default: the SI unit.
    factor : float, optional
        From the SI unit to the one that is drawn.
    log : bool, optional
        Whether the axis is logarithmic.
    names : tuple of str, optional
        What stands at 0, 1, 2, ... instead of numbers.
    """

    quantity: str
    unit: str = ""
    drawn: str = ""
    factor: float = 1.0
    log: bool = False
    names: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """Heading of a column of numbers in SI units."""
        return f"{self.quantity} [{self.unit}]" if self.unit else self.quantity

    @property
    def label(self) -> str:
        """Label of the axis."""
        unit = self.drawn or self.unit
        return f"{self.quantity} [{unit}]" if unit else self.quantity


@dataclass(frozen=True, eq=False)
class Series:
    """A curve or a row of marks.

    Parameters
    ----------
    label : str
        What it is; series of one label look alike in all panels.
    x, y : array_like, shape (n,)
        Coordinates in SI units.
    kind : {"line", "marks", "dots", "limit"}, optional
        How it is drawn: as a curve, as marks, as dots, or as a broad pale curve behind the others.
    pair : int, optional
        Series of one number share a colour. Default: a colour of its own.
    """

    label: str
    x: Float
    y: Float
    kind: Kind = "line"
    pair: int | None = None

    def __init__(
        self,
        label: str,
        x: ArrayLike,
        y: ArrayLike,
        kind: Kind = "line",
        pair: int | None = None,
    ) -> None:
        ordinates = np.array(y, dtype=np.float64)
        abscissae = np.array(x, dtype=np.float64)
        if abscissae.ndim != 1 or abscissae.shape != ordinates.shape:
            raise ValueError(f"series {label!r}: shapes {abscissae.shape} and {ordinates.shape}")
        abscissae.flags.writeable = ordinates.flags.writeable = False
        for name, value in (
            ("label", label),
            ("x", abscissae),
            ("y", ordinates),
            ("kind", kind),
            ("pair", pair),
        ):
            object.__setattr__(self, name, value)


@dataclass(frozen=True, eq=False)
class Panel:
    """Series on one pair of axes.

    Parameters
    ----------
    series : tuple of Series
        What is drawn.
    title : str, optional
        What stands above.
    y : Axis, optional
        Only where it is not that of the plot.
    enlarged : (float, float), optional
        Range of abscissae that an inset shows enlarged, in SI units.
    """

    series: tuple[Series, ...]
    title: str = ""
    y: Axis | None = None
    enlarged: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Plot:
    """Panels, and the quantities on their axes."""

    x: Axis
    y: Axis
    panels: tuple[Panel, ...]


@dataclass(frozen=True)
class Table:
    """Rows of words and numbers, in SI units."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"row {row} does not have the columns {self.columns}")

    def column(self, name: str) -> list[Cell]:
        """Return the cells of a column."""
        place = self.columns.index(name)
        return [row[place] for row in self.rows]


@dataclass(frozen=True)
class Fact:
    """A number that a reproduction shows, beside the printed one where there is one."""

    what: str
    value: float
    unit: str = ""
    printed: float | None = None


@dataclass(frozen=True, eq=False)
class Numbers:
    """All that a table or figure consists of."""

    plot: Plot
    facts: tuple[Fact, ...] = ()
    table: Table | None = None

    def __post_init__(self) -> None:
        names = [fact.what for fact in self.facts]
        if len(set(names)) < len(names):
            raise ValueError("two facts have the same name")

    def fact(self, what: str) -> float:
        """Return the value of a fact.

        Raises
        ------
        KeyError
            If there is no such fact.
        """
        return {fact.what: fact.value for fact in self.facts}[what]

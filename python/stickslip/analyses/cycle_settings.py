"""How limit cycles are computed."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import Span, tolerance_of
from stickslip.analyses.variation import Variation
from stickslip.checks import brief, choice, real_number, whole_number
from stickslip.errors import ModelError

__all__ = ["LOWEST_RATIO", "MOST_HARMONICS", "CycleMethod", "CycleSettings", "wanted"]

CycleMethod = Literal["newton", "exact"]

LOWEST_RATIO = 0.01
"""Ratio at which whole branches begin and end."""

MOST_HARMONICS = 1000
"""Highest harmonic that may be kept."""


@dataclass(frozen=True, kw_only=True)
class CycleSettings:
    """How limit cycles are computed.

    Parameters
    ----------
    mode : int
        Mode of the stuck structure that the branch begins with, counted from 0.
    variation : Variation or None
        The parameter of contacts that is followed; None for the ratio r.
    ratio : float
        r, where a parameter of contacts is followed.
    values : tuple of float or None
        Values of what is followed at which cycles are wanted; None for the whole branch.
    span : (float, float)
        Range of what is followed.
    harmonics : int or "auto"
        Harmonics kept; of exact orbits the highest reported.
    method : {"newton", "exact"}
        Harmonic balance, or exact orbits by shooting.
    tolerance : float
        Relative accuracy that automatic harmonics aim at.
    stability : bool
        Whether Floquet multipliers are computed.
    max_harmonics, max_points : int
        Highest harmonic that may be kept, and most points of a branch.

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    mode: int = 0
    variation: Variation | None = None
    ratio: float = 1.0
    values: tuple[float, ...] | None = None
    span: Span = (LOWEST_RATIO, inf)
    harmonics: int | Literal["auto"] = 31
    method: CycleMethod = "newton"
    tolerance: float = 1e-3
    stability: bool = True
    max_harmonics: int = 255
    max_points: int = 5000

    def __post_init__(self) -> None:
        whole_number(self.mode, "mode")
        ratio = real_number(self.ratio, "ratio")
        if ratio <= 0.0:
            raise ModelError(f"ratio: {ratio:g} must be above 0")
        if self.harmonics != "auto":
            if isinstance(self.harmonics, str):
                raise ModelError(f'harmonics: {self.harmonics!r}; give a number or "auto"')
            whole_number(self.harmonics, "harmonics", smallest=1, largest=MOST_HARMONICS)
        choice(self.method, "method", get_args(CycleMethod))
        object.__setattr__(self, "tolerance", tolerance_of(self.tolerance))
        if not isinstance(self.stability, bool | np.bool_):
            raise ModelError(f"stability: {brief(self.stability)}; give True or False")
        whole_number(self.max_harmonics, "max_harmonics", smallest=1, largest=MOST_HARMONICS)
        whole_number(self.max_points, "max_points", smallest=2)

    @property
    def followed(self) -> str:
        """What is followed: "ratio", "stiffness" or "slip_force"."""
        return "ratio" if self.variation is None else self.variation.parameter

    @property
    def unit(self) -> str:
        """Unit of what is followed."""
        return "1" if self.variation is None else self.variation.unit


def wanted(
    given: ArrayLike | Span | None, entry: str, span: Span
) -> tuple[tuple[float, ...] | None, Span]:
    """Return the values at which cycles are wanted, or none, and the range.

    Parameters
    ----------
    given : array_like, (float, float) or None
        Values; a tuple of two numbers is a range.
    entry : str
        Its name.
    span : (float, float)
        The range where nothing is given.

    Raises
    ------
    ModelError
        If a value is not a finite number above 0, or a range has no two different ends.
    """
    if given is None:
        return None, span
    if isinstance(given, tuple) and len(given) == 2:
        low, high = sorted(
            real_number(end, f"{entry}: end of the range", finite=False) for end in given
        )
        if not 0.0 < low < high:
            raise ModelError(f"{entry}: the range ({low:g}, {high:g}) must have two ends above 0")
        return None, (low, high)
    try:
        values = np.atleast_1d(np.asarray(given))
    except ValueError:
        raise ModelError(f"{entry}: a ragged list; give one list of values") from None
    if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
        raise ModelError(f"{entry}: {brief(given)}; give a list of numbers above 0, or (from, to)")
    numbers = np.array(values, dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(numbers) & (numbers > 0.0)))
    if bad.size:
        raise ModelError(f"{entry}[{bad[0]}] is {numbers[bad[0]]:g}; give finite values above 0")
    return tuple(map(float, np.unique(numbers))), (min(span[0], float(numbers.min())), span[1])

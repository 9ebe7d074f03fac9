"""How the disks of a mistuning study are made and computed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from stickslip.analyses.arguments import Residual, Span, span_of
from stickslip.analyses.forced_response import MAX_HARMONICS, MAX_ITERATIONS, Settings
from stickslip.checks import choice, whole_number
from stickslip.disk.pattern import DISTRIBUTIONS, Distribution
from stickslip.results.arrays import Measure

if TYPE_CHECKING:
    from stickslip._core import Quest
    from stickslip.model import Model

__all__ = ["MistuningSettings"]


@dataclass(frozen=True, kw_only=True)
class MistuningSettings:
    """How the disks of a mistuning study are made and computed.

    Parameters
    ----------
    span : (float, float)
        Range of frequencies in which peaks are the highest points [rad/s].
    distribution : {"normal", "uniform"} or None
        What patterns are drawn from; None: they were given.
    seed : int or None
        Of the patterns drawn.
    measure : {"half_range", "max", "fundamental"}
        Measure of the amplitudes.
    harmonics, tolerance, residual, max_harmonics, max_iterations
        See `stickslip.forced_response`.

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    span: Span
    distribution: Distribution | None = "normal"
    seed: int | None = 0
    measure: Measure = "half_range"
    harmonics: int | Literal["auto"] = "auto"
    tolerance: float = 1e-3
    residual: Residual = "centred"
    max_harmonics: int = MAX_HARMONICS
    max_iterations: int = MAX_ITERATIONS

    def __post_init__(self) -> None:
        choice(self.measure, "measure", get_args(Measure))
        if self.distribution is not None:
            choice(self.distribution, "distribution", DISTRIBUTIONS)
        if self.seed is not None:
            whole_number(self.seed, "seed")
        low, high = span_of(self.span)
        balance = Settings(
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            max_harmonics=self.max_harmonics,
            max_iterations=self.max_iterations,
        )
        checked = {
            "span": (min(low, high), max(low, high)),
            "tolerance": balance.tolerance,
            "residual": balance.residual,
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def quest(self, model: Model, groups: list[list[str]]) -> Quest:
        """Return what the compiled core is to seek, the highest of each group of DOFs."""
        return {
            "groups": [[model.structure.index(dof) for dof in group] for group in groups],
            "measure": self.measure,
            "omega": self.span,
            "harmonics": None if self.harmonics == "auto" else self.harmonics,
            "tolerance": self.tolerance,
            "residual": self.residual,
            "max_harmonics": self.max_harmonics,
            "max_iterations": self.max_iterations,
        }

"""How the peaks of a damper curve are computed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from stickslip.analyses.arguments import Residual, Span, span_of
from stickslip.analyses.forced_response import MAX_HARMONICS, MAX_ITERATIONS, Settings
from stickslip.analyses.variation import Variation
from stickslip.checks import choice, text
from stickslip.model import Model
from stickslip.results.arrays import Measure

if TYPE_CHECKING:
    from stickslip._core import Design

__all__ = ["DamperSettings"]


@dataclass(frozen=True, kw_only=True)
class DamperSettings:
    """How a damper curve is computed.

    Parameters
    ----------
    variation : Variation
        What is varied.
    dof : str
        The degree of freedom whose peak is followed.
    measure : {"half_range", "max", "fundamental"}
        Measure of its amplitude.
    span : (float, float)
        Range of frequencies in which the peak is the highest point [rad/s].
    harmonics, tolerance, residual, max_harmonics, max_iterations
        See `stickslip.forced_response`.

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    variation: Variation
    dof: str
    measure: Measure
    span: Span
    harmonics: int | Literal["auto"] = "auto"
    tolerance: float = 1e-3
    residual: Residual = "centred"
    max_harmonics: int = MAX_HARMONICS
    max_iterations: int = MAX_ITERATIONS

    def __post_init__(self) -> None:
        text(self.dof, "dof")
        choice(self.measure, "measure", get_args(Measure))
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

    def design(self, model: Model) -> Design:
        """Return the settings as the compiled core takes them."""
        return {
            "variation": self.variation.varied(model),
            "dof": model.structure.index(self.dof),
            "measure": self.measure,
            "omega": self.span,
            "harmonics": None if self.harmonics == "auto" else self.harmonics,
            "tolerance": self.tolerance,
            "residual": self.residual,
            "max_harmonics": self.max_harmonics,
            "max_iterations": self.max_iterations,
        }

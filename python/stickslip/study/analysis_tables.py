"""The table [analysis] of a study file: one class per kind of analysis."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Strict,
    Tag,
    WithJsonSchema,
    model_validator,
)

from stickslip.analyses.forced_response import (
    MAX_HARMONICS,
    MAX_ITERATIONS,
    METHODS,
    RESIDUALS,
    Residual,
    Settings,
    forced_response,
)
from stickslip.checks import unknown
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.study.damper_curve_table import DamperCurveTable
from stickslip.study.entries import (
    HERE,
    Count,
    Dof,
    Factor,
    Omega,
    Table,
    Tolerance,
    chosen_by,
    number_or,
)
from stickslip.units import quantity

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse

__all__ = ["AnalysisTable", "ForcedResponseTable", "OmegaRange", "level_name"]


def level_name(level: float) -> str:
    """Return a level as the name of its curve has it."""
    return f"{level:.10g}"


class OmegaRange(Table):
    """A range of angular frequencies: a grid, or left to the step control."""

    begin: Omega = Field(alias="from", description="First frequency.", examples=["20 rad/s"])
    end: Omega = Field(alias="to", description="Last frequency.", examples=["50 Hz"])
    points: Annotated[int, Field(ge=2, le=10_000_000)] | None = Field(
        default=None,
        description="Number of points; left out: chosen to the tolerance.",
        examples=[400],
    )
    spacing: Literal["linear", "log"] | None = Field(
        default=None, description="Spacing of the points; left out: linear."
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        if self.begin == self.end:
            raise ValueError("'from' and 'to' are equal; for one frequency write omega = [...]")
        if self.points is None and self.spacing is not None:
            raise ValueError("'spacing' needs 'points'; without points the steps are adaptive")
        return self

    def values(self) -> NDArray[np.float64] | tuple[float, float]:
        """Return the grid, or the two ends of an adaptive range."""
        if self.points is None:
            return self.begin, self.end
        space = np.geomspace if self.spacing == "log" else np.linspace
        return space(self.begin, self.end, self.points)


def _omega_form(value: object) -> str | None:
    if isinstance(value, Mapping | OmegaRange):
        return "<range>"
    return "<list>" if isinstance(value, list | tuple) else None


def _residual(value: float | str) -> float | str:
    if not isinstance(value, str) or value[:1] in "+-.0123456789":
        return quantity(value, "N", HERE)
    if value not in RESIDUALS:
        raise ModelError(f"{HERE}: {unknown('choice', value, RESIDUALS)}; or give a force in N")
    return value


class ForcedResponseTable(Table):
    """Steady response to the forces, by harmonic balance."""

    kind: Literal["forced-response"] = Field(default="forced-response", description="The analysis.")
    omega: Annotated[
        Annotated[OmegaRange, Tag("<range>")]
        | Annotated[tuple[Omega, ...], Strict(False), Field(min_length=1), Tag("<list>")],
        Discriminator(
            _omega_form,
            custom_error_type="omega_form",
            custom_error_message="is neither {from = ..., to = ..., points = ...} nor a list",
        ),
    ] = Field(
        description="Angular frequencies: a range or a list.",
        examples=[{"from": "20 rad/s", "to": "350 rad/s", "points": 400}, ["25 Hz", "26 Hz"]],
    )
    harmonics: Annotated[
        Annotated[Count, Tag("<number>")] | Annotated[Literal["auto"], Tag("<text>")],
        number_or("<text>"),
    ] = Field(
        default="auto", description="Highest harmonic kept, or 'auto': as the tolerance asks."
    )
    tolerance: Tolerance = Field(
        default=1e-3, description="Relative accuracy of what is automatic."
    )
    residual: Annotated[
        Residual,
        BeforeValidator(_residual),
        WithJsonSchema({"anyOf": [{"enum": list(RESIDUALS)}, {"type": ["number", "string"]}]}),
    ] = Field(
        default="centred",
        description="Mean force assumed in a contact that never slips: 'centred', 'from_rest', "
        "or a force.",
        examples=["from_rest", "10 N"],
    )
    method: Annotated[str, WithJsonSchema({"enum": list(METHODS)})] = Field(
        default="newton", description="Solver."
    )
    observe: Annotated[tuple[Dof, ...], Strict(False), Field(min_length=1)] | None = Field(
        default=None, description="DOFs to keep in the results; left out: all.", examples=[["tip"]]
    )
    levels: Annotated[tuple[Factor, ...], Strict(False), Field(min_length=1)] | None = Field(
        default=None,
        description="Factors on every force: one curve each; left out: the forces as written.",
        examples=[[0.5, 1, 2]],
    )
    max_harmonics: Count = Field(
        default=MAX_HARMONICS, description="Highest harmonic that may be kept."
    )
    max_iterations: Count = Field(
        default=MAX_ITERATIONS, description="Iterations per point before it counts as stalled."
    )

    @model_validator(mode="after")
    def _require_distinct_levels(self) -> Self:
        names = [level_name(level) for level in self.levels or ()]
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"levels holds {twice} twice, to 10 digits; each level is one curve")
        return self

    @model_validator(mode="after")
    def _require_settings(self) -> Self:
        # what the analysis would refuse is refused while the file is read, before any computing
        Settings(
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            method=self.method,
            max_harmonics=self.max_harmonics,
            max_iterations=self.max_iterations,
        )
        return self

    def run(self, model: Model, progress: Callable[[float], None] | None) -> ForcedResponse:
        """Compute one curve."""
        return forced_response(
            model,
            self.omega.values() if isinstance(self.omega, OmegaRange) else list(self.omega),
            self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            method=self.method,
            observe=self.observe,
            progress=progress,
            max_harmonics=self.max_harmonics,
            max_iterations=self.max_iterations,
        )


AnalysisTable = Annotated[
    Annotated[ForcedResponseTable, Tag("<forced-response>")]
    | Annotated[DamperCurveTable, Tag("<damper-curve>")],
    chosen_by("kind", "forced-response", "damper-curve", default="forced-response"),
]
"""Each further analysis joins this union with a table of its own."""

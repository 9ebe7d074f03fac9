"""What the tables of all analyses have in common: frequencies, preload, levels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from stickslip.settings.entries import ONE_OF, Dof, Factor, Omega, Some, Table, Whole

__all__ = [
    "AnalysisEntries",
    "ObserveEntries",
    "OmegaEntry",
    "OmegaRange",
    "PeakRange",
    "SingleResult",
    "level_name",
    "omegas",
]


def level_name(level: float) -> str:
    """Return a level as the name of its curve has it."""
    return f"{level:.10g}"


class OmegaRange(Table):
    """A range of angular frequencies: a grid, or left to the step control."""

    begin: Omega = Field(alias="from", description="First frequency.", examples=["20 rad/s"])
    end: Omega = Field(alias="to", description="Last frequency.", examples=["50 Hz"])
    points: Annotated[int, Whole(2, 10_000_000)] | None = Field(
        default=None,
        description="Number of points; left out: chosen to the tolerance.",
        examples=[400],
    )
    spacing: Annotated[Literal["linear", "log"], ONE_OF] | None = Field(
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


OmegaEntry = Annotated[
    Annotated[OmegaRange, Tag("<range>")] | Annotated[Some[Omega], Tag("<list>")],
    Discriminator(
        _omega_form,
        custom_error_type="omega_form",
        custom_error_message="is neither {from = ..., to = ..., points = ...} nor a list",
    ),
    Field(
        description="Angular frequencies: a range or a list.",
        examples=[{"from": "20 rad/s", "to": "350 rad/s", "points": 400}, ["25 Hz", "26 Hz"]],
    ),
]


def omegas(
    entry: OmegaRange | tuple[float, ...],
) -> NDArray[np.float64] | tuple[float, float] | list[float]:
    """Return frequencies as analyses take them: a grid, or the two ends of a range."""
    return entry.values() if isinstance(entry, OmegaRange) else list(entry)


class PeakRange(Table):
    """The range of frequencies in which peaks are looked for."""

    begin: Omega = Field(alias="from", description="Lowest frequency.", examples=["150 rad/s"])
    end: Omega = Field(alias="to", description="Highest frequency.", examples=["40 Hz"])


class SingleResult(Table):
    """An analysis without levels."""

    @property
    def levels(self) -> None:
        """There is one result."""
        return None


class ObserveEntries(Table):
    """The key of every analysis that observes DOFs."""

    observe: Some[Dof] | None = Field(
        default=None,
        description="DOFs to keep in the results; left out: all but modal coordinates.",
        examples=[["tip"]],
    )


class AnalysisEntries(ObserveEntries):
    """The keys of every analysis with forces."""

    levels: Some[Factor] | None = Field(
        default=None,
        description="Factors on every force: one result each; left out: the forces as written.",
        examples=[[0.5, 1, 2]],
    )

    @model_validator(mode="after")
    def _require_distinct_levels(self) -> Self:
        names = [level_name(level) for level in self.levels or ()]
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"levels holds {twice} twice, to 10 digits; each level is one curve")
        return self

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        return {"observe": self.observe or ()}

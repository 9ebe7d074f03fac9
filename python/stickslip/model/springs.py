"""Nonlinear springs without friction: the stop behind a gap, and the cubic spring."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from stickslip.checks import Matrix, brief, set_fields
from stickslip.model.ends import TwoEnds
from stickslip.model.jenkins import Jenkins
from stickslip.units import from_zero, physical_number


@dataclass(frozen=True)
class _Spring(TwoEnds):
    """A spring whose force is that of its displacement alone: it remembers nothing."""

    slips: ClassVar[bool] = False

    @property
    def limits(self) -> tuple[float, ...]:
        """Largest force of each contact point [N]: none."""
        return (float("inf"),)

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Nothing sticks or slips."""
        return ()

    @property
    @abstractmethod
    def _at_rest(self) -> float:
        """Stiffness at rest [N/m]."""

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness at rest [N/m], shape (1, 1)."""
        return np.array([[self._at_rest]])

    def linear_limit(self, *, stuck: bool) -> Jenkins | None:
        """Return the linear spring that it is at rest; None if it has no stiffness there."""
        if not self._at_rest:
            return None
        return Jenkins(
            self.dof, self.other, stiffness=self._at_rest, slip_force=np.inf, name=self.name
        )


@dataclass(frozen=True)
class Stop(_Spring):
    """An elastic stop: a spring that works once a gap has closed.

    Its force is f = k max(u - gap, 0) with the displacement u = x_dof - x_other.

    Parameters
    ----------
    dof : str
        Degree of freedom that hits it when it moves in positive direction.
    other : str, optional
        Degree of freedom at its other end. Default: the ground.
    stiffness : float
        Stiffness k of the closed stop [N/m].
    gap : float
        Gap at rest [m]; a negative one is an interference, and 0 is touch without force.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If the stiffness is negative, a number is not finite, or both ends are the same degree of
        freedom.

    Notes
    -----
    Solutions need not be unique: `stickslip.forced_response` over a range follows the curve around
    its folds, and says of every point whether it is stable.
    """

    law: ClassVar[str] = "stop"
    keys: ClassVar[tuple[str, ...]] = ("stiffness", "gap")

    stiffness: float = field(kw_only=True)
    gap: float = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        entry = f"stop at {brief(self.dof)}"
        stiffness = from_zero(self.stiffness, "N/m", f"{entry}: stiffness", "N/m above zero")
        gap = physical_number(self.gap, "m", f"{entry}: gap")
        set_fields(self, stiffness=stiffness, gap=gap)

    @property
    def _at_rest(self) -> float:
        return self.stiffness if self.gap <= 0.0 else 0.0


@dataclass(frozen=True)
class Cubic(_Spring):
    """A cubic spring, f = k u^3: the nonlinearity of Duffing's oscillator.

    Parameters
    ----------
    dof : str
        Degree of freedom it is attached to.
    other : str, optional
        Degree of freedom at its other end; the displacement is u = x_dof - x_other. Default: the
        ground.
    stiffness : float
        Coefficient k [N/m^3]; a negative one softens.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If the coefficient is not a finite number, or both ends are the same degree of freedom.

    Notes
    -----
    Solutions need not be unique; see `Stop`. With a softening spring they need not exist either:
    beyond the force that it can hold at most the motion grows without bound.
    """

    law: ClassVar[str] = "cubic"
    keys: ClassVar[tuple[str, ...]] = ("stiffness",)
    other_units: ClassVar[Mapping[str, str]] = {"stiffness": "N/m^3"}

    stiffness: float = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        entry = f"cubic spring at {brief(self.dof)}: stiffness"
        set_fields(self, stiffness=physical_number(self.stiffness, "N/m^3", entry))

    @property
    def _at_rest(self) -> float:
        return 0.0

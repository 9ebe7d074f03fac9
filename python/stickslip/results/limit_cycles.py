"""Limit cycles along a branch, with their stability."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import choice, constant
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.destabilised import destabilised
from stickslip.model.state import State
from stickslip.results.arrays import (
    ExactColumns,
    Measure,
    PeriodicArrays,
    amplitude_in,
    amplitude_of,
    period_of,
)
from stickslip.results.fields import Bool, Columns, Float, Int, Numbers, Shown, column
from stickslip.results.periodic import PeriodicMotions
from stickslip.results.result import ColumnResult
from stickslip.results.stability import FloquetStability, stability_counts
from stickslip.settings.cycles import CycleSettings, MapSettings


class Limit(NamedTuple):
    """Where a branch of limit cycles turns."""

    ratio: float
    """Factor r on the negative damping."""
    omega: float
    """Angular frequency [rad/s]."""
    value: float
    """Value of what is followed; r itself unless a parameter of contacts is."""


class StabilityChange(NamedTuple):
    """Where the stability of a branch changes."""

    value: float
    """Value of what is followed."""
    omega: float
    """Angular frequency [rad/s]."""
    kind: str
    """"fold" (a multiplier passes 1), "complex pair", "symmetry" (a multiplier passes 1 with motion
    that breaks x(t + T/2) = -x(t)), "grazing" (multipliers jump with a change in slip), or "period
    doubling" (a multiplier passes -1)."""
    after: int
    """Position of the cycle before it."""
    unstable_before: int
    """Multipliers outside the unit circle before it."""
    unstable_after: int
    """The same after it."""


CHANGE_KINDS = ("fold", "complex pair", "symmetry", "grazing", "period doubling")
"""What can happen where stability changes."""


class CycleArrays(PeriodicArrays, ExactColumns):
    """The numbers of limit cycles along a branch.

    What only exact orbits have is not-a-number of other cycles.
    """

    along = "cycle"
    labels: ClassVar[Mapping[str, Sequence[str]]] = {
        "side": ("low", "high"),
        "turn_entry": ("value", "omega"),
    }

    value: Float = column("*", "{unit}", "{followed} that is followed")
    ratio: Float = column("*", "1", "factor r on the negative damping")
    slipping: Bool = column("*", "1", "whether it lies on the slipping side")
    closed: Bool = column("*", "1", "whether multipliers are of an exact orbit")
    turn: Float = column(
        "turn_entry", "1", "value and omega where the branch turns for good, if it does"
    )
    folds: Float = column("fold turn_entry", "1", "value and omega where it turns")
    change: Float = column(
        "change_of_stability turn_entry", "1", "value and omega where its stability changes"
    )
    change_after: Int = column(
        "change_of_stability",
        "1",
        "position of the cycle before the change",
        least=0,
        most="cycle",
    )
    change_kind: Int = column("change_of_stability", "1", "what happens there", codes=CHANGE_KINDS)
    change_unstable: Int = column(
        "change_of_stability side",
        "1",
        "multipliers outside the unit circle before and after",
        least=0,
    )
    negative_damping: Numbers = column(
        "diameter row column",
        "kg/s",
        "C_neg of the damping C + r C_neg; of a tuned disk by nodal diameter",
        optional=True,
    )

    @property
    def limit(self) -> tuple[float, float] | None:
        """Value and frequency where the branch turns for good, if it does."""
        value, omega = self.turn
        return None if np.isnan(value) else (float(value), float(omega))


class LimitCycles(PeriodicMotions, FloquetStability):
    """Limit cycles of a mode, from the sticking to the slipping side of their branch."""

    kind: ClassVar[str] = "limit_cycles"
    title = "Limit cycles of a structure with dry friction"

    settings: CycleSettings
    arrays: CycleArrays

    def __repr__(self) -> str:
        limit = self.limit
        turn = (
            "no turn" if limit is None else f"turns at {self.settings.followed} {limit.value:.6g}"
        )
        return (
            f"LimitCycles({self.omega.size} cycles of mode {self.settings.mode}, "
            f"{stability_counts(self.stability)}, {turn})"
        )

    values = Shown[Float]("value")
    ratio = Shown[Float]()
    omega = Shown[Float]()
    negative_damping = Shown[Numbers]()

    plot = Drawn("limit_cycles")
    plot_multipliers = Drawn("cycle_multipliers")

    @cached_property
    def branch(self) -> NDArray[np.str_]:
        """Side of the branch, "sticking" or "slipping", shape (n,)."""
        return constant(np.where(self.arrays.slipping, "slipping", "sticking"))

    @property
    def limit(self) -> Limit | None:
        """Where the branch turns for good, located to about 1e-9; None if it does not turn."""
        found = self.arrays.limit
        return None if found is None else self._turn(*found)

    @property
    def folds(self) -> tuple[Limit, ...]:
        """All places where the branch turns, in its order."""
        return tuple(self._turn(*place) for place in self.arrays.folds.tolist())

    @property
    def changes(self) -> tuple[StabilityChange, ...]:
        """Where the stability of a whole branch changes, in its order."""
        arrays = self.arrays
        rows = (arrays.change, arrays.change_kind, arrays.change_after, arrays.change_unstable)
        listed = zip(*(column.tolist() for column in rows), strict=True)
        return tuple(
            StabilityChange(value, omega, CHANGE_KINDS[kind], after, before, beyond)
            for (value, omega), kind, after, (before, beyond) in listed
        )

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement along the branch.

        Half range and maximum are equal for motions that are symmetric.
        """
        choice(measure, "measure", get_args(Measure))
        column = self._column(dof)
        if measure != "fundamental" and self.settings.method == "exact":
            return amplitude_in(self.arrays.range[:, column], measure)
        return constant(amplitude_of(self.coefficients(dof), measure))

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement from its harmonics, shape (samples,) [m]."""
        return period_of(self.coefficients(dof)[self.position(index)], samples)

    def state(self, index: int) -> State:
        """Return the state at t = 0, from which `stickslip.transient` continues an exact orbit.

        Displacements, velocities and contact forces.

        Raises ModelError if it is no exact orbit.
        """
        values = self.arrays.state[self.position(index)]
        if not np.isfinite(values).all():
            raise ModelError(f"state({index}): of exact orbits only; use method='exact'")
        return State.of_vector(self.model, values)

    def model_at(self, index: int) -> Model:
        """Return the model whose limit cycle one point is, with the damping C + r C_neg in it.

        Without forces, but for static ones where these decide what contacts do, for
        `stickslip.transient` and any other analysis.

        Raises ModelError if the model is a sector of a travelling wave.
        """
        if self.model.travels:
            raise ModelError(
                "model_at: a sector of a travelling wave has no damping matrix of its own"
            )
        position, model = self.position(index), self.model
        if self.settings.variation is not None:
            model = self.settings.variation.apply(model, float(self.values[position]))
        static = [force for force in model.forces if force.harmonic == 0]
        free = Model(model.structure, model.contacts, static if model.problem.biased() else ())
        return destabilised(free, self.negative_damping, float(self.ratio[position]))

    def _words(self) -> Mapping[str, str]:
        return {"unit": self.settings.unit, "followed": self.settings.followed}

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        return self._stable("cycle") | super()._further_variables(derived=derived)

    def _turn(self, value: float, omega: float) -> Limit:
        ratio = value if self.settings.variation is None else self.settings.ratio
        return Limit(ratio, omega, value)


class MapArrays(Columns):
    """The numbers of a stability map."""

    value: Float = column("value", "{unit}", "{parameter} of the contacts")
    limit: Float = column(
        "value", "1", "ratio at which the branch turns for good; not-a-number if nowhere"
    )
    omega: Float = column("value", "rad/s", "frequency there", least=0.0)
    stable_limit: Float = column(
        "value",
        "1",
        "ratio up to which the sticking side is stable without a gap; 0 if it is unstable from the "
        "start, and not-a-number if a cycle below is not decided",
    )
    negative_damping: Numbers = column("row column", "kg/s", "C_neg of the damping C + r C_neg")


class StabilityMap(ColumnResult):
    """Largest ratio r with limit cycles, and with stable ones, over a parameter of the contacts."""

    kind: ClassVar[str] = "stability_map"
    title = "Negative damping that friction bounds"

    settings: MapSettings
    arrays: MapArrays

    def __repr__(self) -> str:
        return (
            f"StabilityMap({self.values.size} values of {self.settings.variation.parameter}, limit "
            f"{np.nanmin(self.limit):.6g} to {np.nanmax(self.limit):.6g})"
        )

    values = Shown[Float]("value")
    limit = Shown[Float]()
    omega = Shown[Float]()
    stable_limit = Shown[Float]()
    negative_damping = Shown[Numbers]()

    def _words(self) -> Mapping[str, str]:
        variation = self.settings.variation
        return {"unit": variation.unit, "parameter": variation.parameter}

    plot = Drawn("stability_map")

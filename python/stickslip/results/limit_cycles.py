"""Limit cycles along a branch, with their stability."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import choice, whole_number
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.state import State
from stickslip.results.arrays import Float, Measure, amplitude_in, amplitude_of, constant
from stickslip.results.cycle_arrays import CHANGE_KINDS, CycleArrays
from stickslip.results.fields import Numbers, Shown
from stickslip.results.periodic import PeriodicMotions
from stickslip.results.stability import FloquetStability, flag_variable, stability_counts
from stickslip.settings.cycles import CycleSettings

if TYPE_CHECKING:
    from typing import Unpack

    from matplotlib.axes import Axes

    from stickslip.plot.options import CycleOptions

__all__ = ["Limit", "LimitCycles", "StabilityChange"]


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
    that breaks x(t + T/2) = -x(t)), or "grazing" (multipliers jump with a change in slip)."""
    after: int
    """Position of the cycle before it."""
    unstable_before: int
    """Multipliers outside the unit circle before it."""
    unstable_after: int
    """The same after it."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LimitCycles(PeriodicMotions, FloquetStability):
    """Limit cycles of a mode, from the sticking to the slipping side of their branch.

    Attributes
    ----------
    settings : CycleSettings
        What was followed, and how.
    arrays : CycleArrays
        Every number by its name.
    """

    kind: ClassVar[str] = "limit_cycles"
    title = "Limit cycles of a structure with dry friction"
    columns = CycleArrays
    settings_class = CycleSettings

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
        return tuple(self._turn(float(value), float(omega)) for value, omega in self.arrays.folds)

    @property
    def changes(self) -> tuple[StabilityChange, ...]:
        """Where the stability of a whole branch changes, in its order."""
        arrays = self.arrays
        rows = zip(
            arrays.change,
            arrays.change_kind,
            arrays.change_after,
            arrays.change_unstable,
            strict=True,
        )
        return tuple(
            StabilityChange(
                float(at[0]), float(at[1]), CHANGE_KINDS[kind], int(after), int(was), int(now)
            )
            for at, kind, after, (was, now) in rows
        )

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement along the branch.

        Parameters
        ----------
        dof : str
            The degree of freedom.
        measure : {"half_range", "max", "fundamental"}, optional
            Half the peak-to-peak range over a period, the largest absolute displacement, or the
            modulus of the first harmonic. The first two are equal for these symmetric motions, and
            exact for exact orbits.

        Returns
        -------
        ndarray of float64, shape (n,)
            [m].

        Raises
        ------
        ModelError
            If there is no such degree of freedom or measure.
        """
        choice(measure, "measure", get_args(Measure))
        column = self._column(dof)
        if measure != "fundamental" and self.settings.method == "exact":
            return amplitude_in(self.arrays.range[:, column], measure)
        return constant(amplitude_of(self.coefficients(dof), measure))

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement from its harmonics.

        Parameters
        ----------
        dof : str
            The degree of freedom.
        index : int
            Position of the cycle; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples,)
            [m].
        """
        series = self.coefficients(dof)[self.position(index)]
        count = whole_number(samples, "samples", smallest=1)
        turn = 2j * np.pi * np.outer(np.arange(count) / count, np.arange(series.size))
        return constant((np.exp(turn) @ series).real)

    def state(self, index: int) -> State:
        """Return the state at t = 0, from which `stickslip.transient` continues an exact orbit.

        Parameters
        ----------
        index : int
            Position of the cycle; negative ones count from the end.

        Returns
        -------
        State
            Displacements, velocities and contact forces.

        Raises
        ------
        ModelError
            If there is no such cycle, or it is no exact orbit.
        """
        values = self.arrays.state[self.position(index)]
        if not np.isfinite(values).all():
            raise ModelError(f"state({index}): of exact orbits only; use method='exact'")
        return State.of_vector(self.model, values)

    def model_at(self, index: int) -> Model:
        """Return the model whose limit cycle one point is, with the damping C + r C_neg in it.

        Parameters
        ----------
        index : int
            Position of the cycle; negative ones count from the end.

        Returns
        -------
        Model
            Without forces, for `stickslip.transient` and any other analysis.

        Raises
        ------
        ModelError
            If there is no such cycle, or the model is a sector of a travelling wave.
        """
        from stickslip.model.structure import Structure

        if self.model.travels:
            raise ModelError(
                "model_at: a sector of a travelling wave has no damping matrix of its own"
            )
        position = self.position(index)
        own = self.model.structure
        structure = Structure(
            mass=own.mass,
            stiffness=own.stiffness,
            damping=own.damping + self.ratio[position] * self.negative_damping,
            dofs=own.dofs,
        )
        model = self.model
        if self.settings.variation is not None:
            model = self.settings.variation.apply(model, float(self.values[position]))
        return Model(structure, model.contacts, [])

    def position(self, index: int) -> int:
        """Return the position of a cycle, counted from the start.

        Raises
        ------
        ModelError
            If there is no such cycle.
        """
        count = self.omega.size
        position = whole_number(index + count if index < 0 else index, "index")
        if position >= count:
            raise ModelError(f"index: {index}; there are {count} cycles")
        return position

    def _words(self) -> Mapping[str, str]:
        return {"unit": self.settings.unit, "followed": self.settings.followed}

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        made: dict[Hashable, Any] = {"stable": flag_variable("cycle", self.stability)}
        if derived:
            meaning = "half peak-to-peak amplitude of the displacement"
            values = np.stack([self.amplitude(dof) for dof in self.dofs], axis=1)
            made["amplitude"] = (("cycle", "dof"), values, {"units": "m", "long_name": meaning})
        return made

    def plot(self, dof: str, **options: Unpack[CycleOptions]) -> Axes:
        """Draw amplitude and frequency along the branch.

        Parameters
        ----------
        dof : str
            The degree of freedom.
        **options
            See `stickslip.plot.limit_cycles`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the amplitude.
        """
        from stickslip import plot

        return plot.limit_cycles(self, dof, **options)

    def plot_multipliers(self, *, ax: Axes | None = None) -> Axes:
        """Draw the Floquet multipliers; see `stickslip.plot.cycle_multipliers`."""
        from stickslip import plot

        return plot.cycle_multipliers(self, ax=ax)

    def _turn(self, value: float, omega: float) -> Limit:
        ratio = value if self.settings.variation is None else self.settings.ratio
        return Limit(ratio, omega, value)

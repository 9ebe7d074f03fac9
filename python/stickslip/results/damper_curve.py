"""Peaks over one parameter of a damper, or over two of a design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.arrays import UNIQUE
from stickslip.results.bounded import ResidualBounds
from stickslip.results.dataset import Stored
from stickslip.results.fields import Bool, Code, Columns, Float, Int, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.results.status import Status
from stickslip.settings.peaks import DamperSettings


class LeastPeak(NamedTuple):
    """A parameter at which a peak is least."""

    value: float
    """Value of the parameter."""
    omega: float
    """Angular frequency of the peak [rad/s]."""
    amplitude: float
    """Its amplitude [m]."""


class DamperArrays(Columns):
    """The numbers of a damper curve."""

    value: Float = column("value", "{unit}", "{varied}")
    omega: Float = column("value", "rad/s", "angular frequency of the peak", least=0.0)
    amplitude: Float = column("value", "m", "amplitude of the peak", least=0.0)
    sensitivity: Float = column(
        "value", "m{per_unit}", "derivative of the amplitude in the parameter"
    )
    error_estimate: Float = column(
        "value", "m", "what the discarded harmonics could still change in the amplitude", least=0.0
    )
    harmonics: Int = column(
        "value", "1", "highest harmonic kept", least=0, file_name="harmonics_kept"
    )
    at_edge: Bool = column("value", "1", "whether the peak lies at an end of the range")
    status: Code = column("value", "1", "how the value ended", codes=Status)
    lower: Float = column(
        "value", "m", "least peak over the residual tractions", least=0.0, absent=np.nan
    )
    upper: Float = column(
        "value", "m", "largest peak over the residual tractions", least=0.0, absent=np.nan
    )
    unique: Code = column(
        "value",
        "1",
        "whether the peak is the same for all residual tractions",
        codes=UNIQUE,
        absent="not asked",
    )
    guaranteed: Bool = column(
        "value", "1", "whether theory excludes peaks outside of the bounds", absent=False
    )

    @cached_property
    def solved(self) -> Bool:
        """(n,) Whether the peak was found."""
        return constant(np.isfinite(self.amplitude))


class DamperCurve(ResidualBounds, ColumnResult):
    """Peak amplitude and frequency along a parameter of contacts, or the level of the forces."""

    kind: ClassVar[str] = "damper_curve"
    title = "Peak of a structure with dry friction along a parameter"

    settings: DamperSettings
    arrays: DamperArrays
    bounded_by = "damper_curve"

    def __repr__(self) -> str:
        values, solved = self.values, self.arrays.solved
        found = "all found" if solved.all() else f"{solved.sum()} found"
        return (
            f"DamperCurve({values.size} values of {self.parameter} from {values.min():g} to "
            f"{values.max():g}{self.settings.variation.behind} ({found}), peak of "
            f"{self.settings.dof!r})"
        )

    @property
    def parameter(self) -> str:
        """What was varied: "slip_force", "stiffness", "level" or another parameter."""
        return self.settings.variation.parameter

    values = Shown[Float]("value")
    omega = Shown[Float]()
    amplitude = Shown[Float]()
    sensitivity = Shown[Float]()
    error_estimate = Shown[Float]()
    harmonics = Shown[Int]()
    at_edge = Shown[Bool]()

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How each value ended; ``status[i].advice`` says what to do about it."""
        return tuple(map(Status.from_code, self.arrays.status.tolist()))

    @property
    def lower(self) -> Float:
        """The least peak over all residual tractions, shape (n,) [m].

        The highest point over frequency of the least amplitudes, half the range over a period. A
        residual traction that stays the same over the sweep has a peak not below it. See `unique`
        and `guaranteed`.

        Raises ModelError if the bounds were not asked for.
        """
        self._require_bounded()
        return self.arrays.lower

    @property
    def upper(self) -> Float:
        """The largest peak over all residual tractions, shape (n,) [m].

        See `lower`.
        """
        self._require_bounded()
        return self.arrays.upper

    @property
    def objective(self) -> Float:
        """What a damper is to make least, shape (n,) [m]: the amplitude, per unit of a level."""
        if self.parameter == "level":
            return constant(self.amplitude / self.values)
        return self.amplitude

    @property
    def optimum(self) -> LeastPeak:
        """The lowest of the computed peaks; of levels, the lowest amplitude per unit of level.

        `stickslip.optimal_damper` finds the lowest of all values, between the computed ones.

        Raises ModelError if no peak was found.
        """
        if not self.arrays.solved.any():
            raise ModelError(f"optimum: none of the {self.values.size} peaks was found; see status")
        best = int(np.nanargmin(self.objective))
        row = (self.values[best], self.omega[best], self.amplitude[best])
        return LeastPeak(*map(float, row))

    def model_at(self, value: float) -> Model:
        """Return the model at a value of the parameter, for any other analysis.

        A new model.

        Raises ModelError if a contact refuses the value.

        Parameters
        ----------
        value : float
            The value, also between the computed ones.
        """
        return self.settings.variation.apply(self.model, value)

    @classmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the curve that a dataset holds."""
        curve = super().from_dataset(dataset, model)
        curve.settings.variation.varied(model)
        return curve

    def _words(self) -> Mapping[str, str]:
        unit = self.settings.variation.unit
        if unit == "1":
            return {"unit": unit, "per_unit": "", "varied": f"factor, {self.parameter}"}
        varied = f"{self.parameter} of the contacts"
        return {"unit": unit, "per_unit": f"/({unit})", "varied": varied}

    plot = Drawn("damper")


@dataclass(frozen=True, eq=False, repr=False)
class DesignMap:
    """Peaks over two parameters of a design; rows belong to the first one."""

    names: tuple[str, str]
    """Names of the parameters."""
    values: tuple[Float, ...]
    """Their values, (n,) and (m,)."""
    dof: str
    """The degree of freedom whose peak it is."""
    amplitude: Float
    """(n, m) Amplitude of the peak [m]; nan where none was found."""
    omega: Float
    """(n, m) Angular frequency of the peak [rad/s]."""
    harmonics: NDArray[np.int64]
    """(n, m) Highest harmonic kept."""
    codes: NDArray[np.int64]
    """(n, m) How each search ended, as `Status.code`."""

    plot = Drawn("design_map")

    def __repr__(self) -> str:
        one, other = (
            f"{values.size} values of {name}"
            for name, values in zip(self.names, self.values, strict=True)
        )
        found = int(np.isfinite(self.amplitude).sum())
        return f"DesignMap({one}, {other}, {found} peaks of {self.dof!r} found)"

    @property
    def status(self) -> tuple[tuple[Status, ...], ...]:
        """How each search ended, row by row; ``status[i][j].advice`` says what to do about it.

        A peak with the status "harmonics limit" is that of the most harmonics there may be: more of
        them would still change it by more than the tolerance.
        """
        return tuple(tuple(map(Status.from_code, row)) for row in self.codes.tolist())

    @property
    def interrupted(self) -> bool:
        """Whether the map was stopped before all cells were done."""
        return bool((self.codes == Status.NOT_COMPUTED.code).any())

    @property
    def optimum(self) -> dict[str, float]:
        """The values of the least of the computed peaks.

        Raises ModelError if no peak was found.
        """
        if not np.isfinite(self.amplitude).any():
            raise ModelError("optimum: none of the peaks was found; widen omega, or max_harmonics")
        place = np.unravel_index(int(np.nanargmin(self.amplitude)), self.amplitude.shape)
        return {
            name: float(values[at])
            for name, values, at in zip(self.names, self.values, place, strict=True)
        }

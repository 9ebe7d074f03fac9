"""Peaks along a parameter: the damper performance curve."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.arrays import Bool, Float, Int, constant
from stickslip.results.result import Result
from stickslip.results.status import Status
from stickslip.results.variables import (
    Variable,
    attributes,
    dof_coordinate,
    parts,
    read,
    settings_of,
    written,
)

if TYPE_CHECKING:
    from typing import Unpack

    import xarray as xr
    from matplotlib.axes import Axes

    from stickslip._core import Peaks
    from stickslip.plot.damper import DamperOptions
    from stickslip.settings.peaks import DamperSettings

__all__ = ["DamperArrays", "DamperCurve", "LeastPeak"]


class LeastPeak(NamedTuple):
    """A parameter at which a peak is least."""

    value: float
    """Value of the parameter."""
    omega: float
    """Angular frequency of the peak [rad/s]."""
    amplitude: float
    """Its amplitude [m]."""


@dataclass(frozen=True, eq=False)
class DamperArrays:
    """The numbers of a damper curve, of n values each."""

    value: Float
    """(n,) Value of the parameter."""
    omega: Float
    """(n,) Angular frequency of the peak [rad/s]."""
    amplitude: Float
    """(n,) Its amplitude [m]."""
    sensitivity: Float
    """(n,) Derivative of the amplitude in the parameter."""
    error_estimate: Float
    """(n,) What the discarded harmonics could still change in the amplitude [m]."""
    harmonics: Int
    """(n,) Highest harmonic kept."""
    at_edge: Bool
    """(n,) Whether the peak lies at an end of the range of frequencies."""
    status: NDArray[np.uint8]
    """(n,) Codes of `Status`."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            object.__setattr__(self, entry.name, constant(array))

    def __reduce__(self) -> tuple[type[DamperArrays], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return DamperArrays, tuple(getattr(self, entry.name) for entry in fields(self))

    @classmethod
    def of(cls, peaks: Peaks) -> DamperArrays:
        """Take over what the core returns."""
        return cls(**{entry.name: np.array(getattr(peaks, entry.name)) for entry in fields(cls)})

    @cached_property
    def solved(self) -> Bool:
        """(n,) Whether the peak was found."""
        return constant(np.isfinite(self.amplitude))


_VARIABLES: Mapping[str, Variable] = {
    "omega": Variable("omega", ("value",), "rad/s", "angular frequency of the peak"),
    "amplitude": Variable("amplitude", ("value",), "m", "amplitude of the peak"),
    "sensitivity": Variable(
        "sensitivity", ("value",), "m", "derivative of the amplitude in the parameter"
    ),
    "error_estimate": Variable(
        "error_estimate", ("value",), "m", "what the discarded harmonics could still change"
    ),
    "harmonics_kept": Variable("harmonics", ("value",), "1", "highest harmonic kept"),
    "at_edge": Variable("at_edge", ("value",), "1", "whether the peak lies at an end of the range"),
    "status": Variable("status", ("value",), "1", "how the value ended"),
}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class DamperCurve(Result):
    """Peak amplitude and frequency along a parameter of the contacts, or the level of the forces.

    Attributes
    ----------
    settings : DamperSettings
        What was varied, which peak was followed, and how.
    arrays : DamperArrays
        Every number by its name.
    """

    kind: ClassVar[str] = "damper_curve"

    settings: DamperSettings
    arrays: DamperArrays

    def __repr__(self) -> str:
        values, solved = self.values, self.arrays.solved
        found = "all found" if solved.all() else f"{solved.sum()} found"
        return (
            f"DamperCurve({values.size} values of {self.parameter} from {values.min():g} to "
            f"{values.max():g} {self.settings.variation.unit} ({found}), peak of "
            f"{self.settings.dof!r})"
        )

    @property
    def parameter(self) -> str:
        """What was varied: "slip_force", "stiffness" or "level"."""
        return self.settings.variation.parameter

    @property
    def values(self) -> Float:
        """Value of the parameter, shape (n,), in the order given."""
        return self.arrays.value

    @property
    def omega(self) -> Float:
        """Angular frequency of the peak, shape (n,) [rad/s]; not-a-number if it was not found."""
        return self.arrays.omega

    @property
    def amplitude(self) -> Float:
        """Amplitude of the peak, shape (n,) [m]; not-a-number if it was not found."""
        return self.arrays.amplitude

    @property
    def sensitivity(self) -> Float:
        """Derivative of the peak's amplitude in the parameter, shape (n,); 0 at infinity."""
        return self.arrays.sensitivity

    @property
    def error_estimate(self) -> Float:
        """What the discarded harmonics could still change in the amplitude, shape (n,) [m]."""
        return self.arrays.error_estimate

    @property
    def harmonics(self) -> Int:
        """Highest harmonic kept, shape (n,)."""
        return self.arrays.harmonics

    @property
    def at_edge(self) -> Bool:
        """Whether the peak lies at an end of the range of frequencies, shape (n,)."""
        return self.arrays.at_edge

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How each value ended; ``status[i].advice`` says what to do about it."""
        return tuple(Status.from_code(int(code)) for code in self.arrays.status)

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

        Raises
        ------
        ModelError
            If no peak was found.
        """
        if not self.arrays.solved.any():
            raise ModelError(f"optimum: none of the {self.values.size} peaks was found; see status")
        best = int(np.nanargmin(self.objective))
        row = (self.values[best], self.omega[best], self.amplitude[best])
        return LeastPeak(*map(float, row))

    def model_at(self, value: float) -> Model:
        """Return the model at a value of the parameter, for any other analysis.

        Parameters
        ----------
        value : float
            The value, also between the computed ones.

        Returns
        -------
        Model
            A new model.

        Raises
        ------
        ModelError
            If a contact refuses the value.
        """
        return self.settings.variation.apply(self.model, value)

    def to_dataset(self, *, derived: bool = True) -> xr.Dataset:
        """Return everything as an xarray dataset with units on every variable.

        Parameters
        ----------
        derived : bool, optional
            Whether to add what follows from the other variables: nothing here.

        Returns
        -------
        xarray.Dataset
            Dimensions value and dof.
        """
        import xarray as xr

        unit = self.settings.variation.unit
        meaning = (
            f"{self.parameter} of the contacts" if unit != "1" else f"factor, {self.parameter}"
        )
        dataset = xr.Dataset(
            written(_VARIABLES, self.arrays),
            coords={
                "value": ("value", self.values.copy(), {"units": unit, "long_name": meaning}),
                "dof": dof_coordinate(self),
            },
            attrs=attributes(
                self, self.settings, "Peak of a structure with dry friction along a parameter"
            ),
        )
        if unit != "1":
            dataset["sensitivity"].attrs["units"] = f"m/({unit})"
        return dataset

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset, model: Model) -> Self:
        """Return the curve that a dataset holds.

        Parameters
        ----------
        dataset : xarray.Dataset
            As `to_dataset` makes it.
        model : Model
            What was computed.

        Returns
        -------
        DamperCurve
            Equal to the one that made the dataset, bit by bit.

        Raises
        ------
        KeyError, ValueError
            If the dataset is incomplete, or belongs to another model.
        """
        from stickslip.settings.peaks import DamperSettings

        settings = DamperSettings.stored(settings_of(dataset))
        settings.variation.varied(model)
        arrays = DamperArrays(value=dataset["value"].values, **read(_VARIABLES, dataset))
        if arrays.status.max(initial=0) >= len(Status):
            raise ValueError(f"status {arrays.status.max()} is unknown")
        return cls(**parts(dataset, model), settings=settings, arrays=arrays)

    def plot(self, **options: Unpack[DamperOptions]) -> Axes:
        """Draw the damper performance curve.

        Parameters
        ----------
        **options
            See `stickslip.plot.damper`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the amplitude.
        """
        from stickslip import plot

        return plot.damper(self, **options)

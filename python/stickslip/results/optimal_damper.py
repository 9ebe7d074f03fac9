"""The parameter of a damper that makes a peak least."""

from __future__ import annotations

from typing import ClassVar, Self

import numpy as np

from stickslip.drawn import Axes
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.damper_curve import DamperCurve, LeastPeak
from stickslip.results.dataset import Record, Stored
from stickslip.results.diagnostic import Diagnostic, from_attributes, to_json
from stickslip.results.fields import Columns, Float, column
from stickslip.results.result import Result
from stickslip.results.status import Status
from stickslip.results.stored_model import part_variables, parts_of


class _Minima(Columns):
    """The local minima of a peak, the least first."""

    prefix: ClassVar[str] = "minimum_"

    value: Float = column("minimum", "{unit}", "value of the parameter at a minimum")
    omega: Float = column("minimum", "rad/s", "angular frequency of a minimum", least=0.0)
    amplitude: Float = column("minimum", "m", "amplitude of a minimum", least=0.0)


class OptimalDamper(Result):
    """The least peak over a parameter, and how it was found.

    Its `model` is the one at the best value, ready for any other analysis; `curve.model` is the
    one that was given.

    Attributes
    ----------
    minima : tuple of LeastPeak
        Every local minimum of the peak, the least first; of levels, of the peak per unit of level.
    bounds : (float, float)
        Between which values it was looked for.
    curve : DamperCurve
        All peaks computed, by value: the coarse curve and what closed in on the minima.
    """

    kind: ClassVar[str] = "optimal_damper"

    minima: tuple[LeastPeak, ...]
    bounds: tuple[float, float]
    curve: DamperCurve

    def __repr__(self) -> str:
        count = len(self.minima)
        return (
            f"OptimalDamper({self.parameter} = {self.value:.6g}"
            f"{self.curve.settings.variation.behind}: peak {self.amplitude:.6g} m at "
            f"{self.omega:.6g} rad/s, {count} local {'minimum' if count == 1 else 'minima'})"
        )

    @property
    def parameter(self) -> str:
        """What was varied: "slip_force", "stiffness", "level" or another parameter."""
        return self.curve.parameter

    @property
    def value(self) -> float:
        """The best value of the parameter, or the best factor."""
        return self.minima[0].value

    @property
    def omega(self) -> float:
        """Angular frequency of the least peak [rad/s]."""
        return self.minima[0].omega

    @property
    def amplitude(self) -> float:
        """Amplitude of the least peak [m]."""
        return self.minima[0].amplitude

    @property
    def slip_force(self) -> float:
        """The best slip force of the contacts that were varied [N].

        Raises ModelError if something else was varied, or the contacts have several slip forces.
        """
        if self.parameter != "slip_force":
            raise ModelError(f"slip_force: the {self.parameter} was varied; see value")
        points = [self.model.slider(ref) for ref in self.curve.settings.variation.contacts]
        forces = {self.model.contacts[contact].slider_limits[point] for contact, point in points}
        if len(forces) > 1:
            raise ModelError("slip_force: the contacts have several; see model.contacts")
        return forces.pop()

    @property
    def status(self) -> Status:
        """How the least peak ended: converged, or at the limit of harmonics."""
        return self.curve.status[int(np.flatnonzero(self.curve.values == self.value)[0])]

    @property
    def at_bound(self) -> bool:
        """Whether the best value is one of the bounds: there may be a better one outside."""
        return self.value in self.bounds

    @property
    def evaluations(self) -> int:
        """Number of peaks computed; `curve.counters` tells of how many solutions each."""
        return int(self.curve.values.size)

    def record(self, *, derived: bool = True) -> Record:
        """Return everything, of which `to_dataset` is the dataset.

        That of the curve, with the dimension minimum of the local minima, the least first, and the
        contacts and forces of the model that was given.
        """
        unit = self.curve.settings.variation.unit
        minima = _Minima(**dict(zip(LeastPeak._fields, np.array(self.minima).T, strict=True)))
        about = {"units": unit, "long_name": "between which values the least was looked for"}
        found = minima.variables({"unit": unit}) | {"bounds": ("bound", self.bounds, about)}
        made = self.curve.record(derived=derived).assign(found)
        return made.assign(part_variables(self.curve.model, "given_")).assign_attrs(
            {
                "title": "Least peak of a structure with dry friction over a parameter",
                "diagnostics": to_json(self.diagnostics),
                "curve_diagnostics": to_json(self.curve.diagnostics),
            }
        )

    @classmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the result that a dataset holds; `model` is the one at the best value."""
        contacts, forces = parts_of(dataset, "given_")
        given = model.replaced(contacts=contacts, forces=forces)
        prefix = "curve_"
        told = dataset.attrs.items()
        of_curve = {name.removeprefix(prefix): one for name, one in told if name.startswith(prefix)}
        columns = _Minima.read(dataset)
        rows = zip(columns.value, columns.omega, columns.amplitude, strict=True)
        minima = tuple(LeastPeak(*map(float, row)) for row in rows)
        if not minima:
            raise ValueError("no minimum")
        low, high = map(float, dataset["bounds"].values)
        curve = DamperCurve.from_dataset(dataset.assign_attrs(of_curve), given)
        return cls.of(minima, (low, high), curve, from_attributes(dataset.attrs))

    @classmethod
    def of(
        cls,
        minima: tuple[LeastPeak, ...],
        bounds: tuple[float, float],
        curve: DamperCurve,
        diagnostics: tuple[Diagnostic, ...],
    ) -> Self:
        """Return the result with what it has in common with its curve."""
        return cls(
            model=curve.model_at(minima[0].value),
            dofs=curve.dofs,
            interrupted=curve.interrupted,
            timings=curve.timings,
            counters=curve.counters,
            diagnostics=diagnostics,
            minima=minima,
            bounds=bounds,
            curve=curve,
        )

    def plot(self, **options: object) -> Axes:
        """Draw the damper performance curve with its least peak; see `stickslip.plot.damper`."""
        return self.curve.plot(**options)

"""What is said and drawn of damper curves and optimal dampers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from stickslip.drawn import plots
from stickslip.results.damper_curve import DamperCurve
from stickslip.results.optimal_damper import OptimalDamper
from stickslip.views.kinds import RPM, Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row, assumed, bound_rows, counted, model_rows


class DamperView(View[DamperCurve]):
    """The ends of every curve and its lowest peak."""

    texts = ("dof", "", "varied")
    numbers = ("value", "peak [{}]", "rad/s", RPM, "rel. error", "H")

    def rows(self, result: DamperCurve, dofs: Dofs, length: float) -> Rows:
        """Return first, lowest and last solved value."""
        solved = result.arrays.solved.nonzero()[0].tolist()
        if not solved:
            return
        lowest = min(solved, key=lambda index: float(result.objective[index]))
        for place, index in (("first", solved[0]), ("lowest", lowest), ("last", solved[-1])):
            yield (
                result.settings.dof,
                place,
                result.settings.variation.heading,
                f"{result.values[index]:.6g}",
                f"{result.amplitude[index] / length:#.7g}",
                f"{result.omega[index]:#.6g}",
                *self.in_rpm(result.model, result.omega[index]),
                f"{result.error_estimate[index] / result.amplitude[index]:.1e}",
                f"{result.harmonics[index]}",
            )

    def about(self, result: DamperCurve) -> list[Row]:
        """Say what was varied, and which peak was followed."""
        settings, values = result.settings, result.values
        low, high = settings.span
        varied = ", ".join(settings.variation.names) or "the forces that vary"
        return [
            ("varied", f"{result.parameter} of {varied}"),
            ("values", f"{values.size} from {values.min():.6g} to {values.max():.6g}"),
            ("peak of", f"{settings.dof} ({settings.measure}), {low:.6g} to {high:.6g} rad/s"),
            ("harmonics", f"{settings.harmonics}"),
            ("solutions", f"{result.counters['points']}"),
            *bound_rows(result),
        ]

    def failures(self, result: DamperCurve) -> list[str]:
        """Word what was not solved, one line per cause."""
        return counted(result.status, f"{result.values.size} values")

    def panels(self, results: Sequence[DamperCurve], dofs: Dofs, output: Output) -> Panels:
        """Return the damper performance curves: amplitude, frequency, limits and optimum."""
        length, omega = output.length_unit, output.frequency_unit
        draw = partial(plots.damper, length_unit=length, omega_unit=omega)
        return [partial(draw, result) for result in results]


class OptimumView(View[OptimalDamper]):
    """Every local minimum, the least first."""

    texts = ("dof", "varied")
    numbers = ("value", "peak [{}]", "rad/s", RPM)

    def rows(self, result: OptimalDamper, dofs: Dofs, length: float) -> Rows:
        """Return a row per minimum."""
        settings = result.curve.settings
        for minimum in result.minima:
            yield (
                settings.dof,
                settings.variation.heading,
                f"{minimum.value:.6g}",
                f"{minimum.amplitude / length:#.7g}",
                f"{minimum.omega:#.6g}",
                *self.in_rpm(result.model, minimum.omega),
            )

    def facts(self, result: OptimalDamper) -> list[Row]:
        """Say what is said of the curve, and what the optimum assumes beside."""
        best = model_rows(result.model)
        # the optimum is that of a model with another value than the given one
        of_curve = [
            (f"{name} as given", said) if name == "contact" and (name, said) not in best else row
            for row in DamperView().facts(result.curve)
            for name, said in [row]
        ]
        return of_curve + [row for row in assumed(result) if row not in of_curve]

    def failures(self, result: OptimalDamper) -> list[str]:
        """Word what was not solved, one line per cause."""
        return DamperView().failures(result.curve)

    def panels(self, results: Sequence[OptimalDamper], dofs: Dofs, output: Output) -> Panels:
        """Return the damper performance curves."""
        return DamperView().panels([result.curve for result in results], dofs, output)

"""What is said and drawn of parameters that are fitted."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from stickslip.drawn import plots
from stickslip.results.fit import Fit
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row


class FitView(View[Fit]):
    """Values, intervals, and what the data do not determine."""

    texts = ("parameter",)
    numbers = ("value", "low", "high")
    last = ("",)

    def rows(self, result: Fit, dofs: Dofs, length: float) -> Rows:
        """Return a row per parameter."""
        for name, value in result.values.items():
            low, high = result.intervals[name]
            known = "" if result.identifiable[name] else "not determined"
            yield name, f"{value:.6g}", f"{low:.6g}", f"{high:.6g}", known

    def about(self, result: Fit) -> list[Row]:
        """Say what was fitted, and how well."""
        noise = "given" if result.noise_known else "estimated from the misfit"
        return [
            ("measured", ", ".join(result.names)),
            ("numbers", f"{result.arrays.observed.size}, noise {noise}"),
            ("scatter", f"{result.scatter:.4g} standard deviations"),
            ("criterion", f"BIC {result.bic:.6g}"),
            ("confidence", f"{result.settings.confidence:.4g}"),
            ("evaluations", f"{result.counters['evaluations']}"),
        ]

    def panels(self, results: Sequence[Fit], dofs: Dofs, output: Output) -> Panels:
        """Return measured and predicted numbers, and their differences."""
        units = {"length_unit": output.length_unit, "omega_unit": output.frequency_unit}
        drawn: Panels = []
        for one in results:
            if one.of_curves.any() or one.of_loops.any():
                drawn.append(partial(plots.fit, one, **units))
            drawn += [
                partial(plots.fit_backbone, one, damping=damping, **units)
                for damping in (False, True)
                if one.of_backbones(damping=damping).any()
            ]
            drawn.append(partial(plots.fit_residuals, one))
        return drawn

    def details(self, result: Fit, dofs: Dofs, output: Output) -> Panels:
        """Return the intervals."""
        return [partial(plots.fit_intervals, result)] if result.arrays.value.all() else []

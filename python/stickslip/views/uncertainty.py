"""What is said and drawn of parameters that are fitted, or uncertain."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from importlib.util import find_spec

import numpy as np

from stickslip.drawn import plots
from stickslip.results.expansion import FEWEST
from stickslip.results.fit import Fit
from stickslip.results.uncertainty import Uncertainty, reasons_in_words
from stickslip.settings.quantities import Backbone
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
        units = {"length_unit": output.length_unit, "omega_unit": output.omega_unit}
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


_SHOWN = (5.0, 50.0, 95.0)


class UncertaintyView(View[Uncertainty]):
    """Percentiles of every number with their intervals."""

    texts = ("number", "unit")
    numbers = tuple(f"{q:g} %" for q in _SHOWN)
    last = ("95 % within",)

    def rows(self, result: Uncertainty, dofs: Dofs, length: float) -> Rows:
        """Return a row per number."""
        for number, unit in result.settings.quantity.numbers.items():
            if not np.isfinite(result.values(number)).any():
                yield number, unit, *("-",) * len(_SHOWN), "-"
                continue
            found = [result.percentile(number, q) for q in _SHOWN]
            *_, last = found
            ends = f"{last.low:.5g} to {last.high:.5g}"
            yield number, unit, *(f"{one.value:.5g}" for one in found), ends

    def about(self, result: Uncertainty) -> list[Row]:
        """Say what was uncertain, and how it was sampled."""
        settings = result.settings
        laws = [
            (name, ", ".join(f"{key} {_told(one)}" for key, one in spec.items()))
            for name, spec in settings.parameters.items()
        ]
        return [
            *laws,
            ("quantity", settings.quantity.kind),
            ("samples", f"{settings.samples}, {settings.sampling}, seed {settings.seed}"),
            ("computed", f"{result.computed}, {result.failed} failed"),
            ("harmonics", f"{settings.harmonics}"),
        ]

    def failures(self, result: Uncertainty) -> list[str]:
        """Word what was not found, one line per cause."""
        total = result.arrays.status.size
        counts = reasons_in_words(result.reasons).items()
        return [f"{count} of {total} samples: {reason}" for reason, count in counts]

    def panels(self, results: Sequence[Uncertainty], dofs: Dofs, output: Output) -> Panels:
        """Return distributions, of backbones their bands."""
        drawn: Panels = []
        for one in results:
            if isinstance(one.settings.quantity, Backbone):
                drawn += [
                    partial(plots.backbone_band, one, omega_unit=output.omega_unit),
                    partial(plots.backbone_band, one, damping=True),
                ]
            else:
                drawn += [
                    partial(plots.uncertainty_distribution, one, number)
                    for number in one.numbers
                    if np.isfinite(one.values(number)).any()
                ]
        return drawn

    def details(self, result: Uncertainty, dofs: Dofs, output: Output) -> Panels:
        """Return the shares of the parameters, where a surrogate can be made."""
        if find_spec("openturns") is None or isinstance(result.settings.quantity, Backbone):
            return []
        return [
            partial(plots.sobol_indices, result, number)
            for number in result.numbers
            for values in [result.values(number)[np.isfinite(result.values(number))]]
            if values.size >= FEWEST and np.ptp(values) > 0.0
        ]


def _told(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)

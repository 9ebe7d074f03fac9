"""What is said and drawn of uncertain parameters."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from importlib.util import find_spec

import numpy as np

from stickslip.drawn import plots
from stickslip.results.expansion import FEWEST
from stickslip.results.uncertainty import Uncertainty, reasons_in_words
from stickslip.settings.quantities import Backbone
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row

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
                    partial(plots.backbone_band, one, omega_unit=output.frequency_unit),
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

"""What is said and drawn of mistuning studies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import product

import numpy as np

from stickslip.drawn import plots
from stickslip.errors import ModelError
from stickslip.results.mistuning import MistuningStudy
from stickslip.results.weibull import fit_weibull
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, titled
from stickslip.views.tables import Row, counted, listed

_HIGH = 99.9
"""Percentile of the fit that is printed."""
_DISTRIBUTIONS = 6
"""Those of a degree of freedom in a report; the table has all."""


class MistuningView(View[MistuningStudy]):
    """Mean, largest and percentiles of the amplification factors of every group."""

    texts = ("dof",)
    numbers = ("deviation", "coupling [N/m]", "disks", "mean", "largest", f"{_HIGH:g} %", "95 %")
    frequencies = False

    def rows(self, result: MistuningStudy, dofs: Dofs, length: float) -> Rows:
        """Return a row for the disks of one deviation and one coupling, and every DOF."""
        for d, deviation in enumerate(result.deviation):
            for c, coupling in enumerate(result.coupling_stiffness):
                for dof in result.dofs:
                    factors = result.amplification(dof)[d, c]
                    factors = factors[np.isfinite(factors)]
                    try:
                        found = fit_weibull(factors).percentile(_HIGH)
                        fit = [f"{found.value:.4f}", f"{found.low:.4f} to {found.high:.4f}"]
                    except ModelError:
                        fit = ["-", "too few or equal"]
                    yield (
                        dof,
                        f"{deviation:g}",
                        "-" if np.isnan(coupling) else f"{coupling:g}",
                        f"{factors.size}",
                        f"{factors.mean():.4f}" if factors.size else "-",
                        f"{factors.max():.4f}" if factors.size else "-",
                        *fit,
                    )

    def about(self, result: MistuningStudy) -> list[Row]:
        """Say which disks there are, and how their peaks were found."""
        settings = result.settings
        low, high = settings.span
        count, sectors = result.patterns.shape
        drawn = f"{settings.distribution}, seed {settings.seed}"
        drawn = "given" if settings.distribution is None else drawn
        couplings = [f"{value:g}" for value in result.coupling_stiffness if np.isfinite(value)]
        return [
            ("patterns", f"{count} of {sectors} sectors, {drawn}"),
            ("deviations", listed([f"{value:g}" for value in result.deviation])),
            ("couplings", f"{listed(couplings)} N/m" if couplings else "as the disk has them"),
            ("peaks", f"{settings.measure}, {low:.6g} to {high:.6g} rad/s"),
            ("harmonics", f"{settings.harmonics}"),
            ("solutions", f"{result.counters['points']}"),
        ]

    def failures(self, result: MistuningStudy) -> list[str]:
        """Word what was not solved, one line per cause."""
        return counted(result.status.ravel(), f"{result.status.size} peaks")

    def panels(self, results: Sequence[MistuningStudy], dofs: Dofs, output: Output) -> Panels:
        """Return the distributions; of several deviations or couplings how they move them."""
        drawn: Panels = []
        for result in results:
            several = (result.deviation.size > 1, result.coupling_stiffness.size > 1)
            for dof in _chosen(result, dofs):
                if several[0]:
                    drawn.append(partial(plots.amplification, result, dof, "deviation"))
                if several[1]:
                    drawn.append(partial(plots.amplification, result, dof, "coupling"))
                if not any(several):
                    drawn.append(partial(plots.distribution, result, dof))
        return drawn

    def details(self, result: MistuningStudy, dofs: Dofs, output: Output) -> Panels:
        """Return the distributions behind a picture of several deviations or couplings."""
        deviations, couplings = result.deviation.tolist(), result.coupling_stiffness.tolist()
        if len(deviations) == 1 and len(couplings) == 1:
            return []
        drawn: Panels = []
        for dof in _chosen(result, dofs):
            for deviation, coupling in list(product(deviations, couplings))[:_DISTRIBUTIONS]:
                stiffness = None if np.isnan(coupling) else coupling
                own = {"deviation": deviation, "coupling": stiffness}
                said = [f"deviation {deviation:g}"]
                said += [] if stiffness is None else [f"coupling {stiffness:g} N/m"]
                panel = partial(plots.distribution, result, dof, **own)
                drawn.append(titled(panel, ", ".join(said)))
        return drawn


def _chosen(result: MistuningStudy, dofs: Dofs) -> Sequence[str]:
    return [dof for dof in dofs if dof in result.dofs] or result.dofs

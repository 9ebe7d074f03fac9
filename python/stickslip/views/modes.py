"""What is said and drawn of nonlinear modes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from stickslip.drawn import plots
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, labelled
from stickslip.views.tables import Row, counted

_MOST = 12
"""Rows of a branch."""


class ModeView(View[NonlinearModes]):
    """Frequency and damping at the amplitudes given, or at some of a branch."""

    texts = ("",)

    def headings(self, dofs: Dofs, length_unit: str) -> list[str]:
        """Return the headings of the numbers, among them one for every DOF."""
        shown = (f"{dof} [{length_unit}]" for dof in dofs)
        return ["amplitude [m kg^1/2]", "rad/s", "damping ratio", "of it viscous", *shown]

    def rows(self, result: NonlinearModes, dofs: Dofs, length: float) -> Rows:
        """Return a row per amplitude."""
        count = result.omega.size
        if result.settings.whole:
            places = np.unique(np.linspace(0, max(count - 1, 0), min(count, _MOST)).astype(int))
        else:
            places = np.arange(count)
        sizes = [result.displacement_amplitude(dof) / length for dof in dofs]
        for index in places.tolist():
            yield (
                f"mode {result.settings.mode}",
                f"{result.amplitude[index]:.6g}",
                f"{result.omega[index]:#.8g}",
                f"{result.damping_ratio[index]:.6g}",
                f"{result.viscous_ratio[index]:.6g}",
                *(f"{size[index]:#.7g}" for size in sizes),
            )

    def about(self, result: NonlinearModes) -> list[Row]:
        """Say which mode it is."""
        rest = f"{result.linear_omega:.8g} rad/s, damping ratio {result.linear_damping_ratio:.6g}"
        return [
            ("mode", f"{result.settings.mode}, {result.omega.size} amplitudes"),
            ("at rest", rest),
            ("harmonics", f"{result.settings.harmonics}"),
        ]

    def failures(self, result: NonlinearModes) -> list[str]:
        """Word what was not solved, one line per cause."""
        return counted(result.status, f"{result.omega.size} amplitudes")

    def panels(self, results: Sequence[NonlinearModes], dofs: Dofs, output: Output) -> Panels:
        """Return frequency over amplitude, and damping."""
        options = {"omega_unit": output.frequency_unit}
        return [
            partial(plots.backbone, list(results), damping=False, **options),
            partial(plots.mode_damping, list(results)),
        ]

    def told_apart(
        self, results: Sequence[tuple[str, NonlinearModes]], dofs: Dofs, output: Output
    ) -> Panels:
        """Return modes in one figure, with their names and what distinguishes them."""
        from stickslip.plot.modes import names_of

        names, modes = zip(*results, strict=True)
        return labelled(self.panels(modes, dofs, output), names, names_of(modes))

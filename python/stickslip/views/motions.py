"""What is said and drawn of classified motions and of basin maps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial

import numpy as np

from stickslip.drawn import plots
from stickslip.errors import ModelError
from stickslip.results.basin_map import BasinMap
from stickslip.results.fate_arrays import Motion
from stickslip.results.motion_class import MotionClass
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row


class MotionView(View[MotionClass]):
    """Class, mode and amplitudes of motions."""

    texts = ("dof", "motion", "mode")
    numbers = ("amplitude [{}]", "rad/s", "decided [s]")

    def rows(self, result: MotionClass, dofs: Dofs, length: float) -> Rows:
        """Return a row per DOF."""
        for dof in dofs:
            yield (
                dof,
                str(result.motion),
                "" if result.mode is None else f"{result.mode}",
                f"{result.amplitude(dof) / length:#.7g}",
                f"{result.omega:#.6g}" if result.motion == Motion.SETTLED else "",
                f"{result.time:.4g}",
            )

    def about(self, result: MotionClass) -> list[Row]:
        """Say the class, and why."""
        return [
            ("motion", str(result.motion)),
            ("because", result.reason.advice),
            ("span", _span(result)),
        ]

    def failures(self, result: MotionClass) -> list[str]:
        """Say that a motion is undecided, in one line; empty if it is not."""
        undecided = result.motion == Motion.UNDECIDED
        return [f"{result.motion}. {result.reason.advice}"] if undecided else []

    def panels(self, results: Sequence[MotionClass], dofs: Dofs, output: Output) -> Panels:
        """Return the spectra of motions that have one."""
        unit, drawn = output.frequency_unit, [result for result in results if len(result.tail)]
        if not drawn:
            raise ModelError("motion: one that decays or grows for ever has no picture")
        return [partial(plots.lines, one, dof, omega_unit=unit) for one in drawn for dof in dofs]


class BasinView(View[BasinMap]):
    """What the starts lead to, and how many of them."""

    texts = ("motion", "mode")
    numbers = ("starts", "share", "rad/s")
    frequencies = False

    def rows(self, result: BasinMap, dofs: Dofs, length: float) -> Rows:
        """Return a row per outcome."""
        for place, (outcome, count) in enumerate(result.outcomes.items()):
            omega = result.omega[result.codes == place]
            known = omega[np.isfinite(omega)]
            yield (
                str(outcome.motion),
                "" if outcome.mode is None else f"{outcome.mode}",
                f"{count}",
                f"{count / len(result):.1%}",
                f"{np.median(known):#.6g}" if known.size else "",
            )

    def about(self, result: BasinMap) -> list[Row]:
        """Say which starts there are."""
        rows = []
        for axis, values in result.settings.axes:
            meant = f"mode {axis}" if isinstance(axis, int) else axis
            span = f"{len(values)} from {min(values):.6g} to {max(values):.6g} m"
            rows.append(("axis", f"{meant}: {span}"))
        return [
            *rows,
            ("starts", f"{len(result)}"),
            ("span", _span(result)),
            ("events", f"{result.counters['events']}"),
        ]

    def failures(self, result: BasinMap) -> list[str]:
        """Word what was not decided, one line per cause."""
        counts = Counter(reason for reason in result.reason if reason.motion == Motion.UNDECIDED)
        return [
            f"{count} of {len(result)} starts undecided. {reason.advice}"
            for reason, count in counts.items()
        ]

    def panels(self, results: Sequence[BasinMap], dofs: Dofs, output: Output) -> Panels:
        """Return the maps over two axes."""
        unit, drawn = output.length_unit, [result for result in results if result.settings.axes]
        if not drawn:
            raise ModelError("basin map: of a list of starts, which has no picture; give it axes")
        return [partial(plots.basins, result, length_unit=unit) for result in drawn]


def _span(result: MotionClass | BasinMap) -> str:
    return f"at most {result.settings.periods} periods of the lowest stuck mode"

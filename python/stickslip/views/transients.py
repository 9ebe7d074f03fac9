"""What is said and drawn of motions in time."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from stickslip.drawn import plots
from stickslip.results.transient import Transient
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, titled
from stickslip.views.tables import Row

_LOOPS = 100
"""Periods of a phase plane in a report."""


class TransientView(View[Transient]):
    """The amplitudes of the last period."""

    texts = ("dof",)
    numbers = ("amplitude [{}]", "periods", "change", "rad/s")
    last = ("status",)

    def rows(self, result: Transient, dofs: Dofs, length: float) -> Rows:
        """Return a row per DOF."""
        for dof in dofs:
            yield (
                dof,
                f"{result.amplitude(dof) / length:#.7g}",
                f"{result.periods}",
                f"{result.change[-1]:.1e}" if result.periods else "",
                f"{result.omega:#.6g}",
                str(result.status),
            )

    def about(self, result: Transient) -> list[Row]:
        """Say how the motion was followed, and how far."""
        settings = result.settings
        limit = (
            "" if settings.tolerance is None else f", until the change is {settings.tolerance:g}"
        )
        steps = f" of {settings.steps} steps" if settings.scheme == "rk4" else ""
        rows = [
            ("omega", f"{result.omega:.6g} rad/s"),
            ("scheme", settings.scheme),
            ("periods", f"{result.periods}{steps} of at most {settings.periods}{limit}"),
            ("kept", f"{result.time.size} instants of the last {result.kept_periods} periods"),
            ("status", str(result.status)),
        ]
        if settings.scheme == "exact":
            rows.append(("events", f"{len(result.events)} in the periods kept"))
        return rows

    def failures(self, result: Transient) -> list[str]:
        """Say that a run has not come to its end, in one line; empty if it has."""
        if result.status in ("settled", "completed"):
            return []
        return [f"{result.status} after {result.periods} periods. {result.status.advice}"]

    def panels(self, results: Sequence[Transient], dofs: Dofs, output: Output) -> Panels:
        """Return histories of DOFs and contacts, section and spectrum of the first DOF."""
        drawn: Panels = []
        for result in results:
            unit, omega = output.length_unit, output.frequency_unit
            history = partial(plots.history, result, omega_unit=omega, length_unit=unit)
            drawn += [partial(history, dof=dof) for dof in dofs]
            forces = partial(plots.contact_history, result, omega_unit=omega)
            drawn += [partial(forces, contact=one) for one in result.model.contact_names[:2]]
            drawn.append(partial(plots.poincare, result, dofs[0], length_unit=unit))
            if result.kept_periods:
                drawn.append(partial(plots.spectrum, result, dofs[0], omega_unit=omega))
        return drawn

    def details(self, result: Transient, dofs: Dofs, output: Output) -> Panels:
        """Return the phase plane of the first DOF."""
        if not result.periods:
            return []
        phase = partial(plots.phase, result, dofs[0], length_unit=output.length_unit)
        if result.kept_periods <= _LOOPS:
            return [phase]
        # thousands of loops are a ring of ink, and a page of tens of megabytes
        return [titled(partial(phase, last=_LOOPS), f"the last {_LOOPS} periods")]

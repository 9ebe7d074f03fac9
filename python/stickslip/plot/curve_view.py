"""How one response curve is drawn: its scale, line, limits, peak, error and gaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.plot.arguments import labels_of
from stickslip.plot.limits import force_level, limit_curve
from stickslip.plot.states import LINES, name_states, pieces
from stickslip.plot.style import FREE, GREY, LIMIT, RESPONSE, STUCK, Scale
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Float, Measure
from stickslip.results.exact_response import ExactResponse

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CurveView", "names_of", "span_of"]

Colour: TypeAlias = tuple[float, float, float, float]

_MEASURE = {
    "half_range": "half peak-to-peak",
    "max": "largest displacement",
    "fundamental": "fundamental amplitude",
}
# A band thinner than the line it lies under says nothing.
_VISIBLE_ERROR = 5e-3


@dataclass(frozen=True)
class CurveView:
    """What of a response is drawn, and in which units.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where.
    dof : str
        Degree of freedom.
    measure : {"half_range", "max", "fundamental"}
        Measure of the amplitude.
    omega, length : Scale
        Units of the two axes.
    per_force : bool
        Whether amplitudes are divided by the largest force amplitude.
    """

    ax: Axes
    dof: str
    measure: Measure
    omega: Scale
    length: Scale
    per_force: bool

    @property
    def unit(self) -> str:
        """Unit of the amplitudes."""
        return f"{self.length.label}/N" if self.per_force else self.length.label

    def label_axes(self) -> None:
        """Write what the axes show."""
        per_force = " per force" if self.per_force else ""
        self.ax.set_xlabel(self.omega.label)
        self.ax.set_ylabel(f"{_MEASURE[self.measure]} of {self.dof}{per_force} [{self.unit}]")

    def draw(self, result: ForcedResponse, colour: Colour, label: str) -> None:
        """Draw the curve, and crosses on the axis where there is no solution.

        Exact orbits that are unstable or undecided are dashed or dotted, and named in the legend.
        """
        omega = self.omega.factor * result.omega
        height = self._factor(result.model) * result.amplitude(self.dof, self.measure)
        states = np.full(omega.size, "stable")
        if isinstance(result, ExactResponse):
            states = np.where(result.arrays.solved, result.stability, "stable")
        for number, (piece, state) in enumerate(pieces(states)):
            (line,) = self.ax.plot(
                omega[piece],
                height[piece],
                color=colour,
                lw=1.6,
                ls=LINES[state],
                label="_" if number else label,
                marker="." if result.omega.size == 1 else "",
            )
            line.set_gid(RESPONSE)
        if not (states == "stable").all():
            name_states(self.ax, [states])
        failed = result.omega[~result.arrays.solved]
        if failed.size:
            self.ax.plot(
                self.omega.factor * failed,
                np.full(failed.size, 0.02),
                transform=self.ax.get_xaxis_transform(),
                ls="",
                marker="x",
                ms=5,
                color=colour,
                label=f"{failed.size} not solved",
            )

    def draw_limit(self, model: Model, span: tuple[float, float], at: str, *, stuck: bool) -> None:
        """Draw the linear response with all contacts stuck, or with none."""
        omega, amplitude = limit_curve(model, self.dof, span, self.measure, stuck=stuck)
        (line,) = self.ax.plot(
            self.omega.factor * omega,
            self._factor(model) * amplitude,
            color=GREY,
            lw=1.1,
            ls=STUCK if stuck else FREE,
            label=f"{'stuck' if stuck else 'free'} (linear{at})",
            zorder=1.5,
        )
        line.set_gid(LIMIT)

    def shade_error(self, result: ForcedResponse, colour: Colour) -> None:
        """Shade what the discarded harmonics could still change."""
        amplitude = result.amplitude(self.dof, self.measure)
        error = result.error_estimate(self.dof)
        if not (error > _VISIBLE_ERROR * amplitude).any():
            return
        factor = self._factor(result.model)
        self.ax.fill_between(
            self.omega.factor * result.omega,
            # A logarithmic axis has no place for zero.
            factor * np.maximum(amplitude - error, 1e-3 * amplitude),
            factor * (amplitude + error),
            color=colour,
            alpha=0.22,
            lw=0.0,
            label="estimated truncation error",
        )

    def mark_certificate(self, result: ForcedResponse, colour: Colour) -> None:
        """Mark the amplitudes of exact orbits, each with a bar to the curve: the true error."""
        certificate = result.certificate
        if certificate is None or self.dof not in certificate.dofs or self.measure != "half_range":
            return
        column = certificate.column(self.dof)
        x, factor = self.omega.factor * certificate.omega, self._factor(result.model)
        exact = factor * certificate.amplitude[:, column]
        curve = exact + factor * certificate.error[:, column]
        self.ax.vlines(x, exact, curve, color="crimson", lw=1.4, zorder=2.6)
        largest = np.abs(certificate.relative[:, column])
        worst = f" (error ≤ {np.nanmax(largest):.2g})" if np.isfinite(largest).any() else ""
        self.ax.plot(
            x,
            exact,
            ls="",
            marker="D",
            ms=4,
            mfc="white",
            mec="crimson",
            zorder=2.7,
            label=f"exact{worst}",
        )

    def mark_peak(self, result: ForcedResponse, colour: Colour, *, named: bool) -> None:
        """Mark the refined peak, unless there is none or it may lie outside or in a gap."""
        if not result.arrays.solved.any():
            return
        peak = result.peak(self.dof, self.measure)
        if peak.at_edge or peak.beside_gap or not np.isfinite(peak.amplitude):
            return
        x, y = self.omega.factor * peak.omega, self._factor(result.model) * peak.amplitude
        self.ax.plot(
            x,
            y,
            ls="",
            marker="o",
            ms=5,
            mfc="white",
            mec=colour,
            mew=1.3,
            label=f"peak {y:.4g} {self.unit} at {x:.5g} {self._omega_unit}" if named else None,
        )

    @property
    def _omega_unit(self) -> str:
        return self.omega.label.rpartition("[")[2].rstrip("]")

    def _factor(self, model: Model) -> float:
        if not self.per_force:
            return self.length.factor
        level = force_level(model)
        if level == 0.0:
            raise ModelError(
                'normalise: "force" needs a harmonic force, and a result has none; use None'
            )
        return self.length.factor / level


def names_of(results: Sequence[ForcedResponse], labels: Sequence[str] | None) -> list[str]:
    """Return one label per result: the given ones, or what distinguishes the results.

    Parameters
    ----------
    results : sequence of ForcedResponse
        The results.
    labels : sequence of str or None
        The labels, if given.

    Returns
    -------
    list of str
        One per result.

    Raises
    ------
    ModelError
        If the labels are not texts, or not as many as the results.
    """
    if labels is not None:
        return labels_of(labels, len(results))
    traits = [_traits(result) for result in results]
    telling = [key for key in traits[0] if len({trait.get(key) for trait in traits}) > 1]
    if len(results) == 1:
        telling = ["P"]
    elif not telling:
        return [f"result {position}" for position in range(len(results))]
    return [", ".join(trait[key] for key in telling if key in trait) for trait in traits]


def _traits(result: ForcedResponse) -> dict[str, str]:
    """Say in what results may differ, each in the notation of a legend."""
    traits = {"P": f"P = {force_level(result.model):.5g} N"}
    for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
        of = f" ({name})" if len(result.model.contacts) > 1 else ""
        parameters = contact.adjustable()
        for key, symbol, unit in (("slip_force", "F_d", "N"), ("stiffness", "k_d", "N/m")):
            if key in parameters and key not in contact.factors:
                values = ", ".join(f"{value:.4g}" for value in parameters[key])
                traits[f"{symbol}{of}"] = f"${symbol}$ = {values} {unit}{of}"
    exact = isinstance(result, ExactResponse)
    traits["H"] = "exact" if exact else f"H = {result.settings.harmonics}"
    return traits


def span_of(results: Sequence[ForcedResponse]) -> tuple[float, float]:
    """Return the lowest and the highest angular frequency of all results [rad/s]."""
    omega: Float = np.concatenate([result.omega for result in results])
    return float(omega.min()), float(omega.max())

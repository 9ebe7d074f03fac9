"""Response curves over frequency, drawn on Matplotlib axes.

Every function takes the axes to draw on, or makes a figure where none are given, and returns the
axes: ``frf.plot("tip").figure.savefig("tip.pdf")``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.disk import BladedDisk
from stickslip.disk.bladed_disk import rotor_order
from stickslip.errors import ModelError
from stickslip.model import Model, PointRef
from stickslip.plot import style
from stickslip.plot.arguments import checked_labels, several
from stickslip.plot.figure import figure
from stickslip.plot.limits import force_level, limit_curve, unit_level
from stickslip.plot.options import CurveOptions, Swept
from stickslip.plot.style import Colour, Looks, Scale
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Measure
from stickslip.results.exact_response import ExactResponse
from stickslip.results.fields import Float

_MEASURE = {
    "half_range": "half peak-to-peak",
    "max": "largest displacement",
    "fundamental": "fundamental amplitude",
}
# A band thinner than the line it lies under says nothing.
_VISIBLE_ERROR = 5e-3

_TRAITS = (
    ("slip_force", "F_d", "N"),
    ("stiffness", "k_d", "N/m"),
    ("friction", r"\mu", ""),
    ("preload", "N_0", "N"),
    ("gap", "g", "m"),
    ("tangential_stiffness", "k_t", "N/m"),
    ("normal_stiffness", "k_n", "N/m"),
)
"""Parameters by which results may differ, with symbol and unit."""


@figure
def curves(
    ax: Axes,
    /,
    results: ForcedResponse | Sequence[ForcedResponse],
    dof: str,
    **options: Unpack[CurveOptions],
) -> None:
    """Draw response curves over frequency, between their two linear limits."""
    listed, measure = several(ForcedResponse, results), options["measure"]
    names = checked_labels(options["labels"], _names_of(listed))
    omega, each = style.omega_scales(options["omega_unit"], listed)
    length = style.LENGTH[options["length_unit"]]
    for result in listed:
        result.amplitude(dof, measure)  # what is unknown is refused before anything is drawn
    per_force, auto = options["normalise"] == "force", options["length_unit"] == "auto"
    view = _View(ax, dof, measure, omega, length, per_force, auto)
    single = len(listed) == 1
    colours = style.colours(len(listed))
    for stuck, wanted in ((True, options["stuck"]), (False, options["free"])):
        # Springs without friction have one linear limit, that at rest.
        if stuck and not any(one.slips for result in listed for one in result.model.contacts):
            wanted = options["stuck"] or options["free"]
        if wanted:
            _draw_limits(view, list(zip(listed, each, colours, strict=True)), stuck=stuck)
    for result, name, colour, scale in zip(listed, names, colours, each, strict=True):
        own = replace(view, omega=scale)
        own.draw(result, colour, name)
        own.shade_bounds(result, colour)
        if options["error_band"] or (options["error_band"] is None and single):
            own.shade_error(result, colour)
        own.mark_certificate(result)
        if options["peaks"]:
            own.mark_peak(result, colour, named=single)
    view.label_axes()
    style.fit(ax, log=options["log"])


@figure
def slip(
    ax: Axes, /, result: ForcedResponse, contact: PointRef | None = None, **options: Unpack[Swept]
) -> None:
    """Draw the share of the period that contact points slip, and dashed, are open.

    Parameters
    ----------
    contact : int, str or (int or str, int), optional
        The contact, or one of its points. Default: all.
    """
    omega = style.omega_scale(options["omega_unit"], result)
    contacts: Sequence[PointRef] = (
        [contact] if contact is not None else contacts_with_states(result)
    )
    lines = [line for one in contacts for line in _shares(result, one)]
    if not lines:
        none = "the model has none, so that nothing slips"
        springs = "those of the model are springs, which neither slip nor open"
        raise ModelError(f"contact: {springs if result.model.contacts else none}")
    x = omega.factor * result.omega
    said = "slipping share of the period"
    for (label, share, opens), colour in zip(lines, style.colours(len(lines)), strict=True):
        ax.plot(x, share, color=colour, lw=1.6, label=label)
        if (opens > 0.0).any():
            ax.plot(x, opens, color=colour, lw=1.1, ls="--", label=f"{label} open")
            said = "share of the period that slips, dashed: is open"
    if x.min() < x.max():
        ax.set_xlim(x.min(), x.max())
    style.label_omega(ax, omega)
    ax.set(ylim=(-0.03, 1.03), ylabel=said)
    if len(lines) == 1:
        ax.set_title(lines[0][0], fontsize="medium")


@dataclass(frozen=True)
class _View:
    """What of responses is drawn, where, and in which units."""

    ax: Axes
    dof: str
    measure: Measure
    omega: Scale
    length: Scale
    per_force: bool
    """Whether amplitudes are divided by the largest force amplitude."""
    auto: bool
    """Whether lengths get a prefix."""
    named: bool = True
    """Whether the legend names the linear limits."""
    limits: Colour | None = None
    """Colour of the linear limits, if several are to be told apart."""

    @property
    def unit(self) -> str:
        """Unit of the amplitudes."""
        return f"{self.length.label}/N" if self.per_force else self.length.label

    def label_axes(self) -> None:
        """Write what the axes show."""
        per_force = " per force" if self.per_force else ""
        style.label_omega(self.ax, self.omega)
        self.ax.set_ylabel(
            f"{_MEASURE[self.measure]} of {style.named(self.dof)}{per_force} [{self.unit}]"
        )

    def draw(self, result: ForcedResponse, colour: Colour, label: str) -> None:
        """Draw the curve, and crosses on the axis where there is no solution.

        Motions that are unstable or undecided are dashed or dotted, and named in the legend, unless
        nothing is known of any. Squares mark folds. Further branches are lines of their own.
        """
        omega = self.omega.factor * result.omega
        height = self._factor(result.model) * result.amplitude(self.dof, self.measure)
        looks: Looks = {"color": colour, "lw": 1.6, "marker": "." if omega.size == 1 else ""}
        solved = result.arrays.solved
        states = np.full(omega.size, "stable")
        if (result.stability != "not decided").any():
            states = np.where(solved, result.stability, "stable")
        pieces = style.pieces(states, result.arrays.further)
        # the legend shows a solid line, if any
        named_at = next((at for at, (_, state) in enumerate(pieces) if state == "stable"), 0)
        for number, (piece, state) in enumerate(pieces):
            named: Looks = {
                "ls": style.LINES[state],
                "label": label if number == named_at else "_",
                "gid": style.RESPONSE,
            }
            self.ax.plot(omega[piece], height[piece], **looks, **named)
        if not (states == "stable").all():
            style.name_states(self.ax, [states])
        if result.folds.size:
            looks = style.mark("s", 4, colour) | {"zorder": 2.6, "label": "folds"}
            self.ax.plot(omega[result.folds], height[result.folds], **looks)
        if not solved.all():
            self.ax.plot(
                omega[~solved],
                np.full((~solved).sum(), 0.02),
                transform=self.ax.get_xaxis_transform(),
                color=colour,
                label=f"{(~solved).sum()} not solved",
                ls="",
                marker="x",
                ms=5,
            )

    def draw_limit(
        self, model: Model, span: tuple[float, float], at: str, *, stuck: bool, name: str = ""
    ) -> None:
        """Draw the linear response with all contacts stuck, or with none."""
        omega, amplitude = limit_curve(model, self.dof, span, self.measure, stuck=stuck)
        looks = style.linear_limit(stuck=stuck, of=at)
        if name:
            looks |= {"label": f"{name} (linear{at})"}
        if not self.named:
            looks |= {"label": "_"}
        if self.limits is not None:
            looks |= {"color": self.limits}
        x, y = self.omega.factor * omega, self._factor(model) * amplitude
        self.ax.plot(x, y, **looks)

    def shade_error(self, result: ForcedResponse, colour: Colour) -> None:
        """Shade what the discarded harmonics could still change."""
        amplitude = result.amplitude(self.dof, self.measure)
        error = result.error_estimate(self.dof)
        if not (error > _VISIBLE_ERROR * amplitude).any():
            return
        factor = self._factor(result.model)
        # A logarithmic axis has no place for zero.
        lower = factor * np.maximum(amplitude - error, 1e-3 * amplitude)
        upper, omega = factor * (amplitude + error), self.omega.factor * result.omega
        looks: Looks = {"color": colour, "label": "estimated truncation error"}
        if omega.size == 1:
            self.ax.vlines(omega, lower, upper, alpha=0.4, lw=4.0, **looks)
        else:
            self.ax.fill_between(omega, lower, upper, alpha=0.22, lw=0.0, **looks)

    def shade_bounds(self, result: ForcedResponse, colour: Colour) -> None:
        """Shade what other residual tractions make of the curve, if that is known."""
        if not result.bounded or self.measure != "half_range":
            return
        factor = self._factor(result.model)
        lower, upper = factor * result.lower(self.dof), factor * result.upper(self.dof)
        if not (upper > lower).any():
            return
        omega = self.omega.factor * result.omega
        looks: Looks = {"color": colour, "lw": 0.7}
        self.ax.fill_between(
            omega, lower, upper, color=colour, alpha=0.15, lw=0.0, label="all residual tractions"
        )
        for bound in (lower, upper):
            self.ax.plot(omega, bound, **looks, label="_")

    def mark_certificate(self, result: ForcedResponse) -> None:
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
        self.ax.plot(x, exact, **style.mark("D", 4, "crimson"), zorder=2.7, label=f"exact{worst}")

    def mark_peak(self, result: ForcedResponse, colour: Colour, *, named: bool) -> None:
        """Mark the refined peak, unless there is none or it may lie outside or in a gap."""
        if not result.arrays.solved.any():
            return
        peak = result.peak(self.dof, self.measure)
        if peak.at_edge or peak.beside_gap or not np.isfinite(peak.amplitude):
            return
        x, y = self.omega.factor * peak.omega, self._factor(result.model) * peak.amplitude
        unit = self.omega.label.rpartition("[")[2].rstrip("]")
        height = style.prefixed(y, self.unit, 4) if self.auto else f"{y:.4g} {self.unit}"
        label = f"peak {height} at {x:.5g} {unit}" if named else None
        self.ax.plot(x, y, **style.mark("o", 5, colour), mew=1.3, label=label)

    def _factor(self, model: Model) -> float:
        return self.length.factor / (unit_level(model) if self.per_force else 1.0)


def _draw_limits(
    view: _View, drawn: Sequence[tuple[ForcedResponse, Scale, Colour]], *, stuck: bool
) -> None:
    """Draw the linear limits, of each engine order and, stuck, of each stiffness of contacts."""
    groups: dict[tuple[Scale, float, object], list[ForcedResponse]] = {}
    first: dict[object, Colour] = {}
    for result, scale, colour in drawn:
        if not result.model.contacts:
            continue
        # Every engine order meets the disk at other nodal diameters.
        stiffness = _stiffness(result.model) if stuck else None
        kind = scale, rotor_order(result.model), stiffness
        groups.setdefault(kind, []).append(result)
        first.setdefault(kind, colour)
    orders, values = len({kind[1] for kind in groups}), len({kind[2] for kind in groups})
    differs = ["engine order"] * (orders > 1) + ["stiffness"] * (values > 1)
    each = f", each {' and '.join(differs)}" if differs else ""
    named = True
    for kind, results in groups.items():
        limits = first[kind] if differs else None
        own = replace(view, omega=kind[0], named=named, limits=limits)
        if _draw_limit(own, results, each, stuck=stuck):
            named = False


def _draw_limit(view: _View, results: Sequence[ForcedResponse], each: str, *, stuck: bool) -> bool:
    """Draw the linear limit of the most strongly forced result; return whether there is one."""
    levels = [force_level(result.model) for result in results]
    model = results[int(np.argmax(levels))].model
    omega: Float = np.concatenate([result.omega for result in results])
    low, high = float(omega.min()), float(omega.max())
    if low == high or not max(levels):
        return False
    level = "" if view.per_force or len(set(levels)) == 1 else f", {max(levels):.5g} N"
    if any(contact.slips for contact in model.contacts):
        view.draw_limit(model, (low, high), each + level, stuck=stuck)
        return True
    if stuck:
        view.draw_limit(model, (low, high), each + level, stuck=True, name="at rest")
    return stuck


def _stiffness(model: Model) -> object:
    """Return what contacts add to a structure that they stick to."""
    stiff = ("stiffness", "tangential_stiffness", "normal_stiffness")
    return tuple(
        tuple(one.adjustable().get(key, ()) for key in stiff) for one in model.contacts if one.slips
    )


def _shares(result: ForcedResponse, contact: PointRef) -> list[tuple[str, Float, Float]]:
    """Return label, slip and open fraction of every point meant by an address."""
    number, only = result.locate(contact)
    shares, opens = (
        of(contact).reshape(result.omega.size, -1).T
        for of in (result.slip_fraction, result.open_fraction)
    )
    name = style.named(result.model.contact_names[number])
    if only is None and len(shares) == 1:
        return [(name, shares[0], opens[0])]
    names = (f"{name}[{point}]" for point, _ in enumerate(shares, only or 0))
    return list(zip(names, shares, opens, strict=True))


def contacts_with_states(result: ForcedResponse) -> list[int]:
    """Return the contacts that can slip, and those that open; springs do neither."""
    return [
        number
        for number, one in enumerate(result.model.contacts)
        if one.slips or (result.open_fraction(number) > 0.0).any()
    ]


def traits_of(results: Sequence[ForcedResponse]) -> list[str]:
    """Return what distinguishes results, one text each; empty ones if nothing does."""
    traits = [_traits(result) for result in results]
    telling = [key for key in traits[0] if len({trait.get(key) for trait in traits}) > 1]
    return [", ".join(trait[key] for key in telling if key in trait) for trait in traits]


def _names_of(results: Sequence[ForcedResponse]) -> list[str]:
    """Return one label per result."""
    if len(results) == 1:
        return [_traits(results[0])["P"]]
    traits = traits_of(results)
    return traits if any(traits) else [f"result {place}" for place in range(len(results))]


def _traits(result: ForcedResponse) -> dict[str, str]:
    """Say in what results may differ, each in the notation of a legend."""
    traits = {"P": f"P = {force_level(result.model):.5g} N"}
    disk = getattr(result.model, "disk", result.model)
    if isinstance(disk, BladedDisk):
        traits["EO"] = f"EO {disk.engine_order}"
    for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
        of = f" ({style.named(name)})" if len(result.model.contacts) > 1 else ""
        parameters = contact.adjustable()
        for key, symbol, unit in _TRAITS:
            if key in parameters and key not in contact.factors:
                values = ", ".join(f"{value:.4g}" for value in dict.fromkeys(parameters[key]))
                own = contact.other_units.get(key, unit)
                traits[f"{symbol}{of}"] = f"${symbol}$ = {values} {own}".rstrip() + of
    exact = isinstance(result, ExactResponse)
    traits["H"] = "exact" if exact else f"H = {result.settings.harmonics}"
    return traits

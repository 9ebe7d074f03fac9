"""What another damper changes in the forced response of the SNECMA beam, Figs 4.3 and 4.4."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

import stickslip as ss
from stickslip_reproduce.curves import FREQUENCY, PER_FORCE
from stickslip_reproduce.numbers import Cell, Fact, Kind, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import Resolution

__all__ = ["REFERENCE", "SHOWN", "Variant", "compared"]

SPAN = (100.0, 300.0)
SHOWN = (6.563, 16.563, 38.438)
"""Loads whose curves are drawn [N], one of each of the three groups of Figs 4.3 and 4.4."""

NEAR = 0.02
"""How far the exact peak may be from that of 15 harmonics, over its frequency."""

KINDS: tuple[Kind, ...] = ("limit", "line", "line", "line")
PLACES = {"damper": "x₁", "tip": "x₂"}

Response: TypeAlias = ss.ForcedResponse | ss.ExactResponse


@dataclass(frozen=True)
class Variant:
    """A beam with a damper, at any load.

    Parameters
    ----------
    label : str
        What is different about it.
    model : callable
        Makes the model of a load [N].
    prefix : str, optional
        What stands before "damper" and "tip" in its degrees of freedom.
    exact : bool, optional
        Whether its law has exact orbits, which then make the facts.
    harmonics : int, optional
        Harmonics of its curves. Default: 15, as in Figs 4.3 and 4.4.
    orbits : sequence of float, optional
        Frequencies of exact orbits that make the curves instead [rad/s].
    """

    label: str
    model: Callable[[float], ss.Model]
    prefix: str = ""
    exact: bool = True
    harmonics: int = 15
    orbits: Sequence[float] | None = None

    def response(self, load: float, resolution: Resolution) -> Response:
        """Return the response to a load over frequency."""
        model, seen = self.model(load), [self.prefix + dof for dof in PLACES]
        if self.orbits is not None:
            return ss.exact_response(model, self.orbits, observe=seen)
        return ss.forced_response(
            model, SPAN, self.harmonics, tolerance=resolution.tolerance, observe=seen
        )

    def peak(self, dof: str, load: float, shown: Response) -> tuple[float, float]:
        """Return frequency and amplitude of the peak, exact where there are exact orbits."""
        name = self.prefix + dof
        peak = shown.peak(name)
        if self.exact and self.orbits is None:
            near = shown.omega[np.abs(shown.omega / peak.omega - 1.0) < NEAR]
            peak = ss.exact_response(self.model(load), near, observe=name).peak(name)
        return peak.omega, peak.amplitude


REFERENCE = Variant("elementary damper", ss.reference.snecma_beam)
"""The damper of Figs 4.3 and 4.4: a Jenkins element from the beam to the ground."""


def compared(variants: Sequence[Variant], resolution: Resolution, *facts: Fact) -> Numbers:
    """Return the response with the elementary damper and with variants of it.

    Curves are those of three loads, the table has the peaks of all eight; facts are exact peaks and
    how far they are from those of the elementary damper, before the further ones.
    """
    loads = sorted({*resolution.of(ss.reference.SNECMA_LOADS), *SHOWN})
    curves: dict[tuple[str, float], list[Series]] = {
        (dof, one): [] for dof in PLACES for one in SHOWN
    }
    rows: dict[tuple[str, float], list[Cell]] = {(dof, one): [] for dof in PLACES for one in loads}
    true: dict[tuple[str, float], float] = {}
    found = []
    for variant, kind in zip((REFERENCE, *variants), KINDS, strict=False):
        for load in loads:
            shown = variant.response(load, resolution)
            for dof, place in PLACES.items():
                name = variant.prefix + dof
                rows[dof, load].append(shown.peak(name).amplitude / load)
                if load not in SHOWN:
                    continue
                kept = shown.converged
                values = shown.amplitude(name)[kept] / load
                curves[dof, load].append(Series(variant.label, shown.omega[kept], values, kind))
                if dof == "tip" and not kept.all():
                    lost = float(np.sum(~kept))
                    found.append(Fact(f"points not solved at {load:g} N, {variant.label}", lost))
                omega, amplitude = variant.peak(dof, load, shown)
                own = true.setdefault((dof, load), amplitude)
                at = f"{place}, {load:g} N, {variant.label}"
                found.append(Fact(f"peak / P of {at}", amplitude / load, "m/N"))
                if variant is REFERENCE:
                    continue
                found += [
                    Fact(
                        f"peak against the elementary damper, {at}",
                        100 * (amplitude / own - 1),
                        "%",
                    ),
                    Fact(f"frequency of the peak of {at}", omega, "rad/s"),
                ]
    panels = tuple(
        Panel(tuple(series), f"{PLACES[dof]}, P = {load:g} N", PER_FORCE[dof])
        for (dof, load), series in curves.items()
    )
    columns = ("load [N]", "place", *(f"{one.label} [m/N]" for one in (REFERENCE, *variants)))
    table = tuple((load, PLACES[dof], *row) for (dof, load), row in rows.items())
    return Numbers(
        Plot(FREQUENCY, PER_FORCE["tip"], panels), (*found, *facts), Table(columns, table)
    )

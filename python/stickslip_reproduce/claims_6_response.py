"""Claims of chapter VI on frequency responses."""

from __future__ import annotations

from math import inf, pi

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import FORCE
from stickslip_reproduce.chapter_6 import DOFS, HARMONICS, SPAN
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.curves import FREQUENCY
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.pair_orbits import WIDE, curves, sets, with_limits
from stickslip_reproduce.resolution import Resolution

LINK = 1e5
"""Stiffness between the tips of two beams that a spring links [N/m]."""


@claim(
    "linear-at-20-n",
    "6.4.2",
    "For a low force amplitude, F_ex = 20N, none of the dampers slip at any time and the "
    "response of the system is linear. In this case, the displacement amplitudes at dampers 1 "
    "and 2 on one hand, and at damper 3 and 4 on the other hand, are very similar.",
    """Largest slip fraction at 20 N from 500 to 700 rad/s, and the differences of the peaks there;
    very similar is 5 %.""",
    rule=lambda n: verdict(
        n["slip fraction"] == 0.0 and max(n["peaks at 1 and 2"], n["peaks at 3 and 4"]) < 5.0,
        n["slip fraction"] == 0.0 and n["peaks at 1 and 2"] < 5.0,
    ),
    see="fig-6.8 fig-6.10",
)
def linear_at_20(resolution: Resolution) -> Found:
    """Slip and differences at 20 N."""
    shown = curves(20.0)
    share = max(float(shown.slip_fraction((0, point)).max()) for point in range(4))
    return Found((Fact("slip fraction", share), *_apart(20.0)))


def _apart(force: float) -> tuple[Fact, ...]:
    tops = [float(curves(force).amplitude(dof).max()) for dof in DOFS]
    return (
        Fact("peaks at 1 and 2", 100.0 * abs(tops[0] / tops[1] - 1.0), "%"),
        Fact("peaks at 3 and 4", 100.0 * abs(tops[2] / tops[3] - 1.0), "%"),
    )


@claim(
    "increasingly-different",
    "6.4.2",
    "As the amplitude of external forcing increases, F_ex ≥ 30N, the displacements at dampers 1 "
    "and 2, and 3 and 4, become increasingly different.",
    """Largest distance of the curves of 1 and 2, and of 3 and 4, over the larger peak, at 20, 40
    and 60 N: how it grows.""",
    rule=lambda n: verdict(
        n["1 and 2, 20 N"] < n["1 and 2, 40 N"] < n["1 and 2, 60 N"]
        and n["3 and 4, 20 N"] < n["3 and 4, 40 N"] < n["3 and 4, 60 N"],
        n["3 and 4, 20 N"] < n["3 and 4, 60 N"],
    ),
    see="fig-6.8 fig-6.10",
)
def increasingly(resolution: Resolution) -> Found:
    """Distances between the curves."""
    facts = []
    for pair in ((0, 1), (2, 3)):
        for force in (20.0, 40.0, 60.0):
            one, other = (curves(force).amplitude(DOFS[point]) for point in pair)
            apart = float(np.abs(one - other).max() / max(one.max(), other.max()))
            facts.append(Fact(f"{pair[0] + 1} and {pair[1] + 1}, {force:g} N", 100.0 * apart, "%"))
    return Found(tuple(facts))


@claim(
    "more-dampers-slip",
    "6.4.2",
    "For larger amplitudes of external forcing, F_ex = 50N, as a result of more dampers undergoing "
    "slipping, more resonance frequencies of the system are excited and another group of "
    "resonances appears.",
    """Contacts that slip on exact orbits at 50, 60, 90 and 120 N, from 500 to 700 rad/s.""",
    rule=lambda n: verdict(n["contacts that slip"] > 1),
    see="fig-6.8 fig-6.9",
)
def more_dampers(resolution: Resolution) -> Found:
    """Contacts that slip to 120 N."""
    return Found((Fact("contacts that slip", len(frozenset().union(*sets()))),))


@claim(
    "continuum",
    "6.4.2",
    "There are six separate resonance frequencies from 500 rad/s to 700 rad/s. This might explain "
    "the fact that for force amplitudes greater than 60N, there is a continuum of resonant "
    "response of the beam system.",
    """Natural frequencies from 500 to 700 rad/s of all eight slip configurations, of those that
    occur on exact orbits to 120 N, and by how much the curve of contact 1 at 120 N varies from 560
    to 640 rad/s, over its mean.""",
    rule=lambda n: verdict(
        n["of all configurations"] == 6 and n["of those that occur"] == 6,
        n["of those that occur"] > 3,
    ),
    see="fig-6.9 fig-6.11 table-6.4",
)
def continuum(resolution: Resolution) -> Found:
    """Resonances from 500 to 700 rad/s."""
    pair = ss.reference.damped_pair()
    every, occur = 0, 0
    for slipping, omega in ss.slip_configurations(pair).items():
        inside = int(((omega > SPAN[0]) & (omega < SPAN[1])).sum())
        every += inside
        occur += inside * (frozenset(point for _, point in slipping) in sets())
    shown = curves(120.0)
    flat = shown.amplitude(DOFS[0])[(shown.omega > 560.0) & (shown.omega < 640.0)]
    return Found(
        (
            Fact("of all configurations", every, "", 6.0),
            Fact("of those that occur", occur, "", 6.0),
            Fact("variation", 100.0 * float(np.ptp(flat) / flat.mean()), "%"),
        )
    )


@claim(
    "interesting-range",
    "6.4.2",
    "The boldfaced resonance frequencies correspond to frequencies in the interesting ranges of "
    "Figs. 6.8-6.11, i.e., from 500 to 700 rad/s.",
    """Highest amplitude at contact 1 at 120 N from 450 to 760 rad/s and where it is: near the
    resonance with contact 1 slipping, beyond the printed axis. At its end, 700 rad/s, it is two
    thirds of that. Beyond the axis, near the maximum, contacts 2 and 3 slip as well, as nowhere on
    it.""",
    rule=lambda n: verdict(SPAN[0] <= n["frequency of the maximum"] <= SPAN[1]),
    see="fig-6.9",
)
def interesting(resolution: Resolution) -> Found:
    """Maximum of contact 1 beyond the printed axis."""
    shown = ss.forced_response(ss.reference.damped_pair(120.0), np.linspace(*WIDE, 311), HARMONICS)
    size = shown.amplitude(DOFS[0])
    free = ss.natural_frequencies(ss.reference.damped_pair(), slipping=[("structural", 0)])
    inside = (shown.omega >= SPAN[0]) & (shown.omega <= SPAN[1])
    series = (
        Series("contact 1, 120 N", shown.omega, size),
        Series("end of the printed axis", [SPAN[1]] * 2, [0.0, float(size.max())]),
        Series("natural frequency, 1 slipping", [float(free[1])] * 2, [0.0, float(size.max())]),
    )
    plot = Plot(FREQUENCY, Axis("amplitude at contact 1", "m", "µm", 1e6), (Panel(series),))
    return Found(
        (
            Fact("frequency of the maximum", float(shown.omega[size.argmax()]), "rad/s"),
            Fact("maximum", float(size.max()), "m"),
            Fact("maximum from 500 to 700 rad/s", float(size[inside].max()), "m"),
            Fact("natural frequency, contact 1 slipping", float(free[1]), "rad/s"),
            Fact("contacts that slip beyond 700 rad/s", _slipping(shown, ~inside)),
            Fact("contacts that slip from 500 to 700 rad/s", _slipping(shown, inside)),
        ),
        plot,
    )


def _slipping(shown: ss.ForcedResponse, where: np.ndarray) -> int:
    return sum(float(shown.slip_fraction((0, point))[where].max()) > 0.0 for point in range(4))


@claim(
    "independent-beams",
    "6.4.2",
    "When both dampers 1 and 3 are slipping, the two SNECMA beams are actually independent from "
    "each other.",
    """Natural frequency from 500 to 700 rad/s with 1 and 3 slipping, and its distance from the
    nearest one of a single beam.""",
    rule=lambda n: verdict(n["distance"] < 1.0),
    see="table-6.4",
)
def independent(resolution: Resolution) -> Found:
    """Natural frequency with 1 and 3 slipping."""
    pair = ss.reference.damped_pair()
    both = ss.natural_frequencies(pair, slipping=[("structural", 0), ("structural", 2)])
    beam = ss.natural_frequencies(ss.reference.snecma_beam(), slipping=[0])
    apart = np.abs(both[:, None] - beam[None, :]).min(axis=1)
    (at,) = np.flatnonzero((both > SPAN[0]) & (both < SPAN[1]))
    return Found(
        (
            Fact("frequency", float(both[at]), "rad/s"),
            Fact("distance", float(apart[at]), "rad/s"),
        )
    )


@claim(
    "antisymmetric-steepness",
    "6.4.2",
    "The steepness of the resonant curves may be attributed to the antisymmetry of the external "
    "forcing",
    """Steepest slope |d ln x / d ln ω| at contact 1 from 450 to 760 rad/s, tips driven in
    opposition and in phase: at 60 N, and at 1 N, where nothing slips and both have the same
    resonance of 541 rad/s.""",
    rule=lambda n: verdict(
        n["60 N, in opposition"] > 1.5 * n["60 N, in phase"]
        and n["1 N, in opposition"] > 1.1 * n["1 N, in phase"],
        n["60 N, in opposition"] > 1.1 * n["60 N, in phase"],
    ),
    see="fig-6.8",
)
def steepness(resolution: Resolution) -> Found:
    """Slopes with forces in opposition and in phase."""
    facts, series = [], []
    omega = np.linspace(*WIDE, 401)
    for name, phase in (("in opposition", pi), ("in phase", 0.0)):
        for force in (60.0, 1.0):
            pair = ss.reference.damped_pair(force)
            both = [ss.Force("1.tip", force), ss.Force("2.tip", force, phase)]
            shown = ss.forced_response(pair.replaced(forces=both), omega, HARMONICS)
            size = shown.amplitude(DOFS[0])
            slope = np.abs(np.diff(np.log(size)) / np.diff(np.log(omega)))
            facts.append(Fact(f"{force:g} N, {name}", float(slope.max())))
            series.append(Series(f"{force:g} N, {name}", omega, size / size.max()))
    y = Axis("amplitude at contact 1 over the highest", log=True)
    return Found(tuple(facts), Plot(FREQUENCY, y, (Panel(tuple(series)),)))


@claim(
    "two-linked-beams",
    "6.4.2",
    "similar results were obtained when two beams, each attached to a flexible friction damper and "
    "coupled through a linear stiffness were subject to antisymmetric external forcing",
    """Two beams with a damper to ground each, tips linked by a spring of 1e5 N/m: steepest slope
    |d ln x / d ln ω| at the dampers at 20.313 N in opposition over that in phase. Similar is a
    steeper one, by a tenth at least.""",
    rule=lambda n: verdict(n["in opposition over in phase"] > 1.1),
)
def two_linked(resolution: Resolution) -> Found:
    """Slopes of two linked beams with forces in opposition and in phase."""
    beam = ss.reference.snecma_structure()
    link = ss.Coupling("1.tip", "2.tip", stiffness=LINK)
    linked = ss.join({"1": beam, "2": beam}, [link])
    dampers = [
        ss.Jenkins(
            f"{part}.damper",
            stiffness=ss.reference.DAMPER_STIFFNESS,
            slip_force=ss.reference.DAMPER_SLIP_FORCE,
            name=f"damper-{part}",
        )
        for part in (1, 2)
    ]
    omega = np.linspace(100.0, 500.0, 801)
    slopes = {}
    for name, phase in (("in opposition", pi), ("in phase", 0.0)):
        forces = [ss.Force("1.tip", FORCE), ss.Force("2.tip", FORCE, phase)]
        both = ss.Model(linked, dampers, forces)
        size = ss.forced_response(both, omega, HARMONICS).amplitude("1.damper")
        slopes[name] = float(np.abs(np.diff(np.log(size)) / np.diff(np.log(omega))).max())
    ratio = slopes["in opposition"] / slopes["in phase"]
    return Found(
        (
            Fact("in opposition over in phase", ratio),
            *(Fact(f"slope, {name}", value) for name, value in slopes.items()),
        )
    )


@claim(
    "drastic-at-3-and-4",
    "6.4.2",
    "There starts to be some slipping: the presence of slipping affects drastically the "
    "displacements at dampers 3 and 4.",
    """Share of the period that contact 1 slips at 30 N, the most; largest distance of the curves of
    contacts 3 and 4 from those of contacts that never slip, over their peak, at 30 and 60 N.
    Drastic is a quarter.""",
    rule=lambda n: verdict(
        n["slip at 30 N"] > 0.0 and n["30 N"] > 25.0, n["slip at 30 N"] > 0.0 and n["60 N"] > 25.0
    ),
    see="fig-6.10",
)
def drastic(resolution: Resolution) -> Found:
    """Distance from the linear response."""
    facts = [Fact("slip at 30 N", float(curves(30.0).slip_fraction((0, 0)).max()))]
    for force in (30.0, 60.0):
        shown = curves(force)
        linear = ss.forced_response(with_limits(force, [inf] * 4), shown.omega, 1)
        apart = [
            np.abs(shown.amplitude(dof) - linear.amplitude(dof)).max() / linear.amplitude(dof).max()
            for dof in DOFS[2:]
        ]
        facts.append(Fact(f"{force:g} N", 100.0 * float(min(apart)), "%"))
    return Found(tuple(facts))

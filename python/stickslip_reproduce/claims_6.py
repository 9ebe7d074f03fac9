"""Claims of chapter VI: dampers that are structures of their own."""

from __future__ import annotations

from functools import cache
from math import inf, pi

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_6 import DOFS, HARMONICS, SPAN
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.curves import FREQUENCY, PERIOD_SHARE, over_period
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution

WIDE = (450.0, 760.0)
"""Range that holds the resonance with contact 1 slipping [rad/s]."""

LEVELS = (20.0, 30.0, 40.0, 50.0, 55.0, 60.0, 70.0, 80.0, 90.0, 100.0, 110.0, 120.0)
LIMITS = np.array([24.6, 100.0, 246.05, inf])


@cache
def orbit(omega: float, force: float) -> ss.ExactResponse:
    """Return the exact orbit of the pair."""
    return ss.exact_response(ss.reference.damped_pair(force), [omega])


@cache
def stuck(omega: float, force: float) -> Float:
    """Return the forces of contacts that never slip, shape (n, 4)."""
    held = _with_limits(force, [inf] * 4)
    return np.asarray(ss.forced_response(held, [omega], 1).contact_force(0, 0))


def _with_limits(force: float, limits: list[float]) -> ss.Model:
    pair = ss.reference.damped_pair(force)
    (damper,) = pair.contacts
    other = ss.StructuralDamper(list(DOFS), stiffness=damper.stuck_stiffness, slip_forces=limits)
    return pair.replaced(contacts=[other])


def _forces(omega: float, force: float) -> Float:
    return np.asarray(orbit(omega, force).contact_force(0, 0))


@cache
def curves(force: float) -> ss.ForcedResponse:
    """Return the pair over the range of the figures."""
    return ss.forced_response(ss.reference.damped_pair(force), np.linspace(*SPAN, 201), HARMONICS)


@cache
def sets() -> frozenset[frozenset[int]]:
    """Return the slip configurations of exact orbits from 20 to 120 N, 500 to 700 rad/s."""
    found: set[frozenset[int]] = set()
    for force in (50.0, 60.0, 90.0, 120.0):
        every = ss.exact_response(ss.reference.damped_pair(force), np.linspace(*SPAN, 41))
        for place in range(len(every.omega)):
            found |= {frozenset(one) for one in every.contact_states(0, place).sets}
    return frozenset(found)


@claim(
    "property-1",
    "6.2",
    "When the damper relative displacement is maximum, the force transmitted by the friction "
    "damper is equal to its maximum value, F_d, and the damper starts sticking.",
    """Force at the largest displacement over F_d, exact orbits of the beam at 20.313 N: at 170
    rad/s, where the damper slips, and at 120, where it does not.""",
    rule=lambda n: verdict(min(n.values()) > 0.99, n["with slip"] > 0.99),
)
def property_1(resolution: Resolution) -> Found:
    """Force at the largest displacement."""
    facts = []
    for name, omega in (("with slip", 170.0), ("without slip", 120.0)):
        one = ss.exact_response(ss.reference.snecma_beam(20.313), [omega])
        moved = one.waveform("damper", 0)
        force = one.contact_force((0, 0), 0)
        at = int(np.argmax(moved) * force.size / moved.size)
        facts.append(Fact(name, float(force[at]) / ss.reference.DAMPER_SLIP_FORCE))
    return Found(tuple(facts))


@claim(
    "property-2",
    "6.3.3",
    "The sum of the forces transmitted by the damper element to the structure is equal to zero.",
    """Largest sum over the largest force, exact orbits of the four cases of Figs 6.4 to 6.7.""",
    rule=lambda n: verdict(n["largest sum"] < 1e-9),
    see="fig-6.4 fig-6.5 fig-6.6 fig-6.7",
)
def property_2(resolution: Resolution) -> Found:
    """Sum of the forces."""
    worst = 0.0
    for case in ((250.0, 15.0), (550.0, 35.0), (550.0, 140.0), (550.0, 550.0)):
        forces = _forces(*case)
        worst = max(worst, float(np.abs(forces.sum(axis=1)).max() / np.abs(forces).max()))
    return Found((Fact("largest sum", worst),))


@claim(
    "not-all-at-once",
    "6.3.3",
    "Therefore, all dampers cannot be simultaneously slipping.",
    """Most contacts that slip at once at 550 rad/s, 550 N: as printed, and with 300 N for the slip
    force of contact 4, so that all four may slip.""",
    rule=lambda n: verdict(max(n.values()) <= 3),
    see="fig-6.7",
)
def not_all_at_once(resolution: Resolution) -> Found:
    """Most contacts that slip at once."""
    finite = ss.exact_response(_with_limits(550.0, [24.6, 100.0, 246.05, 300.0]), [550.0])
    return Found(
        tuple(
            Fact(name, max(map(len, one.contact_states(0, 0).sets)))
            for name, one in (("as printed", orbit(550.0, 550.0)), ("F₄ = 300 N", finite))
        )
    )


@cache
def procedure_2(samples: int, periods: int, force: float, zero_start: bool = True) -> Float:
    """Return the forces of the last period by Procedure 2 as printed, shape (samples, 4).

    The displacements are those of the exact orbit at 550 rad/s; slipping contacts are put on their
    limits by (6.21). From zero forces at the first instant, or from those of the exact orbit.
    """
    one = orbit(550.0, force)
    instants = 2.0 * pi * np.arange(samples) / samples
    moved = np.array(
        [
            (np.exp(1j * np.outer(instants, np.arange(row.size))) @ row).real
            for row in (one.coefficients(dof)[0] for dof in DOFS)
        ]
    ).T
    stiffness = ss.reference.damped_pair().contacts[0].stuck_stiffness
    exact = one.contact_force(0, 0)
    now = np.zeros(4) if zero_start else np.array(exact[0])
    slips = np.zeros(4, bool)
    before = np.zeros(4)
    last = np.zeros((samples, 4))
    for step in range(periods * samples):
        change = moved[(step + 1) % samples] - moved[step % samples]
        given = change.copy()
        if slips.any():
            wanted = np.sign(now[slips]) * LIMITS[slips] - now[slips]
            rest = stiffness[np.ix_(slips, ~slips)] @ change[~slips]
            given[slips] = np.linalg.solve(stiffness[np.ix_(slips, slips)], wanted - rest)
        now = now + stiffness @ given
        relative = given - change
        turned = slips & (relative * before < 0.0)
        before = np.where(slips, relative, 0.0)
        slips = (slips & ~turned) | (~slips & (np.abs(now) >= LIMITS))
        last[(step + 1) % samples] = now
    return last


@claim(
    "overshooting",
    "6.3.3",
    "With this simple correction, it is ensured that the slipping values of the friction forces "
    "are equal to the maximum values, ±F_i, Eq. (6.22).",
    """Procedure 2 with (6.21) on the exact displacements at 550 rad/s, 550 N: by how much a force
    exceeds its limit, with 64 and with 1024 samples per period. It looks at the state one step
    late: the error falls with the step and is there for one step each time.""",
    rule=lambda n: verdict(n["64 samples"] < 0.01, n["1024 samples"] < 0.01),
)
def overshooting(resolution: Resolution) -> Found:
    """Return the forces beyond their limits by Procedure 2."""
    facts = []
    for samples in (64, 1024):
        forces = np.abs(procedure_2(samples, 3, 550.0, zero_start=False)[:, :3])
        facts.append(Fact(f"{samples} samples", float((forces - LIMITS[:3]).max()), "N"))
    return Found(tuple(facts))


@claim(
    "true-solution-is-reached",
    "6.3.4",
    "By repeating this time-marching procedure over several periods, we assume that the true "
    "solution is reached and that the forces are correctly determined.",
    """Procedure 2, 1024 samples, five periods from f(0) = 0 on the exact displacements of Fig. 6.5:
    mean of every force over the fifth period, largest of the contacts that never slip. It is the
    preload that zero forces at a displaced start freeze; the exact orbit has none.""",
    rule=lambda n: verdict(n["by Procedure 2"] < 0.1, n["by Procedure 2"] < 1.0),
    see="fig-6.5 fig-6.6",
)
def true_solution(resolution: Resolution) -> Found:
    """Preload that zero forces at the start freeze."""
    marched, true = procedure_2(1024, 5, 35.0), _forces(550.0, 35.0)
    means = [float(np.abs(_middle(one)[1:]).max()) for one in (marched, true)]
    panels = []
    for points in ((0, 1), (2, 3)):
        series = []
        for point in points:
            name = f"f{'₁₂₃₄'[point]}"
            series += [
                over_period(f"{name}, exact", true[:, point], kind="limit", pair=point),
                over_period(f"{name}, from f(0) = 0", marched[:, point], pair=point),
            ]
        panels.append(Panel(tuple(series), f"contacts {points[0] + 1} and {points[1] + 1}"))
    plot = Plot(PERIOD_SHARE, Axis("contact force", "N"), tuple(panels))
    return Found((Fact("by Procedure 2", means[0], "N"), Fact("exact", means[1], "N", 0.0)), plot)


def _middle(forces: Float) -> Float:
    return np.asarray(0.5 * (forces.max(axis=0) + forces.min(axis=0)))


@claim(
    "mere-stiffness",
    "6.4.1",
    "In Fig. 6.4, the damper structure acts like a mere stiffness and there is no non-linearity.",
    """Largest difference of the forces at 250 rad/s, 15 N to those of contacts that never slip.""",
    rule=lambda n: verdict(n["largest difference"] < 1e-6),
    see="fig-6.4",
)
def mere_stiffness(resolution: Resolution) -> Found:
    """Return the forces without slip."""
    found, linear = np.abs(_forces(250.0, 15.0)).max(axis=0), np.abs(stuck(250.0, 15.0)).max(axis=0)
    return Found((Fact("largest difference", float(np.abs(found - linear).max()), "N"),))


@claim(
    "non-smooth",
    "6.4.1",
    "the force at damper 2 is non-smooth, although damper 2 is never slipping",
    """Largest jump of the slope of f₂ from one sample of the period to the next, over the largest
    slope, at 550 rad/s, 35 N, and of the force if all stuck; whether contact 2 slips.""",
    rule=lambda n: verdict(n["jump"] > 5.0 * n["jump if stuck"] and n["contact 2 slips"] == 0),
    see="fig-6.5",
)
def non_smooth(resolution: Resolution) -> Found:
    """Corners of the force of contact 2."""
    jumps = []
    for forces in (_forces(550.0, 35.0), stuck(550.0, 35.0)):
        every = max(len(forces) // 128, 1)
        slope = np.diff(np.append(forces[::every, 1], forces[0, 1]))
        jumps.append(float(np.abs(slope - np.roll(slope, 1)).max() / np.abs(slope).max()))
    slipping = set().union(*orbit(550.0, 35.0).contact_states(0, 0).sets)
    return Found(
        (
            Fact("jump", jumps[0]),
            Fact("jump if stuck", jumps[1]),
            Fact("contact 2 slips", float(1 in slipping)),
        )
    )


@claim(
    "offset-forces",
    "6.4.1",
    "the forces at dampers 3 and 4 are offset with respect to the values they would have if all "
    "dampers were sticking all the time",
    """Middle of the range of f₃ and f₄ of the exact orbit at 550 rad/s, 35 N. Steady motion is
    symmetric; the printed offset is the preload of section 6.3.4.""",
    rule=lambda n: verdict(max(n.values()) > 0.1),
    see="fig-6.5",
)
def offset(resolution: Resolution) -> Found:
    """Offsets of the forces of contacts 3 and 4."""
    found = np.abs(_middle(_forces(550.0, 35.0)))
    return Found((Fact("f₃", float(found[2]), "N"), Fact("f₄", float(found[3]), "N")))


@claim(
    "two-at-once",
    "6.4.1",
    "there are times when damper 1 alone is slipping, times when damper 1 and 2 are slipping, and "
    "times when dampers 1 and 3 are slipping. For this particular force amplitude and at this "
    "frequency, two dampers at most are slipping at the same time.",
    """Most contacts that slip at once on the exact orbit at 550 rad/s, 140 N, and the largest share
    of its limit that contact 2 or 3 takes.""",
    rule=lambda n: verdict(n["slip at once"] == 2),
    see="fig-6.6",
)
def two_at_once(resolution: Resolution) -> Found:
    """Contacts that slip at 140 N."""
    forces = np.abs(_forces(550.0, 140.0)).max(axis=0)
    return Found(
        (
            Fact(
                "slip at once",
                max(map(len, orbit(550.0, 140.0).contact_states(0, 0).sets)),
                "",
                2.0,
            ),
            Fact("share of the limit", float((forces / LIMITS)[1:3].max())),
        )
    )


@claim(
    "greater-than-stuck",
    "6.4.1",
    "The force transmitted by a slipping damper point can be greater than the force this damper "
    "interface would transmit if all the dampers were sticking",
    """Largest force over that of contacts that never slip, of a contact that slips and of any, at
    550 rad/s and 35, 140 and 550 N.""",
    rule=lambda n: verdict(n["of one that slips"] > 1.0, n["of any"] > 1.0),
    see="fig-6.6 fig-6.7",
)
def greater(resolution: Resolution) -> Found:
    """Return the forces over those of the stuck damper."""
    slipping, any_one = 0.0, 0.0
    for force in (35.0, 140.0, 550.0):
        ratio = np.abs(_forces(550.0, force)).max(axis=0) / np.abs(stuck(550.0, force)).max(axis=0)
        slips = set().union(*orbit(550.0, force).contact_states(0, 0).sets)
        any_one = max(any_one, float(ratio.max()))
        slipping = max([slipping, *(float(ratio[point]) for point in slips)])
    return Found((Fact("of one that slips", slipping), Fact("of any", any_one)))


@claim(
    "never-with-elementary",
    "6.4.1",
    "for an elementary friction damper, the friction force is always smaller than the force the "
    "damper would transmit if it was never slipping",
    """Beam at eight loads, 100 to 300 rad/s: the most by which the amplitude of the force of a
    slipping damper exceeds that of one that never slips, as a factor.""",
    rule=lambda n: verdict(n["largest ratio"] <= 1.0),
)
def never_elementary(resolution: Resolution) -> Found:
    """Force of the elementary damper over that of a stuck one."""
    omega = np.linspace(100.0, 300.0, 201)
    worst = 0.0
    for load in ss.reference.SNECMA_LOADS:
        model = ss.reference.snecma_beam(load)
        held = model.replaced(
            contacts=[ss.Jenkins("damper", stiffness=ss.reference.DAMPER_STIFFNESS, slip_force=inf)]
        )
        true = ss.forced_response(model, omega, 15)
        linear = ss.forced_response(held, omega, 1).damper_amplitude((0, 0))
        slips = true.slip_fraction((0, 0)) > 0.0
        ratio = np.where(slips, true.damper_amplitude((0, 0)) / linear, 0.0)
        worst = max(worst, float(ratio.max()))
    return Found((Fact("largest ratio", worst),))


@claim(
    "three-at-once",
    "6.4.1",
    "when three dampers are slipping, all four friction forces are constant",
    """Contacts that slip at once at 550 rad/s, 550 N, and the largest change of any force from
    sample to sample while all three are on their limits, over the largest change of all.""",
    rule=lambda n: verdict(n["slip at once"] == 3 and n["largest change"] < 1e-9),
    see="fig-6.7",
)
def three_at_once(resolution: Resolution) -> Found:
    """Return the forces while three contacts slip."""
    forces = _forces(550.0, 550.0)
    on = (np.abs(np.abs(forces[:, :3]) - LIMITS[:3]) < 1e-9 * LIMITS[:3]).all(axis=1)
    change = np.abs(np.diff(forces, axis=0))
    both = on[1:] & on[:-1] & (np.sign(forces[1:]) == np.sign(forces[:-1])).all(axis=1)
    return Found(
        (
            Fact(
                "slip at once",
                max(map(len, orbit(550.0, 550.0).contact_states(0, 0).sets)),
                "",
                3.0,
            ),
            Fact("largest change", float(change[both].max() / change.max())),
        )
    )


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
    resonance with contact 1 slipping, beyond the printed axis.""",
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
    plot = Plot(FREQUENCY, Axis("amplitude at contact 1", "m", "10⁻⁵ m", 1e5), (Panel(series),))
    return Found(
        (
            Fact("frequency of the maximum", float(shown.omega[size.argmax()]), "rad/s"),
            Fact("maximum", float(size.max()), "m"),
            Fact("maximum from 500 to 700 rad/s", float(size[inside].max()), "m"),
            Fact("natural frequency, contact 1 slipping", float(free[1]), "rad/s"),
        ),
        plot,
    )


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
    slopes = {}
    for name, order in (("in opposition", 1), ("in phase", 0)):
        # A ring of two sectors has its link twice.
        both = ss.reference.beam_ring(sectors=2, coupling=0.5e5, engine_order=order)
        omega = np.linspace(100.0, 500.0, 801)
        size = ss.forced_response(both, omega, HARMONICS).amplitude("damper")
        slopes[name] = float(np.abs(np.diff(np.log(size)) / np.diff(np.log(omega))).max())
    ratio = slopes["in opposition"] / slopes["in phase"]
    return Found(
        (
            Fact("in opposition over in phase", ratio),
            *(Fact(f"slope, {name}", value) for name, value in slopes.items()),
        )
    )

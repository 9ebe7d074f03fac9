"""Claims of chapter V on one mass: the stiffness of the damper."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.cycles import at, turn
from stickslip_reproduce.mass_cycles import FREE, LIMIT, MODEL, NEGATIVE, NOMINAL
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution


@cache
def softest() -> ss.LimitCycles:
    """Return the exact branch over the stiffness of the damper at r = 1."""
    return ss.limit_cycles(MODEL, NEGATIVE, stiffness=(4e6, 2.4e10), method="exact")


@claim(
    "too-soft",
    "5.2.3",
    "no periodic motion is possible if the damper stiffness is too small",
    """Smallest stiffness with an exact limit cycle at r = 1, over the nominal one.""",
    rule=lambda n: verdict(n["smallest ν"] > 0.0),
    see="fig-5.8",
)
def too_soft(resolution: Resolution) -> Found:
    """Smallest stiffness with a limit cycle."""
    return Found((Fact("smallest ν", turn(softest()).value / NOMINAL),))


@claim(
    "unique-solution",
    "5.2.3",
    "the mostly sticking and the mostly slipping solutions defined in Section 5.2.1 tend toward a "
    "unique solution as the damper stiffness decreases to zero",
    """Stiffness at which the two meet, at r = 1, over the nominal one: they do so long before
    zero.""",
    rule=lambda n: verdict(n["they meet at ν"] < 1e-3, n["they meet at ν"] < 1.0),
    see="fig-5.8 fig-5.9",
)
def unique_solution(resolution: Resolution) -> Found:
    """Stiffness at which both solutions meet."""
    return Found((Fact("they meet at ν", turn(softest()).value / NOMINAL),))


@claim(
    "soft-frequency",
    "5.2.3",
    "there is no periodic solution for values of the friction damper stiffness that are small "
    "enough, and then the frequency of oscillation tends towards the minimum frequency, ω_min",
    """Frequency where the two solutions meet, at r = 1, between ω_min = 0 and ω_max = 1 of that
    stiffness.""",
    rule=lambda n: verdict(n["place between ω_min and ω_max"] < 0.1),
    see="fig-5.9",
)
def soft_frequency(resolution: Resolution) -> Found:
    """Frequency of the softest limit cycle."""
    limit = turn(softest())
    stuck = FREE * np.sqrt(1.0 + limit.value / NOMINAL)
    return Found(
        (Fact("place between ω_min and ω_max", float((limit.omega - FREE) / (stuck - FREE))),)
    )


@claim(
    "two-rigid-solutions",
    "5.2.3",
    "there are two periodic solutions. One solution corresponds to the trivial case: A = 0, and "
    "the other one has an amplitude and frequency independent of the damper stiffness.",
    """Exact amplitudes at ν = 10 and 1000: the sticking one at 1000 over that at 10, and the change
    of the slipping one.""",
    rule=lambda n: verdict(n["sticking, ratio"] < 0.02 and n["slipping, change"] < 1.0),
    see="fig-5.8 fig-5.9",
)
def two_rigid(resolution: Resolution) -> Found:
    """Amplitudes of stiff dampers."""
    found = ss.limit_cycles(
        MODEL, NEGATIVE, stiffness=[10 * NOMINAL, 1000 * NOMINAL], method="exact"
    )
    size = found.amplitude("mass")
    low, high = (
        [size[at(found, nu * NOMINAL, side)] for nu in (10, 1000)]
        for side in ("sticking", "slipping")
    )
    return Found(
        (
            Fact("sticking, ratio", float(low[1] / low[0])),
            Fact("slipping, change", 100.0 * abs(float(high[1] / high[0]) - 1.0), "%"),
        )
    )


@claim(
    "rigid-values",
    "5.2.3",
    "the one-harmonic approximation in the rigid friction damper case predicts ω_min = 159.5 "
    "rad/s, and A = 2.65·10⁻⁴ m, and these are the values also found by the multi-harmonic, "
    "Broyden method",
    """Eq. (5.20) at r = 1, and the exact rigid damper. The print's frequency is rounded, its
    amplitude is not reproduced at r = 1.""",
    rule=lambda n: verdict(
        abs(n["A of (5.20)"] / 2.65e-4 - 1.0) < 0.01 and abs(n["ω_min"] - 159.5) < 0.15
    ),
    see="fig-5.8 fig-5.9",
)
def rigid_values(resolution: Resolution) -> Found:
    """Amplitude and frequency of the rigid damper."""
    rigid, rough = (
        ss.rigid_limit_cycle(
            mass=MODEL.structure.mass[0, 0],
            damping=NEGATIVE[0, 0],
            stiffness=MODEL.structure.stiffness[0, 0],
            slip_force=LIMIT,
            single_harmonic=single,
        )
        for single in (False, True)
    )
    return Found(
        (
            Fact("A of (5.20)", rough.amplitude, "m", 2.65e-4),
            Fact("A, exact", rigid.amplitude, "m", 2.65e-4),
            Fact("ω_min", rough.omega, "rad/s", 159.5),
        )
    )


@claim(
    "softer-slips-less",
    "5.2.3",
    "with all other parameters fixed, the lower the damper stiffness, the less slipping during "
    "each cycle of motion",
    """Exact cycles at r = 1 and ν = 0.2, 0.5, 1, 2 and 5: steps in which the slip fraction falls
    with the stiffness. It does on the slipping side; on the sticking side, the stable one, a softer
    damper slips more, as it has to lose the same share of a larger energy.""",
    rule=lambda n: verdict(min(n.values()) == 4, max(n.values()) == 4),
    see="fig-5.8",
)
def softer_slips_less(resolution: Resolution) -> Found:
    """Slip fractions by stiffness."""
    values = [NOMINAL * nu for nu in (0.2, 0.5, 1.0, 2.0, 5.0)]
    found = ss.limit_cycles(MODEL, NEGATIVE, stiffness=values, method="exact")
    shares = found.slip_fraction((0, 0))
    facts = []
    for side in ("sticking", "slipping"):
        own = [shares[at(found, value, side)] for value in values]
        facts.append(Fact(f"steps on the {side} side", int((np.diff(own) > 0.0).sum())))
    return Found(tuple(facts))


@claim(
    "narrower-range",
    "5.2.3",
    "the range of possible oscillation frequency decreases as the damper stiffness decreases",
    """Distance of the frequencies of both exact cycles at r = 1, over that at ν = 1.""",
    rule=lambda n: verdict(n["ν = 0.2"] < n["ν = 0.5"] < 1.0),
    see="fig-5.9",
)
def narrower_range(resolution: Resolution) -> Found:
    """Distance of the frequencies by stiffness."""
    values = [NOMINAL * nu for nu in (0.2, 0.5, 1.0)]
    found = ss.limit_cycles(MODEL, NEGATIVE, stiffness=values, method="exact")
    apart = [
        float(found.omega[at(found, value, "sticking")] - found.omega[at(found, value, "slipping")])
        for value in values
    ]
    return Found((Fact("ν = 0.2", apart[0] / apart[2]), Fact("ν = 0.5", apart[1] / apart[2])))

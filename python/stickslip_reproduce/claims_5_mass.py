"""Claims of chapter V on one mass with negative damping."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce import beam_orbits
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.cycles import at, turn
from stickslip_reproduce.mass_cycles import (
    FREE,
    LIMIT,
    MODEL,
    NEGATIVE,
    STUCK,
    TRIED,
    exact,
    kept,
    tried,
)
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution


@claim(
    "some-slipping",
    "5.2",
    "all periodic motions predicted by a harmonic balance analysis will exhibit at least some "
    "slipping during each period of the motion",
    """Smallest slip fraction on the whole branch of 5 harmonics.""",
    rule=lambda n: verdict(n["smallest slip fraction"] > 0.0),
    see="fig-5.3",
)
def some_slipping(resolution: Resolution) -> Found:
    """Slip of the limit cycles."""
    return Found((Fact("smallest slip fraction", float(kept(5).slip_fraction(0).min())),))


@claim(
    "no-motion-beyond",
    "5.2.1",
    "For values of the negative viscous damping ratio large enough, r > r_max, the friction damper "
    "is not able to dissipate all the energy brought into the system by negative viscous damping. "
    "Therefore, there is a net increase of energy, and no stable motion.",
    """Exact r_max; of seven starts from 1e-6 to 1e-3 m at 1.01 r_max those that grow without bound,
    and of the same at 0.99 r_max.""",
    rule=lambda n: verdict(n["beyond, unbounded"] == 7 and n["before, unbounded"] < 7),
    see="fig-5.1 fig-5.3",
)
def no_motion_beyond(resolution: Resolution) -> Found:
    """Fates of starts beyond r_max."""
    last = turn(exact()).ratio
    facts = [Fact("r_max, exact", last)]
    for name, factor in (("beyond", 1.01), ("before", 0.99)):
        driven = ss.destabilised(MODEL, NEGATIVE, factor * last)
        ends = ss.basin_map(
            driven, starts=[{"mass": float(size)} for size in np.geomspace(1e-6, 1e-3, 7)]
        )
        facts.append(Fact(f"{name}, unbounded", sum(one == "unbounded" for one in ends.motion)))
    return Found(tuple(facts))


@claim(
    "two-amplitudes",
    "5.2.1",
    "For lower values of the damping ratio, there are two amplitudes of harmonic motion predicted "
    "by the method.",
    """Exact limit cycles per ratio, least and most over seven ratios.""",
    rule=lambda n: verdict(n["least"] == 2 and n["most"] == 2),
    see="fig-5.1",
)
def two_amplitudes(resolution: Resolution) -> Found:
    """Limit cycles per ratio."""
    counts = [int(np.isclose(tried().values, ratio).sum()) for ratio in TRIED]
    return Found((Fact("least", min(counts)), Fact("most", max(counts))))


@claim(
    "cannot-predict-stability",
    "5.2.1",
    "The hybrid frequency/time method is able to find periodic solutions, but it cannot predict "
    "their stability.",
    """Share of the cycles of 5 harmonics whose multipliers, along the cycle of the balance, give
    the stability of their side: sticking stable, slipping unstable, within 0.1 % of the fold left
    out. With multipliers it can.""",
    rule=lambda n: verdict(n["right"] < 50.0, n["right"] < 99.0),
)
def stability_by_balance(resolution: Resolution) -> Found:
    """Stability by multipliers of harmonic balance."""
    found = kept(5)
    counted = found.values < 0.999 * turn(found).value
    states = np.where(found.branch == "sticking", "stable", "unstable")
    right = np.asarray(found.stability)[counted] == states[counted]
    return Found((Fact("right", 100.0 * float(right.mean()), "%"),))


@claim(
    "high-branch-decides",
    "5.2.1",
    "the system is unstable when the initial displacement is larger than the amplitude of the high "
    "branch, and the initial velocity is zero. When the initial displacement is lower than the "
    "converged amplitude of the high branch, and the initial velocity is zero, the system is "
    "stable, and converges toward the lower branch.",
    """Starts at 0.98 and 1.02 of the exact slipping cycle at seven ratios with both friction forces
    that the text leaves open: those that do as it says. It holds with the force of the cycle
    itself, f = F_d.""",
    rule=lambda n: verdict(min(n.values()) == 100.0, n["f(0) = F_d"] == 100.0),
    see="fig-5.4",
)
def high_branch(resolution: Resolution) -> Found:
    """Return the starts beside the slipping branch with two friction forces."""
    facts = []
    for name, force in (("f(0) = 0", 0.0), ("f(0) = F_d", LIMIT)):
        right = []
        for ratio in TRIED:
            slips, sticks = (at(tried(), ratio, side) for side in ("slipping", "sticking"))
            driven = tried().model_at(slips)
            size = float(tried().amplitude("mass")[slips])
            ends = ss.basin_map(
                driven,
                starts=[
                    ss.State(driven, {"mass": factor * size}, contact_force=[force])
                    for factor in (0.98, 1.02)
                ],
            )
            low = tried().amplitude("mass")[sticks]
            back = ends.motion[0] == "settled" and bool(
                np.isclose(ends.amplitude("mass")[0], low, rtol=1e-3)
            )
            right += [back, ends.motion[1] == "unbounded"]
        facts.append(Fact(name, 100.0 * float(np.mean(right)), "% as said"))
    return Found(tuple(facts))


@claim(
    "between-the-frequencies",
    "5.2.1",
    "the frequency of the motion has to be lower than the frequency when the friction damper is "
    "fully stuck, ω_max (sticking natural frequency) and it has to higher to the slipping natural "
    "frequency, ω_min",
    """Least and largest frequency of the exact branch, over 159.40 and 225.42 rad/s.""",
    rule=lambda n: verdict(n["least over ω_min"] > 1.0 and n["largest over ω_max"] < 1.0),
    see="fig-5.2",
)
def between(resolution: Resolution) -> Found:
    """Frequencies of the branch."""
    omega = exact().omega
    return Found(
        (
            Fact("least over ω_min", float(omega.min()) / FREE),
            Fact("largest over ω_max", float(omega.max()) / STUCK),
        )
    )


@claim(
    "limits-of-frequency",
    "5.2.1",
    "The values of the limiting resonance frequencies computed in Eqs. (5.10) and (5.11) match the "
    "values found by the method as the negative viscous damping tends to zero",
    """Frequencies of both exact cycles at r = 0.01 over these values.""",
    rule=lambda n: verdict(max(abs(value - 1.0) for value in n.values()) < 1e-3),
    see="fig-5.2",
)
def limits_of_frequency(resolution: Resolution) -> Found:
    """Frequencies at r = 0.01."""
    ends = ss.limit_cycles(MODEL, NEGATIVE, ratio=[0.01], method="exact")
    return Found(
        (
            Fact("slipping", float(ends.omega[at(ends, 0.01, "slipping")]) / FREE),
            Fact("sticking", float(ends.omega[at(ends, 0.01, "sticking")]) / STUCK),
        )
    )


@claim(
    "number-of-harmonics",
    "5.2.2",
    "Note that the number of harmonics has nearly no effect on the response.",
    """r_max of one harmonic to the exact one; nearly none is 1 %.""",
    rule=lambda n: verdict(n["difference of r_max"] < 1.0),
    see="fig-5.3",
)
def number_of_harmonics(resolution: Resolution) -> Found:
    """Difference of r_max."""
    apart = abs(turn(kept(1)).ratio / turn(exact()).ratio - 1.0)
    return Found((Fact("difference of r_max", 100.0 * apart, "%"),))


@claim(
    "mono-harmonic",
    "5.2.2",
    "The free response of a single-DOF system attached to a flexible friction damper is mostly "
    "mono-harmonic",
    """Largest third harmonic of the mass over the first, on the whole branch of 5 harmonics.""",
    rule=lambda n: verdict(n["third over first"] < 5.0),
)
def mono_harmonic(resolution: Resolution) -> Found:
    """Third harmonic of the limit cycles."""
    found = np.abs(kept(5).coefficients("mass"))
    return Found((Fact("third over first", 100.0 * float((found[:, 3] / found[:, 1]).max()), "%"),))


@claim(
    "good-agreement",
    "5.2.2",
    "The agreement between the two methods is very good. Only the stable, mostly sticking motion "
    "could be obtained by forward numerical integration.",
    """Largest difference of amplitude and frequency of 5 harmonics to motions in time at seven
    ratios, from 2 % below the slipping cycle with f = F_d, and how many come to the sticking
    one.""",
    rule=lambda n: verdict(n["amplitude"] < 1.0 and n["frequency"] < 1.0 and n["sticking"] == 7),
    see="fig-5.4 fig-5.5 fig-5.6 fig-5.7",
)
def good_agreement(resolution: Resolution) -> Found:
    """Harmonic balance against motions in time."""
    balance = ss.limit_cycles(MODEL, NEGATIVE, ratio=TRIED, harmonics=5, stability=False)
    sizes, omegas, reached = [], [], 0
    for ratio in TRIED:
        slips = at(tried(), ratio, "slipping")
        driven = tried().model_at(slips)
        start = ss.State(
            driven, {"mass": 0.98 * tried().amplitude("mass")[slips]}, contact_force=[LIMIT]
        )
        ends = ss.basin_map(driven, starts=[start])
        sticks = at(balance, ratio, "sticking")
        sizes.append(balance.amplitude("mass")[sticks] / ends.amplitude("mass")[0] - 1.0)
        omegas.append(balance.omega[sticks] / ends.omega[0] - 1.0)
        reached += abs(sizes[-1]) < 0.05
    return Found(
        (
            Fact("amplitude", 100.0 * float(np.abs(sizes).max()), "%"),
            Fact("frequency", 100.0 * float(np.abs(omegas).max()), "%"),
            Fact("sticking", reached),
        )
    )


@claim(
    "chosen-alike",
    "5.2.1",
    "The mass and the stiffness are chosen so that the sticking and slipping resonance frequencies "
    "of the single-DOF system are identical to the ones of the 3-DOF beam",
    """Both natural frequencies of the mass over those of the beam; identical to the printed digits
    is 0.003 %.""",
    rule=lambda n: verdict(max(n.values()) < 0.003, max(n.values()) < 0.5),
    see="table-5.3",
)
def chosen_alike(resolution: Resolution) -> Found:
    """Differences of the natural frequencies."""
    return Found(
        tuple(
            Fact(name, 100.0 * abs(own / beam - 1.0), "%")
            for name, own, beam in (
                ("sticking", STUCK, beam_orbits.STUCK),
                ("slipping", FREE, beam_orbits.SLIPPING),
            )
        )
    )


@claim(
    "lower-sticks-higher-slips",
    "5.2.1",
    "The lower one corresponds to a mostly sticking motion, and the higher one corresponds to a "
    "mostly slipping motion.",
    """Slip fractions of the exact cycles at seven ratios: the largest of the lower and the smallest
    of the higher one, there and at r = 1 and less. Near r_max both slip for half of the period.""",
    rule=lambda n: verdict(
        n["lower, all ratios"] < 0.5 < n["higher, all ratios"],
        n["lower, r ≤ 1"] < 0.5 < n["higher, r ≤ 1"],
    ),
    see="fig-5.1 fig-5.3",
)
def lower_sticks(resolution: Resolution) -> Found:
    """Slip fractions of both cycles."""
    shares = tried().slip_fraction((0, 0))
    facts = []
    for name, top in (("all ratios", TRIED[-1]), ("r ≤ 1", 1.0)):
        ratios = [ratio for ratio in TRIED if ratio <= top]
        low, high = (
            [float(shares[at(tried(), ratio, side)]) for ratio in ratios]
            for side in ("sticking", "slipping")
        )
        facts += [Fact(f"lower, {name}", max(low)), Fact(f"higher, {name}", min(high))]
    return Found(tuple(facts))


@claim(
    "stable-and-unstable",
    "5.2.1",
    "The higher one is stable and corresponds to the mostly sticking motion, and the lower one is "
    "unstable and corresponds to the mostly slipping motion.",
    """Multiplier of the exact cycles at seven ratios: the largest on the sticking and the smallest
    on the slipping side, which has the lower frequency.""",
    rule=lambda n: verdict(
        n["sticking"] < 1.0 < n["slipping"] and n["sticking over slipping frequency"] > 1.0
    ),
    see="fig-5.2",
)
def stable_and_unstable(resolution: Resolution) -> Found:
    """Multipliers and frequencies of both cycles."""
    places = {
        side: [at(tried(), ratio, side) for ratio in TRIED] for side in ("sticking", "slipping")
    }
    largest = {
        side: [float(np.abs(tried().multipliers[place]).max()) for place in own]
        for side, own in places.items()
    }
    turns = [
        tried().omega[a] / tried().omega[b]
        for a, b in zip(places["sticking"], places["slipping"], strict=True)
    ]
    return Found(
        (
            Fact("sticking", max(largest["sticking"])),
            Fact("slipping", min(largest["slipping"])),
            Fact("sticking over slipping frequency", float(min(turns))),
        )
    )


@claim(
    "slip-and-stiction",
    "5.2.1",
    "periods of slip alternated with periods of stiction are always present in the steady-state "
    "free response",
    """Smallest and largest slip fraction on the whole exact branch.""",
    rule=lambda n: verdict(n["least"] > 0.0 and n["most"] < 1.0),
    see="fig-5.1",
)
def slip_and_stiction(resolution: Resolution) -> Found:
    """Slip fractions of the branch."""
    shares = np.asarray(exact().slip_fraction(0))
    return Found((Fact("least", float(shares.min())), Fact("most", float(shares.max()))))

"""Claims of chapter V on stability with all modes damped negatively."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_cycles import BEAM, EVERY, NEGATIVE, branch, cases
from stickslip_reproduce.chapter_5_modes import STARTS
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.cycles import beside, held, turn
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

END = 4.9
"""Where mode 1 ends in print."""

KEPT = (3, 5, 9, 15, 63)
"""Highest harmonics at which the fold of mode 1 is sought."""


@claim(
    "higher-modes-higher-damping",
    "5.4.1",
    "the higher modes, though possessing the same negative viscous damping constants, α and β, "
    "feature higher damping, due to the higher frequencies",
    """Negative damping of modes 2 and 3 of the stuck beam over that of mode 1, as a rate of growth
    and as a damping ratio.""",
    rule=lambda n: verdict(min(n.values()) > 1.0, min(n["rate, 2"], n["rate, 3"]) > 1.0),
)
def higher_damping(resolution: Resolution) -> Found:
    """Damping of the modes."""
    omega = ss.natural_frequencies(BEAM)
    rate = 2.6e-5 * omega**2 + 7.49
    facts = []
    for name, values in (("rate", rate), ("ratio", rate / omega)):
        facts += [Fact(f"{name}, {m + 1}", float(values[m] / values[0])) for m in (1, 2)]
    return Found(tuple(facts))


@claim(
    "mode-3-stable-between",
    "5.4.1",
    "There is a range of damping ratio, 2 to 4.5, for which mode 3 seems to be stable. Outside "
    "this range, the system fails to converge or is unstable, or converges towards mode 2 for low "
    "values of the negative viscous damping.",
    """Exact sticking orbits of mode 3: the ratio up to which they are stable, and the lowest ratio
    at which they are. The print's starts lack the signs of mode 3 (+, +, −), which makes its lower
    end.""",
    rule=lambda n: verdict(
        1.5 < n["stable from"] < 2.5 and 4.4 < n["stable up to"] < 5.0,
        False,
    ),
    see="fig-5.17 fig-5.18 fig-5.19 fig-5.20",
)
def mode_3_stable(resolution: Resolution) -> Found:
    """Range of stable sticking orbits of mode 3."""
    found = branch(2)
    sticking = (found.branch == "sticking") & (found.values < found.changes[0].value)
    stable = found.values[sticking & (np.asarray(found.stability) == "stable")]
    return Found(
        (
            Fact("stable from", float(stable.min()), "", 2.0),
            Fact("stable up to", found.changes[0].value, "", 4.5),
        )
    )


@claim(
    "one-unstable-mode",
    "5.4.1",
    "Whenever one of the modes is unstable, the response of the system becomes unbounded, even if "
    "the initial conditions were exclusively in another mode.",
    """Twelve starts in the stuck modes 2 and 3 alone, 1e-7 to 1e-4 m at x₁, at r = 5.25, where mode
    1 has no limit cycle and the others do: those that grow without bound.""",
    rule=lambda n: verdict(n["unbounded"] == n["starts"], n["unbounded"] > 0.5 * n["starts"]),
)
def one_unstable_mode(resolution: Resolution) -> Found:
    """Return the starts in other modes where mode 1 has no limit cycle."""
    from scipy.linalg import eigh

    driven = ss.destabilised(BEAM, NEGATIVE, 5.25)
    stiffness = BEAM.structure.stiffness.copy()
    stiffness[0, 0] += ss.reference.DAMPER_STIFFNESS
    _, shapes = eigh(stiffness, BEAM.structure.mass)
    every = [
        {
            dof: float(size * part / shapes[0, mode])
            for dof, part in zip(BEAM.structure.dofs, shapes[:, mode], strict=True)
        }
        for mode in (1, 2)
        for size in np.geomspace(1e-7, 1e-4, 6)
    ]
    ends = ss.basin_map(driven, starts=[held(driven, one, "pulled") for one in every])
    return Found(
        (
            Fact("unbounded", sum(motion == "unbounded" for motion in ends.motion)),
            Fact("starts", len(every)),
        )
    )


@claim(
    "mode-1-ends-at-4-9",
    "5.4.1",
    "for values of the negative viscous ratio damping greater than 4.9, mode 1 is unstable, since "
    "no harmonic motion could be found by the hybrid frequency/time method",
    """Folds of the branch of mode 1, by harmonics kept and of exact orbits: the last one and the
    one nearest to 4.9. Harmonic motions are found beyond 4.9 with any number of harmonics, with the
    three of the print to 5.29, and exact ones to 5.17. Where the print's 4.9 comes from is not
    known: there is an exact fold at 4.88, and 15 harmonics have one at 4.91; that it is this fold
    is not proven.""",
    rule=lambda n: verdict(
        max(n["last fold, H = 3"], n["r_max, exact"]) < 1.02 * END,
        min(n["last fold, H = 3"], n["r_max, exact"]) < 1.02 * END,
    ),
    see="fig-5.13 fig-5.17",
)
def ends_at(resolution: Resolution) -> Found:
    """Folds of mode 1 over the harmonics kept."""
    near, lasts = [], []
    for kept in KEPT:
        found = ss.limit_cycles(BEAM, NEGATIVE, harmonics=kept, stability=False)
        near.append(_nearest(found))
        lasts.append(max(fold.value for fold in found.folds))
    exact, last = _nearest(branch(0)), turn(branch(0)).ratio
    facts = [Fact(f"fold, H = {k}", v, "", END) for k, v in zip(KEPT, near, strict=True)]
    facts += [
        Fact("fold, exact", exact, "", END),
        Fact("last fold, H = 3", lasts[0], "", END),
        Fact("r_max, exact", last, "", END),
    ]
    ends = [float(KEPT[0]), float(KEPT[-1])]
    series = (
        Series("fold nearest to 4.9", KEPT, near, "marks"),
        Series("last fold", KEPT, lasts, "marks"),
        Series("fold nearest to 4.9, exact", ends, [exact] * 2),
        Series("r_max, exact", ends, [last] * 2),
        Series("printed end", ends, [END] * 2),
    )
    plot = Plot(
        Axis("highest harmonic H"),
        Axis("negative viscous damping ratio r"),
        (Panel(series, "folds of mode 1"),),
    )
    return Found(tuple(facts), plot)


def _nearest(found: ss.LimitCycles) -> float:
    return min((fold.value for fold in found.folds), key=lambda value: abs(value - END))


@claim(
    "highest-mode",
    "5.4.1",
    "It is also found that the higher mode seems to be the preponderant one in the free response "
    "of the system.",
    """Share of the starts of Table 5.2 that end in or about mode 3, at eleven ratios from 0.1 to 4,
    both friction forces; and among ratios of 2.5 and more.""",
    rule=lambda n: verdict(
        n["all ratios"] > 50.0 and n["ratios up to 1"] > 50.0, n["ratios of 2.5 and more"] > 50.0
    ),
    see="table-5.2",
)
def highest_mode(resolution: Resolution) -> Found:
    """Share of the starts that end in mode 3."""
    share = {
        ratio: float(np.mean([cases(ratio, forces).mode == 2 for forces in ("zero", "pulled")]))
        for ratio in EVERY
    }
    groups = {
        "all ratios": EVERY,
        "ratios up to 1": [ratio for ratio in EVERY if ratio <= 1.0],
        "ratios of 2.5 and more": [ratio for ratio in EVERY if ratio >= 2.5],
    }
    return Found(
        tuple(
            Fact(name, 100.0 * float(np.mean([share[ratio] for ratio in group])), "%")
            for name, group in groups.items()
        )
    )


@claim(
    "friction-forces-of-starts",
    "5.4.1",
    "All initial velocities are taken to be zero, and, for each DOF, the initial displacement is "
    "taken to be two percent lower or higher than the amplitudes predicted by the hybrid "
    "frequency/time method",
    """The friction force at the start is not named: starts of Table 5.2 out of 33 whose motion is
    of another class or about another mode with f(0) = clip(k_d x₁(0)) than with f(0) = 0.""",
    rule=lambda n: verdict(n["changed"] == 0, n["changed"] < 0.1 * n["starts"]),
    see="table-5.2 fig-5.17",
)
def friction_forces(resolution: Resolution) -> Found:
    """Return the starts that lead elsewhere with another friction force."""
    changed = 0
    for ratio in EVERY:
        zero, pulled = cases(ratio, "zero"), cases(ratio, "pulled")
        rows = zip(zero.motion, pulled.motion, zero.mode, pulled.mode, strict=True)
        changed += sum(a != b or m != n for a, b, m, n in rows)
    return Found((Fact("changed", changed), Fact("starts", len(EVERY) * len(STARTS))))


@claim(
    "higher-modes-less-stable",
    "5.4.1",
    "Therefore, the higher modes are relatively less stable than the lower ones.",
    """Exact r_max of modes 2 and 3 over that of mode 1, and the ratio up to which their sticking
    orbits are stable over it. The friction damper holds the higher modes to larger ratios: mode 1
    is the first without a limit cycle.""",
    rule=lambda n: verdict(max(n["r_max, 2"], n["r_max, 3"]) < 1.0, n["r_max, 3"] < 1.0),
    see="fig-5.13",
)
def less_stable(resolution: Resolution) -> Found:
    """r_max of the higher modes over that of the first."""
    lasts = [turn(branch(mode)).ratio for mode in range(3)]
    return Found(tuple(Fact(f"r_max, {m + 1}", lasts[m] / lasts[0]) for m in (1, 2)))


@claim(
    "most-times-mode-3",
    "5.4.1",
    "after having started around the converged point on mode 3, the system tends most times "
    "towards mode 3",
    """Of the eight starts each around the sticking orbit of mode 3 at r = 2, 3 and 4, f(0) = 0,
    those that settle in mode 3: with the print's signs and with those of the mode.""",
    rule=lambda n: verdict(min(n.values()) > 50.0, max(n.values()) > 50.0),
    see="fig-5.17",
)
def most_times(resolution: Resolution) -> Found:
    """Share of the starts that settle in mode 3."""
    facts = []
    for kind in ("unsigned", "signed"):
        ends = [one for part in beside((2.0, 3.0, 4.0), kind, "zero") for one in _fates(part)]
        share = float(np.mean([one == ("settled", 2) for one in ends]))
        facts.append(Fact(f"{kind} starts", 100.0 * share, "%"))
    return Found(tuple(facts))


def _fates(ends: ss.BasinMap) -> list[tuple[str, int]]:
    return [(str(a), int(b)) for a, b in zip(ends.motion, ends.mode, strict=True)]


@claim(
    "fails-at-low-damping",
    "5.4.1",
    "for low values of negative viscous damping, the time integration procedure fails to converge "
    "or is unstable: see the first two values of the ratio in Fig. 5.17",
    """Of the eight starts each at r = 0.25 and 0.5, those that do not settle: with the print's
    signs and with those of mode 3.""",
    rule=lambda n: verdict(min(n.values()) > 50.0, n["unsigned starts"] > 50.0),
    see="fig-5.17",
)
def fails_at_low(resolution: Resolution) -> Found:
    """Share of the starts that do not settle."""
    facts = []
    for kind in ("unsigned", "signed"):
        ends = [one for part in beside((0.25, 0.5), kind, "zero") for one in _fates(part)]
        share = float(np.mean([motion != "settled" for motion, _ in ends]))
        facts.append(Fact(f"{kind} starts", 100.0 * share, "%"))
    return Found(tuple(facts))


@claim(
    "no-stable-motion",
    "5.4.1",
    "For values of the viscous damping ratio greater than 4.9, the time integration procedure "
    "shows that there is no stable motion, even when the initial conditions are given around mode "
    "3, which should be stable at these viscous damping ratios.",
    """Of the eight starts each around the sticking orbit of mode 3 at r = 4.95, 5.1 and 5.5, with
    both signs and f(0) = 0, those that grow without bound, and the ratio up to which that orbit is
    stable: it is not at these ratios.""",
    rule=lambda n: verdict(
        n["unbounded"] == n["starts"] and n["mode 3 stable up to r"] > END,
        n["unbounded"] == n["starts"],
    ),
    see="fig-5.17",
)
def no_stable_motion(resolution: Resolution) -> Found:
    """Return the starts around mode 3 that grow without bound."""
    ends = [
        motion
        for kind in ("unsigned", "signed")
        for part in beside((4.95, 5.1, 5.5), kind, "zero")
        for motion, _ in _fates(part)
    ]
    return Found(
        (
            Fact("unbounded", sum(motion == "unbounded" for motion in ends)),
            Fact("starts", len(ends)),
            Fact("mode 3 stable up to r", branch(2).changes[0].value),
        )
    )


@claim(
    "nodes-at-the-damper",
    "5.4.1",
    "those modes which possess nodes at the location of the dry friction damper are completely "
    "uncoupled from the system. With no positive damping contribution from the friction damper, "
    "these modes are always unstable.",
    """Three equal masses in a row, fixed at both ends, with the damper in the middle, where the
    second mode has its node: change of its frequency between stuck and slipping, and its rate of
    growth with r = 0.1.""",
    rule=lambda n: verdict(n["change of the frequency"] < 1e-9 and n["growth"] > 0.0),
)
def nodes(resolution: Resolution) -> Found:
    """Frequency and growth of a mode with its node at the damper."""
    stiffness = 1e6 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]])
    mass, damping = np.eye(3), -0.1 * (2.6e-5 * stiffness + 7.49 * np.eye(3))
    structure = ss.Structure(mass, stiffness, damping, ["a", "b", "c"])
    model = ss.Model(structure, [ss.Jenkins("b", stiffness=1e6, slip_force=1.0)])
    free, held = (ss.natural_frequencies(model, slipping=one) for one in ([0], []))
    apart = np.abs(held[:, None] / free[None, :] - 1.0).min()
    shape = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)
    return Found(
        (
            Fact("change of the frequency", float(apart)),
            Fact("growth", float(-0.5 * shape @ damping @ shape), "1/s"),
        )
    )

"""Claims of chapter V on the SNECMA beam with negative damping."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_5_modes import STARTS
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.cycles import MODES, at, held, stable_share, turn
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

BEAM, NEGATIVE = ss.reference.flutter_beam()
LIMIT = ss.reference.DAMPER_SLIP_FORCE
END = 4.9
"""Where mode 1 ends in print."""

KEPT = (3, 5, 9, 15, 63)
"""Highest harmonics at which the fold of mode 1 is sought."""

SMALL, EVERY = (0.1, 0.15, 0.2), (0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0)


@cache
def branch(mode: int) -> ss.LimitCycles:
    """Return the exact branch of a mode, all three damped negatively."""
    return ss.limit_cycles(BEAM, NEGATIVE, mode=mode, method="exact")


@cache
def single() -> ss.LimitCycles:
    """Return the exact branch with mode 3 alone damped negatively."""
    return ss.limit_cycles(*ss.reference.flutter_beam(mode=2), mode=2, method="exact")


@cache
def cases(ratio: float, forces: str) -> ss.BasinMap:
    """Return what becomes of the starts of Table 5.2 with a reading of the friction force."""
    driven = ss.destabilised(BEAM, NEGATIVE, ratio)
    return ss.basin_map(driven, starts=[held(driven, start, forces) for start in STARTS])


@claim(
    "cannot-be-reduced",
    "5.3.1",
    "all equations, the ones corresponding to the nonlinear DOF's as well as the ones "
    "corresponding to the linear DOF's, must be solved simultaneously. Thus, the system size "
    "cannot be reduced.",
    """Limit cycle of mode 1 at r = 1, 15 harmonics: largest difference of its tip and x₃ to what
    follows from the damper's place alone at the frequency found, over the amplitude. With ω as one
    more unknown the system can be condensed.""",
    rule=lambda n: verdict(n["largest difference"] > 1e-6),
)
def cannot_be_reduced(resolution: Resolution) -> Found:
    """Linear degrees of freedom from those at the damper."""
    cycles = ss.limit_cycles(BEAM, NEGATIVE, ratio=[1.0], harmonics=15, stability=False)
    place = at(cycles, 1.0, "sticking")
    structure = ss.destabilised(BEAM, NEGATIVE, 1.0).structure
    found = np.array([cycles.coefficients(dof)[place] for dof in structure.dofs])
    worst = 0.0
    for order in range(1, 16, 2):
        turned = order * float(cycles.omega[place])
        dynamic = structure.stiffness - turned**2 * structure.mass + 1j * turned * structure.damping
        others = -np.linalg.solve(dynamic[1:, 1:], dynamic[1:, 0] * found[0, order])
        sizes = np.abs(found[1:]).max(axis=1)
        worst = max(worst, float((np.abs(others - found[1:, order]) / sizes).max()))
    return Found((Fact("largest difference", worst),))


@claim(
    "all-its-modes",
    "5.3.2",
    "the system has the possibility to respond in all its modes of vibration. Numerical time "
    "integration reveals that it is indeed the case.",
    """Modes in which one of the starts of Table 5.2 settles at r = 0.15, with f(0) = 0 and with
    f(0) = clip(k_d x₁(0)).""",
    rule=lambda n: verdict(min(n.values()) == 3, max(n.values()) == 3),
    see="table-5.2 fig-5.10 fig-5.11 fig-5.12",
)
def all_its_modes(resolution: Resolution) -> Found:
    """Return the number of modes that the starts settle in."""
    facts = []
    for forces in ("zero", "pulled"):
        ends = cases(0.15, forces)
        settled = {int(m) for m, w in zip(ends.mode, ends.motion, strict=True) if w == "settled"}
        facts.append(Fact(f"f(0) {forces}", len(settled)))
    return Found(tuple(facts))


@claim(
    "starts-of-table-5-2",
    "5.3.2",
    "For these conditions, the steady state reached by the system corresponds to the first mode of "
    "vibration of the beam",
    """Ratios out of eleven from 0.1 to 4 at which case n of Table 5.2 settles in mode n, for all
    three cases, and those at which it is at least about mode n; f(0) = 0.""",
    rule=lambda n: verdict(
        n["all settle in their modes"] == len(EVERY), n["all settle in their modes"] > 0
    ),
    see="table-5.2 fig-5.10 fig-5.11 fig-5.12",
)
def starts(resolution: Resolution) -> Found:
    """Ratios at which the starts lead to their modes."""
    settled = about = 0
    for ratio in EVERY:
        ends = cases(ratio, "zero")
        own = ends.mode.tolist() == [0, 1, 2]
        about += own
        settled += own and all(motion == "settled" for motion in ends.motion)
    return Found(
        (Fact("all settle in their modes", settled), Fact("all are about their modes", about))
    )


@claim(
    "limit-of-every-mode",
    "5.3.2",
    "For each mode, there is a different maximum negative viscous damping ratio beyond which no "
    "periodic solution can be found",
    """Exact r_max of the three modes.""",
    rule=lambda n: verdict(
        len({round(value, 2) for value in n.values()}) == 3 and all(v < 100 for v in n.values())
    ),
    see="fig-5.13 fig-5.14 fig-5.15",
)
def limit_of_every_mode(resolution: Resolution) -> Found:
    """r_max of every mode."""
    return Found(tuple(Fact(name, turn(branch(m)).ratio) for m, name in enumerate(MODES)))


@claim(
    "two-branches-per-mode",
    "5.3.2",
    "for each mode, there is a higher branch, which corresponds to a mostly slipping motion, and a "
    "lower branch, which corresponds to a mostly sticking motion",
    """Exact cycles at r = 1 per mode, the fewest; the smallest slip fraction of the higher and the
    largest of the lower branch there.""",
    rule=lambda n: verdict(
        n["cycles per mode"] == 2 and n["higher branch"] > 0.5 > n["lower branch"]
    ),
    see="fig-5.13 fig-5.16",
)
def two_branches(resolution: Resolution) -> Found:
    """Branches of every mode at r = 1."""
    counts, high, low = [], [], []
    for mode in range(3):
        found = ss.limit_cycles(BEAM, NEGATIVE, mode=mode, ratio=[1.0], method="exact")
        counts.append(len(found.values))
        shares = np.asarray(found.slip_fraction(0)).reshape(len(found.values))
        high.append(float(shares[at(found, 1.0, "slipping")]))
        low.append(float(shares[at(found, 1.0, "sticking")]))
    return Found(
        (
            Fact("cycles per mode", min(counts)),
            Fact("higher branch", min(high)),
            Fact("lower branch", max(low)),
        )
    )


@claim(
    "frequencies-of-table-5-3",
    "5.3.2",
    "These computed frequencies match well with the frequencies of the motion of the beam as the "
    "negative viscous damping ratio tends towards zero",
    """Limit cycles at r = 0.01 to the natural frequencies of the beam, and to the printed ones, the
    largest difference. The printed first row is that of the single DOF.""",
    rule=lambda n: verdict(n["to the printed ones"] < 0.05, n["to the natural ones"] < 0.05),
    see="table-5.3 fig-5.16",
)
def frequencies(resolution: Resolution) -> Found:
    """Frequencies of the limit cycles at a small ratio."""
    table = numbers_of("table-5.3", resolution).table
    assert table is not None
    ours, printed, found = (
        np.array(table.column(name), dtype=np.float64)
        for name in ("ours [rad/s]", "printed [rad/s]", "limit cycle at r = 0.01 [rad/s]")
    )
    return Found(
        tuple(
            Fact(name, 100.0 * float(np.abs(found / values - 1.0).max()), "%")
            for name, values in (("to the natural ones", ours), ("to the printed ones", printed))
        )
    )


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
    """Folds of the branch of mode 1 nearest to 4.9, by harmonics kept and of exact orbits, which
    turn for good later. The print kept 3 harmonics, which fold elsewhere: that its 4.9 is the exact
    fold is not proven.""",
    rule=lambda n: (
        "false"
        if abs(n["fold, exact"] / END - 1.0) > 0.02
        else "holds"
        if abs(n["fold, H = 3"] / END - 1.0) < 0.02
        else "open"
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
    facts += [Fact("fold, exact", exact, "", END), Fact("r_max, exact", last)]
    ends = [float(KEPT[0]), float(KEPT[-1])]
    series = (
        Series("fold nearest to 4.9", KEPT, near, "marks"),
        Series("last fold", KEPT, lasts, "marks"),
        Series("fold nearest to 4.9, exact", ends, [exact] * 2),
        Series("r_max, exact", ends, [last] * 2),
        Series("printed end", ends, [END] * 2),
    )
    plot = Plot(
        Axis("highest harmonic H", log=True),
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
    "almost-mode-1",
    "5.4.1",
    "The agreement between time integration and hybrid frequency/time method is almost perfect for "
    "the second DOF, and is good for the first and third DOF.",
    """Difference of the aperiodic motion at r = 0.361 to the limit cycle of mode 1 over three
    periods, mean squares. Almost perfect is 2 %, good 20 %.""",
    rule=lambda n: verdict(
        n["x₂"] < 2.0 and max(n["x₁"], n["x₃"]) < 20.0, n["x₂"] < 5.0 and n["x₁"] < 20.0
    ),
    see="fig-5.21 fig-5.22 fig-5.23",
)
def almost_mode_1(resolution: Resolution) -> Found:
    """Differences of the aperiodic motion to mode 1."""
    names = {"x₁": "fig-5.21", "x₂": "fig-5.22", "x₃": "fig-5.23"}
    what = "difference over the limit cycle, mean squares"
    return Found(
        tuple(
            Fact(letter, numbers_of(name, resolution).fact(what), "%")
            for letter, name in names.items()
        )
    )


@claim(
    "around-35-hz",
    "5.4.1",
    "the harmonic content of the signal is almost exclusively localized around 35 Hz",
    """Share of the power of x₃ from 30 to 41 Hz, at r = 0.361. Almost exclusively is 95 %.""",
    rule=lambda n: verdict(n["share of the power"] > 95.0, n["share of the power"] > 80.0),
    see="fig-5.24",
)
def around_35_hz(resolution: Resolution) -> Found:
    """Share of the power around 35 Hz."""
    (line,) = numbers_of("fig-5.24", resolution).plot.panels[0].series[:1]
    near = (line.x > 30.0) & (line.x < 41.0)
    return Found(
        (Fact("share of the power", 100.0 * float(line.y[near].sum() / line.y.sum()), "%"),)
    )


@claim(
    "three-small-lines",
    "5.4.1",
    "There is a small amplitude component around 225 Hz, which corresponds to the sticking "
    "frequency of the second mode [...] two other small components around 180 Hz and 250 Hz, which "
    "correspond, respectively, to the fifth harmonic and the seventh harmonic",
    """Lines nearest to these frequencies; they are to be within 2 %.""",
    rule=lambda n: verdict(
        abs(n["mode 2"] / 225.0 - 1.0) < 0.02
        and abs(n["5th harmonic"] / 180.0 - 1.0) < 0.02
        and abs(n["7th harmonic"] / 250.0 - 1.0) < 0.02
    ),
    see="fig-5.24",
)
def three_lines(resolution: Resolution) -> Found:
    """Lines of the aperiodic motion."""
    shown = numbers_of("fig-5.24", resolution)
    return Found(
        tuple(
            Fact(name, shown.fact(f"line of {name}"), "Hz", printed)
            for name, printed in (
                ("5th harmonic", 180.0),
                ("mode 2", 225.0),
                ("7th harmonic", 250.0),
            )
        )
    )


@claim(
    "no-such-components",
    "5.4.1",
    "the power spectral density analysis of the solution predicted by the hybrid frequency/time "
    "method revealed no such components",
    """5th and 7th harmonics of x₃ in the limit cycle of mode 1 at r = 0.361, 15 harmonics, over the
    fundamental.""",
    rule=lambda n: verdict(max(n.values()) < 0.1),
    see="fig-5.24",
)
def no_such(resolution: Resolution) -> Found:
    """Higher harmonics of the limit cycle of mode 1."""
    shown = numbers_of("fig-5.24", resolution)
    return Found(
        tuple(
            Fact(f"{n}th harmonic", shown.fact(f"{n}th harmonic of x₃ in the limit cycle"), "%")
            for n in (5, 7)
        )
    )


@claim(
    "orthogonal-modes",
    "5.4.2",
    "Since the mass and stiffness matrices are symmetric, the transition matrix is orthogonal.",
    """Largest entry of TᵀT − 1, eigenvectors of unit length; they are orthogonal with respect to M
    only.""",
    rule=lambda n: verdict(n["largest entry"] < 1e-6),
    see="fig-5.25",
)
def orthogonal(resolution: Resolution) -> Found:
    """Products of the eigenvectors."""
    shapes, _ = _modes()
    return Found((Fact("largest entry", float(np.abs(shapes.T @ shapes - np.eye(3)).max())),))


@claim(
    "modal-coefficients",
    "5.4.2",
    "They are computed from the nominal SNECMA values given in Eq. (2.32): c₁ = 5.789, c₂ = "
    "27.627, c₃ = 12.095",
    """Modal damping of the three modes, eigenvectors of unit length: the numbers are right, their
    order is reversed.""",
    rule=lambda n: verdict(
        np.allclose(list(n.values()), [5.789, 27.627, 12.095], rtol=1e-3),
        np.allclose(sorted(n.values()), [5.789, 12.095, 27.627], rtol=1e-3),
    ),
    see="fig-5.25",
)
def coefficients(resolution: Resolution) -> Found:
    """Modal damping coefficients."""
    shapes, damping = _modes()
    found = np.diag(shapes.T @ damping @ shapes)
    return Found(
        tuple(
            Fact(f"c_{n}", float(value), "kg/s", printed)
            for n, value, printed in zip((1, 2, 3), found, (5.789, 27.627, 12.095), strict=True)
        )
    )


def _modes() -> tuple[np.ndarray, np.ndarray]:
    """Return eigenvectors of unit length of the beam without damper, and its damping."""
    from scipy.linalg import eigh

    structure = ss.reference.snecma_structure()
    _, shapes = eigh(structure.stiffness, structure.mass)
    return shapes / np.linalg.norm(shapes, axis=0), structure.damping


@claim(
    "only-the-third-mode",
    "5.4.2",
    "the system only vibrates in the third mode of vibration, the one which is negatively damped",
    """Starts in or about modes 1, 2 and 3, the displacements of Table 5.2 with both friction forces
    at r = 1 and 2: those that neither decay nor settle in mode 3.""",
    rule=lambda n: verdict(n["elsewhere"] == 0, n["elsewhere"] < 0.5 * n["starts"]),
    see="fig-5.25 fig-5.28",
)
def only_third(resolution: Resolution) -> Found:
    """Fates of starts with mode 3 alone damped negatively."""
    beam, negative = ss.reference.flutter_beam(mode=2)
    elsewhere = count = 0
    for ratio in (1.0, 2.0):
        driven = ss.destabilised(beam, negative, ratio)
        states = [held(driven, one, forces) for one in STARTS for forces in ("zero", "pulled")]
        ends = ss.basin_map(driven, starts=states)
        for motion, mode in zip(ends.motion, ends.mode, strict=True):
            elsewhere += not (motion == "decaying" or (motion == "settled" and mode == 2))
            count += 1
    return Found((Fact("elsewhere", elsewhere), Fact("starts", count)))


@claim(
    "upper-branch-decides",
    "5.4.2",
    "the upper branch determines the stability limit: any motion with an initial displacement "
    "larger than the value at the upper branch will be unstable, and any motion initiated below "
    "the upper branch will be stable and converge towards to mostly sticking motion. This "
    "stability analysis was checked by numerical time integration.",
    """Starts at 0.98 and 1.02 of the amplitudes of the exact slipping orbit, no velocity, at r = 1,
    2 and 3, with the signs of mode 3 and unsigned: those that do as it says, with f(0) = F_d and
    with f(0) = 0. What a start leads to depends on its whole state.""",
    rule=lambda n: verdict(
        min(n.values()) == 100.0, min(n["0.98, f(0) = F_d"], n["1.02, f(0) = F_d"]) == 100.0
    ),
)
def upper_branch(resolution: Resolution) -> Found:
    """Return the starts beside the slipping branch of mode 3."""
    beam, negative = ss.reference.flutter_beam(mode=2)
    ratios = (1.0, 2.0, 3.0)
    cycles = ss.limit_cycles(beam, negative, mode=2, ratio=ratios, method="exact")
    facts, series = [], []
    for name, force in (("f(0) = F_d", LIMIT), ("f(0) = 0", 0.0)):
        right: dict[float, list[bool]] = {0.98: [], 1.02: []}
        for ratio in ratios:
            place = at(cycles, ratio, "slipping")
            driven = cycles.model_at(place)
            sizes = [float(cycles.amplitude(dof)[place]) for dof in beam.structure.dofs]
            for factor in (0.98, 1.02):
                states = [
                    ss.State(
                        driven,
                        [factor * size * sign for size, sign in zip(sizes, signs, strict=True)],
                        contact_force=[force],
                    )
                    for signs in ((1, 1, -1), (1, 1, 1))
                ]
                ends = ss.basin_map(driven, starts=states)
                wanted = "settled" if factor < 1.0 else "unbounded"
                right[factor] += [motion == wanted for motion in ends.motion]
        for factor, found in right.items():
            share = 100.0 * float(np.mean(found))
            facts.append(Fact(f"{factor:g}, {name}", share, "% as said"))
        series.append(
            Series(
                name, [0.98, 1.02], [100.0 * float(np.mean(one)) for one in right.values()], "marks"
            )
        )
    plot = Plot(
        Axis("start over the slipping orbit"),
        Axis("starts that do as the text says", "%"),
        (Panel(tuple(series)),),
    )
    return Found(tuple(facts), plot)


@claim(
    "unique",
    "5.4.2",
    "In the case of a single negatively damped mode, the harmonic solution is unique",
    """Exact limit cycles at r = 1 and 2 with mode 3 alone damped negatively, the fewest.""",
    rule=lambda n: verdict(n["cycles per ratio"] == 1),
    see="fig-5.25",
)
def unique(resolution: Resolution) -> Found:
    """Limit cycles per ratio."""
    found = ss.limit_cycles(
        *ss.reference.flutter_beam(mode=2), mode=2, ratio=[1.0, 2.0], method="exact"
    )
    counts = [int(np.isclose(found.values, ratio).sum()) for ratio in (1.0, 2.0)]
    return Found((Fact("cycles per ratio", min(counts)),))


@claim(
    "stability-as-one-mass",
    "5.4.2",
    "its stability is the same as the one predicted in the single-DOF case",
    """Share of stable exact orbits on both sides with mode 3 alone damped negatively, and of r_max
    up to which the sticking side is stable. One mass: 100 %, 0 % and 100 %.""",
    rule=lambda n: verdict(
        n["sticking, stable"] == 100.0 and n["slipping, stable"] == 0.0,
        n["slipping, stable"] == 0.0 and n["stable up to r_max"] > 80.0,
    ),
    see="fig-5.25 fig-5.26 fig-5.27",
)
def as_one_mass(resolution: Resolution) -> Found:
    """Stability of the cycles of mode 3."""
    found = single()
    changes = [one.value for one in found.changes]
    last = turn(found).ratio
    return Found(
        (
            Fact("sticking, stable", stable_share(found, "sticking"), "%"),
            Fact("slipping, stable", stable_share(found, "slipping"), "%"),
            Fact("stable up to r_max", 100.0 * min([*changes, last]) / last, "%"),
        )
    )


@claim(
    "several-modes",
    "5.5",
    "the solutions found by time integration often combine several modes and the hybrid "
    "frequency/time method is not able to find those",
    """Share of the starts of Table 5.2 whose motion stays aperiodic, eleven ratios from 0.1 to 4,
    both friction forces; often is a fifth.""",
    rule=lambda n: verdict(n["aperiodic"] > 20.0, n["aperiodic"] > 0.0),
    see="table-5.2 fig-5.24",
)
def several_modes(resolution: Resolution) -> Found:
    """Share of aperiodic motions."""
    motions = [
        motion
        for ratio in EVERY
        for forces in ("zero", "pulled")
        for motion in cases(ratio, forces).motion
    ]
    share = sum(motion == "aperiodic" for motion in motions) / len(motions)
    return Found((Fact("aperiodic", 100.0 * share, "%"),))


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

"""Claims of chapter V on the several motions of the beam."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_cycles import BEAM, EVERY, NEGATIVE, at_one, branch, cases
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.cycles import MODES, at, turn
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution


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
        found = at_one(mode)
        counts.append(len(found.values))
        shares = found.slip_fraction((0, 0))
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
    "frequencies-in-order",
    "5.3.2",
    "The frequencies for the first mode are the lowest ones: the lower part of the curve "
    "corresponds to the mostly slipping motion, and the upper part corresponds to the mostly "
    "sticking motion.",
    """Exact cycles at r = 1: smallest ratio of the sticking to the slipping frequency of a mode,
    and of the slipping frequency of a mode to the sticking one of the mode below.""",
    rule=lambda n: verdict(min(n.values()) > 1.0),
    see="fig-5.16",
)
def in_order(resolution: Resolution) -> Found:
    """Ratios of the frequencies at r = 1."""
    pairs = []
    for mode in range(3):
        found = at_one(mode)
        pairs.append([found.omega[at(found, 1.0, side)] for side in ("slipping", "sticking")])
    own = min(high / low for low, high in pairs)
    next_one = min(above[0] / below[1] for below, above in pairwise(pairs))
    return Found(
        (
            Fact("sticking over slipping", float(own)),
            Fact("over the mode below", float(next_one)),
        )
    )


@claim(
    "almost-linear",
    "5.3.2",
    "As the negative viscous damping tends toward zero, the motion of the system becomes almost "
    "linear: it tends either towards the linear, totally stuck case [...] or towards the piecewise "
    "linear, totally slipping case",
    """Exact cycles at r = 0.01 of the three modes: largest slip fraction of the sticking and
    smallest of the slipping ones, and the largest difference of x₁ from its fundamental.""",
    rule=lambda n: verdict(
        n["sticking"] < 0.1 and n["slipping"] > 0.9 and n["difference from a harmonic"] < 5.0
    ),
    see="fig-5.13 fig-5.16",
)
def almost_linear(resolution: Resolution) -> Found:
    """Slip and distortion at a small ratio."""
    shares: dict[str, list[float]] = {"sticking": [], "slipping": []}
    worst = 0.0
    for mode in range(3):
        found = ss.limit_cycles(BEAM, NEGATIVE, mode=mode, ratio=[0.01], method="exact")
        slips = found.slip_fraction((0, 0))
        for side, own in shares.items():
            place = at(found, 0.01, side)
            own.append(float(slips[place]))
            sizes = np.abs(np.fft.rfft(found.waveform("damper", place)))
            worst = max(worst, float(np.linalg.norm(sizes[2:]) / sizes[1]))
    return Found(
        (
            Fact("sticking", max(shares["sticking"])),
            Fact("slipping", min(shares["slipping"])),
            Fact("difference from a harmonic", 100.0 * worst, "%"),
        )
    )


@claim(
    "not-unique",
    "5.5",
    "If several modes of vibrations are negatively damped, the solution predicted by the method is "
    "non-unique.",
    """Exact limit cycles of the beam at r = 1 with all modes damped negatively, and with mode 3
    alone, counted.""",
    rule=lambda n: verdict(n["all modes"] > n["mode 3 alone"], n["all modes"] > 1),
    see="fig-5.13",
)
def not_unique(resolution: Resolution) -> Found:
    """Return the number of limit cycles at r = 1."""
    every = sum(len(at_one(mode).values) for mode in range(3))
    alone = ss.limit_cycles(*ss.reference.flutter_beam(mode=2), mode=2, ratio=[1.0], method="exact")
    return Found((Fact("all modes", every), Fact("mode 3 alone", len(alone.values))))

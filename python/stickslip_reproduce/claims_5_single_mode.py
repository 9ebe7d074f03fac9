"""Claims of chapter V on the beam with one mode damped negatively."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_cycles import BEAM, LIMIT, RATIOS, alone, single
from stickslip_reproduce.chapter_5_modes import STARTS
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.cycles import at, held, stable_share, turn
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution


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
    cycles = alone()
    facts, series = [], []
    for name, force in (("f(0) = F_d", LIMIT), ("f(0) = 0", 0.0)):
        right: dict[float, list[bool]] = {0.98: [], 1.02: []}
        for ratio in RATIOS:
            place = at(cycles, ratio, "slipping")
            driven = cycles.model_at(place)
            sizes = [float(cycles.amplitude(dof)[place]) for dof in BEAM.structure.dofs]
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
            Series(name, [0, 1], [100.0 * float(np.mean(one)) for one in right.values()], "marks")
        )
    plot = Plot(
        Axis("start over the slipping orbit", names=("0.98", "1.02")),
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
    found = alone()
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
    "like-one-mass",
    "5.4.2",
    "for each DOF, there is an upper and a lower branch, corresponding respectively to the mostly "
    "slipping and mostly sticking motion of the beam",
    """Exact cycles with mode 3 alone damped negatively at r = 1, 2 and 3: smallest ratio of the
    upper to the lower amplitude over the three degrees of freedom, and the slip fractions.""",
    rule=lambda n: verdict(
        n["upper over lower"] > 1.0 and n["upper slips"] > 0.5 > n["lower slips"]
    ),
    see="fig-5.25 fig-5.26 fig-5.27",
)
def like_one_mass(resolution: Resolution) -> Found:
    """Branches of mode 3 alone."""
    found = alone()
    slips = found.slip_fraction((0, 0))
    upper, lower = (
        [at(found, ratio, side) for ratio in RATIOS] for side in ("slipping", "sticking")
    )
    sizes = [found.amplitude(dof) for dof in BEAM.structure.dofs]
    return Found(
        (
            Fact(
                "upper over lower", float(min((size[upper] / size[lower]).min() for size in sizes))
            ),
            Fact("upper slips", float(slips[upper].min())),
            Fact("lower slips", float(slips[lower].max())),
        )
    )


@claim(
    "both-branches-found",
    "5.4.2",
    "the hybrid frequency/time method is able to determine the upper and lower branches of the "
    "free response",
    """Largest difference of 9 harmonics to exact cycles at r = 1, 2 and 3, over three degrees of
    freedom and both branches, and of r_max; able is 1 %.""",
    rule=lambda n: verdict(max(n.values()) < 1.0, max(n.values()) < 5.0),
    see="fig-5.25 fig-5.28",
)
def both_branches(resolution: Resolution) -> Found:
    """Differences of 9 harmonics to exact cycles."""
    beam, negative = ss.reference.flutter_beam(mode=2)
    found = ss.limit_cycles(beam, negative, mode=2, ratio=RATIOS, harmonics=9, stability=False)
    whole = ss.limit_cycles(beam, negative, mode=2, harmonics=9, stability=False)
    worst = 0.0
    for ratio in RATIOS:
        for side in ("sticking", "slipping"):
            one, true = at(found, ratio, side), at(alone(), ratio, side)
            for dof in beam.structure.dofs:
                apart = found.amplitude(dof)[one] / alone().amplitude(dof)[true] - 1.0
                worst = max(worst, abs(float(apart)))
    last = abs(turn(whole).ratio / turn(single()).ratio - 1.0)
    return Found((Fact("amplitudes", 100.0 * worst, "%"), Fact("r_max", 100.0 * float(last), "%")))

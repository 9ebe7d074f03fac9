"""Claims of chapter VI on the force of dampers that are structures."""

from __future__ import annotations

from functools import cache
from itertools import combinations
from math import inf, pi

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_6 import DOFS, HARMONICS
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.curves import PERIOD_SHARE, over_period
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot
from stickslip_reproduce.pair_orbits import CASES, LIMITS, forces_at, middle, orbit, with_limits
from stickslip_reproduce.resolution import Float, Resolution
from stickslip_reproduce.solver_experiment import begins, experiment
from stickslip_reproduce.solvers import Overshooting, solve


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
    for case in CASES:
        forces = forces_at(*case)
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
    finite = ss.exact_response(with_limits(550.0, [24.6, 100.0, 246.05, 300.0]), [550.0])
    return Found(
        tuple(
            Fact(name, max(map(len, one.contact_states(0, 0).sets)))
            for name, one in (("as printed", orbit(550.0, 550.0)), ("F₄ = 300 N", finite))
        )
    )


@cache
def procedure_2(
    samples: int, periods: int, force: float, *, zero_start: bool = True, corrected: bool = True
) -> Float:
    """Return the forces of the last period by Procedure 2 as printed, shape (samples, 4).

    The displacements are those of the exact orbit at 550 rad/s; slipping contacts are put on their
    limits by (6.21), or left by (6.13) on the force at which they were found to slip. From zero
    forces at the first instant, or from those of the exact orbit.
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
            wanted = corrected * (np.sign(now[slips]) * LIMITS[slips] - now[slips])
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
    exceeds its limit, with 64 and with 1024 samples per period, in the first period from the exact
    forces and once it repeats itself; and without (6.21). A contact is found to slip one step late:
    the excess falls with the step, and (6.21) takes it back one step later, not before.""",
    rule=lambda n: verdict(
        max(n["64 samples"], n["64 samples, first period"]) < 0.01,
        max(n["1024 samples"], n["1024 samples, first period"]) < 0.01,
    ),
)
def overshooting(resolution: Resolution) -> Found:
    """Return the forces beyond their limits by Procedure 2."""
    return Found(
        tuple(
            Fact(
                f"{samples} samples{name}",
                _excess(procedure_2(samples, periods, 550.0, zero_start=False, corrected=right)),
                "N",
            )
            for samples in (64, 1024)
            for name, periods, right in (
                ("", 5, True),
                (", first period", 1, True),
                (", without (6.21)", 5, False),
            )
        )
    )


def _excess(forces: Float) -> float:
    return float((np.abs(forces[:, :3]) - LIMITS[:3]).max())


@claim(
    "sum-of-overshooting",
    "6.3.3",
    "The sum of the friction forces at the N_C points might not add to zero, compromising the "
    "overall equilibrium of the system.",
    """Largest sum over the largest force by Procedure 2 without (6.21), 64 samples, 550 rad/s, 550
    N. Every increment is D Δz, and the columns of D add to zero: overshooting cannot change the
    sum.""",
    rule=lambda n: verdict(n["largest sum"] > 1e-9),
)
def sum_of_overshooting(resolution: Resolution) -> Found:
    """Sum of the forces that overshoot."""
    forces = procedure_2(64, 5, 550.0, corrected=False)
    return Found(
        (Fact("largest sum", float(np.abs(forces.sum(axis=1)).max() / np.abs(forces).max())),)
    )


@claim(
    "offset-by-overshooting",
    "6.3.3",
    "The upper and lower slipping positions might not be opposite from each other, resulting in an "
    "offset of the friction force.",
    """Middle of the range of the forces of contacts 1 to 3 over their limits in the fifth period by
    Procedure 2 without and with (6.21), 64 samples, 550 rad/s, 550 N: the largest.""",
    rule=lambda n: verdict(n["without (6.21)"] > 0.01),
)
def offset_by_overshooting(resolution: Resolution) -> Found:
    """Offsets of the forces that overshoot."""
    return Found(
        tuple(
            Fact(name, float(np.abs(middle(forces)[:3] / LIMITS[:3]).max()))
            for name, forces in (
                ("without (6.21)", procedure_2(64, 5, 550.0, corrected=False)),
                ("with (6.21)", procedure_2(64, 5, 550.0)),
            )
        )
    )


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
    marched, true = procedure_2(1024, 5, 35.0), forces_at(550.0, 35.0)
    means = [float(np.abs(middle(one)[1:]).max()) for one in (marched, true)]
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


@claim(
    "failure-by-overshooting",
    "6.3.3",
    "If not addressed, any of these problems hinders the convergence of the method and results in "
    "the failure of the solution algorithm.",
    """Beam at eight loads and four frequencies, Broyden's method from the single harmonic with the
    force by Procedure 2, 256 samples: runs that converge without and with (6.21), and with the
    return map.""",
    rule=lambda n: verdict(
        n["without (6.21)"] == 0, n["without (6.21)"] < min(n["with (6.21)"], n["return map"])
    ),
)
def failure(resolution: Resolution) -> Found:
    """Return the runs of Broyden's method with overshooting forces."""
    begin = experiment().vector(begins(resolution)["single harmonic"])
    cases = experiment().cases
    kinds = {
        "without (6.21)": Overshooting(cases, HARMONICS, corrected=False),
        "with (6.21)": Overshooting(cases, HARMONICS, corrected=True),
        "return map": experiment(),
    }
    return Found(
        tuple(
            Fact(name, solve(one, begin, "Broyden, QR updated", "single harmonic").converged)
            for name, one in kinds.items()
        )
    )


@claim(
    "elementary-is-structure-like",
    "6.3.2",
    "The elementary friction damper [...] can be viewed as a structure-like friction damper with "
    "two points connecting to the adjacent structure. The second end point of such a damper is "
    "always sticking",
    """Two beams with an elementary damper between them and with the structure-like one of (6.6),
    20.313 N in opposition, 150 to 260 rad/s, 15 harmonics: largest difference of the curves over
    the peak, with F₂ = ∞ and with F₂ = 1.5 F₁.""",
    rule=lambda n: verdict(max(n.values()) < 1e-6),
)
def elementary(resolution: Resolution) -> Found:
    """Return the difference of an elementary damper as a structure-like one."""
    pair = ss.reference.damped_pair(20.313)
    ends = ["1.damper", "2.damper"]
    link = ss.reference.DAMPER_STIFFNESS * np.array([[1.0, -1.0], [-1.0, 1.0]])
    limit = ss.reference.DAMPER_SLIP_FORCE
    alone = ss.Jenkins(
        ends[0], stiffness=ss.reference.DAMPER_STIFFNESS, slip_force=limit, other=ends[1]
    )
    dampers = [alone] + [
        ss.StructuralDamper(ends, stiffness=link, slip_forces=[limit, other])
        for other in (inf, 1.5 * limit)
    ]
    omega = np.linspace(150.0, 260.0, 56)
    first, *others = (
        ss.forced_response(pair.replaced(contacts=[one]), omega, HARMONICS).amplitude("1.damper")
        for one in dampers
    )
    return Found(
        tuple(
            Fact(name, float(np.abs(one - first).max() / first.max()))
            for name, one in zip(("F₂ = ∞", "F₂ = 1.5 F₁"), others, strict=True)
        )
    )


@claim(
    "printed-increment",
    "6.3.2",
    "Eqs. (6.6) and (6.9) give Δf₂ = D₂₁ Δz₁ + D₂₂ k_d Δz₂ (6.10)",
    """Δf₂ by (6.10) as printed over that by (6.9), for Δz₁ = 0 and Δz₂ = 1 m: the stray k_d makes
    it k_d times too large.""",
    rule=lambda n: verdict(abs(n["(6.10) over (6.9)"] - 1.0) < 1e-9),
)
def printed_increment(resolution: Resolution) -> Found:
    """Ratio of the increments."""
    stiffness = ss.reference.DAMPER_STIFFNESS
    matrix = stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
    increment = np.array([0.0, 1.0])
    right = float(matrix[1] @ increment)
    printed = float(matrix[1, 0] * increment[0] + matrix[1, 1] * stiffness * increment[1])
    return Found((Fact("(6.10) over (6.9)", printed / right, "times"),))


@claim(
    "singular-stiffness",
    "6.3.3",
    "if all N_C dampers are slipping, D_S = D, and the inversion is impossible to perform because "
    "the stiffness matrix D is singular",
    """Smallest over largest eigenvalue of D of (6.26), and of its submatrices of one to three
    contacts the smallest such ratio.""",
    rule=lambda n: verdict(abs(n["D"]) < 1e-9 and n["submatrices"] > 1e-9),
)
def singular(resolution: Resolution) -> Found:
    """Condition of the submatrices of D."""
    whole = ss.reference.damped_pair().contacts[0].stuck_stiffness
    ratios = []
    for count in (1, 2, 3):
        for points in combinations(range(4), count):
            values = np.linalg.eigvalsh(whole[np.ix_(points, points)])
            ratios.append(float(values[0] / values[-1]))
    values = np.linalg.eigvalsh(whole)
    return Found((Fact("D", float(values[0] / values[-1])), Fact("submatrices", min(ratios))))


@claim(
    "no-exact-start",
    "6.3.4",
    "When a structure-like damper is considered, it is not possible to find an exact initial "
    "condition for the forces transmitted by the friction damper.",
    """Exact orbits of the four cases of Figs 6.4 to 6.7: largest |f(T/2) + f(0)| over the largest
    force. Steady motion repeats itself with the opposite sign after half a period, which fixes the
    forces at the start, those of contacts that never slip too.""",
    rule=lambda n: verdict(n["distance from the opposite"] > 1e-6),
)
def no_exact_start(resolution: Resolution) -> Found:
    """Return the distance of the forces half a period later from the opposite."""
    worst = 0.0
    for case in CASES:
        forces = forces_at(*case)
        later = np.roll(forces, -len(forces) // 2, axis=0)
        worst = max(worst, float(np.abs(forces + later).max() / np.abs(forces).max()))
    return Found((Fact("distance from the opposite", worst),))

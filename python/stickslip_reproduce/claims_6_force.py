"""Claims of chapter VI on the force of dampers that are structures."""

from __future__ import annotations

from functools import cache
from math import pi

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_6 import DOFS
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.curves import PERIOD_SHARE, over_period
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot
from stickslip_reproduce.pair_orbits import (
    LIMITS,
    forces_at,
    middle,
    orbit,
    with_limits,
)
from stickslip_reproduce.resolution import Float, Resolution


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

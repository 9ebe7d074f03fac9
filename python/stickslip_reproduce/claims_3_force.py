"""Claims of chapter III on the friction force and on its harmonics."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT, NEAR, exact
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution

DOZENS = 24
FEW = 5
KEPT = (1, 3, 5, 9, 15, 24)


@cache
def errors(harmonics: int) -> Float:
    """Return errors of the tip's peak at the eight loads [%]."""
    found = []
    for load in EIGHT:
        true = exact(load)
        kept = ss.forced_response(true.model, true.omega, harmonics)
        found.append(kept.peak("tip").amplitude / true.peak("tip").amplitude - 1.0)
    return 100.0 * np.abs(found)


@claim(
    "never-unloads",
    "3.2",
    "The time-marching procedure is presented in Table 3.1.",
    """Range of the force over 2 F_d in the fourth period of u = 2 (F_d / k_d) cos, by the printed
    update and by f_j = clip(f_(j-1) + k_d Δu, −F_d, F_d); 200 and 2000 instants per period. As
    printed a contact whose force exceeds F_d by one step slips on when the motion turns, and never
    unloads.""",
    rule=lambda n: verdict(min(n["as printed, 200"], n["as printed, 2000"]) > 0.99),
)
def never_unloads(resolution: Resolution) -> Found:
    """Range of the force by Table 3.1 and by the corrected update."""
    facts = []
    for count in (200, 2000):
        moved = 2.0 * np.cos(2.0 * np.pi * np.arange(4 * count + 1) / count)
        printed, right = _as_printed(moved), _returned(moved)
        for name, force in (("as printed", printed), ("corrected", right)):
            facts.append(Fact(f"{name}, {count}", float(np.ptp(force[-count:]) / 2.0)))
    return Found(tuple(facts))


def _as_printed(moved: Float) -> Float:
    """Return the force over F_d by Table 3.1, of a displacement over F_d / k_d."""
    force = np.zeros_like(moved)
    slips = False
    change = np.diff(moved, prepend=moved[0])
    for place in range(1, len(moved)):
        force[place] = force[place - 1] + (0.0 if slips else change[place])
        if not slips:
            slips = abs(force[place]) > 1.0
        elif change[place] * change[place - 1] < 0.0:
            slips = False
            # The table's own test of the sticking state comes before its next update.
            slips = abs(force[place]) > 1.0
    return force


def _returned(moved: Float, start: float = 0.0) -> Float:
    force = np.full_like(moved, start)
    for place in range(1, len(moved)):
        force[place] = np.clip(force[place - 1] + moved[place] - moved[place - 1], -1.0, 1.0)
    return force


@claim(
    "few-harmonics",
    "3.3",
    "Practically, a few harmonics will give a good approximation of the solution",
    """Largest error of the tip's peak at the eight loads with 5 harmonics; good is 5 %.""",
    rule=lambda n: verdict(n["largest error, H = 5"] < 5.0, n["median error, H = 5"] < 5.0),
)
def few_harmonics(resolution: Resolution) -> Found:
    """Errors with five harmonics."""
    found = errors(FEW)
    return Found(
        (
            Fact("largest error, H = 5", float(found.max()), "%"),
            Fact("median error, H = 5", float(np.median(found)), "%"),
        )
    )


@claim(
    "couple-dozens",
    "3.3",
    "in all cases a couple dozens of harmonics will predict virtually the same answer as the "
    "numerical time integration",
    """Largest error of the tip's peak at the eight loads with 24 harmonics, with 15 for comparison,
    and with 24 at 20.313 N with a damper a hundred times as stiff, the nearly rigid one of Figs 4.7
    and 4.8; virtually the same is 1 %.""",
    rule=lambda n: verdict(max(n["H = 24"], n["H = 24, stiff damper"]) < 1.0, n["H = 24"] < 1.0),
)
def couple_dozens(resolution: Resolution) -> Found:
    """Errors with 24 harmonics."""
    plot = Plot(
        Axis("highest harmonic H"),
        Axis("largest error of the tip's peak", "%", log=True),
        (
            Panel(
                (
                    Series(
                        "eight loads",
                        KEPT,
                        [float(errors(kept).max()) for kept in KEPT],
                    ),
                )
            ),
        ),
    )
    stiff = ss.Jenkins(
        "damper",
        stiffness=100.0 * ss.reference.DAMPER_STIFFNESS,
        slip_force=ss.reference.DAMPER_SLIP_FORCE,
    )
    rough = ss.forced_response(
        ss.reference.snecma_beam(20.313).replaced(contacts=[stiff]), NEAR, DOZENS
    )
    near = np.abs(rough.omega / rough.peak("tip").omega - 1.0) < 0.02
    true = ss.exact_response(rough.model, rough.omega[near], observe="tip")
    facts = [Fact(f"H = {kept}", float(errors(kept).max()), "%") for kept in (15, DOZENS)]
    apart = 100.0 * abs(rough.peak("tip").amplitude / true.peak("tip").amplitude - 1.0)
    return Found((*facts, Fact(f"H = {DOZENS}, stiff damper", apart, "%")), plot)


@claim(
    "hybrid-method",
    "3.5",
    "The Broyden method is used iteratively until convergence criteria are met and Eq. (3.16) is "
    "solved",
    """Procedure 1 with 19 harmonics against exact orbits: amplitudes at the damper in the cases of
    Figs 4.1 and 4.2.""",
    rule=lambda n: verdict(max(n.values()) < 1.0),
    see="fig-4.1 fig-4.2",
)
def hybrid_method(resolution: Resolution) -> Found:
    """Differences of 19 harmonics to exact orbits."""
    facts = []
    for name in ("fig-4.1", "fig-4.2"):
        shown = numbers_of(name, resolution)
        kept, true = (
            shown.fact(f"amplitude at the damper, {what}") for what in ("19 harmonics", "exact")
        )
        facts.append(Fact(f"difference, {name}", 100.0 * abs(kept / true - 1.0), "%"))
    return Found(tuple(facts))


@claim(
    "fully-determined",
    "3.2",
    "The force is fully determined from the displacements and velocities of the structure DOF's to "
    "which the i-th friction damper is attached.",
    """Forces in the fourth period of u = A cos from f(0) = 0 and from f(0) = F_d: largest
    difference over F_d where the contact slips (A = 2 F_d / k_d) and where it never has to
    (A = 0.4 F_d / k_d). What never slips keeps what it started with.""",
    rule=lambda n: verdict(max(n.values()) < 1e-9, n["with slip"] < 1e-9),
)
def fully_determined(resolution: Resolution) -> Found:
    """Return the forces of one motion from two starts."""
    angle = 2.0 * np.pi * np.arange(4 * 200 + 1) / 200
    facts = []
    for name, size in (("with slip", 2.0), ("without slip", 0.4)):
        one, other = (_returned(size * np.cos(angle), start)[-200:] for start in (0.0, 1.0))
        facts.append(Fact(name, float(np.abs(one - other).max())))
    return Found(tuple(facts))


@claim(
    "orthogonal-functions",
    "3.3",
    "All sin(kωt) and cos(lωt) functions are orthogonal to each other over one period of the "
    "motion: (3.6)-(3.8)",
    """Integrals of products up to 15 harmonics over π/ω: largest of different functions, largest
    distance of the squares from 1 for k ≥ 1, and the square of cos(0), which (3.8) puts at 1: it is
    2, as the integral is T.""",
    rule=lambda n: verdict(
        max(n["different"], n["squares"]) < 1e-9 and abs(n["k = l = 0"] - 1.0) < 1e-9,
        max(n["different"], n["squares"]) < 1e-9,
    ),
)
def orthogonal_functions(resolution: Resolution) -> Found:
    """Integrals of products of harmonics."""
    angle = 2.0 * np.pi * np.arange(256) / 256
    orders = np.arange(16)
    rows = np.vstack([np.cos(np.outer(orders, angle)), np.sin(np.outer(orders[1:], angle))])
    products = rows @ rows.T * 2.0 / 256
    squares = np.diag(products)
    return Found(
        (
            Fact("different", float(np.abs(products - np.diag(squares)).max())),
            Fact("squares", float(np.abs(squares[1:] - 1.0).max())),
            Fact("k = l = 0", float(squares[0]), "", 1.0),
        )
    )


@claim(
    "smaller-system",
    "3.3",
    "The size of the reduced system, Eq. (3.16), may be significantly smaller than the size of the "
    "initial system, Eq. (3.10), if many DOF's of the structure are linear",
    """N_d over N of the beam, of the blade and of the ring.""",
    rule=lambda n: verdict(min(n.values()) < 0.1 and max(n.values()) < 0.5),
)
def smaller_system(resolution: Resolution) -> Found:
    """Share of the unknowns that stay."""
    ring = ss.reference.beam_ring(coupling=7e3, engine_order=3)
    models = (
        ("beam", ss.reference.snecma_beam()),
        ("blade", ss.reference.turbine_blade()),
        ("ring", ring.mistuned(np.zeros(36))),
    )
    return Found(tuple(Fact(name, len(one.contacts) / len(one.structure)) for name, one in models))

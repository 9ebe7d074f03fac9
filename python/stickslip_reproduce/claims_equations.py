"""Equations of the text that are put to the test as they are printed."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.mass_cycles import FREE, LIMIT, NEGATIVE
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Float, Resolution
from stickslip_reproduce.solver_experiment import experiment, solved


@claim(
    "two-lines-of-the-law",
    "2.2.1",
    "f_nl = k_d z when |z| ≤ F_d/k_d (sticking), F_d sign(ẋ) when |z| = F_d/k_d (slipping) (2.2)",
    """Force by the second line less that by the first, over F_d, at z = F_d / k_d with the mass
    moving on and moving back. Moving back the contact sticks, and the second line is wrong: slip
    needs f ẋ > 0.""",
    rule=lambda n: verdict(max(n.values()) == 0.0, n["moving on"] == 0.0),
)
def two_lines(resolution: Resolution) -> Found:
    """Difference of the two lines of eq. (2.2) at the limit."""
    sticking = 1.0
    return Found(
        tuple(
            Fact(name, abs(float(np.sign(velocity)) - sticking))
            for name, velocity in (("moving on", 1.0), ("moving back", -1.0))
        )
    )


@claim(
    "coefficient-a",
    "2.2.3",
    "it can be shown that a = (A/π) (θ_C + ½ sin 2θ_C) (2.13), b = (F_d/(k_d A) − 1) 4 F_d/(k_d π) "
    "(2.14)",
    """Both against the integrals (2.7) and (2.8) of the hysteresis loop, at A = 1.2, 2 and 5 times
    F_d / k_d: largest difference over A, of (2.13) also with a minus sign. Eq. (5.6) repeats
    it.""",
    rule=lambda n: verdict(max(n["a as printed"], n["b as printed"]) < 1e-6),
)
def coefficient_a(resolution: Resolution) -> Found:
    """Coefficients of the loop as printed and by integration."""
    worst = dict.fromkeys(("a as printed", "a with a minus", "b as printed"), 0.0)
    for size in (1.2, 2.0, 5.0):
        count = 200_000
        angle = np.pi * (np.arange(count) + 0.5) / count
        spring = np.maximum(size * np.cos(angle) - size + 1.0, -1.0)
        a, b = (2.0 / count * float(spring @ part(angle)) for part in (np.cos, np.sin))
        turn = np.arccos(1.0 - 2.0 / size)
        double = 0.5 * np.sin(2.0 * turn)
        for name, value, true in (
            ("a as printed", size / np.pi * (turn + double), a),
            ("a with a minus", size / np.pi * (turn - double), a),
            ("b as printed", (1.0 / size - 1.0) * 4.0 / np.pi, b),
        ):
            worst[name] = max(worst[name], abs(float(value) - true) / size)
    return Found(tuple(Fact(name, value) for name, value in worst.items()))


@claim(
    "phase-of-the-beam",
    "2.3.3",
    "The phase angle φ between the external force and the structure displacement at the damper is "
    "given by: (2.30), (2.31)",
    """Cosine and sine by both equations against those of the solutions with one harmonic, at eight
    loads and nine frequencies, with a and b of the solution: largest difference; of (2.31) also
    with a minus before its second term.""",
    rule=lambda n: verdict(max(n["(2.30)"], n["(2.31)"]) < 1e-6, n["(2.30)"] < 1e-6),
)
def phase_of_the_beam(resolution: Resolution) -> Found:
    """Phases as printed and of the solution."""
    structure = ss.reference.snecma_structure()
    worst = dict.fromkeys(("(2.30)", "(2.31)", "(2.31) with a minus"), 0.0)
    for load in EIGHT:
        shown = ss.single_harmonic(ss.reference.snecma_beam(load), np.linspace(150.0, 250.0, 9))
        for place, omega in enumerate(shown.omega):
            dynamic = structure.stiffness - omega**2 * structure.mass
            receptance = np.linalg.inv(dynamic + 1j * omega * structure.damping)
            right = load * receptance[0, 1] / receptance[0, 0]
            moved = shown.coefficients("damper")[place, 1]
            # (2.27): the whole bracket of (2.28) follows from the solution.
            whole = right / (moved / abs(moved))
            real, imaginary = whole.real, whole.imag
            size = abs(whole) ** 2
            cosine = (imaginary * right.imag + real * right.real) / size
            first, second = real * right.imag / size, imaginary * right.real / size
            angle = np.angle(moved)
            for name, value, true in (
                ("(2.30)", cosine, np.cos(angle)),
                ("(2.31)", first + second, np.sin(angle)),
                ("(2.31) with a minus", first - second, np.sin(angle)),
            ):
                worst[name] = max(worst[name], abs(float(value - true)))
    return Found(tuple(Fact(name, value) for name, value in worst.items()))


@claim(
    "sign-of-slip",
    "3.2",
    "f_s,i = F_d,i sign(ẋ_e,i − ẋ_s,i) when k_d |x_s,i − z_i| = F_d,i (slipping) (3.2)",
    """Power that a slipping contact takes from the motion by (3.2), over F_d |ẋ_s − ẋ_e|, with the
    force as Table 3.1 updates it, which is that on the damper: friction takes it, 1, and cannot
    give it back.""",
    rule=lambda n: verdict(n["by (3.2)"] > 0.0),
)
def sign_of_slip(resolution: Resolution) -> Found:
    """Power of the friction force by eq. (3.2) and by Table 3.1."""
    moved = 5.0 * np.cos(np.linspace(0.0, 4.0 * np.pi, 801))
    change = np.diff(moved)
    force = np.zeros_like(change)
    for place, step in enumerate(change):
        force[place] = np.clip(force[place - 1] + step, -1.0, 1.0)
    slips = (np.abs(force) == 1.0) & (force * change > 0.0)
    printed = np.sign(-change)
    lost = np.abs(change[slips]).sum()
    return Found(
        tuple(
            Fact(name, float((values[slips] * change[slips]).sum() / lost))
            for name, values in (("by (3.2)", printed), ("by Table 3.1", force))
        )
    )


@claim(
    "lower-then-upper",
    "3.4.1",
    "The lower system is first solved: L Y = −F (3.19). Then the upper one is solved: U ΔX = −Y "
    "(3.20)",
    """Residual |J ΔX + F| over |F| of the 32 cases at 0.1 % from their solutions, by (3.19) and
    (3.20) as printed, and with L Y = −P F and U ΔX = Y.""",
    rule=lambda n: verdict(n["as printed"] < 1e-6),
)
def lower_then_upper(resolution: Resolution) -> Found:
    """Residuals of the linear systems as printed and corrected."""
    from scipy.linalg import lu

    equations, every = experiment(), np.arange(len(experiment().cases))
    vector = 1.001 * solved()[0]
    worst = dict.fromkeys(("as printed", "corrected"), 0.0)
    residuals: Float = equations.residual(vector, every)
    for matrix, force in zip(equations.jacobian(vector, every), residuals, strict=True):
        swaps, lower, upper = lu(matrix)
        printed = np.linalg.solve(upper, -np.linalg.solve(lower, -force))
        right = np.linalg.solve(upper, np.linalg.solve(lower, -swaps.T @ force))
        for name, step in (("as printed", printed), ("corrected", right)):
            left = np.linalg.norm(matrix @ step + force) / np.linalg.norm(force)
            worst[name] = max(worst[name], float(left))
    return Found(tuple(Fact(name, value) for name, value in worst.items()))


@claim(
    "trivial-solution",
    "5.2.3",
    "There are two solutions to this system. The first solution is the trivial one: A = 0.",
    """Left side of the sine equation of (5.18) over 4 F_d / π, at A = 0 and at r = 1 with A of
    (5.20), as printed and with the minus sign that c < 0 asks for.""",
    rule=lambda n: verdict(max(n["A = 0"], n["A of (5.20)"]) < 1e-9),
    see="fig-5.8",
)
def trivial_solution(resolution: Resolution) -> Found:
    """Residuals of eq. (5.18)."""
    damping, force = float(NEGATIVE[0, 0]), 4.0 * LIMIT / np.pi
    printed = force / (damping * FREE)
    return Found(
        tuple(
            Fact(name, abs(-damping * FREE * size - force) / force)
            for name, size in (
                ("A = 0", 0.0),
                ("A of (5.20)", printed),
                ("A with a minus", -printed),
            )
        )
    )


@claim(
    "transition-matrix",
    "5.4.2",
    "M = T Diag(m₁, m₂, m₃) Tᵀ (5.27), K = T Diag(k₁, k₂, k₃) Tᵀ (5.28), C = T Diag(c₁, c₂, c₃) Tᵀ "
    "(5.29)",
    """Largest difference of both sides of (5.27) over the largest entry, T of eigenvectors of unit
    length and m_i = t_iᵀ M t_i; and with the inverse transposes of T in its place.""",
    rule=lambda n: verdict(n["as printed"] < 1e-9),
    see="fig-5.25",
)
def transition_matrix(resolution: Resolution) -> Found:
    """Differences of both sides of eq. (5.27)."""
    from scipy.linalg import eigh

    structure = ss.reference.snecma_structure()
    _, shapes = eigh(structure.stiffness, structure.mass)
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    own = np.diag(np.diag(shapes.T @ structure.mass @ shapes))
    inverse = np.linalg.inv(shapes).T
    return Found(
        tuple(
            Fact(name, float(np.abs(side @ own @ side.T / structure.mass.max() - whole).max()))
            for whole in (structure.mass / structure.mass.max(),)
            for name, side in (("as printed", shapes), ("inverse transposes", inverse))
        )
    )

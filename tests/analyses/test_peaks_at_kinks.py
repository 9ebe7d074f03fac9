"""Peaks at kinks between points at which contacts slip, which no slope nearby tells of."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss


def chain(mass, grounds, springs, ends, contacts, forces, damping):
    """A chain of springs, some of them between other masses, with proportional damping."""
    size = len(mass)
    stiffness = np.diag(np.array(grounds, dtype=float))
    for (a, b), k in zip(ends, springs, strict=True):
        for i, j, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
            stiffness[i, j] += sign * k
    names = [f"q{i}" for i in range(size)]
    structure = ss.Structure(np.diag(mass), stiffness, damping, names)
    return ss.Model(structure, contacts, [ss.Force(*one[:2], **one[2]) for one in forces])


def ring_of_five():
    """The number of stops per period of a contact changes twice beside the peak."""
    contacts = [
        ss.Jenkins("q1", "q3", stiffness=61630.0, slip_force=2.255, name="c0"),
        ss.Jenkins("q4", stiffness=444.8, slip_force=2.255, name="c1"),
    ]
    forces = [("q3", 39.29, {"phase": 2.505}), ("q3", 16.86, {"phase": 1.658})]
    model = chain(
        [1.215, 0.6394, 1.313, 1.194, 1.24],
        [211.0, 666.0, 179.0, 365.0, 247.0],
        [3521.0, 3241.0, 6700.0, 3615.0, 2157.0],
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)],
        contacts,
        forces,
        ss.ModalDamping(5.1e-5),
    )
    return model, "q1", 3, (68.2, 86.1)


def resonance_of_the_third_harmonic():
    forces = [("q0", 2.272, {"phase": 1.944})]
    model = chain(
        [1.507, 1.658, 1.472, 1.547],
        [142300.0, 100.0, 100.0, 75800.0],
        [124000.0, 104500.0, 118600.0],
        [(0, 1), (1, 2), (2, 3)],
        [ss.Jenkins("q2", stiffness=21530.0, slip_force=4.888)],
        forces,
        ss.ModalDamping(1.1e-5),
    )
    return model, "q0", 3, (153.73, 185.47)


def loads_of_two_harmonics():
    """Contacts that carry a mean stick between points at which they slip, too."""
    contacts = [
        ss.Jenkins("q3", stiffness=203.9, slip_force=9.674, name="c0"),
        ss.Jenkins("q0", "q6", stiffness=874.0, slip_force=9.674, name="c1"),
        ss.Jenkins("q6", stiffness=1747.0, slip_force=9.674, name="c2"),
    ]
    forces = [
        ("q5", 8.157, {"phase": 4.92}),
        ("q3", 10.7, {"phase": 5.368}),
        ("q1", 2.577, {"harmonic": 2}),
    ]
    model = chain(
        [1.176, 1.739, 1.638, 1.286, 1.842, 0.8214, 1.979],
        [1752.0, 0.0, -1.0, 0.0, 0.0, -1.0, 2265.0],
        [2849.0, 3993.0, 2123.0, 5337.0, 4145.0, 3713.0],
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6)],
        contacts,
        forces,
        ss.ModalDamping(3.9e-4),
    )
    return model, "q2", 5, (44.95, 78.87)


@pytest.mark.parametrize(
    ("case", "level"),
    [(ring_of_five, 1.0), (resonance_of_the_third_harmonic, 1.09), (loads_of_two_harmonics, 0.98)],
)
def test_no_grid_is_higher(case, level):
    model, dof, harmonics, span = case()
    curve = ss.damper_curve(model, level=[level], dof=dof, omega=span, harmonics=harmonics)
    beside = curve.omega[0] * np.linspace(0.99, 1.01, 401)
    grid = np.unique(np.r_[np.linspace(*span, 1501), beside])
    fine = ss.forced_response(curve.model_at(level), grid, harmonics, observe=[dof])
    assert curve.amplitude[0] >= (1 - 1e-4) * fine.amplitude(dof).max()

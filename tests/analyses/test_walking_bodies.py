"""Bodies that contacts alone hold and that walk: no motion of them repeats."""

from typing import Any

import numpy as np
import pytest

import stickslip as ss


def pair(contact: Any, static: float) -> ss.Model:
    """Return two masses that nothing but a contact holds, shaken, under a static load."""
    mass, stiffness = np.diag([1.0, 2.0]), 100.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damping = 0.02 * mass + 1e-3 * stiffness
    structure = ss.Structure(mass=mass, stiffness=stiffness, damping=damping, dofs=["x", "y"])
    forces = [ss.Force("y", 1.0), ss.Force("x", static, harmonic=0)]
    return ss.Model(structure, [contact], forces)


def lever() -> ss.Model:
    """Return two masses on a lever without a ground, and a contact between them."""
    bent = np.array([1.0, -1.1])
    structure = ss.Structure(
        mass=np.diag([0.35, 1.07]),
        stiffness=16500.0 * np.outer(bent, bent),
        damping=[[3.0, -2.0], [-2.0, 7.0]],
        dofs=["x", "y"],
    )
    contact = ss.Masing("y", "x", stiffness=921.0, slip_force=0.01742, backbone="exponential")
    return ss.Model(structure, [contact], [ss.Force("x", 0.4), ss.Force("x", 0.002, harmonic=0)])


SLIDER = ss.Jenkins("x", stiffness=50.0, slip_force=0.1)
MICROSLIP = ss.Masing("x", stiffness=50.0, slip_force=0.1, backbone="exponential")
# A soft slider holds the body for long.
SOFT = ss.ParallelJenkins("x", stiffness=(50.0, 0.01), slip_forces=(0.1, 0.005))


@pytest.mark.parametrize("harmonics", [1, 5, "auto"])
@pytest.mark.parametrize("contact", [SLIDER, MICROSLIP, SOFT], ids=["slider", "microslip", "soft"])
def test_a_body_that_walks_is_named_at_once(contact: Any, harmonics: Any) -> None:
    model = pair(contact, 0.03)
    frf = ss.forced_response(model, [3.0], harmonics)
    assert frf.status == ("free",)
    assert "make it walk" in frf.status[0].advice
    # A homotopy and up to thousands of evaluations led to the same status.
    assert frf.counters["homotopies"] == 0
    assert frf.counters["evaluations"] < 20


def test_bodies_walk_in_time() -> None:
    late = ss.transient(pair(SLIDER, 0.03), omega=3.0, periods=400, scheme="rk4", steps=400)
    steps = np.diff(late.poincare("x")[0])
    # Far within the limit of the contact it goes on by as much in every period.
    assert steps[-1] > 1e-3
    assert steps[-1] == pytest.approx(steps[200], rel=1e-6)


@pytest.mark.parametrize("harmonics", [1, 3])
def test_a_body_that_walks_is_not_solved_far_away(harmonics: int) -> None:
    # Its equations hold but for rounding at a mean of 1e8 m, which was called a solution.
    frf = ss.forced_response(lever(), [290.0], harmonics)
    assert frf.status == ("free",)


@pytest.mark.parametrize(
    ("contact", "static"),
    [
        (SLIDER, 0.0),
        (MICROSLIP, 0.0),
        (ss.ParallelJenkins("x", stiffness=(50.0, 0.1), slip_forces=(0.1, 5.0)), 0.03),
    ],
    ids=["slider", "microslip", "held"],
)
def test_what_contacts_hold_is_solved(contact: Any, static: float) -> None:
    frf = ss.forced_response(pair(contact, static), [3.0], 5)
    assert frf.status == ("converged",)

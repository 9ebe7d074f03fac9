"""Interfaces of many contacts of which some are much stiffer than the others."""

import numpy as np
import pytest

import stickslip as ss

COUNT = 160


def interface(law, soft, limit):
    """A chain with a contact at every mass, every second one ten thousand times as stiff."""
    springs = 1e3 * np.eye(COUNT) + 2e4 * np.eye(COUNT)
    springs[0, 0] = springs[-1, -1] = 1.1e4
    springs -= 1e4 * (np.eye(COUNT, k=1) + np.eye(COUNT, k=-1))
    dofs = [f"q{mass}" for mass in range(COUNT)]
    damping = ss.Rayleigh(mass=0.2, stiffness=1e-5)
    structure = ss.Structure(np.eye(COUNT), springs, damping, dofs)
    contacts = [law(dof, soft * (1e4 if i % 2 else 1.0), limit) for i, dof in enumerate(dofs)]
    forces = [ss.Force(dofs[0], 50.0), ss.Force(dofs[COUNT // 2], 80.0, phase=0.7)]
    return ss.Model(structure, contacts, forces)


def iwan(dof, stiffness, limit):
    return ss.Iwan(dof, stiffness=stiffness, slip_force=limit, chi=-0.5, beta=0.1)


def jenkins(dof, stiffness, limit):
    return ss.Jenkins(dof, stiffness=stiffness, slip_force=limit)


@pytest.mark.slow
@pytest.mark.parametrize("law", [iwan, jenkins])
def test_a_direction_that_products_do_not_lead_to_is_found_all_the_same(law):
    """Products with the modes led nowhere: `stalled` after half a minute."""
    model = interface(law, 1e2, 0.3)
    found = ss.forced_response(model, [100.0], 3)
    assert found.status == ("converged",)
    dense = ss.forced_response(model, [100.0], 3, method="broyden")
    assert found.amplitude("q0") == pytest.approx(dense.amplitude("q0"), rel=1e-8)
    # Some directions, not each of some hundred.
    assert 0 < found.counters["products"] < 5000


@pytest.mark.parametrize("law", [iwan, jenkins])
def test_where_they_lead_to_one_nothing_is_formed(law):
    model = ss.Model(
        interface(law, 1e2, 0.3).structure,
        [law(f"q{mass}", 1e3, 5.0) for mass in range(COUNT)],
        [ss.Force("q0", 50.0)],
    )
    found = ss.forced_response(model, [100.0], 3)
    assert found.status == ("converged",)
    assert found.counters["products"] > found.counters["factorisations"]

"""Ranges along which the curve of few harmonics passes where that of more turns back and forth."""

import numpy as np
import pytest

import stickslip as ss


def four(mass, stiffness, damping, contacts, forces):
    dofs = ["d0", "d1", "d2", "d3"]
    structure = ss.Structure(np.diag(mass), stiffness, ss.ModalDamping(damping), dofs)
    return ss.Model(structure, contacts, forces)


def between_two_bodies():
    """With three harmonics the curve passes by four folds of those with more."""
    stiffness = [
        [769400.0, -605700.0, -127300.0, 0.0],
        [-605700.0, 1254000.0, -636500.0, 0.0],
        [-127300.0, -636500.0, 975600.0, -188000.0],
        [0.0, 0.0, -188000.0, 192600.0],
    ]
    contact = ss.Coulomb(
        ["d3", "d2"],
        other=["d0", "d1"],
        normal=[0.9959, -0.09057],
        friction=0.1749,
        tangential_stiffness=45360.0,
        normal_stiffness=66750.0,
        preload=33.44,
    )
    forces = [ss.Force("d1", 25.25, 1.437), ss.Force("d2", 29.38, 4.175)]
    return four([3.167, 0.8306, 1.047, 1.609], stiffness, 0.001559, [contact], forces)


def rubbing_beside_a_stop():
    stiffness = [
        [8010.0, -3480.0, 0.0, -4330.0],
        [-3480.0, 8160.0, -2020.0, 0.0],
        [0.0, -2020.0, 3650.0, -1420.0],
        [-4330.0, 0.0, -1420.0, 6330.0],
    ]
    stop = ss.Stop("d3", "d2", stiffness=370.0, gap=0.000349)
    contact = ss.Coulomb(
        ["d0", "d2"],
        other=["d1", "d3"],
        normal=[0.886, 0.464],
        friction=0.493,
        tangential_stiffness=6240.0,
        normal_stiffness=10300.0,
        preload=2.49,
    )
    forces = [ss.Force("d0", 0.207, 0.74)]
    return four([0.669, 1.85, 1.44, 1.03], stiffness, 0.000572, [stop, contact], forces)


CASES = {
    "contact": (between_two_bodies, "d1", (85.03, 132.9)),
    "contact and stop": (rubbing_beside_a_stop, "d0", (20.5, 32.1)),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("way", [1, -1])
def test_ranges_are_followed_to_their_ends(name, way):
    make, dof, omega = CASES[name]
    model, omega = make(), omega[::way]
    curve = ss.forced_response(model, omega, observe=[dof], stability=False)
    assert curve.converged.all()
    assert tuple(curve.omega[[0, -1]]) == omega
    fine = ss.forced_response(model, omega, 27, observe=[dof], stability=False)
    highest = [np.nanmax(one.amplitude(dof)) for one in (curve, fine)]
    assert highest[0] == pytest.approx(highest[1], rel=5e-3)
    assert curve.omega.size < 1.5 * fine.omega.size

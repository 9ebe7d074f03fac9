"""What a contact keeps that never slips: exact harmonics, samples and exact orbits agree."""

import numpy as np
import pytest

import stickslip as ss

ASSUMED = ["centred", "from_rest", 4.0]


def beside_an_opening_one(directions: int) -> ss.Model:
    """A contact that sticks under a normal load that varies, beside one that opens."""
    names = ["a.x", "a.z", "b.x", "b.z"] if directions == 1 else ["a.x", "a.y", "a.z", "b.z"]
    size = len(names)
    stiffness = 2e3 * np.eye(size)
    for i in range(size):
        for j in range(i):
            stiffness[i, j] = stiffness[j, i] = -300.0 - 70.0 * i + 40.0 * j
    structure = ss.Structure(np.eye(size), stiffness, 3.0 * np.eye(size), names)
    sticking = names[: directions + 1]
    contacts = [
        ss.Coulomb(
            sticking,
            normal=[0.2] * directions + [1.0],
            friction=0.6,
            tangential_stiffness=1500.0,
            normal_stiffness=2500.0,
            preload=25.0,
            name="sticking",
        ),
        ss.Coulomb(
            ["b.z", names[0]],
            normal=[1.0, 0.3],
            friction=0.4,
            tangential_stiffness=900.0,
            normal_stiffness=3000.0,
            gap=0.002,
            name="opening",
        ),
    ]
    forces = [
        ss.Force("b.z", 16.0),
        ss.Force(names[0], 3.0, phase=1.0),
        ss.Force(names[0], 9.0, harmonic=0),
        ss.Force("b.z", 5.0, harmonic=0),
    ]
    return ss.Model(structure, contacts, forces)


def amplitudes(response, names):
    return np.array([response.amplitude(name)[0] for name in names])


@pytest.mark.parametrize("residual", ASSUMED)
@pytest.mark.parametrize(
    ("directions", "evaluation"), [(1, "marched"), (1, "orbit"), (2, "marched")]
)
def test_every_evaluation_keeps_the_same(directions, evaluation, residual):
    model = beside_an_opening_one(directions)
    names = model.structure.dofs
    exact = ss.forced_response(model, [30.0], tolerance=1e-5, max_harmonics=200, residual=residual)
    assert exact.status[0].solved
    assert exact.open_fraction("opening")[0] > 0.05
    assert np.all(exact.slip_fraction("sticking") == 0.0)
    if evaluation == "orbit":
        other = ss.exact_response(model, [30.0], residual=residual)
    else:
        other = ss.forced_response(
            model, [30.0], harmonics=20, samples=4096, evaluation="marched", residual=residual
        )
    assert other.status[0].solved
    size = amplitudes(exact, names).max()
    apart = np.abs(amplitudes(other, names) - amplitudes(exact, names)).max() / size
    assert apart < 1e-4


@pytest.mark.parametrize("directions", [1, 2])
def test_what_is_assumed_moves_the_vibration(directions):
    model = beside_an_opening_one(directions)
    names = model.structure.dofs
    found = [
        amplitudes(ss.forced_response(model, [30.0], residual=residual), names)
        for residual in ASSUMED
    ]
    for other in found[1:]:
        assert np.abs(other - found[0]).max() > 5e-3 * found[0].max()


def test_a_body_that_contacts_alone_hold_begins_from_rest():
    """Centred tractions have no mean that could hold it."""
    pad = ss.Coulomb(
        ["x", "z"],
        normal=[0.0, 1.0],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=2e4,
        preload=10.0,
    )
    forces = [ss.Force("x", 1.0), ss.Force("z", 2.0, phase=1.0)]
    for ground, expected in ((0.0, "from_rest"), (1.0, "centred")):
        held = ss.Structure(np.eye(2), ground * np.eye(2), 4.0 * np.eye(2), ["x", "z"])
        frf = ss.forced_response(ss.Model(held, [pad], forces), [60.0, 70.0], 5)
        assert frf.settings.residual == expected
        assert frf.converged.all()
        exact = ss.exact_response(frf.model, frf.omega)
        np.testing.assert_allclose(frf.amplitude("x"), exact.amplitude("x"), rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("residual", ["centred", 0.5, -0.5])
def test_orbits_hold_the_residual_of_contacts_in_two_directions(residual) -> None:
    mass = np.diag([1.116, 0.814, 1.24, 0.481])
    stiffness = 1e3 * np.array(
        [
            [643.0, -448.6, 0.0, 0.0],
            [-448.6, 1110.5, -639.2, 0.0],
            [0.0, -639.2, 3098.8, -588.9],
            [0.0, 0.0, -588.9, 848.8],
        ]
    )
    dofs = ["a", "b", "c", "d"]
    structure = ss.Structure(mass, stiffness, ss.ModalDamping(0.0126), dofs)
    holding = ss.Coulomb(
        ["b", "d"], normal=None, friction=0.451, tangential_stiffness=1.984e5, preload=3.672
    )
    # Its stick, slip and flight start no orbit with the residual of few harmonics.
    lifting = ss.Coulomb(
        ["a", "d", "c"],
        normal=(-0.638, -0.305, -0.707),
        friction=0.533,
        tangential_stiffness=4.812e6,
        normal_stiffness=5.743e6,
        preload=1.658,
    )
    model = ss.Model(structure, [holding, lifting], [ss.Force("a", 4.323)])
    exact = ss.exact_response(model, [331.84], residual=residual)
    balance = ss.forced_response(model, [331.84], tolerance=1e-5, residual=residual)
    assert exact.status == balance.status == (ss.Status.CONVERGED,)
    assert exact.stable == balance.stable
    for dof in dofs:
        np.testing.assert_allclose(exact.amplitude(dof), balance.amplitude(dof), rtol=1e-4)
    traction, other = (one.contact_force(0, 0, 256) for one in (exact, balance))
    np.testing.assert_allclose(traction, other, atol=1e-3 * np.abs(other).max())

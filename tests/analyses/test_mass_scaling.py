"""Fast modes slowed by mass that moves with them alone."""

import re

import numpy as np
import pytest

import stickslip as ss

TOLERANCE = 1e-4


def chain(seed: int) -> tuple[ss.Model, float]:
    """Return a chain of masses that carry light ones on stiff springs; a light one rubs."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(2, 7))
    springs, stems = 10.0 ** rng.uniform(4.0, 5.0, size), 10.0 ** rng.uniform(5.5, 6.5, size)
    stiffness = np.diag(np.concatenate([springs + np.append(springs[1:], 0.0) + stems, stems]))
    stiffness -= np.diag(np.concatenate([springs[1:], np.zeros(size)]), 1)
    stiffness -= np.diag(np.concatenate([springs[1:], np.zeros(size)]), -1)
    stiffness -= np.diag(stems, size) + np.diag(stems, -size)
    mass = 10.0 ** np.concatenate([rng.uniform(0.0, 1.0, size), rng.uniform(-4.0, -3.0, size)])
    structure = ss.Structure(np.diag(mass), stiffness, ss.ModalDamping(0.01))
    light = int(rng.integers(size))
    stuck = 0.01 * stems[light]
    contact = ss.Jenkins(str(size + light), stiffness=stuck, slip_force=1e-4 * stuck)
    model = ss.Model(structure, [contact], [ss.Force(str(light), 30.0)])
    return model, 0.8 * ss.natural_frequencies(model)[0]


@pytest.mark.parametrize("seed", range(12))
def test_the_motion_changes_by_no_more_than_the_estimate_in_fewer_steps(seed):
    model, omega = chain(seed)
    whole = ss.exact_response(model, [omega])
    slowed = ss.exact_response(model, [omega], mass_scaling=TOLERANCE)
    said = slowed.diagnostics[0]
    assert said.code == "mass-scaling"
    assert said.data["slowed"] < said.data["fastest"]
    assert said.data["change"] <= TOLERANCE * (1.0 + 1e-9)
    assert whole.converged.all()
    assert slowed.converged.all()
    assert slowed.counters["evaluations"] < whole.counters["evaluations"]
    dof = model.forces[0].dof
    changed = slowed.amplitude(dof) / whole.amplitude(dof) - 1.0
    assert 0.0 < np.abs(changed).max() < said.data["change"]


def test_only_the_fast_modes_become_slower_and_the_flexibility_remains():
    model, omega = chain(1)
    slowed = ss.exact_response(model, [omega], mass_scaling=TOLERANCE)
    said = slowed.diagnostics[0].data
    free = model.replaced(contacts=())
    before = ss.natural_frequencies(free)
    after = ss.natural_frequencies(slowed.model.replaced(contacts=()))
    kept = before.size - said["modes"]
    assert before[-1] == pytest.approx(said["fastest"], rel=1e-9)
    np.testing.assert_allclose(after[:kept], before[:kept], rtol=1e-9)
    assert after[-1] == pytest.approx(said["slowed"], rel=1e-9)
    np.testing.assert_array_less(0.79 * said["slowed"], after[kept:])
    assert slowed.model.structure.stiffness.tobytes() == model.structure.stiffness.tobytes()
    assert slowed.model.structure.damping.tobytes() == model.structure.damping.tobytes()


def test_modes_too_fast_to_follow_are_followed():
    stiffness = np.array([[2e4, -1e4, 0.0], [-1e4, 1e8, -9e7], [0.0, -9e7, 9e7]])
    structure = ss.Structure(np.diag([1.0, 1e-3, 1e-8]), stiffness, ss.ModalDamping(0.01))
    model = ss.Model(
        structure, [ss.Jenkins("0", stiffness=1e4, slip_force=5.0)], [ss.Force("0", 30.0)]
    )
    with pytest.raises(ss.ModelError, match=r"mass of dof '2'.*mass_scaling=1e-5"):
        ss.exact_response(model, [80.0])
    slowed = ss.exact_response(model, [80.0], mass_scaling=TOLERANCE)
    balance = ss.forced_response(model, [80.0], 101)
    assert slowed.amplitude("0") == pytest.approx(balance.amplitude("0"), rel=1e-4)


def test_transients_are_slowed_too():
    model, omega = chain(3)
    dof = model.forces[0].dof
    whole = ss.transient(model, omega, periods=300, keep=1)
    slowed = ss.transient(model, omega, periods=300, keep=1, mass_scaling=TOLERANCE)
    assert slowed.diagnostics[0].code == "mass-scaling"
    assert slowed.amplitudes(dof)[-1] == pytest.approx(whole.amplitudes(dof)[-1], rel=TOLERANCE)


def test_a_body_that_contacts_alone_hold_is_slowed_too():
    """Rigid motions have no stiffness; one of them moves neither the contact nor the force."""
    stiffness = np.zeros((4, 4))
    stiffness[:3, :3] = 1e9 * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    structure = ss.Structure(np.diag([1.0, 1e-3, 1.0, 1.0]), stiffness, ss.Rayleigh(mass=1.0))
    contact = ss.Jenkins("0", stiffness=1e4, slip_force=5.0)
    model = ss.Model(structure, [contact], [ss.Force("2", 3.0)])
    whole = ss.exact_response(model, [60.0])
    slowed = ss.exact_response(model, [60.0], mass_scaling=TOLERANCE)
    assert "slowed" in slowed.diagnostics[0].data
    assert slowed.amplitude("2") == pytest.approx(whole.amplitude("2"), rel=TOLERANCE)


def test_what_has_no_fast_modes_stays_as_it_is():
    beam = ss.reference.snecma_beam(25.0)
    whole = ss.exact_response(beam, [170.0])
    same = ss.exact_response(beam, [170.0], mass_scaling=1e-8)
    assert same.diagnostics[0].data == {"tolerance": 1e-8}
    assert same.amplitude("tip") == whole.amplitude("tip")


def test_rings_and_dofs_without_mass_are_refused():
    with pytest.raises(ss.ModelError, match=r"mass_scaling: .* has sectors"):
        ss.exact_response(ss.reference.beam_ring(), [170.0], mass_scaling=TOLERANCE)
    structure = ss.Structure(np.diag([1.0, 0.0]), [[2e4, -1e4], [-1e4, 1e4]])
    contact = ss.Jenkins("1", stiffness=1e4, slip_force=5.0)
    model = ss.Model(structure, [contact], [ss.Force("0", 1.0)])
    with pytest.raises(ss.ModelError, match=r"mass_scaling: dof '1' has no mass"):
        ss.exact_response(model, [80.0], mass_scaling=TOLERANCE)


def heavy(stiffness: float) -> ss.Model:
    """Return two masses that nobody would call light, on a contact."""
    structure = ss.Structure(
        np.diag([0.517, 0.352]), [[4.9e4, -2e4], [-2e4, 4.6e4]], ss.ModalDamping(1e-3)
    )
    contact = ss.Jenkins("1", stiffness=stiffness, slip_force=0.5, name="stop")
    return ss.Model(structure, [contact], [ss.Force("0", 1.0)])


@pytest.mark.parametrize("scaling", [None, TOLERANCE, 0.1])
@pytest.mark.parametrize("analysis", ["exact", "transient"])
def test_a_stiff_contact_is_named_where_it_makes_a_mass_too_fast(scaling, analysis):
    def follow(model):
        if analysis == "exact":
            return ss.exact_response(model, [1.6], mass_scaling=scaling)
        return ss.transient(model, 1.6, 1, mass_scaling=scaling)

    softer = (
        r"contact 'stop': on its 1\.2e\+12 N/m dof '1' of 0\.352 kg .* make it softer than (\S+) "
    )
    with pytest.raises(ss.ModelError, match=softer) as refused:
        follow(heavy(1.2e12))
    assert "mass_scaling" not in str(refused.value)
    limit = float(re.search(softer, str(refused.value))[1])
    with pytest.raises(ss.ModelError, match="contact 'stop'"):
        follow(heavy(1.1 * limit))
    if analysis == "exact":
        assert follow(heavy(0.99 * limit)).converged.all()


@pytest.mark.parametrize("damping", [None, ss.ModalDamping(0.01), np.diag([0.5, 0.2, 0.3])])
@pytest.mark.parametrize("scaling", [None, 1e-7])
def test_the_mass_scaling_that_is_advised_helps(damping, scaling):
    stiffness = 1e4 * (2.0 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    structure = ss.Structure(np.diag([1.0, 1.5, 1e-12]), stiffness, damping)
    contact = ss.Jenkins("2", stiffness=2e4, slip_force=0.3)
    model = ss.Model(structure, [contact], [ss.Force("0", 1.0)])
    with pytest.raises(ss.ModelError, match="mass of dof '2': with 1e-12 kg it") as refused:
        ss.exact_response(model, [60.0, 80.0], mass_scaling=scaling)
    said = str(refused.value)
    assert ("slowed by mass_scaling=1e-7" in said) == (scaling is not None)
    advised = re.search(r"give mass_scaling=(\S+) to", said)
    slowed = ss.exact_response(model, [60.0, 80.0], mass_scaling=float(advised[1]))
    assert slowed.converged.all()

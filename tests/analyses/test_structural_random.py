"""Random structure-like dampers on random structures."""

import numpy as np
import pytest

import stickslip as ss


def linked_model(seed):
    """A passive structure of 3 to 6 DOFs with a random damper of 2 to 6 contacts."""
    rng = np.random.default_rng(seed)
    size, points = int(rng.integers(3, 7)), int(rng.integers(2, 7))
    basis = rng.normal(size=(2, size, size))
    mass = basis[0] @ basis[0].T + 2.0 * np.eye(size)
    stiffness = 30.0 * (basis[1] @ basis[1].T + np.eye(size))
    structure = ss.Structure(mass, stiffness, damping=ss.ModalDamping(10 ** rng.uniform(-3, -1.3)))
    links = np.triu(10 ** rng.uniform(0.0, 2.5, (points, points)), 1)
    links = links + links.T
    own = np.diag(links.sum(axis=1)) - links
    limits = 10 ** rng.uniform(-1.5, 0.5, points)
    limits[rng.random(points) < 0.2] = np.inf
    dofs = [str(dof) for dof in rng.integers(0, size, points)]
    if rng.random() < 0.3:
        dofs[-1] = None
    damper = ss.StructuralDamper(dofs, stiffness=own, slip_forces=limits)
    forces = [ss.Force(str(dof), rng.uniform(0.5, 5.0), rng.uniform(0, 6)) for dof in (0, size - 1)]
    model = ss.Model(structure, [damper], forces)
    return model, ss.natural_frequencies(model)[0] * rng.uniform(0.4, 1.6)


@pytest.mark.slow
def test_three_hundred_random_dampers_need_no_homotopy():
    for seed in range(300):
        model, omega = linked_model(seed)
        frf = ss.forced_response(model, [omega], harmonics=9)
        assert frf.converged.all(), seed
        assert frf.counters["homotopies"] == 0, seed


@pytest.mark.parametrize("seed", range(20))
def test_random_dampers_on_random_structures_are_solved(seed):
    model, omega = linked_model(seed)
    frf = ss.forced_response(model, [omega], harmonics=9)
    assert frf.converged.all()
    work = frf.dissipation(0)
    assert (work >= -1e-12 * np.abs(work).max(initial=1e-300)).all()
    free = [point for point, dof in enumerate(model.contacts[0].dofs) if dof is None]
    forces = frf.contact_force(0, 0, 256)
    largest = np.abs(forces).max()
    assert np.abs(forces.sum(axis=1)).max() <= 1e-9 * max(largest, 1e-12)
    assert len(free) <= 1
    if seed < 8:
        exact = ss.exact_response(model, [omega])
        assert exact.converged.all()
        assert exact.energy.friction[0] == pytest.approx(
            exact.energy.work[0] - exact.energy.viscous[0], abs=1e-7 * exact.energy.work[0]
        )
        moving = np.abs(exact.multipliers[0, exact.neutral[0] :])
        assert (moving < 1.0).all()


def coupled_model(seed: int) -> tuple[ss.Model, float]:
    """A structure of 3 to 6 DOFs with a damper of 3 to 5 contacts, some of them on the ground."""
    rng = np.random.default_rng(seed)
    size, points = int(rng.integers(3, 7)), int(rng.integers(3, 6))
    basis = rng.normal(size=(2, size, size))
    structure = ss.Structure(
        basis[0] @ basis[0].T / size + np.eye(size),
        1e5 * (basis[1] @ basis[1].T + 0.3 * np.eye(size)),
        damping=ss.Rayleigh(mass=4.0, stiffness=4e-5),
    )
    strains = rng.normal(size=(points, points))
    if rng.random() < 0.5:
        strains -= strains.mean(axis=1, keepdims=True)
    own = 10 ** rng.uniform(4.5, 6.3) * strains.T @ strains
    dofs = [str(dof) for dof in rng.permutation(max(size, points))[:points]]
    damper = ss.StructuralDamper(
        [dof if int(dof) < size else None for dof in dofs],
        stiffness=0.5 * (own + own.T),
        slip_forces=20.0 * 10 ** rng.uniform(-1.5, 0.3, points),
    )
    model = ss.Model(structure, [damper], [ss.Force("0", 20.0)])
    return model, ss.natural_frequencies(model)[0] * rng.uniform(0.7, 1.05)


@pytest.mark.slow
def test_orbits_and_balances_of_random_dampers_agree():
    """At every instant: a contact that slips against its force moves them by several per cent."""
    slipping = 0
    for seed in range(60):
        model, omega = coupled_model(seed)
        exact = ss.exact_response(model, [omega])
        balance = ss.forced_response(model, [omega], harmonics=41)
        assert exact.converged.all(), seed
        assert balance.converged.all(), seed
        forces = exact.contact_force(0, 0, 512)
        off = np.abs(forces - balance.contact_force(0, 0, 512)).max() / np.abs(forces).max()
        assert off < 0.02, (seed, off)
        slipping += (exact.slip_fraction(0) > 0.0).sum() >= 2
    assert slipping > 20


@pytest.mark.parametrize("seed", [2, 7, 11])
def test_dissipation_is_that_of_the_energy_balance(seed):
    model, omega = coupled_model(seed)
    exact = ss.exact_response(model, [omega])
    lost = exact.energy.work[0] - exact.energy.viscous[0]
    assert exact.dissipation(0).sum() == pytest.approx(lost, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_points_that_turn_together_leave_no_residual(seed):
    """Close modes let two points of a damper stick and slip again at nearly one time."""
    rng = np.random.default_rng(seed)
    for _ in range(50):
        basis = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        modes = 1e3 * (1.0 + 10 ** rng.uniform(-4.0, -1.0, 3))
        stiffness = basis @ np.diag(modes**2) @ basis.T
        damping = basis @ np.diag(2e-3 * modes) @ basis.T
        structure = ss.Structure(np.eye(3), stiffness, damping, ["0", "1", "2"])
        own = 10 ** rng.uniform(5.0, 7.5) * np.array([[1.2, -0.5], [-0.5, 1.0]])
        damper = ss.StructuralDamper(
            ["0", "1"], stiffness=own, slip_forces=10 ** rng.uniform(-2.5, 0.5, 2)
        )
        model = ss.Model(structure, [damper], [ss.Force("0", 1.0)])
        omega = np.linspace(0.95 * modes.min(), 1.05 * modes.max(), 20)
        frf = ss.forced_response(model, omega, harmonics=int(rng.choice([3, 5, 9, 15])))
        assert frf.converged.all()
        assert frf.arrays.residual.max() < 1e-10

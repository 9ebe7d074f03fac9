"""Exact orbits of random structure-like dampers, each contact of which may turn another back."""

import numpy as np
import pytest

import stickslip as ss


def random_model(seed: int) -> tuple[ss.Model, float]:
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


def test_orbits_and_balances_of_random_dampers_agree():
    """At every instant: a contact that slips against its force moves them by several per cent."""
    slipping = 0
    for seed in range(60):
        model, omega = random_model(seed)
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
    model, omega = random_model(seed)
    exact = ss.exact_response(model, [omega])
    lost = exact.energy.work[0] - exact.energy.viscous[0]
    assert exact.dissipation(0).sum() == pytest.approx(lost, rel=1e-6, abs=1e-12)

"""Degrees of freedom of hardly any mass in the middle of a structure."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row

DAMPING = ["modal", "rayleigh", "each dof", "between dofs"]


def chain(seed: int, mass: float, damping: str) -> ss.Model:
    """Random chain with one light dof inside, and a contact on it or elsewhere."""
    rng = np.random.default_rng([78, seed])
    size = int(rng.integers(4, 9))
    masses = rng.uniform(0.5, 2.0, size)
    light = int(rng.integers(1, size - 1))
    masses[light] = mass

    def springs(low: float, high: float) -> np.ndarray:
        return in_a_row(10 ** rng.uniform(low, high, size + 1))

    stiffness = springs(3.0, 5.0)
    laws = {
        "modal": ss.ModalDamping(0.01),
        "rayleigh": ss.Rayleigh(mass=0.3, stiffness=1e-5),
        "each dof": np.diag(10 ** rng.uniform(-1.0, 1.0, size)),
        "between dofs": springs(-1.0, 1.0),
    }
    dofs = [f"d{i}" for i in range(size)]
    beam = ss.Structure(np.diag(masses), stiffness, laws[damping], dofs=dofs)
    place = light if rng.random() < 0.5 else int(rng.integers(size))
    rigid = stiffness[place, place] * 10 ** rng.uniform(-1.0, 1.0)
    damper = ss.Jenkins(dofs[place], stiffness=rigid, slip_force=0.2)
    return ss.Model(beam, [damper], [ss.Force(dofs[(light + 1) % size], 1.0)])


@pytest.mark.slow
@pytest.mark.parametrize("damping", DAMPING)
def test_the_response_does_not_depend_on_a_mass_that_is_next_to_nothing(damping: str) -> None:
    slipped = []
    for seed in range(6):
        heavier = chain(seed, 1e-7, damping)
        omega = ss.natural_frequencies(heavier)[1] * np.linspace(0.3, 1.2, 6)
        expected = ss.forced_response(heavier, omega, harmonics=9)
        slipped.append(expected.slip_fraction(0).max())
        for mass in (1e-9, 1e-12, 1e-14):
            frf = ss.forced_response(chain(seed, mass, damping), omega, harmonics=9)
            assert frf.converged.all()
            for dof in frf.dofs:
                right = expected.coefficients(dof)
                # A mass of 1e-7 kg changes this much.
                np.testing.assert_allclose(
                    frf.coefficients(dof), right, rtol=0.0, atol=1e-5 * np.abs(right).max()
                )
    assert np.mean(np.array(slipped) > 0.1) > 0.5


@pytest.mark.parametrize("damping", DAMPING)
def test_natural_frequencies_keep_their_digits_beside_a_very_fast_one(damping: str) -> None:
    for seed in range(6):
        slow = [
            ss.natural_frequencies(chain(seed, mass, damping), slipping=[(0, 0)])[:-1]
            for mass in (1e-11, 1e-14)
        ]
        np.testing.assert_allclose(slow[1], slow[0], rtol=1e-9)


def test_a_motion_too_long_to_keep_names_the_dof_that_moves_fastest(monkeypatch) -> None:
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**8)
    beam = ss.Structure(np.diag([1.0, 1e-7]), [[1e4, -5e3], [-5e3, 8e3]], dofs=["a", "b"])
    model = ss.Model(beam, [ss.Jenkins("a", stiffness=1e3, slip_force=1.0)])
    with pytest.raises(ss.ModelError, match="condense dof 'b' statically"):
        ss.classify(model, {"a": 0.01})

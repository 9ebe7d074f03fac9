"""What results say of structures that were reduced with too few modes."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from scipy.linalg import eigh

import stickslip as ss
from stickslip.results.diagnostic import Severity

N = 60
ENDS = {"a": 5, "b": 23, "c": 48}


def chain(seed=0):
    """Mass and stiffness of an uneven chain that is held at both ends."""
    rng = np.random.default_rng(seed)
    k = 1e6 * np.exp(rng.normal(0.0, 0.3, N + 1))
    stiffness = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
    return np.diag(0.1 * np.exp(rng.normal(0.0, 0.2, N))), stiffness


MASS, STIFFNESS = chain()
TRUE = np.sqrt(eigh(STIFFNESS, MASS, eigvals_only=True))


def reduced(modes):
    return ss.craig_bampton(MASS, STIFFNESS, ENDS, modes=modes)


def model(modes, damping=None):
    structure = reduced(modes).structure(ss.ModalDamping(0.005) if damping is None else damping)
    return ss.Model(
        structure, [ss.Jenkins("b", stiffness=1e6, slip_force=10.0)], [ss.Force("c", 1.0)]
    )


def said(result):
    return [one for one in result.diagnostics if one.code == "few-modes"]


ANALYSES = {
    "balance": lambda m, omega: ss.forced_response(m, [omega], harmonics=1),
    "orbits": lambda m, omega: ss.exact_response(m, [omega]),
    "transient": lambda m, omega: ss.transient(m, omega=omega, periods=2),
    "damper": lambda m, omega: ss.damper_curve(
        m, slip_force=[10.0], dof="c", omega=(0.99 * omega, 1.01 * omega), harmonics=1
    ),
}


@pytest.mark.parametrize("name", ANALYSES)
def test_an_excitation_beyond_the_accurate_modes_is_a_caution(name):
    limit = reduced(3).accurate_to
    assert not said(ANALYSES[name](model(3), 0.9 * limit))
    (one,) = said(ANALYSES[name](model(3), 1.2 * limit))
    assert one.severity is Severity.CAUTION
    assert one.data["limit"] == limit
    assert one.data["omega"] == pytest.approx(1.2 * limit, rel=0.02)
    assert "craig_bampton(..., omega=" in one.text
    assert not said(ANALYSES[name](model(20), 1.2 * limit))


def test_a_motion_by_itself_is_asked_for_its_frequency():
    for mode, expected in ((0, 0), (4, 1)):
        found = ss.nonlinear_modes(model(3), amplitude=[1e-6], mode=mode, harmonics=1)
        assert len(said(found)) == expected


def test_a_harmonic_of_the_forces_counts():
    limit = reduced(3).accurate_to
    third = model(3).replaced(forces=[ss.Force("c", 1.0, harmonic=3)])
    (one,) = said(ss.forced_response(third, [0.5 * limit], harmonics=3))
    assert one.data["omega"] == pytest.approx(1.5 * limit)
    assert one.text.startswith("The structure was reduced")
    assert "harmonic 3 of the forces" in one.text
    assert not said(ss.forced_response(third, [0.3 * limit], harmonics=3))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("modes", [2, 4, 8, 16])
def test_the_limit_follows_the_true_errors(seed, modes):
    """The estimate is compared with the natural frequencies of the full chain."""
    mass, stiffness = chain(seed)
    found = ss.craig_bampton(mass, stiffness, ENDS, modes=modes)
    own = np.sqrt(eigh(found.stiffness, found.mass, eigvals_only=True))
    error = own / np.sqrt(eigh(stiffness, mass, eigvals_only=True))[: own.size] - 1.0
    assert (error[own < found.accurate_to] < 0.0101).all()
    assert found.accurate_to < own[np.argmax(error > 0.0101)]
    first = int(np.argmax(error > 0.0099))
    assert found.accurate_to > own[first] * np.sqrt(0.01 / error[first]) * 0.7


def test_a_structure_that_keeps_all_modes_is_accurate_everywhere():
    mass, stiffness = MASS[:6, :6], STIFFNESS[:6, :6]
    whole = ss.craig_bampton(mass, stiffness, {"tip": 5}, modes=5)
    assert whole.accurate_to == np.inf
    assert ss.Structure(mass, stiffness).accurate_to == np.inf


def test_a_structure_that_is_statically_unstable_is_reduced_all_the_same():
    pulled = STIFFNESS.copy()
    pulled[5, 5] -= 1e8
    assert ss.craig_bampton(MASS, pulled, ENDS, modes=5).structure().unstable_dof == "a"


def test_rigid_motions_are_no_errors():
    free = STIFFNESS.copy()
    free[0, 0], free[-1, -1] = -free[0, 1], -free[-1, -2]
    found = ss.craig_bampton(MASS, free, ENDS, modes=12)
    elastic = np.sqrt(np.abs(eigh(free, MASS, eigvals_only=True)))[1]
    assert elastic < found.accurate_to < np.inf


def test_what_is_made_of_a_reduced_structure_is_no_more_accurate(tmp_path):
    own, other = model(3).structure, reduced(6).structure()
    limit = own.accurate_to
    assert limit < other.accurate_to
    joined = ss.join(
        {"1": own, "2": other, "3": ss.Structure([[1.0]], [[1e6]])},
        [ss.Coupling("1.a", "2.a", stiffness=1e3)],
    )
    disk = ss.BladedDisk(
        reduced(3).structure(ss.Rayleigh(stiffness=1e-6)),
        4,
        [ss.Coupling("a", stiffness=1e3)],
        forces=[ss.Force("c", 1.0)],
        engine_order=1,
    )
    blades = disk.mistuned([0.0, 0.01, 0.0, -0.01])
    made = [joined, disk.structure, blades.structure, copy.deepcopy(own)]
    fed = ss.destabilised(model(3), ss.ModalDamping(-0.001), 1.0)
    made.append(fed.structure)
    for one in made:
        assert one.accurate_to == limit
    for place, one in enumerate((model(3), disk, blades)):
        ss.forced_response(one, [0.5 * limit], harmonics=1).save(tmp_path / f"{place}.nc")
        assert ss.load(tmp_path / f"{place}.nc").model.structure.accurate_to == limit
    reduced(3).save(tmp_path / "reduction.nc")
    again = ss.Reduction.load(tmp_path / "reduction.nc")
    assert again.accurate_to == again.structure().accurate_to == limit

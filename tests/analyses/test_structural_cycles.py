"""Limit cycles of the beam pair with the dissertation's structure-like damper."""

import numpy as np
import pytest

import stickslip as ss


@pytest.fixture(scope="module")
def fed_pair():
    pair = ss.reference.damped_pair()
    free = pair.structure
    bare = ss.Structure(free.mass, free.stiffness, None, free.dofs)
    return ss.Model(bare, pair.contacts, []), ss.reference.negative_damping(free)


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "limit"), [(0, 51.5614), (1, 22.8755), (2, 88.5427)])
def test_exact_limit_cycles_are_followed_past_all_corners(fed_pair, mode, limit):
    # The balance finds 51.56125 (127 harmonics), 22.87541 and 88.54278 (63). Modes 0 and 2 lead
    # through motions of which a small change grows by more than 1e40 in a period.
    branch = ss.limit_cycles(*fed_pair, mode=mode, method="exact", stability=mode == 2)
    assert branch.limit.ratio == pytest.approx(limit, rel=1e-5)
    assert not any("Stalled" in text for text in branch.assumptions)
    assert branch.ratio[-1] < 0.05
    slipping = np.array(branch.branch) == "slipping"
    amplitude = branch.amplitude("1.tip")
    assert amplitude[slipping][-1] > 1e3 * amplitude[0]
    if mode == 2:
        assert np.nanmax(np.abs(branch.multipliers)) > 1e80
        # small multipliers are not lost in it: one of them passes 1 where the branch turns
        folds = [change.value for change in branch.changes if change.kind == "fold"]
        assert max(folds) == pytest.approx(branch.limit.ratio, rel=1e-9)


@pytest.mark.slow
def test_exact_limit_cycles_with_four_contacts_are_those_of_harmonic_balance(fed_pair):
    ratio = [4.5, 20.0, 60.0]
    exact = ss.limit_cycles(*fed_pair, mode=2, ratio=ratio, method="exact")
    balance = ss.limit_cycles(*fed_pair, mode=2, ratio=ratio, harmonics=31)
    assert np.array_equal(exact.ratio, balance.ratio)
    assert len(exact.ratio) == 12
    tip = exact.amplitude("1.tip")
    assert tip.max() > 4000 * tip.min()
    assert exact.omega == pytest.approx(balance.omega, rel=3e-3)
    assert tip == pytest.approx(balance.amplitude("1.tip"), rel=4e-3)
    # the orbit next to a balance has been found by another way, from other states
    largest = np.abs(exact.multipliers).max(axis=1)
    assert largest.max() > 1e80
    found = np.log(largest), np.log(np.abs(balance.multipliers).max(axis=1))
    assert found[0] == pytest.approx(found[1], rel=5e-3)


@pytest.mark.slow
def test_few_harmonics_are_followed_past_all_corners_too(fed_pair):
    # exact: 51.5614
    branch = ss.limit_cycles(*fed_pair, harmonics=5, stability=False)
    assert not any("Stalled" in text for text in branch.assumptions)
    assert branch.limit.ratio == pytest.approx(51.56, rel=0.05)
    assert branch.ratio[-1] == pytest.approx(0.01)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["newton", "exact"])
def test_a_structural_damper_of_two_contacts_is_a_jenkins_element(method):
    pair = ss.reference.damped_pair().structure
    bare = ss.Structure(pair.mass, pair.stiffness, None, pair.dofs)
    negative = ss.reference.negative_damping(pair)
    stiffness, ends = 2.4e6, ("1.tip", "2.tip")
    element = ss.Jenkins(*ends, stiffness=stiffness, slip_force=60.0)
    body = ss.StructuralDamper(
        ends, stiffness=stiffness * np.array([[1, -1], [-1, 1]]), slip_forces=[60.0, np.inf]
    )
    one, other = (
        ss.limit_cycles(model, negative, mode=1, method=method, harmonics=9, ratio=[4.0, 9.0])
        for model in (ss.Model(bare, [contact], []) for contact in (element, body))
    )
    assert (
        list(one.branch) == list(other.branch) == ["sticking", "sticking", "slipping", "slipping"]
    )
    np.testing.assert_allclose(other.omega, one.omega, rtol=1e-9)
    np.testing.assert_allclose(other.amplitude("1.tip"), one.amplitude("1.tip"), rtol=1e-9)
    largest = np.abs(one.multipliers).max(axis=1)
    np.testing.assert_allclose(np.abs(other.multipliers).max(axis=1), largest, rtol=1e-6)

"""Limit cycles at given ratios: those that there are, and what is said of the others."""

import numpy as np
import pytest

import stickslip as ss


@pytest.fixture(scope="module")
def mass():
    return ss.reference.flutter_mass()


def test_large_cycles_at_ratios_that_are_asked_for(mass):
    """They lie far beyond where a whole branch counts as going to infinity."""
    model, negative = mass
    ratios = [1e-6, 1e-5]
    lco = ss.limit_cycles(model, negative, ratio=ratios, stability=False)
    assert lco.ratio.tolist() == [*ratios, *ratios[::-1]]
    # Friction on a motion that hardly sticks loses 4 F A, the damping gains pi r c omega A^2.
    (contact,) = model.contacts
    omega = np.sqrt(model.structure.stiffness[0, 0] / model.structure.mass[0, 0])
    expected = 4.0 * contact.slip_force / (np.pi * -negative[0, 0] * omega * lco.ratio[2:])
    np.testing.assert_allclose(lco.amplitude("mass")[2:], expected, rtol=1e-4)


@pytest.mark.parametrize("method", ["newton", "exact"])
def test_ratios_beside_the_onset_are_on_the_branch(method):
    structure = ss.Structure([[1.0]], [[1e4]], [[0.5]], ["x"])
    model = ss.Model(structure, [ss.Jenkins("x", stiffness=1e4, slip_force=2.0)])
    lco = ss.limit_cycles(model, [[-0.5]], ratio=[1.001, 1.5], method=method, stability=False)
    assert lco.ratio.tolist() == [1.001, 1.5, 1.5, 1.001]
    assert "values-missed" not in {d.code for d in lco.diagnostics}
    below = ss.limit_cycles(model, [[-0.5]], ratio=[0.5], method=method, stability=False)
    assert below.ratio.size == 0
    (missed,) = (d for d in below.diagnostics if d.code == "values-missed")
    assert "goes on with larger motions than it was followed to" in missed.text


def test_values_that_a_branch_may_have_are_not_said_to_have_no_cycle(mass):
    """The walk ends by its number of points before it comes to the slipping side."""
    model, negative = mass
    lco = ss.limit_cycles(model, negative, ratio=[0.01, 4.9], max_points=12, stability=False)
    assert set(lco.ratio) == {0.01}
    (missed,) = (d for d in lco.diagnostics if d.code == "values-missed")
    assert "there may be some all the same" in missed.text
    (missed,) = (
        d
        for d in ss.limit_cycles(model, negative, ratio=[0.5, 9.0], stability=False).diagnostics
        if d.code == "values-missed"
    )
    assert "has no limit cycle at ratio = 9;" in missed.text

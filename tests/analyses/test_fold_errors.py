"""The errors of folds, which are judged as all other points are."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss


def two_masses(law, stiffness, slip_force):
    structure = ss.Structure(
        [[1.0, 0.0], [0.0, 0.4]],
        [[3.0, -1.0], [-1.0, 2.0]],
        [[0.06, -0.02], [-0.02, 0.05]],
        ["a", "b"],
    )
    friction = ss.Jenkins("b", stiffness=stiffness, slip_force=slip_force)
    return ss.Model(structure, [law, friction], [ss.Force("a", 0.5)])


CASES = {
    "hardening": (ss.Cubic("a", stiffness=2.63), 0.228, 0.05, (2.78, 1.15)),
    "stop": (ss.Stop("a", stiffness=26.3, gap=0.3), 0.151, 0.183, (3.93, 1.87)),
}


def size(frf, dof):
    return np.linalg.norm(frf.coefficients(dof)[:, 1:], axis=1)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_converged_points_keep_the_tolerance_at_folds_too(name, tolerance):
    law, stiffness, slip_force, span = CASES[name]
    model = two_masses(law, stiffness, slip_force)
    frf = ss.forced_response(model, span, tolerance=tolerance, stability=False)
    assert frf.folds.size > 0
    converged = np.array([status == "converged" for status in frf.status])
    assert converged[frf.folds].any()
    fine = ss.forced_response(model, span, 61, tolerance=1e-3, stability=False)
    for dof in frf.dofs:
        sizes = size(frf, dof)
        reference = np.maximum(sizes, 1e-3 * sizes.max())
        assert (frf.error_estimate(dof) <= tolerance * reference)[converged].all()
    # Their frequencies are those of many harmonics.
    for at in frf.folds[converged[frf.folds]]:
        nearest = fine.omega[fine.folds][np.abs(fine.omega[fine.folds] - frf.omega[at]).argmin()]
        assert frf.omega[at] == pytest.approx(nearest, rel=tolerance)


def test_the_error_of_a_fold_is_how_far_it_moves():
    """Duffing's equation in one harmonic: three move its upper fold by what is estimated."""
    structure = ss.Structure([[1.0]], [[1.0]], [[0.05]], ["a"])
    model = ss.Model(structure, [ss.Cubic("a", stiffness=1.0)], [ss.Force("a", 0.3)])
    one, many = (
        ss.forced_response(model, (0.5, 2.5), harmonics, stability=False) for harmonics in (1, 15)
    )
    upper, exact = one.folds[0], many.folds[0]
    estimate = one.error_estimate("a")[upper]
    third = np.abs(many.coefficients("a")[exact, 2:]).sum()
    moved = abs(many.omega[exact] / one.omega[upper] - 1.0) * size(one, "a")[upper]
    assert 0.5 * max(third, moved) < estimate < 3.0 * (third + moved)


def test_folds_among_points_of_other_harmonics_are_found():
    """Where the branch went over to fewer harmonics that did not pass beside it, one was not."""
    model = two_masses(ss.Stop("a", stiffness=74.13, gap=0.3), 7.828, 0.01562)
    frf = ss.forced_response(model, (0.3033, 1.977), tolerance=4.179e-3, stability=False)
    fine = ss.forced_response(model, (0.3033, 1.977), 61, tolerance=1e-3, stability=False)
    status = np.array([str(frf.status[at]) for at in frf.folds])
    assert (status == "converged").all()
    exact = fine.omega[fine.folds]
    for at in frf.folds:
        assert np.abs(exact / frf.omega[at] - 1.0).min() < 4.179e-3

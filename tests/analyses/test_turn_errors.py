"""Points beside a turn are judged across the way and need no more harmonics than others."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

#: Points on either side of a fold that are beside it, and those beyond to which they are compared.
BESIDE, BEYOND = 4, 14
TOLERANCE = 1e-3


@pytest.fixture(scope="module")
def model():
    """A mass against a stop, with sharp folds, and one on a slider."""
    structure = ss.Structure(
        [[1.0, 0.0], [0.0, 0.4]],
        [[3.0, -1.0], [-1.0, 2.0]],
        [[0.06, -0.02], [-0.02, 0.05]],
        ["a", "b"],
    )
    friction = ss.Jenkins("b", stiffness=0.151, slip_force=0.183)
    stop = ss.Stop("a", stiffness=26.3, gap=0.3)
    return ss.Model(structure, [stop, friction], [ss.Force("a", 0.5)])


@pytest.fixture(scope="module")
def curve(model):
    return ss.forced_response(model, (3.93, 1.87), tolerance=TOLERANCE, stability=False)


def test_points_beside_a_turn_need_no_more_harmonics_than_their_neighbours(curve):
    """The last fold and its neighbours took 27 harmonics, where 9 do a few points on."""
    levels = np.unique(curve.harmonics)
    assert curve.folds.size > 1
    for at in curve.folds:
        away = np.abs(np.arange(curve.omega.size) - at)
        beside = curve.harmonics[away <= BESIDE].max()
        beyond = curve.harmonics[(away > BESIDE) & (away <= BEYOND)].max()
        assert beside <= beyond, (at, beside, beyond, levels)


def motions(frf, dof, highest):
    series = frf.coefficients(dof)[:, 1 : highest + 1]
    missing = highest - series.shape[1]
    return np.pad(series, ((0, 0), (0, missing)))


def test_points_beside_a_turn_are_as_close_to_the_curve_of_many_harmonics(model, curve):
    fine = ss.forced_response(model, (3.93, 1.87), 61, tolerance=1e-5, stability=False)
    own, exact = (
        np.concatenate([motions(frf, dof, 61) for dof in ("a", "b")], axis=1)
        for frf in (curve, fine)
    )
    size = np.linalg.norm(own, axis=1)
    for at in curve.folds:
        for i in range(max(at - BESIDE, 0), min(at + BESIDE + 1, curve.omega.size)):
            # In the metric of the curve: the motion against its size, the frequency against itself.
            points = np.concatenate(
                [(exact - own[i]) / size[i], (fine.omega / curve.omega[i] - 1.0)[:, None]], axis=1
            )
            ways = np.diff(points, axis=0)
            lengths = np.maximum((np.abs(ways) ** 2).sum(1), 1e-300)
            along = -(ways.conj() * points[:-1]).sum(1).real / lengths
            nearest = points[:-1] + np.clip(along, 0.0, 1.0)[:, None] * ways
            assert np.linalg.norm(nearest, axis=1).min() < TOLERANCE, (at, i)

"""Curves of several solutions: folds, jumps and stability, against independent computation."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.model.state import State

sys.path.insert(0, str(Path(__file__).parents[1]))
from sprung import Balance, Sprung, chain, duffing, stopped

CASES = {
    "hardening": (duffing(1.0), (0.3, 4.0), 25, 2),
    "softening": (duffing(-0.05, load=0.12, damping=0.05), (1.5, 0.5), 15, 2),
    "stop": (stopped(), (0.5, 2.5), 25, 2),
    "interference": (stopped(gap=-0.2, load=0.6), (6.0, 2.0), 25, None),
    "chain hardening": (chain([("cubic", (1, None), 2.0)]), (0.4, 2.6), 15, None),
    "chain softening": (
        chain([("cubic", (0, 1), -0.3)], (0.25, 0.0, 0.0)),
        (1.4, 0.4),
        11,
        None,
    ),
    "chain stop": (chain([("stop", (2, None), 6.0, 0.8)]), (0.5, 1.6), 25, None),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.slow
def test_folds_are_those_of_a_fine_continuation(name):
    system, (start, stop), harmonics, count = CASES[name]
    expected, _ = Balance(system, harmonics).folds(start, stop)
    frf = ss.forced_response(system.model(), (start, stop), harmonics, stability=False)
    assert frf.converged.all()
    assert frf.folds.size == len(expected) == (count if count is not None else len(expected))
    assert frf.omega[-1] == stop or frf.omega[-1] == start
    balance = Balance(system, harmonics)
    for at, z in zip(frf.folds, expected, strict=True):
        assert frf.omega[at] == pytest.approx(z[-1], rel=1e-4)
        for dof, named in enumerate(frf.dofs):
            amplitude = balance.amplitude(z, dof)
            assert frf.amplitude(named)[at] == pytest.approx(amplitude, rel=1e-4)


def test_single_harmonic_folds_of_duffing_are_those_of_the_closed_form():
    alpha, load, damping = 1.0, 1.0, 0.1

    def square(a, side):
        k = 1.0 + 0.75 * alpha * a**2
        root = (load / a) ** 2 - damping**2 * k + 0.25 * damping**4
        return k - 0.5 * damping**2 + side * np.sqrt(root)

    def slope(a, side):
        return square(a + 1e-6, side) - square(a - 1e-6, side)

    frf = ss.forced_response(duffing(alpha).model(), (0.3, 4.0), 1)
    upper, lower = frf.folds
    # Upper fold on the falling side of the resonance near its top, lower one on the same side.
    for at, guess in ((upper, 3.3), (lower, 0.87)):
        a = brentq(slope, 0.99 * guess, 1.012 * guess if guess < 1 else 1.0003 * guess, args=(1.0,))
        assert frf.amplitude("x0")[at] == pytest.approx(a, rel=1e-5)
        assert frf.omega[at] == pytest.approx(np.sqrt(square(a, 1.0)), rel=1e-9)


@pytest.mark.parametrize("name", ["hardening", "softening", "stop"])
def test_sweeps_jump_at_the_folds_in_their_direction(name):
    system, span, harmonics, _ = CASES[name]
    model = system.model()
    curve = ss.forced_response(model, span, harmonics, stability=False)
    low, high = sorted(curve.omega[curve.folds])
    grid = np.linspace(*sorted(span), 120)
    for omega, expected in ((grid, high), (grid[::-1], low)):
        sweep = ss.forced_response(model, omega, harmonics)
        (jump,) = sweep.jumps
        before, after = sweep.omega[jump - 1], sweep.omega[jump]
        assert min(before, after) <= expected <= max(before, after)
        (told,) = [one for one in sweep.diagnostics if one.code == "jump"]
        assert ("upward" if omega[0] < omega[1] else "downward") in told.text
        assert (sweep.stability == "stable").sum() > 0.9 * sweep.omega.size


def test_jumps_whose_end_is_far_along_the_curve_are_told():
    """Around the fold the way is so long that where it ends is not known, but that it turns is."""
    structure = ss.Structure([[1.0]], [[1.0]], [[0.05]], ["x"])
    stop = ss.Stop("x", stiffness=20.0, gap=1.0)
    model = ss.Model(structure, [stop], [ss.Force("x", 0.2)])
    curve = ss.forced_response(model, (0.4, 3.2), 5, stability=False)
    sweep = ss.forced_response(model, np.linspace(0.4, 3.2, 113), 5)
    (jump,) = sweep.jumps
    last = curve.omega[curve.folds].max()
    assert sweep.omega[jump - 1] <= last <= sweep.omega[jump]
    assert [one.code for one in sweep.diagnostics].count("jump") == 1
    assert sweep.peak("x").amplitude <= curve.peak("x").amplitude


def test_steps_that_are_too_coarse_to_be_followed_are_told():
    """Between motions far apart it is not known whether the branch is left; close ones tell."""
    structure = ss.Structure(np.eye(2), 1e4 * np.eye(2), np.eye(2), ["x", "z"])
    plane = ss.Coulomb(
        ["x", "z"],
        normal=[0.0, 1.0],
        friction=0.3,
        tangential_stiffness=2e4,
        normal_stiffness=3e4,
        preload=1.0,
    )
    model = ss.Model(structure, [plane], [ss.Force("x", 20.0), ss.Force("z", 10.0, phase=1.0)])

    def told(points):
        sweep = ss.forced_response(model, np.linspace(60, 200, points), 5, stability=False)
        assert all(status is ss.Status.CONVERGED for status in sweep.status)
        found = (one for one in sweep.diagnostics if one.code in ("jump", "branch-unknown"))
        return sweep.omega, {one.code: one for one in found}

    omega, coarse = told(4)
    (unknown,) = coarse.values()
    assert unknown.code == "branch-unknown"
    assert unknown.severity == "note"
    assert unknown.data == {"steps": 1, "low": omega[1], "high": omega[2]}
    _, fine = told(57)
    assert list(fine) == ["jump"]


def state_of(frf, index):
    orders = np.arange(frf.coefficients("x0").shape[1])
    series = np.stack([frf.coefficients(dof)[index] for dof in frf.dofs])
    x = series.sum(axis=1).real
    v = (1j * orders * frf.omega[index] * series).sum(axis=1).real
    return np.concatenate([x, v])  # springs remember nothing


def drift(model, frf, index, periods, steps=400):
    """Return how far a push has grown at most, and at the end, over some periods of Runge-Kutta."""
    start = state_of(frf, index)
    pushed = start.copy()
    size = np.abs(start[: len(frf.dofs)]).max()
    pushed[: len(frf.dofs)] += 1e-4 * size * np.cos(1.0 + np.arange(len(frf.dofs)))
    runs = [
        ss.transient(
            model,
            omega=float(frf.omega[index]),
            periods=periods,
            scheme="rk4",
            steps=steps,
            samples=16,
            keep=1,
            start=State.of_vector(model, values),
        )
        for values in (start, pushed)
    ]
    ends = [run.arrays.poincare[:, : 2 * len(frf.dofs)] for run in runs]
    weights = np.repeat([1.0, 1.0 / frf.omega[index]], len(frf.dofs))
    apart = np.linalg.norm((ends[1] - ends[0]) * weights, axis=1)
    return apart.max() / apart[0], apart[-1] / apart[0]


def growth_of_closed_orbit(model, frf, index):
    """Return the largest multiplier of the orbit that shooting finds beside a motion, or None."""
    size = 2 * len(frf.dofs)

    def period(values):
        run = ss.transient(
            model,
            omega=float(frf.omega[index]),
            periods=1,
            scheme="rk4",
            steps=1000,
            samples=16,
            keep=1,
            start=State.of_vector(model, values),
        )
        return run.arrays.poincare[-1, :size]

    begun = state = state_of(frf, index)
    large = np.abs(begun).max()
    for _ in range(10):
        end = period(state)
        pushes = 1e-6 * large * np.eye(size)
        monodromy = np.stack([period(state + one) - end for one in pushes], axis=1) / (1e-6 * large)
        if np.abs(end - state).max() < 1e-7 * large:
            return np.abs(np.linalg.eigvals(monodromy)).max()
        state = state - np.linalg.solve(monodromy - np.eye(size), end - state)
        if np.abs(state - begun).max() > 0.05 * large:
            return None
    return None


@pytest.mark.parametrize("name", ["hardening", "softening", "stop"])
@pytest.mark.slow
def test_stable_motions_stay_and_unstable_ones_are_left(name):
    system, span, _, _ = CASES[name]
    model = system.model()
    frf = ss.forced_response(model, span, tolerance=1e-4)
    first, last = sorted(frf.folds)
    # Discarded harmonics move a fold: which side a point so close beside it is on, they decide.
    apart = np.min([np.abs(frf.omega / frf.omega[fold] - 1.0) for fold in (first, last)], axis=0)
    between = np.arange(first + 1, last)
    assert (frf.stability[between[apart[between] > 1e-5]] == "unstable").all()
    around = [at for fold in (first, last) for at in (fold - 1, fold + 1)]
    chosen = np.linspace(2, frf.omega.size - 3, 14).astype(int)
    for at in chosen:
        if at in around or at in frf.folds:
            continue
        # Beside a fold disturbances hardly grow, and take their time.
        for periods in (60, 240):
            most, left = drift(model, frf, at, periods)
            told = left < 0.5 if frf.stable[at] else most > 1.5
            if told:
                break
        assert told, (at, most, left)


def random_system(rng):
    size = int(rng.integers(1, 7))
    springs = rng.uniform(0.5, 3.0, size)
    stiffness = np.diag(springs + np.append(springs[1:], 0.0))
    stiffness -= np.diag(springs[1:], 1) + np.diag(springs[1:], -1)
    mass = np.diag(rng.uniform(0.5, 2.0, size))
    damping = rng.uniform(0.01, 0.04) * stiffness + rng.uniform(0.0, 0.05) * mass
    load = np.zeros(size)
    load[rng.integers(size)] = rng.uniform(0.1, 1.0)
    found = []
    for _ in range(int(rng.integers(1, 4))):
        one = int(rng.integers(size))
        other = None if one == 0 or rng.random() < 0.5 else one - 1
        if rng.random() < 0.5:
            found.append(("stop", (one, other), rng.uniform(1.0, 10.0), rng.uniform(-0.1, 0.8)))
        else:
            found.append(("cubic", (one, other), rng.uniform(-0.02, 1.0)))
    return Sprung(mass, damping, stiffness, load, found)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(24))
def test_random_systems_are_followed_and_judged(seed):
    rng = np.random.default_rng(seed)
    system = random_system(rng)
    model = system.model()
    frf = ss.forced_response(model, (0.3, 2.5), 21)
    assert frf.arrays.solved.all()
    ended = [one for one in frf.diagnostics if one.code == "branch-end"]
    assert ended or frf.omega[frf.branch == 0][-1] == 2.5
    assert not ended, ended[0].text
    balance = Balance(system, 21)
    for at in np.linspace(0, frf.omega.size - 1, 12).astype(int):
        z = balance.of_response(frf, at)
        assert np.linalg.norm(balance.residual(z, slope=False)) < 1e-5 * np.linalg.norm(system.load)
    known, doubtful = 0, 0
    for at in rng.choice(frf.omega.size, 5, replace=False):
        growth = growth_of_closed_orbit(model, frf, int(at))
        if frf.stable[at] is None or growth is None or abs(growth - 1.0) < 2e-3:
            doubtful += 1
            continue
        known += 1
        assert frf.stable[at] == (growth < 1.0), (seed, at, growth)
    assert known >= doubtful


@pytest.mark.parametrize("stiffness", [1e6, 1e7])
def test_converged_points_along_a_range_are_balanced_at_rigid_stops(stiffness):
    structure = ss.Structure([[1.0]], [[1.0]], [[0.05]], ["a"])
    stop = ss.Stop("a", stiffness=stiffness, gap=3.5)
    model = ss.Model(structure, [stop], [ss.Force("a", 1.0)])
    frf = ss.forced_response(model, (0.5, 1.3), 5, stability=False)
    assert frf.folds.size > 0
    assert frf.converged.mean() > 0.95
    assert frf.residual[frf.converged].max() <= 1e-8


def hardening_chain():
    size, dofs = 5, [f"x{number}" for number in range(1, 6)]
    stiffness = 2.0 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1)
    structure = ss.Structure(np.eye(size), stiffness, ss.ModalDamping(3e-4), dofs)
    omega = ss.natural_frequencies(ss.Model(structure, []))
    model = ss.Model(structure, [ss.Cubic("x2", stiffness=1e-3)], [ss.Force("x1", 0.1)])
    return model, (0.9 * omega[0], 1.2 * omega[2])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "omega", "harmonics", "tolerance", "folds"),
    [
        # The third mode has a node at the spring.
        (*hardening_chain(), 3, 1e-3, 4),
        (duffing(1.0).model(), (0.3, 4.0), 5, 1e-6, 2),
    ],
    ids=["light damping", "fine tolerance"],
)
def test_steps_that_the_tolerance_shortens_do_not_end_a_range(
    model, omega, harmonics, tolerance, folds
):
    options = {"tolerance": tolerance, "stability": False}
    frf = ss.forced_response(model, omega, harmonics, **options)
    assert frf.omega[-1] == omega[1]
    assert frf.converged.all()
    assert frf.folds.size == folds

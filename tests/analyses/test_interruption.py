"""Interruption and progress of forced responses: what was computed is kept."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from rubbing import beam_response, one_dof
from slow_law import Slow
from stickslip.reference import snecma_beam
from stickslip.results.arrays import Arrays


@pytest.fixture(scope="module")
def frf():
    return beam_response()


class StopAt:
    """A progress callback that presses Ctrl-C."""

    def __init__(self, share):
        self.share = share

    def __call__(self, done):
        if done > self.share:
            raise KeyboardInterrupt


def interrupted(omega, **options):
    with pytest.raises(ss.Interrupted, match="interrupted after") as caught:
        ss.forced_response(snecma_beam(), omega, progress=StopAt(0.0), **options)
    return caught.value.result


def test_interruption_keeps_what_was_computed():
    omega = np.linspace(180, 200, 20000)
    partial = interrupted(omega, harmonics=21)
    done = partial.omega.size
    assert partial.interrupted
    assert 0 < done < 20000
    assert partial.converged.all()
    np.testing.assert_array_equal(partial.omega, omega[:done])
    assert partial.coefficients("tip").shape == (done, 22)
    assert partial.peak("tip").omega <= partial.omega.max()
    assert any(f"after {done} of 20000 frequencies, at" in text for text in partial.assumptions)


def test_interrupted_orbits_have_no_gap():
    """Pieces of a sweep are worked on at the same time: what lies behind a gap is left out."""
    omega = np.linspace(150, 250, 6000)
    with pytest.raises(ss.Interrupted) as caught:
        ss.exact_response(snecma_beam(), omega, progress=StopAt(0.0))
    partial = caught.value.result
    done = partial.omega.size
    assert 0 < done < 6000
    np.testing.assert_array_equal(partial.omega, omega[:done])


def test_interruption_of_a_range():
    partial = interrupted((150.0, 250.0), tolerance=1e-7)
    assert partial.arrays.solved.all()
    assert partial.omega[-1] < 250.0
    assert any(f"end at {partial.omega[-1]:.6g} rad/s" in text for text in partial.assumptions)
    assert not any("between 150 and 250" in text for text in partial.assumptions)


@pytest.mark.slow
def test_a_first_point_without_a_solution_does_not_lose_the_others(monkeypatch):
    """What is left to itself has put its points aside, whether they are solved or not."""
    structure = ss.Structure([[1.0]], [[4e4]], dofs=["tip"])
    model = ss.Model(structure, [Slow(["tip"])], [ss.Force("tip", 10.0)])
    omega = np.array([np.sqrt(4.1e4) / 3.0, *range(90, 110)])

    monkeypatch.setattr(Slow, "pause", 1e-4)

    def press(done):
        if done > 0.5:
            monkeypatch.setattr(Slow, "pause", 1.5)
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted) as caught:
        ss.forced_response(model, omega, 3, progress=press)
    partial = caught.value.result
    assert 5 < partial.omega.size < omega.size
    assert not partial.converged[0]
    assert partial.converged[1:].all()


def test_an_interruption_can_be_pickled(frf):
    again = pickle.loads(pickle.dumps(ss.Interrupted("after 2 points", frf)))
    assert isinstance(again, ss.Interrupted)
    assert str(again) == "after 2 points"
    np.testing.assert_array_equal(again.result.omega, frf.omega)


def test_interruption_before_the_first_point():
    """Nothing of a result without any solution fails, though there is nothing in it."""
    model, n = one_dof(), 3
    empty = Arrays(
        omega=np.ones(n),
        harmonics=np.zeros(n, int),
        samples=np.zeros(n, int),
        status=np.full(n, 3, np.uint8),
        residual=np.full(n, np.nan),
        iterations=np.zeros(n, int),
        displacement=np.full((n, 2, 1), np.nan + 0j),
        contact_displacement=np.full((n, 2, 1), np.nan + 0j),
        contact_force=np.full((n, 2, 1), np.nan + 0j),
        error_estimate=np.full((n, 1), np.nan),
        sampling_error=np.full((n, 1), np.nan),
        slip_fraction=np.full((n, 1), np.nan),
        dissipation=np.full((n, 1), np.nan),
        fold=np.zeros(n, np.bool_),
        jump=np.zeros(n, np.bool_),
        further=np.zeros(n, np.bool_),
        stability=np.full(n, 2, np.uint8),
        lower=np.full((n, 1), np.nan),
        upper=np.full((n, 1), np.nan),
        unique=np.zeros(n, np.uint8),
        guaranteed=np.zeros(n, np.bool_),
    )
    frf = replace(ss.forced_response(model, [1.0], 1), arrays=empty, interrupted=True)
    assert np.isnan(frf.amplitude("x")).all()
    assert np.isnan(frf.phase("x")).all()
    assert frf.summary() == []
    assert "0 solved" in repr(frf)


def test_a_failing_progress_callback_is_not_an_interruption():
    def fail(_):
        raise RuntimeError("bar broke")

    with pytest.raises(RuntimeError, match="bar broke"):
        ss.forced_response(snecma_beam(), [190.0], 3, progress=fail)


@pytest.mark.slow
def test_progress_ends_at_one():
    shares = []
    ss.forced_response(snecma_beam(), np.linspace(180, 200, 3000), 15, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_static_loads_that_take_long_hear_ctrl_c(ctrl_c, monkeypatch):
    structure = ss.Structure([[1.0]], [[4e4]], dofs=["tip"])
    model = ss.Model(structure, [Slow(["tip"])], [ss.Force("tip", 10.0, harmonic=0)])
    monkeypatch.setattr(Slow, "pause", 30.0)
    ctrl_c(0.05)
    with pytest.raises(KeyboardInterrupt):
        ss.static_response(model)

"""Ctrl-C is heard while results are put together and saved; what is left to itself is kept."""

import os
import signal
import time

import numpy as np
import pytest

import stickslip as ss
from rubbing import one_dof
from slow_law import Slow
from stickslip.interruption import Interruption
from stickslip.reference import snecma_beam
from stickslip.results import netcdf
from stickslip.results.arrays import Arrays

pytestmark = pytest.mark.timeout(60)


def slow_body(*contacts):
    structure = ss.Structure([[1.0]], [[4e4]], dofs=["tip"])
    return ss.Model(structure, [Slow(["tip"]), *contacts], [ss.Force("tip", 10.0)])


def modes(progress, **options):
    return ss.nonlinear_modes(
        slow_body(), mode=0, amplitude=(1e-5, 1.0), harmonics=15, progress=progress, **options
    )


def cycles(progress):
    model = slow_body(ss.Jenkins("tip", stiffness=1e4, slip_force=1.0))
    return ss.limit_cycles(model, [[-1.0]], mode=0, harmonics=15, progress=progress)


@pytest.mark.slow
@pytest.mark.parametrize(
    "analysis", [modes, lambda progress: modes(progress, residual="bounds"), cycles]
)
def test_steps_that_hear_nobody_lose_nothing(analysis, monkeypatch):
    """The step goes on by itself; who asks for the result waits for its end."""
    told, pressed = [], []

    def press(share):
        told.append(share)
        if np.count_nonzero(told) == 4:
            Slow.pauses.clear()
            monkeypatch.setattr(Slow, "pause", 1.5)
            assert Slow.pauses.wait(10.0)
            pressed.append(time.monotonic())
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match="interrupted after some") as caught:
        analysis(press)
    assert time.monotonic() - pressed[0] < 1.0
    monkeypatch.setattr(Slow, "pause", 0.0)
    assert caught.value.result.interrupted
    assert caught.value.result.omega.size > 0


@pytest.mark.slow
def test_a_step_before_the_first_point_has_nothing_to_keep(monkeypatch):
    monkeypatch.setattr(Slow, "pause", 30.0)

    def press(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="nothing was computed yet"):
        modes(press)


@pytest.mark.parametrize("analysis", [ss.forced_response, ss.single_harmonic])
def test_a_stop_does_not_wait_until_its_result_is_put_together(analysis, monkeypatch):
    made, of = [], Arrays.of
    monkeypatch.setattr(Arrays, "of", lambda solution: made.append(1) or of(solution))

    def press(share):
        if share > 0.0:
            raise KeyboardInterrupt

    omega = np.linspace(150, 250, 200_000)
    with pytest.raises(ss.Interrupted, match=r"interrupted after \d+ of 200000 points") as caught:
        analysis(snecma_beam(), omega, progress=press)
    assert not made
    partial = caught.value.result
    assert 0 < partial.omega.size < omega.size
    np.testing.assert_array_equal(partial.omega, omega[: partial.omega.size])
    assert f"after {partial.omega.size} of" in str(caught.value)
    assert caught.value.result is partial
    assert len(made) == 1


def test_a_campbell_diagram_keeps_the_speeds_that_are_complete():
    pressed = []

    def build(speed):
        if len(pressed) == 4:
            raise KeyboardInterrupt
        pressed.append(speed)
        return one_dof()

    with pytest.raises(ss.Interrupted, match="after 4 of 9 speeds") as caught:
        ss.campbell(build, speed=np.linspace(1.0, 9.0, 9), orders=[1])
    partial = caught.value.result
    assert partial.interrupted
    np.testing.assert_array_equal(partial.speed, pressed)


@pytest.fixture(scope="module")
def large():
    return ss.forced_response(one_dof(), np.linspace(0.5, 1.5, 60_000), 9)


@pytest.mark.slow
def test_no_signal_is_lost_while_a_file_is_saved_or_read(large, tmp_path, ctrl_c):
    """HDF5 calls Python back, where an exception is passed over."""
    file = tmp_path / "large.nc"
    begin = time.monotonic()
    large.save(file)
    saving = time.monotonic() - begin
    ss.load(file)

    def pressed(work, delay):
        ctrl_c(delay)
        work()
        time.sleep(saving + 1.0)

    for work in (lambda: large.save(tmp_path / "other.nc"), lambda: ss.load(file)):
        for share in np.linspace(0.02, 0.9, 12):
            with pytest.raises(KeyboardInterrupt):
                pressed(work, share * saving)
    whole = [one for one in tmp_path.iterdir() if ss.load(one).omega.size == large.omega.size]
    assert whole == list(tmp_path.iterdir())


def test_a_signal_ends_saving_unless_a_block_around_lets_it_wait(large, tmp_path, monkeypatch):
    written, presses = netcdf._written, []

    def writing(*arguments, **options):
        if presses:
            os.kill(os.getpid(), presses.pop())
        return written(*arguments, **options)

    monkeypatch.setattr(netcdf, "_written", writing)
    presses.append(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        large.save(tmp_path / "ended.nc")
    presses.append(signal.SIGINT)
    saved = []

    def save_within():
        with Interruption():
            large.save(tmp_path / "whole.nc")
            saved.append("whole")

    with pytest.raises(KeyboardInterrupt):
        save_within()
    assert saved == ["whole"]
    assert [one.name for one in tmp_path.iterdir()] == ["whole.nc"]
    assert ss.load(tmp_path / "whole.nc").omega.size == large.omega.size

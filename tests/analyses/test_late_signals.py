"""Signals that come when all is computed: at any line up to the end of an analysis it is kept."""

import os
import signal
import sys
import threading
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core
from stickslip.analyses import prediction, side_by_side, speed_response
from stickslip.analyses.side_by_side import in_turn, whole
from stickslip.interruption import Interruption

PACKAGE = str(Path(ss.__file__).parent)
LEAVING = Interruption.__exit__.__code__


@pytest.fixture(scope="module")
def model():
    structure = ss.Structure(
        np.eye(2), [[1100.0, -100.0], [-100.0, 1100.0]], ss.ModalDamping(0.01), ["a", "b"]
    )
    model = ss.Model(
        structure, [ss.Jenkins("a", stiffness=500.0, slip_force=0.5)], [ss.Force("b", 1.2)]
    )
    assert model.problem is not None  # It is made once, before lines are counted.
    return model


STUDY = """
name = "pair"
[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[1100.0, -100.0], [-100.0, 1100.0]]
dofs = ["a", "b"]
[[force]]
dof = "b"
amplitude = 1.2
[analysis]
kind = "forced-response"
omega = [20.0, 30.0]
harmonics = 3
levels = [1.0, 2.0, 4.0]
"""

ANALYSES = {
    "forced_response": lambda model: ss.forced_response(model, [30.0, 33.0], 3),
    "exact_response": lambda model: ss.exact_response(model, [30.0]),
    "transient": lambda model: ss.transient(model, 30.0, 3),
    "damper_curve": lambda model: ss.damper_curve(
        model, slip_force=[0.5, 1.0], dof="a", omega=(25.0, 40.0)
    ),
    "static_response": lambda model: ss.static_response(model),
    "single_harmonic": lambda model: ss.single_harmonic(model, [30.0, 33.0]),
    "limit_cycles": lambda model: ss.limit_cycles(model, -np.eye(2), mode=0, harmonics=3),
    "nonlinear_mode": lambda model: ss.nonlinear_modes(
        model, mode=0, amplitude=[1e-3, 1e-2], harmonics=3, residual="bounds"
    ),
}


def lines_behind(core, call, at, monkeypatch):
    """Call an analysis; press Ctrl-C at a line behind the core's work, before its block is left.

    Returns what became of it, None if there is no such line.
    """
    work, lines, pressed = getattr(_core, core), count(), []

    def worked(*arguments):
        found = work(*arguments)
        sys.settrace(trace)
        frame = sys._getframe(1)
        while frame is not None:
            frame.f_trace, frame = trace, frame.f_back
        return found

    def trace(frame, event, _):
        if not frame.f_code.co_filename.startswith(PACKAGE):
            return None
        if frame.f_code is LEAVING and event == "return":
            sys.settrace(None)
        elif not pressed and event == "line" and next(lines) == at:
            pressed.append(frame.f_lineno)
            signal.raise_signal(signal.SIGINT)
        return trace

    before = sys.gettrace()
    with monkeypatch.context() as patch:
        patch.setattr(_core, core, worked)
        try:
            call()
        except ss.Interrupted as stop:
            return stop.result
        finally:
            sys.settrace(before)
    assert not pressed, "the signal was lost"
    return None


@pytest.mark.slow
@pytest.mark.parametrize("core", ANALYSES)
def test_a_signal_at_any_line_behind_the_core_keeps_the_result(core, model, ctrl_c, monkeypatch):
    call = partial(ANALYSES[core], model)
    whole = call()
    behind = count()
    while lines_behind(core, call, 50 * next(behind), monkeypatch) is not None:
        pass
    last = 50 * next(behind)
    assert last > 200
    # Where it has been left no line has it any more: the last ones are all looked at.
    found = [lines_behind(core, call, at, monkeypatch) for at in range(last - 150, last)]
    kept = [one for one in found if one is not None]
    assert len(kept) > 20
    for one in kept:
        assert not one.interrupted
        assert type(one) is type(whole)


def test_a_signal_while_a_sweep_is_put_together_keeps_it(model, ctrl_c, monkeypatch):
    made = ss.Sweep.of

    def making(*arguments, **others):
        os.kill(os.getpid(), signal.SIGINT)
        return made(*arguments, **others)

    monkeypatch.setattr(ss.Sweep, "of", making)
    with pytest.raises(ss.Interrupted, match="when all was computed") as caught:
        ss.sweep(model, lambda one: ss.forced_response(one, [30.0], 3), slip_force=[0.5, 1.0])
    assert len(caught.value.result.results) == 2


def test_work_that_is_complete_when_it_hears_of_the_end_does_not_pass_over_it(model, monkeypatch):
    core = _core.forced_response

    def deaf(*arguments):
        found = core(*arguments)
        with suppress(KeyboardInterrupt):
            arguments[5](0.9)
        return found

    def press(share):
        if share == 0.9:
            raise KeyboardInterrupt

    monkeypatch.setattr(_core, "forced_response", deaf)
    with pytest.raises(ss.Interrupted, match="when all was computed") as caught:
        ss.forced_response(model, [30.0, 33.0], 3, progress=press)
    assert caught.value.complete
    assert not caught.value.result.interrupted


def test_a_signal_that_python_passes_over_is_heeded_later(ctrl_c):
    class Passing:
        def __del__(self):
            with suppress(KeyboardInterrupt):  # as Python does
                signal.raise_signal(signal.SIGINT)

    reached = []

    def within():
        with Interruption() as watch:
            with watch.at_once():
                passing = Passing()
                del passing
                reached.append("behind")
                watch(0.5)
            reached.append("lost")

    with pytest.raises(KeyboardInterrupt):
        within()
    assert reached == ["behind"]


SEVERAL = {
    "sweep": lambda model, stopped: ss.sweep(model, stopped, slip_force=[0.5, 1.0]),
    "speed response": lambda model, _: ss.speed_response(
        model, dof="a", speed=[30.0, 33.0], engine_order=1
    ),
    "fit": lambda model, _: ss.fit(
        model,
        [ss.Measurement([30.0, 33.0], "a", [1e-3, 1e-3])],
        parameters={"slip_force": (0.1, 1.0)},
    ),
}


@pytest.mark.parametrize("kind", SEVERAL)
def test_a_part_of_the_first_value_is_not_taken_for_the_whole(kind, model, monkeypatch):
    part = replace(ss.forced_response(model, [30.0], 3), interrupted=True)

    def stopped(*_, **__):
        raise ss.Interrupted("stopped", part)

    monkeypatch.setattr(speed_response, "begun_with", stopped)
    monkeypatch.setattr(prediction, "forced_response", stopped)
    with pytest.raises(KeyboardInterrupt, match=f"{kind} interrupted before") as caught:
        SEVERAL[kind](model, stopped)
    assert not isinstance(caught.value, ss.Interrupted)


def test_a_value_that_was_complete_when_a_signal_came_is_kept(model):
    def late(one):
        raise ss.Interrupted("late", ss.forced_response(one, [30.0], 3))

    with pytest.raises(ss.Interrupted) as caught:
        ss.sweep(model, late, slip_force=[0.5, 1.0])
    assert len(caught.value.result.results) == 1


def test_a_part_that_was_complete_when_it_heard_of_the_end_is_whole(model, monkeypatch):
    complete = ss.forced_response(model, [30.0], 3)

    def late():
        raise ss.Interrupted("late", complete)

    def partly():
        raise ss.Interrupted("stopped", replace(complete, interrupted=True))

    monkeypatch.setattr(side_by_side, "processors", lambda: 2)
    found = in_turn([lambda _: whole(late), lambda _: whole(partly)], None)
    assert next(found) is complete
    with pytest.raises(ss.Interrupted):
        next(found)
    # In the thread of the caller nobody else knows that it was interrupted.
    with pytest.raises(ss.Interrupted):
        whole(late)


@pytest.mark.parametrize("where", ["between", "behind"])
def test_a_signal_between_or_behind_speeds_keeps_them(where, model, ctrl_c, monkeypatch):
    name = {"between": "_last_motion", "behind": "told"}[where]
    own = getattr(speed_response, name)

    def pressing(found, *others):
        if found:
            os.kill(os.getpid(), signal.SIGINT)
        return own(found, *others)

    monkeypatch.setattr(speed_response, name, pressing)
    with pytest.raises(ss.Interrupted) as caught:
        ss.speed_response(model, dof="a", speed=[30.0, 33.0, 36.0], engine_order=1)
    kept = caught.value.result
    assert kept.interrupted == (where == "between")
    assert kept.speed.size == (2 if where == "between" else 3)


def test_what_later_parts_have_come_to_is_not_lost(monkeypatch):
    """The first part was complete when the end came; the one beside it keeps what it has."""
    monkeypatch.setattr(side_by_side, "processors", lambda: 2)
    begun, ended = threading.Event(), threading.Event()

    def first(_):
        assert begun.wait(50)
        assert ended.wait(50)
        return "first"

    def second(progress):
        begun.set()
        try:
            while True:
                progress(0.5)
        except KeyboardInterrupt:
            raise ss.Interrupted("stopped", "half") from None

    def press(_):
        if begun.is_set():
            ended.set()
            raise KeyboardInterrupt

    found = in_turn([first, second], press)
    assert next(found) == "first"
    with pytest.raises(ss.Interrupted) as caught:
        next(found)
    assert caught.value.result == "half"


@pytest.mark.parametrize("first", ["nothing", "a part", "all"])
def test_a_run_saves_what_all_levels_have_come_to(first, model, tmp_path, monkeypatch):
    """Whatever the first has, the level beside it is saved."""
    from typer.testing import CliRunner

    from stickslip.cli import app
    from stickslip.study import Study

    def interrupted(result):
        raise ss.Interrupted("stopped", replace(result, interrupted=True))

    begun = threading.Event()

    def computed(study, case, progress, shown):
        result = ss.forced_response(case.model, [30.0], 3)
        if case.level == 1.0:
            assert begun.wait(50)
        begun.set()
        try:
            while True:
                progress(0.5)
        except KeyboardInterrupt:
            if case.level == 2.0 or first == "a part":
                interrupted(result)
            if first == "nothing":
                raise
        return result

    def press(study, watch):
        def pressed(share):
            if begun.is_set():
                raise KeyboardInterrupt

        return own(study, pressed)

    own = Study.run
    monkeypatch.setattr(side_by_side, "processors", lambda: 2)
    monkeypatch.setattr(Study, "_result", computed)
    monkeypatch.setattr(Study, "run", press)
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    done = CliRunner().invoke(app, ["run", "study.toml", "--no-plot"])
    assert done.exit_code == 130
    names = {file.name: ss.load(file).interrupted for file in Path("results").iterdir()}
    expected = {"nothing": {}, "a part": {"pair-1-partial.nc": True}, "all": {"pair-1.nc": False}}
    assert names == expected[first] | {"pair-2-partial.nc": True}
    count = int(first == "all")
    assert f"interrupted: {count} of 3 curves complete in results, the next" in done.stderr
    assert all(name in done.stderr for name, part in names.items() if part)


def test_a_certified_curve_is_saved_before_it_is_shown(model, tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from stickslip.cli import app, console

    def press(_):
        raise KeyboardInterrupt

    file = tmp_path / "curve.nc"
    ss.forced_response(model, [30.0, 33.0], 3).save(file)
    monkeypatch.setattr(console, "show_all", press)
    assert CliRunner().invoke(app, ["certify", str(file), "--points", "all"]).exit_code == 130
    assert ss.load(file).certificate is not None

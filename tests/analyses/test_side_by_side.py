"""Parts of a work at the same time: their order, their numbers, their end."""

import os
import signal
import threading
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses import side_by_side
from stickslip.analyses.run import Progress
from stickslip.analyses.side_by_side import in_turn
from stickslip.study import Study

STUDY = """
name = "study"
[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[5e4, -2e4], [-2e4, 2e4]]
damping = { modal = 0.003 }
dofs = ["a", "b"]
[[contact]]
law = "jenkins"
dof = "b"
stiffness = 1e4
slip_force = 2.0
[[force]]
dof = "a"
amplitude = 1.0

"""
LEVELS = """
[analysis]
kind = "forced-response"
omega = SPAN
harmonics = 9
levels = [0.5, 1, 2, 4, 8]
"""
SWEEP = """
[analysis]
kind = "forced-response"
omega = [80, 90, 100]
harmonics = 9
[sweep]
slip_force = [0.5, 1.0, 2.0, 4.0]
"""


def read(rest: str) -> Study:
    return Study.parse(STUDY + rest, folder=Path())


def threads(monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    monkeypatch.setattr(side_by_side, "processors", lambda: count)


def flutter() -> tuple[ss.Model, np.ndarray]:
    structure = ss.Structure(
        np.eye(2), [[5e4, -2e4], [-2e4, 2e4]], ss.ModalDamping(0.003), ["a", "b"]
    )
    model = ss.Model(structure, [ss.Jenkins("b", stiffness=1e4, slip_force=2.0)])
    return model, -0.5 * np.eye(2)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_parts_come_in_their_order_from_as_many_threads(
    monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    threads(monkeypatch, count)
    seen, told, all_at_work = set(), [], threading.Barrier(count)

    def part(number: int, progress: Progress) -> int:
        seen.add(threading.get_ident())
        if number < count:
            all_at_work.wait()
        time.sleep(0.02 * (7 - number))
        assert progress is not None
        progress(1.0)
        return number

    assert list(in_turn([partial(part, number) for number in range(7)], told.append)) == [*range(7)]
    assert len(seen) == count
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_what_a_part_raises_comes_in_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    threads(monkeypatch, 2)

    def part(number: int, _: Progress) -> int:
        if number == 2:
            raise ss.ModelError("no")
        return number

    found = in_turn([partial(part, number) for number in range(5)], None)
    assert [next(found), next(found)] == [0, 1]
    with pytest.raises(ss.ModelError, match="no"):
        next(found)


@pytest.mark.slow
def test_numbers_are_the_same_with_any_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    model, negative = flutter()
    disk = ss.BladedDisk(
        model.structure,
        sectors=5,
        couplings=[ss.Coupling("a", stiffness=1e3)],
        contacts=model.contacts,
        engine_order=0,
    )
    found = []
    for count in (1, 2, 3):
        threads(monkeypatch, count)
        curves = list(read(LEVELS.replace("SPAN", "[80, 85, 90, 95, 100, 240]")).run())
        chart = ss.stability_map(model, negative, stiffness=[5e3, 1e4, 2e4, 4e4, 8e4])
        waves = ss.flutter_map(disk, ss.AerodynamicDamping(ratio=[-0.001] * 5), harmonics=5)
        (sweep,) = read(SWEEP).run()
        found.append(
            (
                *(curve.coefficients("a") for curve in curves),
                *(one.coefficients("b") for one in sweep.results),
                chart.limit,
                chart.omega,
                chart.stable_limit,
                waves.omega,
                waves.disk_ratio,
                np.array([one.amplitude for one in waves.cycles()]),
                np.array([waves.counters["evaluations"]]),
            )
        )
    for other in found[1:]:
        for one, two in zip(found[0], other, strict=True):
            np.testing.assert_array_equal(one, two)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 3])
def test_ctrl_c_keeps_the_levels_that_are_complete(
    monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    threads(monkeypatch, count)
    study = read(LEVELS.replace("SPAN", "{ from = 50, to = 300, points = 60000 }"))
    found = study.run()
    whole = [next(found)]
    timer = threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt) as caught:
        whole.extend(found)
    assert len(whole) < 5
    assert all(curve.status[-1].solved for curve in whole)
    # It may have been complete when the signal came.
    if isinstance(caught.value, ss.Interrupted):
        part = caught.value.result
        assert part.interrupted == (part.omega.size < 60000)


@pytest.mark.parametrize(
    ("study", "told"), [(LEVELS, "5 times, 2 at once,"), (SWEEP, "4 times, 2 at once,")]
)
def test_results_kept_together_are_reckoned_together(
    monkeypatch: pytest.MonkeyPatch, study: str, told: str
) -> None:
    """Each of them alone has room enough."""
    threads(monkeypatch, 2)
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**6)
    many = "{ from = 50, to = 300, points = 150 }"
    study = study.replace("SPAN", many).replace("[80, 90, 100]", many)
    one = study.replace("[0.5, 1, 2, 4, 8]", "[1]").replace("[0.5, 1.0, 2.0, 4.0]", "[1.0]")
    (alone,) = read(one).run()
    assert alone is not None
    with pytest.raises(ss.ModelError, match=f"{told} needs .* GB of the 0.001 GB of memory"):
        next(iter(read(study).run()))
    # What comes after them is not one of them.
    (again,) = read(one).run()
    assert again is not None

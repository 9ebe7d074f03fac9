"""Stable, unstable, not decided: three states in arrays, figures, tables, reports and files."""

import io
import json
from functools import partial

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

import stickslip as ss
from stickslip import plot
from stickslip.html.figures import drawn
from stickslip.results.stability import stability_of
from stickslip.views.cycles import CycleView
from wedges import ENDS, WEDGE

K = np.array([[1e4, -1e4], [-1e4, 1e4]])


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def self_excited(**options):
    structure = ss.Structure([[1.0]], [[1e4]], [[0.1]], ["a"])
    model = ss.Model(structure, [ss.Jenkins("a", stiffness=4e3, slip_force=2.0)])
    return ss.limit_cycles(model, [[-0.6]], mode=0, harmonics=5, **options)


@pytest.fixture(scope="module")
def undecided():
    return self_excited(stability=False)


@pytest.fixture(scope="module")
def whole():
    return self_excited()


def test_what_is_not_computed_is_not_decided(undecided):
    assert undecided.omega.size > 3
    assert all(one is None for one in undecided.stable)
    assert (undecided.stability == "not decided").all()
    assert f"{undecided.omega.size} not decided" in repr(undecided)
    assert "Stability is not decided: it was left out." in undecided.assumptions


def test_a_wave_is_not_decided():
    blade = ss.Structure([[1.0]], [[4e4]], [[0.2]], ["tip"])
    damper = ss.Jenkins("tip", stiffness=1e4, slip_force=1.0)
    disk = ss.BladedDisk(blade, 6, contacts=[damper], engine_order=2)
    wave = ss.limit_cycles(disk, [[-0.6]], ratio=[0.5], harmonics=5)
    assert wave.stable.tolist() == [None] * wave.omega.size != []
    ax = plot.limit_cycles(wave, "tip", ax=Figure().add_subplot())
    assert "not decided" in legend(ax)
    assert {line.get_marker() for line in ax.lines if line.get_xdata().size} == {"x"}


def test_decided_cycles_are_true_and_false(whole):
    assert {True, False} <= set(whole.stable.tolist()) <= {True, False, None}
    np.testing.assert_array_equal(whole.stable == True, whole.stability == "stable")  # noqa: E712
    size = np.abs(whole.multipliers).max(axis=1)
    np.testing.assert_array_equal(whole.stability == "unstable", size > 1.0 + 1e-10)


def test_lines_say_what_is_decided(undecided, whole):
    ax = plot.limit_cycles([whole, undecided], "a", ax=Figure().add_subplot())
    assert legend(ax)[-3:] == ["stable", "unstable", "not decided"]
    assert {line.get_linestyle() for line in ax.lines} == {"-", "--", ":", "None"}


@pytest.mark.slow
def test_reports_say_what_is_decided(undecided, whole):
    found = drawn(partial(plot.limit_cycles, [whole, undecided], "a"))
    dashes = {
        trace["name"]: trace["line"]["dash"]
        for trace in json.loads(found.data)["data"]
        if trace.get("name") in {"stable", "unstable", "not decided"}
    }
    assert (dashes["stable"], dashes["not decided"]) == ("solid", "dot")
    assert "px" in dashes["unstable"]


def test_tables_say_what_is_decided(undecided, whole):
    for result, words in ((undecided, {"not decided"}), (whole, {"yes", "no"})):
        screen = Console(file=io.StringIO(), width=200)
        for table in CycleView().tables([("x", result)], "", ["a"], "m"):
            screen.print(table)
        assert all(word in screen.file.getvalue() for word in words)
        assert ("not decided" in screen.file.getvalue()) == (result is undecided)
    facts = dict(CycleView().facts(undecided)[:-1])
    assert facts["stability"] == f"{undecided.omega.size} not decided"


@pytest.mark.slow
def test_files_have_flags(undecided, whole, tmp_path):
    for result, flag in ((undecided, -1), (whole, 1)):
        dataset = result.to_dataset()
        stored = dataset["stable"]
        assert stored.dtype == np.int8
        assert stored.attrs["flag_values"].tolist() == [1, 0, -1]
        assert stored.attrs["flag_meanings"] == "stable unstable not_decided"
        assert flag in stored.values
        result.save(tmp_path / "lco.nc")
        again = ss.load(tmp_path / "lco.nc")
        assert again.stable.tolist() == result.stable.tolist()


def test_files_of_the_first_version_load(undecided, tmp_path):
    """They hold a truth value per cycle: without multipliers it says nothing."""
    dataset = undecided.to_dataset()
    dataset["stable"] = ("cycle", np.zeros(undecided.omega.size, dtype=bool))
    again = ss.LimitCycles.from_dataset(dataset, undecided.model)
    assert again.stable.tolist() == [None] * undecided.omega.size


def floating(contacts, damping):
    structure = ss.Structure(np.eye(2), K, damping, ["a", "b"])
    return ss.Model(structure, contacts, [ss.Force("b", 20.0)])


GROUND = ss.Jenkins("a", stiffness=1e3, slip_force=1.0)
BETWEEN = ss.Jenkins("a", "b", stiffness=1e3, slip_force=1.0)
HELD = ss.Jenkins("a", stiffness=1e3, slip_force=1e6)
ABSOLUTE, RELATIVE = ss.Rayleigh(mass=0.1, stiffness=1e-4), ss.Rayleigh(stiffness=1e-4)


@pytest.mark.parametrize(
    ("contacts", "damping", "neutral"),
    [
        ([GROUND], RELATIVE, 1),  # a shift
        ([GROUND], ABSOLUTE, 1),
        ([BETWEEN], RELATIVE, 2),  # a shift and a momentum: a Jordan block
        ([BETWEEN], None, 2),
        ([BETWEEN], ABSOLUTE, 1),  # the momentum decays
        ([BETWEEN, HELD], RELATIVE, 1),  # held by the contact that never slips: its own force
        ([], RELATIVE, 2),
    ],
)
def test_drift_of_a_floating_structure_is_no_instability(contacts, damping, neutral):
    exact = ss.exact_response(floating(contacts, damping), [90.0, 150.0])
    assert exact.converged.all()
    assert exact.stable.tolist() == [True, True]
    assert exact.neutral.tolist() == [neutral, neutral]
    for multipliers in exact.multipliers:
        np.testing.assert_array_equal(multipliers[:neutral], 1.0)
        assert np.abs(multipliers[neutral:]).max() < 1.0 - 1e-6


def test_rotations_are_neutral_too():
    """A free beam in the plane: a contact to the ground at one end and one along it."""
    stiff = 1e5 * np.array([[1.0, -2.0, 1.0], [-2.0, 4.0, -2.0], [1.0, -2.0, 1.0]])
    structure = ss.Structure(np.eye(3), stiff, ss.Rayleigh(stiffness=2e-5), ["a", "b", "c"])
    pad = ss.Jenkins("a", stiffness=1e4, slip_force=1.0)
    model = ss.Model(structure, [pad], [ss.Force("b", 30.0)])
    (slips,) = ss.exact_response(model, [300.0]).neutral
    # Two shifts; the rotation about the pad keeps its momentum.
    assert slips == 3
    exact = ss.exact_response(model.scaled(slip_force=1e6), [300.0])
    # The pad's force, and position and momentum of the rotation about it.
    assert exact.neutral.tolist() == [3]
    assert exact.stable.tolist() == [True]


def test_slow_decay_is_not_neutral():
    """A multiplier close to 1 of a structure that is held is counted."""
    slow = np.array([[1e4 + 1e-3, -1e4], [-1e4, 1e4]])
    structure = ss.Structure(np.eye(2), slow, [[1e-4, 0], [0, 0]], ["a", "b"])
    exact = ss.exact_response(ss.Model(structure, [BETWEEN], [ss.Force("b", 20.0)]), [90.0])
    assert exact.neutral.tolist() == [0]
    assert exact.stable.tolist() == [True]
    assert 1e-8 < 1.0 - np.abs(exact.multipliers).max() < 1e-3


def test_rounding_decides_nothing():
    """Without damping and slip all multipliers lie on the unit circle."""
    exact = ss.exact_response(floating([HELD], None), [60.0, 90.0, 130.0])
    assert exact.converged.all()
    assert exact.stable.tolist() == [None, None, None]


def test_orbits_that_are_not_found_are_not_decided():
    oscillator = ss.Structure([[2.0]], [[8.0]], dofs=["tip"])
    damper = ss.Jenkins("tip", stiffness=10.0, slip_force=1.0)
    exact = ss.exact_response(ss.Model(oscillator, [damper], [ss.Force("tip", 100.0)]), [2.0])
    assert exact.stable.tolist() == [None]
    assert exact.to_dataset()["stable"].values.tolist() == [-1]


def test_unstable_orbits_are_dashed():
    structure = ss.Structure([[1.0]], [[4.0]], [[-0.01]], ["x"])
    exact = ss.exact_response(ss.Model(structure, forces=[ss.Force("x", 1.0)]), [1.0, 1.5, 3.0])
    assert exact.stable.tolist() == [False] * 3
    ax = plot.curves(exact, "x", ax=Figure().add_subplot())
    assert "unstable" in legend(ax)
    assert "--" in {line.get_linestyle() for line in ax.lines if line.get_gid() == "response"}


@pytest.mark.parametrize(
    ("multipliers", "neutral", "known", "state"),
    [
        ([1.0, 0.5, 0.1], 1, True, "stable"),
        ([1.0, 1.5, 0.1], 1, True, "unstable"),
        ([1.0, 0.5, 0.1], 0, True, "not decided"),
        ([0.6 + 0.8j, 0.6 - 0.8j, 0.0], 0, True, "not decided"),
        ([1.0, 1.0, 1.0], 3, True, "stable"),
        ([np.nan, np.nan, np.nan], 0, False, "not decided"),
    ],
)
def test_states_follow_from_multipliers(multipliers, neutral, known, state):
    found = stability_of(np.array([multipliers], complex), np.array([neutral]), np.array([known]))
    assert found.tolist() == [state]


def told_of(result):
    return {one.code: one for one in result.diagnostics}


def test_limits_that_are_touched_leave_it_open_and_that_is_told():
    """Forces out of phase press the wedge until one face slips no more."""
    soft, stiff = (
        ss.Structure(10.0 * np.eye(2), [[a, -b], [-b, a]], 100.0 * np.eye(2), ["x", "y"])
        for a, b in ((4e5, 3e5), (1e6, 9e5))
    )
    forces = [ss.Force("left.x", 200.0), ss.Force("right.x", 200.0, phase=np.pi)]
    model, omega = WEDGE.between(stiff, soft, **ENDS, forces=forces), [290.0, 305.0]
    for result in (ss.exact_response(model, omega), ss.forced_response(model, omega, 15)):
        assert result.stability.tolist() == ["unstable", "not decided"]
        told = told_of(result)
        assert told["unstable"].data["points"] == 1
        assert told["stability-undecided"].data["points"] == 1
        assert "touches its limit" in told["stability-undecided"].text
    plain = ss.forced_response(model, omega, 15, stability=False)
    assert told_of(plain)["stability-undecided"].text.endswith("it was left out.")


def test_motions_that_nothing_damps_leave_it_open_and_that_is_told():
    undamped = ss.Structure([[1.0]], [[1.0]], [[0.0]], ["x"])
    stuck = ss.Jenkins("x", stiffness=1.0, slip_force=10.0)
    model = ss.Model(undamped, [stuck], [ss.Force("x", 1.0)])
    exact, balance = ss.exact_response(model, [0.5]), ss.forced_response(model, [0.5], 3)
    assert [exact.stable[0], balance.stable[0]] == [None, None]
    assert "1 to rounding" in told_of(exact)["stability-undecided"].text
    assert "exact_response has multipliers" in told_of(balance)["stability-undecided"].text
    damped = model.with_structure(ss.Structure([[1.0]], [[1.0]], [[0.1]], ["x"]))
    for result in (ss.exact_response(damped, [0.5]), ss.forced_response(damped, [0.5], 3)):
        assert result.stable[0] is True
        assert "stability-undecided" not in told_of(result)


def test_an_unstable_motion_has_another_one_beside_it_and_that_is_told():
    """Transients settle 5 % below the motion of the curve."""
    left, right = (
        ss.Structure(np.diag(mass), [[a, -b], [-b, c]], np.diag(damping), ["x", "y"])
        for mass, (a, b, c), damping in (
            ([10.89, 7.38], (7.79e5, 4.525e5, 1.086e6), [56.6, 103.0]),
            ([6.31, 8.38], (5.036e5, 2.529e5, 9.814e5), [193.4, 123.5]),
        )
    )
    wedge = ss.WedgeDamper(
        angle=(27.84, 35.05),
        mass=0.4276,
        friction=0.3465,
        tangential_stiffness=3.425e5,
        normal_stiffness=6.576e5,
        load=256.0,
    )
    forces = [ss.Force("left.x", 141.0), ss.Force("right.x", 141.0, phase=4.096)]
    model = wedge.between(left, right, **ENDS, forces=forces)
    for result in (
        ss.forced_response(model, [309.717], 15, residual="bounds"),
        ss.exact_response(model, [309.717], residual="bounds"),
    ):
        assert result.unique.tolist() == ["yes"]
        assert result.stable.tolist() == [False]
        assert told_of(result)["other-motion"].data["points"] == 1


def test_contacts_decide_how_many_harmonics_stability_takes():
    """The observed DOF is right to 1.4e-4 with 7 harmonics, the contact is not, and not stable."""
    mass = [0.724, 1.24, 0.881, 0.414, 1.04, 2.16]
    stiffness = np.diag([3005.0, 11016, 12072, 5919, 5279, 932])
    for i, j, spring in [(0, 1, 845), (1, 2, 8773), (1, 4, 1374), (2, 3, 2923), (3, 4, 2761)]:
        stiffness[i, j] = stiffness[j, i] = -spring
    stiffness[4, 5] = stiffness[5, 4] = -765
    names = [f"d{i}" for i in range(6)]
    structure = ss.Structure(np.diag(mass), stiffness, ss.ModalDamping(0.004575), names)
    contact = ss.Coulomb(
        ["d3", "d5"],
        ["d0", "d2"],
        normal=(-0.9987, -0.051),
        friction=0.483,
        tangential_stiffness=1023.0,
        normal_stiffness=1914.0,
        preload=0.757,
    )
    model = ss.Model(structure, [contact], [ss.Force("d0", 10.49)])
    exact = ss.exact_response(model, [13.1775])
    few = ss.forced_response(model, [13.1775], observe=["d0"])
    assert few.harmonics[0] < 13
    assert few.amplitude("d0") == pytest.approx(exact.amplitude("d0"), rel=3e-4)
    assert [exact.stable[0], few.stable[0]] == [False, False]

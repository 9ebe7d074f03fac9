"""What free motions lead to: the dissertation's starts, separatrices, and starts by the hundred."""

import pickle
from dataclasses import fields

import numpy as np
import pytest

import stickslip as ss
from stickslip import plot
from stickslip.reference import DAMPER_SLIP_FORCE, beam_pair, beam_ring, single_dof, snecma_beam
from stickslip.results.fate_arrays import Reason

NEGATIVE = ss.Rayleigh(mass=-7.49, stiffness=-2.6e-5)

# Guillen (1999), Table 5.2: displacements [m]
STARTS = (
    {"damper": 1e-5, "tip": 1e-3, "mode": 1e-5},
    {"damper": 1e-5, "tip": 1e-5, "mode": 3e-4},
    {"damper": 1e-6, "tip": 1e-6, "mode": 1e-5},
)

# computed independently: sticking amplitude and frequency, slipping amplitude of the single DOF
SINGLE = {
    0.1: (1.0310896e-5, 225.38065, 2.5423978e-3),
    1.0: (1.0909294e-5, 224.01322, 2.4383235e-4),
    3.0: (1.2959006e-5, 216.70029, 7.0556856e-5),
    5.0: (1.9544597e-5, 197.41295, 2.8865970e-5),
}


def undamped(model):
    structure = model.structure
    bare = ss.Structure(structure.mass, structure.stiffness, None, structure.dofs)
    return ss.Model(bare, model.contacts)


def beam(ratio):
    return ss.destabilised(undamped(snecma_beam()), NEGATIVE, ratio)


def mass(ratio):
    return ss.destabilised(undamped(single_dof()), [[-7699.054]], ratio)


@pytest.mark.parametrize("ratio", SINGLE)
def test_the_slipping_limit_cycle_is_the_separatrix(ratio):
    sticking, omega, slipping = SINGLE[ratio]
    model = mass(ratio)
    # at the top of the limit cycle the damper is at its limit
    top = [
        ss.State(model, [share * slipping], contact_force=[DAMPER_SLIP_FORCE])
        for share in (0.99, 1.01)
    ]
    inside, outside = (ss.classify(model, one) for one in top)
    assert (inside.motion, inside.mode, inside.reason) == ("settled", 0, "closed")
    assert inside.amplitude("mass") == pytest.approx(sticking, rel=1e-6)
    assert inside.omega == pytest.approx(omega, rel=1e-6)
    assert inside.share == pytest.approx(1.0)
    assert (outside.motion, outside.mode, outside.reason) == ("unbounded", None, "outgrown")
    assert np.isnan(outside.amplitude("mass"))
    assert not len(outside.tail)


def test_what_is_outgrown_does_grow_and_friction_is_what_it_lacks():
    model = mass(3.0)
    outside = ss.classify(model, {"mass": 1e-4})
    # the run ends where growth is certain, long before it is seen
    grown = ss.transient(model, 160.0, 12, start=outside.final)
    sizes = grown.amplitudes("mass")
    assert (np.diff(sizes) > 0.0).all()
    held = ss.Model(model.structure, [ss.Jenkins("mass", stiffness=2.4e7, slip_force=2460.48)])
    assert ss.classify(held, {"mass": 1e-4}).motion == "settled"


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.14, 0.15])
def test_table_5_2_leads_to_the_three_modes(ratio):
    model = beam(ratio)
    motions = [ss.classify(model, start) for start in STARTS]
    assert [motion.motion for motion in motions] == ["settled"] * 3
    assert [motion.mode for motion in motions] == [0, 1, 2]
    assert all(motion.share > 0.99 for motion in motions)
    for motion, stuck in zip(motions, ss.natural_frequencies(model), strict=True):
        assert 0.99 * stuck < motion.omega < stuck


@pytest.mark.slow
def test_table_5_2_at_a_tenth():
    model = beam(0.1)
    first, second, third = (ss.classify(model, start, periods=1000) for start in STARTS)
    # about mode 0 there is a torus: its amplitude swings within a percent, sidebands at 17.1 Hz
    assert (first.motion, first.mode) == ("aperiodic", 0)
    assert first.share > 0.999
    assert first.lines("mode", 1)[0].frequency == pytest.approx(225.6 / 2 / np.pi, rel=1e-3)
    assert [(m.motion, m.mode) for m in (second, third)] == [("settled", 1), ("settled", 2)]
    assert second.omega == pytest.approx(1403.96, rel=1e-5)
    # the orbit by another road: the exact flow closes after a period of this length
    orbit = ss.transient(model, third.omega, 1, start=third.final)
    assert orbit.change[0] < 1e-6


def test_by_two_and_a_half_everything_goes_to_mode_two():
    model = beam(2.5)
    result = ss.basin_map(model, starts=STARTS)
    assert [str(one) for one in result.outcomes] == ["settled, mode 2"]
    assert np.ptp(result.omega) < 1e-5 * result.omega[0]
    assert result.shape == (3,)


@pytest.mark.slow
def test_the_motion_of_figure_5_24_is_aperiodic():
    model = beam(0.361)
    # unsigned amplitudes of the slipping orbit of mode 3 at this ratio, by one harmonic:
    # pi c omega U = 4 F_d (1 - F_d / (k_d U)) phi^2
    from scipy.linalg import eigh

    structure = model.structure
    squares, shapes = eigh(structure.stiffness, structure.mass)
    shape, omega = shapes[:, 2], np.sqrt(squares[2])
    damping = 0.361 * (7.49 + 2.6e-5 * squares[2])
    top = 1.0
    for _ in range(60):
        balance = 1.0 - DAMPER_SLIP_FORCE / (2.4e7 * top)
        top = 4.0 * DAMPER_SLIP_FORCE * shape[0] ** 2 * balance / (np.pi * damping * omega)
    start = ss.State(model, 0.98 * top * np.abs(shape / shape[0]))
    motion = ss.classify(model, start)
    assert (motion.motion, motion.mode, motion.reason) == ("aperiodic", 0, "wanders")
    assert np.isnan(motion.omega)
    found = [line.frequency for line in motion.lines("mode", 5)]
    for expected in (36.0, 179.5, 221.8, 251.3):
        assert min(abs(one - expected) for one in found) < 0.25
    # the strongest line carries the motion, and lines are no stronger than it
    strongest = motion.lines("mode", 1)[0]
    assert strongest.amplitude == pytest.approx(4.6e-5, rel=0.03)
    assert strongest.amplitude < motion.amplitude("mode")


def test_damped_motions_die_away():
    structure = snecma_beam().structure
    damped = ss.Model(structure, snecma_beam().contacts)
    motion = ss.classify(damped, {"tip": 1e-3})
    assert (motion.motion, motion.reason, motion.mode) == ("decaying", "held", None)
    # held for good: what comes after is without slip
    after = ss.transient(damped, 225.0, 50, start=motion.final)
    assert not len(after.events)
    light = ss.Model(
        ss.Structure(structure.mass, structure.stiffness, ss.ModalDamping(1e-6), structure.dofs)
    )
    slow = ss.classify(light, {"tip": 1e-3}, periods=40)
    assert (slow.motion, slow.reason) == ("decaying", "held")


@pytest.mark.slow
def test_rest_stays_at_rest_and_the_smallest_push_leaves_it():
    model = beam(1.0)
    assert ss.classify(model, {}).motion == "decaying"
    assert ss.classify(model, {"tip": 1e-9}).motion == "settled"


def test_a_short_span_is_undecided_with_a_remedy():
    model = mass(0.1)
    motion = ss.classify(model, {"mass": 1e-3}, periods=60)
    assert (motion.motion, motion.reason) == ("undecided", "falling")
    assert "start=result.final" in motion.reason.advice
    rest = ss.classify(model, motion.final)
    assert rest.motion == "settled"
    growing = ss.classify(mass(0.1), {"mass": 1e-7}, periods=60)
    assert growing.reason == "growing"
    settling = ss.classify(mass(5.0), {"mass": 2.2e-5}, periods=30, tolerance=1e-9)
    assert settling.reason in ("settling", "falling")


def test_a_free_contact_and_one_that_never_slips():
    """Without friction negative damping wins; a spring beside the damper changes no class."""
    model = mass(1.0)
    loose = ss.Model(model.structure, [ss.Jenkins("mass", stiffness=2.4e7, slip_force=0.0)])
    assert ss.classify(loose, {"mass": 1e-6}).motion == "unbounded"
    spring = ss.Jenkins("mass", stiffness=1e6, slip_force=np.inf)
    held = ss.Model(model.structure, [*model.contacts, spring])
    stiff = ss.Structure(
        model.structure.mass,
        model.structure.stiffness + 1e6,
        model.structure.damping,
        model.structure.dofs,
    )
    same = ss.Model(stiff, model.contacts)
    for size, expected in ((1e-4, "settled"), (4e-4, "unbounded")):
        one = ss.classify(held, ss.State(held, [size], contact_force=[0.0, 1e6 * size]))
        other = ss.classify(same, {"mass": size})
        assert one.motion == other.motion == expected
        assert one.time == pytest.approx(other.time, rel=1e-9)


@pytest.mark.slow
def test_a_map_agrees_with_its_starts_one_by_one():
    model = beam(0.15)
    axes = {2: np.linspace(0.0, 4e-4, 4), "tip": np.linspace(-1e-3, 2e-3, 3)}
    chart = ss.basin_map(model, axes, base={"damper": 1e-6}, periods=200, threads=2, observe="mode")
    assert chart.shape == (4, 3)
    assert chart.amplitude("mode").shape == (4, 3)
    for row in range(4):
        for column in range(3):
            one = ss.classify(model, chart.start(row, column), periods=200)
            assert one.motion == chart.motion[3 * row + column]
            assert one.mode == (None if chart.mode[row, column] < 0 else chart.mode[row, column])
    again = ss.basin_map(model, axes, base={"damper": 1e-6}, periods=200, threads=1, observe="mode")
    for entry in fields(chart.arrays):
        mine, theirs = (getattr(each.arrays, entry.name) for each in (chart, again))
        np.testing.assert_array_equal(mine, theirs)
    # the amplitude of a mode is its largest displacement
    assert np.abs(chart.start(3, 1).displacement - chart.start(0, 1).displacement).max() == (
        pytest.approx(4e-4)
    )
    assert sum(chart.outcomes.values()) == len(chart) == 12


@pytest.fixture(scope="module")
def chart():
    axes = {"tip": np.linspace(0.0, 1e-3, 3), "mode": [0.0, 3e-4]}
    return ss.basin_map(beam(2.5), axes)


@pytest.mark.slow
def test_files_and_pickles_give_it_back(chart, tmp_path):
    motion = ss.classify(beam(2.5), STARTS[1], observe="mode")
    for result in (chart, motion):
        result.save(tmp_path / "it.nc")
        again = ss.load(tmp_path / "it.nc")
        for other in (again, pickle.loads(pickle.dumps(result))):
            assert type(other) is type(result)
            assert other.settings == result.settings
            assert other.assumptions == result.assumptions
            assert repr(other) == repr(result)
            for entry in fields(result.arrays):
                mine, theirs = (getattr(one.arrays, entry.name) for one in (result, other))
                assert mine.tobytes() == theirs.tobytes()
        assert all(one.attrs["units"] for one in result.to_dataset().variables.values())
    assert again.lines("mode") == motion.lines("mode")
    assert again.tail.tobytes() == motion.tail.tobytes()
    assert ss.classify(again.model, again.final).mode == motion.mode


@pytest.mark.slow
def test_pictures(chart):
    ax = chart.plot(length_unit="mm")
    labels = [one.get_text() for one in ax.get_legend().get_texts()]
    assert sum(int(label.split("(")[1][:-1]) for label in labels) == 6
    assert ax.get_xlabel() == "start of mode [mm]"
    mesh = ax.collections[0]
    np.testing.assert_array_equal(mesh.get_array(), chart.codes)
    motion = ss.classify(beam(2.5), STARTS[1])
    drawn = motion.plot("mode", most=3)
    assert drawn.get_yscale() == "log"
    listed = ss.basin_map(beam(2.5), starts=[STARTS[0]])
    with pytest.raises(ss.ModelError, match="without axes"):
        plot.basins(listed)
    with pytest.raises(ss.ModelError, match="is not a BasinMap"):
        plot.basins(motion)


def test_a_map_drawn_from_falling_values_is_turned(chart):
    turned = ss.basin_map(chart.model, {"tip": [1e-3, 5e-4, 0.0], "mode": [3e-4, 0.0]})
    ax = turned.plot()
    drawn = ax.collections[0].get_array()
    np.testing.assert_array_equal(drawn, turned.codes[::-1, ::-1])


@pytest.mark.slow
def test_a_mistuned_disk_is_followed_as_a_whole():
    disk = beam_ring(sectors=3, coupling=1e5).mistuned(0.02 * np.array([1.0, -1.0, 0.5]))
    driven = ss.destabilised(disk, ss.Rayleigh(mass=-3 * 7.49, stiffness=-3 * 2.6e-5))
    motion = ss.classify(driven, {"0.tip": 1e-4}, periods=100)
    assert motion.motion in ("settled", "aperiodic", "undecided")
    assert not motion.model.forces
    assert motion.mode is not None
    with pytest.raises(ss.ModelError, match=r"disk\.mistuned"):
        ss.classify(beam_ring(), {"tip": 1e-3})


def test_forces_are_left_out_and_it_is_said():
    motion = ss.classify(beam_pair(), {beam_pair().structure.dofs[0]: 1e-5})
    assert any("left out" in text for text in motion.assumptions)
    assert motion.motion == "decaying"


@pytest.mark.slow
def test_forced_analyses_of_negative_damping_say_that_solutions_may_be_several():
    model = ss.destabilised(snecma_beam(), NEGATIVE, 3.0)
    said = "damping is negative for some motion"
    curve = ss.forced_response(model, [190.0, 200.0], 3)
    orbits = ss.exact_response(model, [190.0])
    run = ss.transient(model, 190.0, 2)
    dampers = ss.damper_curve(
        model, dof="tip", slip_force=[200.0], omega=(150.0, 250.0), harmonics=3
    )
    for result in (curve, orbits, run, dampers):
        assert any(said in text for text in result.assumptions)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda m: ss.classify(m, {"tpi": 1.0}), "did you mean 'tip'"),
        (lambda m: ss.classify(m, [1.0]), "is no state"),
        (lambda m: ss.classify(m, {}, periods=3), "periods"),
        (lambda m: ss.classify(m, {}, tolerance=0.0), "tolerance: 0"),
        (lambda m: ss.classify(m, {"tip": np.nan}), "tip"),
        (lambda m: ss.classify(1, {}), "is not a Model"),
        (lambda m: ss.basin_map(m), "neither is given"),
        (lambda m: ss.basin_map(m, {"tip": [0.0]}), "1 axes; give two"),
        (lambda m: ss.basin_map(m, {"tip": [0.0], 3: [1.0]}), "mode 3; there are 3"),
        (lambda m: ss.basin_map(m, {"tip": [0.0], "tpi": [1.0]}), "did you mean 'tip'"),
        (lambda m: ss.basin_map(m, {"tip": [], 0: [1.0]}), "finite numbers"),
        (lambda m: ss.basin_map(m, {"tip": ["a"], 0: [1.0]}), "no real numbers"),
        (lambda m: ss.basin_map(m, starts=[]), "starts: empty"),
        (lambda m: ss.basin_map(m, starts=[{}, 3]), r"starts\[1\]"),
        (lambda m: ss.basin_map(m, starts=[{}], base={}), "base"),
        (lambda m: ss.basin_map(m, starts=[{}], threads=0), "threads"),
        (lambda m: ss.destabilised(m, np.eye(2)), "2 x 2, but the structure has 3"),
        (lambda m: ss.destabilised(m, NEGATIVE, np.inf), "ratio"),
        (lambda m: ss.destabilised(3, NEGATIVE), "is not a Model"),
        (lambda m: ss.classify(ss.Model(ss.Structure([[1.0]], [[0.0]])), {"0": 1.0}), "oscillates"),
    ],
)
def test_nonsense_is_refused(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call(beam(1.0))


def test_every_reason_has_a_class_and_advice():
    assert [reason.code for reason in Reason] == list(range(len(Reason)))
    for reason in Reason:
        assert reason.motion
        assert reason.advice.endswith(".")


@pytest.mark.slow
@pytest.mark.timeout(60)
def test_ctrl_c_keeps_what_was_decided(ctrl_c):
    model = beam(0.2)
    starts = [STARTS[2]] + [STARTS[1]] * 200
    ctrl_c(0.6)
    with pytest.raises(ss.Interrupted) as caught:
        ss.basin_map(model, starts=starts, periods=20_000)
    result = caught.value.result
    assert result.interrupted
    assert result.reason[0] == "closed"
    assert result.reason[-1] == "interrupted"
    assert result.motion[-1] == "undecided"

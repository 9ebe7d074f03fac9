"""Transients: settled amplitudes, states, spectra, and how a run ends."""

import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import beam_pair, snecma_beam


@pytest.fixture(scope="module")
def run():
    return ss.transient(snecma_beam(), 170.0, 60)


def one_dof(damping=0.4, force=0.5, slip_force=1.0):
    structure = ss.Structure([[2.0]], [[8.0]], [[damping]], ["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=slip_force)
    return ss.Model(structure, [contact], [ss.Force("x", force)])


def assert_close(one, other):
    """The core goes through modal coordinates, which leaves rounding."""
    for name in ("displacement", "velocity", "contact_force"):
        mine, theirs = getattr(one, name), getattr(other, name)
        np.testing.assert_allclose(mine, theirs, atol=1e-12 * np.abs(theirs).max())


# ---------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("options", "close"),
    [({}, 1e-8), ({"scheme": "rk4", "steps": 8000}, 1e-6)],
    ids=["exact", "rk4"],
)
def test_the_settled_amplitudes_are_those_of_the_orbit(options, close):
    run = ss.transient(snecma_beam(25.0), 200.0, tolerance=1e-10, **options)
    assert run.status == "settled"
    assert run.settled
    assert run.periods < 200
    # Guillen (1999), Fig 4.2, computed anew
    assert run.amplitude("damper") == pytest.approx(1.01597422e-4, rel=close)
    assert run.amplitude("tip") == pytest.approx(1.57188600e-3, rel=close)


def test_without_contacts_it_is_the_closed_form():
    structure = ss.Structure([[1.0]], [[4.0]], [[0.2]], ["x"])
    run = ss.transient(ss.Model(structure), 3.0, 5, start={"x": 1.0})
    decay, turn = 0.1, np.sqrt(4.0 - 0.01)
    t = run.time
    expected = np.exp(-decay * t) * (np.cos(turn * t) + decay / turn * np.sin(turn * t))
    np.testing.assert_allclose(run.displacement("x"), expected, atol=1e-12)
    slope = -np.exp(-decay * t) * 4.0 / turn * np.sin(turn * t)
    np.testing.assert_allclose(run.velocity("x"), slope, atol=1e-11)


# ---------------------------------------------------------------------------------- interface


def test_shapes(run):
    n = 60 * 128 + 1
    assert run.time.shape == run.displacement("tip").shape == run.velocity("mode").shape == (n,)
    assert run.contact_force(0).shape == run.contact_displacement("jenkins").shape == (n, 1)
    assert run.contact_force((0, 0)).shape == (n,)
    assert run.change.shape == run.amplitudes("tip").shape == (60,)
    assert [part.shape for part in run.poincare("tip")] == [(61,), (61,)]
    assert run.time[-1] == pytest.approx(60 * run.period)
    assert run.period == pytest.approx(2 * np.pi / 170.0)
    assert run.kept_periods == run.periods == 60
    assert repr(run) == "Transient(60 periods at 170 rad/s (completed), 3 dofs, scheme='exact')"
    np.testing.assert_array_equal(run.contact_displacement((0, 0)), run.displacement("damper"))
    for array in (run.time, run.displacement("tip"), run.change, run.amplitudes("tip")):
        assert not array.flags.writeable
    assert np.abs(run.contact_force(0)).max() == 246.048


def test_poincare_samples_are_states_of_the_history(run):
    x, v = run.poincare("tip")
    np.testing.assert_allclose(x, run.displacement("tip")[::128], atol=1e-17)
    np.testing.assert_allclose(v, run.velocity("tip")[::128], atol=1e-15)
    few = ss.transient(snecma_beam(), 170.0, 3, observe="tip")
    assert few.poincare("mode")[0].shape == (4,)
    with pytest.raises(ss.ModelError, match="'mode': it was not observed"):
        few.displacement("mode")


def test_measures(run):
    last = run.displacement("tip")[-128:]
    assert run.amplitude("tip") == run.amplitudes("tip")[-1]
    assert run.amplitude("tip") == pytest.approx(0.5 * np.ptp(last), rel=1e-3)
    assert run.amplitude("tip", "max") == pytest.approx(np.abs(last).max(), rel=1e-3)
    orbit = ss.exact_response(snecma_beam(), [170.0])
    fundamental = abs(orbit.coefficients("tip")[0, 1])
    assert run.amplitude("tip", "fundamental") == pytest.approx(fundamental, rel=1e-6)
    rows = run.summary()
    assert [row.dof for row in rows] == ["damper", "tip", "mode"]
    assert rows[1].amplitude == run.amplitude("tip")
    assert 0.0 < rows[1].change < 1e-9
    for measure in ("halfrange", None):
        with pytest.raises(ss.ModelError, match="measure: "):
            run.amplitude("tip", measure)


def test_only_the_last_periods_are_kept(run):
    few = ss.transient(snecma_beam(), 170.0, 60, keep=2, samples=16)
    assert few.time.shape == (33,)
    assert few.time[0] == pytest.approx(58 * few.period)
    assert few.kept_periods == 2
    np.testing.assert_allclose(few.displacement("tip"), run.displacement("tip")[-257::8], rtol=1e-9)
    np.testing.assert_array_equal(few.amplitudes("tip"), run.amplitudes("tip"))
    assert len(few.events) == 8
    assert few.events.time[0] >= few.time[0]
    assert any("of the last 2 periods only" in text for text in few.assumptions)


def test_events(run):
    events = run.events[-4:]
    assert [event.kind for event in events] in (
        ["sticks", "slips backward", "sticks", "slips forward"],
        ["slips forward", "sticks", "slips backward", "sticks"],
        ["sticks", "slips forward", "sticks", "slips backward"],
        ["slips backward", "sticks", "slips forward", "sticks"],
    )
    assert len(ss.transient(snecma_beam(), 170.0, 2, "rk4").events) == 0


def test_a_run_goes_on_where_another_ended(run):
    first = ss.transient(snecma_beam(), 170.0, 20)
    second = ss.transient(snecma_beam(), 170.0, 40, start=first.final)
    assert_close(second.start, first.final)
    np.testing.assert_allclose(second.amplitudes("tip"), run.amplitudes("tip")[20:], rtol=1e-10)
    louder = ss.transient(snecma_beam(25.0), 200.0, 2, start=first.final)
    assert_close(louder.start, first.final)


def test_how_runs_end():
    beam = snecma_beam()
    assert ss.transient(beam, 170.0, 3).status == "completed"
    assert ss.transient(beam, 170.0, 3, tolerance=1e-9).status == "not settled"
    growing = one_dof(damping=-4.0, force=1.0)
    run = ss.transient(growing, 2.0, 5000)
    assert run.status == "unbounded"
    assert run.unbounded
    assert run.periods < 5000
    for one in (run, ss.transient(beam, 170.0, 3)):
        assert one.status.advice.count(". ") >= 1
    assert any("No tolerance was given" in text for text in ss.transient(beam, 9.0, 1).assumptions)


@pytest.mark.parametrize("force", [1e150, 1e155, 1e200, 1e300])
def test_forces_whose_squares_are_no_numbers_end_the_motion(force):
    asked = []

    def bounded(_):
        asked.append(None)
        assert len(asked) < 100

    run = ss.transient(one_dof(force=force), 2.0, 3, progress=bounded)
    assert run.status == "unbounded"


@pytest.mark.slow
def test_an_interrupted_run_keeps_its_periods(tmp_path):
    def stop(_):
        raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match=r"transient interrupted after \d+ of 100000") as it:
        ss.transient(snecma_beam(), 170.0, 100_000, keep=2, progress=stop)
    partial = it.value.result
    assert partial.status == "interrupted"
    assert 0 < partial.periods < 100_000
    partial.save(tmp_path / "partial.nc")
    again = ss.load(tmp_path / "partial.nc")
    on = ss.transient(snecma_beam(), 170.0, 2, start=again.final)
    assert again.final == partial.final
    assert_close(on.start, partial.final)


@pytest.mark.slow
def test_progress_ends_at_one():
    told = []
    ss.transient(snecma_beam(), 170.0, 3000, keep=1, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_it_travels(run):
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.displacement("tip"), run.displacement("tip"))
    assert not again.time.flags.writeable
    assert again.final == run.final
    assert list(again.events[:5]) == list(run.events[:5])


# ---------------------------------------------------------------------------------- spectrum


def test_lines_stand_at_the_harmonics_and_carry_their_power():
    run = ss.transient(snecma_beam(), 170.0, 80, samples=256)
    found = run.spectrum("damper", last=10)
    assert found.frequency[0] == 0.0
    assert found.frequency[-1] == pytest.approx(128 * 170.0 / (2 * np.pi))
    step = found.frequency[1]
    assert step == pytest.approx(17.0 / (2 * np.pi))
    lines = found.density[::10] * step
    series = ss.exact_response(snecma_beam(), [170.0]).coefficients("damper")[0]
    np.testing.assert_allclose(lines[1:12:2], 0.5 * np.abs(series[1:12:2]) ** 2, rtol=1e-4)
    between = np.delete(found.density, np.s_[::10])
    assert between.max() < 1e-12 * found.density.max()
    motion = run.displacement("damper")[-2561:-1]
    assert found.density.sum() * step == pytest.approx(np.var(motion), rel=1e-9)


def test_segments_and_windows():
    run = ss.transient(snecma_beam(), 170.0, 16)
    coarse = run.spectrum("tip", segment=4)
    assert coarse.frequency[1] == pytest.approx(170.0 / (8 * np.pi))
    soft = run.spectrum("tip", segment=4, window="hann")
    assert soft.density[3] > coarse.density[3] or soft.density[5] > coarse.density[5]
    for options, message in (
        ({"last": 17}, "last: 17 is too large; give at most 16"),
        ({"segment": 17}, "segment: 17 is too large"),
        ({"window": "bell"}, "^window: 'bell' is none .* give 'boxcar' or 'hann'$"),
        ({"window": "kaiser"}, "^window: 'kaiser' is none .* give 'boxcar' or 'hann'$"),
        ({"window": 3}, "^window: 3 is not text"),
    ):
        with pytest.raises(ss.ModelError, match=message) as refused:
            run.spectrum("tip", **options)
        assert "\n" not in str(refused.value)


# ---------------------------------------------------------------------------------- states


def test_states():
    model = beam_pair()
    state = ss.State(model, {"1.tip": 1e-3}, {"2.mode": 0.5}, {"tips": 3.0, ("damper-1", 0): -2.0})
    assert state.displacement.tolist() == [0.0, 1e-3, 0.0, 0.0, 0.0, 0.0]
    assert state.velocity[5] == 0.5
    assert state.contact_force.tolist() == [-2.0, 0.0, 3.0]
    assert state.vector.shape == (15,)
    assert not state.vector.flags.writeable
    assert state == ss.State.of_vector(model, state.vector)
    assert state != ss.State.rest(model)
    assert not ss.State.rest(model).vector.any()
    assert repr(state) == "State(6 dofs, largest displacement 0.001 m)"
    assert pickle.loads(pickle.dumps(state)) == state
    with pytest.raises(ValueError, match="read-only"):
        state.velocity[0] = 1.0
    again = ss.transient(model, 170.0, 1, start=state)
    assert_close(again.start, state)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([3], "model: 3 is not a Model"),
        ([snecma_beam(), {"tpi": 1.0}], r"displacement: unknown dof 'tpi'; did you mean 'tip'\?"),
        ([snecma_beam(), {"tip": np.nan}], "displacement of 'tip': nan is not a finite number"),
        ([snecma_beam(), [1.0, 2.0]], r"displacement: shape \(2,\) for 3 dofs; give \(3,\)"),
        ([snecma_beam(), "x"], "displacement: 'x' is neither a list of numbers nor a mapping"),
        ([snecma_beam(), None, [0, np.inf, 0]], r"velocity\[1\]: inf is not a finite number"),
        ([snecma_beam(), None, None, [300.0]], "300 N at contact 'jenkins' exceeds its slip force"),
        ([snecma_beam(), None, None, {"damper": 1.0}], "unknown contact 'damper'"),
    ],
)
def test_bad_states(arguments, message):
    with pytest.raises(ss.ModelError, match=message) as refused:
        ss.State(*arguments)
    assert "\n" not in str(refused.value)


# ---------------------------------------------------------------------------------- bad input


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (["x", 1.0], {}, "model: 'x' is not a Model"),
        ([one_dof(), 0.0], {}, "omega = 0.0 must be positive"),
        ([one_dof(), [1.0]], {}, r"omega: \[1.0\] is not a number"),
        ([one_dof(), 1.0, 0], {}, "periods: 0 lies below 1"),
        ([one_dof(), 1.0, 2, "rk5"], {}, "scheme: unknown choice 'rk5'; did you mean 'rk4'"),
        ([one_dof(), 1.0], {"tolerance": 0}, "tolerance: 0; give a fraction from 1e-12 to 0.5"),
        ([one_dof(), 1.0], {"steps": 1}, "steps: 1 lies below 4"),
        ([one_dof(), 1.0], {"samples": 1.5}, "samples: 1.5 is not an integer"),
        ([one_dof(), 1.0], {"keep": 0}, "keep: 0 lies below 1"),
        ([one_dof(), 1.0], {"observe": "y"}, "observe: unknown dof 'y'"),
        ([one_dof(), 1.0], {"progress": "x"}, "progress: 'x' cannot be called"),
        ([one_dof(), 1.0], {"start": 3}, r"start: 3 is no state; give ss.State\(model"),
        ([one_dof(), 1.0], {"start": {"y": 1.0}}, "displacement: unknown dof 'y'"),
        (
            [one_dof(), 1.0],
            {"start": ss.State.rest(snecma_beam())},
            "start: a state of 3 dofs and 1 contact points of another model",
        ),
        (
            [one_dof(slip_force=0.5), 1.0],
            {"start": ss.State(one_dof(), contact_force=[0.9])},
            "start: 0.9 N at contact 'jenkins' exceeds its slip force of 0.5 N",
        ),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments, options, message):
    with pytest.raises(ss.ModelError, match=message) as refused:
        ss.transient(*arguments, **options)
    assert "\n" not in str(refused.value)


def test_a_result_beyond_the_memory_is_refused_before_it_is_computed(monkeypatch):
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**6)
    with pytest.raises(ss.ModelError, match=r"needs .* keep fewer periods with keep=\.\.\."):
        ss.transient(snecma_beam(), 170.0, 1000)
    assert ss.transient(snecma_beam(), 170.0, 1000, keep=1).periods == 1000


def light(mass):
    """A body of 1 kg with a contact at a dof of hardly any mass."""
    stiffness = [[2e4, -1e4], [-1e4, 1.2e4]]
    structure = ss.Structure(
        np.diag([1.0, mass]), stiffness, ss.Rayleigh(mass=0.5), dofs=["body", "pad"]
    )
    contact = ss.Jenkins("pad", stiffness=1e4, slip_force=1.0)
    return ss.Model(structure, [contact], [ss.Force("body", 5.0)])


@pytest.mark.timeout(60)
@pytest.mark.parametrize(
    "analysis",
    [
        lambda model: ss.exact_response(model, [85.0]),
        lambda model: ss.transient(model, 85.0, 10),
        lambda model: ss.transient(model, 85.0, 10, scheme="rk4"),
        lambda model: ss.classify(model, {"body": 0.01}),
        lambda model: ss.basin_map(model, starts=[{"body": 0.01}]),
        lambda model: ss.limit_cycles(model, -np.eye(2), method="exact"),
    ],
)
def test_a_dof_of_hardly_any_mass_is_refused_by_name(analysis):
    with pytest.raises(ss.ModelError, match=r"^mass of dof 'pad': with 1e-12 kg .* condense"):
        analysis(light(1e-12))


@pytest.mark.timeout(60)
def test_a_run_that_would_take_a_million_steps_is_refused_by_name():
    with pytest.raises(ss.ModelError, match=r"^mass of dof 'pad': with 1e-09 kg .* condense"):
        ss.transient(light(1e-9), 85.0, 20)
    assert ss.transient(light(1e-9), 85.0, 1).periods == 1


@pytest.mark.timeout(60)
def test_harmonic_balance_takes_a_dof_of_hardly_any_mass():
    assert ss.forced_response(light(1e-12), [85.0], 15).converged.all()
    balance = ss.forced_response(light(1e-6), [85.0], 63)
    orbit = ss.exact_response(light(1e-6), [85.0])
    np.testing.assert_allclose(balance.amplitude("body"), orbit.amplitude("body"), rtol=1e-3)
    # Cycles by balance go without their stability.
    cycles = ss.limit_cycles(light(1e-12), -np.diag([1.0, 0.0]), harmonics=3, max_points=10)
    assert cycles.ratio.size


@pytest.mark.timeout(60)
def test_a_free_motion_is_refused_before_it_is_followed(monkeypatch):
    """As its spectrum would be, for which the end of it is followed on."""
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**12)
    with pytest.raises(ss.ModelError, match=r"^mass of dof 'pad': with 1e-09 kg .* condense"):
        ss.classify(light(1e-9), {"body": 0.01})

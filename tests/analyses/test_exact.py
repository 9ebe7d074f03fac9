"""Exact orbits: published numbers, the interface of a curve, and what only orbits have."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core
from stickslip.reference import beam_pair, snecma_beam
from stickslip.settings.orbits import ExactSettings

GRID = np.linspace(150.0, 250.0, 40)


@pytest.fixture(scope="module")
def exact():
    return ss.exact_response(snecma_beam(), GRID)


def one_dof(force=0.5, slip_force=1.0, **more):
    structure = ss.Structure([[2.0]], [[8.0]], [[0.4]], ["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=slip_force)
    return ss.Model(structure, [contact], [ss.Force("x", force, **more)])


# ---------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("force", "omega", "damper", "tip", "slips"),
    [
        # Guillen (1999), Figs 4.1 and 4.2, computed anew by exact orbits and fine Runge-Kutta
        (20.313, 170.0, 1.13231437e-5, 7.19208565e-4, 2),
        (25.0, 200.0, 1.01597422e-4, 1.57188600e-3, 6),
    ],
)
def test_orbits_of_the_dissertation(force, omega, damper, tip, slips):
    orbit = ss.exact_response(snecma_beam(force), [omega])
    assert orbit.amplitude("damper")[0] == pytest.approx(damper, rel=1e-8)
    assert orbit.amplitude("tip")[0] == pytest.approx(tip, rel=1e-8)
    events = orbit.events(0)
    assert events.count("slips forward") + events.count("slips backward") == slips
    assert events.count("sticks") == slips
    assert orbit.stable.all()


@pytest.mark.parametrize("force", [0.938, 6.563, 20.313, 38.438])
def test_energy_is_in_balance(force):
    exact = ss.exact_response(snecma_beam(force), GRID)
    assert exact.converged.all()
    assert np.abs(exact.energy.imbalance).max() < 1e-8
    np.testing.assert_allclose(exact.energy.friction, exact.dissipation((0, 0)), rtol=1e-15)
    assert (exact.energy.viscous > 0.0).all()


@pytest.mark.slow
def test_harmonic_balance_comes_to_the_orbits(exact):
    balance = ss.forced_response(snecma_beam(), GRID, 101)
    for dof in exact.dofs:
        np.testing.assert_allclose(balance.amplitude(dof), exact.amplitude(dof), rtol=2e-4)
    close = balance.coefficients("tip")[:, :8]
    scale = np.abs(close).max()
    np.testing.assert_allclose(exact.coefficients("tip")[:, :8], close, atol=1e-4 * scale)
    np.testing.assert_allclose(
        exact.slip_fraction(0), balance.slip_fraction(0), rtol=0.02, atol=1e-9
    )


def test_a_peak_is_refined_on_orbits():
    peak = ss.exact_response(snecma_beam(31.475), np.linspace(160.0, 180.0, 21)).peak("tip")
    assert peak.amplitude == pytest.approx(2.9847e-3, rel=2e-5)
    assert peak.omega == pytest.approx(169.05, abs=0.01)
    assert not peak.at_edge


def test_several_contacts():
    exact = ss.exact_response(beam_pair(), np.linspace(170.0, 220.0, 11))
    assert exact.converged.all()
    assert exact.multipliers.shape == (11, 2 * 6 + 3)
    assert np.abs(exact.energy.imbalance).max() < 1e-8
    found = {event.contact for index in range(11) for event in exact.events(index)}
    assert found <= set(exact.model.contact_names)
    assert "damper-1" in found


# ---------------------------------------------------------------------------------- interface


def test_it_is_a_forced_response(exact):
    assert isinstance(exact, ss.ForcedResponse)
    assert exact.coefficients("tip").shape == (40, 33)
    assert exact.harmonics.tolist() == [32] * 40
    assert exact.settings == ExactSettings(residual="centred")
    assert exact.half_wave
    assert repr(exact).startswith("ExactResponse(40 points from 150 to 250 rad/s (all solved)")
    row = exact.summary("tip")[0]
    assert row.amplitude == exact.peak("tip").amplitude
    assert row.error_estimate < 1e-12


def test_reported_harmonics_do_not_change_the_orbit(exact):
    few = ss.exact_response(snecma_beam(), GRID, harmonics=3, observe="tip")
    assert few.coefficients("tip").shape == (40, 4)
    np.testing.assert_array_equal(few.amplitude("tip"), exact.amplitude("tip"))
    np.testing.assert_array_equal(few.waveform("tip", 20), exact.waveform("tip", 20))


def test_measures(exact):
    wave = exact.waveform("tip", 20, 20_000)
    for measure, expected in (
        ("half_range", 0.5 * np.ptp(wave)),
        ("max", np.abs(wave).max()),
        ("fundamental", abs(exact.coefficients("tip")[20, 1])),
    ):
        assert exact.amplitude("tip", measure)[20] == pytest.approx(expected, rel=1e-7)
    with pytest.raises(ss.ModelError, match="measure: unknown choice 'halfrange'"):
        exact.amplitude("tip", "halfrange")


def test_waveforms_follow_the_orbit(exact):
    index = exact.index(200.0)
    period = 2 * np.pi / exact.omega[index]
    x, v = (wave("tip", index, 4096) for wave in (exact.waveform, exact.velocity_waveform))
    slope = (np.roll(x, -1) - np.roll(x, 1)) / (2 * period / 4096)
    np.testing.assert_allclose(slope, v, atol=1e-4 * np.abs(v).max())
    u, f = (wave(0, index, 4096) for wave in (exact.contact_waveform, exact.contact_force))
    assert u.shape == f.shape == (4096, 1)
    np.testing.assert_allclose(u[:, 0], exact.waveform("damper", index, 4096), rtol=1e-12)
    assert np.abs(f).max() == 246.048
    area = np.sum(0.5 * (f + np.roll(f, -1, 0)) * (np.roll(u, -1, 0) - u))
    assert area == pytest.approx(exact.dissipation((0, 0))[index], rel=1e-4)
    np.testing.assert_array_equal(exact.contact_force((0, 0), index, 64), f[::64, 0])


def test_events_are_where_the_force_meets_its_limit(exact):
    index = exact.index(200.0)
    events = exact.events(index)
    assert len(events) == 12
    assert (np.diff(events.time) > 0.0).all()
    assert 0.0 <= events.time[0] <= events.time[-1] < 2 * np.pi / exact.omega[index]
    first = events[0]
    assert first == next(iter(events))
    assert (first.contact, first.point) == ("jenkins", 0)
    assert first.time == events.time[0]
    assert first.kind in ("sticks", "slips forward", "slips backward")
    assert events[-1] == list(events)[-1]
    assert list(events[2:4]) == list(events)[2:4]
    assert set(events.contact) == {"jenkins"}
    assert not events.time.flags.writeable
    share = exact.slip_fraction((0, 0))[index]
    assert _slipping(events, 2 * np.pi / exact.omega[index]) == pytest.approx(share, rel=1e-9)
    with pytest.raises(IndexError):
        events[12]


def _slipping(events, period):
    times = np.append(events.time, events.time[0] + period)
    lasting = np.diff(times) / period
    return lasting[events.kind != "sticks"].sum()


def test_multipliers(exact):
    assert exact.multipliers.shape == (40, 7)
    stuck = exact.slip_fraction((0, 0)) == 0.0
    assert stuck.any()
    assert not stuck.all()
    np.testing.assert_array_equal(exact.neutral, stuck)
    np.testing.assert_allclose(exact.multipliers[stuck, 0], 1.0, atol=1e-12)
    assert exact.stable.all()
    assert (np.abs(exact.multipliers[~stuck]) < 1.0).all()
    size = np.abs(exact.multipliers[~stuck])
    assert (np.diff(size, axis=1) <= 1e-12).all()


def test_multipliers_are_those_of_small_disturbances():
    """Central differences of one period of the exact flow, from a state that sticks."""
    beam = snecma_beam(25.0)
    orbit = ss.exact_response(beam, [200.0])
    start = orbit.state(0).vector
    assert abs(start[6]) < 246.0
    sizes = np.array([1e-4, 1e-3, 1e-4, 1e-2, 1e-1, 1e-2, 2e2])
    columns = []
    for entry, size in enumerate(1e-6 * sizes):
        ends = []
        for side in (1.0, -1.0):
            moved = start.copy()
            moved[entry] += side * size
            state = ss.State.of_vector(beam, moved)
            ends.append(ss.transient(beam, 200.0, 1, start=state).final.vector)
        columns.append((ends[0] - ends[1]) / (2.0 * size))
    disturbed = np.linalg.eigvals(np.array(columns).T)
    order = np.argsort(-np.abs(disturbed))
    np.testing.assert_allclose(
        np.sort_complex(disturbed[order][:6]),
        np.sort_complex(orbit.multipliers[0][:6]),
        atol=1e-6,
    )


def test_negative_damping_is_seen_to_be_unstable():
    structure = ss.Structure([[1.0]], [[4.0]], [[-0.01]], ["x"])
    free = ss.exact_response(ss.Model(structure, forces=[ss.Force("x", 1.0)]), [1.0, 3.0])
    assert free.converged.all()
    assert not free.stable.any()
    assert (np.abs(free.multipliers).max(axis=1) > 1.0).all()
    assert any("negative for some motion" in text for text in free.assumptions)


def test_the_state_is_where_the_period_begins(exact):
    state = exact.state(5)
    assert state.displacement[1] == pytest.approx(exact.waveform("tip", 5, 2)[0], rel=1e-12)
    assert state.contact_force[0] == pytest.approx(exact.contact_force((0, 0), 5, 2)[0], rel=1e-12)
    again = ss.transient(exact.model, exact.omega[5], 1, start=state)
    assert again.change[0] < 1e-11


def test_a_range_takes_the_frequencies_of_the_balance():
    exact = ss.exact_response(snecma_beam(), (190.0, 196.0), tolerance=0.05)
    balance = ss.forced_response(snecma_beam(), (190.0, 196.0), tolerance=0.05)
    np.testing.assert_array_equal(exact.omega, balance.omega)
    assert exact.settings.span == (190.0, 196.0)
    assert any("adaptive harmonic balance chose" in text for text in exact.assumptions)


@pytest.mark.slow
def test_progress_goes_from_zero_to_one():
    told = []
    ss.exact_response(snecma_beam(), (150.0, 250.0), progress=told.append)
    assert told[-1] == 1.0
    assert told == sorted(told)


@pytest.mark.slow
def test_an_interrupted_run_keeps_its_points(tmp_path):
    def stop(done):
        if done > 0.0:
            raise KeyboardInterrupt

    grid = np.linspace(150.0, 250.0, 4000)
    with pytest.raises(ss.Interrupted, match=r"exact response interrupted after \d+ of 4000") as it:
        ss.exact_response(snecma_beam(), grid, progress=stop)
    partial = it.value.result
    assert isinstance(partial, ss.ExactResponse)
    assert partial.interrupted
    assert 0 < partial.omega.size < 4000
    assert partial.converged.all()
    # Parts of the sweep are followed at a time: the last one of them may have left a gap.
    places = np.searchsorted(grid, partial.omega)
    np.testing.assert_array_equal(partial.omega, grid[places])
    assert (np.diff(places) > 0).all()
    last = ss.exact_response(snecma_beam(), partial.omega[-1:])
    assert len(partial.events(-1)) == len(last.events(0))
    assert any("interrupted after" in text for text in partial.assumptions)
    partial.save(tmp_path / "partial.nc")
    assert ss.load(tmp_path / "partial.nc").omega.size == partial.omega.size


def test_an_interrupted_choice_of_frequencies_keeps_the_balance():
    def stop(done):
        if done > 0.0:
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match="interrupted while its frequencies were chosen") as it:
        ss.exact_response(snecma_beam(), (20.0, 350.0), tolerance=1e-6, progress=stop)
    assert it.value.result.omega[0] == 20.0


def test_a_point_without_orbit_says_so():
    """Undamped, at the free resonance, with a force that friction cannot bound."""
    oscillator = ss.Structure(mass=[[2.0]], stiffness=[[8.0]], dofs=["tip"])
    damper = ss.Jenkins("tip", stiffness=10.0, slip_force=1.0)
    exact = ss.exact_response(ss.Model(oscillator, [damper], [ss.Force("tip", 100.0)]), [2.0])
    (status,) = exact.status
    assert status == "orbit stalled"
    assert "Raise max_iterations" in status.advice
    assert np.isnan(exact.amplitude("tip")).all()
    assert np.isnan(exact.waveform("tip", 0)).all()
    assert np.isnan(exact.contact_force(0, 0)).all()
    assert len(exact.events(0)) == 0
    assert not exact.stable[0]
    assert np.isnan(exact.energy.friction[0])
    with pytest.raises(ss.ModelError, match=r"index: 0 has no state \(orbit stalled\)"):
        exact.state(0)
    with pytest.raises(ss.ModelError, match="none of the 1 points is solved"):
        exact.peak("tip")


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (["x", [1.0]], {}, "model: 'x' is not a Model"),
        ([one_dof(), []], {}, "omega: empty"),
        ([one_dof(), [-1.0]], {}, r"omega\[0\] is -1; give finite frequencies above 0"),
        ([one_dof(), [1.0]], {"harmonics": "auto"}, "harmonics: 'auto' is not an integer"),
        ([one_dof(), [1.0]], {"harmonics": 0}, "harmonics: 0 lies below 1"),
        ([one_dof(), [1.0]], {"harmonics": 10**7}, "harmonics: 10000000 .*; give at most 255"),
        ([one_dof(), [1.0]], {"residual": "none"}, "unknown choice 'none'"),
        ([one_dof(), [1.0]], {"observe": ["y"]}, "observe: unknown dof 'y'"),
        ([one_dof(), [1.0]], {"progress": 3}, "progress: 3 cannot be called"),
        ([one_dof(), [1.0]], {"max_iterations": 0}, "max_iterations: 0 lies below 1"),
        ([one_dof(), (2.0, 2.0)], {}, "two different ends"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments, options, message):
    with pytest.raises(ss.ModelError, match=message) as refused:
        ss.exact_response(*arguments, **options)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("derivative", ["sensitivity", "peak_sensitivity"])
def test_derivatives_are_those_of_a_balance(exact, derivative, monkeypatch):
    runs = []
    monkeypatch.setattr(_core, "forced_response", lambda *_: runs.append(1))
    with pytest.raises(ss.ModelError, match=r"^sensitivity: none of an exact_response; "):
        getattr(exact, derivative)("tip", parameter="level")
    assert not runs


def test_orbits_are_immutable_and_travel(exact):
    for array in (exact.multipliers, exact.neutral, exact.stable, exact.energy.work, exact.omega):
        assert not array.flags.writeable
    with pytest.raises(AttributeError):
        exact.omega = GRID
    for twin in (copy.deepcopy(exact), pickle.loads(pickle.dumps(exact))):
        assert type(twin) is ss.ExactResponse
        np.testing.assert_array_equal(twin.amplitude("tip"), exact.amplitude("tip"))
        assert list(twin.events(20)) == list(exact.events(20))
        assert not twin.multipliers.flags.writeable


# ---------------------------------------------------------------------------------- energy


def test_energy_of_a_harmonic_balance():
    frf = ss.forced_response(snecma_beam(), GRID, 5)
    assert np.abs(frf.energy.imbalance).max() < 1e-8
    stalled = ss.forced_response(snecma_beam(), GRID, 9, max_iterations=1)
    assert np.isnan(stalled.energy.work[~stalled.converged]).all()
    few = ss.forced_response(snecma_beam(), GRID[:2], 5, observe="tip")
    with pytest.raises(ss.ModelError, match="energy: dof 'damper' was not observed"):
        _ = few.energy


def test_forces_on_several_harmonics_do_their_work():
    beam = snecma_beam()
    loads = [
        ss.Force("tip", 20.0, 0.3),
        ss.Force("damper", 5.0, 1.0, harmonic=2),
        ss.Force("tip", 3.0, harmonic=0),
    ]
    model = ss.Model(beam.structure, beam.contacts, loads)
    exact = ss.exact_response(model, [170.0, 190.0, 230.0])
    assert exact.converged.all()
    assert not exact.half_wave
    assert np.abs(exact.energy.imbalance).max() < 1e-8
    balance = ss.forced_response(model, exact.omega, 61)
    np.testing.assert_allclose(balance.energy.work, exact.energy.work, rtol=1e-4)


def test_an_orbit_too_fast_to_follow_names_the_dof():
    exact = ss.exact_response(snecma_beam(25.0), [170.0])
    arrays = dataclasses.replace(exact.arrays, omega=np.array([1e-300]))
    slow = dataclasses.replace(exact, arrays=arrays)
    with pytest.raises(ss.ModelError, match=r"mass of dof '\w+': .* too fast to follow in time"):
        slow.waveform("tip", 0)


@pytest.mark.parametrize("omega", [8.0, 16.0, 20.0])
def test_last_newton_steps_take_no_pass_along_the_orbit(omega):
    """A start that is all but closed saves no pass: one is looked at, and one read off."""
    size, contacts = 24, 12
    stiffness = np.diag(900.0 + 70.0 * np.arange(size))
    stiffness -= 400.0 * (np.eye(size, k=1) + np.eye(size, k=-1))
    dofs = [f"x{i}" for i in range(size)]
    structure = ss.Structure(np.eye(size), stiffness, ss.Rayleigh(mass=0.05, stiffness=0.0), dofs)
    elements = [
        ss.Jenkins(dof, stiffness=150.0, slip_force=1.0 + 0.7 * i)
        for i, dof in enumerate(dofs[:contacts])
    ]
    forces = [ss.Force(dofs[-1], amplitude=60.0), ss.Force(dofs[0], amplitude=20.0)]
    model = ss.Model(structure, elements, forces)

    once, twice = (ss.exact_response(model, [omega] * count) for count in (1, 2))

    assert twice.converged.all()
    assert once.iterations[0] > 1
    steps, both = (found.counters["evaluations"] for found in (once, twice))
    assert steps <= both - steps

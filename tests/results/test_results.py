"""Forced responses: what comes out is consistent and honest."""

import copy
import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.settings.balance import ForcedSettings

GRID = np.linspace(150.0, 250.0, 60)


@pytest.fixture(scope="module")
def frf():
    return ss.forced_response(snecma_beam(), GRID, harmonics=9)


@pytest.fixture(scope="module")
def stalled():
    """Without iterations only the stuck points, which are linear, are solved."""
    return ss.forced_response(snecma_beam(), GRID, harmonics=9, max_iterations=1)


def one_dof(*forces, damping=0.4, stiffness=8.0, slip_force=1.0):
    structure = ss.Structure([[2.0]], [[stiffness]], damping=[[damping]], dofs=["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=slip_force)
    return ss.Model(structure, [contact], forces or [ss.Force("x", 0.5)])


# ---------------------------------------------------------------------------------- curves


def test_shapes_and_constancy(frf):
    n, orders = 60, 10
    assert frf.omega.shape == frf.harmonics.shape == frf.residual.shape == (n,)
    assert frf.dofs == ("damper", "tip", "mode")
    assert frf.coefficients("tip").shape == (n, orders)
    assert frf.amplitude("tip").shape == frf.error_estimate("tip").shape == (n,)
    assert frf.slip_fraction(0).shape == frf.dissipation("jenkins").shape == (n, 1)
    assert frf.slip_fraction((0, 0)).shape == (n,)
    assert frf.residual_bounds(0).shape == (n, 1, 2)
    assert frf.residual_bounds(("jenkins", 0)).shape == (n, 2)
    assert frf.converged.all()
    assert set(frf.status) == {ss.Status.CONVERGED}
    assert frf.half_wave
    assert frf.timings["total"] > 0.0
    for array in (frf.omega, frf.coefficients("tip"), frf.amplitude("tip"), frf.converged):
        assert not array.flags.writeable
    assert repr(frf) == (
        "ForcedResponse(60 points from 150 to 250 rad/s (all solved), 3 dofs, harmonics=9)"
    )


def test_waveform_is_the_series(frf):
    t = np.arange(100) / 100
    X = frf.coefficients("mode")[31]
    direct = sum((X[k] * np.exp(2j * np.pi * k * t)).real for k in range(10))
    np.testing.assert_allclose(frf.waveform("mode", 31, samples=100), direct, atol=1e-17)
    np.testing.assert_array_equal(frf.waveform("mode", -1), frf.waveform("mode", 59))


@pytest.mark.parametrize(
    ("measure", "of"),
    [
        ("half_range", lambda x, _: 0.5 * (x.max() - x.min())),
        ("max", lambda x, _: np.abs(x).max()),
        ("fundamental", lambda _, X: abs(X[1])),
    ],
)
def test_amplitude_measures(measure, of):
    load = [ss.Force("tip", 20.0), ss.Force("tip", 15.0, harmonic=0), ss.Force("tip", 5, 0.3, 2)]
    beam = snecma_beam()
    frf = ss.forced_response(ss.Model(beam.structure, beam.contacts, load), GRID[::10], 6)
    assert not frf.half_wave
    for index in range(6):
        expected = of(frf.waveform("tip", index, 20000), frf.coefficients("tip")[index])
        assert frf.amplitude("tip", measure)[index] == pytest.approx(expected, rel=1e-7)


def test_linear_response_is_the_direct_solution():
    beam = snecma_beam()
    model = ss.Model(beam.structure, forces=[ss.Force("tip", 3.0, phase=0.7)])
    frf = ss.forced_response(model, GRID, harmonics=1)
    M, C, K = beam.structure.mass, beam.structure.damping, beam.structure.stiffness
    load = np.array([0.0, 3.0 * np.exp(0.7j), 0.0])
    X = np.array([np.linalg.solve(K + 1j * w * C - w**2 * M, load) for w in GRID])
    np.testing.assert_allclose(frf.coefficients("tip")[:, 1], X[:, 1], rtol=1e-9)
    np.testing.assert_allclose(frf.phase("mode"), np.angle(X[:, 2]), rtol=1e-8)


def test_phase_needs_a_fundamental():
    frf = ss.forced_response(one_dof(ss.Force("x", 0.5, harmonic=3)), [0.4], harmonics=3)
    assert np.isnan(frf.phase("x")).all()
    assert frf.amplitude("x")[0] > 0.0


def test_order_of_the_grid_does_not_matter(frf):
    shuffled = np.random.default_rng(2).permutation(60)
    other = ss.forced_response(snecma_beam(), GRID[shuffled], harmonics=9)
    np.testing.assert_array_equal(other.omega, GRID[shuffled])
    np.testing.assert_allclose(other.amplitude("tip"), frf.amplitude("tip")[shuffled], rtol=1e-7)
    assert other.peak("tip") == pytest.approx(frf.peak("tip"), rel=1e-6)


def test_observed_dofs(frf):
    few = ss.forced_response(snecma_beam(), GRID, 9, observe=["mode", "damper"])
    assert few.dofs == ("mode", "damper")
    np.testing.assert_array_equal(few.coefficients("mode"), frf.coefficients("mode"))
    assert ss.forced_response(snecma_beam(), GRID[:2], 1, observe="tip").dofs == ("tip",)
    with pytest.raises(ss.ModelError, match=r"'tip': it was not observed; add it to observe"):
        few.amplitude("tip")
    with pytest.raises(ss.ModelError, match=r"unknown dof 'mod'; did you mean 'mode'\?"):
        few.waveform("mod", 0)
    with pytest.raises(ss.ModelError, match=r"measure: .*'halfrange'; did you mean 'half_range'"):
        few.amplitude("mode", "halfrange")


def test_nearest_point(frf):
    assert frf.index(150.2) == 0
    assert frf.index(frf.omega[-1] * (1.0 + 1e-7)) == 59
    for outside in (149.0, 260.0):
        with pytest.raises(ss.ModelError, match=f"{outside:g} rad/s lies outside the computed 150"):
            frf.index(outside)
    assert frf.omega[frf.index(201.0)] == pytest.approx(201.0, abs=0.85)
    with pytest.raises(ss.ModelError, match="omega: nan is not a finite number"):
        frf.index(np.nan)


@pytest.mark.parametrize("index", [60, -61, 1.0, True, None])
def test_wrong_point(frf, index):
    with pytest.raises(ss.ModelError, match="index: "):
        frf.waveform("tip", index)


@pytest.mark.parametrize("samples", [0, -3, 2.5])
def test_wrong_samples(frf, samples):
    for ask in (lambda: frf.waveform("tip", 0, samples), lambda: frf.contact_force(0, 0, samples)):
        with pytest.raises(ss.ModelError, match="samples: "):
            ask()


# ---------------------------------------------------------------------------------- contacts


def test_contact_force_and_loop(frf):
    index = frf.index(195.0)
    u, f = (ask(0, index, samples=2**15) for ask in (frf.contact_waveform, frf.contact_force))
    assert u.shape == f.shape == (2**15, 1)
    np.testing.assert_array_equal(frf.contact_force((0, 0), index, 2**15), f[:, 0])
    np.testing.assert_array_equal(frf.contact_waveform(("jenkins", 0), index, 2**15), u[:, 0])
    assert np.abs(f).max() == pytest.approx(246.048, rel=1e-9)
    area = 0.5 * np.sum((f + np.roll(f, 1, 0)) * (u - np.roll(u, 1, 0)))
    assert frf.dissipation((0, 0))[index] == pytest.approx(area, rel=1e-6)
    slipping = np.mean(np.abs(f) > 246.048 * (1 - 1e-9))
    assert frf.slip_fraction((0, 0))[index] == pytest.approx(slipping, abs=1e-3)
    F = 2 * np.fft.rfft(f[:, 0])[:10] / f.size
    np.testing.assert_allclose(F[1:], frf.arrays.contact_force[index, 1:, 0], atol=1e-3)


def test_energy_balance(frf):
    C = frf.model.structure.damping
    X = np.stack([frf.coefficients(dof) for dof in frf.dofs], axis=2)
    k = np.arange(X.shape[1])
    fed = np.pi * (20.313 * 1j * X[:, 1, 1]).real
    quadratic = np.einsum("nki,ij,nkj->nk", X.conj(), C, X).real
    lost = np.pi * frf.omega * (k**2 * quadratic).sum(axis=1)
    np.testing.assert_allclose(fed, lost + frf.dissipation((0, 0)), rtol=1e-7)


def test_rounding_is_no_imbalance():
    undamped = one_dof(ss.Force("x", 0.5), damping=0.0, slip_force=100.0)
    static = one_dof(ss.Force("x", 0.5, harmonic=0), slip_force=100.0)
    for model in (undamped, static):
        for solve in (ss.forced_response, ss.exact_response):
            energy = solve(model, [1.5, 2.0, 2.5]).energy
            assert np.abs(energy.imbalance).max() < 1e-9
            assert (energy.apparent > 0.0).all()


def test_residual_bounds():
    grid = [120.0, 190.0, 300.0]
    centred = ss.forced_response(snecma_beam(), grid, 9)
    bounds = centred.residual_bounds(0)
    half = 0.5 * np.ptp([centred.contact_waveform((0, 0), n, 4096) for n in range(3)], axis=1)
    room = 246.048 - 2.4e7 * half
    np.testing.assert_allclose(bounds[[0, 2], 0, 1], room[[0, 2]], rtol=1e-6)
    np.testing.assert_allclose(bounds[:, 0, 0], -bounds[:, 0, 1], atol=1e-9)
    np.testing.assert_array_equal(bounds[1], 0.0)
    assert centred.slip_fraction((0, 0))[1] > 0.0
    # Any force inside the bounds goes with the same vibration.
    held = 0.9 * bounds[0, 0, 1]
    other = ss.forced_response(snecma_beam(), grid[:1], 9, residual=held)
    np.testing.assert_allclose(other.amplitude("tip"), centred.amplitude("tip")[:1], rtol=1e-9)
    assert other.arrays.contact_force[0, 0, 0].real == pytest.approx(held, rel=1e-9)
    assert other.slip_fraction((0, 0))[0] == 0.0


def test_residual_bounds_are_of_the_mean_force():
    """With an even harmonic the mean and the mid-range of a stuck contact differ."""
    model = one_dof(ss.Force("x", 0.3), ss.Force("x", 0.2, harmonic=2))
    frf = ss.forced_response(model, [0.5], 4)
    low, high = frf.residual_bounds((0, 0))[0]
    assert frf.slip_fraction((0, 0))[0] == 0.0
    mean = frf.arrays.contact_force[0, 0, 0].real
    assert abs(mean) > 1e-3
    assert 0.5 * (low + high) == pytest.approx(mean, rel=1e-6)


def test_contact_that_never_slips():
    frf = ss.forced_response(one_dof(slip_force=np.inf), [1.0], 3)
    np.testing.assert_array_equal(frf.residual_bounds((0, 0)), [[-np.inf, np.inf]])


@pytest.mark.parametrize(
    ("contact", "message"),
    [
        ("jenkin", r"unknown contact 'jenkin'; did you mean 'jenkins'\?"),
        (1, r"no contact at position 1; the model has 1"),
        ((0, 1), r"no point at position 1; contact .* has 1"),
        ((0, 0, 0), r"write \(contact, point\)"),
    ],
)
def test_wrong_contact(frf, contact, message):
    asks = (frf.slip_fraction, frf.dissipation, frf.residual_bounds)
    for ask in (*asks, lambda c: frf.contact_force(c, 0), lambda c: frf.contact_waveform(c, 0)):
        with pytest.raises(ss.ModelError, match=message):
            ask(contact)


# ---------------------------------------------------------------------------------- failures


def test_failed_points_give_no_number(stalled):
    failed = ~stalled.converged
    index = int(np.flatnonzero(failed)[0])
    assert stalled.status[index] is ss.Status.STALLED
    assert "max_iterations" in stalled.status[index].advice
    for array in (
        stalled.amplitude("tip"),
        stalled.phase("tip"),
        stalled.error_estimate("tip"),
        stalled.slip_fraction(0),
        stalled.dissipation(0),
        stalled.residual_bounds(0),
    ):
        assert np.isnan(array[failed]).all()
        assert np.isfinite(array[~failed]).all()
    assert np.isfinite(stalled.coefficients("tip")[failed]).all()
    assert np.isnan(stalled.waveform("tip", index)).all()
    assert np.isnan(stalled.contact_waveform(0, index)).all()
    assert np.isnan(stalled.contact_force(0, index, 7)).all()
    assert stalled.contact_force(0, index, 7).shape == (7, 1)
    assert any("stalled" in text for text in stalled.assumptions)


def test_harmonics_limit_is_solved_but_not_converged():
    frf = ss.forced_response(snecma_beam(), [190.0, 195.0], tolerance=1e-6, max_harmonics=7)
    assert set(frf.status) == {ss.Status.HARMONICS_LIMIT}
    assert not frf.converged.any()
    assert np.isfinite(frf.amplitude("tip")).all()
    assert (frf.harmonics == 7).all()
    assert "max_harmonics" in frf.status[0].advice


def test_settings():
    settings = ForcedSettings.of(harmonics=np.int64(5), residual=np.float64(3.0), span=(1, 2))
    assert (settings.harmonics, settings.residual, settings.span) == (5, 3.0, (1.0, 2.0))
    assert type(settings.harmonics) is int
    assert settings.fixed_harmonics == 5
    assert ForcedSettings.of().fixed_harmonics is None
    # Files of other versions have other keys.
    assert ForcedSettings.stored({"span": [1.0, 2.0], "speed": 3}).span == (1.0, 2.0)
    with pytest.raises(ss.ModelError, match="a range has two ends, not 3"):
        ForcedSettings.of(span=(1, 2, 3))
    with pytest.raises(ValueError, match="frozen"):
        settings.tolerance = 1.0


# ---------------------------------------------------------------------------------- status


def test_status():
    assert [status.code for status in ss.Status] == list(range(13))
    assert all(ss.Status.from_code(status.code) is status for status in ss.Status)
    assert ss.Status.STALLED == "stalled"
    solved = {
        ss.Status.CONVERGED,
        ss.Status.HARMONICS_LIMIT,
        ss.Status.SAMPLES_LIMIT,
        ss.Status.EFFORT_LIMIT,
    }
    assert {status for status in ss.Status if status.solved} == solved
    for status in ss.Status:
        assert status.advice.count(". ") == 1
    for code in (13, -1):
        with pytest.raises(ss.ModelError, match=f"status {code} is unknown"):
            ss.Status.from_code(code)


def test_pickling(frf):
    again = pickle.loads(pickle.dumps(frf))
    assert again.peak("damper") == frf.peak("damper")
    assert not again.omega.flags.writeable
    np.testing.assert_array_equal(again.contact_force(0, 3), frf.contact_force(0, 3))


@pytest.mark.parametrize(
    "twin", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))]
)
def test_what_is_only_kept_to_save_time_is_not_copied(frf, twin):
    frf.peak("tip")
    again = twin(frf)
    assert again._peaks == again._amplitudes == {}
    assert again.counters == frf.counters
    assert not again.amplitude("tip").flags.writeable


def test_timings_and_counters_are_constant(frf):
    for table in (frf.timings, frf.counters, pickle.loads(pickle.dumps(frf)).timings):
        with pytest.raises(TypeError, match="does not support item assignment"):
            table["total"] = 0


@pytest.mark.parametrize("wrong", [["tip"], np.array(["tip"]), np.array(["tip", "mode"]), None, 3])
def test_names_must_be_text(frf, wrong):
    for ask in (frf.amplitude, frf.coefficients, frf.peak, frf.error_estimate):
        with pytest.raises(ss.ModelError, match=r"dof: .* is not text"):
            ask(wrong)
    for ask in (frf.amplitude, frf.peak):
        with pytest.raises(ss.ModelError, match=r"measure: .* is not text"):
            ask("tip", wrong)

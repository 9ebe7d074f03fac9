"""Forced responses: what goes in is checked, what comes out is consistent and honest."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses.forced_response import Settings
from stickslip.reference import snecma_beam
from stickslip.results.arrays import Arrays

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
    assert frf.index(1e6) == 59
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


def test_interruption_of_a_range():
    partial = interrupted((150.0, 250.0), tolerance=1e-7)
    assert partial.arrays.solved.all()
    assert partial.omega[-1] < 250.0
    assert any(f"end at {partial.omega[-1]:.6g} rad/s" in text for text in partial.assumptions)
    assert not any("between 150 and 250" in text for text in partial.assumptions)


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
        status=np.full(n, 3, np.uint8),
        residual=np.full(n, np.nan),
        iterations=np.zeros(n, int),
        displacement=np.full((n, 2, 1), np.nan + 0j),
        contact_displacement=np.full((n, 2, 1), np.nan + 0j),
        contact_force=np.full((n, 2, 1), np.nan + 0j),
        error_estimate=np.full((n, 1), np.nan),
        slip_fraction=np.full((n, 1), np.nan),
        dissipation=np.full((n, 1), np.nan),
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


def test_progress_ends_at_one():
    shares = []
    ss.forced_response(snecma_beam(), np.linspace(180, 200, 3000), 15, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


# ---------------------------------------------------------------------------------- input


@pytest.mark.parametrize(
    ("omega", "message"),
    [
        ((0.0, 2.0), r"range \(0, 2\) must have two different ends above 0"),
        ((2.0, -1.0), r"two different ends above 0"),
        ((1.0, 1.0), r"two different ends above 0"),
        ((1.0, np.inf), r"end of the range: inf is not a finite number"),
        ((1.0, "2"), r"end of the range: '2' is not a number"),
        ([], r"omega: empty"),
        (3.0, r"omega: shape \(\) instead of \(n,\); write \[3\]"),
        ([[1.0, 2.0]], r"omega: shape \(1, 2\)"),
        ([[1.0], [2.0, 3.0]], r"ragged"),
        ([1.0, np.nan], r"omega\[1\] is nan"),
        ([1.0, -2.0], r"omega\[1\] is -2"),
        ([0.0], r"omega\[0\] is 0"),
        (["1"], r"holds no real numbers"),
        ([1.0 + 1j], r"holds no real numbers"),
        (None, r"omega: None holds no real numbers"),
        ([True, False], r"holds no real numbers"),
    ],
)
def test_wrong_omega(omega, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(one_dof(), omega, 3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"harmonics": 0}, r"harmonics: 0 lies below 1"),
        ({"harmonics": 2.0}, r"harmonics: 2.0 is not an integer"),
        ({"harmonics": True}, r"harmonics: True is not an integer"),
        ({"harmonics": "all"}, r'harmonics: \'all\'; give "auto"'),
        ({"harmonics": 40, "max_harmonics": 30}, r"40 lies above max_harmonics = 30"),
        ({"max_harmonics": 0}, r"max_harmonics: 0 lies below 1"),
        ({"max_iterations": 0}, r"max_iterations: 0 lies below 1"),
        ({"tolerance": 0.0}, r"tolerance: 0; give a fraction"),
        ({"tolerance": 0.6}, r"tolerance: 0.6; give a fraction"),
        ({"tolerance": np.nan}, r"tolerance: nan"),
        ({"tolerance": "small"}, r"tolerance: 'small' is not a number"),
        ({"residual": "centered"}, r"unknown residual 'centered'; did you mean 'centred'\?"),
        ({"residual": np.inf}, r"residual: inf"),
        ({"residual": None}, r"residual: None is not a number"),
        ({"method": "newtn"}, r"method: unknown choice 'newtn'; did you mean 'newton'\?"),
        ({"method": "secant"}, r"method: unknown choice 'secant'; known: 'newton', 'broyden'"),
        ({"method": np.array(["newton", "x"])}, r"method: .* is not text"),
        ({"residual": np.array(["centred", "x"])}, r"residual: .* is not a number"),
        ({"residual": np.array([1.0, 2.0])}, r"residual: .* is not a number"),
        ({"residual": ["centred"]}, r"residual: .* is not a number"),
        ({"method": ["newton"]}, r"method: .* is not text"),
        ({"observe": []}, r"observe: no dof"),
        ({"observe": ["y"]}, r"observe: unknown dof 'y'; known: 'x'"),
        ({"observe": ["x", "x"]}, r"observe: 'x' is given more than once"),
        ({"observe": 3}, r"observe: 3 is not a list of names"),
        ({"observe": [0]}, r"observe\[0\]: 0 is not text"),
        ({"progress": 3}, r"progress: 3 cannot be called"),
    ],
)
def test_wrong_option(options, message):
    with pytest.raises(ss.ModelError, match=message) as caught:
        ss.forced_response(one_dof(), [1.0], **options)
    assert "\n" not in str(caught.value)


def test_wrong_model():
    with pytest.raises(ss.ModelError, match=r"model: .* is not a Model"):
        ss.forced_response(one_dof().structure, [1.0])


def test_the_core_refuses_in_the_same_way():
    model = one_dof(ss.Force("x", 1.0, harmonic=5))
    with pytest.raises(ss.ModelError, match="5, the highest forced harmonic"):
        ss.forced_response(model, [1.0], 3)
    with pytest.raises(ss.ModelError, match="undamped natural frequency"):
        ss.forced_response(one_dof(damping=0.0), [3.0], 1)


def test_static_load_needs_support():
    free = ss.Structure(np.eye(2), [[1.0, -1.0], [-1.0, 1.0]], 0.1 * np.eye(2), ["a", "b"])
    loads = [ss.Force("a", 1.0), ss.Force("b", 2.0, harmonic=0)]
    with pytest.raises(ss.ModelError, match=r"force 2 at 'b': a static load of 2 N on a struct"):
        ss.forced_response(ss.Model(free, forces=loads), [0.5], 1)
    held = ss.Model(free, [ss.Jenkins("a", stiffness=4.0, slip_force=9.0)], loads)
    with pytest.raises(ss.ModelError, match=r'alone, .* use residual="from_rest"'):
        ss.forced_response(held, [0.5], 1)
    frf = ss.forced_response(held, [0.5], 1, residual="from_rest")
    assert frf.converged.all()
    assert frf.arrays.contact_force[0, 0, 0].real == pytest.approx(2.0, rel=1e-12)


def test_a_range_may_run_downwards():
    frf = ss.forced_response(snecma_beam(), (240.0, 180.0), tolerance=1e-2)
    assert frf.converged.all()
    assert (frf.omega[0], frf.omega[-1]) == (240.0, 180.0)
    assert (np.diff(frf.omega) < 0.0).all()
    assert any("between 180 and 240 rad/s" in text for text in frf.assumptions)


def test_a_range_chooses_its_points():
    frf = ss.forced_response(snecma_beam(), (150, 250))
    assert frf.settings.span == (150.0, 250.0)
    assert (frf.omega[0], frf.omega[-1]) == (150.0, 250.0)
    assert (np.diff(frf.omega) > 0).all()
    fine = ss.forced_response(snecma_beam(), np.linspace(160, 240, 37))
    between = np.interp(fine.omega, frf.omega, frf.amplitude("tip"))
    np.testing.assert_allclose(between, fine.amplitude("tip"), rtol=1e-2)
    two = ss.forced_response(snecma_beam(), [150, 250], 1)
    assert two.omega.size == 2
    assert two.settings.span is None


def test_settings():
    settings = Settings(harmonics=np.int64(5), residual=np.float64(3.0), span=(1, 2))
    assert (settings.harmonics, settings.residual, settings.span) == (5, 3.0, (1.0, 2.0))
    assert type(settings.harmonics) is int
    assert settings.fixed_harmonics == 5
    assert Settings().fixed_harmonics is None
    with pytest.raises(ss.ModelError, match="a range has two ends, not 3"):
        Settings(span=(1, 2, 3))
    with pytest.raises(AttributeError):
        settings.tolerance = 1.0


# ---------------------------------------------------------------------------------- assumptions


def assumed(model, omega=(1.0,), harmonics=5, **options):
    return " ".join(ss.forced_response(model, np.array(omega), harmonics, **options).assumptions)


def test_assumptions_on_harmonics():
    assert "Only the odd harmonics up to 5 were solved for" in assumed(one_dof())
    even = one_dof(ss.Force("x", 0.3), ss.Force("x", 0.1, harmonic=2))
    assert "All harmonics from 0 to 5 were solved for" in assumed(even)
    assert "chosen per point" in assumed(one_dof(), harmonics="auto")


def test_assumptions_on_residual_forces():
    assert "residual='centred', of effect at 1 of 1 points" in assumed(one_dof())
    assert "built up from zero displacement" in assumed(one_dof(), residual="from_rest")
    assert "hold 0.1 N" in assumed(one_dof(), residual=0.1)
    assert "residual" not in assumed(one_dof(ss.Force("x", 60.0)), omega=[2.0])


@pytest.mark.parametrize(
    ("damping", "text"),
    [
        (np.diag([1.0, 1e-6]), ""),
        ([[1.0, 5.0], [-5.0, 1.0]], ""),
        ([[1.0, -1.0], [-1.0, 1.0]], "leaves some motion undamped"),
        (np.diag([1.0, 0.0]), "leaves some motion undamped"),
        (np.diag([1.0, -0.01]), "negative for some motion"),
        ([[1.0, 2.0], [2.0, 1.0]], "negative for some motion"),
    ],
)
def test_assumptions_on_damping(damping, text):
    structure = ss.Structure(np.eye(2), np.diag([4.0, 9.0]), damping, ["a", "b"])
    said = assumed(ss.Model(structure, forces=[ss.Force("a", 1.0)]), harmonics=1)
    assert text in said
    assert ("motion" in said) is bool(text)


def test_assumptions_on_truncation_and_observation():
    said = assumed(snecma_beam(), [190.0], 1, observe=["mode"])
    assert "still change 'mode' by" in said
    assert "at omega = 190 rad/s" in said
    assert "Only 1 of 3 dofs are kept in the result: mode." in said
    assert "still change" not in assumed(snecma_beam(), [190.0], "auto")


# ---------------------------------------------------------------------------------- status


def test_status():
    assert [status.code for status in ss.Status] == [0, 1, 2, 3, 4, 5]
    assert all(ss.Status.from_code(status.code) is status for status in ss.Status)
    assert ss.Status.STALLED == "stalled"
    assert [status.solved for status in ss.Status] == [True, False, False, False, True, False]
    for status in ss.Status:
        assert status.advice.count(". ") == 1
    for code in (6, -1):
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


def test_assumptions_on_huge_numbers_raise_no_warning():
    frf = ss.forced_response(one_dof(ss.Force("x", 1e200), slip_force=1e199), [0.9, 2.1], 3)
    assert frf.assumptions


def test_a_result_beyond_the_memory_is_refused_before_it_is_computed(monkeypatch):
    monkeypatch.setattr("stickslip.analyses.memory.physical_memory", lambda: 10**6)
    message = "needs 0.0048 GB of the 0.001 GB of memory; name fewer dofs with observe="
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(snecma_beam(), np.linspace(150, 250, 6000), 9)
    with pytest.raises(ss.ModelError, match="give fewer points"):
        ss.forced_response(snecma_beam(), np.linspace(150, 250, 6000))
    assert ss.forced_response(snecma_beam(), GRID[:3], 9).converged.all()
    monkeypatch.setattr("stickslip.analyses.memory.physical_memory", lambda: None)
    assert ss.forced_response(snecma_beam(), GRID[:3], 9).converged.all()

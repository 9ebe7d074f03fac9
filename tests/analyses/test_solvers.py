"""The dissertation's solvers: Broyden's method and the marched evaluation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip import _core
from stickslip.reference import SNECMA_LOADS, beam_pair, snecma_beam
from stickslip.study import Study
from stickslip.views.curves import CurveView

GRID = np.linspace(20.0, 350.0, 400)
BAND = np.linspace(150.0, 250.0, 60)


def beam(**settings):
    return ss.forced_response(snecma_beam(), BAND, harmonics=9, **settings)


@pytest.fixture(scope="module")
def frf():
    return beam()


# ---------------------------------------------------------------------------------- Broyden


@pytest.mark.parametrize("load", SNECMA_LOADS)
@pytest.mark.parametrize("harmonics", [1, 3, 9, 15, 21])
def test_broyden_agrees_with_newton_at_every_point_of_every_load(load, harmonics):
    newton = ss.forced_response(snecma_beam(load), GRID, harmonics)
    broyden = ss.forced_response(snecma_beam(load), GRID, harmonics, method="broyden")
    assert newton.converged.all()
    assert broyden.converged.all()
    for dof in newton.dofs:
        np.testing.assert_allclose(broyden.amplitude(dof), newton.amplitude(dof), rtol=1e-9)
        scale = newton.amplitude(dof)
        difference = broyden.error_estimate(dof) - newton.error_estimate(dof)
        assert np.abs(difference / scale).max() < 1e-7
    assert broyden.counters["homotopies"] == 0
    assert broyden.counters["restarts"] <= 40


def test_counters_tell_the_work_of_either_method(frf):
    assert frf.counters["updates"] == frf.counters["restarts"] == 0
    broyden = beam(method="broyden")
    assert broyden.counters["updates"] > 60
    assert 60 <= broyden.counters["factorisations"] <= 60 + 2 * broyden.counters["restarts"]
    differences = beam(method="broyden", jacobian="differences")
    # Ten unknowns: one evaluation each, for every Jacobian.
    more = differences.counters["evaluations"] - broyden.counters["evaluations"]
    assert more >= 10 * broyden.counters["factorisations"]
    for result in (broyden, differences):
        np.testing.assert_allclose(result.amplitude("tip"), frf.amplitude("tip"), rtol=1e-9)


@pytest.mark.slow
def test_broyden_with_several_contacts_a_range_and_automatic_harmonics():
    model = beam_pair(60.0)
    newton = ss.forced_response(model, (150.0, 200.0))
    broyden = ss.forced_response(model, (150.0, 200.0), method="broyden")
    np.testing.assert_array_equal(broyden.harmonics, newton.harmonics)
    np.testing.assert_allclose(broyden.omega, newton.omega, rtol=1e-7)
    np.testing.assert_allclose(broyden.amplitude("1.tip"), newton.amplitude("1.tip"), rtol=1e-6)
    assert broyden.peak("2.tip") == pytest.approx(newton.peak("2.tip"), rel=1e-7)


def test_the_sensitivity_of_a_peak_is_solved_with_the_settings_of_its_curve(monkeypatch):
    curve = beam(method="broyden", jacobian="differences")
    solve, methods = _core.forced_response, []

    def spy(problem, omega, observe, driving, settings, *rest):
        methods.append((settings.method, settings.jacobian))
        return solve(problem, omega, observe, driving, settings, *rest)

    monkeypatch.setattr(_core, "forced_response", spy)
    slope = curve.peak_sensitivity("tip", parameter="level")
    assert methods == [("broyden", "differences")]
    assert slope == pytest.approx(beam().peak_sensitivity("tip", parameter="level"), rel=1e-6)


# ---------------------------------------------------------------------------------- marched


def test_the_march_approaches_the_exact_evaluation(frf):
    errors = [
        np.abs(beam(evaluation="marched", samples=n).amplitude("tip") / frf.amplitude("tip") - 1)
        for n in (64, 1024)
    ]
    rate = np.log2(np.linalg.norm(errors[0]) / np.linalg.norm(errors[1])) / 4
    assert rate == pytest.approx(2.0, abs=0.3)
    assert errors[1].max() < 1e-4
    assert not any("marched" in one for one in frf.assumptions)
    assert not frf.samples.any()


@pytest.mark.slow
def test_everything_of_a_marched_result_is_marched(frf, tmp_path):
    coarse = beam(evaluation="marched", samples=40)
    index = coarse.index(195.0)
    force = coarse.contact_force((0, 0), index, 40)
    harmonics = 2 * np.fft.rfft(force)[:10] / 40
    kept = coarse.arrays.contact_force[index, :, 0]
    np.testing.assert_allclose(harmonics[1::2], kept[1::2], atol=1e-9 * 246.048)
    peak = coarse.peak("tip")
    assert not peak.at_edge
    again = ss.forced_response(
        snecma_beam(), [peak.omega], 9, evaluation="marched", samples=40, method="broyden"
    )
    assert again.amplitude("tip")[0] == pytest.approx(peak.amplitude, rel=1e-8)
    assert peak.amplitude != pytest.approx(frf.peak("tip").amplitude, rel=1e-4)
    coarse.save(tmp_path / "coarse.nc")
    loaded = ss.load(tmp_path / "coarse.nc")
    assert loaded.settings == coarse.settings
    np.testing.assert_array_equal(loaded.contact_force((0, 0), index, 40), force)


@pytest.mark.slow
def test_automatic_samples_keep_the_tolerance_and_say_how_many(frf, tmp_path):
    def by_themselves(**options):
        points = [ss.forced_response(snecma_beam(), [omega], 9, **options) for omega in frf.omega]
        return np.array([point.error_estimate("tip")[0] for point in points])

    counts, estimate = [], by_themselves()
    for tolerance in (1e-2, 1e-3, 1e-4):
        options = {"evaluation": "marched", "tolerance": tolerance}
        march = beam(**options)
        assert march.converged.all()
        errors = np.abs(march.amplitude("tip") / frf.amplitude("tip") - 1)
        assert 0.005 * tolerance < errors.max() < 0.4 * tolerance
        # The estimate of the exact evaluation, and the error of the samples; along a curve points
        # go on from those beside them.
        of_samples = 0.3 * tolerance * march.amplitude("tip") + 1e-15
        more = by_themselves(**options) - estimate
        assert (np.abs(more) < of_samples + 0.5 * estimate).all()
        more = march.error_estimate("tip") - estimate
        assert (np.abs(more) < of_samples + 2.0 * estimate).all()
        assert np.mean(np.abs(more) < of_samples + 0.5 * estimate) > 0.95
        counts.append(march.samples.sum())
    assert counts[0] < counts[1] < counts[2]
    assert march.samples.min() == 64 < march.samples.max()
    text = (
        f"marched through 64 to {march.samples.max()} samples per period, chosen per point to a "
        "quarter of the tolerance of 0.0001; the error of the sampling is part of"
    )
    assert any(text in one for one in march.assumptions)
    dataset = march.to_dataset()
    np.testing.assert_array_equal(dataset.samples, march.samples)
    assert dataset.samples.dims == ("omega",)
    march.save(tmp_path / "march.nc")
    loaded = ss.load(tmp_path / "march.nc")
    np.testing.assert_array_equal(loaded.samples, march.samples)
    assert loaded.settings == march.settings
    index = march.index(190.0)
    force = march.contact_force((0, 0), index, 512)
    np.testing.assert_array_equal(loaded.contact_force((0, 0), index, 512), force)
    assert np.abs(force - frf.contact_force((0, 0), index, 512)).max() < 0.01 * 246.048
    rows = dict(CurveView().facts(march))
    assert rows["samples"] == f"auto, 64 to {march.samples.max()} per period"
    assert (
        dict(CurveView().facts(beam(evaluation="marched", samples=64)))["samples"]
        == "64 per period"
    )
    assert "samples" not in dict(CurveView().facts(frf))


def test_files_without_samples_per_point_are_read_as_long_as_the_settings_name_them():
    march = beam(evaluation="marched", samples=64)
    model, index = march.model, march.index(190.0)
    old = march.to_dataset().drop_vars("samples")
    again = ss.ForcedResponse.from_dataset(old, model)
    assert set(again.samples) == {64}
    force = march.contact_force((0, 0), index)
    np.testing.assert_array_equal(again.contact_force((0, 0), index), force)
    exact = beam().to_dataset().drop_vars("samples")
    exact.attrs["settings"] = exact.attrs["settings"].replace(
        '"samples": "auto"', '"samples": null'
    )
    assert not ss.ForcedResponse.from_dataset(exact, model).samples.any()
    old.attrs["settings"] = old.attrs["settings"].replace('"samples": 64', '"samples": null')
    with pytest.raises(KeyError, match="samples"):
        ss.ForcedResponse.from_dataset(old, model)


@pytest.mark.slow
def test_peaks_and_sensitivities_of_automatic_samples(frf):
    march = beam(evaluation="marched")
    assert march.peak("tip").amplitude == pytest.approx(frf.peak("tip").amplitude, rel=3e-4)
    slope = {"parameter": "slip_force", "contact": 0}
    there = [one.sensitivity("tip", **slope)[30] for one in (march, frf)]
    assert there[0] == pytest.approx(there[1], rel=0.02)
    # With few samples the top has several maxima of nearly one height, and slopes of their own.
    fine = beam(evaluation="marched", tolerance=1e-4)
    peaks = [one.peak_sensitivity("tip", **slope) for one in (fine, frf)]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.02)
    both = ss.forced_response(snecma_beam(), (150.0, 250.0), evaluation="marched")
    exact = ss.forced_response(snecma_beam(), (150.0, 250.0))
    assert both.converged.all()
    assert both.peak("tip").amplitude == pytest.approx(exact.peak("tip").amplitude, rel=1e-3)


def test_a_limit_of_samples_is_a_status_with_advice():
    march = beam(evaluation="marched", tolerance=1e-5, max_samples=256)
    limited = np.array([status == ss.Status.SAMPLES_LIMIT for status in march.status])
    assert limited.any()
    assert not limited.all()
    assert (march.samples[limited] == 256).all()
    assert np.isfinite(march.amplitude("tip")).all()
    assert "raise max_samples" in ss.Status.SAMPLES_LIMIT.advice
    assert ss.Status.SAMPLES_LIMIT.solved
    assert any(f"{limited.sum()} samples limit" in one for one in march.assumptions)


@pytest.mark.slow
@settings(max_examples=15)
@given(
    stiffness=st.floats(0.05, 20.0),
    limit=st.floats(0.05, 3.0),
    damping=st.floats(0.005, 0.05),
    mass=st.floats(0.3, 3.0),
)
def test_automatic_samples_of_random_systems(stiffness, limit, damping, mass):
    chain = np.array([[2.0, -1.0], [-1.0, 2.0]])
    structure = ss.Structure(
        mass=np.diag([1.0, mass]), stiffness=chain, damping=damping * chain, dofs=["a", "b"]
    )
    contacts = [
        ss.Jenkins("a", stiffness=stiffness, slip_force=limit),
        ss.StructuralDamper(
            ["a", "b", None],
            stiffness=stiffness * np.array([[3.0, -1, -2], [-1, 2, -1], [-2, -1, 3]]),
            slip_forces=[limit, 0.3 * limit, np.inf],
        ),
    ]
    model = ss.Model(structure, contacts=contacts, forces=[ss.Force("b", amplitude=1.0)])
    omega = np.linspace(0.6, 2.4, 12)
    exact = ss.forced_response(model, omega, harmonics=5)
    march = ss.forced_response(model, omega, harmonics=5, evaluation="marched", tolerance=1e-2)
    assert march.converged.all()
    for dof in "ab":
        apart = np.abs(march.coefficients(dof) - exact.coefficients(dof)).sum(axis=1)
        size = np.abs(exact.coefficients(dof)).max(axis=1)
        assert (apart < 1e-2 * np.maximum(size, 1e-3 * size.max())).all()


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"method": "broiden"}, r"method: unknown choice 'broiden'; did you mean 'broyden'\?"),
        ({"jacobian": "differences"}, "jacobian: .* give method='broyden' with it"),
        ({"jacobian": "numeric", "method": "broyden"}, "jacobian: unknown choice 'numeric'"),
        ({"evaluation": "sampled"}, "evaluation: unknown choice 'sampled'"),
        ({"samples": 512}, "samples: 512 for the exact evaluation.*evaluation='marched'"),
        ({"evaluation": "marched", "samples": 38}, "samples: 38 .* up to 9; .* number from 40"),
        ({"evaluation": "marched", "samples": 513}, "samples: 513 .* an even number from 40"),
        ({"evaluation": "marched", "samples": 51.2}, "samples: 51.2 is not an integer"),
        ({"evaluation": "marched", "samples": 512, "harmonics": "auto"}, "up to 255; .* 1024"),
        (
            {"evaluation": "marched", "samples": "many"},
            "unknown choice 'many'.* or a whole",
        ),
        ({"evaluation": "marched", "max_samples": 1000}, "max_samples: 1000 is not a power of two"),
        (
            {"evaluation": "marched", "max_samples": 32},
            "max_samples: 32 for .* up to 9; .* 40",
        ),
        ({"evaluation": "marched", "max_samples": 16}, "max_samples: 16 lies below 32"),
    ],
)
def test_settings_that_do_not_fit_are_refused(settings, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(snecma_beam(), BAND, **{"harmonics": 9} | settings)


def test_a_study_file_chooses_solver_and_evaluation():
    text = """
    [structure]
    mass = [[1.0]]
    stiffness = [[100.0]]
    [[contact]]
    law = "jenkins"
    dof = 0
    stiffness = 20.0
    slip_force = 1.0
    [[force]]
    dof = 0
    amplitude = 2.0
    [analysis]
    omega = [8.0, 9.0]
    harmonics = 5
    method = "broyden"
    jacobian = "differences"
    evaluation = "marched"
    samples = 64
    """
    (result,) = Study.parse(text).run()
    settings = result.settings
    assert (settings.method, settings.jacobian) == ("broyden", "differences")
    assert settings.march == 64
    assert result.converged.all()
    assert set(result.samples) == {64}
    (automatic,) = Study.parse(text.replace("= 64", '= "auto"\nmax_samples = 4096')).run()
    assert (automatic.settings.march, automatic.settings.max_samples) == ("auto", 4096)
    assert automatic.converged.all()
    assert automatic.samples.max() <= 4096
    with pytest.raises(ss.ModelError, match="samples: 64 for harmonics up to 31"):
        Study.parse(text.replace("harmonics = 5", "harmonics = 31"))

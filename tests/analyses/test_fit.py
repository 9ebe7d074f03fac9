"""Parameters fitted to measurements that another integrator made, with noise."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses.profile import _walked_end

TRUE = {"stiffness": 2.1e7, "slip_force": 200.0}
BEAM = ss.reference.snecma_beam()
OMEGA = np.linspace(120.0, 240.0, 40)
BOUNDS = {"jenkins.stiffness": (1e6, 1e9), "slip_force": (10.0, 1000.0)}


def model(level: float, **parameters: float) -> ss.Model:
    contact = ss.Jenkins("damper", **{"stiffness": 2.4e7, "slip_force": 246.0} | parameters)
    return ss.Model(BEAM.structure, [contact], [ss.Force("tip", amplitude=level)])


def curves(seed: int, levels=(5.0, 20.0, 60.0), noise=0.02, **more) -> list[ss.Measurement]:
    rng = np.random.default_rng(seed)
    tests = []
    for level in levels:
        exact = ss.exact_response(model(level, **TRUE), OMEGA).amplitude("tip")
        seen = exact * (1.0 + noise * rng.standard_normal(OMEGA.size))
        known = {"relative_noise": noise} | more
        own = model(level)
        tests.append(ss.Measurement(OMEGA, "tip", seen, model=own, name=f"{level:g} N", **known))
    return tests


@pytest.fixture(scope="module")
def fitted() -> ss.Fit:
    return ss.fit(model(1.0), curves(0), parameters=BOUNDS)


@pytest.mark.slow
def test_noisy_curves_of_exact_orbits_give_the_parameters_back(fitted):
    assert fitted.values["jenkins.stiffness"] == pytest.approx(2.1e7, rel=0.03)
    assert fitted.values["slip_force"] == pytest.approx(200.0, rel=0.02)
    assert all(fitted.identifiable.values())
    assert 0.8 < fitted.scatter < 1.2
    (contact,) = fitted.model.contacts
    assert contact.slip_force == fitted.values["slip_force"]


@pytest.mark.slow
def test_profiles_end_where_the_misfit_has_risen_to_its_limit(fitted):
    """Refits with one parameter held at an end, by an optimiser that knows nothing of profiles."""
    from scipy.optimize import minimize_scalar

    rise = 1.959963984540054**2
    for name, other in (("slip_force", "jenkins.stiffness"), ("jenkins.stiffness", "slip_force")):
        for end in fitted.intervals[name]:

            def misfit(log, name=name, other=other, end=end):
                at = {
                    name.removeprefix("jenkins."): end,
                    other.removeprefix("jenkins."): np.exp(log),
                }
                total = 0.0
                for test, level in zip(curves(0), (5.0, 20.0, 60.0), strict=True):
                    said = ss.forced_response(model(level, **at), OMEGA, tolerance=1e-4)
                    total += (((said.amplitude("tip") - test.observed) / test.deviation) ** 2).sum()
                return total

            middle = np.log(fitted.values[other])
            found = minimize_scalar(misfit, bounds=(middle - 0.1, middle + 0.1), method="bounded")
            assert found.fun - fitted.misfit == pytest.approx(rise, rel=0.02)


@pytest.mark.slow
def test_intervals_do_not_depend_on_where_in_a_valley_the_fit_ends():
    """Nothing slips: slip forces above 9.76 N fit alike, and the search ends at any of them."""
    rig = ss.Structure(
        np.diag([1.0, 0.5]),
        [[3e5, -1e5], [-1e5, 2e5]],
        ss.Rayleigh(mass=0.0, stiffness=1e-4),
        ["blade", "platform"],
    )
    pad = ss.Jenkins("platform", stiffness=2e5, slip_force=12.0, name="pad")
    stuck = ss.Model(rig, [pad], [ss.Force("blade", 2.0)])
    omega = np.linspace(380, 680, 16)
    seen = ss.forced_response(stuck, omega, 5).amplitude("blade")
    test = ss.Measurement(omega, "blade", seen, relative_noise=0.02)

    def intervals(highest):
        bounds = {
            "pad.stiffness": (1e4, 1e7),
            "pad.slip_force": (0.5, highest),
            "damping.stiffness": (1e-6, 1e-2),
        }
        return ss.fit(stuck, [test], parameters=bounds, harmonics=5).intervals

    wide = intervals(200.0)
    for highest in (25.0, 150.0):
        found = intervals(highest)
        for name in ("pad.stiffness", "damping.stiffness"):
            assert found[name] == pytest.approx(wide[name], rel=1e-4)
        assert found["pad.slip_force"] == pytest.approx((wide["pad.slip_force"][0], highest))


def test_a_walk_that_does_not_leave_the_best_fit_has_no_end():
    class Narrow:
        """A misfit that rises at once."""

        def at(self, place):
            misfit = 1e10 * abs(place[0] - 0.5)
            return SimpleNamespace(misfit=misfit)

    assert _walked_end(Narrow(), np.array([0.5]), 0, 1, 1.0) is None


@pytest.mark.slow
def test_covariance_agrees_with_profiles_where_the_model_bends_little(fitted):
    quick = ss.fit(model(1.0), curves(0), parameters=BOUNDS, intervals="covariance")
    for name, ends in quick.intervals.items():
        width = fitted.intervals[name][1] - fitted.intervals[name][0]
        assert ends == pytest.approx(fitted.intervals[name], abs=0.1 * width)


@pytest.mark.slow
def test_noise_that_is_not_given_is_estimated():
    free = ss.fit(model(1.0), curves(1, relative_noise=None), parameters=BOUNDS)
    assert free.scatter == pytest.approx(0.02, rel=0.2)
    assert not free.noise_known
    assert "noise-estimated" in {one.code for one in free.diagnostics}


@pytest.mark.slow
def test_what_the_data_do_not_determine_is_named():
    # A contact that never slips at the only level tells nothing of its slip force beyond a bound.
    found = ss.fit(model(1.0), curves(2, levels=(0.05,)), parameters=BOUNDS)
    assert not found.identifiable["slip_force"]
    assert found.identifiable["jenkins.stiffness"]
    (said,) = [one for one in found.diagnostics if one.code == "not-determined"]
    assert said.data["parameter"] == "slip_force"
    assert found.intervals["slip_force"][1] == pytest.approx(1000.0)


@pytest.mark.slow
def test_parameters_known_only_together_are_named():
    structure = BEAM.structure
    pads = [
        ss.Jenkins("damper", stiffness=1e7, slip_force=1e9, name=name) for name in ("one", "two")
    ]
    both = ss.Model(structure, pads, [ss.Force("tip", amplitude=1.0)])
    seen = ss.forced_response(both, OMEGA, harmonics=1).amplitude("tip")
    found = ss.fit(
        both,
        ss.Measurement(OMEGA, "tip", seen, relative_noise=0.02),
        parameters={"one.stiffness": (1e6, 1e8), "two.stiffness": (1e6, 1e8)},
    )
    assert "tied" in {one.code for one in found.diagnostics}
    assert found.correlation("one.stiffness", "two.stiffness") < -0.98


@pytest.mark.slow
def test_damping_is_fitted_by_its_law():
    found = ss.fit(model(1.0), curves(3), parameters=BOUNDS | {"damping.stiffness": (1e-6, 1e-3)})
    low, high = found.intervals["damping.stiffness"]
    assert low < 2.6e-5 < high


@pytest.mark.slow
def test_level_is_fitted():
    tests = [one.on(model(level)) for one, level in zip(curves(4), (4.0, 16.0, 48.0), strict=True)]
    found = ss.fit(model(1.0), tests, parameters={"level": (0.5, 2.0)} | BOUNDS)
    # Forces too small by a fifth in every model, and the slip force with them.
    assert found.values["level"] == pytest.approx(1.25, rel=0.02)


@pytest.mark.slow
def test_peaks_are_fitted():
    tests = []
    for level in (5.0, 20.0, 60.0):
        peak = ss.forced_response(model(level, **TRUE), (100.0, 260.0)).peak("tip")
        own = model(level)
        tests.append(
            ss.MeasuredPeak(
                "tip",
                peak.amplitude,
                peak.omega,
                span=(100.0, 260.0),
                relative_noise=0.02,
                frequency_noise=1e-3,
                model=own,
            )
        )
    found = ss.fit(model(1.0), tests, parameters=BOUNDS, intervals="covariance")
    assert found.values["slip_force"] == pytest.approx(200.0, rel=5e-3)
    assert found.values["jenkins.stiffness"] == pytest.approx(2.1e7, rel=5e-3)


@pytest.mark.slow
def test_loops_are_fitted():
    """Loops of a Jenkins element in closed form: a march from sample to sample."""
    rng = np.random.default_rng(0)
    tests = []
    for amplitude in (5e-6, 2e-5, 5e-5):
        u = amplitude * np.cos(2.0 * np.pi * np.arange(400) / 400)
        force, f = np.empty(400), 0.0
        for _lap in range(2):
            for n in range(400):
                f = float(np.clip(f + 2.1e7 * (u[n] - u[n - 1]), -200.0, 200.0))
                force[n] = f
        force += 0.02 * np.abs(force).max() * rng.standard_normal(400)
        tests.append(ss.MeasuredLoop("jenkins", u, force, relative_noise=0.02))
    found = ss.fit(model(1.0), tests, parameters=BOUNDS)
    assert found.values["slip_force"] == pytest.approx(200.0, rel=0.01)
    assert found.values["jenkins.stiffness"] == pytest.approx(2.1e7, rel=0.01)


def loop_of_sliders(amplitude, stiffness, slip_force, chi, beta, samples=400, sliders=4000):
    """A loop of Segalman's density of sliders, each followed from sample to sample."""
    share = beta + (chi + 1.0) / (chi + 2.0)
    longest = slip_force * (1.0 + beta) / (stiffness * share)
    density = slip_force * (chi + 1.0) / (longest ** (chi + 2.0) * share)
    reach = longest * ((np.arange(sliders) + 0.5) / sliders) ** (1.0 / (chi + 1.0))
    each = density * longest ** (chi + 1.0) / (chi + 1.0) / sliders
    reach = np.append(reach, longest)
    springs = np.append(np.full(sliders, each), slip_force / longest * beta / share)
    u = amplitude * np.cos(2.0 * np.pi * np.arange(samples) / samples)
    force, x = np.empty(samples), np.zeros(sliders + 1)
    for _ in range(2):
        for n, at in enumerate(u):
            x = np.clip(x, at - reach, at + reach)
            force[n] = springs @ (at - x)
    return u, force


@pytest.mark.slow
def test_four_parameters_of_an_iwan_joint_follow_from_three_noisy_loops():
    rng = np.random.default_rng(3)
    true = {"stiffness": 2e6, "slip_force": 1000.0, "chi": -0.6, "beta": 0.5}
    tests = []
    for amplitude in (2e-4, 6e-4, 2e-3):
        u, force = loop_of_sliders(amplitude, **true)
        force = force + 0.02 * np.abs(force).max() * rng.standard_normal(force.size)
        tests.append(ss.MeasuredLoop("iwan", u, force, harmonics=1, relative_noise=0.02))
    joint = ss.Iwan("tip", stiffness=1e6, slip_force=500.0, chi=-0.3, beta=0.1)
    bounds = {"stiffness": (1e5, 1e8), "slip_force": (10, 1e5), "chi": (-0.95, 0), "beta": (0, 5)}
    found = ss.fit(ss.Model(BEAM.structure, [joint]), tests, parameters=bounds)
    assert found.values["stiffness"] == pytest.approx(2e6, rel=0.01)
    assert found.values["slip_force"] == pytest.approx(1000.0, rel=0.01)
    assert found.values["chi"] == pytest.approx(-0.6, abs=0.05)
    for name, (low, high) in found.intervals.items():
        assert low < true[name] < high


@pytest.mark.slow
def test_laws_are_compared_by_a_criterion(fitted):
    wrong = ss.Model(
        BEAM.structure,
        [ss.Jenkins("damper", stiffness=1e7, slip_force=np.inf)],
        [ss.Force("tip", amplitude=1.0)],
    )
    tests = [
        one.on(wrong.scaled(force=level))
        for one, level in zip(curves(0), (5.0, 20.0, 60.0), strict=True)
    ]
    other = ss.fit(wrong, tests, parameters={"stiffness": (1e6, 1e9)}, intervals="covariance")
    both = ss.compare_fits({"jenkins": fitted, "spring": other})
    assert both.best == "jenkins"
    assert both.weights["jenkins"] == pytest.approx(1.0)
    assert "misfit-above-noise" in {one.code for one in other.diagnostics}
    assert str(both).count("\n") == 2


@pytest.mark.parametrize("share", [0.1, 0.3, 0.7])
@pytest.mark.slow
def test_ctrl_c_keeps_the_best_values_so_far(share):
    def press(done):
        if done > share:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        ss.fit(model(1.0), curves(0), parameters=BOUNDS, progress=press)
    if share < 0.18:
        # Starts were still being compared.
        assert not isinstance(stopped.value, ss.Interrupted)
        return
    kept = stopped.value.result
    assert kept.interrupted
    low, high = kept.intervals["slip_force"]
    assert low < kept.values["slip_force"] < high
    assert kept.values["slip_force"] == pytest.approx(200.0, rel=0.05)


@pytest.mark.slow
def test_a_fit_is_saved_and_loaded(fitted, tmp_path):
    fitted.save(tmp_path / "fit.nc")
    again = ss.load(tmp_path / "fit.nc")
    assert again.values == fitted.values
    assert again.intervals == fitted.intervals
    assert again.names == fitted.names
    assert again.diagnostics == fitted.diagnostics


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"pad.stiffness": (1.0, 2.0)}, "unknown contact 'pad'"),
        ({"friction": (0.1, 1.0)}, "unknown parameter 'friction'"),
        ({"slip_force": (2.0, 1.0)}, "give lowest < highest"),
        ({"damping.ratio": (0.001, 0.1)}, "Rayleigh"),
        ({"slip_force": (-1.0, 1.0)}, "negative"),
        ({}, "give {'friction'"),
    ],
)
def test_bad_parameters_are_refused(parameters, said):
    test = ss.Measurement(OMEGA, "tip", np.ones(40))
    with pytest.raises(ss.ModelError, match=said):
        ss.fit(model(1.0), test, parameters=parameters)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"omega": [1.0, 2.0], "dof": "tip", "amplitude": [1.0]}, "2 frequencies for 1"),
        ({"omega": [1.0], "dof": "tip", "amplitude": [0.0]}, "above 0"),
        ({"omega": [1.0], "dof": "tip", "amplitude": [np.nan]}, "finite"),
        (
            {"omega": [1.0], "dof": "tip", "amplitude": [1.0], "noise": 1.0, "relative_noise": 1.0},
            "one of them",
        ),
    ],
)
def test_bad_measurements_are_refused(arguments, said):
    with pytest.raises(ss.ModelError, match=said):
        ss.Measurement(**arguments)


def test_too_few_numbers_are_refused():
    with pytest.raises(ss.ModelError, match="1 numbers for 2 parameters"):
        ss.fit(model(1.0), ss.Measurement([170.0], "tip", [1e-3]), parameters=BOUNDS)


@pytest.mark.parametrize("levels", [1, 3])
def test_a_parameter_that_moves_no_number_is_not_identifiable(levels):
    """The damper sticks: its slip force changes nothing."""
    own = ss.forced_response(model(0.01), OMEGA[:levels], harmonics=3).amplitude("tip")
    test = ss.Measurement(OMEGA[:levels], "tip", own, model=model(0.01), relative_noise=0.02)
    found = ss.fit(model(0.01), [test], parameters={"slip_force": (10.0, 1000.0)})
    assert found.intervals["slip_force"] == pytest.approx((10.0, 1000.0))
    assert not found.identifiable["slip_force"]

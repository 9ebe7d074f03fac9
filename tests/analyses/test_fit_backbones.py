"""Parameters fitted to backbones: closed forms, decaying vibrations, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss

MASS, STIFFNESS, DAMPING = 1.0, 1e4, 0.4
TRUE = {"pad.stiffness": 4000.0, "slip_force": 1.0}
BOUNDS = {"pad.stiffness": (1e3, 1e5), "slip_force": (0.1, 10.0)}
AMPLITUDE = np.geomspace(1e-4, 4e-3, 20)
NOISE = {"frequency_noise": 0.002, "damping_noise": 0.02}


def model(stiffness: float = 3000.0, slip_force: float = 2.0) -> ss.Model:
    structure = ss.Structure([[MASS]], [[STIFFNESS]], [[DAMPING]], ["tip"])
    pad = ss.Jenkins("tip", stiffness=stiffness, slip_force=slip_force, name="pad")
    return ss.Model(structure, [pad])


def closed_form(amplitude):
    """Return frequency and damping ratio of a mass with one Jenkins element, of one harmonic."""
    k, f = TRUE.values()
    turn = np.arccos(np.clip(1.0 - 2.0 * f / (k * amplitude), -1.0, 1.0))
    omega = np.sqrt((STIFFNESS + k / np.pi * (turn - 0.5 * np.sin(2.0 * turn))) / MASS)
    lost = 4.0 * f / np.pi * np.maximum(1.0 - f / (k * amplitude), 0.0) / amplitude
    return omega, (DAMPING * omega + lost) / (2.0 * MASS * omega**2)


def noisy(seed: int, **more) -> ss.MeasuredBackbone:
    rng = np.random.default_rng(seed)
    omega, ratio = closed_form(AMPLITUDE)
    return ss.MeasuredBackbone(
        AMPLITUDE,
        omega * (1.0 + 0.002 * rng.standard_normal(AMPLITUDE.size)),
        ratio * (1.0 + 0.02 * rng.standard_normal(AMPLITUDE.size)),
        **NOISE | more,
    )


@pytest.fixture(scope="module")
def fitted() -> ss.Fit:
    return ss.fit(model(), noisy(0), parameters=BOUNDS, harmonics=1)


def test_a_noisy_closed_form_gives_the_parameters_back(fitted):
    assert fitted.values == pytest.approx(TRUE, rel=0.02)
    assert all(fitted.identifiable.values())
    for name, (low, high) in fitted.intervals.items():
        assert low < TRUE[name] < high
    assert fitted.dofs == ()
    count = AMPLITUDE.size
    np.testing.assert_array_equal(fitted.arrays.abscissa, np.tile(AMPLITUDE, 2))
    assert fitted.arrays.predicted[:count] == pytest.approx(closed_form(AMPLITUDE)[0], rel=1e-3)
    assert fitted.arrays.predicted[count:] == pytest.approx(closed_form(AMPLITUDE)[1], rel=0.02)


@pytest.mark.slow
def test_intervals_hold_the_truth_in_most_seeds():
    held = 0
    for seed in range(20):
        found = ss.fit(model(), noisy(seed), parameters=BOUNDS, harmonics=1)
        assert found.values["slip_force"] == pytest.approx(1.0, rel=0.02)
        held += sum(low < TRUE[name] < high for name, (low, high) in found.intervals.items())
    # 95 % of 40 are 38.
    assert 34 <= held <= 40


@pytest.mark.slow
def test_a_decay_in_time_gives_the_friction_back():
    """Free vibration, exact from event to event, evaluated from extreme to extreme."""
    from scipy.interpolate import CubicSpline

    run = ss.transient(model(400.0, 0.1), 100.0, 200, start={"tip": 5e-3}, samples=256, keep=200)
    course = CubicSpline(run.time, run.displacement("tip"))
    instants = course.derivative().roots(extrapolate=False)
    height = np.abs(course(instants))
    omega = 2.0 * np.pi / (instants[2:] - instants[:-2])
    ratio = np.log(height[:-2] / height[2:]) / (2.0 * np.pi)
    # Of every second period; above where the contact sticks, below the first period.
    own = (height[1:-1] > 3e-4) & (height[1:-1] < 4e-3) & (np.arange(omega.size) % 4 == 0)
    count = int(own.sum())
    assert count > 30
    for seed in range(3):
        rng = np.random.default_rng(seed)
        test = ss.MeasuredBackbone(
            height[1:-1][own],
            omega[own] * (1.0 + 0.002 * rng.standard_normal(count)),
            ratio[own] * (1.0 + 0.02 * rng.standard_normal(count)),
            dof="tip",
            **NOISE,
        )
        found = ss.fit(
            model(300.0, 0.2),
            test,
            parameters={"pad.stiffness": (1e2, 1e4), "slip_force": (0.01, 1.0)},
            harmonics=7,
            intervals="covariance",
        )
        assert found.values["slip_force"] == pytest.approx(0.1, rel=0.02)
        assert found.values["pad.stiffness"] == pytest.approx(400.0, rel=0.03)
        assert found.scatter < 1.2


@pytest.mark.slow
def test_any_order_and_repeated_amplitudes_are_taken():
    draw = np.random.default_rng(5).permutation(np.tile(np.arange(AMPLITUDE.size), 2))
    omega, ratio = closed_form(AMPLITUDE)
    test = ss.MeasuredBackbone(AMPLITUDE[draw], omega[draw], ratio[draw], dof="tip", **NOISE)
    found = ss.fit(model(), test, parameters=BOUNDS, harmonics=1, intervals="covariance")
    assert found.values == pytest.approx(TRUE, rel=1e-6)
    assert found.misfit < 1e-6
    assert found.dofs == ("tip",)


@pytest.mark.slow
def test_amplitudes_of_a_degree_of_freedom_are_met():
    """Of a beam, whose shape changes as its contact slips."""
    beam = ss.reference.snecma_beam()

    def pad(stiffness: float, slip_force: float) -> ss.Model:
        contact = ss.Jenkins("damper", stiffness=stiffness, slip_force=slip_force)
        return ss.Model(beam.structure, [contact])

    modes = ss.nonlinear_modes(
        pad(2.1e7, 200.0), amplitude=np.geomspace(1e-4, 1e-2, 8), harmonics=3
    )
    for measure in ("half_range", "fundamental"):
        test = ss.MeasuredBackbone(
            modes.displacement_amplitude("tip", measure),
            modes.omega,
            modes.damping_ratio,
            dof="tip",
            measure=measure,
            **NOISE,
        )
        found = ss.fit(
            pad(2.4e7, 246.0),
            test,
            parameters={"stiffness": (1e7, 5e7), "slip_force": (100.0, 400.0)},
            harmonics=3,
            intervals="covariance",
        )
        assert found.values["slip_force"] == pytest.approx(200.0, rel=1e-5)
        assert found.values["stiffness"] == pytest.approx(2.1e7, rel=1e-5)
        assert found.arrays.predicted == pytest.approx(test.observed, rel=1e-6)


def test_noise_of_one_quantity_may_be_unknown():
    test = noisy(2)
    alone = ss.MeasuredBackbone(AMPLITUDE, damping_ratio=test.damping_ratio)
    found = ss.fit(model(4000.0), alone, parameters={"slip_force": (0.1, 10.0)}, harmonics=1)
    assert not found.noise_known
    assert found.scatter == pytest.approx(0.02, rel=0.35)
    assert found.values["slip_force"] == pytest.approx(1.0, rel=0.02)


def test_slopes_are_those_of_the_closed_form():
    from stickslip.analyses.fit_parameters import FitParameter
    from stickslip.analyses.prediction import Prediction
    from stickslip.settings.balance import HarmonicSettings

    parameters = [FitParameter(name, *ends) for name, ends in BOUNDS.items()]
    test, keys = noisy(0), HarmonicSettings.of(harmonics=1)
    found = Prediction(test, model(), parameters, np.array([4000.0, 1.0]), keys).slopes
    for place, (name, value) in enumerate(TRUE.items()):
        sides = []
        for factor in (1.0 - 1e-6, 1.0 + 1e-6):
            TRUE[name] = value * factor
            sides.append(np.concatenate(closed_form(AMPLITUDE)))
        TRUE[name] = value
        slope = (sides[1] - sides[0]) / (2e-6 * value)
        # Where slip has not begun within a step of the difference.
        assert found[:, place] == pytest.approx(slope, abs=1e-3 * np.abs(slope).max())


def test_a_fit_to_backbones_is_saved_and_drawn(fitted, tmp_path):
    fitted.save(tmp_path / "fit.nc")
    again = ss.load(tmp_path / "fit.nc")
    np.testing.assert_array_equal(again.arrays.quantity, fitted.arrays.quantity)
    np.testing.assert_array_equal(again.arrays.against, fitted.arrays.against)
    for damping, label in ((None, "ω"), (False, "ω"), (True, "damping ratio")):
        ax = again.plot_backbone(damping=damping)
        assert ax.get_xscale() == "log"
        assert "modal amplitude" in ax.get_xlabel()
        if damping:
            assert ax.get_ylabel() == label
        points = ax.lines[0]
        np.testing.assert_array_equal(points.get_xdata(), AMPLITUDE)
    with pytest.raises(ss.ModelError, match="draw them with plot_backbone"):
        again.plot()


def test_places_without_a_mode_do_not_end_a_fit(monkeypatch):
    """A trial whose mode has no motion at small amplitudes counts as a misfit."""
    from stickslip.analyses import prediction

    every, lost = prediction.nonlinear_modes, []

    def failing(model, *, amplitude, **keys):
        modes = every(model, amplitude=amplitude, **keys)
        if model.contacts[0].slip_force < 3.0 or len(amplitude) > 1:
            return modes
        lost.append(model)
        nowhere = np.full_like(modes.arrays.displacement, np.nan)
        return replace(modes, arrays=replace(modes.arrays, displacement=nowhere))

    monkeypatch.setattr(prediction, "nonlinear_modes", failing)
    tested, keys = noisy(0, dof="tip"), {"harmonics": 1, "intervals": "covariance"}
    fit = ss.fit(model(slip_force=4.0), tested, parameters=BOUNDS, **keys)
    assert lost
    assert fit.values == pytest.approx(TRUE, rel=0.02)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"amplitude": [1.0]}, "no numbers; give omega, damping_ratio or both"),
        ({"amplitude": [1.0, 2.0], "omega": [1.0]}, "2 amplitudes for 1 of omega"),
        ({"amplitude": [0.0], "omega": [1.0]}, "above 0"),
        ({"amplitude": [1.0], "damping_ratio": [-0.1]}, "above 0"),
        ({"amplitude": [1.0], "omega": [np.nan]}, "finite"),
        ({"amplitude": [1.0], "omega": [1.0], "damping_ratio": [0.1]}, "the noise of each"),
        ({"amplitude": [1.0], "omega": [1.0], "frequency_noise": 0.0}, "above 0"),
        ({"amplitude": [1.0], "omega": [1.0], "mode": -1}, "mode"),
        ({"amplitude": [1.0], "omega": [1.0], "dof": "tip", "measure": "rms"}, "measure"),
    ],
)
def test_bad_backbones_are_refused(arguments, said):
    with pytest.raises(ss.ModelError, match=said):
        ss.MeasuredBackbone(**arguments)


def test_a_degree_of_freedom_that_is_none_is_refused():
    test = ss.MeasuredBackbone([1e-3], [100.0], dof="tipp", frequency_noise=0.01)
    with pytest.raises(ss.ModelError, match="tipp"):
        ss.fit(model(), test, parameters={"slip_force": (0.1, 10.0)})

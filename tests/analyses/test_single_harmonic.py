"""Griffin's method, corrected, and the improved damper displacement."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import (
    DAMPER_SLIP_FORCE,
    DAMPER_STIFFNESS,
    SNECMA_LOADS,
    beam_pair,
    single_dof,
    snecma_beam,
)
from stickslip.study import Study

GRID = np.linspace(20.0, 350.0, 400)
SLIP = DAMPER_SLIP_FORCE / DAMPER_STIFFNESS

# Peaks of one harmonic at the tip [1e-3 m] and at the damper [1e-5 m]: Guillen (1999), Table 2.3,
# with two digits more.
PEAKS = (
    (0.3709, 0.5700),
    (0.7055, 1.1167),
    (0.8722, 2.2520),
    (1.1802, 6.2252),
    (1.3648, 8.5232),
    (1.7345, 12.7750),
    (2.8231, 24.1648),
    (5.2352, 47.8855),
)


@pytest.mark.parametrize(("load", "peaks"), list(zip(SNECMA_LOADS, PEAKS, strict=True)))
def test_every_load_agrees_with_the_balance_of_one_harmonic_and_the_table(load, peaks):
    model = snecma_beam(load)
    frf, other = ss.single_harmonic(model, GRID), ss.forced_response(model, GRID, harmonics=1)
    assert frf.converged.all()
    for dof in frf.dofs:
        np.testing.assert_allclose(frf.coefficients(dof), other.coefficients(dof), rtol=1e-9)
        estimates = frf.error_estimate(dof), other.error_estimate(dof)
        np.testing.assert_allclose(*estimates, rtol=1e-6, atol=1e-9 * frf.amplitude(dof).max())
    assert frf.peak("tip").amplitude == pytest.approx(1e-3 * peaks[0], rel=1e-4)
    assert frf.peak("damper").amplitude == pytest.approx(1e-5 * peaks[1], rel=1e-4)
    assert frf.half_wave
    assert set(frf.harmonics) == {1}


@pytest.mark.parametrize("force", [10.0, 40.0])
def test_several_dampers_keep_their_phases(force):
    for phase in (0.0, 1.0, np.pi):
        model = beam_pair(force, phase=phase)
        frf, other = ss.single_harmonic(model, GRID), ss.forced_response(model, GRID, harmonics=1)
        assert frf.converged.all()
        size = np.abs(other.arrays.displacement).max(axis=(1, 2))
        difference = np.abs(frf.arrays.displacement - other.arrays.displacement).max(axis=(1, 2))
        assert (difference / size).max() < 1e-9
        np.testing.assert_allclose(
            frf.arrays.dissipation, other.arrays.dissipation, rtol=1e-6, atol=1e-9
        )


def test_the_result_says_what_it_is():
    frf = ss.single_harmonic(snecma_beam(), GRID[::40], estimate=False)
    assert np.isnan(frf.error_estimate("tip")).all()
    assert "Griffin" in frf.assumptions[0]
    assert any("estimate=True" in text for text in frf.assumptions)
    full = ss.single_harmonic(snecma_beam(), GRID[::40], observe=["tip"])
    assert not any("estimate=True" in text for text in full.assumptions)
    assert full.dofs == ("tip",)
    np.testing.assert_array_equal(full.amplitude("tip"), frf.amplitude("tip"))


@pytest.mark.parametrize(
    ("model", "settings", "message"),
    [
        (None, {}, "model: None is not a Model"),
        (snecma_beam(), {"omega": (20.0, 350.0)}, r"omega: \(20.0, 350.0\) is a range"),
        (snecma_beam(), {"estimate": 1}, "estimate: 1; give True or False"),
        (snecma_beam(), {"observe": "tipp"}, "did you mean 'tip'"),
        (snecma_beam(), {"max_iterations": 0}, "max_iterations: 0 lies below 1"),
    ],
)
def test_wrong_arguments_are_refused(model, settings, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.single_harmonic(model, **{"omega": GRID} | settings)


@pytest.mark.parametrize("harmonic", [0, 3])
def test_forces_of_other_harmonics_are_refused(harmonic):
    base = snecma_beam()
    other = ss.Force("damper", 5.0, harmonic=harmonic)
    with pytest.raises(
        ss.ModelError, match=f"force 2 at 'damper': harmonic {harmonic}; .* use forc"
    ):
        ss.single_harmonic(ss.Model(base.structure, base.contacts, [*base.forces, other]), GRID)


@pytest.mark.slow
def test_interruption_keeps_what_was_solved():
    def stop(share):
        if share > 0.0:
            raise KeyboardInterrupt

    with pytest.raises(
        ss.Interrupted, match="single-harmonic response interrupted after"
    ) as caught:
        ss.single_harmonic(snecma_beam(), np.linspace(150.0, 250.0, 2_000_000), progress=stop)
    assert 0 < caught.value.result.omega.size < 2_000_000


# ------------------------------------------------------------------------ damper displacement


def test_damper_displacement_follows_table_2_1():
    """Figure 2.3: P = 0.5 F_d at 225 rad/s, against the printed procedure step by step."""
    frf = ss.single_harmonic(single_dof(0.5), [225.0])
    x = frf.contact_waveform((0, 0), 0, samples=4000)
    z = frf.damper_displacement((0, 0), 0, samples=4000)
    assert np.abs(z).max() == pytest.approx(SLIP, rel=1e-12)
    expected = np.zeros(4000)
    for _ in range(2):
        for n in range(4000):
            step = x[n] - x[n - 1]
            expected[n] = np.clip(expected[n - 1] + step, -SLIP, SLIP)
    np.testing.assert_allclose(z, expected, atol=1e-5 * SLIP)
    # One harmonic of the displacement has corners in the damper's.
    exact = ss.exact_response(single_dof(0.5), [225.0])
    true = exact.damper_displacement((0, 0), 0, samples=4000)
    assert np.abs(z - true).max() < 0.05 * SLIP


def test_damper_amplitude_is_limited_by_slip():
    model = single_dof(2.0)
    for frf in (ss.single_harmonic(model, GRID), ss.forced_response(model, GRID[::20], 9)):
        z, x = frf.damper_amplitude((0, 0)), frf.amplitude("mass")
        slips = frf.slip_fraction((0, 0)) > 0.0
        assert slips.any()
        assert not slips.all()
        np.testing.assert_allclose(z[slips], SLIP, rtol=1e-12)
        np.testing.assert_allclose(z[~slips], x[~slips], rtol=1e-9)
        assert frf.damper_amplitude(0).shape == (frf.omega.size, 1)
        index = int(np.flatnonzero(slips)[0])
        assert np.abs(frf.damper_displacement(0, index)).max() == pytest.approx(SLIP, rel=1e-3)


def test_figure_2_6_has_its_optimum_between_half_and_once_the_slip_force():
    ratios = (0.1, 0.5, 1.0, 2.0)
    peaks = [
        ss.single_harmonic(single_dof(ratio), GRID, estimate=False).peak("mass").amplitude / ratio
        for ratio in ratios
    ]
    assert max(peaks[1:3]) < min(peaks[0], peaks[3])


def test_a_spring_is_needed_for_its_deflection():
    base = single_dof()
    soft = ss.Jenkins("mass", stiffness=0.0, slip_force=1.0)
    frf = ss.single_harmonic(ss.Model(base.structure, [soft], base.forces), [100.0])
    for ask in (lambda: frf.damper_displacement(0, 0), lambda: frf.damper_amplitude(0)):
        with pytest.raises(ss.ModelError, match=r"contact 'jenkins': .* one stiffness above 0"):
            ask()


# ------------------------------------------------------------------------ study files

STUDY = """
[structure]
mass = [[944.6]]
stiffness = [[2.4e7]]
damping = [[7700.0]]
dofs = ["mass"]
[[contact]]
law = "jenkins"
dof = "mass"
stiffness = 2.4e7
slip_force = 246.048
[[force]]
dof = "mass"
amplitude = 246.048
[analysis]
kind = "single-harmonic"
omega = {from = 150, to = 230, points = 81}
levels = [0.5, 2]
"""


def test_a_study_of_a_single_harmonic():
    low, high = Study.parse(STUDY).run()
    direct = ss.single_harmonic(single_dof(2.0), np.linspace(150, 230, 81))
    np.testing.assert_array_equal(high.amplitude("mass"), direct.amplitude("mass"))
    assert np.isfinite(low.error_estimate("mass")).all()
    (plain, _) = Study.parse(STUDY + "estimate = false\n").run()
    assert np.isnan(plain.error_estimate("mass")).all()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (", points = 81", "", "omega: a range needs 'points' here"),
        ("levels", "harmonics", "unknown key 'harmonics'"),
    ],
)
def test_a_wrong_study_is_refused(old, new, message):
    with pytest.raises(ss.ModelError, match=message):
        Study.parse(STUDY.replace(old, new))

"""Quasi-static modes and phase resonance."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from joints import JENKINS, chain, one_mass


def test_the_quasi_static_mode_of_one_jenkins_element_has_its_closed_form():
    amplitudes = np.array([1e-5, 2.6e-4, 1e-3, 1e-2])
    mode = ss.nonlinear_modes(one_mass(JENKINS), amplitude=amplitudes, method="quasi-static")
    squared = 1e4 + np.minimum(4e3, 1.0 / amplitudes)
    lost = 4.0 * np.maximum(amplitudes - 2.5e-4, 0.0)
    assert mode.omega == pytest.approx(np.sqrt(squared), rel=1e-9)
    assert mode.dissipation((0, 0)) == pytest.approx(lost, rel=1e-9, abs=1e-15)
    friction = lost / (2.0 * np.pi * squared * amplitudes**2)
    assert mode.friction_ratio == pytest.approx(friction, rel=1e-8, abs=1e-12)
    assert mode.viscous_ratio == pytest.approx(1.0 / mode.omega, rel=1e-9)


@pytest.mark.parametrize(
    "law",
    [
        ss.Jenkins("x", stiffness=100.0, slip_force=0.1),
        ss.Iwan("x", stiffness=100.0, slip_force=0.1, chi=-0.5),
    ],
)
def test_a_quasi_static_mode_with_light_friction_is_the_periodic_one(law):
    # Frequencies of a secant and of a fundamental differ by less than the whole softening.
    amplitudes = np.geomspace(2e-4, 2e-2, 7)
    static, periodic = (
        ss.nonlinear_modes(one_mass(law), amplitude=amplitudes, method=method)
        for method in ("quasi-static", "periodic")
    )
    assert static.omega == pytest.approx(periodic.omega, rel=1e-3)
    assert static.damping_ratio == pytest.approx(periodic.damping_ratio, rel=5e-3)


def test_a_quasi_static_mode_of_several_contacts_loses_what_they_do():
    mode = ss.nonlinear_modes(chain(), amplitude=(1e-5, 1e-2), method="quasi-static")
    work = mode.dissipation((0, 0)) + mode.dissipation((1, 0))
    friction = work / (2.0 * np.pi * mode.omega**2 * mode.amplitude**2)
    # Springs give back what the load has put into them.
    assert friction == pytest.approx(mode.friction_ratio, rel=1e-7, abs=1e-12)
    stuck = ss.natural_frequencies(mode.model)[0]
    assert mode.omega[0] == pytest.approx(stuck, rel=1e-9)


def test_phase_resonance_is_at_quadrature_of_the_direct_response():
    model = chain(ss.Force("x", 0.3))
    amplitudes = np.geomspace(1e-4, 1e-2, 5)
    mode = ss.nonlinear_modes(model, amplitude=amplitudes, harmonics=9, method="phase-resonance")
    for index, level in enumerate(mode.force_level):
        force = ss.Force("x", 0.3 * float(level))
        direct = ss.forced_response(chain(force), [mode.omega[index]], harmonics=9)
        series = direct.coefficients("x")[0]
        assert np.angle(series[1]) == pytest.approx(-0.5 * np.pi, abs=1e-5)
        assert np.abs(series) == pytest.approx(np.abs(mode.coefficients("x")[index]), rel=1e-5)


def test_phase_resonance_of_one_mass_is_its_mode():
    # Its shape cannot change, and no harmonic tells force and damping apart.
    amplitudes = np.geomspace(1e-4, 1e-2, 5)
    keys = {"amplitude": amplitudes, "harmonics": 1}
    mode = ss.nonlinear_modes(one_mass(JENKINS), **keys)
    model = one_mass(JENKINS, force=ss.Force("x", 2.0))
    driven = ss.nonlinear_modes(model, method="phase-resonance", **keys)
    assert driven.omega == pytest.approx(mode.omega, rel=1e-9)
    assert driven.damping_ratio == pytest.approx(mode.damping_ratio, rel=1e-8)
    force = 2.0 * mode.damping_ratio * mode.omega**2 * amplitudes
    assert 2.0 * driven.force_level == pytest.approx(force, rel=1e-8)
    assert np.isnan(mode.force_level).all()


def test_true_maxima_are_beside_quadrature_where_damping_is_strong():
    for stiffness, slip, light in ((300.0, 0.1, True), (2e4, 5.0, False)):
        joint = ss.Jenkins("x", stiffness=stiffness, slip_force=slip)
        model = one_mass(joint, force=ss.Force("x", 1.0), damping=0.2)
        amplitudes = 3.0 * slip / stiffness * np.array([1.0, 2.0])
        keys = {"amplitude": amplitudes, "tolerance": 1e-5}
        mode = ss.nonlinear_modes(model, method="phase-resonance", **keys)
        omega, height = mode.direct_peaks("x")
        quadrature = mode.displacement_amplitude("x")
        assert (height > quadrature * (1.0 - 1e-5)).all()
        beside = np.abs(omega / mode.omega - 1.0)
        assert (mode.damping_ratio < 0.011).all() if light else (mode.damping_ratio > 0.1).all()
        assert (beside < 2e-5).all() if light else (beside > 2e-4).all()
    with pytest.raises(ss.ModelError, match="phase-resonance"):
        ss.nonlinear_modes(one_mass(joint), amplitude=amplitudes).direct_peaks("x")


def test_methods_say_what_they_do_not_take():
    with pytest.raises(ss.ModelError, match="give forces of harmonic 1"):
        ss.nonlinear_modes(chain(), amplitude=[1e-3], method="phase-resonance")
    force = ss.Force("x", 1.0, harmonic=3)
    with pytest.raises(ss.ModelError, match="give forces of harmonic 1"):
        ss.nonlinear_modes(chain(force), amplitude=[1e-3], method="phase-resonance")
    with pytest.raises(ss.ModelError, match="method"):
        ss.nonlinear_modes(chain(), amplitude=[1e-3], method="static")


def iwan(chi, *, further=0):
    size = 1 + further
    dofs = ["tip", "base"][:size]
    structure = ss.Structure(
        np.eye(size), 4e4 * np.diag(np.arange(1.0, size + 1.0)), 0.8 * np.eye(size), dofs
    )
    joint = ss.Iwan("tip", stiffness=7e4, slip_force=1.5, chi=chi)
    return ss.Model(structure, [joint])


@pytest.mark.parametrize("further", [0, 1])
def test_microslip_that_softens_the_first_amplitude_is_named_with_a_remedy(further):
    model, low = iwan(-0.937, further=further), 1e-8
    lost = ss.nonlinear_modes(model, mode=further, amplitude=[low], harmonics=1)
    (why,) = [one for one in lost.diagnostics if one.severity == "failure"]
    assert np.isnan(lost.omega).all()
    assert why.code == "mode-not-reached"
    static = ss.nonlinear_modes(model, mode=further, amplitude=[low], method="quasi-static")
    assert why.data["omega"] == pytest.approx(static.omega[0], rel=1e-12)
    assert ("stands apart" in why.text) == bool(further)
    # Both remedies that it names help, and agree on the frequency.
    begun = ss.nonlinear_modes(model, mode=further, amplitude=[1e-25, low], harmonics=1)
    assert begun.omega[1] == pytest.approx(static.omega[0], rel=1e-2)
    whole = ss.nonlinear_modes(model, mode=further, amplitude=(low, 1e-6), harmonics=1)
    assert [one.data["omega"] for one in whole.diagnostics if one.code == why.code] == [
        why.data["omega"]
    ]
    assert not any("up to 0" in one for one in whole.assumptions)


def test_a_free_structure_has_no_static_mode_to_tell_how_much_it_slips():
    structure = ss.Structure(np.eye(2), [[1e4, -1e4], [-1e4, 1e4]], None, ["x", "y"])
    joint = ss.Iwan("x", "y", stiffness=1e4, slip_force=1.0, chi=-0.937)
    lost = ss.nonlinear_modes(ss.Model(structure, [joint]), mode=1, amplitude=[1e-8])
    (why,) = [one for one in lost.diagnostics if one.severity == "failure"]
    assert why.code == "mode-not-reached"
    assert "none found" in repr(lost)

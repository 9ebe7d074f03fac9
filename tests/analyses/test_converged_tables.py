"""Guillen (1999), chapters II and IV: the converged numbers, met by exact orbits."""

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import single_dof, snecma_beam

# Force [N]: peak of the tip [mm] and its frequency [rad/s], peak at the damper [1e-5 m] likewise.
LOADS = {
    0.938: (0.3709, 225.58, 0.5700, 225.60),
    2.188: (0.6778, 224.19, 1.1279, 225.47),
    6.563: (0.7216, 216.49, 2.1158, 221.64),
    16.563: (1.2175, 194.01, 6.2856, 195.40),
    20.313: (1.4548, 192.93, 8.7471, 191.49),
    25.0: (1.8185, 177.98, 13.0627, 178.99),
    31.475: (2.9847, 169.05, 24.8364, 168.78),
    38.438: (6.0031, 162.43, 50.9307, 162.65),
}
# Damper stiffness [N/m]: peak at the damper at 20.313 N [1e-5 m].
STIFFNESSES = {
    2.4e4: 98.09,
    2.4e5: 92.44,
    2.4e6: 24.020,
    2.4e7: 8.7471,
    2.4e8: 6.9825,
    2.4e9: 6.7453,
    2.4e10: 6.7195,
}
# Force over slip force: peak [1e-5 m], its frequency [rad/s].
SINGLE = {0.5: (1.49967, 209.21), 1.0: (2.93748, 182.09), 2.0: (15.98269, 161.24)}


@pytest.mark.parametrize("force", LOADS)
def test_peaks_of_the_beam_by_load(force):
    tip, tip_omega, damper, damper_omega = LOADS[force]
    exact = ss.exact_response(snecma_beam(force), np.linspace(20.0, 350.0, 200))
    for dof, amplitude, omega in (
        ("tip", 1e-3 * tip, tip_omega),
        ("damper", 1e-5 * damper, damper_omega),
    ):
        peak = exact.peak(dof)
        # the table has four to six digits
        assert peak.amplitude == pytest.approx(amplitude, rel=1e-4)
        assert peak.omega == pytest.approx(omega, abs=6e-3)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_peaks_of_the_beam_by_damper_stiffness(stiffness):
    model = snecma_beam(20.313)
    contact = replace(model.contacts[0], stiffness=stiffness)
    softer = ss.Model(model.structure, [contact], model.forces)
    exact = ss.exact_response(softer, np.linspace(120.0, 260.0, 141), observe=["damper"])
    assert exact.converged.all()
    assert exact.peak("damper").amplitude == pytest.approx(1e-5 * STIFFNESSES[stiffness], rel=1e-4)


@pytest.mark.parametrize("ratio", SINGLE)
def test_peaks_of_the_single_degree_of_freedom(ratio):
    amplitude, omega = SINGLE[ratio]
    model = single_dof(ratio)
    peak = ss.exact_response(model, np.linspace(100.0, 260.0, 161)).peak(model.structure.dofs[0])
    assert peak.amplitude == pytest.approx(1e-5 * amplitude, rel=1e-6)
    assert peak.omega == pytest.approx(omega, abs=6e-3)


@pytest.mark.slow
def test_subresonances_of_the_single_degree_of_freedom():
    model = single_dof(2.0)
    exact = ss.exact_response(model, np.linspace(20.0, 80.0, 1201))
    amplitude = exact.amplitude(model.structure.dofs[0])
    inner = (amplitude[1:-1] > amplitude[:-2]) & (amplitude[1:-1] >= amplitude[2:])
    found = exact.omega[1:-1][inner]
    for omega in (66.1, 41.6, 30.3, 23.8):
        assert np.abs(found - omega).min() < 0.15


@pytest.mark.slow
def test_optima_of_the_beam():
    """Only the ratio of slip force to load counts: the print varies the load."""
    force, slip_force = 20.313, 246.048
    for dof, load, compliance in (("damper", 10.1, 3.02e-6), ("tip", 13.8, 6.72e-5)):
        best = ss.optimal_damper(snecma_beam(force), dof=dof)
        assert slip_force * force / best.slip_force == pytest.approx(load, rel=5e-3)
        assert best.amplitude / force == pytest.approx(compliance, rel=2e-3)
        if dof == "tip":
            second = best.minima[1]
            assert slip_force * force / second.value == pytest.approx(22.2, rel=5e-3)
            assert second.amplitude / force == pytest.approx(6.99e-5, rel=2e-3)

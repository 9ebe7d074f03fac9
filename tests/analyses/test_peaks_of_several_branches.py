"""Peaks of curves with jumps between their branches: those of the curve, at the price of one."""

import numpy as np
import pytest

import stickslip as ss


def against_a_stop():
    structure = ss.Structure(
        [[1.15, 0.0], [0.0, 2.52]],
        [[46100.0, -42000.0], [-42000.0, 63900.0]],
        ss.ModalDamping(3.48e-4),
        ["d0", "d1"],
    )
    stop = ss.Stop("d1", stiffness=9520.0, gap=0.00199)
    return ss.Model(structure, [stop], [ss.Force("d0", 0.116, 3.06)])


def rubbing_and_opening():
    structure = ss.Structure(
        np.diag([0.48, 1.3, 1.2]),
        [[1800.0, -1400.0, 0.0], [-1400.0, 7500.0, -1100.0], [0.0, -1100.0, 1200.0]],
        ss.ModalDamping(0.007),
        ["d0", "d1", "d2"],
    )
    contact = ss.Coulomb(
        ["d2", "d0"],
        normal=[0.29, 0.957],
        friction=0.59,
        tangential_stiffness=3600.0,
        normal_stiffness=4500.0,
        preload=0.63,
    )
    return ss.Model(structure, [contact], [ss.Force("d1", 3.5, 5.8)])


CASES = {
    "stop": (against_a_stop, "d0", (66.8, 104.0)),
    "contact": (rubbing_and_opening, "d1", (23.0, 36.0)),
}


@pytest.mark.parametrize("name", CASES)
def test_peaks_are_those_of_the_curve_at_its_price(name):
    make, dof, omega = CASES[name]
    model = make()
    curve = ss.forced_response(model, omega, observe=[dof], stability=False)
    assert curve.folds.size >= 2
    found = ss.damper_curve(model, dof=dof, level=[1.0], omega=omega)
    assert found.status == ("converged",)
    assert found.amplitude[0] > (1.0 - 1e-3) * np.nanmax(curve.amplitude(dof))
    assert found.amplitude[0] == pytest.approx(np.nanmax(curve.amplitude(dof)), rel=5e-3)
    assert found.counters["points"] < 4 * curve.omega.size

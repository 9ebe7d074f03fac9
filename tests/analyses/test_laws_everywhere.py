"""Every law without sliders in every analysis: it answers, or refuses by name."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

JOINT = {"stiffness": 5e4, "slip_force": 16.0}
ROWS = ([1e-4, 3e-4, 1e-3, 2e-3], [4.0, 9.0, 14.0, 16.0])
LAWS = {
    "iwan": ss.Iwan("x", **JOINT, chi=-0.5, beta=0.2),
    "exponential": ss.Masing("x", **JOINT, backbone="exponential"),
    "shear layer": ss.Masing("x", **JOINT, backbone="shear-layer", shear_lag=3.0),
    "table": ss.Masing("x", backbone=ROWS),
    "bouc-wen": ss.BoucWen("x", **JOINT),
}
GRID = np.linspace(150.0, 420.0, 7)
STRUCTURE = ss.Structure(np.eye(2), [[4e4, -1e4], [-1e4, 9e4]], np.diag([8.0, 10.0]), ["x", "y"])
FORCES = [ss.Force("x", 30.0)]


@pytest.mark.parametrize("name", LAWS)
def test_every_law_answers_or_is_refused_by_name(name: str) -> None:
    law = LAWS[name]
    model = ss.Model(STRUCTURE, [law], FORCES)
    balance = ss.forced_response(model, GRID, harmonics=9)
    assert balance.converged.all()
    assert ss.forced_response(model, GRID, harmonics=5, residual=2.0).converged.all()
    assert ss.forced_response(model, GRID, harmonics=5, residual="bounds").converged.all()
    ss.transient(model, omega=200.0, periods=3, scheme="rk4")
    disk = ss.BladedDisk(
        STRUCTURE,
        sectors=4,
        couplings=[ss.Coupling("y", stiffness=3e3)],
        contacts=[law],
        forces=FORCES,
        engine_order=1,
    )
    tuned = ss.forced_response(disk, GRID, harmonics=5)
    mistuned = ss.forced_response(disk.mistuned(np.zeros(4)), GRID, harmonics=5)
    assert np.allclose(tuned.amplitude("x"), mistuned.amplitude("2.x"), rtol=1e-6)
    ss.damper_curve(model, slip_force=[4.0, 16.0], dof="x", harmonics=3)
    if name == "bouc-wen":
        for refused in (
            lambda: ss.exact_response(model, GRID),
            lambda: ss.transient(model, omega=200.0, periods=3, scheme="exact"),
        ):
            with pytest.raises(ss.ModelError, match="bouc-wen has no events"):
                refused()
        with pytest.raises(ss.ModelError, match="bouc-wen, which has none"):
            ss.single_harmonic(model, GRID)
        return
    exact = ss.exact_response(model, GRID)
    assert exact.converged.all()
    assert np.allclose(exact.amplitude("x"), balance.amplitude("x"), rtol=1e-4)
    ss.transient(model, omega=200.0, periods=3, scheme="exact")
    assert ss.single_harmonic(model, GRID).converged.all()


@pytest.mark.parametrize("displacement", [1e-4, 1.08e-4, 2.8e-4, 7.3e-4])
def test_free_motions_of_a_table_fade(displacement):
    table = ss.Masing("x", backbone=([0.0, 1e-4, 3e-4, 1e-3], [0.0, 1.0, 2.0, 2.5]))
    structure = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 2e4]], ss.Rayleigh(mass=1.0), ["x", "y"]
    )
    model = ss.Model(structure, [table])
    fate = ss.classify(model, {"x": displacement})
    # Around a residual force they fade to nothing, and there seemed to repeat themselves.
    assert str(fate.motion) == "decaying"
    # Motions of rounding size pass the reversal that they began at again and again.
    assert ss.transient(model, omega=100.0, periods=400, start=fate.final).periods == 400

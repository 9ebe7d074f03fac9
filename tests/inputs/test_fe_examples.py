"""The finite-element examples: CalculiX from deck to damper, and the study of the blade."""

import importlib.util
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.study import Study

EXAMPLES = Path(__file__).parents[2] / "examples"
CCX = shutil.which("ccx")
NO_CCX = "ccx is not installed: apt install calculix-ccx"


def module(path, name):
    spec = importlib.util.spec_from_file_location(name, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


@pytest.mark.skipif(CCX is None, reason=NO_CCX)
def test_calculix_from_deck_to_damper(capsys):
    peaks = module(EXAMPLES / "calculix-plate" / "plate.py", "plate").main()
    assert "rigid-body modes   0: the structure is held" in capsys.readouterr().out
    # the damper takes more than nine tenths of the free and of the stuck peak
    assert peaks[1.0] < 0.1 * min(peaks[0.0], peaks[np.inf])


@pytest.mark.skipif(CCX is None, reason=NO_CCX)
def test_own_elements_are_those_of_calculix(tmp_path):
    skfem = pytest.importorskip("skfem")
    shutil.copy(EXAMPLES / "calculix-plate" / "plate.inp", tmp_path)
    subprocess.run([CCX, "plate"], cwd=tmp_path, check=True, capture_output=True)
    axes = np.linspace(0, 0.12, 13), np.linspace(0, 0.03, 4), np.linspace(0, 0.004, 2)
    solid = ss.Solid(skfem.MeshHex.init_tensor(*axes), 210e9, 0.3, 7850.0)
    rows = [solid.dofs.index(dof) for dof in ss.read_dofs(tmp_path / "plate.dof")]
    for end, own in ((".sti", solid.stiffness), (".mas", solid.mass)):
        theirs = ss.read_matrix(tmp_path / f"plate{end}")
        scale = np.abs(theirs).max()
        np.testing.assert_allclose(own[rows][:, rows].toarray(), theirs, rtol=0, atol=1e-12 * scale)


def test_without_calculix_the_example_says_what_to_install(monkeypatch):
    plate = module(EXAMPLES / "calculix-plate" / "plate.py", "plate")
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(SystemExit, match="apt install calculix-ccx"):
        plate.main()


def test_the_blade_study_file_is_the_reference_blade():
    study = Study.load(EXAMPLES / "turbine-blade" / "study.toml")
    reference = ss.reference.turbine_blade()
    np.testing.assert_array_equal(study.model.structure.mass, reference.structure.mass)
    np.testing.assert_array_equal(study.model.structure.stiffness, reference.structure.stiffness)
    np.testing.assert_allclose(
        study.model.structure.damping, reference.structure.damping, rtol=1e-9
    )
    for own, other in zip(study.model.forces, reference.forces, strict=True):
        assert own.dof == other.dof
        assert own.amplitude == pytest.approx(other.amplitude, rel=1e-9)
    assert study.model.contacts[0].slip_force == reference.contacts[0].slip_force


@pytest.mark.slow
def test_the_best_slip_force_of_the_blade():
    model = ss.reference.turbine_blade()
    low, high = (ss.natural_frequencies(model, slipping=which)[0] for which in ([0], []))
    best = ss.optimal_damper(model, dof="tip", omega=(0.95 * low, 1.05 * high))
    assert best.slip_force == pytest.approx(ss.reference.BLADE_SLIP_FORCE, rel=1e-3)
    omega = np.linspace(0.98 * low, 1.02 * high, 30)
    exact = ss.exact_response(model, omega=omega)
    tolerance = 1e-3
    auto = ss.forced_response(model, omega=omega, tolerance=tolerance)
    assert auto.converged.all()
    assert exact.converged.all()
    for dof in ("damper", "tip"):
        difference = np.abs(auto.amplitude(dof) - exact.amplitude(dof)).max()
        assert difference < tolerance * exact.amplitude(dof).max()
    with open(EXAMPLES / "turbine-blade" / "study.json") as stream:
        written = json.load(stream)
    lower = written["stuck_peak_m"]["tip"] / best.amplitude
    assert lower == pytest.approx(written["peak_reduction_at_optimum"], rel=5e-3)


def test_the_mode_of_the_study_moves_the_tip_most():
    study = module(EXAMPLES / "turbine-blade" / "study.py", "blade_study")
    assert study.largest_tip_mode(ss.reference.turbine_blade()) == 0


def test_a_lap_joint_slips_from_a_deck(capsys):
    pytest.importorskip("skfem")
    example = module(EXAMPLES / "lap-joint" / "joint.py", "joint")
    found = example.main(4, curve=np.array([0.93]))
    assert "37 pairs" in capsys.readouterr().out
    assert found["open"] == 0.0
    # the plates themselves, clamped at their ends, bear some 2 % of the 4 kN
    assert found["force"] == pytest.approx(3924.9, rel=1e-4)
    slips = [found["slip"][level] for level in (200.0, 400.0, 800.0)]
    np.testing.assert_allclose(slips, [4.0e-4, 5.737e-4, 6.579e-4], rtol=1e-3)
    # the same by 128 samples: 2.75234e-5
    assert found["amplitude"] == pytest.approx([2.75247e-5], rel=1e-4)


@pytest.mark.slow
def test_a_lap_joint_of_121_pairs_softens_around_its_resonance():
    pytest.importorskip("skfem")
    example = module(EXAMPLES / "lap-joint" / "joint.py", "joint")
    interface, plates, bolt = example.joint(8)
    laws = {
        "friction": example.FRICTION,
        "tangential_stiffness": example.K_T,
        "normal_stiffness": example.K_N,
    }
    touching = interface.contact(**laws, relative=True)
    curve = np.array([0.93, 0.95, 1.01])
    response, slips = example.shaken(plates, touching, bolt, interface, curve)
    assert list(response.status) == ["converged"] * 3
    # by products with the modes, along the curve too
    assert response.counters["products"] > 500
    # by 128 samples 2.76196e-5, 4.11195e-5 and 6.69211e-5
    assert response.amplitude("middle") == pytest.approx(
        [2.76198e-5, 4.11210e-5, 6.69186e-5], rel=1e-4
    )
    opens = (response.open_fraction(0) > 0.0).mean(axis=1)
    np.testing.assert_allclose(opens, [0.0, 0.0, 14 / 121], atol=1e-3)
    assert 0.0 < slips[0] < slips[1] < slips[2] < interface.area

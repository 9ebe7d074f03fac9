"""Damper curves and optima at light damping, of rigid dampers, and their files."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip import reference


@pytest.fixture(scope="module")
def beam() -> ss.Model:
    return reference.snecma_beam()


def light(damping: float, slip_force: float) -> ss.Model:
    structure = ss.Structure(
        mass=np.eye(2),
        stiffness=[[2e4, -1e4], [-1e4, 1e4]],
        damping=ss.ModalDamping(damping) if damping else None,
        dofs=["root", "tip"],
    )
    contact = ss.Jenkins("root", stiffness=2e4, slip_force=slip_force)
    return ss.Model(structure, contacts=[contact], forces=[ss.Force("tip", 1.0)])


def test_peaks_of_lightly_damped_structures_are_not_missed() -> None:
    curve = ss.damper_curve(light(1e-5, 48.0), slip_force=[5740, 10800], dof="tip")
    assert curve.amplitude == pytest.approx([0.94828, 1.78384], rel=1e-4)
    # the tops are flat: over 4e-5 rad/s the first one falls by 1e-8 of its height
    assert curve.omega == pytest.approx([83.49947, 83.49972], rel=5e-7)
    assert all(status == "converged" for status in curve.status)


@pytest.mark.parametrize("harmonics", [1, 9, "auto"])
def test_a_resonance_that_friction_cannot_bound_is_singular(harmonics: int | str) -> None:
    oscillator = ss.Structure(mass=[[2.0]], stiffness=[[8.0]], dofs=["tip"])
    for slip_force, status in ((1.0, "singular"), (100.0, "converged")):
        contact = ss.Jenkins("tip", stiffness=10.0, slip_force=slip_force)
        model = ss.Model(oscillator, [contact], [ss.Force("tip", 100.0)])
        frf = ss.forced_response(model, [2.0], harmonics=harmonics)
        assert frf.status[0] == status
        # held fast, 100 N move 18 - 8 N/m
        assert frf.amplitude("tip")[0] == pytest.approx(
            10.0 if status == "converged" else np.nan, rel=1e-9, nan_ok=True
        )


@pytest.mark.parametrize("damping", [0.0, 1e-6])
def test_a_peak_is_found_or_missing(damping: float) -> None:
    values = np.array([48.0, 1000.0, 51794.7, 1e5])
    curve = ss.damper_curve(light(damping, 48.0), slip_force=values, dof="tip")
    for value, amplitude, status in zip(values, curve.amplitude, curve.status, strict=True):
        assert np.isfinite(amplitude) == status.solved, value
    # Slip begins at an amplitude in proportion to the slip force.
    known = curve.arrays.solved[1:] & (values[1:] < 4e5)
    ratio = curve.amplitude[1:][known] / values[1:][known]
    assert known[0]
    assert ratio == pytest.approx(1.655e-4, rel=5e-3)


@pytest.mark.parametrize("damping", [1e-4, 1e-5, 1e-6])
def test_optimum_at_light_damping(damping: float) -> None:
    best = ss.optimal_damper(light(damping, 5.0), dof="tip")
    assert best.slip_force == pytest.approx(1.92, rel=0.01)
    assert best.amplitude == pytest.approx(6.767e-4, rel=1e-3)
    assert not best.at_bound


def test_optimum_without_damping_is_a_solved_peak() -> None:
    best = ss.optimal_damper(light(0.0, 5.0), dof="tip")
    assert best.status.solved
    assert best.amplitude == pytest.approx(6.767e-4, rel=1e-3)
    assert best.curve.arrays.solved[best.curve.values == best.value].all()
    with pytest.raises(ss.ModelError, match=r"^optimal damper: 0 peaks were found[^\n]*$"):
        ss.optimal_damper(light(0.0, 5.0), dof="tip", bounds=(1e5, 2e5), max_iterations=1)


@pytest.mark.slow
def test_an_optimum_is_saved_and_loaded(beam: ss.Model, tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from stickslip.cli import app

    best = ss.optimal_damper(beam, dof="tip", harmonics=3, common="factor")
    file = tmp_path / "best.nc"
    best.save(file)
    for copy in (ss.load(file), pickle.loads(pickle.dumps(best))):
        assert isinstance(copy, ss.OptimalDamper)
        assert copy.minima == best.minima
        assert copy.bounds == best.bounds
        assert copy.assumptions == best.assumptions
        assert copy.timings == best.timings
        assert copy.counters == best.counters
        assert copy.status == best.status == "converged"
        assert copy.model.contacts == best.model.contacts
        assert copy.curve.model.contacts == beam.contacts
        assert copy.curve.assumptions == best.curve.assumptions
        np.testing.assert_array_equal(copy.curve.amplitude, best.curve.amplitude)
    shown = CliRunner().invoke(app, ["show", str(file)])
    assert shown.exit_code == 0, shown.output
    drawn = CliRunner().invoke(app, ["plot", str(file), "--out", str(tmp_path / "best.png")])
    assert drawn.exit_code == 0, drawn.output


@pytest.mark.slow
def test_stiffnesses_beyond_the_rigid_limit_lie_on_its_line() -> None:
    stiff = [4e6, 6e6, 1e12, 1e20, 1e300, np.inf]
    curve = ss.damper_curve(light(0.01, 1.0), stiffness=stiff, dof="tip", tolerance=1e-4)
    assert all(status == "converged" for status in curve.status)
    limit = curve.amplitude[-1]
    assert curve.amplitude[2:] == pytest.approx(limit, rel=1e-5)
    # One on either side of where solutions end: on one line in 1/k_d.
    slopes = (limit - curve.amplitude[:2]) * stiff[:2]
    assert slopes[0] == pytest.approx(slopes[1], rel=0.1)
    assert any("above 5e+06 N/m were not solved" in text for text in curve.assumptions)


def test_wording_of_one_and_of_several() -> None:
    curve = ss.damper_curve(light(0.01, 5.0), slip_force=[5.0], dof="tip")
    (text,) = (one for one in curve.assumptions if one.startswith("Harmonics"))
    assert text.startswith(f"Harmonics up to {curve.harmonics[0]} were kept, chosen at each peak")
    best = ss.optimal_damper(light(0.01, 5.0), dof="tip")
    assert "1 local minimum)" in repr(best)


def weakly_coupled():
    """Weak springs pass little of the load on away from resonance, at which all of it arrives."""
    springs = 1e4 * np.diag([1.0077, 1.0139, 1.0136, 1.0157, 1.0074])
    springs -= 67.8 * (np.eye(5, k=1) + np.eye(5, k=-1))
    structure = ss.Structure(np.eye(5), springs, ss.ModalDamping(1e-5), list("abcde"))
    damper = ss.Jenkins("a", stiffness=7.5e4, slip_force=1.0)
    return ss.Model(structure, [damper], [ss.Force("e", 1.0)])


def test_default_bounds_hold_the_optimum_of_a_load_that_hardly_reaches_the_damper():
    model = weakly_coupled()
    found = ss.optimal_damper(model, dof="b", harmonics=1)
    assert not found.at_bound
    curve = ss.damper_curve(model, slip_force=np.geomspace(1e-4, 100.0, 25), dof="b", harmonics=1)
    assert found.amplitude <= np.nanmin(curve.amplitude) * (1.0 + 1e-6)


def test_ctrl_c_in_the_search_between_wider_bounds_keeps_the_curve_before():
    shares = [0.0]

    def press(share):
        if share < shares[-1]:
            raise KeyboardInterrupt
        shares.append(share)

    with pytest.raises(ss.Interrupted, match="interrupted after") as stop:
        ss.optimal_damper(weakly_coupled(), dof="b", harmonics=15, progress=press)
    curve = stop.value.result
    assert curve.interrupted
    assert curve.values.size >= 40


def test_a_dip_before_contacts_stick_is_found():
    """Between two values of the coarse curve: from the dip the peak rises to what is flat."""
    coupled = np.diag([16391.0, 18112.0, 17987.0, 17159.0])
    coupled -= 920.0 * (np.eye(4, k=1) + np.eye(4, k=-1))
    damping = ss.Rayleigh(mass=0.02, stiffness=1.25e-6)
    structure = ss.Structure(np.eye(4), coupled, damping, list("abcd"))
    damper = ss.Jenkins("c", stiffness=7.8e4, slip_force=1.0)
    forces = [ss.Force("c", 0.79, phase=2.27), ss.Force("a", 0.58, phase=3.86)]
    model = ss.Model(structure, [damper], forces)
    best = ss.optimal_damper(model, dof="d", harmonics=1, bounds=(0.0272, 272.0))
    curve = ss.damper_curve(model, slip_force=np.linspace(1.4, 1.8, 9), dof="d", harmonics=1)
    assert best.amplitude <= curve.amplitude.min()
    assert not best.at_bound

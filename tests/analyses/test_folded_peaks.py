"""Peaks where a frequency has several motions: what the curve over its folds reaches."""

import numpy as np
import pytest

import stickslip as ss


def chain(contacts, force):
    mass = np.diag([1.889, 0.911, 0.59, 0.966])
    stiffness = [
        [25530.8, -13912.5, 0.0, 0.0],
        [-13912.5, 40349.1, -14065.0, 0.0],
        [0.0, -14065.0, 31204.2, -7674.8],
        [0.0, 0.0, -7674.8, 14414.8],
    ]
    dofs = ["d0", "d1", "d2", "d3"]
    structure = ss.Structure(mass, stiffness, 1.934 * mass, dofs)
    return ss.Model(structure, contacts, [ss.Force("d0", force)])


@pytest.fixture(scope="module")
def behind_a_gap():
    """A contact that closes once per cycle; the upper branch begins behind a fold."""
    pad = ss.Coulomb(
        ["d0", "d1"],
        normal=[0.92824, np.sqrt(1 - 0.92824**2)],
        friction=0.44637,
        tangential_stiffness=5639.32,
        normal_stiffness=29443.7,
        gap=0.0153094,
        name="pad",
    )
    return chain([pad], 20.331)


SPAN = (40.75, 135.84)


@pytest.mark.slow
def test_damper_curves_find_the_branch_behind_a_fold(behind_a_gap):
    curve = ss.forced_response(behind_a_gap, SPAN)
    assert len(curve.folds) >= 2
    peak = curve.peak("d0")
    damper = ss.damper_curve(behind_a_gap, friction=[0.44637], dof="d0", omega=SPAN)
    assert damper.amplitude[0] == pytest.approx(peak.amplitude, rel=2e-3)
    assert damper.omega[0] == pytest.approx(peak.omega, rel=2e-3)


def hardening(level=1.0, stiffness=1e9):
    structure = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.01), ["x"])
    cubic = ss.Cubic("x", stiffness=stiffness, name="cubic")
    return ss.Model(structure, [cubic], [ss.Force("x", level)])


def test_slopes_of_a_peak_beside_a_fold_are_those_of_its_branch():
    """At the frequency of the peak the lower branch has a motion, too, with slopes of its own."""
    keys = {"omega": (60.0, 200.0), "harmonics": 5, "tolerance": 1e-4}
    curve = ss.forced_response(hardening(), **keys)
    assert curve.folds.size == 2

    def height(level, stiffness):
        return ss.forced_response(hardening(level, stiffness), **keys).peak("x").amplitude

    by_level = (height(1.01, 1e9) - height(0.99, 1e9)) / 0.02
    by_stiffness = (height(1.0, 1.01e9) - height(1.0, 0.99e9)) / 0.02e9
    assert curve.peak_sensitivity("x", parameter="level") == pytest.approx(by_level, rel=0.01)
    found = curve.peak_sensitivity("x")
    assert found["cubic", "stiffness"] == pytest.approx(by_stiffness, rel=0.01)


@pytest.mark.slow
def test_orbits_of_other_motions_certify_nothing(behind_a_gap):
    """Orbits begin at the lower branch, and upper points have no such error."""
    curve = ss.forced_response(behind_a_gap, (80.0, 110.0), 7, tolerance=1e-2, stability=False)
    assert curve.folds.size == 2
    top = int(curve.amplitude("d0").argmax())
    seen = ss.certify(curve, [0, top - 1, top, curve.omega.size - 1]).certificate
    assert seen.status == ("converged", "other motion", "other motion", "converged")
    assert np.isnan(seen.amplitude[1:3]).all()
    assert np.isnan(seen.waveform_error[1:3]).all()
    assert np.nanmax(np.abs(seen.relative)) < 1e-3
    assert seen.worst.position in (0, curve.omega.size - 1)


def test_the_point_beside_a_peak_is_on_its_branch() -> None:
    mass = ss.Structure([[1.0]], [[1e4]], damping=ss.ModalDamping(0.01), dofs=["tip"])
    model = ss.Model(mass, [ss.Cubic("tip", stiffness=2e7)], [ss.Force("tip", 17.0)])
    frf = ss.forced_response(model, (70.0, 200.0), harmonics=3)
    place = frf.peak_index("tip")
    assert place == np.nanargmax(frf.amplitude("tip"))
    assert frf.index(frf.peak("tip").omega) != place
    assert frf.summary()[0].error_estimate == frf.error_estimate("tip")[place]


def bouncing(k, force=0.1, damping=0.02):
    structure = ss.Structure([[1.0]], [[1.0]], [[damping]], ["x"])
    return ss.Model(structure, [ss.Stop("x", stiffness=k, gap=1.0)], [ss.Force("x", force)])


def test_peaks_on_a_fold_are_judged_by_their_own_motion():
    """With fewer harmonics only the motion below the fold is left, which touches nothing."""
    keys = {"level": [1.0], "dof": "x", "omega": (0.6, 3.0)}
    found = ss.damper_curve(bouncing(20.0), **keys)
    fine = ss.damper_curve(bouncing(20.0), **keys, harmonics=31)
    assert found.arrays.harmonics[0] > 7
    assert found.arrays.error_estimate[0] > 0.0
    assert found.amplitude[0] == pytest.approx(fine.amplitude[0], rel=1e-4)


@pytest.mark.parametrize("points", [24, 400])
def test_peaks_of_a_map_are_reached_by_a_motion(points):
    """No parabola leads through points of both branches of a fold."""
    found = ss.design_map(
        lambda k, force: bouncing(k, force, damping=0.05),
        {"k": [2.0, 30.0], "force": [0.2]},
        dof="x",
        omega=(0.6, 3.0),
        points=points,
        threads=1,
    )
    for row, k in enumerate((2.0, 30.0)):
        curve = ss.forced_response(bouncing(k, 0.2, 0.05), (0.6, 3.0), 31, stability=False)
        assert found.status[row][0] == "converged"
        highest = np.nanmax(curve.amplitude("x"))
        assert found.amplitude[row, 0] == pytest.approx(highest, rel=1e-2)


def test_the_point_beside_a_peak_is_near_in_frequency() -> None:
    modes = ss.Structure(
        np.eye(3),
        np.diag([500.0**2, 800.0**2, 1.0]),
        ss.ModalDamping([0.0, 2e-3, 2e-2]),
        list("cab"),
    )
    forces = [ss.Force("c", 1.0), ss.Force("a", 1.0)]
    frf = ss.forced_response(ss.Model(modes, [], forces), np.linspace(300.0, 1000.0, 21), 1)
    for dof in ("c", "a"):
        near = np.abs(frf.omega - frf.peak(dof).omega).argmin()
        assert frf.peak_index(dof) == near
    assert [row.amplitude for row in frf.summary(["b"])] == [0.0]


def test_what_stands_still_has_a_summary() -> None:
    pair = ss.Structure(
        np.eye(2), np.diag([1e4, 2e4]), damping=ss.ModalDamping(0.01), dofs=["tip", "still"]
    )
    damper = ss.Jenkins("tip", stiffness=1e3, slip_force=1.0)
    frf = ss.forced_response(
        ss.Model(pair, [damper], [ss.Force("tip", 17.0)]), np.linspace(80.0, 200.0, 9), harmonics=3
    )
    (still,) = frf.summary("still")
    assert (still.amplitude, still.error_estimate) == (0.0, 0.0)
    assert frf.omega[frf.peak_index("still")] == still.omega

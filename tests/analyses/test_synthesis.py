"""Responses, peaks and limit cycles that a nonlinear mode alone gives, against direct ones."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row
from joints import chain


def random_chain(seed):
    """Return a random chain on Jenkins elements, and the names of its DOFs."""
    rng = np.random.default_rng([5, seed])
    size = int(rng.integers(1, 5))
    springs = 10.0 ** rng.uniform(3.5, 4.5, size + 1)
    stiffness = in_a_row(springs)
    dofs = [f"d{place}" for place in range(size)]
    damping = ss.ModalDamping(rng.choice([0.001, 0.003, 0.01]))
    structure = ss.Structure(np.diag(rng.uniform(0.3, 2.0, size)), stiffness, damping, dofs)
    contacts = []
    for _ in range(int(rng.integers(1, 4))):
        pair = size > 1 and rng.random() < 0.5
        ends = rng.choice(dofs, 2, replace=False) if pair else [rng.choice(dofs)]
        keys = {
            "stiffness": 10.0 ** rng.uniform(2.5, 4.2),
            "slip_force": 10.0 ** rng.uniform(-0.5, 0.5),
        }
        contacts.append(ss.Jenkins(*map(str, ends), **keys))
    return ss.Model(structure, contacts), dofs


@pytest.mark.parametrize("size", [0.05, 0.5, 2.0])
def test_synthesised_peaks_are_those_of_direct_computation(size):
    force = ss.Force("x", size)
    mode = ss.nonlinear_modes(chain(), mode=0, amplitude=(1e-6, 3e-2))
    direct = ss.forced_response(chain(force), omega=(120.0, 190.0), tolerance=1e-4).peak("y")
    near = np.linspace(0.97, 1.03, 1201) * direct.omega
    response = mode.forced_response(force, near)
    heights = response.amplitude("y")
    top = int(np.nanargmax(heights))
    ratio = np.interp(
        np.log(response.modal_amplitude[top]), np.log(mode.amplitude), mode.damping_ratio
    )
    error = abs(heights[top] / direct.amplitude - 1.0)
    assert ratio < 0.03
    assert error < 0.01
    assert response.omega[top] == pytest.approx(direct.omega, rel=3e-3)
    assert response.error_indicator[top] > error


@pytest.mark.parametrize("seed", [0, 1, *range(3, 12)])
def test_damper_curves_of_one_mode_are_right_or_say_that_they_are_not(seed):
    model, dofs = random_chain(seed)
    mode = ss.nonlinear_modes(model, amplitude=(1e-6, 0.3), harmonics=9)
    force, dof = ss.Force(dofs[-1], 1.0), dofs[seed % len(dofs)]
    factors = np.geomspace(0.02, 20.0, 5)
    curve = mode.damper_curve(force, factors)
    loose = ss.natural_frequencies(model, slipping=range(len(model.contacts)))[0]
    driven, span = (
        ss.Model(model.structure, model.contacts, [force]),
        (0.9 * loose, 1.05 * mode.linear_omega),
    )
    compared = 0
    for factor, height, said in zip(
        factors, curve.amplitude(dof), curve.error_indicator, strict=True
    ):
        peak = ss.forced_response(driven.scaled(slip_force=factor), span, harmonics=9).peak(dof)
        if np.isfinite(height) and not peak.at_edge:
            compared += 1
            assert abs(height / peak.amplitude - 1.0) < 0.01 or said > 0.01
    assert compared > 1
    levels = mode.peaks(force, 1.0 / factors)
    np.testing.assert_allclose(curve.amplitude(dof), factors * levels.amplitude(dof), rtol=1e-12)
    np.testing.assert_allclose(curve.omega, levels.omega, rtol=1e-12)


@pytest.mark.parametrize("seed", [0, 1, 4, 5, 8, 14])
def test_limit_cycles_of_one_mode_are_right_or_say_that_they_are_not(seed):
    model, dofs = random_chain(seed)
    mode = ss.nonlinear_modes(model, amplitude=(1e-6, 0.3), harmonics=9)
    rng = np.random.default_rng(seed)
    negative = np.diag(-rng.uniform(0.0, 2.0, len(dofs))) if seed % 2 else ss.Rayleigh(mass=-1.0)
    whole = ss.limit_cycles(model, negative, harmonics=9, stability=False)
    ratios = np.linspace(max(whole.ratio[0], 0.02), whole.ratio.max(), 5)[1:-1]
    found = mode.limit_cycles(negative, ratios)
    direct = ss.limit_cycles(model, negative, ratio=ratios, harmonics=9, stability=False)
    assert set(found.ratio) == set(ratios)
    for ratio, height, stable, said in zip(
        found.ratio, found.amplitude(dofs[0]), found.stable, found.error_indicator, strict=True
    ):
        same = np.isclose(direct.ratio, ratio, rtol=1e-9)
        off = height / direct.amplitude(dofs[0])[same] - 1.0
        nearest = np.abs(off).argmin()
        assert abs(off[nearest]) < 0.01 or said > 0.01
        if said < 0.01:
            assert stable == (np.array(direct.branch)[same][nearest] == "sticking")


def oscillator(damping):
    structure = ss.Structure([[1.0]], [[1e4]], [[damping]], dofs=["x"])
    return ss.Model(structure, [ss.Jenkins("x", stiffness=1e3, slip_force=1.0)])


def test_limit_cycles_at_the_onset_of_slip_know_their_error():
    """Without viscous damping nothing is needed of the negative one up to the onset."""
    mode = ss.nonlinear_modes(oscillator(0.0), amplitude=(1e-4, 1e-1))
    ratios = [0.001, 0.01]
    found = mode.limit_cycles([[-2.0]], ratios)
    direct = ss.limit_cycles(oscillator(0.0), [[-2.0]], ratio=ratios)
    assert found.stable.all()
    small = np.array(direct.branch) == "sticking"
    off = np.abs(found.amplitude("x") / direct.amplitude("x")[small] - 1.0)
    assert (off < 2e-5).all()
    assert off[0] < found.error_indicator[0] < 0.01


def test_a_damping_that_takes_from_cycles_that_the_structure_feeds():
    """C = -2 kg/s of its own and 0.5 times 2 kg/s are 0.5 times -2 kg/s."""
    amplitude = np.geomspace(1e-4, 1e-1, 200)
    usual, other = (
        ss.nonlinear_modes(oscillator(own), amplitude=amplitude).limit_cycles([[added]], [0.5])
        for own, added in ((0.0, -2.0), (-2.0, 2.0))
    )
    np.testing.assert_allclose(other.modal_amplitude, usual.modal_amplitude, rtol=1e-2)
    assert usual.stable.tolist() == other.stable.tolist() == [True, False]


def test_what_does_not_scale_is_refused():
    model, dofs = random_chain(0)
    keys = {"amplitude": [1e-5, 1e-4], "harmonics": 3}
    force = ss.Force(dofs[0], 1.0)
    loaded = ss.Model(model.structure, model.contacts, [ss.Force(dofs[0], 2.0, harmonic=0)])
    with pytest.raises(ss.ModelError, match="static loads"):
        ss.nonlinear_modes(loaded, **keys).damper_curve(force, [1.0])
    stiff = ss.Model(model.structure, [*model.contacts, ss.Cubic(dofs[0], stiffness=1e6)])
    mode = ss.nonlinear_modes(stiff, **keys)
    with pytest.raises(ss.ModelError, match="harden"):
        mode.damper_curve(force, [1.0])
    assert np.isfinite(mode.peaks(force, [1e-4]).amplitude(dofs[0])).all()
    turning, dofs = random_chain(2)
    mode = ss.nonlinear_modes(turning, amplitude=(1e-6, 0.3), harmonics=9)
    with pytest.raises(ss.ModelError, match=r"does not turn; it has .* 2 turns"):
        mode.peaks(ss.Force(dofs[0], 1.0), [1.0])


def test_levels_are_positive():
    model, dofs = random_chain(0)
    mode = ss.nonlinear_modes(model, amplitude=[1e-5, 1e-4], harmonics=3)
    force = ss.Force(dofs[0], 1.0)
    with pytest.raises(ss.ModelError, match="level"):
        mode.peaks(force, [-1.0])

"""Forced responses: what goes in is checked before anything is computed."""

import numpy as np
import pytest

import stickslip as ss
from rubbing import GRID, beam_response, one_dof
from stickslip.reference import snecma_beam


@pytest.fixture(scope="module")
def frf():
    return beam_response()


@pytest.mark.parametrize(
    ("omega", "message"),
    [
        ((0.0, 2.0), r"range \(0, 2\) must have two different ends above 0"),
        ((2.0, -1.0), r"two different ends above 0"),
        ((1.0, 1.0), r"two different ends above 0"),
        ((1.0, np.inf), r"end of the range: inf is not a finite number"),
        ((1.0, "2"), r"end of the range: '2' is not a number"),
        ([], r"omega: empty"),
        (3.0, r"omega: shape \(\) instead of \(n,\); write \[3\]"),
        ([[1.0, 2.0]], r"omega: shape \(1, 2\)"),
        ([[1.0], [2.0, 3.0]], r"ragged"),
        ([1.0, np.nan], r"omega\[1\] is nan"),
        ([1.0, -2.0], r"omega\[1\] is -2"),
        ([0.0], r"omega\[0\] is 0"),
        (["1"], r"holds no real numbers"),
        ([1.0 + 1j], r"holds no real numbers"),
        (None, r"omega: None holds no real numbers"),
        ([True, False], r"holds no real numbers"),
    ],
)
def test_wrong_omega(omega, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(one_dof(), omega, 3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"harmonics": 0}, r"harmonics: 0 lies below 1"),
        ({"harmonics": 2.0}, r"harmonics: 2.0 is not an integer"),
        ({"harmonics": True}, r"harmonics: True is not an integer"),
        ({"harmonics": "all"}, "harmonics: unknown choice 'all'"),
        ({"harmonics": 40, "max_harmonics": 30}, r"40 lies above max_harmonics = 30"),
        ({"max_harmonics": 0}, r"max_harmonics: 0 lies below 1"),
        ({"max_iterations": 0}, r"max_iterations: 0 lies below 1"),
        ({"tolerance": 0.0}, r"tolerance: 0; give a fraction"),
        ({"tolerance": 0.6}, r"tolerance: 0.6; give a fraction"),
        ({"tolerance": np.nan}, r"tolerance: nan"),
        ({"tolerance": "small"}, r"tolerance: 'small' is not a number"),
        ({"residual": "centered"}, r"unknown choice 'centered'; did you mean 'centred'\?"),
        ({"residual": np.inf}, r"residual: inf"),
        ({"method": "newtn"}, r"method: unknown choice 'newtn'; did you mean 'newton'\?"),
        ({"method": "secant"}, r"method: unknown choice 'secant'; known: 'newton', 'broyden'"),
        ({"method": np.array(["newton", "x"])}, r"method: .* is not text"),
        ({"residual": np.array(["centred", "x"])}, r"residual: .* is not a number"),
        ({"residual": np.array([1.0, 2.0])}, r"residual: .* is not a number"),
        ({"residual": ["centred"]}, r"residual: .* is not a number"),
        ({"method": ["newton"]}, r"method: .* is not text"),
        ({"observe": []}, r"observe: no dof"),
        ({"observe": ["y"]}, r"observe: unknown dof 'y'; known: 'x'"),
        ({"observe": ["x", "x"]}, r"observe: 'x' is given more than once"),
        ({"observe": 3}, r"observe: 3 is not a list of names"),
        ({"observe": [0]}, r"observe\[0\]: 0 is not text"),
        ({"progress": 3}, r"progress: 3 cannot be called"),
    ],
)
def test_wrong_option(options, message):
    with pytest.raises(ss.ModelError, match=message) as caught:
        ss.forced_response(one_dof(), [1.0], **options)
    assert "\n" not in str(caught.value)


def test_wrong_model():
    with pytest.raises(ss.ModelError, match=r"model: .* is not a Model"):
        ss.forced_response(one_dof().structure, [1.0])


def test_the_core_refuses_in_the_same_way():
    with pytest.raises(ss.ModelError, match="undamped natural frequency"):
        ss.forced_response(one_dof(damping=0.0), [3.0], 1)


def test_static_load_needs_support():
    free = ss.Structure(np.eye(2), [[1.0, -1.0], [-1.0, 1.0]], 0.1 * np.eye(2), ["a", "b"])
    loads = [ss.Force("a", 1.0), ss.Force("b", 2.0, harmonic=0)]
    with pytest.raises(ss.ModelError, match=r"force 2 at 'b': a static load of 2 N on a struct"):
        ss.forced_response(ss.Model(free, forces=loads), [0.5], 1)
    held = ss.Model(free, [ss.Jenkins("a", stiffness=4.0, slip_force=9.0)], loads)
    with pytest.raises(ss.ModelError, match=r'alone, .* use residual="from_rest"'):
        ss.forced_response(held, [0.5], 1, residual="centred")
    frf = ss.forced_response(held, [0.5], 1)
    assert frf.settings.residual == "from_rest"
    assert frf.converged.all()
    assert frf.arrays.contact_force[0, 0, 0].real == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("entry", ["harmonics", "max_harmonics"])
def test_a_force_beyond_the_harmonics_is_named(entry):
    model = one_dof(ss.Force("x", 0.5), ss.Force("x", 0.1, harmonic=2))
    message = f"^{entry}: 1 would leave out force 2 at 'x', of harmonic 2; give at least 2"
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(model, [1.0], **{entry: 1})
    silent = one_dof(ss.Force("x", 0.5), ss.Force("x", 0.0, harmonic=2))
    assert ss.forced_response(silent, [1.0], 1).converged.all()


def test_a_range_may_run_downwards():
    frf = ss.forced_response(snecma_beam(), (240.0, 180.0), tolerance=1e-2)
    assert frf.converged.all()
    assert (frf.omega[0], frf.omega[-1]) == (240.0, 180.0)
    assert (np.diff(frf.omega) < 0.0).all()
    assert any("between 180 and 240 rad/s" in text for text in frf.assumptions)


def test_a_range_chooses_its_points():
    frf = ss.forced_response(snecma_beam(), (150, 250))
    assert frf.settings.span == (150.0, 250.0)
    assert (frf.omega[0], frf.omega[-1]) == (150.0, 250.0)
    assert (np.diff(frf.omega) > 0).all()
    fine = ss.forced_response(snecma_beam(), np.linspace(160, 240, 37))
    between = np.interp(fine.omega, frf.omega, frf.amplitude("tip"))
    np.testing.assert_allclose(between, fine.amplitude("tip"), rtol=1e-2)
    two = ss.forced_response(snecma_beam(), [150, 250], 1)
    assert two.omega.size == 2
    assert two.settings.span is None


def test_a_result_beyond_the_memory_is_refused_before_it_is_computed(monkeypatch):
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**6)
    message = r"^omega: the result of 6000 points, .* needs .* GB of the 0.001 GB of memory"
    with pytest.raises(ss.ModelError, match=message):
        ss.forced_response(snecma_beam(), np.linspace(150, 250, 6000), 9)
    with pytest.raises(ss.ModelError, match="give fewer points"):
        ss.forced_response(snecma_beam(), np.linspace(150, 250, 6000))
    assert ss.forced_response(snecma_beam(), GRID[:3], 9).converged.all()
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: None)
    assert ss.forced_response(snecma_beam(), GRID[:3], 9).converged.all()

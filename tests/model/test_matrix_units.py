"""Matrices in the units of finite elements."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.study import Study

LENGTH, WIDTH, YOUNG, DENSITY = 0.4, 0.02, 210e9, 7850.0


def clamped_beam(metre=1.0, kilogram=1.0, second=1.0):
    """One element of a clamped beam in units that are so many of SI: tip.w, tip.ry."""
    length = LENGTH / metre
    inertia = WIDTH**4 / 12
    bending = YOUNG * inertia / (kilogram * metre**3 / second**2) / length**3
    mass = DENSITY * WIDTH**2 * LENGTH / kilogram / 420
    M = mass * np.array([[156, -22 * length], [-22 * length, 4 * length**2]])
    K = bending * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])
    return M, K


@pytest.mark.parametrize(
    ("units", "sizes"),
    [
        ("t-mm-s", (1e-3, 1e3, 1.0)),
        ("kg-mm-ms", (1e-3, 1.0, 1e-3)),
        ("kg-m-s", (1.0, 1.0, 1.0)),
        ("lb-in-s", (0.0254, 0.45359237, 1.0)),
    ],
)
def test_matrices_of_any_units_are_those_of_si(units, sizes):
    M, K = clamped_beam(*sizes)
    C = 1e-5 * K / sizes[2]  # the time of a Rayleigh factor is one too
    true_mass, true_stiffness = clamped_beam()
    for names in (["tip.w", "tip.ry"], ["7.3", "7.5"]):
        beam = ss.Structure(M, K, C, names, units=units)
        np.testing.assert_allclose(beam.mass, true_mass, rtol=1e-12)
        np.testing.assert_allclose(beam.stiffness, true_stiffness, rtol=1e-12)
        np.testing.assert_allclose(beam.damping, 1e-5 * true_stiffness, rtol=1e-12)
    blocks = ss.Interface(K, M, C, units=units, dofs=["tip.w", "tip.ry"])
    np.testing.assert_allclose(blocks.stiffness, true_stiffness, rtol=1e-12)
    np.testing.assert_allclose(blocks.mass, true_mass, rtol=1e-12)


def test_reductions_and_study_files_take_them():
    springs = 1e3 * (2.0 * np.eye(5) - np.eye(5, k=1) - np.eye(5, k=-1))  # N/mm
    whole = ss.craig_bampton(1e-3 * np.eye(5), springs, {"tip": 4}, modes=3, units="t-mm-s")
    plain = ss.craig_bampton(np.eye(5), 1e3 * springs, {"tip": 4}, modes=3)
    np.testing.assert_allclose(whole.stiffness, plain.stiffness, rtol=1e-12)
    np.testing.assert_allclose(whole.mass, plain.mass, rtol=1e-12, atol=1e-15)
    study = Study.parse(
        "[structure]\nmass = [[2e-3]]\nstiffness = [[8]]\nunits = 't-mm-s'\ndofs = ['tip']\n"
        "[analysis]\nomega = [1]"
    )
    assert study.model.structure.mass == pytest.approx(2.0)
    assert study.model.structure.stiffness == pytest.approx(8e3)


@pytest.mark.parametrize(
    ("units", "message"),
    [
        ("SI", "units: 'SI'; give mass, length and time"),
        ("mm-t-s", "units: 'mm-t-s': '1 mm' is not a mass"),
        ("t-mm-foo", "units: 't-mm-foo': .*unknown unit 'foo'"),
        (3, "units: 3; give mass"),
    ],
)
def test_nonsense_units_are_refused(units, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.Structure([[1.0]], [[1.0]], units=units)

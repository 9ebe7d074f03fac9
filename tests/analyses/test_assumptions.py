"""What a forced response took for granted is said in words."""

import numpy as np
import pytest

import stickslip as ss
from rubbing import beam_response, one_dof
from stickslip.reference import snecma_beam


@pytest.fixture(scope="module")
def frf():
    return beam_response()


def assumed(model, omega=(1.0,), harmonics=5, **options):
    return " ".join(ss.forced_response(model, np.array(omega), harmonics, **options).assumptions)


def test_assumptions_on_harmonics():
    assert "Only the odd harmonics up to 5 were solved for" in assumed(one_dof())
    assert "Only harmonic 1 was solved for" in assumed(one_dof(), harmonics=1)
    even = one_dof(ss.Force("x", 0.3), ss.Force("x", 0.1, harmonic=2))
    assert "All harmonics from 0 to 5 were solved for" in assumed(even)
    assert "chosen per point" in assumed(one_dof(), harmonics="auto")


def test_assumptions_on_residual_forces():
    assert "residual='centred', of effect at 1 of 1 points" in assumed(one_dof())
    assert "built up from zero displacement" in assumed(one_dof(), residual="from_rest")
    assert "hold 0.1 N" in assumed(one_dof(), residual=0.1)
    assert "residual" not in assumed(one_dof(ss.Force("x", 60.0)), omega=[2.0])


@pytest.mark.parametrize(
    ("damping", "text"),
    [
        (np.diag([1.0, 1e-6]), ""),
        ([[1.0, 5.0], [-5.0, 1.0]], ""),
        ([[1.0, -1.0], [-1.0, 1.0]], "leaves some motion undamped"),
        (np.diag([1.0, 0.0]), "leaves some motion undamped"),
        (np.diag([1.0, -0.01]), "negative for some motion"),
        ([[1.0, 2.0], [2.0, 1.0]], "negative for some motion"),
    ],
)
def test_assumptions_on_damping(damping, text):
    structure = ss.Structure(np.eye(2), np.diag([4.0, 9.0]), damping, ["a", "b"])
    said = assumed(ss.Model(structure, forces=[ss.Force("a", 1.0)]), harmonics=1)
    assert text in said
    assert ("motion" in said) is bool(text)


def test_assumptions_on_truncation_and_observation():
    said = assumed(snecma_beam(), [190.0], 1, observe=["mode"])
    assert "still change 'mode' by" in said
    assert "at omega = 190 rad/s" in said
    assert "Only 1 of 3 dofs are kept in the result: mode." in said
    assert "still change" not in assumed(snecma_beam(), [190.0], "auto")


def test_assumptions_on_huge_numbers_raise_no_warning():
    frf = ss.forced_response(one_dof(ss.Force("x", 1e200), slip_force=1e199), [0.9, 2.1], 3)
    assert frf.assumptions


def test_a_single_harmonic_is_not_told_to_keep_more():
    result = ss.single_harmonic(snecma_beam(25.0), [170.0, 200.0])
    said = " ".join(result.assumptions)
    assert "the worst point; forced_response keeps more of them." in said
    assert "keep more harmonics" not in said
    assert "odd harmonics" not in said

"""Ranges of parameters, single numbers in place of lists, and plain factors."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from small_study import ANALYSIS, PAD, SMALL
from stickslip.study import Study

DAMPER = 'kind = "damper-curve"\ndof = "tip"\n'
CYCLES = 'kind = "limit-cycles"\nnegative_damping = {rayleigh = {mass = -20.0}}\n'


def analysis(entries: str) -> Study:
    return Study.parse(f"{PAD}[analysis]\n{entries}")


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("slip_force = {from = '1 N', to = inf, points = 4}", "slip_force: a range to inf has no"),
        ("slip_force = {from = '1 N', to = '1 N', points = 4}", r"for one value write \[1\]"),
        ("slip_force = {from = 0, to = '9 N', points = 4}", "begin above 0, or write spacing = 'l"),
        ("friction = {from = 0, to = 0.6, points = 4}", "friction: the range holds 0"),
        ("preload = {from = '9 N', to = 0, points = 4}", "preload: the range holds 0"),
        ("stiffness = {from = 1, to = 2, spacing = 'log'}", "stiffness: 'spacing' needs 'points'"),
    ],
)
def test_ranges_without_values_in_between_are_refused(entry, message):
    for kind in (f"[analysis]\n{DAMPER}{entry}", f"{ANALYSIS}\n[sweep]\n{entry}"):
        with pytest.raises(ss.ModelError, match=message):
            Study.parse(PAD + kind)


def test_a_branch_has_no_points_up_to_an_end_that_is_left_out():
    with pytest.raises(ss.ModelError, match="ratio: a range to inf has no values in between"):
        analysis(f"{CYCLES}ratio = {{from = 0.1, points = 3}}")


def test_linear_ranges_of_parameters_begin_at_zero():
    study = analysis(
        f"{DAMPER}slip_force = {{from = 0, to = '9 N', points = 4, spacing = 'linear'}}"
    )
    assert study.tables.analysis.slip_force.tolist() == [0.0, 3.0, 6.0, 9.0]
    study = analysis(f"{DAMPER}slip_force = {{from = 8, to = 1, points = 4}}")
    np.testing.assert_allclose(study.tables.analysis.slip_force, [8.0, 4.0, 2.0, 1.0])


@pytest.mark.parametrize(
    ("entries", "key"),
    [
        (f"{CYCLES}ratio = 1", "ratio"),
        (f"{CYCLES}slip_force = 1", "slip_force"),
        (f"{DAMPER}level = 1.0", "level"),
        (f"{DAMPER}gap = '1 m'", "gap"),
        ('kind = "nonlinear-modes"\namplitude = 1.0', "amplitude"),
    ],
)
def test_one_number_stands_for_a_list_of_one(entries, key):
    assert getattr(analysis(entries).tables.analysis, key).tolist() == [1.0]


FACTORS = ("'50 N' is not a ratio; .* common = 'factor' multiplies the contacts' own", "factor")


@pytest.mark.parametrize("given", [["50 %", "50 N"], "50 N", np.array(["50 N"])])
def test_values_with_a_unit_are_no_factors(given):
    beam = ss.reference.snecma_beam()
    with pytest.raises(ss.ModelError, match=FACTORS[0]):
        ss.damper_curve(beam, dof="tip", slip_force=given, common=FACTORS[1])
    with pytest.raises(ss.ModelError, match=FACTORS[0]):
        ss.sweep(beam, ss.static_response, stiffness=given, common=FACTORS[1])


@pytest.mark.parametrize("given", ["['2', '50 N']", "{from = 1, to = '50 N', points = 2}"])
def test_values_with_a_unit_are_no_factors_in_study_files(given):
    for kind in (f"[analysis]\n{DAMPER}", f"{ANALYSIS}\n[sweep]\n"):
        with pytest.raises(ss.ModelError, match=FACTORS[0]):
            Study.parse(f"{PAD}{kind}common = 'factor'\nslip_force = {given}")


def test_factors_may_be_shares():
    study = analysis(f"{DAMPER}common = 'factor'\nslip_force = ['50 %', 2]")
    assert study.tables.analysis.slip_force.tolist() == [0.5, 2.0]


def test_factors_have_no_unit_where_the_search_is_told():
    found = ss.optimal_damper(
        Study.parse(SMALL).model, dof="tip", common="factor", bounds=(0.1, 10.0), harmonics=1
    )
    assert "between 0.1 and 10;" in next(
        one.text for one in found.diagnostics if one.code == "coarse-search"
    )

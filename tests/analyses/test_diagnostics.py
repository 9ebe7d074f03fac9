"""What results say of themselves: codes and severities, never decisions by wording."""

import ast
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from stickslip.analyses.doubts import uniqueness
from stickslip.analyses.texts import TEXTS
from stickslip.cli import app
from stickslip.reference import snecma_beam
from stickslip.results.diagnostic import SEVERITIES, Severity, diagnostic, missed_tolerances
from stickslip.views import kinds

PACKAGE = Path(ss.__file__).parent


def codes(result):
    return {one.code for one in result.diagnostics}


def one_dof(damping, *forces):
    structure = ss.Structure([[2.0]], [[8.0]], damping=[[damping]], dofs=["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=1.0)
    return ss.Model(structure, [contact], forces)


@pytest.mark.slow
def test_every_code_is_used_and_known():
    used, said = {"text"}, "".join(f.read_text("utf-8") for f in PACKAGE.glob("analyses/*.py"))
    for file in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "diagnostic":
                used |= {one.value for one in node.args[:1] if isinstance(one, ast.Constant)}
    assert used | {name.partition("/")[0] for name in TEXTS} == set(SEVERITIES)
    built = ("modal-base/", "time-steps/", "intervals/", "mode-at-rest", "samples-drawn/")
    for name in TEXTS:
        assert said.count(f'"{name}"') > 1 or name.startswith(built), name


def test_the_page_lists_every_code_by_severity():
    page = (Path(__file__).parents[2] / "docs" / "troubleshooting.md").read_text("utf-8")
    for severity in Severity:
        (row,) = [line for line in page.splitlines() if line.startswith(f"| {severity}: ")]
        listed = re.findall(r"`([a-z-]+)`", row)
        assert sorted(listed) == sorted(one for one, of in SEVERITIES.items() if of is severity)


def test_no_decision_reads_a_text():
    reads = re.compile(r"assumptions if |\.text\.startswith|\.text [!=]=|in \w+\.text\b")
    lines = [
        line for file in PACKAGE.rglob("*.py") for line in file.read_text("utf-8").splitlines()
    ]
    assert [line for line in lines if reads.search(line)] == []


def test_texts_are_the_assumptions():
    frf = ss.forced_response(snecma_beam(), [190.0, 192.0], harmonics=1)
    assert frf.assumptions == tuple(map(str, frf.diagnostics))
    (truncation,) = [one for one in frf.diagnostics if one.code == "truncation"]
    assert truncation.severity is Severity.CAUTION
    share = frf.error_estimate(truncation.data["dof"]) / frf.amplitude(truncation.data["dof"])
    assert truncation.data["share"] == pytest.approx(share.max())


@pytest.mark.parametrize(
    ("damping", "expected"),
    [(0.4, set()), (0.0, {"undamped-motion"}), (-0.1, {"negative-damping"})],
)
def test_damping_that_leaves_uniqueness_open_is_a_caution(damping, expected):
    frf = ss.forced_response(one_dof(damping, ss.Force("x", 0.9)), [1.0], harmonics=3)
    assert codes(frf) & {"undamped-motion", "negative-damping"} == expected
    assert len(kinds.cautions(frf)) == len(expected)


def test_uniqueness_is_asked_of_the_laws():
    model = one_dof(0.4)
    assert model.problem.laws_not_monotone == []
    assert uniqueness(model) is None
    asked = SimpleNamespace(
        structure=model.structure, problem=SimpleNamespace(laws_not_monotone=["stop", "stop"])
    )
    assert uniqueness(asked).code == "law-not-monotone"
    assert "contact law 'stop' is not monotone" in uniqueness(asked).text
    assert "may peak higher" in uniqueness(asked, peaks=True).text


def test_missed_tolerances_are_counted():
    assert missed_tolerances(np.array([0, 0]), "points") is None
    missed = missed_tolerances(np.array([0, 1, 1, 4]), "points")
    assert missed.data == {"total": 4, "missed": 3}
    assert missed.text == ("Of 4 points not all met every tolerance: 2 stalled, 1 harmonics limit.")


@pytest.mark.slow
def test_the_exit_code_comes_from_the_severity_whatever_the_wording(tmp_path, monkeypatch):
    cycles = ss.limit_cycles(
        one_dof(0.4), negative_damping=[[-0.4]], ratio=[1.2], harmonics=3, stability=False
    )
    assert kinds.failures(cycles) == []
    stalled = diagnostic("branch-stalled", "Bloqué.")
    marked = replace(cycles, diagnostics=(*cycles.diagnostics, stalled))
    assert kinds.failures(marked) == ["Bloqué."]
    file = tmp_path / "marked.nc"
    marked.save(file)
    assert ss.load(file).diagnostics == marked.diagnostics
    shown = CliRunner().invoke(app, ["show", str(file)])
    assert shown.exit_code == 0
    assert "Bloqué." in shown.stderr

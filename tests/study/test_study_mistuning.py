"""Study files of kind mistuning-study, and what the command line makes of them."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from small_study import ONE_CONTACT, ONE_FORCE, STRUCTURE
from stickslip.cli import app
from stickslip.study import Study

EXAMPLE = Path(__file__).parents[2] / "examples" / "beam-ring" / "mistuning.toml"
DISK = """
[disk]
sectors = 5
engine_order = 2

[[coupling]]
dof = "tip"
stiffness = "20 N/m"
"""
ANALYSIS = """
[analysis]
kind = "mistuning-study"
deviation = ["2 %", 0.05]
patterns = 32
seed = 4
omega = { from = "5 rad/s", to = "60 rad/s" }
harmonics = 3
threads = 1
"""
DAMPED = STRUCTURE.replace("dofs =", 'damping = { rayleigh = { mass = "2 1/s" } }\ndofs =')
TEXT = DAMPED + DISK + ONE_CONTACT + ONE_FORCE + ANALYSIS


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ring.toml").write_text(TEXT)
    return tmp_path


def small_example(patterns=6):
    text = EXAMPLE.read_text()
    text = text.replace("patterns = 1000", f"patterns = {patterns}")
    text = text.replace("sectors = 36", "sectors = 12")
    return Study.parse(text, folder=EXAMPLE.parent, name="small")


@pytest.mark.slow
def test_a_study_file_gives_what_the_function_gives():
    study = Study.parse(TEXT)
    (result,) = study.run()
    same = ss.mistuning_study(
        study.model, [0.02, 0.05], patterns=32, seed=4, omega=(5.0, 60.0), harmonics=3
    )
    for dof in ("tip", "root"):
        assert np.array_equal(result.amplification(dof), same.amplification(dof))
    assert study.dofs == ("tip", "root")
    given = TEXT.replace("patterns = 32", "patterns = [[1, 0, 0, -0.5, 0]]")
    (result,) = Study.parse(given).run()
    assert result.patterns.tolist() == [[1.0, 0.0, 0.0, -0.5, 0.0]]


def test_the_example_in_small():
    study = small_example()
    (result,) = study.run()
    assert (result.status == "converged").all()
    assert result.settings.distribution == "uniform"
    factors = result.amplification("damper")
    assert 1.0 < factors.min() < factors.max() < 2.5


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[disk]\nsectors", "[disk]\nmistuning = {deviation = 0.1}\nsectors", "of a tuned one"),
        ('deviation = ["2 %", 0.05]', "", "analysis: 'deviation' is missing"),
        ('deviation = ["2 %", 0.05]', 'deviation = "2 N"', "'2 N'"),
        ("patterns = 32", "patterns = 0", "patterns: 0 lies below 1"),
        ("patterns = 32", 'patterns = "many"', "patterns: 'many'"),
        ("seed = 4", "seed = -1", "seed: -1"),
        ("seed = 4", 'dofs = ["tpi"]', "unknown dof 'tpi'"),
        ("seed = 4", "sed = 4", "unknown key 'sed'; did you mean 'seed'"),
        ("harmonics = 3", "harmonics = 0", "harmonics: 0"),
    ],
)
def test_bad_studies_are_refused_in_one_line(old, new, message):
    assert old in TEXT
    with pytest.raises(ss.ModelError) as refused:
        Study.parse(TEXT.replace(old, new))
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_without_a_disk():
    with pytest.raises(ss.ModelError, match="analysis: a mistuning-study makes its disks of a"):
        Study.parse(STRUCTURE + ONE_CONTACT + ONE_FORCE + ANALYSIS)


@pytest.mark.slow
def test_run_show_and_plot(folder):
    result = invoke("run", "ring.toml", "--timings")
    assert (result.exit_code, result.stderr) == (0, ""), result.output
    assert "dof   deviation" in result.stdout
    assert "picture: results/ring.png" in result.stdout
    saved = ss.load("results/ring.nc")
    assert saved.amplification("tip").shape == (2, 1, 32)
    mean = saved.factors("tip", deviation=0.02).mean()
    assert f"{mean:.4f}" in result.stdout
    assert (folder / "results" / "ring.png").stat().st_size > 5000
    assert (folder / "results" / "ring.db").is_file()
    shown = invoke("show", "results/ring.nc")
    assert shown.exit_code == 0
    for text in (
        "disk        5 equal sectors, engine order 2",
        "patterns    32 of 5 sectors, normal, seed 4",
        "deviations  0.02, 0.05",
        "peaks       half_range, 5 to 60 rad/s",
        "assumed     The stiffness of whole sectors deviates",
    ):
        assert text in shown.stdout, text
    assert invoke("plot", "results/ring.nc", "--dof", "tip", "--out", "it.svg").exit_code == 0
    assert (folder / "it.svg").stat().st_size > 5000


@pytest.mark.slow
def test_the_store_beside_the_result_is_used_again(folder):
    assert invoke("run", "ring.toml", "--no-plot", "--quiet").exit_code == 0
    first = ss.load("results/ring.nc")
    Path("ring.toml").write_text(TEXT.replace("patterns = 32", "patterns = 34"))
    assert invoke("run", "ring.toml", "--no-plot", "--quiet").exit_code == 0
    more = ss.load("results/ring.nc")
    assert np.array_equal(more.amplification("tip")[..., :32], first.amplification("tip"))
    Path("ring.toml").write_text(TEXT.replace("seed = 4", "seed = 5"))
    refused = invoke("run", "ring.toml", "--no-plot")
    assert refused.exit_code == 2
    (line,) = refused.stderr.splitlines()
    assert "results/ring.db: holds another study (seed is 4 there and 5 here)" in line
    text = TEXT.replace("seed = 4", 'seed = 5\nstore = "other.db"')
    Path("ring.toml").write_text(text)
    assert invoke("run", "ring.toml", "--no-plot", "--quiet").exit_code == 0
    assert (folder / "other.db").is_file()


@pytest.mark.slow
def test_ctrl_c_saves_the_part_and_the_next_run_goes_on(folder):
    Path("ring.toml").write_text(TEXT.replace("patterns = 32", "patterns = 3000"))
    code = """
import os, signal
from stickslip.study.analysis import MistuningStudyTable as table
from stickslip.cli import app
signal.signal(signal.SIGINT, signal.default_int_handler)
whole = table.analysis
sent = []
def interrupted(*arguments, **options):
    def interrupt(fraction):
        # A second signal, on a slow machine, would end the run at once.
        if not sent:
            sent.append(fraction)
            os.kill(os.getpid(), signal.SIGINT)
    return whole(*arguments, **(options | {"progress": interrupt}))
table.analysis = interrupted
app(["run", "ring.toml"])
"""
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 130, done.stderr
    *_, line = done.stderr.splitlines()
    assert line.startswith("interrupted: 0 of 1 studies complete in results, the next one as far")
    assert line.endswith("; run it again to go on from there")
    partial = ss.load("results/ring-partial.nc")
    computed = partial.counters["disks"]
    assert 0 < computed < 6000
    assert invoke("show", "results/ring-partial.nc").exit_code == 0
    analysis = Study.load("ring.toml").tables.analysis
    again = ss.mistuning_study(
        partial.model,
        analysis.deviation,
        patterns=2,
        seed=4,
        omega=(5.0, 60.0),
        harmonics=3,
        store="results/ring.db",
    )
    assert again.counters["disks"] == 4

"""The command line on exact orbits, transients and certificates, in a fresh folder."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

import stickslip as ss
from small_study import ONE_CONTACT, ONE_FORCE, STRUCTURE
from stickslip.cli import app
from stickslip.cli.drawing import Wanted
from stickslip.cli.run import _panels
from stickslip.reference import snecma_beam
from stickslip.study import Study
from stickslip.study.tables import OutputTable
from stickslip.views.kinds import view_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "snecma-beam"

EXACT = 'kind = "exact"\nomega = {from = 150, to = 250, points = 12}\nlevels = [6.563, 20.313]'
TRANSIENT = (
    'kind = "transient"\nomega = "170 rad/s"\nperiods = 60\ntolerance = 1e-6\nlevels = [20.313]\n'
    'keep = 3\nstart = {tip = "0.1 mm"}'
)
CERTIFY = (
    'kind = "certify"\nomega = {from = 150, to = 250}\nlevels = [20.313]\npoints = 5\nseed = 2'
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder, analysis):
    head, tail = (EXAMPLE / "study.toml").read_text().split("[analysis]")
    text = f'name = "beam"\n{head}[analysis]\n{analysis}\n[output]{tail.split("[output]")[1]}'
    (folder / "study.toml").write_text(text)


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def lines_of(result):
    return [line.split() for line in result.stdout.splitlines()]


# ---------------------------------------------------------------------------------- run


@pytest.mark.slow
def test_exact_orbits(folder):
    write(folder, EXACT)
    result = invoke("run", "study.toml", "--timings")
    assert (result.exit_code, result.stderr) == (0, "")
    assert sorted(file.name for file in (folder / "results").iterdir()) == [
        "beam-20.313.nc",
        "beam-6.563.nc",
        "beam.png",
    ]
    saved = ss.load("results/beam-20.313.nc")
    assert isinstance(saved, ss.ExactResponse)
    heading, *rows = lines_of(result)
    assert heading[:4] == ["level", "dof", "rad/s", "Hz"]
    assert rows[2][:2] == ["20.313", "tip"]
    assert float(rows[2][4]) == pytest.approx(1e3 * saved.peak("tip").amplitude, rel=1e-4)
    assert rows[2][6:] == ["exact", "12", "of", "12"]
    assert "total" in result.stdout


@pytest.mark.slow
def test_a_transient(folder):
    write(folder, TRANSIENT)
    result = invoke("run", "study.toml")
    assert (result.exit_code, result.stderr) == (0, "")
    saved = ss.load("results/beam-20.313.nc")
    assert saved.status == "settled"
    assert saved.start.displacement[1] == pytest.approx(1e-4, rel=1e-12)
    heading, *rows = lines_of(result)
    assert heading == ["level", "dof", "amplitude", "[um]", "periods", "change", "rad/s", "status"]
    assert rows[0][:2] == ["20.313", "tip"]
    assert float(rows[0][2]) == pytest.approx(1e6 * saved.amplitude("tip"), rel=1e-6)
    assert rows[0][3] == str(saved.periods)
    assert rows[0][-1] == "settled"
    assert (folder / "results" / "beam.png").stat().st_size > 20_000


@pytest.mark.slow
def test_a_transient_that_has_not_settled_is_a_warning(folder):
    write(folder, TRANSIENT.replace("periods = 60", "periods = 3"))
    result = invoke("run", "study.toml", "--no-plot")
    assert result.exit_code == 1
    (line,) = result.stderr.splitlines()
    assert line.startswith("warning: beam-20.313: not settled after 3 periods. The limit of")
    write(folder, TRANSIENT.replace("tolerance = 1e-6\n", ""))
    result = invoke("run", "study.toml", "--no-plot")
    assert result.exit_code == 0
    assert result.stderr.startswith("warning: beam-20.313: No tolerance was given")


@pytest.mark.slow
def test_a_certified_curve(folder):
    write(folder, CERTIFY)
    result = invoke("run", "study.toml")
    assert (result.exit_code, result.stderr) == (0, "")
    saved = ss.load("results/beam-20.313.nc")
    certificate = saved.certificate
    assert certificate.indices.size == 5
    assert certificate.within_tolerance.all()
    assert "largest true error, against exact orbits" in result.stdout
    rows = [row for row in lines_of(result) if row[:2] == ["20.313", "tip"]]
    assert rows[1][2:5] == ["5", "of", "5"]
    assert rows[1][-3:] == ["5", "of", "5"]
    again = ss.certify(saved, 5, seed=2).certificate
    assert again.indices.tolist() == certificate.indices.tolist()


# ---------------------------------------------------------------------------------- certify


@pytest.mark.slow
def test_certify_puts_the_error_into_the_file(folder):
    frf = ss.forced_response(ss.reference.snecma_beam(31.475), range(150, 200, 5), 15)
    frf.save("curve.nc")
    result = invoke("certify", "curve.nc", "--points", "4", "--seed", "1")
    assert result.exit_code == 0
    assert result.stderr.startswith("warning: curve: The discarded harmonics could still change")
    certificate = ss.load("curve.nc").certificate
    expected = ss.certify(frf, 4, seed=1).certificate
    assert certificate.indices.tolist() == expected.indices.tolist()
    assert certificate.error.tobytes() == expected.error.tobytes()
    title, heading, *rows = [row for row in lines_of(result) if row]
    assert title[0] == "largest"
    assert heading[:3] == ["dof", "orbits", "rad/s"]
    assert [row[0] for row in rows[:3]] == ["damper", "tip", "mode"]
    assert rows[0][1:4] == ["4", "of", "4"]
    assert rows[-1] == ["certified:", "curve.nc"]
    result = invoke("certify", "curve.nc", "--points", "all", "--dof", "tip", "--out", "all.nc")
    assert result.exit_code == 0
    assert ss.load("all.nc").certificate.error.shape == (10, 1)
    assert ss.load("curve.nc").certificate.error.shape == (4, 3)
    shown = invoke("show", "all.nc")
    assert "largest true error, against exact orbits" in shown.stdout
    assert invoke("plot", "all.nc", "--dof", "tip").exit_code == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--points", "some"], "--points = 'some': give a number, or all"),
        (["--points", "0"], "points: 0 lies below 1"),
        (["--points", "1_0"], "--points = '1_0': give a number, or all"),
        (["--points", "\u0661"], "--points = '\u0661': give a number, or all"),
        (["--seed", "1_0"], "'1_0' is not a whole number"),
        (["--seed", "\u0661"], "'\u0661' is not a whole number"),
        (["--seed", "-1"], "seed: -1 lies below 0"),
        (["--dof", "tpi"], "unknown dof 'tpi'; did you mean 'tip'?"),
        (["--out", "none/x.nc"], "there is no folder none; create it first"),
    ],
)
def test_certify_refuses_in_one_line(folder, arguments, message):
    ss.forced_response(ss.reference.snecma_beam(), [150, 170], 3).save("curve.nc")
    result = invoke("certify", "curve.nc", *arguments)
    assert result.exit_code == 2
    (line,) = result.stderr.splitlines()
    assert message in line
    assert ss.load("curve.nc").certificate is None


@pytest.mark.slow
def test_certify_takes_curves_only(folder):
    ss.transient(ss.reference.snecma_beam(), 170.0, 2).save("run.nc")
    result = invoke("certify", "run.nc")
    assert result.exit_code == 2
    assert "is not a ForcedResponse" in result.stderr
    assert len(result.stderr.splitlines()) == 1


# ---------------------------------------------------------------------------------- show, plot


@pytest.fixture
def files(folder):
    beam = ss.reference.snecma_beam(25.0)
    ss.exact_response(beam, [150, 170, 200, 250]).save("exact.nc")
    ss.transient(beam, 200.0, 20, keep=5).save("run.nc")
    ss.forced_response(beam, [150, 170, 200, 250], 5).save("curve.nc")
    return folder


@pytest.mark.slow
def test_show(files):
    result = invoke("show", "exact.nc", "run.nc")
    assert (result.exit_code, result.stderr) == (0, "")
    for text in (
        "harmonics  exact orbits, reported up to 32",
        "events     0 to 12 per period",
        "stability  4 stable, largest multiplier 0.",
        "assumed    Orbits were sought on half a period",
        "scheme   exact",
        "periods  20 of at most 20",
        "status   completed",
        "events   60 in the periods kept",
        "assumed  The run starts from rest",
    ):
        assert text in result.stdout, text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["exact.nc"], "exact-curve.png"),
        (["exact.nc", "curve.nc", "--dof", "tip", "--hertz"], "exact-curve.png"),
        (["exact.nc", "--waveform", "170", "--dof", "tip"], "exact-waveform.png"),
        (["exact.nc", "--loop", "200"], "exact-loop.png"),
        (["exact.nc", "--events", "200"], "exact-events.png"),
        (["exact.nc", "--multipliers"], "exact-multipliers.png"),
        (["run.nc"], "run-transient.png"),
        (["run.nc", "--dof", "mode", "--out", "mode.svg"], "mode.svg"),
    ],
)
def test_plot(files, arguments, name):
    result = invoke("plot", *arguments)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == f"picture: {name}\n"
    assert (files / name).stat().st_size > 5000


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["curve.nc", "--events", "200"], "--events: needs exact orbits; run the study with kind"),
        (["curve.nc", "--multipliers"], "--multipliers: needs exact orbits"),
        (["run.nc", "--waveform", "200"], "--waveform: run holds a transient, which has no such"),
        (["run.nc", "curve.nc"], "transient and forced response do not go together"),
        (["exact.nc", "--events", "200", "--loop", "200"], "--loop and --events exclude each"),
        (["exact.nc", "--events", "900"], "--events = '900': 900 rad/s lies outside the comp"),
        (["run.nc", "--dof", "tpi"], "unknown dof 'tpi'"),
    ],
)
def test_plot_refuses_in_one_line(files, arguments, message):
    result = invoke("plot", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert message in line


# ---------------------------------------------------------------------------------- studies


def parse(analysis):
    return Study.parse(STRUCTURE + ONE_CONTACT + ONE_FORCE + f"[analysis]\n{analysis}")


@pytest.mark.parametrize(
    ("analysis", "message"),
    [
        ('kind = "exat"\nomega = [1]', "analysis: unknown kind 'exat'; did you mean 'exact'?"),
        ('kind = "exact"', "analysis: 'omega' is missing"),
        ('kind = "exact"\nomega = [1]\nharmonics = "auto"', "harmonics: 'auto' is not an integer"),
        ('kind = "exact"\nomega = [1]\nmethod = "newton"', "unknown key 'method'"),
        ('kind = "transient"\nomega = [1]', "omega = [1] is not a frequency [rad/s]"),
        ('kind = "transient"\nomega = 1\nperiods = 0', "periods: 0 lies below 1"),
        ('kind = "transient"\nomega = 1\nscheme = "rk5"', "scheme: unknown choice 'rk5'; did you"),
        ('kind = "transient"\nomega = 1\ntolerance = 2', "tolerance: 2; give a fraction from"),
        ('kind = "transient"\nomega = 1\nstart = {tpi = 1}', "start[1]: unknown dof 'tpi'"),
        ('kind = "transient"\nomega = 1\nstart = {tip = "1 N"}', "'1 N' is not a length [m]"),
        ('kind = "transient"\nomega = 1\nsteps = 2', "steps: 2 lies below 4"),
        (
            'kind = "certify"\nomega = [1]\npoints = "some"',
            "points: 'some'; give \"all\", a number",
        ),
        ('kind = "certify"\nomega = [1]\npoints = []', "points: empty; give at least one"),
        ('kind = "certify"\nomega = [1]\npoints = 0', "points: 0 lies below 1"),
    ],
)
def test_bad_studies_are_refused_in_one_line(analysis, message):
    with pytest.raises(ss.ModelError) as refused:
        parse(analysis)
    text = str(refused.value)
    assert message in text
    assert "analysis" in text
    assert "\n" not in text


def test_points_may_be_positions():
    study = parse('kind = "certify"\nomega = [1, 2, 3]\nharmonics = 3\npoints = [0, 2]')
    (result,) = study.run()
    assert result.certificate.indices.tolist() == [0, 2]
    told = []
    (result,) = study.run(told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


@pytest.mark.slow
def test_the_schema_has_every_kind():
    schema = json.dumps(json.loads(invoke("schema").stdout))
    for kind in ("forced-response", "exact", "transient", "certify"):
        assert f'"const": "{kind}"' in schema


@pytest.mark.slow
def test_ctrl_c_saves_the_part_of_a_run(folder):
    write(folder, TRANSIENT.replace("60", "2000000").replace("tolerance = 1e-6\n", ""))
    code = """
import os, signal
from stickslip.study.analysis import TransientTable as table
from stickslip.cli import app
from stickslip.cli.drawing import Wanted
from stickslip.cli.run import _panels
from stickslip.reference import snecma_beam
signal.signal(signal.SIGINT, signal.default_int_handler)
whole = table.analysis
sent = []
def interrupted(*arguments, **options):
    def interrupt(fraction):
        # A second signal, on a slow machine, would end the run at once.
        if fraction > 0 and not sent:
            sent.append(fraction)
            os.kill(os.getpid(), signal.SIGINT)
    return whole(*arguments, **(options | {"progress": interrupt}))
table.analysis = interrupted
app(["run", "study.toml"])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 130
    *_, line = done.stderr.splitlines()
    assert line.startswith("interrupted: 0 of 1 runs complete in results, the next one as far")
    partial = ss.load("results/beam-20.313-partial.nc")
    assert partial.status == "interrupted"
    assert 0 < partial.periods < 2_000_000


def drawn_titles(panels):
    titles = []
    for panel in panels:
        ax = Figure().add_subplot()
        panel(ax=ax)
        titles.append(ax.get_title())
    return titles


def test_pictures_without_frequencies_take_no_unit_of_them():
    result = ss.static_response(ss.reference.snecma_beam())
    wanted = Wanted(dofs=None, omega_unit="rpm", log=True, per_force=False, contact=None)
    with pytest.raises(ss.ModelError, match="--rpm: changes nothing of a static response"):
        wanted.picture({}, [("rest.nc", result)])


@pytest.mark.slow
def test_pictures_name_the_results_they_show():
    moved = [
        ("0.3", ss.transient(snecma_beam(6.0), 170.0, 3)),
        ("1", ss.transient(snecma_beam(), 170.0, 3)),
    ]
    output = OutputTable()
    titles = drawn_titles(_panels(view_of([moved[0][1]]), moved, ["tip"], output))
    half = len(titles) // 2
    assert all(title.startswith("level 0.3") for title in titles[:half])
    assert all(title.startswith("level 1") for title in titles[half:])
    wanted = Wanted(dofs=["tip"], omega_unit="rad/s", log=True, per_force=False, contact=None)
    named = [("first.nc", moved[0][1]), ("second.nc", moved[1][1])]
    _, panels = wanted.picture({}, named)
    assert {title.partition(":")[0] for title in drawn_titles(panels)} == {"first.nc", "second.nc"}

"""The explorer: sliders of a study, the study they make, and what is computed of it."""

import json
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import EXAMPLE, invoke
from small_study import ANALYSIS, ONE_CONTACT, ONE_FORCE, SMALL, STRUCTURE

pytest.importorskip("tomlkit")
pytest.importorskip("tornado")

from stickslip.explore import panes
from stickslip.explore.draft import MOST, Draft
from stickslip.explore.session import Session

# the page marks these peaks, as the command does
pytestmark = pytest.mark.filterwarnings("ignore:peak of:UserWarning")

EXAMPLES = EXAMPLE.parent
BEAM = EXAMPLE / "study.toml"
TWO = SMALL.replace(ONE_FORCE, ONE_CONTACT.replace("root", "tip").replace("= 2", "= '3 kN'"))
TWO = f"{TWO}{ONE_FORCE}".replace("dofs = [", "damping = {modal = 0.02}\ndofs = [")


def never(_):
    return None


@pytest.fixture
def draft(tmp_path):
    def made(text):
        file = tmp_path / "small.toml"
        file.write_text(text)
        return Draft(file)

    return made


def moved(draft, **values):
    return [values.get(one.label.replace(" ", "_"), one.value) for one in draft.knobs]


class Told(list):
    """What a session tells its page."""

    def __init__(self):
        super().__init__()
        self.change = threading.Condition()

    def __call__(self, message):
        text = json.dumps(message, allow_nan=False)
        with self.change:
            self.append(json.loads(text))
            self.change.notify_all()

    def until(self, wanted):
        with self.change:
            assert self.change.wait_for(lambda: any(map(wanted, self)), 120)
            return next(one for one in self if wanted(one))

    def pane(self, number, name):
        return self.until(
            lambda one: one.get("number") == number and one["pane"] == name and "figures" in one
        )


@pytest.fixture
def session():
    opened = []

    def made(path):
        told = Told()
        opened.append(Session(Path(path), told))
        return opened[-1], told

    yield made
    for one in opened:
        one.end()
        assert one.ended(60)


def asked(session, number=1, **given):
    greeting = session.greeting()
    known = {
        "number": number,
        "want": "panes",
        "values": moved(session.draft, **given.pop("moves", {})),
        "dof": greeting["dofs"][0],
        "over": [*greeting["overs"], ""][0],
    }
    return json.dumps(known | given)


# ------------------------------------------------------------------------------------- sliders


def test_sliders_of_the_beam():
    level, stiffness, slip = Draft(BEAM).knobs
    # the middle one of eight levels
    assert (level.label, level.value, level.unit) == ("level", 20.313, "")
    assert (stiffness.label, stiffness.value, stiffness.unit) == ("stiffness", 24.0, "kN/mm")
    assert (slip.group, slip.value, slip.unit) == ("contact 1 (jenkins)", 246.048, "N")
    assert slip.low < slip.value < slip.high
    assert slip.log


@pytest.mark.parametrize(
    ("study", "wanted"),
    [
        ("friction-pad", {"friction", "preload", "tangential stiffness", "normal stiffness"}),
        ("wedge-damper", {"mass", "load", "angle", "friction"}),
        ("laxalde-blisk", {"slip force", "stiffness"}),
        # the fourth limit is infinite, and the stiffness a matrix
        ("beam-pair", {"slip forces 1", "slip forces 2", "slip forces 3"}),
    ],
)
def test_sliders_of_other_contacts(study, wanted):
    found = Draft(EXAMPLES / study / "study.toml").knobs
    assert wanted <= {one.label for one in found}
    assert {"stiffness 1", "slip forces 4"}.isdisjoint(one.label for one in found)
    assert all(one.low <= one.value <= one.high for one in found)


def test_contacts_are_told_apart_and_loads_at_rest_can_be_moved(draft):
    load = ONE_FORCE.replace("amplitude = 1", "amplitude = -2\nharmonic = 0")
    known = [(one.group, one.label, one.value, one.unit) for one in draft(TWO + load).knobs]
    assert ("contact 1 (jenkins)", "slip force", 2.0, "N") in known
    assert ("contact 2 (jenkins)", "slip force", 3.0, "kN") in known
    assert ("force 3", "static load", -2.0, "N") not in known
    assert known[-1] == ("force 2", "static load", -2.0, "N")


def test_a_page_has_no_end_of_sliders(draft):
    many = STRUCTURE + 60 * ONE_CONTACT + ONE_FORCE + ANALYSIS
    assert len(draft(many).knobs) == MOST


def test_a_study_without_a_curve_is_refused():
    with pytest.raises(ss.ModelError, match="kind = 'limit-cycles' has no response curve"):
        Draft(EXAMPLES / "flutter-beam" / "study.toml")


# ----------------------------------------------------------------------------- the study they make


def test_only_what_was_moved_is_written_anew():
    draft = Draft(BEAM)
    before, after = draft.text(moved(draft)), draft.text(moved(draft, slip_force=300.0))
    lines = zip(before.splitlines(), after.splitlines(), strict=True)
    assert [pair for pair in lines if pair[0] != pair[1]] == [
        ('slip_force = "246.048 N"', 'slip_force = "300 N"')
    ]
    assert "# one DOF: to ground" in after
    # and back again
    assert draft.text(moved(draft)) == before


def test_the_unit_of_the_file_stays():
    draft = Draft(BEAM)
    study = draft.parsed(draft.text(moved(draft, stiffness=30.0, level=2.0)))
    assert study.model.contacts[0].stiffness == pytest.approx(30e6)
    assert [case.level for case in study.cases] == [2.0]


def test_lists_and_plain_numbers_are_moved(draft):
    pair = Draft(EXAMPLES / "beam-pair" / "study.toml")
    study = pair.parsed(pair.text(moved(pair, slip_forces_2=77.0)))
    assert study.model.contacts[0].slip_forces == (24.6, 77.0, 246.05, np.inf)
    small = draft(SMALL)
    assert small.parsed(small.text(moved(small, slip_force=7.5))).model.contacts[0].limits == (7.5,)


@pytest.mark.slow
@pytest.mark.parametrize("study", ["snecma-beam", "friction-pad", "wedge-damper"])
def test_an_exported_study_gives_the_same_curve(study, tmp_path, monkeypatch):
    draft = Draft(EXAMPLES / study / "study.toml")
    values = moved(draft, slip_force=310.0, friction=0.35, level=1.2)
    monkeypatch.chdir(tmp_path)
    Path("out.toml").write_text(draft.exported(values))
    result = invoke("run", "out.toml", "--no-plot")
    assert result.exit_code == 0, result.stderr
    (file,) = Path("results").glob("*.nc")
    (curve,) = draft.parsed(draft.text(values)).run()
    dof = draft.study.dofs[0]
    stored = ss.load(file)
    assert np.array_equal(stored.omega, curve.omega)
    assert np.array_equal(stored.amplitude(dof), curve.amplitude(dof))
    named = "name" in draft.exported(values).split("[structure]")[0]
    assert file.stem == (f"{study}-explored-1.2" if named else "out-1.2")


# --------------------------------------------------------------------------------- what is computed


@pytest.mark.slow
def test_panes_come_in_the_order_of_the_page(session, tmp_path):
    file = tmp_path / "two.toml"
    file.write_text(TWO)
    page, told = session(file)
    page.take(asked(page))
    told.pane(1, "damper")
    shown = [one for one in told if "figures" in one]
    assert [one["pane"] for one in shown] == ["curve", "contacts", "damper"]
    assert all(one["failures"] == [] for one in shown)
    # the loops of both contacts, and slip
    assert len(shown[1]["figures"]) == 3


@pytest.mark.slow
def test_the_optimum_is_that_of_the_library(session):
    page, told = session(BEAM)
    page.take(asked(page, moves={"stiffness": 20.0}))
    pane = told.pane(1, "damper")
    beam = ss.reference.snecma_beam(20.313)
    contact = ss.Jenkins("damper", stiffness=20e6, slip_force=246.048)
    model = ss.Model(beam.structure, [contact], beam.forces)
    best = ss.optimal_damper(model, dof="tip", omega=(20, 350), harmonics=35)
    (table,) = pane["tables"]
    value = table["headings"].index("value")
    assert float(table["rows"][0][value]) == pytest.approx(best.value, rel=1e-5)
    names = [one.get("name") for one in json.loads(pane["figures"][0]["data"])["data"]]
    assert "now: 246 N" in names


@pytest.mark.slow
def test_the_newest_position_wins(session):
    page, told = session(EXAMPLES / "wedge-damper" / "study.toml")
    page.take(asked(page, over="friction"))
    # a share is told while the damper curve is computed, for a minute if it were not dropped
    told.until(lambda one: one.get("pane") == "damper" and "share" in one)
    page.take(asked(page, 2, moves={"friction": 0.3}, over="friction"))
    told.pane(2, "contacts")
    page.take(asked(page, 3, moves={"friction": 0.4}, over="friction"))
    told.pane(3, "contacts")
    assert not any(one.get("pane") == "damper" and "figures" in one for one in told)
    numbers = [one["number"] for one in told if one.get("pane") == "curve"]
    assert numbers == sorted(numbers)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"slip_force": -5.0}, "contact 1: slip_force = -5.0 must not be negative"),
        ({"level": 0.0}, "levels"),
        ({"stiffness": 1e308}, "entries of absurd size"),
    ],
)
@pytest.mark.slow
def test_what_the_library_refuses_stands_on_the_page(session, tmp_path, values, said):
    file = tmp_path / "small.toml"
    file.write_text(SMALL)
    page, told = session(file)
    page.take(asked(page, moves=values))
    (line,) = told.pane(1, "curve")["failures"]
    assert said in line
    assert "\n" not in line
    assert told.pane(1, "damper")["figures"] == []
    # and the page lives on
    page.take(asked(page, 2))
    assert told.pane(2, "curve")["failures"] == []


def test_points_without_a_solution_are_told(session, tmp_path):
    file = tmp_path / "small.toml"
    file.write_text(SMALL.replace("harmonics = 3", "harmonics = 31\nmax_iterations = 1"))
    page, told = session(file)
    page.take(asked(page, over="slip_force", moves={"slip_force": 0.3}))
    (line,) = told.pane(1, "curve")["failures"]
    assert "of 5 points" in line


@pytest.mark.parametrize(
    "message",
    [
        "",
        "null",
        "[" * 40_000,
        '{"number": 1}',
        '{"number": 1e999}',
        b"\xff\xfe",
        "unknown key",
        "not a number",
        "too few",
        "unknown dof",
        "unknown parameter",
        "code",
    ],
)
def test_messages_made_by_hand_are_refused_in_a_line(session, message):
    page, told = session(BEAM)
    spoilt = {
        "unknown key": {"eval": "1"},
        "not a number": {"values": [1.0, "__import__('os')", 2.0]},
        "too few": {"values": [1.0]},
        "unknown dof": {"dof": "../../etc/passwd"},
        "unknown parameter": {"over": "__class__"},
        "code": {"want": "run"},
    }
    if message in spoilt:
        message = asked(page, **spoilt[message])
    page.take(message)
    (refusal,) = told
    assert list(refusal) == ["refused"]
    assert "\n" not in refusal["refused"]


@pytest.mark.parametrize("value", ["NaN", "Infinity", "1e999"])
def test_only_finite_numbers_are_taken(session, value):
    page, told = session(BEAM)
    page.take(asked(page).replace("246.048", value))
    assert "values" in told[0]["refused"]


@pytest.mark.slow
def test_a_picture_has_all_that_is_shown(session, tmp_path, monkeypatch):
    file = tmp_path / "small.toml"
    file.write_text(SMALL)
    page, told = session(file)
    page.take(asked(page, want="picture"))
    assert "nothing is drawn yet" in told.until(lambda one: "refused" in one)["refused"]
    page.take(asked(page))
    told.pane(1, "damper")
    with monkeypatch.context() as patch:
        # It is made in memory.
        patch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
        page.take(asked(page, want="picture"))
        assert told.until(lambda one: "picture" in one)["file"] == "small-explored.png"


# ------------------------------------------------------------------------------ the damper curve


def test_different_values_are_varied_by_a_factor(draft):
    one, two = draft(SMALL).study.model, draft(TWO).study.model
    assert panes.present(one, "slip_force") == ("value", 2.0)
    assert panes.present(two, "slip_force") == ("factor", 1.0)
    assert panes.present(two, "stiffness") == ("value", 1e3)
    assert panes.present(two, "level") == ("value", 1.0)
    pair = Draft(EXAMPLES / "beam-pair" / "study.toml").study.model
    assert panes.present(pair, "stiffness") == ("factor", 1.0)


def test_a_model_without_contacts_has_no_damper_curve(draft, session, tmp_path):
    linear = draft(STRUCTURE + ONE_FORCE + ANALYSIS)
    assert panes.parameters(linear.study.model) == []
    page, told = session(tmp_path / "small.toml")
    page.take(asked(page))
    assert told.pane(1, "damper")["failures"] == []


@pytest.mark.slow
def test_a_sweep_is_left_out_and_named(session, tmp_path):
    file = tmp_path / "swept.toml"
    file.write_text(SMALL + "\n[sweep]\nslip_force = [1, 2]\n")
    page, told = session(file)
    assert page.greeting()["description"] == "The table [sweep] of the file is left out here."
    assert "sweep" not in page.draft.exported(moved(page.draft))
    page.take(asked(page))
    for name in ("curve", "contacts", "damper"):
        said = told.pane(1, name)["failures"]
        assert not any("defect" in one for one in said)
    assert told.pane(1, "contacts")["figures"]


@pytest.mark.slow
def test_nothing_of_it_is_loaded_with_the_library():
    code = (
        "import sys, stickslip\nfrom stickslip.cli import app\n"
        "assert not {'tornado', 'tomlkit', 'plotly', 'stickslip.explore'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_an_exported_study_finds_the_matrices_of_a_speed(tmp_path):
    for name, value in (("M", 1.0), ("K", 4e4), ("K2", 2.0)):
        np.save(tmp_path / f"{name}.npy", np.array([[value]]))
    own = """
        [structure]
        mass = "M.npy"
        stiffness = "K.npy"
        stiffening = "K2.npy"
        speed = "3000 rpm"
        dofs = ["tip"]
        [[force]]
        dof = "tip"
        amplitude = 1.0
        [analysis]
        omega = [100]
    """
    (tmp_path / "study.toml").write_text(own)
    drafted = Draft(tmp_path / "study.toml")
    assert str(tmp_path / "K2.npy") in drafted.exported([one.value for one in drafted.knobs])

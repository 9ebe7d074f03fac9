import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from stickslip import ModelError, reference
from stickslip.study import Study, json_schema

EXAMPLE = Path(__file__).parents[1] / "examples" / "snecma-beam"

STRUCTURE = """
[structure]
mass = [[2, 0.5], [0.5, 1]]
stiffness = [[800, -200], [-200, 200]]
dofs = ["root", "tip"]
"""
ONE_CONTACT = """
[[contact]]
law = "jenkins"
dof = "root"
stiffness = 1e3
slip_force = 2
"""
ONE_FORCE = """
[[force]]
dof = "tip"
amplitude = 1
"""
ANALYSIS = """
[analysis]
omega = {from = 1, to = 30, points = 5}
harmonics = 3
"""
SMALL = STRUCTURE + ONE_CONTACT + ONE_FORCE + ANALYSIS


def test_the_example_is_the_reference_beam():
    study = Study.load(EXAMPLE / "study.toml")
    beam = reference.snecma_beam(1.0)
    for matrix in ("mass", "damping", "stiffness"):
        assert getattr(study.model.structure, matrix) == pytest.approx(
            getattr(beam.structure, matrix), rel=1e-15
        )
    assert study.model.structure.dofs == beam.structure.dofs
    assert study.model.contacts == beam.contacts
    assert study.model.forces == beam.forces
    assert study.name == "snecma-beam"
    assert study.dofs == ("tip", "damper")


def test_each_level_is_one_case_with_its_forces_scaled():
    study = Study.load(EXAMPLE / "study.toml")
    assert [case.level for case in study.cases] == list(reference.SNECMA_LOADS)
    assert [model.forces[0].amplitude for model in study.models()] == list(reference.SNECMA_LOADS)
    assert study.cases[4].name == "snecma-beam-20.313"
    assert study.cases[5].name == "snecma-beam-25"


def test_without_levels_there_is_one_case_named_as_the_study():
    (case,) = Study.parse(SMALL, name="pair").cases
    assert case.name == "pair"
    assert case.level is None
    (case,) = Study.parse('name = "the pair"\n' + SMALL, name="pair").cases
    assert case.name == "the pair"


def test_every_quantity_may_carry_a_unit():
    text = """
    [structure]
    mass = [[1]]
    stiffness = [[100]]
    damping = {modal = "0.5 %"}
    [[contact]]
    law = "jenkins"
    dof = 0
    stiffness = "0.3 N/mm"
    slip_force = inf
    [[force]]
    dof = "0"
    amplitude = "1 kN"
    phase = "90 deg"
    [analysis]
    omega = ["1 Hz", 10]
    tolerance = "0.2 %"
    residual = "-1 mN"
    """
    study = Study.parse(text)
    (contact,), (force,) = study.model.contacts, study.model.forces
    assert study.model.structure.damping[0, 0] == pytest.approx(0.005 * 2 * 10)
    assert contact.parameters() == {"stiffness": pytest.approx(300), "slip_force": math.inf}
    assert force.amplitude == 1000
    assert force.phase == pytest.approx(math.pi / 2)
    assert study.tables.analysis.omega == pytest.approx((2 * math.pi, 10))
    assert study.tables.analysis.tolerance == pytest.approx(0.002)
    assert study.tables.analysis.residual == pytest.approx(-0.001)


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        ('{from = 1, to = "5 rad/s", points = 5}', np.arange(1.0, 6.0)),
        ("{from = 5, to = 1, points = 5}", np.arange(5.0, 0.0, -1.0)),
        ('{from = 1, to = 100, points = 3, spacing = "log"}', np.array([1.0, 10.0, 100.0])),
        ("{from = 1, to = 5}", (1.0, 5.0)),
    ],
)
def test_a_range_of_omega_is_a_grid_or_adaptive(entry, expected):
    text = SMALL.replace("{from = 1, to = 30, points = 5}", entry)
    omega = Study.parse(text).tables.analysis.omega.values()
    assert type(omega) is type(expected)
    assert omega == pytest.approx(expected)


@pytest.mark.parametrize(
    "entry",
    [
        '"mass.npz"',
        '{file = "mass.npz"}',
        '{file = "mass.npz", key = "M"}',
        "[[2.0, 0.5], [0.5, 1.0]]",
    ],
)
def test_a_matrix_is_a_file_or_rows(entry, tmp_path):
    np.savez(tmp_path / "mass.npz", M=[[2.0, 0.5], [0.5, 1.0]])
    text = SMALL.replace("[[2, 0.5], [0.5, 1]]", entry)
    mass = Study.parse(text, folder=tmp_path).model.structure.mass
    assert mass == pytest.approx(np.array([[2.0, 0.5], [0.5, 1.0]]))


@pytest.mark.parametrize(
    ("damping", "expected"),
    [
        ("[[3, 1], [1, 2]]", [[3, 1], [1, 2]]),
        ("{rayleigh = {mass = 2}}", [[4, 1], [1, 2]]),
        ('{rayleigh = {stiffness = "10 ms"}}', [[8, -2], [-2, 2]]),
    ],
)
def test_damping_is_a_matrix_or_a_law(damping, expected):
    text = SMALL.replace("dofs = [", f"damping = {damping}\ndofs = [", 1)
    assert Study.parse(text).model.structure.damping == pytest.approx(np.array(expected))


def test_dofs_shown_are_those_with_a_force_or_a_contact_unless_named():
    assert Study.parse(SMALL).dofs == ("tip", "root")
    assert Study.parse(SMALL + 'observe = ["root"]').dofs == ("root",)
    assert Study.parse(SMALL + '[output]\ndofs = ["root"]').dofs == ("root",)


BAD_ENTRIES = [
    # what is written, what takes its place, what the message says
    ("[structure]", "[structur]", "unknown key 'structur'; did you mean 'structure'?"),
    ("slip_force", "slipforce", "contact 1: unknown key 'slipforce'; did you mean 'slip_force'?"),
    ("amplitude", "amplitud", "force 1: unknown key 'amplitud'; did you mean 'amplitude'?"),
    ("points = 5", "pionts = 5", "analysis: omega: unknown key 'pionts'; did you mean 'points'?"),
    ("stiffness = 1e3", "", "contact 1: 'stiffness' is missing"),
    (ANALYSIS, "", "[analysis] is missing"),
    ("[analysis]", "[[analysis]]", "is not written as a table; begin it with [analysis]"),
    ("[[contact]]", "[contact]", "is not written as a table; begin it with [[contact]]"),
    ("[[force]]", "[force]", "is not written as a table; begin it with [[force]]"),
    ("[structure]", "[[structure]]", "is not written as a table; begin it with [structure]"),
    (
        STRUCTURE + ONE_CONTACT,
        "contact = [3]" + STRUCTURE,
        "contact 1 = 3 is not written as a table",
    ),
    ('law = "jenkins"', 'law = "jenkin"', "contact 1: unknown law 'jenkin'; did you mean"),
    ('law = "jenkins"', "", "contact 1: 'law' is missing; known: 'jenkins'"),
    (
        "harmonics = 3",
        'kind = "forced"',
        "analysis: unknown kind 'forced'; known: 'forced-response'",
    ),
    ("amplitude = 1", 'amplitude = "20 kg"', "force 1: amplitude = '20 kg' is not a force [N]"),
    ("amplitude = 1", 'amplitude = "20,5 N"', "force 1: amplitude = '20,5 N' has a decimal comma"),
    ("amplitude = 1", "amplitude = nan", "force 1: amplitude = nan is not finite"),
    ("amplitude = 1", "amplitude = inf", "force 1: amplitude = inf is not finite"),
    ("amplitude = 1", "amplitude = true", "force 1: amplitude = True is not a force"),
    ("amplitude = 1", "amplitude = 1\nharmonic = -1", "force 1: harmonic = -1 is below the least"),
    ("amplitude = 1", "amplitude = 1\nharmonic = 1.5", "harmonic = 1.5 is not a whole number"),
    (
        "amplitude = 1",
        "amplitude = 1\nharmonic = 0\nphase = 1",
        "force 1: force at 'tip': phase 1 on",
    ),
    ("amplitude = 1", 'amplitude = 1\nphase = "5 %"', "phase = '5 %' is not an angle [rad]"),
    ("slip_force = 2", "slip_force = nan", "contact 1: slip_force = nan is not a number"),
    ("slip_force = 2", "slip_force = -2", "contact 1: slip_force = -2 must be not negative"),
    ("slip_force = 2", 'slip_force = 2\nname = ""', "contact 1: name = '' is empty"),
    ("stiffness = 1e3", "stiffness = -1", "contact 1: stiffness = -1 must be not negative"),
    ("stiffness = 1e3", 'stiffness = "1 kN"', "contact 1: stiffness = '1 kN' is not a stiffness"),
    ('dof = "root"', 'dof = "rot"', "contact 1: unknown dof 'rot'; did you mean 'root'?"),
    ('dof = "root"', "", "contact 1: give either 'dof', for a contact to ground, or 'dofs'"),
    ('dof = "root"', 'dof = "root"\ndofs = ["root", "tip"]', "contact 1: give either 'dof'"),
    ('dof = "root"', 'dofs = ["root"]', "contact 1: dofs"),
    ('dof = "root"', 'dofs = ["tip", "tip"]', "contact 1: jenkins contact: both ends at dof 'tip'"),
    ('dof = "root"', "dof = true", "contact 1: dof = True is not a text"),
    ('dof = "tip"', 'dof = "tpi"', "force 1: unknown dof 'tpi'; did you mean 'tip'?"),
    (
        'dofs = ["root", "tip"]',
        'dofs = ["tip", "tip"]',
        "structure: dofs: 'tip' is given more than",
    ),
    ('dofs = ["root", "tip"]', 'dofs = ["tip"]', "structure: dofs: 1 names for 2 dofs"),
    ('dofs = ["root", "tip"]', 'dofs = "tip"', "structure: dofs = 'tip' is not a list"),
    ("[[2, 0.5], [0.5, 1]]", "3", "structure: mass = 3 is neither a file name, nor {file = ..."),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 0.5], [0.5]]", "structure: mass has rows of different lengths"),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 0.5], [0.5, nan]]", "structure: mass[2][2] = nan is not finite"),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 1], [0.5, 1]]", "structure: mass: 1 at ('root', 'tip') but 0.5"),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 3], [3, 1]]", "structure: mass: smallest eigenvalue"),
    ("[[2, 0.5], [0.5, 1]]", "[2, 1]", "structure: mass[1] = 2 is not a list"),
    ("[[2, 0.5], [0.5, 1]]", '"mas.mtx"', "structure: mass = 'mas.mtx': no such file in"),
    ("[[2, 0.5], [0.5, 1]]", '{fil = "m.mtx"}', "structure: mass: unknown key 'fil'; did you mean"),
    ("dofs = [", "damping = 0.01\ndofs = [", "structure: damping = 0.01 is neither a matrix, nor"),
    ("dofs = [", "damping = {modal = [0.1]}\ndofs = [", "structure: damping: 1 ratios for 2 modes"),
    (
        "dofs = [",
        'damping = {modal = "x"}\ndofs = [',
        "structure: damping.modal = 'x' is not a ratio",
    ),
    (
        "dofs = [",
        "damping = {rayleigh = {mas = 1}}\ndofs = [",
        "damping.rayleigh: unknown key 'mas'",
    ),
    ("from = 1", "from = -1", "analysis: omega.from = -1 must be positive"),
    ("from = 1", "from = 0", "analysis: omega.from = 0 must be positive"),
    ("from = 1", "from = 30", "analysis: omega: 'from' and 'to' are equal"),
    ("from = 1", 'from = "1 1/s"', "omega.from = '1 1/s' is not a frequency [rad/s]"),
    ("points = 5", 'spacing = "log"', "analysis: omega: 'spacing' needs 'points'"),
    ("points = 5", 'points = 5, spacing = "lin"', "unknown choice 'lin'; did you mean 'linear'?"),
    ("points = 5", "points = 1", "analysis: omega.points = 1 is below the least allowed, 2"),
    ("points = 5", "points = 5.0", "analysis: omega.points = 5.0 is not a whole number"),
    ("{from = 1, to = 30, points = 5}", "[]", "analysis: omega = [] has too few entries"),
    ("{from = 1, to = 30, points = 5}", "[3, -1]", "analysis: omega[2] = -1 must be positive"),
    ("{from = 1, to = 30, points = 5}", "7", "analysis: omega = 7 is neither {from = ..., to"),
    ("harmonics = 3", "harmonics = 0", "analysis: harmonics = 0 is below the least allowed, 1"),
    (
        "harmonics = 3",
        'harmonics = "atuo"',
        "harmonics: unknown choice 'atuo'; did you mean 'auto'",
    ),
    ("harmonics = 3", "harmonics = true", "analysis: harmonics = True is not a whole number"),
    ("harmonics = 3", "harmonics = 999", "analysis: harmonics: 999 lies above max_harmonics"),
    ("harmonics = 3", "tolerance = 2", "analysis: tolerance: 2; give a fraction above 0"),
    ("harmonics = 3", "tolerance = 0", "analysis: tolerance = 0 must be positive"),
    ("harmonics = 3", 'method = "newtn"', "unknown method 'newtn'; did you mean 'newton'?"),
    ("harmonics = 3", 'residual = "centered"', "unknown choice 'centered'; did you mean 'centred'"),
    ("harmonics = 3", 'residual = "3 m"', "analysis: residual = '3 m' is not a force [N]"),
    ("harmonics = 3", 'observe = ["tpi"]', "analysis: observe[1]: unknown dof 'tpi'; did you mean"),
    ("harmonics = 3", "observe = []", "analysis: observe = [] has too few entries"),
    ("harmonics = 3", "levels = [1, 2, 1]", "analysis: levels holds 1 twice; each level is one"),
    ("harmonics = 3", "levels = [1, -2]", "analysis: levels[2] = -2 must be positive"),
    ("harmonics = 3", 'levels = ["2 N"]', "analysis: levels[1] = '2 N' is not a ratio"),
    ("harmonics = 3", '[output]\ndofs = ["tpi"]', "output: dofs[1]: unknown dof 'tpi'"),
    (
        "harmonics = 3",
        'observe = ["tip"]\n[output]\ndofs = ["root"]',
        "output: dofs[1]: 'root' is not kept; add it to 'observe' in [analysis]",
    ),
    ("harmonics = 3", '[output]\nomega_unit = "hz"', "output: omega_unit: unknown choice 'hz'"),
    (STRUCTURE, 'name = "a/b"' + STRUCTURE, "name = 'a/b' does not make a file name"),
    ("mass = [[", "mass = [[[", "not valid TOML"),
    ("harmonics = 3", "harmonics = 3\nharmonics = 5", "not valid TOML: Cannot overwrite a value"),
]


@pytest.mark.parametrize(("written", "instead", "message"), BAD_ENTRIES)
def test_a_bad_entry_is_refused_in_one_line(written, instead, message, tmp_path):
    text = SMALL.replace(written, instead, 1)
    assert text != SMALL
    with pytest.raises(ModelError) as caught:
        Study.parse(text, folder=tmp_path, source="study.toml")
    refusal = str(caught.value)
    assert refusal.startswith("study.toml: ")
    assert message in refusal
    assert "\n" not in refusal
    assert "\0" not in refusal


def test_the_second_contact_is_contact_2():
    bad = ONE_CONTACT.replace("stiffness", "stifness")
    expected = r"contact 2: unknown key 'stifness'; did you mean 'stiffness'\?"
    with pytest.raises(ModelError, match=expected):
        Study.parse(STRUCTURE + ONE_CONTACT + bad + ONE_FORCE + ANALYSIS)


def test_two_contacts_of_one_name_are_refused():
    named = ONE_CONTACT + 'name = "damper"\n'
    with pytest.raises(ModelError, match="contact 2: name = 'damper' is that of contact 1 too"):
        Study.parse(STRUCTURE + named + named + ONE_FORCE + ANALYSIS)


def test_further_findings_are_counted():
    text = SMALL.replace("amplitude = 1", 'amplitude = "1 m"').replace("slip_force = 2", "")
    with pytest.raises(ModelError, match=r"contact 1: 'slip_force' is missing \(and 1 more\)"):
        Study.parse(text)


def test_toml_errors_name_the_line():
    with pytest.raises(ModelError, match=r"not valid TOML: .*line 4"):
        Study.parse("[structure]\nmass = [[1]]\nstiffness = [[1\n[analysis]")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("stuy.toml", None, r"stuy.toml: no such study file; did you mean 'study.toml'\?"),
        ("no/study.toml", None, "no such study file; there is no folder .*no either"),
        (".", None, "is a folder; name the study file in it"),
        ("bytes.toml", b"\xff\xfe", "is not text in UTF-8"),
        ("empty.toml", b"", r"empty.toml: \[structure\] is missing"),
    ],
)
def test_a_study_file_that_cannot_be_read_is_named(name, content, message, tmp_path):
    (tmp_path / "study.toml").write_text(SMALL)
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(ModelError, match=message):
        Study.load(tmp_path / name)


def test_matrix_files_are_relative_to_the_study_and_named_when_missing_or_damaged(tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "beam")
    mass = tmp_path / "beam" / "mass.mtx"
    mass.rename(mass.with_name("masses.mtx"))
    with pytest.raises(ModelError, match=r"structure: mass = 'mass.mtx': .* mean 'masses.mtx'\?"):
        Study.load(tmp_path / "beam" / "study.toml")
    mass.write_text("%%MatrixMarket matrix array real symmetric\nthree\n")
    with pytest.raises(ModelError, match=r"study.toml: structure: .*mass.mtx: cannot be read"):
        Study.load(tmp_path / "beam" / "study.toml")


def test_the_schema_describes_every_entry_for_editors():
    schema = json_schema()
    assert schema["title"] == "stickslip study"
    assert set(schema["required"]) == {"structure", "analysis"}
    tables = [schema, *schema["$defs"].values()]
    for table in tables:
        assert table["additionalProperties"] is False
        assert table["description"]
        for name, entry in table["properties"].items():
            assert "title" in entry or "$ref" in entry, name
            assert "description" in entry or "$ref" in entry, name
    assert schema["$defs"]["ForceTable"]["properties"]["amplitude"]["type"] == ["number", "string"]
    assert {"from", "to"} <= set(schema["$defs"]["OmegaRange"]["properties"])

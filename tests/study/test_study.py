import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from small_study import ANALYSIS, ONE_CONTACT, ONE_FORCE, SMALL, STRUCTURE
from stickslip import ModelError, reference
from stickslip.study import Study, json_schema

EXAMPLE = Path(__file__).parents[2] / "examples" / "snecma-beam"


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
    omega = Study.parse(text).tables.analysis.omega
    assert type(omega) is type(expected)
    assert omega == pytest.approx(expected)


@pytest.mark.slow
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
    with pytest.raises(ModelError, match=r"contact 1: 'slip_force' is missing;.*\(and 1 more\)"):
        Study.parse(text)


@pytest.mark.parametrize("unit", ["um", "\u00b5m", "\u03bcm"])
def test_micrometres_may_be_written_with_the_greek_letter(unit):
    study = Study.parse(SMALL + f'[output]\nlength_unit = "{unit}"')
    assert study.tables.output.length_unit == "um"


def test_only_a_near_file_name_is_suggested(tmp_path):
    (tmp_path / "damping.mtx").touch()
    with pytest.raises(ModelError, match=r"no such file in [^;]*$"):
        Study.parse(SMALL.replace("[[2, 0.5], [0.5, 1]]", '"mass.mtx"'), folder=tmp_path)


@pytest.mark.parametrize("path", [None, 3, math.nan, "", "a\0b"])
def test_what_is_no_path_is_refused(path):
    with pytest.raises(ModelError, match=r"^study file: .* (not a path|no file name); give"):
        Study.load(path)


def test_toml_errors_name_the_line():
    with pytest.raises(ModelError, match=r"not valid TOML: .*line 4"):
        Study.parse("[structure]\nmass = [[1]]\nstiffness = [[1\n[analysis]")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("stuy.toml", None, r"stuy.toml: no such study file; did you mean 'study.toml'\?"),
        ("no/study.toml", None, "no such study file; there is no folder .*no either"),
        (".", None, "is a folder; give the name of a file in it"),
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


@pytest.mark.parametrize("slip_force", ["1e400", "-1e400", "1e-400", "-0.1E-999"])
def test_numbers_that_no_float_holds_are_refused(slip_force):
    text = SMALL.replace("slip_force = 2", f"slip_force = {slip_force}")
    with pytest.raises(ModelError, match=f"'{slip_force}' is too (small|large) for a number"):
        Study.parse(text)
    Study.parse(SMALL.replace("slip_force = 2", "slip_force = inf"))
    Study.parse(SMALL.replace("slip_force = 2", "slip_force = 0e-400"))
    assert Study.parse(SMALL.replace("slip_force = 2", "slip_force = 2_0")).model.contacts


def test_harmonics_of_engine_orders_are_plain_digits():
    disk = "[disk]\nsectors = 6\nengine_order = 1\nengine_orders = {%s = 2}\n"
    Study.parse(SMALL + disk % "3")
    for key in ('"1_0"', '"\u0663"', '"+3"'):
        with pytest.raises(ModelError, match=r"is no harmonic; write \{3 = 6\}"):
            Study.parse(SMALL + disk % key)


@pytest.mark.parametrize("damping", ['"1_0"', '"3"', "inf", "nan", "-1", "true"])
def test_damping_of_couplings_is_a_number(damping):
    text = SMALL + "[disk]\nsectors = 6\nengine_order = 1\n[[coupling]]\ndof = 'tip'\n"
    Study.parse(text + "stiffness = 1\ndamping = 3")
    with pytest.raises(ModelError, match="coupling 1: damping"):
        Study.parse(text + f"stiffness = 1\ndamping = {damping}")


@pytest.mark.parametrize("name", ["nul", "AUX", "con.beam", "Lpt1", "com\u00b2", "prn "])
def test_names_of_devices_are_refused(name, tmp_path):
    with pytest.raises(ModelError, match="is that of a device on Windows; give the study another"):
        Study.parse(f'name = "{name}"\n' + SMALL)
    (tmp_path / f"{name}.toml").write_text(SMALL)
    with pytest.raises(ModelError, match="is that of a device on Windows; give the study another"):
        Study.load(tmp_path / f"{name}.toml")
    for sound in ("null", "console", "beam.nul", "com", "com10"):
        assert Study.parse(f'name = "{sound}"\n' + SMALL).name == sound


def test_a_name_too_long_for_its_results_is_refused_before_they_are_computed(tmp_path):
    with pytest.raises(ModelError, match="more than 150 bytes, too long for the names of result"):
        Study.parse(f'name = "{"n" * 151}"\n' + SMALL)
    (tmp_path / ("\u00fc" * 80 + ".toml")).write_text(SMALL)
    with pytest.raises(ModelError, match="more than 150 bytes"):
        Study.load(tmp_path / ("\u00fc" * 80 + ".toml"))
    assert Study.parse(f'name = "{"n" * 150}"\n' + SMALL).name == "n" * 150


@pytest.mark.parametrize("part", ["[", "{a = ", ".x", " . 'x'"])
def test_what_nests_too_deep_is_refused(part):
    start = "x" if "." in part else "x = "
    with pytest.raises(ModelError, match="nest too deep"):
        Study.parse(start + part * 10**5 + " = 1\n" + SMALL)


@pytest.mark.slow
def test_thousands_of_contacts_are_named_at_once():
    contact = '[[contact]]\nlaw = "jenkins"\ndof = "tip"\nstiffness = 1\nslip_force = 1\n'
    names = Study.parse(SMALL + 3000 * contact).model.contact_names
    assert names[:3] == ("jenkins", "jenkins-2", "jenkins-3")
    assert len(set(names)) == 3001


def test_matrix_files_are_relative_to_the_study_and_named_when_missing_or_damaged(tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "beam")
    mass = tmp_path / "beam" / "mass.mtx"
    mass.rename(mass.with_name("masses.mtx"))
    with pytest.raises(ModelError, match=r"structure: mass = 'mass.mtx': .* mean 'masses.mtx'\?"):
        Study.load(tmp_path / "beam" / "study.toml")
    mass.write_text("%%MatrixMarket matrix array real symmetric\nthree\n")
    with pytest.raises(
        ModelError, match=r"study.toml: structure: mass: .*mass.mtx: cannot be read"
    ):
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

"""The tables [disk] and [[coupling]] of study files."""

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from small_study import ANALYSIS, ONE_CONTACT, ONE_FORCE, SMALL, STRUCTURE
from stickslip.cli import app
from stickslip.disk import BladedDisk, MistunedDisk
from stickslip.study import Study, json_schema

DISK = """
[disk]
sectors = 6
engine_order = 2
"""
COUPLING = """
[[coupling]]
dof = "tip"
stiffness = "20 N/m"
"""
TUNED = STRUCTURE + DISK + COUPLING + ONE_CONTACT + ONE_FORCE + ANALYSIS


def test_a_tuned_disk():
    study = Study.parse(TUNED)
    disk = study.model
    assert isinstance(disk, BladedDisk)
    assert (disk.sectors, disk.engine_order) == (6, 2)
    assert disk.couplings == (ss.Coupling("tip", stiffness=20.0),)
    assert study.dofs == ("tip", "root")
    (result,) = study.run()
    assert result.sector(1).converged.all()


def test_a_spring_between_two_dofs_of_a_structure():
    spring = COUPLING.replace('dof = "tip"', 'dof = "tip"\nother = "root"')
    bare, coupled = (Study.parse(SMALL + more).model.structure for more in ("", spring))
    tip, root = (bare.index(dof) for dof in ("tip", "root"))
    expected = bare.stiffness.copy()
    expected[np.ix_([tip, root], [tip, root])] += 20.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_array_equal(coupled.stiffness, expected)
    np.testing.assert_array_equal(coupled.damping, bare.damping)


def test_a_contact_to_the_next_sector_and_levels():
    between = ONE_CONTACT.replace('dof = "root"', 'dofs = ["tip", "next.root"]')
    text = TUNED.replace(ONE_CONTACT, between) + "levels = [1, 2]\n"
    study = Study.parse(text)
    assert study.model.contacts[0].dofs == ("tip", "next.root")
    first, second = study.run()
    assert isinstance(second.model, BladedDisk)
    assert second.model.forces[0].amplitude == 2.0 * first.model.forces[0].amplitude


def test_random_and_given_mistuning():
    table = 'mistuning = { deviation = "5 %", distribution = "uniform", seed = 3 }\n'
    disk = Study.parse(TUNED.replace(DISK, DISK + table)).model
    assert isinstance(disk, MistunedDisk)
    expected = disk.disk.mistuned(ss.mistuning_pattern(6, 0.05, "uniform", seed=3))
    assert np.array_equal(disk.structure.stiffness, expected.structure.stiffness)
    table = 'mistuning = { pattern = ["1 %", 0, 0, -0.02, 0, 0] }\n'
    given = Study.parse(TUNED.replace(DISK, DISK + table) + 'observe = ["3.tip"]\n')
    expected = given.model.disk.mistuned([0.01, 0, 0, -0.02, 0, 0])
    assert np.array_equal(given.model.structure.stiffness, expected.structure.stiffness)
    (result,) = given.run()
    assert result.dofs == ("3.tip",)


def test_measured_frequencies_make_the_mistuning():
    table = 'mistuning = { frequency = ["1 %", 0, 0, -0.02, 0, 0] }\n'
    disk = Study.parse(TUNED.replace(DISK, DISK + table)).model
    expected = disk.disk.mistuned([0.0201, 0, 0, -0.0396, 0, 0])
    assert np.allclose(disk.structure.stiffness, expected.structure.stiffness, rtol=1e-14)
    both = TUNED.replace(DISK, DISK + "mistuning = { deviation = 0.1, frequency = [0.1] }\n")
    with pytest.raises(ss.ModelError, match="or 'frequency', those of blade frequencies"):
        Study.parse(both)
    far = TUNED.replace(DISK, DISK + "mistuning = { frequency = [0, 0, 2, 0, 0, 0] }\n")
    with pytest.raises(ss.ModelError, match=r"disk: mistuning.frequency\[2\] is 2; give"):
        assert Study.parse(far).model


def test_interface_blocks_and_boundaries():
    block = "stiffness = [[0, 0], [-5, 0]], damping = { rayleigh = { stiffness = 1e-3 } }"
    disk = Study.parse(TUNED.replace(DISK, f"{DISK}interface = {{ {block} }}\n")).model
    assert disk.matrices.stiffness.next[1, 0] == -5.0
    assert disk.matrices.damping.next[1, 0] == pytest.approx(-5e-3)
    joined = TUNED.replace(DISK, DISK + 'boundary = { root = "tip" }\n')
    joined = joined.replace('dof = "root"', 'dof = "tip"')
    disk = Study.parse(joined).model
    assert disk.structure.dofs == ("tip",)
    assert disk.matrices.stiffness.own[0, 0] == 800 + 200 + 40


def test_engine_orders_of_harmonics():
    table = "engine_orders = { 3 = 6 }\n"
    disk = Study.parse(TUNED.replace(DISK, DISK + table)).model
    assert dict(disk.engine_orders) == {3: 6}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (SMALL + COUPLING, "coupling 1: there are no sectors to couple; add the table"),
        (
            SMALL + COUPLING.replace('dof = "tip"', 'dof = "tip"\nother = "tip"'),
            "coupling 1: both ends at dof 'tip'; name the 'other' end",
        ),
        (
            SMALL + COUPLING.replace('dof = "tip"', 'dof = "tip"\nother = "tp"'),
            "coupling 1: unknown dof 'tp'",
        ),
        (
            TUNED.replace("sectors = 6", "sector = 6"),
            "disk: unknown key 'sector'; did you mean 'sectors'",
        ),
        (TUNED.replace("sectors = 6\n", ""), "disk: 'sectors' is missing"),
        (TUNED.replace("sectors = 6", "sectors = 1"), "disk: sectors: 1 lies below 2"),
        (
            TUNED.replace('[[coupling]]\ndof = "tip"', '[[coupling]]\ndof = "tpi"'),
            "disk: coupling 1: unknown dof 'tpi'; did you mean 'tip'",
        ),
        (
            TUNED.replace('dof = "root"', 'dofs = ["root", "next.tpi"]'),
            "contact 1: unknown dof 'next.tpi'; did you mean 'next.tip'",
        ),
        (TUNED.replace('"20 N/m"', '"20 N"'), "coupling 1: stiffness"),
        (TUNED.replace('"20 N/m"', "-3"), "coupling 1: stiffness = -3 must not be negative"),
        (
            TUNED.replace(DISK, DISK + "mistuning = {}\n"),
            "disk: mistuning: give either 'pattern'",
        ),
        (
            TUNED.replace(DISK, DISK + "mistuning = { pattern = [0.1] }\n"),
            r"disk: pattern: shape \(1,\) for 6 sectors",
        ),
        (
            TUNED.replace(DISK, DISK + 'mistuning = { deviation = 0.1, distribution = "x" }\n'),
            "disk: mistuning.distribution: unknown choice 'x'",
        ),
        (
            TUNED.replace(DISK, DISK + "engine_orders = { third = 6 }\n"),
            "disk: engine_orders: 'third' is no harmonic",
        ),
        (
            TUNED.replace(
                DISK, DISK + "interface = { stiffness = [[1]], damping = { modal = 1 } }\n"
            ),
            "disk: interface: damping: modes belong to the whole disk",
        ),
        (
            TUNED.replace(
                DISK,
                DISK + 'interface = { stiffness = [[1]] }\nboundary = { tip = "root" }\n',
            ),
            "disk: give either 'interface', the blocks, or 'boundary'",
        ),
        ("disk = 3\n" + SMALL, r"disk = 3 is not written as a table; begin it with \[disk\]"),
        (
            TUNED.replace("[[coupling]]", "[coupling]"),
            r"coupling = .* is not written as a table; begin it with \[\[coupling\]\]",
        ),
        (
            TUNED.replace(ANALYSIS, "[analysis]\nkind = 'transient'\nomega = 20\n"),
            "travelling wave",
        ),
    ],
)
def test_bad_disk_tables_are_refused_in_one_line(text, message):
    with pytest.raises(ss.ModelError, match=message) as refusal:
        list(Study.parse(text).run())
    assert "\n" not in str(refusal.value)


@pytest.mark.slow
def test_the_command_line_runs_shows_and_plots_disks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    table = 'mistuning = { deviation = "5 %" }\n'
    (tmp_path / "tuned.toml").write_text(TUNED)
    (tmp_path / "ring.toml").write_text(TUNED.replace(DISK, DISK + table))
    for name, fact in (("tuned", "6 equal sectors"), ("ring", "6 sectors of their own")):
        for words in (f"run {name}.toml", f"plot results/{name}.nc", f"show results/{name}.nc"):
            outcome = CliRunner().invoke(app, words.split())
            assert outcome.exit_code == 0, outcome.output
        assert fact in outcome.output
        assert "engine order 2" in outcome.output
        assert (tmp_path / "results" / f"{name}.png").is_file()


def test_the_schema_knows_the_disk():
    schema = json_schema()
    assert "disk" in schema["properties"]
    assert "MistuningTable" in schema["$defs"]


@pytest.mark.parametrize(
    ("contacts", "keys", "said"),
    [
        (ONE_CONTACT, 'decrement = ["1 %"]', "give all of 0 to 5, or influence instead"),
        ("", f"damping_ratio = {6 * [-0.01]}", "give amplitude = {from = ..., to = ...}"),
    ],
)
def test_remedies_are_those_of_study_files(contacts, keys, said):
    flutter = f'\n[analysis]\nkind = "flutter-map"\n{keys}\n'
    study = Study.parse(STRUCTURE + DISK + COUPLING + contacts + flutter)
    with pytest.raises(ss.ModelError) as refused:
        list(study.run())
    assert said in str(refused.value)


def test_bounds_of_an_optimum_are_written_as_in_study_files():
    pad = ss.Coulomb(["a"], normal=None, friction=0.3, tangential_stiffness=1e3, preload=5.0)
    body = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.01), ["a"])
    model = ss.Model(body, [pad], [ss.Force("a", 1.0)])
    with pytest.raises(ss.ModelError, match=r"give bounds=\(lowest") as refused:
        ss.optimal_damper(model, dof="a", parameter="friction")
    assert refused.value.study.endswith("give bounds = [lowest, highest]")

"""Responses along the speed of rotation, from study files."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

import stickslip as ss
from stickslip.cli import app
from stickslip.study import Study
from stickslip.views.kinds import failures, view_of

BLADE = """
[structure]
mass = [[2.0, 0.0], [0.0, 1.0]]
stiffness = [[3.0e4, -1.0e4], [-1.0e4, 1.0e4]]
damping = [[3.0, 0.0], [0.0, 2.0]]
stiffening = [[0.0, 0.0], [0.0, 0.5]]
dofs = ["root", "tip"]

[[force]]
dof = "tip"
amplitude = "3 N"

[analysis]
kind = "speed-response"
dof = "tip"
harmonics = 1
speed = { from = "300 rpm", to = "600 rpm", points = 16 }
"""
ORDER = "engine_order = 2\n"

DISK = """
[disk]
sectors = 12
engine_order = 3

[[coupling]]
dof = "root"
stiffness = "2 kN/m"

[[contact]]
law = "jenkins"
dofs = ["tip", "next.tip"]
stiffness = "3 N/mm"
slip_force = "0.4 N"
"""


def test_a_linear_blade_agrees_with_its_receptance(tmp_path):
    (found,) = Study.parse(BLADE + ORDER).run()
    assert isinstance(found, ss.SpeedResponse)
    np.testing.assert_allclose(found.speed, np.linspace(10.0, 20.0, 16) * np.pi)
    np.testing.assert_array_equal(found.omega, 2.0 * found.speed)
    mass, damping = np.diag([2.0, 1.0]), np.diag([3.0, 2.0])
    for speed, omega, amplitude in zip(found.speed, found.omega, found.amplitude, strict=True):
        stiffness = np.array([[3e4, -1e4], [-1e4, 1e4 + 0.5 * speed**2]])
        dynamic = stiffness - omega**2 * mass + 1j * omega * damping
        assert amplitude == pytest.approx(abs(np.linalg.solve(dynamic, [0.0, 3.0])[1]), rel=1e-10)
    found.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc")
    np.testing.assert_array_equal(again.amplitude, found.amplitude)
    assert (again.dof, again.engine_order) == ("tip", 2.0)


def test_the_disk_says_the_order_and_rubs_as_its_response_curve_does():
    study = Study.parse(BLADE.replace("harmonics = 1", "harmonics = 5") + DISK)
    (found,) = study.run()
    assert found.engine_order == 3.0
    structure = study.model.structure
    for place in (0, 9):
        speed = found.speed[place]
        stiffness = structure.stiffness + speed**2 * np.diag([0.0, 0.5])
        disk = ss.BladedDisk(
            ss.Structure(structure.mass, stiffness, structure.damping, structure.dofs),
            12,
            study.model.couplings,
            study.model.contacts,
            study.model.forces,
            engine_order=3,
        )
        own = ss.forced_response(disk, [3.0 * speed], 5, observe=["tip"], tolerance=1e-2)
        assert found.amplitude[place] == pytest.approx(own.amplitude("tip")[0], rel=1e-8)
    assert any("All sectors are equal" in text for text in found.assumptions)


@pytest.mark.slow
def test_its_table_and_picture(tmp_path, monkeypatch):
    (found,) = Study.parse(BLADE + ORDER).run()
    (table,) = view_of([found]).tables([("", found)], "", ["tip"], "m")
    cells = {str(column.header): next(iter(column.cells)) for column in table.columns}
    top = int(found.amplitude.argmax())
    assert float(cells["rotor rpm"]) == pytest.approx(found.speed[top] * 30 / np.pi, rel=1e-5)
    assert float(cells["Hz"]) == pytest.approx(found.omega[top] / (2 * np.pi), rel=1e-5)
    assert float(cells["highest [m]"]) == pytest.approx(found.amplitude.max(), rel=1e-4)
    study = Study.parse(BLADE + ORDER)
    (panel,) = view_of([found, found]).panels([found, found], ["tip"], study.tables.output)
    axes = Figure().add_subplot()
    panel(ax=axes)
    assert axes.get_xlabel() == "rotor speed at engine order 2 [rpm]"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "blade.toml").write_text(BLADE + ORDER, encoding="utf-8")
    done = CliRunner().invoke(app, ["run", "blade.toml"])
    assert done.exit_code == 0, done.output
    shown = CliRunner().invoke(app, ["show", "results/blade.nc"])
    assert "16 from 300 to 600 rpm" in shown.stdout
    assert (tmp_path / "results" / "blade.png").stat().st_size > 5000


@pytest.mark.parametrize(("unit", "turns"), [("rad/s", 1.0), ("Hz", 0.5 / np.pi)])
def test_the_axis_of_speeds_is_in_the_unit_that_is_asked_for(unit, turns):
    (found,) = Study.parse(BLADE + ORDER).run()
    output = Study.parse(BLADE + ORDER + f'[output]\nomega_unit = "{unit}"').tables.output
    (panel,) = view_of([found]).panels([found], ["tip"], output)
    axes = Figure().add_subplot()
    panel(ax=axes)
    assert axes.get_xlabel() == f"rotor speed at engine order 2 [{unit}]"
    np.testing.assert_allclose(axes.lines[0].get_xdata(), turns * found.speed)
    (above,) = axes.child_axes
    axes.figure.draw_without_rendering()
    np.testing.assert_allclose(above.get_xlim(), found.omega[[0, -1]] / (2 * np.pi))


def test_speeds_without_a_solution_are_told():
    (found,) = Study.parse(BLADE + ORDER).run()
    amplitude = np.array(found.amplitude)
    amplitude[[3, 4]] = np.nan
    arrays = type(found.arrays)(
        speed=found.speed,
        omega=found.omega,
        amplitude=amplitude,
        error_estimate=found.error_estimate,
    )
    (text,) = failures(replace(found, arrays=arrays))
    assert text.startswith("2 of 16 speeds not solved, between 360 and 380 rpm.")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (BLADE, "engine_order: missing, and no .disk. says it"),
        (BLADE + ORDER + DISK, "engine_order: 2, but the forces on the disk have 3"),
        (BLADE.replace('"300 rpm"', '"0 rpm"') + ORDER, "give numbers above zero"),
        (BLADE.replace(", points = 16", "") + ORDER, "speed: a range needs 'points'"),
        (BLADE.replace('dof = "tip"\nh', 'dof = "tap"\nh') + ORDER, "did you mean 'tip'"),
        (BLADE + ORDER + "[sweep]\nlevel = [1, 2]", "sweep: a speed-response makes the model anew"),
    ],
)
def test_refusals(text, message):
    with pytest.raises(ss.ModelError, match=message):
        list(Study.parse(text).run())

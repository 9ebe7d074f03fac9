"""Study files with dampers as bodies."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.study import Study
from wedges import WEDGE

EXAMPLE = Path(__file__).parents[2] / "examples" / "wedge-damper" / "study.toml"
SECTOR = """
[structure]
mass = [[1, 0], [0, 1]]
stiffness = [[4e4, 0], [0, 2e5]]
dofs = ["x", "y"]

[disk]
sectors = 8
engine_order = 2

[[damper]]
kind = "wedge"
angle = ["40 deg", "20 deg"]
mass = 0.05
friction = [0.2, 0.3]
tangential_stiffness = 5e4
normal_stiffness = 5e4
load = { radius = "0.4 m", speed = "500 rad/s" }
left_dofs = ["x", "y"]
right_dofs = ["x", "y"]

[[force]]
dof = "x"
amplitude = 1

[analysis]
omega = [200]
"""


def test_example_is_the_wedge_between_two_blades():
    model = Study.load(EXAMPLE).model
    wedge = replace(WEDGE, angle=60.0, friction=0.2)
    blades = (
        ss.Structure(10.0 * np.eye(2), stiffness, 100.0 * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    between = wedge.between(*blades, left_dofs=["x", "y"], right_dofs=["x", "y"])
    assert model.structure.dofs == between.structure.dofs
    np.testing.assert_array_equal(model.structure.mass, between.structure.mass)
    for one, other in zip(model.contacts, between.contacts, strict=True):
        assert (one.name, one.dofs) == (other.name, other.dofs)
        np.testing.assert_allclose(one.frame, other.frame, atol=1e-15)
    assert model.forces[:1] == between.forces


def test_disk_with_a_damper_behind_every_blade():
    disk = Study.parse(SECTOR).model
    wedge = ss.WedgeDamper(
        angle=(40.0, 20.0),
        mass=0.05,
        friction=(0.2, 0.3),
        tangential_stiffness=5e4,
        normal_stiffness=5e4,
        load=ss.Centrifugal(radius=0.4, speed=500.0),
    )
    blade = ss.Structure(np.eye(2), np.diag([4e4, 2e5]), dofs=["x", "y"])
    ends = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    expected = wedge.in_disk(blade, 8, engine_order=2, **ends)
    for one, other in zip(disk.contacts, expected.contacts, strict=True):
        np.testing.assert_allclose(
            one.rows(disk.neighbours), other.rows(expected.neighbours), atol=1e-14
        )
    assert disk.forces[0] == expected.forces[0]


def test_two_dampers_have_names_of_their_own():
    second = SECTOR.split("[[damper]]")[1].split("[[force]]")[0]
    text = SECTOR.replace("[[force]]", f"[[damper]]{second}\n[[force]]")
    disk = Study.parse(text).model
    assert disk.structure.dofs[2:] == ("damper.x", "damper.y", "damper-2.x", "damper-2.y")
    assert disk.contact_names == ("left", "right", "damper-2.left", "damper-2.right")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('kind = "wedge"', 'kind = "wegde"', "damper 1: .*did you mean 'wedge'"),
        ('"40 deg"', '"140 deg"', "damper 1: WedgeDamper: angle 140"),
        ('"40 deg"', "40", "angle 2291.83 deg; .* as '30 deg': a number alone is in rad"),
        ('right_dofs = ["x", "y"]', 'right_dofs = ["x", "z"]', "right_dofs: unknown dof 'z'"),
        ("mass = 0.05\n", "", "damper 1: 'mass' is missing"),
        ('radius = "0.4 m"', 'radius = "0.4 N"', "damper 1"),
    ],
)
def test_refused(old, new, message):
    with pytest.raises(ss.ModelError, match=message):
        Study.parse(SECTOR.replace(old, new))


def test_axes_are_those_of_the_sectors_of_a_disk():
    lines = EXAMPLE.read_text().replace('kind = "wedge"', 'kind = "wedge"\naxes = "parallel"')
    with pytest.raises(ss.ModelError, match="damper 1: axes = 'parallel' says how the sectors of"):
        Study.parse(lines)

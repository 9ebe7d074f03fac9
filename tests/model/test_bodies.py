"""Dampers as bodies: what is built of them, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

import stickslip as ss
from wedges import ENDS, WEDGE

SIDES = {"friction": 0.3, "tangential_stiffness": 2e5, "normal_stiffness": 3e5, "load": 50.0}
TURNING = [(-0.012, 0.002), (-0.008, 0.006)]


def blade(stiffness=((1e6, -9e5), (-9e5, 1e6)), mass=10.0):
    return ss.Structure(mass * np.eye(2), np.array(stiffness), 20.0 * np.eye(2), ["x", "y"])


def rows(model):
    return np.vstack([contact.rows(model.structure) for contact in model.contacts])


def test_published_wedge_is_built_as_it_was_printed():
    """Balaji, Ferhatoglu (2025), B40, whose damper has a spring between xD and yD besides."""
    model = WEDGE.between(blade(), blade([[4e5, -3e5], [-3e5, 4e5]]), **ENDS)
    K = np.zeros((6, 6))
    K[:2, :2], K[2:4, 2:4] = [[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]]
    structure = model.structure
    np.testing.assert_array_equal(structure.mass, np.diag([10.0] * 4 + [0.1] * 2))
    np.testing.assert_array_equal(structure.damping, np.diag([20.0] * 4 + [0.0] * 2))
    np.testing.assert_array_equal(structure.stiffness, K)
    c, s = np.cos(np.deg2rad(40.0)), np.sin(np.deg2rad(40.0))
    printed = np.array(
        [
            [-c, -s, 0.0, 0.0, c, s],
            [s, -c, 0.0, 0.0, -s, c],
            [0.0, 0.0, -c, s, c, -s],
            [0.0, 0.0, -s, -c, s, c],
        ]
    )
    np.testing.assert_array_equal(rows(model), printed)
    assert model.forces == (ss.Force("damper.y", 240.0, harmonic=0),)
    K[4:, 4:] = [[1e6, -1e6], [-1e6, 1e6]]
    sprung = ss.Structure(structure.mass, K, structure.damping, structure.dofs)
    stuck = ss.natural_frequencies(model.with_structure(sprung))
    # Mode 3 of the published system, of a quasi-linear branch without slip.
    assert stuck[2] / (2.0 * np.pi) == pytest.approx(49.421406, abs=1e-6)


def solid():
    points = [ss.ContactPoint((0.3, -0.5, 0.8), (0.02, 0.01, -0.03))]
    body = ss.RigidBody(0.2, np.diag([1e-5, 2e-5, 3e-5]), load=(1.0, 2.0, 3.0))
    values = {"friction": 0.3, "tangential_stiffness": 1e5, "normal_stiffness": 2e5}
    other = [ss.ContactPoint((0.0, 1.0, 0.0), (0.0, 0.02, 0.0))]
    return ss.BodyDamper(
        body,
        [ss.Face(points=points, to="left", **values), ss.Face(points=other, to="right", **values)],
    )


def elastic():
    """A bar of three points along x that bends in y, free."""
    dofs = ["a.x", "a.y", "m.y", "b.x", "b.y"]
    spring = np.zeros((5, 5))
    bend, stretch = np.array([0, 1.0, -2.0, 0, 1.0]), np.array([1.0, 0, 0, -1.0, 0])
    spring += 1e6 * np.outer(bend, bend) + 1e7 * np.outer(stretch, stretch)
    bar = ss.Structure(0.02 * np.eye(5), spring, dofs=dofs)
    values = {"friction": 0.3, "tangential_stiffness": 1e5, "normal_stiffness": 2e5}
    faces = [
        ss.Face(
            points=[ss.ContactPoint((0.0, 1.0), dofs=[f"{end}.x", f"{end}.y"])], to=to, **values
        )
        for end, to in (("a", "left"), ("b", "right"))
    ]
    return ss.BodyDamper(ss.FlexibleBody(bar, {"m.y": 30.0}), faces)


DAMPERS = {
    "wedge": WEDGE,
    "roof": replace(WEDGE, angle=(40.0, 15.0), friction=(0.2, 0.4)),
    "turning": replace(WEDGE, inertia=2e-5, positions=TURNING),
    "cylinder": ss.CylinderDamper(angle=45.0, mass=0.03, cylinder_radius=0.005, **SIDES),
    "split": ss.SplitDamper(angle=30.0, mass=0.06, **SIDES),
    "strip": ss.StripDamper(mass=0.01, gap=(0.0, 1e-4), **SIDES),
    "flexible": elastic(),
}


@pytest.mark.parametrize("name", DAMPERS)
@pytest.mark.parametrize("translation", [(1.0, 0.0), (0.0, 1.0)])
def test_what_moves_together_feels_no_contact(name, translation):
    model = DAMPERS[name].between(blade(), blade(), **ENDS)
    axes = dict(zip("xy", translation, strict=True))
    moved = np.array([axes.get(dof.split(".")[-1], 0.0) for dof in model.structure.dofs])
    np.testing.assert_allclose(rows(model) @ moved, 0.0, atol=1e-15)


@given(st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
@pytest.mark.slow
def test_turning_together_feels_no_contact(angle, x, y):
    """Neighbours that turn with the body about any point."""
    damper = replace(WEDGE, inertia=2e-5, positions=TURNING)
    platform = ss.Structure(np.eye(3), np.zeros((3, 3)), dofs=["x", "y", "rotation"])
    centre = np.array([x, y])
    sides = {}
    for side, face in zip(("left_dofs", "right_dofs"), damper.faces, strict=True):
        # The body's centre of mass is at the origin, that of the neighbour at `centre`.
        arms = [np.array(point.position) - centre for point in face.points]
        sides[side] = [
            [{"x": 1.0, "rotation": -arm[1]}, {"y": 1.0, "rotation": arm[0]}] for arm in arms
        ]
    model = damper.between(platform, platform, **sides)
    # A rotation about the origin by `angle`: the centres of the neighbours move with it.
    neighbour = [-angle * y, angle * x, angle]
    moved = np.array([*neighbour, *neighbour, 0.0, 0.0, angle])
    np.testing.assert_allclose(rows(model) @ moved, 0.0, atol=1e-14)


def test_bodies_in_space_turn_about_three_axes():
    damper = solid()
    model = damper.between(None, None)
    theta, shift = np.array([0.3, -0.2, 0.5]), np.array([1.0, 2.0, 3.0])
    moved = np.concatenate([shift, theta])
    for face, contact in zip(damper.faces, model.contacts, strict=True):
        expected = shift + np.cross(theta, face.points[0].position)
        np.testing.assert_allclose(
            contact.rows(model.structure) @ moved, contact.frame @ expected, atol=1e-14
        )
    assert [force.amplitude for force in model.forces] == [1.0, 2.0, 3.0]
    np.testing.assert_array_equal(np.diag(model.structure.mass), [0.2] * 3 + [1e-5, 2e-5, 3e-5])


def test_disk_that_turns_as_a_whole_feels_no_contact():
    """Sectors with axes of their own: x along the circumference, y outwards."""
    disk = WEDGE.in_disk(blade(), 12, engine_order=1, **ENDS)
    half = np.pi / 12
    turned = {
        # The contact nodes lie halfway to the neighbour, where they move along the damper's x.
        "x": np.cos(half),
        "y": -np.sin(half),
        "next.x": np.cos(half),
        "next.y": np.sin(half),
        "damper.x": 1.0,
    }
    moved = np.array([turned.get(dof, 0.0) for dof in disk.neighbours.dofs])
    for contact in disk.contacts:
        np.testing.assert_allclose(contact.rows(disk.neighbours) @ moved, 0.0, atol=1e-15)
    parallel = WEDGE.in_disk(blade(), 12, engine_order=1, axes="parallel", **ENDS)
    between = WEDGE.between(blade(), blade(), **ENDS)
    for one, other in zip(parallel.contacts, between.contacts, strict=True):
        np.testing.assert_array_equal(one.frame, other.frame)
    assert parallel.contacts[1].dofs == ("damper.x", "damper.y", "next.x", "next.y")


def test_split_damper_has_two_bodies():
    model = DAMPERS["split"].between(blade(), blade(), **ENDS)
    assert model.contact_names == ("left", "right", "split")
    assert {force.dof: force.amplitude for force in model.forces} == {
        "damper.left.y": 25.0,
        "damper.right.y": 25.0,
    }
    at_rest = ss.static_response(DAMPERS["split"].between(None, None))
    # The blades press the halves together.
    assert at_rest.contact_force("split")[1] > 0.0


def test_centrifugal_load():
    spun = replace(WEDGE, load=ss.Centrifugal(radius=0.4, speed=500.0))
    assert spun.force == pytest.approx(0.1 * 0.4 * 500.0**2, rel=1e-15)
    assert replace(spun, mass=0.2).force == 2.0 * spun.force


def test_points_share_the_stiffness_of_a_face():
    one, two = WEDGE, DAMPERS["turning"]
    whole, parts = (
        model.contacts[0] for model in (d.between(blade(), blade(), **ENDS) for d in (one, two))
    )
    assert parts.points == 2
    assert whole.tangential_stiffness == 2.0 * parts.tangential_stiffness
    mirrored = two.faces[1].points
    assert [point.position for point in mirrored] == [(0.012, 0.002), (0.008, 0.006)]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"angle": 90.0}, "angle 90; give degrees from 0 to below 90"),
        ({"angle": (10.0, 20.0, 30.0)}, "angle: 3 numbers"),
        ({"mass": -1.0}, "mass -1 is negative"),
        ({"friction": np.nan}, "friction: nan is not a finite number"),
        ({"inertia": 1e-5}, "give inertia and positions together"),
        ({"positions": TURNING}, "give inertia and positions together"),
        ({"inertia": 1e-5, "positions": [(0.1,)]}, "is no point"),
        ({"inertia": 1e-5, "positions": []}, "a face without points"),
        ({"load": "120 kg"}, "load = '120 kg' is not a force"),
    ],
)
def test_refused_numbers(changes, message):
    with pytest.raises(ss.ModelError, match=message):
        replace(WEDGE, **changes)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"left_dofs": ["x"]}, "left_dofs: 1 displacements for a damper of 2 axes"),
        ({"left_dofs": ["x", "z"]}, "left_dofs: unknown dof 'z'"),
        ({"right_dofs": None}, "right_dofs: missing"),
        ({"right_dofs": [["x", "y"]] * 3}, "right_dofs: 3 nodes for a face of 1 points"),
        ({"right": None}, "right_dofs: given without a structure"),
        ({"left": 3}, "left: 3 is no Structure"),
    ],
)
def test_refused_neighbours(arguments, message):
    given = {"left": blade(), "right": blade()} | ENDS | arguments
    with pytest.raises(ss.ModelError, match=message):
        WEDGE.between(**given)


def test_refused_bodies():
    values = {"friction": 0.3, "tangential_stiffness": 1e5, "normal_stiffness": 2e5}
    body = ss.RigidBody(0.1, load=(0.0, 1.0))

    def damper(point, to="left", of=body):
        return ss.BodyDamper(of, [ss.Face(points=[point], to=to, **values)]).between(None, None)

    with pytest.raises(ss.ModelError, match="a body that does not turn has no use for positions"):
        damper(ss.ContactPoint((0.0, 1.0), (0.1, 0.0)))
    with pytest.raises(ss.ModelError, match="face 1: unknown body 'up'"):
        damper(ss.ContactPoint((0.0, 1.0)), to="up")
    with pytest.raises(ss.ModelError, match="a rigid body of 2 axes"):
        damper(ss.ContactPoint((0.0, 1.0, 0.0)))
    bar = ss.FlexibleBody(ss.Structure(np.eye(2), np.zeros((2, 2)), dofs=["x", "y"]))
    with pytest.raises(ss.ModelError, match=r"give ContactPoint\(normal, dofs"):
        damper(ss.ContactPoint((0.0, 1.0)), of=bar)
    with pytest.raises(ss.ModelError, match="unknown dof 'z'"):
        damper(ss.ContactPoint((0.0, 1.0), dofs=["x", "z"]), of=bar)
    with pytest.raises(ss.ModelError, match="inertia"):
        ss.RigidBody(1.0, [1.0, 2.0], load=(0.0, 0.0, 1.0))
    with pytest.raises(ss.ModelError, match="a mass of 0 has no centrifugal load"):
        replace(WEDGE, mass=0.0, load=ss.Centrifugal(radius=0.4, speed=900.0))


@pytest.mark.parametrize("name", DAMPERS)
def test_drawings_name_faces_and_loads(name):
    axes = DAMPERS[name].plot(ax=Figure().add_subplot())
    said = " ".join(text.get_text() for text in axes.texts)
    for face in DAMPERS[name].faces:
        assert (face.name or face.to) in said
    assert name == "flexible" or f"{sum(load(DAMPERS[name])):g} N" in said


def load(damper):
    """Return the load of the first body along y."""
    first = next(iter(damper.bodies.values()))
    return [first.forces.get("y", 0.0)]


def test_dampers_in_space_are_not_drawn():
    with pytest.raises(ss.ModelError, match="only those in a plane are drawn"):
        solid().plot(ax=Figure().add_subplot())


def test_degrees_of_freedom_begin_with_the_names_of_the_bodies():
    values = {"friction": 0.3, "tangential_stiffness": 1e5, "normal_stiffness": 2e5}
    up = [ss.ContactPoint((0.0, 1.0))]
    bodies = {"pin": ss.RigidBody(0.1, load=(0.0, 10.0)), "damper2": ss.RigidBody(0.1)}
    faces = [
        ss.Face(points=up, to="left", body="pin", **values),
        ss.Face(points=up, to="pin", body="damper2", **values),
    ]
    damper, blade = (
        ss.BodyDamper(bodies, faces),
        ss.Structure(np.eye(2), np.eye(2), dofs=["x", "y"]),
    )
    alone = damper.inside(blade, left_dofs=["x", "y"])
    assert alone.structure.dofs == ("x", "y", "pin.x", "pin.y", "damper2.x", "damper2.y")
    assert alone.forces == (ss.Force("pin.y", 10.0, harmonic=0),)
    named = damper.built(blade, ["x", "y"], None, "second").structure.dofs[2:]
    assert named == ("second.pin.x", "second.pin.y", "second.damper2.x", "second.damper2.y")

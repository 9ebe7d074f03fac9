"""Elastic dampers in motion: component modes beside all degrees of freedom, stiff and rigid."""

import numpy as np
import pytest

import stickslip as ss

NODES, MASS, SPACING = 7, 0.1, 0.01
VALUES = {"friction": 0.3, "tangential_stiffness": 1e5, "normal_stiffness": 2e5}
BLADE = ss.Structure(np.eye(2), [[6e4, -2e4], [-2e4, 9e4]], 40.0 * np.eye(2), ["x", "y"])
GRID = np.array([250.0, 280.0, 300.0, 330.0])
DAMPING = 1e-4  # s, of the bar's stiffness: free-free modes would ring for ever
LOAD = 300.0  # N


def bar(factor=1.0):
    """Free bar along x with its nodes in a row: mass, stiffness, names."""
    names = [f"{node}.{axis}" for node in range(NODES) for axis in "xy"]
    stiffness = np.zeros((len(names), len(names)))
    for node in range(NODES - 1):
        stretch = np.zeros(len(names))
        stretch[[2 * node, 2 * node + 2]] = 1.0, -1.0
        stiffness += 1e6 * factor * np.outer(stretch, stretch)
    for node in range(NODES - 2):
        bend = np.zeros(len(names))
        bend[[2 * node + 1, 2 * node + 3, 2 * node + 5]] = 1.0, -2.0, 1.0
        stiffness += 2e5 * factor * np.outer(bend, bend)
    return MASS / NODES * np.eye(len(names)), stiffness, names


def between(body, point):
    """The body between two blades that move against one another; two points on either face."""
    faces = [
        ss.Face(points=[point(normal, node) for node in nodes], to=to, **VALUES)
        for to, nodes, normal in (
            ("left", (0, 1), np.deg2rad(150.0)),
            ("right", (NODES - 2, NODES - 1), np.deg2rad(30.0)),
        )
    ]
    sides = {side: [["x", "y"]] * 2 for side in ("left_dofs", "right_dofs")}
    forces = [ss.Force("left.x", 90.0), ss.Force("right.x", 90.0, phase=2.6)]
    return ss.BodyDamper(body, faces).between(BLADE, BLADE, **sides, forces=forces)


def elastic(structure):
    def point(angle, node):
        normal = (np.cos(angle), np.sin(angle))
        return ss.ContactPoint(normal, dofs=[f"{node}.x", f"{node}.y"])

    return between(ss.FlexibleBody(structure, {"3.y": LOAD}), point)


def by_modes(count):
    mass, stiffness, names = bar()
    kept = [f"{node}.{axis}" for node in (0, 1, 5, 6) for axis in "xy"] + ["3.y"]
    reduced = ss.craig_bampton(mass, stiffness, {one: one for one in kept}, modes=count, dofs=names)
    return elastic(reduced.structure(ss.Rayleigh(stiffness=DAMPING)))


def in_full(factor=1.0):
    mass, stiffness, names = bar(factor)
    return elastic(ss.Structure(mass, stiffness, DAMPING * stiffness / factor, names))


def response(model):
    frf = ss.forced_response(model, GRID, 15, observe=["left.x"], stability=False)
    assert frf.converged.all()
    return frf


@pytest.mark.slow
def test_component_modes_move_as_all_degrees_of_freedom():
    """Thirteen of fourteen, the rigid-body modes among them, are as good as all."""
    full = response(in_full())
    assert full.slip_fraction("left").max() > 0.3
    missed = [
        np.abs(response(by_modes(count)).amplitude("left.x") / full.amplitude("left.x") - 1.0).max()
        for count in (1, 4)
    ]
    assert missed[0] < 1e-3
    assert missed[1] < 1e-5


@pytest.mark.slow
def test_time_integration_of_a_flexible_damper():
    """What sticks keeps another traction than the balance assumes where contacts slip."""
    reduced, full = by_modes(4), in_full()
    frf = ss.forced_response(
        reduced, GRID, 15, observe=["left.x"], residual="bounds", stability=False
    )
    assert not frf.slip_fraction("left")[0].any()
    for place, omega in enumerate(GRID):
        amplitude, other = (
            ss.transient(one, omega=omega, periods=300, keep=1, observe=["left.x"]).amplitude(
                "left.x"
            )
            for one in (reduced, full)
        )
        assert amplitude == pytest.approx(other, rel=1e-5)
        assert frf.lower("left.x")[place] * (1.0 - 5e-4) < amplitude
        assert amplitude < frf.upper("left.x")[place] * (1.0 + 5e-4)
        if not place:
            assert amplitude == pytest.approx(frf.amplitude("left.x")[0], rel=1e-6)


@pytest.mark.slow
def test_a_stiff_bar_is_a_rigid_body():
    along = SPACING * (np.arange(NODES) - (NODES - 1) / 2.0)

    def point(angle, node):
        return ss.ContactPoint((np.cos(angle), np.sin(angle)), (along[node], 0.0))

    inertia = MASS / NODES * (along @ along)
    rigid = response(between(ss.RigidBody(MASS, inertia, load=(0.0, LOAD)), point))
    # The load of a rigid body acts at its centre, that of the bar at its middle node.
    missed = [
        np.abs(response(in_full(k)).amplitude("left.x") / rigid.amplitude("left.x") - 1.0).max()
        for k in (1e2, 1e3)
    ]
    assert missed[1] < 1e-3
    assert missed[1] == pytest.approx(0.1 * missed[0], rel=0.3)

"""Structures at rest: with the history of friction, and what Coulomb leaves open."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.results.static_response import StaticResponse
from stickslip.results.status import RestStatus


def wedge(friction: float, load: float = 240.0, angle: float = 40.0) -> ss.Model:
    """Return a wedge between fixed faces, held by its contacts alone."""
    a = np.deg2rad(angle)
    faces = [
        ss.Coulomb(
            ["x", "y"],
            normal=[side * np.sin(a), np.cos(a)],
            friction=friction,
            tangential_stiffness=3e5,
            normal_stiffness=3e5,
            name=name,
        )
        for name, side in (("left", -1.0), ("right", 1.0))
    ]
    body = ss.Structure(0.1 * np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), ["x", "y"])
    return ss.Model(body, faces, [ss.Force("y", load, harmonic=0)])


def test_wedge_statics_and_their_range():
    at_rest = ss.static_response(wedge(0.6))
    assert at_rest.status == RestStatus.CONVERGED
    least, greatest = at_rest.normal_force_range("left")
    assert least == pytest.approx(104.19226170, abs=1e-8)
    assert greatest == pytest.approx(315.48073651, abs=1e-8)
    # A wedge pressed in for the first time moves in.
    assert at_rest.contact_force("left")[1] == pytest.approx(least, rel=1e-9)
    alone = at_rest.normal_force_range("left", alone=True)
    assert alone[0] < least
    assert alone[1] >= greatest - 1e-9
    assert ss.static_response(wedge(0.0)).normal_force_range("right") == pytest.approx(
        (156.64887472, 156.64887472), abs=1e-8
    )


def test_wedge_that_locks():
    least, greatest = ss.static_response(wedge(1.2)).normal_force_range("right")
    assert greatest == np.inf
    a = np.deg2rad(40.0)
    assert least == pytest.approx(120.0 / (np.cos(a) + 1.2 * np.sin(a)), rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 1e-9])
def test_a_wall_without_friction_does_not_pull(friction):
    """A body on a rough floor at a smooth wall: the floor bears least as the wall is left."""
    structure = ss.Structure(np.eye(2), [[1e4, -4e3], [-4e3, 1e4]], np.zeros((2, 2)), ["x", "y"])
    springs = {"tangential_stiffness": 2e4, "normal_stiffness": 3e4}
    floor = ss.Coulomb(["x", "y"], normal=[0, 1], friction=0.8, name="floor", **springs)
    wall = ss.Coulomb(["y", "x"], normal=[0, 1], friction=friction, name="wall", **springs)
    loads = [ss.Force("x", 30.0, harmonic=0), ss.Force("y", 100.0, harmonic=0)]
    at_rest = ss.static_response(ss.Model(structure, [floor, wall], loads))
    for alone in (False, True):
        # There x = 0, and y is that of the spring and the floor under 100 N.
        least, greatest = at_rest.normal_force_range("floor", alone=alone)
        assert least == pytest.approx(100.0 * 3e4 / (1e4 + 3e4), rel=1e-7)
        assert greatest > at_rest.contact_force("floor")[1] > least
        assert at_rest.normal_force_range("wall", alone=alone)[0] == pytest.approx(0.0, abs=1e-7)


def test_range_in_space_agrees_with_the_plane():
    """A node between two springs, pushed in a direction of the plane that is no axis."""
    for turn in (0.0, 0.3, 1.1):
        u = np.array([np.cos(turn), np.sin(turn), 0.0])
        # Pulling along u presses the node: the structure couples the two.
        stiffness = 1e4 * np.eye(3) - 4e3 * (np.outer(u, [0, 0, 1]) + np.outer([0, 0, 1], u))
        body = ss.Structure(np.eye(3), stiffness, np.zeros((3, 3)), ["x", "y", "z"])
        pad = ss.Coulomb(
            ["x", "y", "z"],
            normal=[0, 0, 1],
            friction=0.5,
            tangential_stiffness=2e4,
            normal_stiffness=3e4,
        )
        forces = [ss.Force("z", 100.0, harmonic=0)]
        found = ss.static_response(ss.Model(body, [pad], forces)).normal_force_range(0)
        flat = ss.Structure(
            np.eye(2), np.array([[1e4, -4e3], [-4e3, 1e4]]), np.zeros((2, 2)), ["t", "z"]
        )
        line = ss.Coulomb(
            ["t", "z"],
            normal=[0, 1],
            friction=0.5,
            tangential_stiffness=2e4,
            normal_stiffness=3e4,
        )
        expected = ss.static_response(ss.Model(flat, [line], forces)).normal_force_range(0)
        assert found == pytest.approx(expected, rel=1e-9)


def test_a_body_that_comes_free_says_so():
    pulled = ss.static_response(wedge(0.6, load=-1.0))
    assert pulled.status == RestStatus.FREE
    assert pulled.share < 1e-6
    with pytest.raises(ss.ModelError, match="loading ended as free"):
        pulled.normal_force_range("left")


def test_what_statics_refuses_names_it():
    at_rest = ss.static_response(wedge(0.6))
    with pytest.raises(ss.ModelError, match="'up'"):
        at_rest.normal_force_range("up")
    with pytest.raises(ss.ModelError, match="point"):
        at_rest.normal_force_range("left", 1)
    with pytest.raises(ss.ModelError, match="dof"):
        at_rest.displacement("z")
    body = ss.Structure(np.eye(2), 1e4 * np.eye(2), np.zeros((2, 2)), ["x", "y"])
    away = ss.Coulomb(
        ["x", "y"],
        normal=[0, 1],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=1e4,
        gap=1e-3,
        name="away",
    )
    rubs = ss.Jenkins("x", stiffness=1e3, slip_force=1.0)
    loads = [ss.Force("y", -1.0, harmonic=0)]
    apart = ss.static_response(ss.Model(body, [away, rubs], loads))
    with pytest.raises(ss.ModelError, match="node 0 of contact 'away' is open"):
        apart.normal_force_range("away")
    with pytest.raises(ss.ModelError, match="'jenkins' has no normal force"):
        apart.normal_force_range("jenkins")
    floating = ss.Structure(np.eye(1), np.zeros((1, 1)), np.zeros((1, 1)), ["x"])
    with pytest.raises(ss.ModelError, match="singular although all contacts stick"):
        ss.static_response(ss.Model(floating, [], [ss.Force("x", 1.0, harmonic=0)]))


def test_statics_of_a_disk_are_those_of_all_its_sectors():
    body = ss.Structure(np.eye(2), 1e4 * np.eye(2), np.zeros((2, 2)), ["x", "y"])
    shroud = ss.Coulomb(
        ["x", "y"],
        ["next.x", "next.y"],
        normal=[0.6, 0.8],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=1e4,
        preload=3.0,
    )
    disk = ss.BladedDisk(
        body, sectors=4, contacts=[shroud], forces=[ss.Force("x", 1.0)], engine_order=1
    )
    with pytest.raises(ss.ModelError, match=r"ask the whole disk, disk\.mistuned"):
        ss.static_response(disk).normal_force_range(0)
    at_rest = ss.static_response(disk.mistuned(np.zeros(4)))
    low, high = at_rest.normal_force_range(3)
    assert at_rest.contact_force(3)[1] == 3.0
    assert low <= 3.0 <= high


def test_without_static_loads_nothing_moves():
    body = ss.Structure(np.eye(1), 1e4 * np.eye(1), np.zeros((1, 1)), ["x"])
    rubs = ss.Jenkins("x", stiffness=1e3, slip_force=1.0)
    for contacts in ([], [rubs]):
        at_rest = ss.static_response(ss.Model(body, contacts, [ss.Force("x", 1.0)]))
        assert at_rest.status == RestStatus.CONVERGED
        assert at_rest.displacement("x") == 0.0


def test_motions_begin_with_the_history_of_static_loads():
    body = ss.Structure(np.eye(2), np.diag([4e4, 9e4]), np.diag([8.0, 10.0]), ["t", "n"])
    pad = ss.Coulomb(
        ["t", "n"], normal=[0, 1], friction=0.4, tangential_stiffness=5e4, normal_stiffness=8e4
    )
    forces = [ss.Force("n", 200.0, harmonic=0), ss.Force("t", 1e-6)]
    model = ss.Model(body, [pad], [*forces, ss.Force("t", 30.0, harmonic=0)])
    at_rest = ss.static_response(model)
    moving = ss.forced_response(model, [50.0], harmonics=3)
    assert moving.settings.residual == "from_rest"
    assert moving.coefficients("t")[0, 0].real == pytest.approx(at_rest.displacement("t"), rel=1e-6)
    np.testing.assert_allclose(
        moving.contact_force(0, 0, 16).mean(axis=0), at_rest.contact_force(0), rtol=1e-6
    )
    assert ss.forced_response(ss.Model(body, [pad], forces[1:]), [50.0]).settings.residual == (
        "centred"
    )


def test_files_and_pictures(tmp_path):
    result = ss.static_response(wedge(0.6))
    result.save(tmp_path / "rest.nc")
    again = ss.load(tmp_path / "rest.nc")
    np.testing.assert_array_equal(again.contact_force("left"), result.contact_force("left"))
    heights = sorted(bar.get_height() for bar in result.plot().patches)
    assert heights[0] == pytest.approx(heights[-1])


@pytest.mark.parametrize("seed", [7, 19])
def test_a_body_that_only_rounding_holds_is_free(seed: int) -> None:
    """Its eigenvalue of 0 is rounded: it had converged at 2e9 m, or stalled after 20 000 steps."""
    rng = np.random.default_rng(seed)
    shapes, _ = np.linalg.qr(rng.normal(size=(5, 5)))
    stiffness = shapes @ np.diag([0.0, *rng.uniform(1e4, 9e4, 4)]) @ shapes.T
    stiffness = 0.5 * (stiffness + stiffness.T)
    dofs = [f"q{number}" for number in range(5)]
    structure = ss.Structure(np.eye(5), stiffness, 1e-4 * stiffness, dofs)
    pad = ss.Coulomb(
        ["q0", "q1"],
        normal=[0, 1],
        friction=0.5,
        tangential_stiffness=1e4,
        normal_stiffness=3e4,
        preload=1.0,
    )
    pushes = 5.0 * rng.normal(size=5)
    loads = [ss.Force(dof, push, harmonic=0) for dof, push in zip(dofs, pushes, strict=True)]
    rest = ss.static_response(ss.Model(structure, [pad], loads))
    assert rest.status == "free"
    assert rest.counters["steps"] < 100


@pytest.mark.parametrize("stiffness", [1e8, 1e12, 1e15])
def test_a_rigid_contact_that_slips_leaves_the_body_to_its_springs(stiffness: float) -> None:
    springs = [[2e3, -1e3], [-1e3, 1e3]]
    structure = ss.Structure(np.eye(2), springs, np.eye(2), ["x", "y"])
    pad = ss.Jenkins("x", stiffness=stiffness, slip_force=1.0)
    model = ss.Model(structure, [pad], [ss.Force("x", 5.0, harmonic=0)])
    rest = ss.static_response(model)
    assert rest.status == "converged"
    assert rest.displacement("x") == pytest.approx(4e-3, rel=1e-5)


@pytest.mark.parametrize(("load", "status"), [(0.97, "converged"), (1.03, "free")])
def test_a_load_beyond_friction_in_space_carries_a_body_away(load: float, status: str) -> None:
    # Three contacts turn their tractions towards the slide of a body along (1, 2), which a spring
    # across alone holds: together they take 7.7 N.
    along, across = np.array([1.0, 2.0]) / 5**0.5, np.array([-2.0, 1.0]) / 5**0.5
    structure = ss.Structure(np.eye(2), 4e4 * np.outer(across, across), 2.0 * np.eye(2), ["x", "y"])
    contacts = [
        ss.Coulomb(
            [{"x": np.cos(a), "y": np.sin(a)}, {"x": -np.sin(a), "y": np.cos(a)}],
            normal=None,
            friction=friction,
            tangential_stiffness=stiffness,
            preload=10.0,
        )
        for a, friction, stiffness in [(0.0, 0.5, 1e4), (0.7, 0.2, 3e4), (2.0, 0.07, 2e3)]
    ]
    forces = [ss.Force(dof, 7.7 * load * p, harmonic=0) for dof, p in zip("xy", along, strict=True)]
    shaken = ss.Force("x", 0.3)
    model = ss.Model(structure, contacts, [*forces, shaken])
    assert ss.static_response(model).status == status
    response = ss.forced_response(model, [60.0], 5, stability=False)
    assert response.status[0] == status


def test_the_least_normal_force_is_below_the_greatest():
    """A block on a rough and a smooth face, by hand: pressed least in all, the rough one is most.

    Along x and y -0.6 N + 0.6 S - 0.8 T = 0 and 0.8 N + 0.8 S - 0.6 T = 100 with T = +-0.5 N.
    """
    laws = {"tangential_stiffness": 1e6, "normal_stiffness": 1e6}
    faces = [
        ss.Coulomb(["x", "y"], normal=[0.6, -0.8], friction=0.5, name="rough", **laws),
        ss.Coulomb(["x", "y"], normal=[-0.6, -0.8], friction=0.0, name="smooth", **laws),
    ]
    block = ss.Structure(np.eye(2), np.zeros((2, 2)), dofs=["x", "y"])
    at_rest = ss.static_response(ss.Model(block, faces, [ss.Force("y", -100.0, harmonic=0)]))
    ends = {"rough": [], "smooth": []}
    for slip in (0.5, -0.5):
        share = (0.6 + 0.8 * slip) / 0.6
        rough = 100.0 / (0.8 + 0.8 * share - 0.6 * slip)
        ends["rough"].append(rough)
        ends["smooth"].append(share * rough)
    for name, forces in ends.items():
        for alone in (False, True):
            found = at_rest.normal_force_range(name, alone=alone)
            assert found == pytest.approx(sorted(forces), rel=1e-9)


def pressed(
    faces: np.ndarray, softer: float, *, mirrored: bool = False, length: float = 1.0
) -> StaticResponse:
    """Return a cylinder pressed between two blades, in a mirror or in another unit of length.

    `faces` holds two rows: friction and angle [deg] of each face.
    """
    (first, angle), (second, other_angle) = faces[::-1] if mirrored else faces
    cylinder = ss.CylinderDamper(
        mass=0.1 / length,
        friction=(first, second),
        tangential_stiffness=1e5 / length,
        normal_stiffness=1e5 * softer / length,
        angle=(angle, other_angle),
        load=80.0,
        cylinder_radius=0.01 * length,
    )
    coupling = -1e5 if mirrored else 1e5
    blades = [
        ss.Structure(
            10.0 / length * np.eye(2),
            np.array([[s, coupling], [coupling, 1.5 * s]]) / length,
            np.zeros((2, 2)),
            ["x", "y"],
        )
        for s in (1e6, 1.2e6)
    ]
    axes = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    model = cylinder.between(*(blades[::-1] if mirrored else blades), **axes)
    return ss.static_response(model)


@pytest.mark.parametrize("seed", range(20))
def test_a_pressed_cylinder_rests_as_in_the_mirror_and_in_other_units(seed: int) -> None:
    """Both faces slip from the start: turning then has no stiffness, and rounding told how far."""
    rng = np.random.default_rng(seed)
    least, more = rng.uniform(0.05, 0.4), rng.uniform(1.1, 2.0)
    faces = np.column_stack([[least, more * least], rng.uniform(20.0, 50.0, 2)])
    softer = 10.0 ** rng.uniform(-1.0, 1.0)
    rest = pressed(faces, softer)
    mirror = pressed(faces, softer, mirrored=True)
    longer = pressed(faces, softer, length=1e3)
    assert mirror.status == rest.status == longer.status == RestStatus.CONVERGED
    for dof in rest.model.structure.dofs:
        here = rest.displacement(dof)
        turned = "rotation" in dof
        there = longer.displacement(dof) / (1.0 if turned else 1e3)
        assert there == pytest.approx(here, rel=1e-7, abs=1e-12)
        if turned:
            assert abs(here) < 10.0
            assert mirror.displacement(dof) == pytest.approx(-here, rel=1e-7, abs=1e-12)

"""Interfaces: areas of random meshes, pairs, contacts of meshes, maps, and what is refused."""

import numpy as np
import pytest
from scipy.sparse import block_diag

import stickslip as ss
from stickslip.fe.surface import Surface, turned

skfem = pytest.importorskip("skfem")
LAWS = {"friction": 0.3, "tangential_stiffness": 2e12, "normal_stiffness": 3e12}


def block(low=0.0, high=0.01, nx=3, ny=2, seed=None):
    """A block on z = low; with a seed its inner lines are moved."""
    x, y = np.linspace(0.0, 0.03, nx + 1), np.linspace(0.0, 0.02, ny + 1)
    if seed is not None:
        random = np.random.default_rng(seed)
        for line in (x, y):
            line[1:-1] += 0.3 * line[1] * random.uniform(-1.0, 1.0, line.size - 2)
    mesh = skfem.MeshHex.init_tensor(x, y, np.array([low, high]))
    return ss.Solid(mesh, 210e9, 0.3, 7850.0)


def flat(faces, points):
    return Surface.of(np.arange(1, len(points) + 1), points, faces, "test")


def random_triangles(seed):
    """Triangles of random points in a plane that is turned; their area by the hull."""
    from scipy.spatial import ConvexHull, Delaunay

    random = np.random.default_rng(seed)
    plane = random.random((40, 2))
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    turn[2] *= np.linalg.det(turn)
    triangles = Delaunay(plane).simplices.astype(np.int64)
    points = np.column_stack([plane, np.full(40, 0.3)]) @ turn
    return triangles, points, ConvexHull(plane).volume, turn


def quadratic(faces, points):
    """The same faces with nodes at the middles of their edges."""
    corners = faces.shape[1]
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)
    keys, place = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    middles = points[keys].mean(axis=1)
    added = place.reshape(-1, corners) + len(points)
    return np.hstack([faces, added]), np.vstack([points, middles])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("order", [1, 2])
def test_areas_of_random_triangles_add_up(seed, order):
    faces, points, area, turn = random_triangles(seed)
    if order == 2:
        faces, points = quadratic(faces, points)
    surface = flat([faces], points)
    assert surface.area == pytest.approx(area, rel=1e-13)
    assert (surface.areas > 0.0).all()
    cosine = surface.normals @ turn[2]
    np.testing.assert_allclose(np.abs(cosine), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(flat([turned(faces)], points).normals, -surface.normals, atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("order", [1, 2])
def test_areas_of_random_quadrilaterals_add_up(seed, order):
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    inner = (x % 4 > 0) & (y % 3 > 0)
    x, y = (one + 0.3 * inner * random.uniform(-1, 1, x.shape) for one in (x, y))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(20)])
    grid = np.arange(20).reshape(5, 4)
    corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    faces = np.stack([one.ravel() for one in corners], axis=1)
    if order == 2:
        faces, points = quadratic(faces, points)
    surface = flat([faces], points)
    assert surface.area == pytest.approx(12.0, rel=1e-13)
    assert (surface.areas > 0.0).all()
    np.testing.assert_allclose(surface.normals, np.tile([0.0, 0.0, 1.0], (len(points), 1)))


def test_linear_areas_are_those_of_uniform_pressure():
    """A quarter of each square, by hand: corners 1, edges 2, the middle 4."""
    points = np.array([[x, y, 0.0] for x in range(3) for y in range(3)], dtype=float)
    grid = np.arange(9).reshape(3, 3)
    faces = np.stack(
        [one.ravel() for one in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])],
        axis=1,
    )
    np.testing.assert_allclose(4 * flat([faces], points).areas, [1, 2, 1, 2, 4, 2, 1, 2, 1])


def test_a_curved_quadratic_surface_has_its_area():
    """A quarter of a cylinder of radius 1 and length 1: pi / 2, to the error of its elements."""
    errors = []
    for count in (4, 8):
        angle = np.linspace(0.0, np.pi / 2, 2 * count + 1)
        ring = np.column_stack([np.cos(angle), np.sin(angle)])
        points = np.array([[*ring[i], z] for z in (0.0, 0.5, 1.0) for i in range(len(ring))])
        at = np.arange(len(points)).reshape(3, -1)
        lines = [
            [
                *(at[0, i], at[0, i + 2], at[2, i + 2], at[2, i]),
                *(at[0, i + 1], at[1, i + 2], at[2, i + 1], at[1, i]),
            ]
            for i in range(0, 2 * count, 2)
        ]
        surface = flat([np.array(lines)], points)
        errors.append(abs(surface.area - np.pi / 2))
        radial = surface.points * [1.0, 1.0, 0.0]
        cosine = np.einsum("ni,ni->n", surface.normals, radial)
        inner = (radial[:, :2] > 1e-9).all(axis=1)  # at the ends faces lie on one side only
        np.testing.assert_allclose(cosine[inner], 1.0, rtol=0, atol=1e-12)
        assert (cosine > 0.99).all()
    assert errors[1] < errors[0] / 12.0
    assert errors[1] < 1e-5


def two_blocks(gap=0.0, seed=0, noise=0.0, order=None):
    """Upper and lower block as meshes; `order` renumbers the nodes of the lower one."""
    upper, lower = ss.Mesh.of_solid(block(gap, 0.01 + gap, seed=seed)), block(-0.01, 0.0, seed=seed)
    lower = ss.Mesh.of_solid(lower)
    points = lower.nodes + noise * np.random.default_rng(9).uniform(-1, 1, lower.nodes.shape)
    if order is not None:
        back = np.argsort(order)
        points = points[order]
        cells = tuple((kind, back[nodes]) for kind, nodes in lower.cells)
        return upper, ss.Mesh(points, cells, lower.numbers)
    return upper, ss.Mesh(points, lower.cells, lower.numbers)


def paired(upper, lower, **keys):
    low = np.abs(upper.nodes[:, 2] - upper.nodes[:, 2].min()) < 1e-5
    high = np.abs(lower.nodes[:, 2]) < 1e-5
    names = ("upper", "lower")
    return ss.ContactInterface.from_surfaces(upper, low, lower, high, names=names, **keys)


def test_pairs_do_not_depend_on_numbers_or_noise():
    straight = paired(*two_blocks())
    order = np.random.default_rng(3).permutation(len(two_blocks()[1].numbers))
    mixed = paired(*two_blocks(order=order, noise=1e-6))
    # places of the mixed numbers, led back
    np.testing.assert_array_equal(order[mixed.other - 1] + 1, straight.other)
    np.testing.assert_array_equal(mixed.first, straight.first)
    assert straight.area == pytest.approx(6e-4, rel=1e-13)
    assert np.abs(straight.gap).max() < 1e-15
    np.testing.assert_allclose(
        straight.normals, np.tile([0, 0, -1.0], (straight.count, 1)), atol=1e-12
    )


def test_the_gap_is_the_distance_along_the_normal():
    interface = paired(*two_blocks(gap=2e-5))
    np.testing.assert_allclose(interface.gap, 2e-5, rtol=1e-9)


def test_nodes_without_a_partner_are_named_and_may_be_left():
    upper, _ = two_blocks()
    shifted = ss.Mesh(upper.nodes + np.array([0.015, 0.0, -0.01]), upper.cells, upper.numbers)
    with pytest.raises(ss.ModelError, match=r"nodes of the first surface have no partner") as error:
        paired(upper, shifted)
    assert "\n" not in str(error.value)
    assert "partial=True" in str(error.value)


def test_half_an_overlap():
    upper = ss.Mesh.of_solid(block(0.0, 0.01, nx=4))
    lower = ss.Mesh(upper.nodes + np.array([0.015, 0.0, -0.01]), upper.cells, upper.numbers)
    interface = paired(upper, lower, partial=True)
    assert len(interface.unpaired[0]) == len(interface.unpaired[1]) > 0
    assert (interface.points[:, 0] > 0.015 - 1e-9).all()
    assert interface.count + len(interface.unpaired[0]) == len(interface.surface.labels)
    assert interface.area < interface.surface.area


def test_rigid_motion_gives_no_force():
    upper, lower = two_blocks(seed=2)
    interface = paired(upper, lower)
    contact = interface.contact(**LAWS)
    names = [f"upper.{n}.{way}" for n in upper.numbers for way in (1, 2, 3)]
    names += [f"lower.{n}.{way}" for n in lower.numbers for way in (1, 2, 3)]
    places = np.vstack([upper.nodes, lower.nodes])
    matrix = np.eye(len(names))
    rows = contact.rows(ss.Structure(matrix, matrix, dofs=names))
    moves = [np.tile(one, (len(places), 1)) for one in np.eye(3)]
    moves += [np.cross(one, places) for one in np.eye(3)]
    for move in moves:
        assert np.abs(rows @ move.ravel()).max() < 1e-15
    assert np.abs(rows @ np.random.default_rng(0).random(len(names))).max() > 0.1


def pressed_block(nx=3, ny=2, **keys):
    """A block on the ground, its top pressed by a pressure; interface, reduction, load."""
    solid = block(nx=nx, ny=ny)
    mesh = ss.Mesh.of_solid(solid)
    interface = ss.ContactInterface.from_surfaces(solid, mesh.nodes[:, 2] == 0.0)
    kept = [*interface.first_dofs]
    top = solid.dofs[3 * solid.nearest([0.0, 0.0, 0.01])][:-2]
    reduced = ss.craig_bampton(
        solid.mass,
        solid.stiffness,
        {dof: dof for dof in kept} | {"top": f"{top}.1"},
        modes=4,
        dofs=solid.dofs,
    )
    vertices = np.flatnonzero(solid.mesh.p[2] == 0.01)
    push = lambda where: np.stack([0 * where[0], 0 * where[0], -5e6 + 0 * where[0]])  # noqa: E731
    return interface, reduced, solid.load(push, vertices)


def test_normal_forces_bear_the_load():
    interface, reduced, load = pressed_block()
    model = ss.Model(
        reduced.structure(ss.ModalDamping(0.01)),
        [interface.contact(**LAWS)],
        reduced.forces(load, harmonic=0),
    )
    at_rest = ss.static_response(model)
    pressure = interface.pressure(at_rest)
    assert interface.areas @ pressure == pytest.approx(5e6 * 6e-4, rel=1e-9)
    seen = ss.ContactMap.of(interface, at_rest)
    assert seen.normal_force == pytest.approx(3000.0, rel=1e-9)
    assert seen.open_area == 0.0
    np.testing.assert_allclose(seen["pressure"], pressure)
    assert seen.work == 0.0


def test_one_contact_of_many_nodes_is_many_contacts():
    interface, reduced, _ = pressed_block(nx=1, ny=1)
    many = interface.contact(**LAWS, pressure=5e6)
    single = [
        ss.Coulomb(
            [f"{node}.{way}" for way in (1, 2, 3)],
            normal=normal,
            friction=0.3,
            tangential_stiffness=2e12 * area,
            normal_stiffness=3e12 * area,
            preload=5e6 * area,
            name=f"at-{node}",
        )
        for node, normal, area in zip(
            interface.first, interface.normals, interface.areas, strict=True
        )
    ]
    # Held a little by the ground: a body on contacts alone has no mean position.
    held = reduced.stiffness + 1e-3 * np.trace(reduced.stiffness) / 29 * np.eye(29)
    plate = ss.Structure(reduced.mass, held, ss.ModalDamping(0.01), reduced.dofs)
    force = [ss.Force("top", 1000.0)]
    omega = 0.3 * ss.natural_frequencies(ss.Model(plate, [many], force))[0]
    one = ss.forced_response(ss.Model(plate, [many], force), [omega], harmonics=3)
    each = ss.forced_response(ss.Model(plate, single, force), [omega], harmonics=3)
    assert one.converged.all()
    assert each.converged.all()
    assert one.amplitude("top") == pytest.approx(each.amplitude("top"), rel=1e-8)
    seen = ss.ContactMap.of(interface, one, index=0)
    alone = [each.dissipation(number)[0].sum() for number in range(interface.count)]
    np.testing.assert_allclose(seen["work"] * interface.areas, alone, rtol=1e-6, atol=1e-12)
    assert seen.work > 0.0
    assert seen.slip_area == pytest.approx(ss.slip_area(interface, one)[0])
    np.testing.assert_allclose(seen["stick"] + seen["slip"] + seen["open"], 1.0, atol=1e-12)


def test_relative_displacements_are_another_view_of_the_same_joint():
    upper, lower = block(0.0, 0.01, nx=1, ny=1), block(-0.01, 0.0, nx=1, ny=1)
    meshes = ss.Mesh.of_solid(upper), ss.Mesh.of_solid(lower)
    interface = paired(*meshes)
    count = 3 * len(meshes[0].numbers)
    held = 1e9 * np.eye(count)  # springs to the ground
    stiffness = block_diag([upper.stiffness, lower.stiffness + held])
    names = [
        f"{body}.{dof}" for body, one in (("upper", upper), ("lower", lower)) for dof in one.dofs
    ]
    changed = interface.relative(stiffness, names)
    contact, other = interface.contact(**LAWS), interface.contact(**LAWS, relative=True)
    load = np.random.default_rng(1).standard_normal(2 * count)
    plain, moved = _bonded(stiffness, contact, names), _bonded(changed, other, names)
    x = np.linalg.solve(plain, load)
    relative = np.linalg.solve(moved, interface.relative(load, names))
    rows = {name: at for at, name in enumerate(names)}
    first, second = (
        np.array([rows[one] for one in half]) for half in np.split(np.array(interface.dofs), 2)
    )
    scale = np.abs(x).max()
    np.testing.assert_allclose(relative[first], x[first] - x[second], atol=1e-8 * scale)
    np.testing.assert_allclose(relative[second], x[second], atol=1e-8 * scale)


def _bonded(stiffness, contact, names):
    identity = np.eye(len(names))
    rows = contact.rows(ss.Structure(identity, identity, dofs=names))
    return stiffness.toarray() + rows.T @ contact.stuck_stiffness @ rows


DECK = """** two bricks, one above the other, and a shell on top
*NODE, NSET=ALL
 1, 0,0,0
 2, 2,0,0
 3, 2,3,0
 4, 0,3,0
 5, 0,0,1
 6, 2,0,1
 7, 2,3,1
 8, 0,3,1
 21, 0,0,1
 22, 2,0,1
 23, 2,3,1
 24, 0,3,1
 31, 0,0,2
 32, 2,0,2
 33, 2,3,2
 34, 0,3,2
*ELEMENT, TYPE=C3D8, ELSET=LOW
10, 1,2,3,4,5,
6,7,8
*Element, type=C3D8R, elset=High
20, 21,22,23,24,31,32,33,34
*ELEMENT, TYPE=SPRINGA, ELSET=SPRINGS
30, 1, 2
*NSET, NSET=FEET, GENERATE
1, 4
*NSET, NSET=ENDS
FEET, 31, 32, 33, 34
*SURFACE, NAME=SEAT
LOW, S2
*SURFACE, NAME=PAD, TYPE=ELEMENT
20, S1
*SURFACE, NAME=POINTS, TYPE=NODE
31, 32, 33, 34
*STEP
*END STEP
"""


def deck(folder, text=DECK):
    path = folder / "joint.inp"
    path.write_text(text)
    return path


def test_a_deck_gives_surfaces_and_sets(tmp_path):
    mesh = ss.read_mesh(deck(tmp_path))
    interface = ss.ContactInterface.from_surfaces(mesh, "PAD", mesh, "SEAT")
    assert dict(zip(interface.first.tolist(), interface.other.tolist(), strict=True)) == {
        21: 5,
        22: 6,
        23: 7,
        24: 8,
    }
    assert interface.area == pytest.approx(6.0)
    np.testing.assert_allclose(interface.normals, np.tile([0, 0, -1.0], (4, 1)), atol=1e-15)
    assert interface.dofs[:3] == ("21.1", "21.2", "21.3")
    for name, height, normal in (("FEET", 0.0, -1.0), ("POINTS", 2.0, 1.0), ("SEAT", 1.0, 1.0)):
        surface = mesh.surface(name)
        assert surface.area == pytest.approx(6.0)
        assert (surface.points[:, 2] == height).all()
        np.testing.assert_allclose(surface.normals[:, 2], normal)
    assert mesh.surface("ENDS").area == pytest.approx(12.0)
    # every node of both bricks: their whole outside, the two faces that touch too
    assert mesh.surface("ALL").area == pytest.approx(2 * 22.0)


def test_all_surfaces_of_elements_close():
    """The area vectors of the outside of a body add up to nothing, for every kind of element."""
    corners = np.array([[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]], dtype=float)
    brick = np.vstack([corners, corners * 0.8 + [0.1, 0.2, 1.5]])
    for kind, nodes, faces in (
        ("hexahedron", range(8), 6),
        ("wedge", (0, 1, 3, 4, 5, 7), 5),
        ("tetra", (0, 1, 3, 4), 4),
    ):
        own = brick[list(nodes)]
        # numbered in a mirrored way too: normals point outward all the same
        for points in (own, own * [1.0, 1.0, -1.0]):
            cells = ((kind, np.arange(len(own))[None]),)
            mesh = ss.Mesh(points, cells)
            surface = mesh.surface(np.ones(len(own), dtype=bool))
            assert sum(map(len, surface.faces)) == faces
            total, volume = np.zeros(3), 0.0
            for _, _, vectors in surface._integrals:
                total += vectors.sum(axis=(0, 1))
            for face in surface.faces:
                for one in face:
                    a, b, c = (
                        surface.points[one[0]],
                        surface.points[one[1]],
                        surface.points[one[-1]],
                    )
                    volume += np.cross(b - a, c - a) @ (
                        surface.points[one].mean(axis=0) - points.mean(axis=0)
                    )
            np.testing.assert_allclose(total, 0.0, atol=1e-12)
            assert volume > 0.0


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("LOW, S2", "LOV, S2", "unknown ELSET 'LOV'"),
        ("LOW, S2", "LOW, S7", "hexahedron has no face 'S7'"),
        ("LOW, S2", "SPRINGS, S1", "unknown ELSET 'SPRINGS'"),
        ("LOW, S2", "30, S1", "element 30 has no faces here"),
        ("LOW, S2", "99, S1", "element 99 is not there"),
        ("FEET, 31", "FEAT, 31", "unknown set 'FEAT'"),
        ("FEET, 31", "FEET, 77", "node set ENDS: there is no node 77"),
        ("6,7,8", "6,7,9", "element 10: there is no node 9"),
        ("6,7,8", "6,7", "8 numbers; 9 each"),
        (" 8, 0,3,1", " 8, 0,3,nan", "a coordinate is not finite"),
        (" 8, 0,3,1", " 8, 0,3,one", "could not convert"),
        ("*NODE, NSET=ALL", "*NODE, SYSTEM=C", "rectangular"),
        ("*STEP", "*PART, NAME=A", "without parts and instances"),
        ("*STEP", "*NSET", "NSET= is missing"),
        ("*STEP", "*INCLUDE, INPUT=joint.inp", "include each other"),
    ],
)
def test_a_damaged_deck_is_refused_in_one_line(tmp_path, old, new, says):
    path = deck(tmp_path, DECK.replace(old, new))
    with pytest.raises(ss.ModelError, match=r"joint\.inp") as error:
        ss.read_mesh(path)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_what_does_not_exist_is_named(tmp_path):
    mesh = ss.read_mesh(deck(tmp_path))
    pair = ss.ContactInterface.from_surfaces
    for call, says in (
        (lambda: mesh.surface("SEATS"), "did you mean 'SEAT'"),
        (lambda: mesh.surface(np.array([5, 6])), "True and False for the 16 nodes"),
        (lambda: mesh.surface(np.zeros(16, dtype=bool)), "it has no faces"),
        (lambda: pair(mesh, "PAD", mesh, "FEET", tolerance=0.5), "the nearest are 1 m apart"),
        (lambda: pair(mesh, "PAD", mesh, "SEAT", tolerance=0.0), "must be positive"),
        (lambda: pair(mesh, "PAD", mesh, "SEAT", tolerance="1"), "not a number"),
        (lambda: pair(mesh, "PAD", mesh, "PAD"), "paired with itself"),
        (lambda: pair(mesh, "PAD", mesh, "PAD", names=("a", "b")), "do not face each other"),
        (lambda: pair(mesh, "PAD", mesh), "other_mesh and other_surface"),
        (lambda: pair(mesh, "PAD", names=("a",)), "give two"),
        (lambda: pair("mesh", "PAD"), "ss.read_mesh"),
        (lambda: ss.read_mesh(tmp_path / "none.inp"), "no such file"),
        (lambda: ss.read_mesh(tmp_path / "joint.obj"), "no such file"),
    ):
        with pytest.raises(ss.ModelError) as error:
            call()
        assert says in str(error.value)
        assert "\n" not in str(error.value)


def test_the_map_is_written_and_drawn(tmp_path):
    meshio = pytest.importorskip("meshio")
    interface, reduced, load = pressed_block()
    model = ss.Model(
        reduced.structure(), [interface.contact(**LAWS)], reduced.forces(load, harmonic=0)
    )
    seen = ss.ContactMap.of(interface, ss.static_response(model))
    seen.write_vtu(tmp_path / "map.vtu")
    read = meshio.read(tmp_path / "map.vtu")
    np.testing.assert_array_equal(read.point_data["pressure"], seen["pressure"])
    assert read.cells[0].type == "quad8"
    ax = seen.plot(field="pressure")
    assert len(ax.collections[0].get_paths()) == 6
    with pytest.raises(ss.ModelError, match="did you mean 'pressure'"):
        seen["presure"]
    with pytest.raises(ss.ModelError, match="did you mean 'pressure'"):
        seen.plot(field="presure")


def test_a_map_of_another_contact_is_refused():
    interface, reduced, load = pressed_block()
    model = ss.Model(
        reduced.structure(),
        [interface.contact(**LAWS), ss.Jenkins("top", stiffness=1.0, slip_force=1.0)],
        reduced.forces(load, harmonic=0),
    )
    at_rest = ss.static_response(model)
    with pytest.raises(ss.ModelError, match="'jenkins' has 1 points, the interface 29 pairs"):
        ss.ContactMap.of(interface, at_rest, "jenkins")
    with pytest.raises(ss.ModelError, match="give the contact of the 29 pairs"):
        interface.pressure(at_rest, "jenkins")

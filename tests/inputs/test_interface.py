"""Interfaces: pairs of nodes, contacts of meshes, maps, and what is refused."""

import numpy as np
import pytest
from scipy.sparse import block_diag

import stickslip as ss

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


@pytest.mark.slow
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
    back = interface.absolute(np.stack([relative, 1j * relative]), names)
    np.testing.assert_allclose(back, [x, 1j * x], atol=1e-8 * scale)
    with pytest.raises(ss.ModelError, match=r"absolute: shape \(2,\) for 120 dofs; give one"):
        interface.absolute([1.0, 2.0], names)


def test_fields_of_a_relative_model_are_those_of_both_bodies():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) * 0.01
    cells = [("quad", [[0, 1, 2, 3], [4, 7, 6, 5]])]
    mesh = ss.Mesh(np.vstack([square, square]), cells)
    lower = np.arange(8) < 4
    interface = ss.ContactInterface.from_surfaces(mesh, lower, mesh, ~lower)
    random = np.random.default_rng(2).standard_normal((2, 24, 24))
    M, K = np.eye(24) + 0.01 * random[0] @ random[0].T, 1e6 * (np.eye(24) + random[1] @ random[1].T)
    names = [f"{node}.{way}" for node in mesh.numbers for way in (1, 2, 3)]
    laws = {"friction": 0.3, "tangential_stiffness": 1e9, "normal_stiffness": 1e9, "pressure": 2e4}
    force, damping = [ss.Force("6.1", 100.0)], ss.ModalDamping(0.01)
    structures = [
        ss.Structure(M, K, damping, names),
        ss.Structure(*(interface.relative(one, names).toarray() for one in (M, K)), damping, names),
    ]
    plain, moved = (
        ss.forced_response(
            ss.Model(one, [interface.contact(**laws, relative=relative)], force),
            [800.0],
            harmonics=3,
            observe=names,
        )
        for one, relative in zip(structures, (False, True), strict=True)
    )
    assert plain.slip_fraction(0).max() > 0.1
    wanted, found = mesh.motion(plain, 0), mesh.motion(moved, 0, relative=interface)
    largest = wanted["displacement amplitude"].max()
    for name in wanted.keys() - {"slip fraction", "dissipation"}:
        np.testing.assert_allclose(found[name], wanted[name], rtol=0, atol=1e-6 * largest)

    change = [interface.relative(one, names) for one in (M, K)]
    reduced = ss.craig_bampton(*change, interface.first_dofs, modes=8, dofs=names)
    for field in mesh.modes(reduced, 3, relative=interface).values():
        assert field.ravel() @ M @ field.ravel() == pytest.approx(1.0)


def _bonded(stiffness, contact, names):
    identity = np.eye(len(names))
    rows = contact.rows(ss.Structure(identity, identity, dofs=names))
    return stiffness.toarray() + rows.T @ contact.stuck_stiffness @ rows


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
    drawn = ax.collections[0]
    bar = drawn.colorbar.ax
    assert bar.get_ylabel() == "mean pressure [MPa]"
    assert bar.yaxis.get_major_formatter()(2e6) == "2"
    assert ax.get_title().startswith("slips 0 mm², open")
    # Shares have no unit, and no prefix.
    assert seen.plot(field="slip").collections[0].colorbar.ax.get_ylabel().endswith("slips")
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

"""Surfaces and sets of the decks of finite-element programs."""

import numpy as np
import pytest

import stickslip as ss
from decks import DECK, bulk_data, deck


def test_a_deck_in_millimetres_becomes_metres(tmp_path):
    path = deck(tmp_path)
    own = ss.read_mesh(path)
    mesh = ss.read_mesh(path, units="t-mm-s")
    assert mesh.nodes == pytest.approx(1e-3 * own.nodes)
    assert mesh.numbers.tolist() == own.numbers.tolist()
    interface = ss.ContactInterface.from_surfaces(mesh, "PAD", mesh, "SEAT")
    # A face of 2 mm by 3 mm.
    assert interface.areas.sum() == pytest.approx(6e-6)
    contact = interface.contact(friction=0.3, tangential_stiffness=1e12, normal_stiffness=2e12)
    assert sum(contact.tangential_stiffness) == pytest.approx(6e6)
    renumbered = ss.read_mesh(path, np.arange(101, 117), units="t-mm-s")
    assert renumbered.numbers[0] == 101
    assert renumbered.nodes == pytest.approx(mesh.nodes)
    mesh.write_vtu(tmp_path / "joint.vtu", {})
    other = ss.read_mesh(tmp_path / "joint.vtu", units="kg-mm-s")
    assert other.nodes == pytest.approx(1e-3 * mesh.nodes)
    with pytest.raises(ss.ModelError, match="units: 'mm'; give mass, length and time"):
        ss.read_mesh(path, units="mm")


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


BRICK = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (2, 0), (2, 3), (0, 3))], float)
TOP = np.array([[4, 5, 6, 7]])
HALVES = np.array([[4, 5, 6], [4, 6, 7]])


@pytest.mark.parametrize("halves", [HALVES, HALVES[::-1, ::-1], [[4, 5, 7], [5, 6, 7]]])
def test_triangles_on_the_face_of_a_brick_do_not_count_again(halves):
    """Membranes that read stresses at the surface are triangles on quadrilaterals too."""
    on_top = BRICK[:, 2] == 1.0
    brick, halves = ("hexahedron", np.arange(8)[None]), ("triangle", np.asarray(halves))
    for cells in ([brick, halves], [halves, brick], [("quad", TOP), halves], [halves]):
        assert ss.Mesh(BRICK, cells).surface(on_top).area == pytest.approx(6.0)
    one = [brick, ("triangle", HALVES[:1])]
    assert ss.Mesh(BRICK, one).surface(on_top).area == pytest.approx(6.0)


def test_quadratic_triangles_on_a_quadratic_face_do_not_count_again():
    middles = [(0, 1), (1, 2), (2, 3), (3, 0)]
    middles += [(a + 4, b + 4) for a, b in middles] + [(a, a + 4) for a in range(4)] + [(4, 6)]
    nodes = np.vstack([BRICK, [BRICK[list(edge)].mean(axis=0) for edge in middles]])
    brick = ("hexahedron20", np.arange(20)[None])
    shells = ("triangle6", [[4, 5, 6, 12, 13, 20], [4, 6, 7, 20, 14, 15]])
    surface = ss.Mesh(nodes, [brick, shells]).surface(nodes[:, 2] == 1.0)
    assert [face.shape for face in surface.faces if face.size] == [(1, 8)]
    assert surface.area == pytest.approx(6.0)


def test_bricks_upon_tetrahedra_are_inside():
    """Meshes that are glued brick to tetrahedra have no surface there."""
    above = np.vstack([BRICK, [[1.0, 1.5, 2.0]]])
    tetrahedra = ("tetra", [[4, 5, 6, 8], [4, 6, 7, 8]])
    for kind, own in (tetrahedra, ("pyramid", [[4, 5, 6, 7, 8]])):
        mesh = ss.Mesh(above, [("hexahedron", np.arange(8)[None]), (kind, own)])
        whole = mesh.surface(np.ones(9, dtype=bool))
        assert sum(map(len, whole.faces)) == 5 + 4
        with pytest.raises(ss.ModelError, match="it has no faces"):
            mesh.surface(above[:, 2] == 1.0)


def test_a_quadrilateral_on_the_faces_of_tetrahedra_does_not_count_again():
    above = np.vstack([BRICK, [[1.0, 1.5, 2.0]]])
    cells = [("quad", TOP), ("tetra", [[4, 5, 6, 8], [4, 6, 7, 8]])]
    assert ss.Mesh(above, cells).surface(above[:, 2] == 1.0).area == pytest.approx(6.0)


@pytest.mark.parametrize(
    "rows",
    [
        "LOW, S2\n10, S2\n",
        "LOW, S2\nSKIN\n",
        "SKIN\nLOW, S2\n",
        "LOW, S2\nHALVES, SPOS\n",
        "HALVES\nSKIN\n",
    ],
)
def test_faces_that_a_surface_names_twice_count_once(tmp_path, rows):
    skin = (
        "*ELEMENT, TYPE=S4, ELSET=SKIN\n40, 5,6,7,8\n"
        "*ELEMENT, TYPE=M3D3, ELSET=HALVES\n41, 5,6,7\n42, 5,7,8\n"
    )
    text = DECK.replace("*NSET, NSET=FEET", skin + "*NSET, NSET=FEET").replace("LOW, S2\n", rows)
    seat = ss.read_mesh(deck(tmp_path, text)).surface("SEAT")
    assert seat.area == pytest.approx(6.0)
    np.testing.assert_allclose(seat.normals, np.tile([0, 0, 1.0], (4, 1)), atol=1e-15)


def test_both_sides_of_a_shell_are_refused_as_one_surface(tmp_path):
    skin = "*ELEMENT, TYPE=S4, ELSET=SKIN\n40, 5,6,7,8\n*NSET, NSET=FEET"
    text = DECK.replace("*NSET, NSET=FEET", skin)
    text = text.replace("LOW, S2\n", "SKIN, SPOS\nSKIN, SNEG\n")
    with pytest.raises(ss.ModelError, match="leave one of two opposite sides out"):
        _ = ss.read_mesh(deck(tmp_path, text)).surface("SEAT").normals


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
        (" 8, 0,3,1", " 8, 0,3,one", "line 10: 'ONE' is no real number"),
        ("6,7,8", "6,7,x", "line 21: 'X' stands where a whole number must be"),
        ("10, 1,2", f"{10**30}, 1,2", f"line 20: {10**30} is too large for a whole number"),
        ("1, 4\n", "1, 4, 0\n", "set FEET: [1, 4, 0] is no range; give first, last, step"),
        ("1, 4\n", "1\n", "set FEET: [1] is no range"),
        ("1, 4\n", "1, 4000000000\n", "set FEET: 1 to 4000000000 are too many; at most 6666666"),
        ("LOW, S2", "LOW, S²", "has no face"),
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


@pytest.mark.parametrize("wide", [False, True])
def test_sets_of_nastran_make_an_interface(tmp_path, wide):
    path = tmp_path / "joint.bdf"
    path.write_text(bulk_data(wide))
    mesh = ss.read_mesh(path)
    # SET1 3 is one of elements.
    assert sorted(mesh.node_sets) == ["SET1 1", "SET1 2"]
    interface = ss.ContactInterface.from_surfaces(mesh, "SET1 1", mesh, "SET1 2")
    assert interface.dofs[:3] == ("15.1", "15.2", "15.3")
    assert interface.area == pytest.approx(6.0)
    np.testing.assert_allclose(interface.normals, np.tile([0, 0, 1.0], (4, 1)), atol=1e-15)


def test_coordinates_of_another_system_of_nastran_are_refused(tmp_path):
    path = tmp_path / "joint.bdf"
    path.write_text(bulk_data(False, system="4"))
    with pytest.raises(ss.ModelError, match="GRID 11: its coordinates are those of system 4"):
        ss.read_mesh(path)


def test_a_set_of_more_numbers_than_nodes_takes_no_room(tmp_path):
    path = tmp_path / "joint.bdf"
    path.write_text(bulk_data(False).replace("SET1,1,15,THRU,18", "SET1,1,15,THRU,999999999999"))
    assert sorted(ss.read_mesh(path).node_sets) == ["SET1 2"]


@pytest.mark.parametrize(
    "entry",
    [
        "SET1,1,15,THRU",
        "SET1,1,18,THRU,15",
        "SET1,x,15",
        "SET1,,15",
        "GRID,,,0.,0.,0.",
        "SET1,1,15,16,17,18,20,21,22,,10",
    ],
)
def test_a_spoilt_entry_of_nastran_is_refused(tmp_path, entry):
    path = tmp_path / "joint.bdf"
    path.write_text(bulk_data(False).replace("SET1,1,15,THRU,18", entry))
    with pytest.raises(ss.ModelError, match=r"joint\.bdf"):
        ss.read_mesh(path)


@pytest.mark.parametrize("name", ["NBLOCKS", "NBLOCK"])
def test_sets_of_a_deck_may_have_names_of_other_programs(tmp_path, name):
    text = DECK.replace("NSET=FEET", f"NSET={name}").replace("FEET, 31", f"{name}, 31")
    own, other = ss.read_mesh(deck(tmp_path)), ss.read_mesh(deck(tmp_path, text))
    np.testing.assert_array_equal(other.node_sets[name], own.node_sets["FEET"])
    np.testing.assert_array_equal(other.node_sets["ENDS"], own.node_sets["ENDS"])


@pytest.mark.parametrize("words", ["SKIN", "15,THRU,18,EXCEPT,16", "15,thru,18,by,2"])
def test_a_set_said_in_other_words_is_left_out(tmp_path, words):
    path = tmp_path / "joint.bdf"
    path.write_text(bulk_data(False).replace("SET1,1,15,THRU,18", f"SET1,1,15\nSET1,1,{words}"))
    assert sorted(ss.read_mesh(path).node_sets) == ["SET1 2"]


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"cells": [("hexahedron", [[0, 1, 2, 3]])]}, "4 nodes for a hexahedron; give 8 of each"),
        ({"cells": [("quad", [[0, 1, 2]])]}, "3 nodes for a quad; give 4 of each"),
        ({"cells": [("triangle6", [[0, 1, 2]])]}, "3 nodes for a triangle6; give 6 of each"),
        ({"surfaces": {"top": [[[0, 1]]]}}, r"surface top: faces of shape \(1, 2\)"),
        ({"surfaces": {"top": [[0, 1, 2]]}}, r"surface top: faces of shape \(3,\)"),
    ],
)
def test_elements_and_faces_have_as_many_nodes_as_their_kind(parts, says):
    corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    with pytest.raises(ss.ModelError, match=says):
        ss.Mesh(corners, **parts)


def test_a_field_of_words_is_refused():
    with pytest.raises(ss.ModelError, match="are no numbers"):
        ss.Mesh([[0.0, 0.0, 0.0]]).field(["1.1"], ["a"])

"""Meshes of ANSYS: archives of CDWRITE, and what Workbench writes for its solver."""

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from archives import (
    COMPONENTS,
    ELEMENTS,
    HIGH,
    LOW,
    NODES,
    PLACES,
    TYPES,
    archive,
    brick,
    joint,
    read,
)


def deck(folder, nodes, cells, sets):
    """Read the same mesh as a deck of CalculiX; `cells` are type and nodes of each element."""
    lines = ["*NODE", *(f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in nodes.items())]
    for number, (kind, own) in enumerate(cells, 1):
        words = [*map(str, own)]
        lines += [f"*ELEMENT, TYPE={kind}", f"{number}, " + ", ".join(words[:10]) + ","]
        lines += [", ".join(words[10:])] if words[10:] else []
    for name, own in sets.items():
        lines += [f"*NSET, NSET={name}", *(f"{one}," for one in own)]
    path = folder / "joint.inp"
    path.write_text("\n".join([*lines, ""]))
    return ss.read_mesh(path)


@pytest.mark.parametrize(("integers", "reals"), [(9, "21.13e3"), (8, "20.13"), (8, "16.9")])
def test_an_archive_pairs_as_the_deck_of_the_same_mesh(tmp_path, integers, reals):
    mesh = read(tmp_path, joint(integers=integers, reals=reals))
    sets = {name: own for name, kind, own in COMPONENTS if kind == "NODE"}
    other = deck(tmp_path, NODES, [("C3D8", LOW), ("C3D8", HIGH)], sets)
    assert mesh.numbers.tolist() == other.numbers.tolist()
    np.testing.assert_array_equal(mesh.nodes, other.nodes)
    pairs = [ss.ContactInterface.from_surfaces(one, "PAD", one, "SEAT") for one in (mesh, other)]
    for name in ("first", "other", "areas", "normals", "gap"):
        np.testing.assert_array_equal(*(getattr(one, name) for one in pairs), err_msg=name)
    assert pairs[0].area == pytest.approx(6.0)
    assert pairs[0].dofs[:3] == ("21.1", "21.2", "21.3")
    # the contact elements lie on the same faces; they turn to the other body whatever their order
    contacts = mesh.surface("CONTACTS")
    assert contacts.areas == pytest.approx(pairs[0].areas)
    np.testing.assert_allclose(contacts.normals, pairs[0].normals, atol=1e-15)
    with pytest.raises(ss.ModelError, match="unknown surface or node set 'BODIES'"):
        mesh.surface("BODIES")


def test_units_and_numbers(tmp_path):
    mesh = read(tmp_path, joint(), units="t-mm-s")
    pair = ss.ContactInterface.from_surfaces(mesh, "PAD", mesh, "SEAT")
    assert pair.area == pytest.approx(6e-6)
    renumbered = ss.read_mesh(tmp_path / "joint.cdb", np.arange(101, 117))
    assert renumbered.surface("PAD").labels.tolist() == [109, 110, 111, 112]


SHAPES = {
    "tetra": ([0, 1, 2, 2, 4, 4, 4, 4], ("C3D4", "C3D10")),
    "wedge": ([0, 1, 2, 2, 4, 5, 6, 6], ("C3D6", "C3D15")),
    "hexahedron": ([*range(8)], ("C3D8", "C3D20R")),
    "pyramid": ([0, 1, 2, 3, 4, 4, 4, 4], None),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("middles", [False, True])
def test_bricks_whose_corners_coincide(tmp_path, shape, middles):
    corners, kinds = SHAPES[shape]
    nodes, own = brick(corners, middles)
    element = 186 if middles else 45
    text = archive(nodes, [(7, 1, own)], {1: element}, [("ALL", "NODE", [*nodes])])
    mesh = read(tmp_path, text)
    ((kind, cells),) = mesh.cells
    surface = mesh.surface("ALL")
    assert kind.startswith(shape)
    assert len(surface.labels) == len(nodes) == cells.shape[1]
    total = sum(vectors.sum(axis=(0, 1)) for _, _, vectors in surface._integrals)
    np.testing.assert_allclose(total, 0.0, atol=1e-12)
    if kinds:
        order = mesh.numbers[cells[0]].tolist()
        other = deck(tmp_path, nodes, [(kinds[middles], order)], {"ALL": [*nodes]})
        assert other.cells[0][0] == kind
        np.testing.assert_array_equal(surface.areas, other.surface("ALL").areas)
    else:
        arms = PLACES[:4] - PLACES[4]
        sides = np.linalg.norm(np.cross(arms, np.roll(arms, 1, axis=0)), axis=1) / 2
        assert surface.area == pytest.approx(6.0 + sides.sum())


def test_a_pyramid_covers_the_face_of_the_brick_below(tmp_path):
    nodes = NODES | {30: (1.0, 1.0, 3.0)}
    elements = [(20, 1, [*HIGH]), (21, 1, [25, 26, 27, 28, 30, 30, 30, 30])]
    mesh = read(tmp_path, archive(nodes, elements, {1: 185}, [("ALL", "NODE", [*HIGH, 30])]))
    faces = mesh.surface("ALL").faces
    assert [sum(len(one) for one in faces if one.shape[1] == size) for size in (3, 4)] == [4, 5]


@pytest.mark.parametrize(
    ("element", "own", "kind"),
    [
        (187, range(1, 11), "tetra10"),
        (187, range(1, 5), "tetra"),
        (285, range(1, 5), "tetra"),
        (186, range(1, 9), "hexahedron"),
        (181, (1, 2, 3, 4), "quad"),
        (181, (1, 2, 3, 3), "triangle"),
        (181, (1, 2, 3), "triangle"),
        (281, range(1, 9), "quad8"),
        (281, (1, 2, 3, 3, 5, 6, 3, 7), "triangle6"),
        (281, (1, 2, 3, 4), "quad"),
    ],
)
def test_kinds_of_elements(tmp_path, element, own, kind):
    places = np.random.default_rng(1).random((10, 3))
    nodes = {number: tuple(place) for number, place in enumerate(places.round(12).tolist(), 1)}
    mesh = read(tmp_path, archive(nodes, [(7, 3, [*own])], {3: element}))
    ((found, cells),) = mesh.cells
    assert found == kind
    assert mesh.numbers[cells[0]].tolist() == list(dict.fromkeys(own))
    np.testing.assert_allclose(mesh.nodes, places, atol=1e-12)


@pytest.mark.parametrize(
    "types",
    [
        "ET,2,SOLID185\nET, 3, CONTA173",
        "et,2,185,,,1\net,3,173",
        "*SET,TID ,  2.000000000000    \nET,tid,185\nET,3,173",
        "ETBLOCK,        3,        2\n(2i9,19a9)\n        2      185        0\n"
        "        3      173        0        0        0\n       -1",
    ],
)
def test_types_of_elements(tmp_path, types):
    text = joint().replace("ET,        2,185\nET,        3,173", types)
    assert types in text
    mesh = read(tmp_path, text)
    assert [(kind, len(own)) for kind, own in mesh.cells] == [("hexahedron", 2)]
    assert mesh.surface("CONTACTS").area == pytest.approx(6.0)
    if types.startswith("ETBLOCK"):
        with pytest.raises(ss.ModelError, match="3 types announced, 2 present"):
            read(tmp_path, text.replace("        3,        2", "        3,        3"))


def test_other_elements_are_left_out(tmp_path):
    """Springs and surface effects, with their node away from the surface, change no area."""
    nodes = NODES | {40: (9.0, 9.0, 9.0)}
    elements = [*ELEMENTS, (41, 4, [5, 21]), (42, 5, [25, 26, 27, 28, 40])]
    parts = [*COMPONENTS, ("TOP", "ELEM", [42]), ("BOTH", "ELEM", [41, 42])]
    text = archive(nodes, elements, {**TYPES, 4: 14, 5: 152}, parts)
    mesh = read(tmp_path, text)
    assert [(kind, len(own)) for kind, own in mesh.cells] == [("hexahedron", 2)]
    assert mesh.surface("PAD").area == pytest.approx(6.0)
    assert mesh.surface("TOP").points[:, 2].tolist() == [2.0] * 4
    assert "BOTH" not in mesh.surfaces


def test_a_shell_on_a_solid_does_not_count_twice(tmp_path):
    skin = [(50, 6, [24, 23, 22, 21]), (51, 6, [1, 2, 3, 4])]
    text = joint(elements=[*ELEMENTS[:2], *skin], types={2: 185, 6: 181}, components=COMPONENTS[:2])
    mesh = read(tmp_path, text)
    assert dict(mesh.cells).keys() == {"hexahedron", "quad"}
    assert mesh.surface("PAD").area == pytest.approx(6.0)


def test_rotated_nodes_are_refused_where_directions_count(tmp_path):
    mesh = read(tmp_path, joint(angles={26: (30.0, 0.0, 0.0), 22: (0.0, -5.0, 0.0)}))
    assert mesh.numbers[mesh.rotated].tolist() == [22, 26]
    assert mesh.surface("SEAT").area == pytest.approx(6.0)
    assert mesh.dof_at([0, 0, 2], 3) == "25.3"
    for call, number in (
        (lambda: mesh.surface("PAD"), 22),
        (lambda: mesh.surface("CONTACTS"), 22),
        (lambda: mesh.dof_at([2, 0, 2], 1), 26),
        (lambda: mesh.field(["21.1", "22.1"], [1.0, 2.0]), 22),
    ):
        with pytest.raises(ss.ModelError, match=f"node {number} has directions of its own"):
            call()


def workbench(joined=True):
    """Return what Workbench writes for its solver."""
    ends = "" if joined else ",,16"
    nodes = "".join(
        f"{number:9d}" + "".join(f"{one:19.9e}".replace("e+", "e+0") for one in place) + "\n"
        for number, place in NODES.items()
    )
    solids = "".join(
        "".join(f"{one:9d}" for one in (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, number, *own)) + "\n"
        for number, _, own in ELEMENTS[:2]
    )
    contacts = "".join(f"{one:9d}" for one in (31, 3, 3, 3, 0, 24, 23, 22, 21)) + "\n"
    return (
        "/batch\n/com,*********** Nodes for the whole assembly ***********\n"
        f"nblock,3{ends}\n(1i9,3e20.9e3)\n{nodes}-1\n"
        f"et,1,185\neblock,19,solid,,2\n(19i9)\n{solids}-1\n"
        f"*set,cid,3\n*set,tid,4\net,cid,174\net,tid,170\neblock,10,,,1\n(15i9)\n{contacts}-1\n"
        "n,99,1.,2.,3.   ! pilot\ntype,tid\nen,100,99\n"
        "CMBLOCK,PAD,NODE,        2\n(8i10)\n        21       -24\n"
        "CMBLOCK,FACES,ELEM,       1\n(8i10)\n        31\n"
    )


@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("name", ["ds.dat", "ds.inp", "ds.cdb"])
def test_what_workbench_writes(tmp_path, joined, end, name):
    mesh = read(tmp_path, workbench(joined).replace("\n", end), name)
    assert mesh.numbers.tolist() == [*NODES]
    np.testing.assert_array_equal(mesh.nodes, [*NODES.values()])
    assert mesh.surface("PAD").areas.tolist() == mesh.surface("FACES").areas.tolist()


def test_bricks_of_20_nodes_without_their_count(tmp_path):
    nodes, own = brick(range(8), True)
    body = archive(nodes, [(7, 1, own)], {1: 95}, [("ALL", "NODE", [*nodes])])
    head, _, rest = body.partition("EBLOCK,")
    lines = [
        "".join(f"{one:10d}" for one in part) for part in ([7, 1, 1, 1, 0, *own[:10]], own[10:])
    ]
    block = "EBLOCK,10,,,1\n(15i10)\n" + "\n".join(lines)
    whole = read(tmp_path, body)
    short = read(tmp_path, head + block + "\n        -1\n" + rest.partition("        -1\n")[2])
    np.testing.assert_array_equal(whole.cells[0][1], short.cells[0][1])


def test_elements_between_linear_and_quadratic_ones(tmp_path):
    nodes, own = brick(range(8), True)
    own[8] = 0
    text = archive(nodes, [(7, 1, own)], {1: 186}, [("ALL", "NODE", [*nodes])])
    with pytest.raises(ss.ModelError, match="element 7, at the outside, has some midside nodes"):
        read(tmp_path, text)
    # a tetrahedron with all its neighbours is inside
    hull = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    nodes = {at: tuple(one) for at, one in enumerate([*hull.tolist(), *(-3 * hull).tolist()], 1)}
    nodes[9] = (0.0, 0.0, 1.0)
    around = [(at, 1, [*({1, 2, 3, 4} - {at}), 4 + at]) for at in range(1, 5)]
    inner = (7, 2, [1, 2, 3, 4, 9, 0, 0, 0, 0, 0])
    mesh = read(tmp_path, archive(nodes, [*around, inner], {1: 285, 2: 187}))
    assert [(kind, len(own)) for kind, own in mesh.cells] == [("tetra", 5)]


@pytest.mark.parametrize("name", ["HexBeam.cdb", "TetBeam.cdb", "sector.cdb"])
def test_archives_of_ansys_as_its_reader_reads_them(name):
    reader = pytest.importorskip("ansys.mapdl.reader", reason="pip install 'stickslip[ansys]'")
    file = Path(reader.__file__).parent / "examples" / name
    theirs, mesh = reader.Archive(str(file), parse_vtk=False), ss.read_mesh(file)
    order = np.argsort(mesh.numbers)
    np.testing.assert_array_equal(mesh.numbers[order], theirs.nnum)
    # theirs is a unit of the last digit off
    np.testing.assert_allclose(mesh.nodes[order], theirs.nodes, rtol=1e-15, atol=1e-15)
    assert sum(len(own) for _, own in mesh.cells) == len(theirs.elem)
    assert mesh.node_sets.keys() == theirs.node_components.keys()
    for part, members in theirs.node_components.items():
        assert sorted(mesh.numbers[mesh.node_sets[part]]) == sorted(members)


def test_lines_of_numbers_that_belong_to_other_commands_are_passed_over(tmp_path):
    others = (
        "RLBLOCK,       1,       1,       8,       7\n(2i8,6g16.9)\n(7g16.9)\n"
        "       1       2  0.00000000      1.00000000\n\nMPTEMP,R5.0, 1, 1,  0.0,\n"
        "MPDATA,R5.0, 1,EX  ,     1, 1,  2.0E+11,\nSECBLOCK,1\n 0.1, 1, 0., 3\n"
        "*VWRITE,A(1)\n(F8.3)\n*PREAD,B,2\n 1.5 2.5\nEND PREAD\n"
        "*CREATE,a,txt\n1.5\t2\n*END\n! 3 4\n-1\n"
    )
    text = joint().replace("EXTOPT", others + "EXTOPT").replace("NBLOCK", others + "NBLOCK")
    mesh, whole = read(tmp_path, text), read(tmp_path, joint(), "whole.cdb")
    assert mesh.node_sets.keys() == whole.node_sets.keys()
    np.testing.assert_array_equal(mesh.cells[0][1], whole.cells[0][1])


def test_commands_share_lines_and_are_known_by_four_letters(tmp_path):
    whole = joint()
    text = whole.replace("ET,        2,185", "ET,2,SOLID185 $ KEYOPT,2,2,3").replace(
        "BLOCK,", "BLO,"
    )
    text = text.replace("NBLO,", "NBLOC,").replace("CMBLO,", "cmblock,")
    # neither texts nor parameters nor commands of results change nodes
    texts = "/TITLE, pads $ move\n/COM, lift $ N,R5.3\nMOVE_X=3\nFILL(2,1)=4\n! $ NROTAT\n"
    text = text.replace("/GO", f"{texts}FILLDATA,2,1,9 $ /GO")
    for name in ("joint.cdb", "joint.dat"):
        mesh, other = read(tmp_path, text, name), read(tmp_path, whole, "whole.cdb")
        np.testing.assert_array_equal(mesh.nodes, other.nodes)
        np.testing.assert_array_equal(mesh.cells[0][1], other.cells[0][1])
        assert mesh.node_sets.keys() == other.node_sets.keys()

"""Decks as programs write them in other ways that their manuals allow."""

import os

import numpy as np
import pytest

import stickslip as ss
from decks import DECK, deck

AREAS = {"SEAT": 6.0, "PAD": 6.0, "FEET": 6.0, "ENDS": 12.0, "POINTS": 6.0}


def found(mesh):
    kinds = {kind: len(own) for kind, own in mesh.cells}
    names = sorted({*mesh.surfaces, *mesh.node_sets} - {"ALL"})
    return [len(mesh.nodes), kinds, {name: mesh.surface(name).area for name in names}]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        # a blank coordinate is 0, and does not shift the next ones
        (" 5, 0,0,1", " 5, ,,1"),
        (" 8, 0,3,1", " 8,\t0.D0, .3+1 ,1.0d+00,"),
        ("*ELEMENT, TYPE=C3D8, ELSET=LOW", "*ELEMENT, TYPE=C3D8,\n ELSET = LOW"),
        ("*NSET, NSET=FEET, GENERATE", "*NSET, NSET=FEET,\nGENERATE"),
        ("1, 4\n", "1, 4, 1,\n"),
        ("*NSET, NSET=ENDS", '*NSET, UNSORTED, NSET="Ends"'),
        ("type=C3D8R", "TYPE=SC8R"),
        ("type=C3D8R", "TYPE=CSS8"),
        ("31, 32, 33, 34\n*STEP", "31, 1.0\n32, 1.\n33\n34,\n*STEP"),
        ("20, S1", "HIGH, S1"),
        ("*STEP\n", "*SYSTEM\n*STEP\n"),
        # a surface of the nodes of the set that has its name
        ("*STEP\n", "*SURFACE, TYPE=NODE, NAME=FEET\nFEET\n*STEP\n"),
        ("\n", "\r\n"),
        ("\n", "\n** a comment\n"),
    ],
)
def test_other_forms_of_the_same(tmp_path, old, new):
    assert old in DECK
    nodes, kinds, areas = found(ss.read_mesh(deck(tmp_path, DECK.replace(old, new))))
    assert (nodes, kinds) == (16, {"hexahedron": 2})
    assert areas == pytest.approx(AREAS)


def test_rows_in_files_of_their_own(tmp_path):
    head, _, rest = DECK.partition("*NODE, NSET=ALL\n")
    rows, _, rest = rest.partition("*ELEMENT")
    (tmp_path / "Nodes.txt").write_text(rows)
    (tmp_path / "sets.inp").write_text("*NSET, NSET=LOWER, ELSET=LOW\n")
    text = f"{head}*NODE, NSET=ALL, INPUT=Nodes.txt\n*ELEMENT{rest}".replace(
        "*STEP", "*INCLUDE, INPUT='sets.inp'\n*STEP"
    )
    mesh = ss.read_mesh(deck(tmp_path, text))
    assert len(mesh.node_sets["ALL"]) == 16
    assert mesh.numbers[mesh.node_sets["LOWER"]].tolist() == [*range(1, 9)]
    (tmp_path / "upper, sets.inp").write_text("*NSET, NSET=UPPER, ELSET=HIGH\n")
    others = '*INCLUDE, PASSWORD=x, INPUT="upper, sets.inp"\n*include, input = sets.inp\n*STEP'
    both = ss.read_mesh(deck(tmp_path, text.replace("*STEP", others)))
    assert len(both.node_sets["UPPER"]) == len(both.node_sets["LOWER"]) == 8
    (tmp_path / "sets.inp").unlink()
    with pytest.raises(ss.ModelError, match=r"no file sets\.inp, which it includes"):
        ss.read_mesh(tmp_path / "joint.inp")
    os.mkfifo(tmp_path / "sets.inp")
    with pytest.raises(ss.ModelError, match=r"no file sets\.inp, which it includes"):
        ss.read_mesh(tmp_path / "joint.inp")


def test_solids_without_a_face_are_their_outside(tmp_path):
    mesh = ss.read_mesh(deck(tmp_path, DECK.replace("LOW, S2", "LOW")))
    assert mesh.surface("SEAT").area == pytest.approx(22.0)
    # one body: the face between two elements is none
    text = DECK.replace("21,22,23,24,31", "5,6,7,8,31").replace("LOW, S2", "LOW")
    mesh = ss.read_mesh(deck(tmp_path, text))
    assert mesh.surface("SEAT").area == pytest.approx(16.0)


def test_pyramids_and_triangles(tmp_path):
    more = "*ELEMENT, TYPE=C3D5\n40, 31,32,33,34,41\n*ELEMENT, TYPE=STRI3\n50, 1, 2, 41\n"
    text = DECK.replace("*ELEMENT, TYPE=C3D8,", f" 41, 1,1.5,4\n{more}*ELEMENT, TYPE=C3D8,", 1)
    text = text.replace("20, S1", "40, S1").replace(
        "POINTS, TYPE=NODE", "TOP\n40, S2\n*NSET, NSET=P"
    )
    mesh = ss.read_mesh(deck(tmp_path, text))
    assert {kind: len(own) for kind, own in mesh.cells} == {
        **{"pyramid": 1, "triangle": 1, "hexahedron": 2}
    }
    assert mesh.surface("PAD").normals[:, 2] == pytest.approx(-1.0)
    assert [one.shape for one in mesh.surface("TOP").faces] == [(1, 3)]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("*STEP", "*NGEN\n1, 4, 1\n*STEP", "*NGEN: write all nodes, elements"),
        ("*STEP", "*ELGEN\n10, 2, 4, 1\n*STEP", "*ELGEN: write all nodes"),
        ("*STEP", "*NCOPY, OLD SET=ALL, CHANGE NUMBER=100, SHIFT\n0,0,5\n*STEP", "*NCOPY"),
        ("*NODE,", "*SYSTEM\n1., 0., 0.\n*NODE,", "*SYSTEM: write"),
        ("type=C3D8R", "type=C3D27", "TYPE=C3D27: solids that are not known here"),
        ("1, 4\n", "4, 1\n", "[4, 1] is no range"),
        ("31, 32, 33, 34\n*STEP", "31, 1\n*STEP", "is 1 a node? give one a line"),
        ("*STEP", "*NSET, NSET=X, ELSET=LOV\n*STEP", "unknown ELSET 'LOV'"),
        ("*STEP", "*NSET, NSET=X, ELSET=SPRINGS\n*STEP", "unknown ELSET"),
        ("*STEP", "*ELSET, ELSET=S\n30,\n*NSET, NSET=X, ELSET=S\n*STEP", "element 30 has no faces"),
        ("*STEP", "*INCLUDE,\nINPUT=sets.inp\n*STEP", "*INCLUDE: INPUT= is missing; write it on"),
        ("*STEP", "*SURFACE, TYPE=NODE, NAME=FEET\nALL\n*STEP", "the set FEET has other nodes"),
        (
            "*NSET, NSET=FEET",
            "*SURFACE, TYPE=NODE, NAME=FEET\nALL\n*NSET, NSET=FEET",
            "surface FEET: the set FEET has other nodes; rename one",
        ),
        ("*STEP", "*TRANSFORM, NSET=FEAT\n0,0,0,0,0,1\n*STEP", "unknown set 'FEAT'"),
    ],
)
def test_what_would_be_lost_is_refused(tmp_path, old, new, says):
    assert old in DECK
    with pytest.raises(ss.ModelError, match=r"joint\.inp") as error:
        ss.read_mesh(deck(tmp_path, DECK.replace(old, new)))
    assert says in str(error.value)


def test_directions_of_transformed_nodes_are_not_x_y_z(tmp_path):
    text = DECK.replace("*STEP", "*TRANSFORM, NSET=FEET, TYPE=C\n0,0,0, 0,0,1\n*STEP")
    mesh = ss.read_mesh(deck(tmp_path, text))
    assert mesh.surface("SEAT").area == pytest.approx(6.0)
    with pytest.raises(ss.ModelError, match="node 1 has directions of its own"):
        mesh.surface("FEET")


@pytest.mark.parametrize("other", ["C3D8", "C3D6"])
def test_bricks_whose_corners_coincide(tmp_path, other):
    """Two wedges make a cube; one of them, or both, are bricks with an edge of no length."""
    lines = ["*NODE"]
    lines += [f"{1 + at}, {at % 2}., {at // 2 % 2}., {at // 4}." for at in range(8)]
    second = "2, 2,4,3,3, 6,8,7,7" if other == "C3D8" else "2, 2,4,3, 6,8,7"
    lines += ["*ELEMENT, TYPE=C3D8", "1, 1,2,3,3, 5,6,7,7", f"*ELEMENT, TYPE={other}", second]
    lines += ["*NSET, NSET=ALL, GENERATE", "1, 8", "*NSET, NSET=TOP, GENERATE", "5, 8"]
    mesh = ss.read_mesh(deck(tmp_path, "\n".join([*lines, ""])))
    assert mesh.surface("ALL").area == pytest.approx(6.0)
    top = mesh.surface("TOP")
    assert top.areas == pytest.approx([1 / 6, 1 / 3, 1 / 3, 1 / 6])
    assert top.normals[:, 2] == pytest.approx(1.0)
    assert top.shortest_edge == 1.0


def test_solids_whose_faces_are_not_known_are_refused():
    mesh = ss.Mesh(np.random.default_rng(2).random((27, 3)), [("hexahedron27", [[*range(27)]])])
    with pytest.raises(ss.ModelError, match="faces of hexahedron27 are not known"):
        mesh.surface(np.ones(27, dtype=bool))


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_names_are_read_in_either_encoding(tmp_path, encoding):
    path = tmp_path / "seat.inp"
    path.write_bytes(DECK.replace("FEET", "FÜSSE").encode(encoding))
    assert "FÜSSE" in ss.read_mesh(path).node_sets


def test_surfaces_made_of_others_are_refused_by_name(tmp_path):
    text = DECK.replace("*STEP", "*SURFACE, NAME=BOTH, COMBINE=UNION\nSEAT, SEAT\n*STEP")
    with pytest.raises(ss.ModelError, match="surface BOTH: COMBINE is not read"):
        ss.read_mesh(deck(tmp_path, text))


@pytest.mark.parametrize(
    ("line", "name"), [("*INCLUDE, INPUT={}\n", "d{}.inp"), ("INCLUDE {}\n", "d{}.bdf")]
)
def test_few_files_that_include_each_other_many_times_are_refused(tmp_path, line, name):
    for number in range(6):
        (tmp_path / name.format(number)).write_text(20 * line.format(name.format(number + 1)))
    (tmp_path / name.format(6)).write_text("")
    with pytest.raises(ss.ModelError, match="it includes more than 1000 files; join some") as error:
        ss.read_mesh(tmp_path / name.format(0))
    assert "\n" not in str(error.value)
    (tmp_path / name.format(3)).write_text("")
    with pytest.raises(ss.ModelError, match="more than 1000 files"):
        ss.read_mesh(tmp_path / name.format(0))
    (tmp_path / name.format(2)).write_text("")
    with pytest.raises(ss.ModelError) as error:
        ss.read_mesh(tmp_path / name.format(0))
    assert "includes" not in str(error.value)

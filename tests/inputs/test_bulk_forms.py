"""Bulk data of Nastran as programs write it in other ways that its manual allows."""

import os

import numpy as np
import pytest

import stickslip as ss
from archives import archive, brick
from decks import bulk_data

SOUND = bulk_data(False)
GRID = "GRID          22           2.000   0.000   1.000"
CHEXA = f"CHEXA{10:11d}" + "".join(f"{one:8d}" for one in (1, *range(11, 17))) + "+\n"
CHEXA += f"+{17:15d}{18:8d}"


def read(folder, text, name="joint.bdf"):
    (folder / name).write_text(text)
    return ss.read_mesh(folder / name)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (GRID, "GRID,22,,2.,0.,1."),
        (GRID, "grid, 22, 0, 2.0D0, .0, 10.d-1, 0"),
        (GRID, "GRID,22,,2.+0,0.,1.-0 $ bare exponents"),
        (GRID, "GRID\t22\t\t2.\t0.\t1."),
        (GRID, "GRID*,22,,2.,0.\n*,1."),
        (GRID, f"GRID*{22:19d}{'':16}{2.0:16.9E}{0.0:16.9E}*A\n*A{1.0:22.9E}"),
        # blank coordinates are 0
        (GRID, f"GRID{22:12d}{'':8}{2.0:8.3f}{'':8}{1.0:8.3f}"),
        (GRID, f"{GRID}\n{GRID}"),
        (CHEXA, CHEXA.replace("+\n+ ", "\n  ")),
        (CHEXA, CHEXA.replace("+\n+ ", "+E1\n+E1").replace("+E1  ", "+E1")),
        (CHEXA, "CHEXA,10,1,11,12,13,14,15,16,\n,17,18"),
        (CHEXA, "chexa,10,1,11,12,13,14,15,16,+a\n+a,17,18"),
        (CHEXA, "CHEXA*,10,1,11,12\n*,13,14,15,16\n*,17,18"),
        ("ENDDATA\n", "PSOLID,1,1\nRBE2,92,21,123,22,23\nENDDATA\nGRID,77,,1.,1.,1.\n"),
        ("ENDDATA\n", "CQUAD4,90,1,21,22,23,24\n"),
        # marks at the ends of lines that nothing continues, and of others that are read over
        (GRID, "GRID,22,,2.,0.,1.,,,,+7\nPLOAD4,1,2,,,,,,,+7\n+7,1"),
        ("\n", "\r\n"),
        ("BEGIN BULK", "TITLE = a, b\nSET 1 = 5 THRU 7,\n 9\nbegin bulk\nGRDSET,,0,,,,0"),
        ("THRU", "thru"),
    ],
)
@pytest.mark.parametrize("name", ["joint.bdf", "joint.dat"])
def test_other_forms_of_the_same(tmp_path, old, new, name):
    assert old in SOUND
    whole, mesh = read(tmp_path, SOUND), read(tmp_path, SOUND.replace(old, new), name)
    assert mesh.numbers.tolist() == whole.numbers.tolist()
    np.testing.assert_array_equal(mesh.nodes, whole.nodes)
    np.testing.assert_array_equal(mesh.cells[0][1], whole.cells[0][1])
    pair = ss.ContactInterface.from_surfaces(mesh, "SET1 1", mesh, "SET1 2")
    assert pair.area == pytest.approx(6.0)


def test_wide_fields_on_one_line(tmp_path):
    text = SOUND.replace("BEGIN BULK", "BEGIN BULK\nGRDSET*,,0")
    text = text.replace(GRID, f"GRID*{22:19d}{'':16}{2.0:16.9E}{0.5:16.9E}")
    mesh = read(tmp_path, text)
    assert mesh.nodes[mesh.numbers == 22].tolist() == [[2.0, 0.5, 0.0]]
    assert len(mesh.nodes) == 16


def test_included_files(tmp_path):
    head, _, rest = SOUND.partition("GRID          21")
    (tmp_path / "upper, part.inc").write_text(f"GRID          21{rest}")
    mesh = read(tmp_path, f"{head}INCLUDE 'upper, part.inc'\n{rest[rest.index('$ bet') :]}")
    assert len(mesh.nodes) == 16
    (tmp_path / "upper, part.inc").write_text("GRID,x\n")
    with pytest.raises(ss.ModelError, match=r"upper, part\.inc line 1: 'x' stands"):
        ss.read_mesh(tmp_path / "joint.bdf")
    (tmp_path / "upper, part.inc").unlink()
    with pytest.raises(ss.ModelError, match=r"there is no file upper, part\.inc"):
        ss.read_mesh(tmp_path / "joint.bdf")
    os.mkfifo(tmp_path / "upper, part.inc")
    with pytest.raises(ss.ModelError, match=r"joint\.bdf"):
        ss.read_mesh(tmp_path / "joint.bdf")
    with pytest.raises(ss.ModelError, match="include each other"):
        read(tmp_path, "INCLUDE joint.bdf\n")
    with pytest.raises(ss.ModelError, match="is no name of a file on one line"):
        read(tmp_path, "INCLUDE 'joint\nGRID,1\n")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("BEGIN BULK", "BEGIN BULK\nGRDSET,,5", "GRID 11: its coordinates are those of system 5"),
        (GRID, "GRID,22,,2.,0.,7.\n" + GRID, "line 16: GRID 22 is given twice"),
        (CHEXA, f"{CHEXA}\n{CHEXA}", "CHEXA 10: an element of this number is given twice"),
        (CHEXA, CHEXA.replace("+\n+ ", "+A\n+B"), "'+B' does not continue '+A'"),
        (CHEXA, "CHEXA,10,1,11,12,13,14,15,16", "CHEXA 10 has not 8 corners"),
        (CHEXA, "CHEXA,10,1,11,12,13,14,15,16\n,17,19", "element 10: there is no node 19"),
        (CHEXA, "CHEXA,10,1,11,12,13,14,15,16\n,17,17", "element 10: corners coincide"),
        (CHEXA, "CTETRA,10,1,11,12,13,15,16,17\n,18,14,21,22,23,24,25", "CTETRA 10 has more than"),
        (CHEXA, CHEXA.partition("\n")[2], "GRID 18 goes on over a second line; a card is missing"),
        (
            "ENDDATA",
            "SET1,7,1,2,3,4,5,6,7,+S1\nPSOLID,1,1\n+S1,11\nENDDATA",
            "'+S1' continues line 29; write it there",
        ),
        ("ENDDATA", "CTETRA,5,1,21,22,23,25,11\nENDDATA", "5, at the outside, has some midside"),
    ],
)
def test_what_would_be_wrong_is_refused(tmp_path, old, new, says):
    assert old in SOUND
    with pytest.raises(ss.ModelError, match=r"joint\.bdf") as error:
        read(tmp_path, SOUND.replace(old, new))
    assert says in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("card", ["CPYRAM", "CPYRA"])
def test_pyramids_of_nastran_and_optistruct(tmp_path, card):
    top = f"GRID,41,,1.,1.5,3.\n{card},40,1,25,26,27,28,41\nENDDATA"
    mesh = read(tmp_path, SOUND.replace("ENDDATA", top), "joint.fem")
    assert [kind for kind, _ in mesh.cells] == ["hexahedron", "pyramid"]


@pytest.mark.parametrize("default", [False, True])
def test_displacements_along_directions_of_their_own_are_refused(tmp_path, default):
    text = SOUND.replace(GRID, "GRID,22,,2.,0.,1.,5")
    if default:
        text = SOUND.replace("BEGIN BULK", "BEGIN BULK\nGRDSET,,,,,,5")
    mesh = read(tmp_path, text)
    with pytest.raises(ss.ModelError, match=r"node 2[12] has directions of its own"):
        ss.ContactInterface.from_surfaces(mesh, "SET1 2")


@pytest.mark.parametrize(
    ("card", "corners"),
    [
        ("CTETRA", [0, 1, 2, 2, 4, 4, 4, 4]),
        ("CPENTA", [0, 1, 2, 2, 4, 5, 6, 6]),
        ("CPYRAM", [0, 1, 2, 3, 4, 4, 4, 4]),
        ("CHEXA", range(8)),
    ],
)
def test_nodes_between_corners_are_those_of_the_same_element_of_ansys(tmp_path, card, corners):
    nodes, own = brick(corners, True)
    (tmp_path / "one.cdb").write_text(archive(nodes, [(7, 1, own)], {1: 186}))
    other = ss.read_mesh(tmp_path / "one.cdb")
    # the corners, the edges below, those upright, those above
    order = [*range(8), *range(8, 12), *range(16, 20), *range(12, 16)]
    ends = {number: tuple(place) for number, place in nodes.items()}
    kept = [number for number in dict.fromkeys(own[at] for at in order) if number in ends]
    lines = [f"GRID,{number},,{x!r},{y!r},{z!r}" for number, (x, y, z) in ends.items()]
    words = [card, "7", "1", *map(str, kept)]
    rows = [words[:9], *(["", *words[at : at + 8]] for at in range(9, len(words), 8))]
    mesh = read(tmp_path, "\n".join([*lines, *map(",".join, rows), ""]))
    assert [kind for kind, _ in mesh.cells] == [kind for kind, _ in other.cells]
    np.testing.assert_array_equal(mesh.cells[0][1], other.cells[0][1])


def test_a_node_that_a_set_names_twice_is_one(tmp_path):
    sets = read(tmp_path, SOUND).node_sets
    twice = read(tmp_path, SOUND.replace("SET1,1,", "SET1,1,16,15,")).node_sets
    assert sorted(twice["SET1 1"]) == sorted(sets["SET1 1"])


def test_fields_between_blanks_are_refused(tmp_path):
    with pytest.raises(ss.ModelError, match="fields of CTETRA are separated by blanks"):
        read(tmp_path, SOUND.replace("SET1,1,", "CTETRA 99 1 1 2 3 4\nSET1,1,"))

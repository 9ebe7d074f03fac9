"""Archives of ANSYS with damage: refused in one line, or as many nodes and elements as they say."""

import random
import re

import numpy as np
import pytest

import stickslip as ss
from archives import joint, read
from mutations import mutated

CHANGES = [
    (
        "NBLOCK,6,SOLID,        28,        16",
        "NBLOCK,6,SOLID,        28,        17",
        "17 nodes announced",
    ),
    (
        "NBLOCK,6,SOLID,        28,        16",
        "NBLOCK,6,SOLID,        27,        16",
        "line 31: node 28 is above 27",
    ),
    (
        "EBLOCK,19,SOLID,        31,         3",
        "EBLOCK,19,SOLID,        31,         4",
        "4 elements announced",
    ),
    ("EBLOCK,19,SOLID,        31,         3", "EBLOCK,19,SOLID,        x", "'x' stands where"),
    (
        "SEAT    ,NODE,       2",
        "SEAT    ,NODE,       3",
        "component SEAT: 3 numbers announced, 2 present",
    ),
    ("SEAT    ,NODE,       2", "SEAT    ,NODES", "'' stands where a whole number must be"),
    ("SEAT    ,NODE", "SEAT    ,LINE", "neither of nodes nor of elements"),
    ("         5        -8", "        -8         5", "-8 ends no range"),
    ("         5        -8", "         5-999999999", "component SEAT: there is no node 9"),
    ("(8i10)", "8i10", "'8i10' is no format"),
    ("(19i10)", "(19i0)", "no format"),
    ("(19i10)", "(9i10)", "the format is none of elements"),
    ("(3i9,6e21.13e3)", "(3i9)", "the format is none of nodes"),
    ("(3i9,6e21.13e3)", "(3i9,6e20.13)", "line"),
    ("       28        0        0", "       27        0        0", "node 27 is given twice"),
    ("ET,        2,185", "ET,        4,185", "element 10: no ET says what type 2 is"),
    ("ET,        2,185", "ET,        2,187", "element 10, at the outside, has some midside nodes"),
    (
        "         8         0        10",
        "         9         0        10",
        "element 10 does not have the 9 nodes",
    ),
    (
        "         8         0        10",
        "       999         0        10",
        "element 10 has 999 nodes",
    ),
    (
        "         8         0        20",
        "         8         0        10",
        "element 10 is given twice",
    ),
    ("        27        28\n", "        27        29\n", "element 20: there is no node 29"),
    ("        27        28\n", "        25        25\n", "element 20: corners coincide as in no"),
    ("2.0000000000000E+000\n", "2.0000000000000E+0\n", "is cut short"),
    ("2.0000000000000E+000\n", "2.0000000000000Q+000\n", "is no real number"),
    ("NBLOCK", "NBLICK", "line 15: '(3i9,6e21.13e3)' stands outside of a block"),
    (
        "N,R5.3,LOC,       -1,",
        "N,R5.3,LOC,       99,1.,2.,3.",
        "N: one by one; write it with CDWRITE",
    ),
    ("EXTOPT,ATTR,", "NROTAT,ALL", "NROTAT changes nodes or elements; write it"),
    ("EXTOPT,ATTR,", "nrot,all", "NROT changes nodes or elements"),
    ("EXTOPT,ATTR,", "CSYS,5 $ NROTAT,ALL", "NROTAT changes nodes or elements"),
    ("EXTOPT,ATTR,", "UPGEOM,1,1,1,file,rst", "UPGEOM changes nodes or elements"),
    ("EXTOPT,ATTR,", "nummrg,node", "NUMMRG changes nodes or elements"),
    ("EXTOPT,ATTR,", "TYPE,2\nE,1,2,3,4,5,6,7,8", "E: elements one by one"),
]


@pytest.mark.parametrize(("old", "new", "says"), CHANGES)
def test_a_damaged_archive_is_refused_in_one_line(tmp_path, old, new, says):
    text = joint()
    assert old in text
    with pytest.raises(ss.ModelError, match=r"joint\.cdb") as error:
        read(tmp_path, text.replace(old, new))
    assert says in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("/PREP7\nN,R5.3,LOC, 1, 0, 0, 0.5, 0.5, 0.5\n", "line 2: N: one by one"),
        ("/PREP7\nEN,R5.5,ATTR, 8, 1, 1\n", "line 2: EN: one by one"),
        ("/DECRYPT,ab\nx%&/\n", "it is encrypted; write it with CDWRITE"),
        ("", "it has no NBLOCK; write it with CDWRITE"),
        ("NBLOCK,6,SOLID,1,1", "line 1: the file ends inside a block"),
        ("NBLOCK,6,SOLID\n(3i9,6e21.13e3)\n        1        0        0\n", "does not end"),
    ],
)
def test_archives_in_other_forms_are_refused(tmp_path, text, says):
    with pytest.raises(ss.ModelError) as error:
        read(tmp_path, text)
    assert says in str(error.value)


def test_who_may_have_made_a_node_that_is_missing_is_said(tmp_path):
    text = joint().replace("         5        -8", "         5        -9")
    with pytest.raises(ss.ModelError, match="before CDWRITE, or it was made by N;"):
        read(tmp_path, text)


def test_ranges_without_end_take_no_room(tmp_path):
    long = "CMBLOCK,ALL     ,NODE,       2\n(8i10)\n         1-999999999\n"
    for block in (long, long.replace("NODE", "ELEM")):
        with pytest.raises(ss.ModelError, match=r"component ALL: there is no \w+ \d"):
            read(tmp_path, joint() + block)


def test_components_without_head_or_twice_and_elements_without_end_are_refused(tmp_path):
    text = joint()
    blocks = re.findall(r"CMBLOCK[^\n]*\n\(8i10\)\n[^C]*?\n(?=CM|EX)", text)
    assert len(blocks) == 4
    head, _, numbers = blocks[0].partition("\n")
    stray = text.replace(head + "\n", "")
    end = text.index("        -1\nCMBLOCK")
    for damaged, says in (
        (stray, "'(8i10)' stands outside of a block; the line before is lost"),
        (stray.replace("-1\n(8", "-1\n\n/COM, parts\n! here\n(8"), "stands outside of a block"),
        (stray.replace(numbers, numbers.partition("\n")[2]), "stands outside of a block"),
        (text.replace("EXTOPT,", "MP,EX,1,2E11\n 5 6\nEXTOPT,"), "'5 6' stands outside of a block"),
        (text[:end], "the block of elements does not end"),
        (text.replace("        -1\nCMBLOCK", "CMBLOCK"), "the block of elements does not end"),
        *((text.replace(one, one + one), "is given twice") for one in blocks),
        (text + blocks[1].lower(), "component PAD is given twice"),
    ):
        assert damaged != text
        with pytest.raises(ss.ModelError, match=r"joint\.cdb") as error:
            read(tmp_path, damaged)
        assert says in str(error.value)
        assert "\n" not in str(error.value)


def same(mesh, other):
    """Return whether two meshes have the same nodes, cells and parts."""
    if [kind for kind, _ in mesh.cells] != [kind for kind, _ in other.cells]:
        return False
    parts = [
        (one.numbers, one.nodes, one.rotated, *(own for _, own in one.cells))
        for one in (mesh, other)
    ]
    return all(map(np.array_equal, *parts))


def test_a_line_of_a_block_lost_or_twice_is_refused(tmp_path):
    lines = joint().splitlines(keepends=True)
    whole = read(tmp_path, joint())
    first, last = (
        next(at for at, line in enumerate(lines) if line.startswith(name))
        for name in ("NBLOCK", "EXTOPT")
    )
    refused = 0
    for at in range(first, last):
        for damaged in (lines[: at + 1] + lines[at:], lines[:at] + lines[at + 1 :]):
            try:
                mesh = read(tmp_path, "".join(damaged))
            except ss.ModelError:
                refused += 1
                continue
            assert same(mesh, whole), lines[at]
            assert whole.surfaces.keys() == mesh.surfaces.keys(), lines[at]
            assert whole.node_sets.keys() == mesh.node_sets.keys(), lines[at]
            for name in whole.node_sets:
                np.testing.assert_array_equal(mesh.node_sets[name], whole.node_sets[name])
    assert refused > 1.2 * (last - first)


@pytest.mark.slow
def test_whatever_is_damaged_counts_hold_and_one_line_says_so(tmp_path):
    text = joint()
    whole, refused, other = read(tmp_path, text), [], 0
    for seed in range(2000):
        damaged = mutated(text.encode(), random.Random(seed))
        try:
            mesh = read(tmp_path, damaged)
        except ss.ModelError as error:
            refused.append(str(error))
            continue
        if same(mesh, whole):
            continue
        other += 1
        # digits that became others: as many nodes and elements as the heads say
        said = damaged.decode("latin-1")
        for head, present in (("NBLOCK", len(mesh.nodes)), ("EBLOCK", None)):
            counts = re.findall(rf"^{head},\d+,SOLID,[ \d]*,([ \d]+)$", said, re.M)
            assert not counts or present in (None, sum(map(int, counts))), seed
    assert all("\n" not in one and "joint.cdb" in one for one in refused)
    assert len(refused) > 1000
    assert other < 60

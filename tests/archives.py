"""Archives as ANSYS' CDWRITE lays them out."""

import numpy as np

import stickslip as ss

CORNERS = ((0, 0), (2, 0), (2, 3), (0, 3))
AROUND = [(0, 1), (1, 2), (2, 3), (3, 0)]
EDGES = [*AROUND, *((a + 4, b + 4) for a, b in AROUND), *((a, a + 4) for a in range(4))]
"""Of a brick, in the order of the nodes between its corners."""
PLACES = np.array([[x, y, z] for z in (0, 1) for x, y in CORNERS], float)
PLACES[4:, :2] = PLACES[4:, :2] * 0.75 + 0.25
"""Corners of a brick, the upper ones shifted."""
_COMPONENT = {"NODE": "node", "ELEM": "element"}


def archive(nodes, elements, types, components=(), angles=None, integers=9, reals="21.13e3"):
    """Return the text of an archive.

    Parameters
    ----------
    nodes : dict of int to (x, y, z)
    elements : sequence of (number, type, nodes), nodes in the order of ANSYS
    types : dict of int to int
        The element of each type.
    components : sequence of (name, "NODE" or "ELEM", numbers)
    angles : dict of int to three angles
        Of nodes that are rotated.
    integers, reals : int, str
        Widths of fields, as in (3i9,6e21.13e3); of elements an integer is one wider.
    """
    exponent = 3 if reals.endswith("e3") else 2
    lines = [
        "/COM,ANSYS RELEASE 2023 R2           BUILD 23.2      UP20230601       10:41:12",
        "/PREP7",
        "/NOPR",
        "/TITLE,                                                                        ",
        "*IF,_CDRDOFF,EQ,1,THEN     !if solid model was read in",
        "_CDRDOFF=             !reset flag, numoffs already performed",
        "*ELSE              !offset database for the following FE model",
        f"NUMOFF,NODE, {max(nodes):8d}",
        "*ENDIF",
        "*SET,_RETURN ,  0.000000000000    ",
        "DOF,DELETE",
        *(f"ET,{number:9d},{name:3d}" for number, name in types.items()),
        f"NBLOCK,6,SOLID,{max(nodes):10d},{len(nodes):10d}",
        f"(3i{integers},6e{reals})",
    ]
    for number, place in nodes.items():
        values = [*place, *(angles or {}).get(number, ())]
        while values and values[-1] == 0.0:
            values.pop()
        head = "".join(f"{one:{integers}d}" for one in (number, 0, 0))
        lines.append(head + "".join(real(one, reals, exponent) for one in values))
    highest = max(number for number, _, _ in elements)
    lines += [
        "N,R5.3,LOC,       -1,",
        f"EBLOCK,19,SOLID,{highest:10d},{len(elements):10d}",
        f"(19i{integers + 1})",
    ]
    for number, kind, own in elements:
        fields = [1, kind, 1, 1, 0, 0, 0, 0, len(own), 0, number, *own]
        lines += rows(fields[:19], integers + 1, 19) + rows(fields[19:], integers + 1, 19)
    lines.append(" " * (integers - 1) + "-1")
    for name, kind, numbers in components:
        packed = ranges(numbers)
        said = f"! users {_COMPONENT[kind]} component definition"
        lines.append(f"CMBLOCK,{name:8s},{kind:4s},{len(packed):8d}  {said}")
        lines += ["(8i10)", *rows(packed, 10, 8)]
    lines += ["EXTOPT,ATTR,      0,      0,      0", "/GO", "FINISH", ""]
    return "\n".join(lines)


def real(value, form, exponent):
    """Return a number as Fortran writes it: e21.13e3 has three digits of exponent."""
    width, decimals = (int(one) for one in form.split("e")[0].split("."))
    mantissa, power = f"{value:.{decimals}e}".split("e")
    return f"{mantissa}E{power[0]}{int(power[1:]):0{exponent}d}".rjust(width)


def rows(numbers, width, count):
    """Return whole numbers in lines."""
    made = [
        "".join(f"{one:{width}d}" for one in numbers[at : at + count])
        for at in range(0, len(numbers), count)
    ]
    return made


def ranges(numbers):
    """Return sorted numbers, of those that follow each other the first and minus the last."""
    given = np.sort(np.array(numbers))
    ends = np.flatnonzero(np.diff(given) != 1)
    packed = []
    for part in np.split(given, ends + 1):
        packed += [int(part[0])] if len(part) == 1 else [int(part[0]), -int(part[-1])]
    return packed


def brick(corners, middles):
    """Return nodes and element of a brick; edges that coincide have one node between them."""
    nodes = {1 + at: PLACES[at].tolist() for at in sorted({*corners})}
    own, between = [1 + at for at in corners], {}
    for ends in [{corners[a], corners[b]} for a, b in EDGES] if middles else ():
        one, other = min(ends), max(ends)
        number = between.setdefault((one, other), 101 + len(between)) if one < other else 1 + one
        nodes[number] = ((PLACES[one] + PLACES[other]) / 2).tolist()
        own.append(number)
    return nodes, own


LOW = dict(zip(range(1, 9), [(x, y, z) for z in (0, 1) for x, y in CORNERS], strict=True))
HIGH = dict(zip(range(21, 29), [(x, y, z + 1) for x, y, z in LOW.values()], strict=True))
NODES = {number: tuple(map(float, place)) for number, place in (LOW | HIGH).items()}
ELEMENTS = [(10, 2, [*LOW]), (20, 2, [*HIGH]), (31, 3, [24, 23, 22, 21])]
COMPONENTS = [
    ("SEAT", "NODE", [5, 6, 7, 8]),
    ("PAD", "NODE", [21, 22, 23, 24]),
    ("CONTACTS", "ELEM", [31]),
    ("BODIES", "ELEM", [10, 20]),
]
TYPES = {2: 185, 3: 173}


def joint(**changes):
    given = {"nodes": NODES, "elements": ELEMENTS, "types": TYPES, "components": COMPONENTS}
    return archive(**given | changes)


def read(folder, text, name="joint.cdb", **said):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return ss.read_mesh(path, **said)

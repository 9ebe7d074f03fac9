"""Decks of two bricks, one above the other: of CalculiX or Abaqus, and of Nastran."""

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


def bulk_data(wide: bool, system: str = "") -> str:
    """Return two bricks of Nastran, one upon the other, with the nodes between them in sets."""
    lines, corners = ["SOL 103", "CEND", "BEGIN BULK"], ((0, 0), (2, 0), (2, 3), (0, 3))
    for base, height in ((10, 0.0), (20, 1.0)):
        ids = range(base + 1, base + 9)
        places = [(x, y, height + z) for z in (0.0, 1.0) for x, y in corners]
        for number, (x, y, z) in zip(ids, places, strict=True):
            if wide:
                lines.append(f"GRID*   {number:16d}{system:>16}{x:16.8f}{y:16.8f}*G{number}")
                lines.append(f"*G{number:<6d}{z:16.8f}")
            else:
                lines.append(f"GRID    {number:8d}{system:>8}{x:8.3f}{y:8.3f}{z:8.3f}")
        own = "".join(f"{number:8d}" for number in ids)
        lines += [f"CHEXA   {base:8d}{1:8d}{own[:48]}+", f"+       {own[48:]}"]
    first = f"SET1    {2:8d}{21:8d}{22:8d}{23:8d}".ljust(72)
    lines += ["$ between them", "SET1,1,15,THRU,18", f"{first}+S"]
    return "\n".join([*lines, f"+S      {24:8d}", "SET1,3,10,20", "ENDDATA", ""])

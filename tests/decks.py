"""A deck of CalculiX or Abaqus: two bricks, one above the other."""

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

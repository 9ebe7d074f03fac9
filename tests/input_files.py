"""Files of every kind that is read, and ways in which files get damaged."""

import gzip
import random
import re
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import scipy.io
import scipy.sparse

import stickslip as ss
from archives import archive
from decks import DECK, bulk_data
from stickslip.analyses.pattern_store import Key, PatternStore, Row
from stickslip.io import Frf, read_dofs, read_frf, read_matrix, write_frf

DATA = Path(__file__).parent / "data"

K = np.random.default_rng(0).standard_normal((9, 9))
K = (K @ K.T + np.eye(9)) * 1e7
BAND = np.where(abs(np.subtract.outer(range(9), range(9))) < 3, K, 0.0)

STUDY = """\
name = "beam"

[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[1100.0, -100.0], [-100.0, 1100.0]]
damping = { modal = 0.01 }
dofs = ["a", "b"]

[[contact]]
law = "jenkins"
dof = "a"
stiffness = "0.5 kN/m"
slip_force = 1.5

[[force]]
dof = "b"
amplitude = "1.2e0 N"
phase = "90 deg"

[analysis]
kind = "forced-response"
omega = { from = "20 rad/s", to = "6 Hz", points = 4 }
harmonics = 3
levels = [0.5, 1.0]
"""

JOINT = (
    {number: tuple(place) for number, place in enumerate(np.eye(3).tolist(), 5)} | {9: (0.0,) * 3},
    [(3, 1, [9, 5, 6, 7])],
    {1: 285},
    [("SEAT", "NODE", [5, 6, 7])],
)
"""Nodes, elements, types and components of an archive of ANSYS."""
IDENTITY = {"omega": [1.0, 2.0], "seed": 3}


def write(file: Path, text: str) -> Path:
    """Return a file with a text."""
    file.write_text(text)
    return file


def make(folder: Path) -> dict[str, Callable[[Path], object]]:
    """Write a sound file of every kind; return how each is read."""
    band = scipy.sparse.csc_array(BAND)
    np.save(folder / "one.npy", K)
    np.savez(folder / "two.npz", K=K, M=BAND)
    np.savez_compressed(folder / "packed.npz", K=BAND)
    scipy.sparse.save_npz(folder / "sparse.npz", band)
    for version in ("4", "5"):
        scipy.io.savemat(folder / f"full{version}.mat", {"K": K, "t": "text"}, format=version)
        scipy.io.savemat(folder / f"sparse{version}.mat", {"K": band}, format=version)
    scipy.io.savemat(folder / "packed.mat", {"K": band}, do_compression=True)
    with h5py.File(folder / "seven.mat", "w", userblock_size=512) as file:
        said = {"chunks": (4, 4), "compression": "gzip"}
        file.create_dataset("K", data=BAND.T, **said).attrs["MATLAB_class"] = np.bytes_("double")
    with h5py.File(folder / "seven-sparse.mat", "w", userblock_size=512) as file:
        group = file.create_group("K")
        group.attrs["MATLAB_sparse"] = np.uint64(9)
        group["jc"], group["ir"] = band.indptr.astype("u8"), band.indices.astype("u8")
        group["data"] = band.data
    for symmetry in ("general", "symmetric"):
        scipy.io.mmwrite(folder / f"{symmetry}.mtx", band, symmetry=symmetry, precision=17)
        scipy.io.mmwrite(folder / f"array-{symmetry}.mtx", K, symmetry=symmetry, precision=17)
    np.savetxt(folder / "rows.csv", K, delimiter=";")
    (folder / "packed.mtx.gz").write_bytes(gzip.compress((folder / "symmetric.mtx").read_bytes()))
    scipy.io.hb_write(folder / "harwell.rua", band)
    lower = [(i, j) for i in range(9) for j in range(i + 1)]
    coordinates = "".join(f"{i + 1} {j + 1} {K[i, j]:.15e}\n" for i, j in lower)
    (folder / "coordinates.mtx").write_text(coordinates)
    nodes = [f"{i // 3 + 4},{i % 3 + 1}" for i in range(9)]
    named = "".join(f"{nodes[i]}, {nodes[j]}, {K[i, j]:.15e}\n" for i, j in lower)
    (folder / "named.mtx").write_text("** matrix input\n*MATRIX INPUT, NAME=K\n" + named)
    for name in ("bar.sti", "bar.dof", "bar-substructure.mtx"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    (folder / "narrow.pch").write_text(
        "DMIG    STIF    0       6       2       0\n"
        "DMIG    STIF    27      1               27      1       3.+5\n"
        "        2       3       -1.25D+5\n"
        "DMIG,STIF,2,3,,2,3,4.0E5\n"
    )
    (folder / "joint.cdb").write_text(archive(*JOINT))
    (folder / "joint.inp").write_text(DECK)
    (folder / "joint.bdf").write_text(bulk_data(False))
    mapping = ["    Matrix Eqn          Node    DOF     ", "             1             4    UX  "]
    (folder / "rows.mapping").write_text("\n".join([*mapping, ""]))
    write_frf(folder / "frf.uff", [Frf([1.0, 2.0, 3.5], [1.0, 1j, 2.0], "1.1", "2.3")] * 2)
    (folder / "study.toml").write_text(STUDY)
    study = ss.study.Study.load(folder / "study.toml")
    next(study.run()).save(folder / "result.nc")
    ss.exact_response(study.model, [22.0, 30.0]).save(folder / "exact.nc")
    (folder / "store.db").unlink(missing_ok=True)
    with PatternStore(folder / "store.db", IDENTITY) as store:
        for pattern in range(4):
            store.add(Key(0.02, np.nan, pattern), [Row(1.5, 2e-3, 1, 0, 3, 1e-6, False)] * 2, 7)
    readers = {name.name: _matrix for name in folder.iterdir()}
    _nastran(folder, readers)
    return readers | {
        "bar.dof": read_dofs,
        "rows.mapping": read_dofs,
        **dict.fromkeys(("joint.cdb", "joint.inp", "joint.bdf"), _mesh),
        "frf.uff": lambda path: [(one.dof, one.omega, one.values) for one in read_frf(path)],
        "study.toml": lambda path: ss.study.Study.load(path).tables.model_dump_json(),
        "result.nc": _result,
        "exact.nc": _result,
        "store.db": _rows,
    }


def _nastran(folder: Path, readers: dict[str, Callable[[Path], object]]) -> None:
    """Add files that pyyeti writes, if it is there."""
    try:
        import pandas
        from pyyeti import nastran
        from pyyeti.nastran import op4
    except ImportError:
        return
    for binary in (True, False):
        for layout in ("dense", "bigmat", "nonbigmat"):
            name = f"{layout}{'-text' * (not binary)}.op4"
            op4.write(str(folder / name), {"K": BAND}, binary=binary, sparse=layout, digits=16)
            readers[name] = _matrix
    index = pandas.MultiIndex.from_product([(1, 2, 3), (1, 2, 3)], names=["id", "dof"])
    nastran.wtdmig(str(folder / "wide.pch"), {"K": pandas.DataFrame(K, index, index)})
    readers["wide.pch"] = _matrix


def _matrix(path: Path) -> object:
    key = "K" if path.name in ("two.npz", "full4.mat", "full5.mat") else None
    return read_matrix(path, key)


def _mesh(path: Path) -> object:
    mesh = ss.read_mesh(path)
    return [(None, *mesh.cells[0][1], *(mesh.nodes[own] for own in mesh.node_sets.values()))]


def _result(path: Path) -> object:
    result = ss.load(path)
    return result.omega, result.coefficients("a"), repr(result)


def _rows(path: Path) -> object:
    with PatternStore(path, IDENTITY) as store:
        return list(store.rows())


def damaged(content: bytes, draw: random.Random) -> tuple[str, bytes]:
    """Return what was done to a file, and the file."""
    text = content.isascii()
    kind = draw.choice(_OF_LINES if text and draw.random() < 0.8 else _OF_BYTES)
    return kind.__name__, kind(content, draw)


def flip(content: bytes, draw: random.Random) -> bytes:
    new = bytearray(content)
    for _ in range(draw.choice([1, 1, 3])):
        new[draw.randrange(len(new))] ^= 1 << draw.randrange(8)
    return bytes(new)


def overwrite(content: bytes, draw: random.Random) -> bytes:
    at, size = draw.randrange(len(content)), draw.choice([1, 2, 4, 8])
    filling = draw.choice([b"\0" * size, b"\xff" * size, draw.randbytes(size)])
    return content[:at] + filling + content[at + size :]


def cut(content: bytes, draw: random.Random) -> bytes:
    return content[: draw.randrange(len(content))]


def lose(content: bytes, draw: random.Random) -> bytes:
    at = draw.randrange(len(content))
    return content[:at] + content[at + draw.choice([1, 4, 8, 40]) :]


def insert(content: bytes, draw: random.Random) -> bytes:
    at, size = draw.randrange(len(content)), draw.choice([1, 4, 8, 40])
    return content[:at] + draw.choice([draw.randbytes(size), content[:size]]) + content[at:]


def append(content: bytes, draw: random.Random) -> bytes:
    return content + draw.choice([b"\0" * 8, draw.randbytes(8), content[-40:], content])


def lose_line(content: bytes, draw: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    del lines[draw.randrange(len(lines))]
    return b"".join(lines)


def double_line(content: bytes, draw: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    at = draw.randrange(len(lines))
    return b"".join([*lines[: at + 1], *lines[at:]])


def replace_line(content: bytes, draw: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    lines[draw.randrange(len(lines))] = draw.choice(lines)
    return b"".join(lines)


def swap_lines(content: bytes, draw: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def change_count(content: bytes, draw: random.Random) -> bytes:
    """Change a whole number of the first lines, where counts stand."""
    head = content[:400]
    found = draw.choice(list(re.finditer(rb"\d+", head)))
    number = draw.choice([0, 1, int(found[0]) + draw.choice([-1, 1]), 10**9, 10**19, -3])
    written = str(number).encode().rjust(len(found[0]))
    return content[: found.start()] + written + content[found.end() :]


def change_number(content: bytes, draw: random.Random) -> bytes:
    found = draw.choice(list(re.finditer(rb"\d+", content)))
    strange = [b"nan", b"1e-400", b"1e400", b"1_0", "\u0661".encode(), b"-", b"", b"0x1", b"9" * 30]
    return content[: found.start()] + draw.choice(strange) + content[found.end() :]


_OF_BYTES = (flip, overwrite, cut, lose, insert, append)
_OF_LINES = (lose_line, double_line, replace_line, swap_lines, change_count, change_number, cut)

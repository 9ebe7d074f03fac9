"""Matrices of ANSYS' HBMAT with the names of their rows, and the whole way to a response."""

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

import stickslip as ss
from archives import archive
from stickslip.io import read_dofs, read_matrix

K = scipy.sparse.csc_array([[4.0, -1.5, 0.0], [-1.5, 3.0, -1.0], [0.0, -1.0, 5.0]])
NAMES = ("12.1", "7.3", "7.6")
_LABELS = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")


def hbmat(folder, name, matrix, names):
    """Write a symmetric matrix and its mapping as HBMAT does."""
    lower = scipy.sparse.tril(matrix, format="csc")
    lower.sort_indices()
    numbers = [*(lower.indptr + 1), *(lower.indices + 1)]
    counts = (len(lower.indptr), lower.nnz, lower.nnz)
    lines = [
        "Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format".ljust(80),
        "".join(f"{one:14d}" for one in (sum(counts), *counts, 0)),
        "RSA".ljust(14) + "".join(f"{one:14d}" for one in (*matrix.shape, lower.nnz, 0)),
        "(I14)           (I14)           (d25.15)            (d25.15)            ",
        *(f"{one:14d}" for one in numbers),
        *(f"{one:25.15e}".replace("e", "D") for one in lower.data),
    ]
    (folder / f"{name}.matrix").write_text("\n".join([*lines, ""]))
    rows = [(at, *one.split(".")) for at, one in enumerate(names, 1)]
    head = "    Matrix Eqn          Node    DOF     "
    said = [f"{at:14d}{node:>14s}    {_LABELS[int(way) - 1]:4s}" for at, node, way in rows]
    (folder / f"{name}.mapping").write_text("\n".join([head, *said, ""]))


def test_the_mapping_names_the_rows(tmp_path):
    hbmat(tmp_path, "k", K, NAMES)
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.matrix"), K.toarray())
    assert read_dofs(tmp_path / "k.matrix") == read_dofs(tmp_path / "k.mapping") == NAMES
    (tmp_path / "k.mapping").rename(tmp_path / "k.MAPPING")
    assert read_dofs(tmp_path / "k.matrix") == NAMES
    (tmp_path / "k.MAPPING").unlink()
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.matrix"), K.toarray())
    with pytest.raises(ss.ModelError, match="it does not name its rows"):
        read_dofs(tmp_path / "k.matrix")


def test_what_apdl_math_exports_has_the_same_rows(tmp_path):
    hbmat(tmp_path, "k", K, NAMES)
    lower = scipy.sparse.tril(K, format="csc").tocoo()
    head = [
        "%%MatrixMarket matrix coordinate real symmetric ",
        "%====",
        "% Creator: ANSYS Inc",
        "% ",
    ]
    entries = zip(lower.row + 1, lower.col + 1, lower.data, strict=True)
    rows = [f"{row} {column} {value:.15E}" for row, column, value in entries]
    text = "\n".join([*head, f"3 3 {lower.nnz}", *rows, ""]).replace("E+00", "E+000")
    (tmp_path / "k.mmf").write_text(text)
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.mmf"), K.toarray())
    assert read_dofs(tmp_path / "k.mmf") == NAMES


def test_other_quantities_keep_their_names(tmp_path):
    (tmp_path / "t.mapping").write_text("Matrix Eqn Node DOF\n 1 3 TEMP\n 2 3 ux\n")
    assert read_dofs(tmp_path / "t.mapping") == ("3.TEMP", "3.1")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "             2             7    UZ",
            "             3             7    UZ",
            "row 3 follows row 1",
        ),
        ("UZ", "", "row, node and quantity expected"),
        ("             7    UZ", "             7.   UZ", "line 3: '7.' stands where"),
        ("ROTZ", "UZ  ", "names a row twice"),
        ("             3             7    ROTZ\n", "", "3 rows, but k.mapping names 2"),
        ("ROTZ\n", "ROTZ", "the last line does not end"),
    ],
)
def test_a_damaged_mapping_is_refused(tmp_path, old, new, says):
    hbmat(tmp_path, "k", K, NAMES)
    text = (tmp_path / "k.mapping").read_text()
    assert old in text
    (tmp_path / "k.mapping").write_text(text.replace(old, new))
    with pytest.raises(ss.ModelError, match=r"k\.matrix: ") as error:
        read_dofs(tmp_path / "k.matrix")
    assert says in str(error.value)


def two_blocks():
    """Return a block on another, their nodes by number, and the matrices of both."""
    skfem = pytest.importorskip("skfem")
    bodies = []
    for low, high in ((-0.01, 0.0), (0.0, 0.01)):
        grid = skfem.MeshHex.init_tensor(
            np.linspace(0, 0.03, 3), np.linspace(0, 0.02, 2), [low, high]
        )
        bodies.append(ss.Solid(grid, 210e9, 0.3, 7850.0))
    count = len(bodies[0].nodes)
    nodes = np.vstack([body.nodes for body in bodies])
    cells = np.vstack([bodies[0].elements, bodies[1].elements + count])
    stiffness, mass = (
        scipy.sparse.block_diag([getattr(body, name) for body in bodies], format="csc")
        for name in ("stiffness", "mass")
    )
    return nodes, cells, count, stiffness, mass


def test_from_the_files_of_ansys_to_a_response(tmp_path):
    """HBMAT and CDWRITE, in millimetres and tonnes, give the response of the same arrays."""
    nodes, cells, count, stiffness, mass = two_blocks()
    numbers = 3 + 2 * np.random.default_rng(4).permutation(len(nodes))
    below = np.abs(nodes[:, 2] + 0.01) < 1e-9
    free = np.flatnonzero(~np.repeat(below, 3))
    rows = np.random.default_rng(5).permutation(free)  # a solver orders its equations
    names = [f"{numbers[row // 3]}.{row % 3 + 1}" for row in rows]
    K, M = (one[rows][:, rows] for one in (stiffness, mass))
    hbmat(tmp_path, "k", K * 1e-3, names)  # N/mm
    hbmat(tmp_path, "m", M * 1e-3, names)  # t
    between = np.abs(nodes[:, 2]) < 1e-9
    upper = np.arange(len(nodes)) >= count
    parts = [
        (name, "NODE", numbers[between & which].tolist())
        for name, which in (("PAD", upper), ("SEAT", ~upper))
    ]
    places = dict(zip(numbers.tolist(), (1e3 * nodes).round(9).tolist(), strict=True))
    elements = [(at, 1, numbers[own].tolist()) for at, own in enumerate(cells, 1)]
    (tmp_path / "joint.cdb").write_text(archive(places, elements, {1: 186}, parts))

    units = "t-mm-s"
    mesh = ss.read_mesh(tmp_path / "joint.cdb", units=units)
    pad = ss.ContactInterface.from_surfaces(mesh, "PAD", mesh, "SEAT")
    loaded = mesh.dof_at([0.03, 0.02, 0.01], 1, within=1e-9)
    reduced = ss.craig_bampton(
        *(read_matrix(tmp_path / f"{name}.matrix", sparse=True) for name in "mk"),
        [*pad.dofs, loaded],
        modes=2,
        dofs=read_dofs(tmp_path / "k.matrix"),
        units=units,
    )
    own = ss.Mesh(nodes, [("hexahedron20", cells)], numbers)
    other = ss.ContactInterface.from_surfaces(own, between & upper, own, between & ~upper)
    assert pad.dofs == other.dofs
    np.testing.assert_allclose(pad.areas, other.areas, rtol=1e-12)
    direct = ss.craig_bampton(
        mass[free][:, free],
        stiffness[free][:, free],
        [*other.dofs, loaded],
        modes=2,
        dofs=[f"{numbers[row // 3]}.{row % 3 + 1}" for row in free],
    )
    found = []
    for pairs, one in ((pad, reduced), (other, direct)):
        contact = pairs.contact(
            friction=0.3, tangential_stiffness=2e12, normal_stiffness=4e12, pressure=1e5
        )
        model = ss.Model(one.structure(ss.ModalDamping(0.01)), [contact], [ss.Force(loaded, 10.0)])
        at = 0.5 * ss.natural_frequencies(model)[0]
        found.append(ss.forced_response(model, [at], 1, stability=False))
    assert found[0].slip_fraction(0).max() > 0.0
    np.testing.assert_allclose(*(one.amplitude(loaded) for one in found), rtol=1e-6)


def test_rows_of_a_full_file_are_at_the_nodes_of_the_archive():
    """A rotation of the archive's coordinates strains no element: numbers and directions agree."""
    reader = pytest.importorskip(
        "ansys.mapdl.reader", reason="pip install 'stickslip[ansys]', with its examples"
    )
    folder = Path(reader.__file__).parent / "examples"
    mesh = ss.read_mesh(folder / "HexBeam.cdb")
    stiffness = read_matrix(folder / "file.full", "stiffness", sparse=True)
    names = [name.split(".") for name in read_dofs(folder / "file.full", "stiffness")]
    nodes, ways = np.array(names, np.int64).T
    place = {number: at for at, number in enumerate(mesh.numbers.tolist())}
    ((_, cells),) = mesh.cells
    held = ~np.isin(mesh.numbers, nodes)
    assert np.unique(mesh.nodes[held, 2]).tolist() == [0.0]
    near = np.unique(cells[held[cells].any(axis=1)])
    at = np.array([place[node] for node in nodes])
    free = ~np.isin(at, near)
    assert free.sum() > 800
    for axis in np.eye(3):
        turned = np.cross(axis, mesh.nodes)[at, ways - 1]
        forces = stiffness @ turned
        assert np.abs(forces[free]).max() < 1e-13 * abs(stiffness).max() * np.abs(turned).max()
        assert np.abs(forces[~free]).max() > 1e-3 * abs(stiffness).max()

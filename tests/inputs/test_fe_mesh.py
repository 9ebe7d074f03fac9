"""Meshes of other programs: nodes by place, fields on nodes, files for ParaView."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

import stickslip as ss

meshio = pytest.importorskip("meshio", reason="pip install 'stickslip[fe]'")
DECK = Path(__file__).parents[2] / "examples" / "calculix-plate" / "plate.inp"


@pytest.fixture(scope="module")
def plate():
    """A small plate of the elements of the package, its deck with numbers of its own."""
    skfem = pytest.importorskip("skfem")
    grid = skfem.MeshHex.init_tensor(np.linspace(0, 0.12, 5), [0, 0.015, 0.03], [0, 0.004])
    return ss.Solid(grid, young=210e9, poisson=0.3, density=7850.0)


@pytest.fixture(scope="module")
def numbers(plate):
    return 7 + 3 * np.random.default_rng(5).permutation(len(plate.nodes))


@pytest.fixture(scope="module")
def mesh(plate, numbers, tmp_path_factory):
    lines = ["** a plate", "*NODE, NSET=ALL"]
    places = zip(numbers, plate.nodes.tolist(), strict=True)
    lines += [f"{number}, {x!r}, {y!r}, {z!r}" for number, (x, y, z) in places]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=PLATE")
    for number, cell in enumerate(plate.elements, 1):
        names = [str(numbers[node]) for node in cell]
        lines += [f"{number}, " + ", ".join(names[:10]) + ",", ", ".join(names[10:])]
    path = tmp_path_factory.mktemp("deck") / "plate.inp"
    path.write_text("\n".join([*lines, "*STEP", "*END STEP"]) + "\n")
    return ss.read_mesh(path)


@pytest.fixture(scope="module")
def reduced(plate, numbers, mesh):
    free = np.flatnonzero(np.repeat(plate.nodes[:, 0] > 1e-9, 3))
    names = [f"{numbers[dof // 3]}.{dof % 3 + 1}" for dof in free]
    boundary = {
        "damper": mesh.dof_at([0.03, 0.015, 0.0], 3),
        "tip": mesh.dof_at([0.12, 0.0, 0.004], 3, within=1e-9),
    }
    M, K = (one[free][:, free] for one in (plate.mass, plate.stiffness))
    return ss.craig_bampton(M, K, boundary, modes=6, dofs=names)


@pytest.fixture(scope="module")
def response(reduced):
    structure = reduced.structure(ss.ModalDamping(0.002))
    damper = ss.Jenkins("damper", stiffness=1e6, slip_force=0.5)
    model = ss.Model(structure, [damper], [ss.Force("tip", 0.1)])
    omega = np.linspace(0.97, 1.03, 5) * ss.natural_frequencies(model)[0]
    return ss.forced_response(model, omega, 5, observe=structure.dofs)


def test_a_deck_has_nodes_numbers_and_elements(plate, numbers, mesh):
    np.testing.assert_array_equal(mesh.nodes, plate.nodes)
    np.testing.assert_array_equal(mesh.numbers, numbers)
    ((kind, cells),) = mesh.cells
    assert kind == "hexahedron20"
    np.testing.assert_array_equal(cells, plate.elements)
    assert repr(mesh) == f"Mesh({len(plate.nodes)} nodes, 8 elements, parts ['ALL'])"


def test_the_example_deck():
    mesh = ss.read_mesh(DECK)
    assert mesh.node_at([0.12, 0.0, 0.0]) == 49
    assert mesh.node_at([0.12, 0.0, 0.0001], within="0.2 mm") == 49
    with pytest.raises(ss.ModelError, match="within=5e-05"):
        mesh.node_at([0.12, 0.0, 0.0001], within="0.05 mm")
    assert mesh.dof_at([0.1201, 0.0, 0.0], 3, within=1e-3) == "49.3"


def test_other_formats_count_from_one(tmp_path):
    points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    meshio.Mesh(points, [("triangle", [[0, 1, 2]])]).write(tmp_path / "a.vtk")
    mesh = ss.read_mesh(tmp_path / "a.vtk")
    assert mesh.numbers.tolist() == [1, 2, 3]
    assert mesh.nodes.shape == (3, 3)
    assert ss.read_mesh(tmp_path / "a.vtk", numbers=[30, 10, 20]).node_at([1.0, 0.0, 0.0]) == 10


@pytest.mark.parametrize(
    "cards",
    [
        "GRID,41,,0.,0.,0.\nGRID,7,,1.,0.,0.\nGRID,90,,0.,1.,0.\nCTRIA3,1,1,41,7,90\n",
        "GRID          41              0.      0.      0.\n"
        "GRID           7              1.      0.      0.\n"
        "GRID          90              0.      1.      0.\n"
        "CTRIA3         1       1      41       7      90\n",
    ],
)
def test_nastran_numbers(cards, tmp_path):
    (tmp_path / "a.bdf").write_text(f"BEGIN BULK\n{cards}ENDDATA\n")
    mesh = ss.read_mesh(tmp_path / "a.bdf")
    assert mesh.numbers.tolist() == [41, 7, 90]
    assert mesh.node_at([1.0, 0.1, 0.0]) == 7


def test_the_nearest_node(mesh):
    rng = np.random.default_rng(0)
    for point in rng.uniform([-0.01] * 3, [0.13, 0.04, 0.01], (20, 3)):
        number = mesh.node_at(point)
        distances = [np.linalg.norm(node - point) for node in mesh.nodes]
        assert mesh.numbers.tolist().index(number) == int(np.argmin(distances))


def test_fields_are_of_nodes(mesh, numbers, reduced):
    rng = np.random.default_rng(2)
    values = rng.standard_normal(reduced.size)
    field = mesh.field(reduced.row_names, values)
    for name, value in zip(reduced.row_names, values, strict=True):
        node, way = map(int, name.split("."))
        assert field[numbers.tolist().index(node), way - 1] == value
    assert np.count_nonzero(field) == reduced.size
    turned = mesh.field([f"{numbers[0]}.5", f"{numbers[0]}.2"], [3.0, 4.0])
    assert turned[0].tolist() == [0.0, 4.0, 0.0]


def test_modes_are_those_of_the_full_structure(plate, numbers, mesh, reduced):
    free = np.flatnonzero(np.repeat(plate.nodes[:, 0] > 1e-9, 3))
    M, K = (one[free][:, free].toarray() for one in (plate.mass, plate.stiffness))
    place = reduced.row_names.index(mesh.dof_at([0.03, 0.015, 0.0], 3))
    K[place, place] += 1e6
    squares, shapes = scipy.linalg.eigh(K, M, subset_by_index=(0, 1))
    fields = mesh.modes(reduced, 2, springs={"damper": 1e6})
    for number, (name, field) in enumerate(fields.items()):
        told = re.fullmatch(rf"mode {number + 1} at (.*) Hz", name)
        assert float(told[1]) == pytest.approx(np.sqrt(squares[number]) / (2 * np.pi), rel=1e-3)
        moved = field.ravel()[free]
        assert moved @ M @ moved == pytest.approx(1.0)
        assert abs(moved @ M @ shapes[:, number]) == pytest.approx(1.0, abs=1e-3)
        assert not field.ravel()[np.setdiff1d(np.arange(field.size), free)].any()


def test_a_response_at_the_nodes(mesh, reduced, response):
    fields = mesh.motion(response, 2, reduced)
    tip, damper = (
        mesh.numbers.tolist().index(int(reduced.row_names[row].split(".")[0]))
        for row in (reduced.rows[1], reduced.rows[0])
    )
    amplitude = fields["displacement amplitude"]
    assert amplitude[tip, 2] == pytest.approx(response.amplitude("tip")[2], rel=1e-12)
    assert amplitude[damper, 2] == pytest.approx(response.amplitude("damper")[2], rel=1e-12)
    first = fields["displacement fundamental real"] + 1j * fields["displacement fundamental imag"]
    assert first[tip, 2] == response.coefficients("tip")[2, 1]
    slip, work = fields["slip fraction"], fields["dissipation"]
    assert 0.0 < slip[damper] == response.slip_fraction("jenkins")[2]
    assert 0.0 < work[damper] == response.dissipation("jenkins")[2]
    assert np.isnan(slip).sum() == np.isnan(work).sum() == len(slip) - 1


def test_work_is_shared_between_the_nodes_of_a_contact():
    mesh = ss.Mesh(np.eye(3), numbers=[4, 5, 6])
    K, M = np.diag([2.0, 3.0, 4.0]), np.eye(3)
    structure = ss.Structure(M, K, 0.01 * K, dofs=["4.1", "5.1", "6.1"])
    contacts = [
        ss.Jenkins("4.1", "5.1", stiffness=1.0, slip_force=0.2),
        ss.Jenkins("5.1", stiffness=1.0, slip_force=0.1),
    ]
    model = ss.Model(structure, contacts, [ss.Force("4.1", 1.0)])
    response = ss.forced_response(model, [1.2, 1.4], 3)
    fields = mesh.motion(response, -1)
    between, ground = (response.dissipation((place, 0))[-1] for place in (0, 1))
    assert min(between, ground) > 0.0
    np.testing.assert_allclose(
        fields["dissipation"], [between / 2, between / 2 + ground, np.nan], rtol=1e-15
    )
    shares = [response.slip_fraction((place, 0))[-1] for place in (0, 1)]
    np.testing.assert_array_equal(fields["slip fraction"], [shares[0], max(shares), np.nan])
    assert fields["displacement amplitude"][0, 0] == pytest.approx(response.amplitude("4.1")[-1])


def test_a_node_that_opens_does_not_slip_for_that():
    mesh = ss.Mesh(np.eye(3)[:2])
    structure = ss.Structure(
        np.eye(3), 1e6 * np.eye(3), ss.ModalDamping(0.02), ["2.1", "2.2", "2.3"]
    )
    stiffness = {"tangential_stiffness": 1e5, "normal_stiffness": 1e5}
    pad = ss.Coulomb(structure.dofs, normal=[0, 0, 1], friction=0.3, preload=5.0, **stiffness)
    forces = [ss.Force("2.1", 40.0), ss.Force("2.3", 100.0)]
    response = ss.forced_response(ss.Model(structure, [pad], forces), [1000.0], harmonics=9)
    fields = mesh.motion(response, 0)
    assert 0.0 < fields["slip fraction"][1] == response.slip_fraction(0)[0, 0]
    assert fields["slip fraction"][1] < response.open_fraction(0)[0, 0]
    assert 0.0 < fields["dissipation"][1] == response.dissipation(0)[0, 0]


def test_what_paraview_reads(mesh, reduced, response, tmp_path):
    fields = mesh.modes(reduced, 2) | mesh.motion(response, 2, reduced)
    mesh.write_vtu(tmp_path / "a.vtu", fields)
    read = meshio.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(read.points, mesh.nodes)
    np.testing.assert_array_equal(read.cells_dict["hexahedron20"], mesh.cells[0][1])
    assert set(read.point_data) == set(fields)
    for name, field in fields.items():
        np.testing.assert_array_equal(read.point_data[name], field)


# ---------------------------------------------------------------------------------- nonsense


def test_nonsense(mesh, reduced, response, tmp_path):
    for call, message in {
        lambda: mesh.node_at([0.0, 0.0]): "has not three finite coordinates",
        lambda: mesh.node_at([0.0, np.nan, 0.0]): "has not three finite coordinates",
        lambda: mesh.node_at([120.0, 0, 0], 1.0): "away; allow more than within=1, or look at the",
        lambda: mesh.dof_at([0, 0, 0], 7): "direction: 7 is too large; give at most 6",
        lambda: mesh.field(["tip"], [1.0]): "dof 'tip': it names no node",
        lambda: mesh.field(["8.1"], [1.0]): "node 8: it is not in the mesh of",
        lambda: mesh.field(["7.1"], [1.0, 2.0]): "field: shape (2,) for 1 dofs",
        lambda: mesh.modes(reduced, 99): "count: 99 is too large; give at most 8",
        lambda: mesh.modes(reduced, 1, {"tpi": 1.0}): "springs: unknown dof 'tpi'; did you mean",
        lambda: mesh.motion(response, 5, reduced): "index: 5 is too large; give at most 4",
        lambda: mesh.motion(response, 0): "it names no node; names are node.direction",
        lambda: ss.Mesh([[0.0, 1.0]]): "mesh: nodes of shape (1, 2)",
        lambda: ss.Mesh(np.eye(3), numbers=[1, 1, 2]): "mesh: 3 numbers, 2 of them different",
        lambda: ss.Mesh(np.eye(3), [("line", [[0, 3]])]): "a line has a node that is not among",
        lambda: ss.Mesh([[0.0, np.inf, 0.0]]): "a coordinate is not finite",
        lambda: mesh.write_vtu(tmp_path / "a.vtu", {"a": [1.0]}): "field 'a': float64 of shape",
        lambda: mesh.write_vtu(tmp_path / "a.vtu", {"a": 1j * mesh.nodes}): "give real numbers",
    }.items():
        with pytest.raises(ss.ModelError, match=re.escape(message)) as refused:
            call()
        assert len(str(refused.value).splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_response_without_all_dofs_or_of_another_structure_is_refused(mesh, reduced, response):
    few = ss.forced_response(response.model, [100.0], 1, observe=["tip"])
    with pytest.raises(ss.ModelError, match="not all degrees of freedom were observed"):
        mesh.motion(few, 0, reduced)
    beam = ss.forced_response(ss.reference.snecma_beam(), [100.0], 1)
    with pytest.raises(ss.ModelError, match="the response has other degrees of freedom"):
        mesh.motion(beam, 0, reduced)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.inp", "*NODE\n1, zero\n", "a.inp: cannot be read as deck"),
        ("a.inp", "*NODE\n1, zero\n", "line 2: 'ZERO' is no real number; write the file again"),
        ("a.bdf", "BEGIN BULK\nGRID,1,,0.,zero,0.\n", "a.bdf: cannot be read as mesh: line 2: 'ze"),
        ("a.bdf", "BEGIN BULK\n\nGRID,x,,0.,0.,0.\n", "line 3: 'x' stands where a whole number m"),
        ("a.inp", "no deck", "a.inp: cannot be read as deck: it has no *NODE"),
        ("a.inp", "", "a.inp: cannot be read as deck: it has no *NODE"),
        ("a.txt", "1 2 3", "a.txt: cannot be read as mesh: Could not deduce file format"),
        ("a.vtu", "<VTKFile", "a.vtu: cannot be read as mesh"),
        ("a.msh", "$MeshFormat", "a.msh: cannot be read as mesh"),
    ],
)
def test_damaged_meshes_are_refused(name, content, message, tmp_path):
    (tmp_path / name).write_text(content)
    with pytest.raises(ss.ModelError, match=re.escape(message)) as refused:
        ss.read_mesh(tmp_path / name)
    assert len(str(refused.value).splitlines()) == 1


def test_a_missing_package_or_file_is_named(tmp_path, monkeypatch):
    with pytest.raises(ss.ModelError, match="no such file"):
        ss.read_mesh(tmp_path / "a.inp")
    monkeypatch.setitem(sys.modules, "meshio", None)
    (tmp_path / "a.vtu").write_text("<VTKFile")
    with pytest.raises(ss.ModelError, match=r"meshio: pip install 'stickslip\[fe\]'"):
        ss.read_mesh(tmp_path / "a.vtu")


def test_solids_take_hexahedra_alone():
    skfem = pytest.importorskip("skfem")
    for mesh in (3, skfem.MeshTet()):
        with pytest.raises(ss.ModelError, match=r"solid: mesh .* has no hexahedra; give a skfem.M"):
            ss.Solid(mesh, young=210e9, poisson=0.3, density=7850.0)

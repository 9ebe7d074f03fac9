"""Craig-Bampton reductions against full models, and solid elements against scikit-fem."""

import importlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import stickslip as ss
from stickslip.errors import ModelError

EXAMPLE = Path(__file__).parents[2] / "examples" / "turbine-blade"
NO_SKFEM = "scikit-fem is not installed: pip install 'stickslip[fe]'"


def chain(size, grounded=True):
    """Return mass and stiffness of masses in a row, the first one held."""
    K = 2.0 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1)
    if not grounded:
        K[0, 0] = 1.0
    K[-1, -1] = 1.0
    return scipy.sparse.csc_array(np.diag(np.linspace(1.0, 2.0, size))), scipy.sparse.csc_array(
        1e6 * K
    )


def test_all_modes_kept_is_the_full_structure():
    M, K = (matrix.toarray() for matrix in chain(20))
    reduced = ss.craig_bampton(M, K, [19, 4], modes=17)
    # 17 of 18 modes: only the highest frequency is missed
    full = np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True))
    own = np.sqrt(scipy.linalg.eigh(reduced.stiffness, reduced.mass, eigvals_only=True))
    np.testing.assert_allclose(own[:12], full[:12], rtol=1e-3)
    assert (own[:19] >= full[:19] * (1.0 - 1e-12)).all()  # Rayleigh-Ritz: never below


def test_every_mode_below_a_high_frequency_is_kept():
    M, K = (matrix.toarray() for matrix in chain(20))
    reduced = ss.craig_bampton(M, K, [19, 4], omega=1e9)
    full = scipy.linalg.eigh(K, M, eigvals_only=True)
    own = scipy.linalg.eigh(reduced.stiffness, reduced.mass, eigvals_only=True)
    np.testing.assert_allclose(own, full, rtol=1e-10)  # no mode is missing: nothing is lost
    assert ss.craig_bampton(M, K, [19, 4], modes=18).omega.size == 18
    # Two rows share an inertia: their difference has none, and no mode.
    M[:2, :2] = 1.0
    assert ss.craig_bampton(M, K, [19, 4], omega=1e9).omega.size == 17
    with pytest.raises(ModelError, match="modes: 18 is too large; give at most 17"):
        ss.craig_bampton(M, K, [19, 4], modes=18)


@pytest.mark.parametrize("size", [50, 900])  # dense modes, and Lanczos' method
def test_constraint_modes_keep_static_flexibility_exactly(size):
    M, K = chain(size)
    reduced = ss.craig_bampton(M, K, {"tip": size - 1, "damper": 10}, modes=5)
    force = np.zeros(size)
    force[-1] = 3.0
    full = scipy.sparse.linalg.spsolve(K, force)
    work = np.zeros(7)
    work[0] = 3.0
    found = reduced.recover(np.linalg.solve(reduced.stiffness, work))
    np.testing.assert_allclose(found, full, rtol=1e-9)
    assert reduced.forces(force) == [ss.Force("tip", 3.0)]
    assert reduced.dofs == ("tip", "damper", "mode-1", "mode-2", "mode-3", "mode-4", "mode-5")


def test_recovery_is_the_motion_of_the_full_structure():
    M, K = chain(60)
    reduced = ss.craig_bampton(M, K, {"tip": 59}, modes=45)
    damping = ss.Rayleigh(stiffness=1e-5)
    model = ss.Model(reduced.structure(damping), [], [ss.Force("tip", 1.0)])
    omega = 60.0
    frf = ss.forced_response(model, [omega], harmonics=1, observe=model.structure.dofs)
    small = frf.arrays.displacement[0, 1]
    dynamic = K.toarray() * (1.0 + 1e-5j * omega) - omega**2 * M.toarray()
    full = np.linalg.solve(dynamic, np.eye(60)[-1])
    np.testing.assert_allclose(reduced.recover(small), full, rtol=0, atol=1e-4 * abs(full).max())


@pytest.mark.slow
def test_modes_up_to_a_frequency():
    M, K = chain(300)
    squares = scipy.linalg.eigh(K.toarray()[:-1, :-1], M.toarray()[:-1, :-1], eigvals_only=True)
    limit = 0.5 * float(np.sqrt(squares[33]) + np.sqrt(squares[34]))
    reduced = ss.craig_bampton(M, K, [299], omega=limit)
    np.testing.assert_allclose(reduced.omega, np.sqrt(squares[:34]), rtol=1e-9)


def test_the_report_tells_a_held_structure_from_a_free_one():
    M, K = chain(80)
    held = ss.craig_bampton(M, K, [79], modes=10, dofs=[f"{node}.1" for node in range(80)])
    report = held.report(5)
    assert report.rigid == 0
    assert report.masses["1"] == pytest.approx(M.diagonal().sum())
    assert report.grounding["1"] > 1e-4
    full = np.sqrt(scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True))[:5]
    np.testing.assert_allclose(report.full, full, rtol=1e-9)
    assert 0.0 <= report.errors.min() < report.errors[:4].max() < 1e-3
    assert "the structure is held" in str(report)
    stuck = held.report(3, {"79.1": 1e6})
    spring = K.toarray() + 1e6 * np.diag(np.eye(80)[-1])
    full = np.sqrt(scipy.linalg.eigh(spring, M.toarray(), eigvals_only=True))[:3]
    np.testing.assert_allclose(stuck.full, full, rtol=1e-9)

    M, K = chain(80, grounded=False)
    free = ss.craig_bampton(M, K, [79], modes=10, dofs=[f"{node}.1" for node in range(80)]).report(
        5
    )
    assert free.rigid == 1
    assert free.grounding["1"] < 1e-12
    assert np.isnan(free.errors[0])
    assert "rigid body" in str(free)


def test_boundary_without_inertia():
    """Five masses of twenty, none of them at the boundary: the reduced mass is singular."""
    _, K = chain(20)
    M = np.diag([1.0] * 5 + [0.0] * 15)
    dofs = [f"{node}.1" for node in range(1, 21)]
    squares = 1.0 / scipy.linalg.eigh(M, K.toarray(), eigvals_only=True)[:-6:-1]
    for few in ({"modes": 5}, {"omega": 1e9}):
        reduced = ss.craig_bampton(M, K, [19], dofs=dofs, **few)
        assert reduced.omega.size == 5
        report = reduced.report(10)
        for found in (report.full, report.reduced):
            np.testing.assert_allclose(found, np.sqrt(squares), rtol=1e-12)
        fields = ss.Mesh(np.arange(60.0).reshape(20, 3)).modes(reduced, 5)
        told = [float(name.split()[3]) for name in fields]
        np.testing.assert_allclose(told, np.sqrt(squares) / (2 * np.pi), rtol=1e-5)
        for shape in fields.values():
            assert shape[:5, 0] @ shape[:5, 0] == pytest.approx(1.0)
    with pytest.raises(ModelError, match="modes: 6 is too large; give at most 5"):
        ss.craig_bampton(M, K, [19], modes=6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": np.diag([0.0] * 19 + [1.0])}, "mass: only boundary dofs have inertia"),
        ({"boundary": ["5.9"]}, r"boundary: unknown dof '5\.9'; did you mean '5\.1'"),
        ({"boundary": [20]}, "boundary: 20: 20 is too large; give at most 19"),
        ({"boundary": []}, "boundary: it is empty"),
        ({"boundary": {"a": 3, "b": 3}}, "a dof or a name is given twice"),
        ({"modes": None}, "give either modes=16, their number, or omega="),
        ({"omega": 10.0}, "give either modes=16, their number, or omega="),
        ({"modes": 30}, "modes: 30 is too large"),
        ({"modes": None, "omega": 1.0}, "lies below every fixed-interface mode, the first at"),
        ({"mass": np.zeros((20, 20))}, "mass: no entry of the diagonal is positive"),
        ({"dofs": ["1.1"]}, "1 names for 20 rows"),
        ({"stiffness": np.eye(19)}, "stiffness: 19 rows, but the mass has 20"),
        (
            {"stiffness": np.triu(np.ones((20, 20)))},
            "stiffness: not symmetric, by 1 of its largest",
        ),
        ({"stiffness": np.full((20, 20), np.nan)}, "stiffness: an entry is not finite"),
        ({"mass": "blade.op4"}, "mass: 'blade.op4' is not a matrix"),
        ({"stiffness": np.zeros((20, 20))}, "can still move as a rigid body"),
    ],
)
def test_what_cannot_be_reduced_is_refused(change, message):
    M, K = chain(20)
    given = {"mass": M, "stiffness": K, "boundary": [19], "modes": 4}
    given["dofs"] = [f"{node}.1" for node in range(20)]
    given |= change
    with pytest.raises(ModelError, match=message):
        ss.craig_bampton(given.pop("mass"), given.pop("stiffness"), given.pop("boundary"), **given)


def test_massless_dofs_inside_are_condensed():
    M, K = (matrix.toarray() for matrix in chain(30))
    M[4, 4] = M[17, 17] = 0.0
    reduced = ss.craig_bampton(M, K, [29], modes=12)
    shapes = scipy.linalg.eigh(M, K, eigvals_only=True)[::-1]
    full = np.sqrt(1.0 / shapes[:4])
    own = np.sqrt(scipy.linalg.eigh(reduced.stiffness, reduced.mass, eigvals_only=True))[:4]
    np.testing.assert_allclose(own, full, rtol=1e-3)
    np.testing.assert_allclose(reduced.report(4).full, full, rtol=1e-9)


def test_a_structure_held_too_little_is_refused():
    M, K = chain(600)
    loose = K.tolil()
    loose[299, 300] = loose[300, 299] = 0.0  # two parts; the first is held, the second not
    loose[299, 299], loose[300, 300] = 1e6, 1e6
    with pytest.raises(ModelError, match="can still move as a rigid body"):
        ss.craig_bampton(M, loose.tocsc(), [0], modes=4)


@pytest.fixture(scope="module")
def blade():
    """Return the example's modules and its reduction of a coarse mesh."""
    pytest.importorskip("skfem", reason=NO_SKFEM)
    sys.path.insert(0, os.fspath(EXAMPLE))
    try:
        reduce = importlib.import_module("reduce")
        yield reduce, reduce.Model.of(reduce.Blade(**reduce.COARSE))
    finally:
        sys.path.remove(os.fspath(EXAMPLE))


@pytest.mark.slow
def test_elements_are_those_of_scikit_fem(blade):
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    reduce, _ = blade
    tiny = {"along": 2, "through": 1, "up": (1, 1, 1, 2), "beside": (1, 1)}
    solid = reduce.Blade(**tiny).solid()
    basis = skfem.Basis(solid.mesh, skfem.ElementVector(skfem.ElementHexS2()), intorder=4)
    form = linear_elasticity(*lame_parameters(solid.young, solid.poisson))
    expected = form.assemble(basis)
    assert abs(solid.stiffness - expected).max() < 1e-13 * abs(expected).max()

    @skfem.BilinearForm
    def inertia(u, v, _):
        return solid.density * (u[0] * v[0] + u[1] * v[1] + u[2] * v[2])

    expected = inertia.assemble(basis)
    assert abs(solid.mass - expected).max() < 1e-13 * abs(expected).max()


@pytest.mark.slow
def test_a_linear_displacement_has_one_stress_everywhere(blade):
    _, model = blade
    solid = model.solid
    gradient = np.array([[1.0, 2.0, 3.0], [0.0, 5.0, 6.0], [7.0, 0.0, 10.0]]) * 1e-4
    stress = solid.stress((solid.nodes @ gradient.T).ravel())
    strain = 0.5 * (gradient + gradient.T)
    shear = solid.young / (2.0 * (1.0 + solid.poisson))
    lame = 2.0 * shear * solid.poisson / (1.0 - 2.0 * solid.poisson)
    expected = 2.0 * shear * strain + lame * np.trace(strain) * np.eye(3)
    places = [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]
    np.testing.assert_allclose(stress, np.tile(expected[places], (len(stress), 1)), rtol=1e-9)


@pytest.mark.slow
def test_the_coarse_blade_is_reduced_to_a_thousandth(blade):
    reduce, model = blade
    for springs in (None, {"damper": reduce.DAMPER_STIFFNESS}):
        report = model.reduction.report(10, springs)
        assert report.rigid == 0
        assert report.errors.max() < 1e-3
    first = report.full[0]
    errors = reduce.response_errors(model, np.array([0.5, 1.0005, 1.3]) * first)
    assert max(one["error"] for one in errors) < 1e-2


def test_the_shipped_blade_is_that_of_the_example(blade):
    reduce, _ = blade
    model = ss.reference.turbine_blade()
    with np.load(EXAMPLE / "blade.npz") as shipped:
        np.testing.assert_array_equal(shipped["mass"], model.structure.mass)
        np.testing.assert_array_equal(shipped["stiffness"], model.structure.stiffness)
        np.testing.assert_array_equal(shipped["force"], [one.amplitude for one in model.forces])
    assert model.structure.damping_law == reduce.DAMPING
    assert len(model.structure) == 18
    # report.md, the full structure of 58,092 degrees of freedom
    hertz = ss.natural_frequencies(model) / (2.0 * np.pi)
    np.testing.assert_allclose(hertz[:3], [264.653, 778.398, 1830.96], rtol=1e-4)


def test_von_mises_ranges():
    turning = np.zeros((2, 1, 6), complex)
    turning[0, 0, 0] = 5e6  # static: adds nothing
    turning[1, 0, 0] = 3e6
    assert ss.fe.von_mises_range(turning) == pytest.approx(6e6)
    shear = np.zeros((2, 1, 6), complex)
    shear[1, 0, 5], shear[1, 0, 4] = 1e6, 1e6j  # a shear that turns round: never zero
    assert ss.fe.von_mises_range(shear) == pytest.approx(2.0 * np.sqrt(3.0) * 1e6)
    even = np.zeros((3, 1, 6), complex)
    even[2, 0, 1] = 2e6
    assert ss.fe.von_mises_range(even) == pytest.approx(4e6)
    with pytest.raises(ModelError, match="give \\(harmonics, nodes, 6\\)"):
        ss.fe.von_mises_range(np.zeros((2, 6)))


@pytest.mark.slow
def test_stresses_of_the_coarse_blade_reach_paraview(blade, tmp_path, monkeypatch, capsys):
    meshio = pytest.importorskip("meshio")
    monkeypatch.chdir(tmp_path)
    stress = importlib.import_module("stress")
    found = stress.main(coarse=True)
    written = meshio.read("turbine-blade.vtu")
    field = written.point_data["von Mises range [Pa]"]
    assert field.argmax() + 1 == found["node"]
    assert written.cells[0].type == "hexahedron20"
    # VTK's order: each of the 12 last nodes lies midway between two corners
    cell = written.points[written.cells[0].data]
    np.testing.assert_allclose(cell[:, 8], 0.5 * (cell[:, 0] + cell[:, 1]), atol=1e-12)
    np.testing.assert_allclose(cell[:, 16], 0.5 * (cell[:, 0] + cell[:, 4]), atol=1e-12)
    tip = written.point_data["displacement amplitude [m]"][
        stress.Blade(**stress.COARSE).tip(blade[1].solid)
    ]
    assert tip[1] == pytest.approx(found["tip_m"], rel=1e-2)


@pytest.mark.parametrize("keep", [{"modes": 448}, {"omega": 1e4}])
def test_all_modes_of_many_rows_are_kept(keep):
    M, K = chain(450)
    reduced = ss.craig_bampton(M, K, [449, 4], **keep)
    assert reduced.omega.size == 448
    full = np.sqrt(scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True))
    own = np.sqrt(scipy.linalg.eigh(reduced.stiffness, reduced.mass, eigvals_only=True))
    np.testing.assert_allclose(own, full, rtol=1e-9)


def test_modes_that_have_no_inertia_are_no_modes():
    M, K = chain(450)
    # each two of the last rows move with the inertia of one
    M = M.tolil()
    for row in range(100, 440, 2):
        M[row, row] = M[row + 1, row + 1] = M[row, row + 1] = M[row + 1, row] = 1.0
    M = M.tocsc()
    assert ss.craig_bampton(M, K, [449, 4], modes=278).omega.size == 278
    with pytest.raises(ModelError, match="modes: 279"):
        ss.craig_bampton(M, K, [449, 4], modes=279)

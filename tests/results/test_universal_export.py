"""Results as Universal Files: what is read back has the numbers of the result."""

import numpy as np
import pytest

import stickslip as ss

BEAM = ss.reference.snecma_beam()
GRID = np.linspace(150.0, 250.0, 12)


def test_a_universal_file_has_the_receptances(tmp_path):
    pytest.importorskip("pyuff")
    frf = ss.forced_response(BEAM, GRID, 5)
    frf.export(tmp_path / "a.uff")
    functions = ss.read_frf(tmp_path / "a.uff")
    assert [one.dof for one in functions] == list(frf.dofs)
    for one in functions:
        mine = ss.Frf.of(frf, one.dof, "tip")
        assert one.reference == "tip"
        np.testing.assert_allclose(one.omega, mine.omega, rtol=1e-5)
        np.testing.assert_allclose(one.values, mine.values, rtol=1e-10)


def test_a_universal_file_has_the_functions_of_a_sweep(tmp_path):
    pyuff = pytest.importorskip("pyuff")

    def curve(model):
        return ss.forced_response(model, GRID, 3, observe=["damper", "tip"])

    swept = ss.sweep(BEAM, curve, slip_force=["100 N", "246 N"])
    swept.export(tmp_path / "a.uff")
    functions = ss.read_frf(tmp_path / "a.uff")
    pairs = [(about, dof) for about in swept.labels for dof in ("damper", "tip")]
    assert [(one.about, one.dof) for one in functions] == pairs
    assert swept.labels[0] == "slip force = 100 N"
    for number, one in enumerate(functions):
        mine = ss.Frf.of(swept.results[number // 2], one.dof, "tip")
        np.testing.assert_allclose(one.values, mine.values, rtol=1e-10)
    assert not np.allclose(functions[1].values, functions[3].values, rtol=1e-3)
    sets = pyuff.UFF(str(tmp_path / "a.uff")).read_sets()
    assert [one["id2"].strip() for one in sets] == [about for about, _ in pairs]

    orbits = ss.sweep(BEAM, lambda model: ss.exact_response(model, GRID[:2]), level=[0.5, 1.0])
    with pytest.raises(ss.ModelError, match="the result is an exact response; export it"):
        orbits.export(tmp_path / "b.uff")


def test_response_functions_are_those_of_one_force(tmp_path):
    pytest.importorskip("pyuff")
    with pytest.raises(ss.ModelError, match="the result is a transient; export it"):
        ss.transient(BEAM, 170.0, 2, samples=16).export(tmp_path / "a.uff")
    forces = [ss.Force("tip", 1.0), ss.Force("damper", 1.0)]
    both = ss.forced_response(ss.Model(BEAM.structure, BEAM.contacts, forces), GRID, 1)
    with pytest.raises(ss.ModelError, match="2 degrees of freedom have a force"):
        both.export(tmp_path / "a.uff")


def test_the_head_tells_of_forces_beside_the_reference(tmp_path):
    pytest.importorskip("pyuff")
    disk = ss.reference.beam_ring(6, 7e3, 2)
    ss.forced_response(disk, GRID, 3).export(tmp_path / "a.uff")
    said = {one.about for one in ss.read_frf(tmp_path / "a.uff")}
    assert said == {"to forces on all 6 sectors, engine order 2"}
    model = BEAM.replaced(forces=[*BEAM.forces, ss.Force("damper", 1.0)])
    frf = ss.Frf.of(ss.forced_response(model, GRID, 3), "tip", "tip", "bench")
    assert frf.about == "with forces in proportion at damper; bench"

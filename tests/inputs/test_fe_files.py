"""Matrices of finite-element codes, written by other programs."""

import os
import shutil
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import stickslip as ss
from stickslip.errors import ModelError

DATA = Path(__file__).parents[1] / "data"
CCX = shutil.which("ccx")
NO_CCX = "ccx is not installed: apt install calculix-ccx"
NO_ANSYS = "ansys-mapdl-reader is not installed: pip install 'stickslip[ansys]'"

op4 = pytest.importorskip("pyyeti.nastran.op4", reason="pip install 'stickslip[test]'")


def symmetric(size=12, seed=0):
    random = np.random.default_rng(seed).standard_normal((size, size))
    return random @ random.T * 1e7 + np.eye(size)


def files_of_nastran():
    """Return the OP4 files, most of them written by Nastran itself, in the tests of pyyeti."""
    import pyyeti.tests

    roots = [Path(root) for root in pyyeti.tests.__path__]
    files = [file for root in roots for file in (root / "nastran_op4_data").glob("*.op4")]
    # those of ten million columns have a file of their own, and one has no name for its matrix
    return sorted(f for f in files if "large" not in f.name and "badname" not in f.name)


@pytest.mark.parametrize("file", files_of_nastran(), ids=lambda file: file.name)
def test_op4_of_nastran_reads_as_pyyeti_does(file):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        names, matrices, _, kinds = op4.load(os.fspath(file), into="list", sparse=True)
    for name, expected, kind in zip(names, matrices, kinds, strict=True):
        if kind > 2:
            with pytest.raises(ModelError, match="is complex; export real matrices"):
                ss.read_matrix(file, name, sparse=True)
        else:
            found = ss.read_matrix(file, name, sparse=True)
            assert found.shape == expected.shape
            assert abs(found - expected).max() == 0.0


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("layout", ["dense", "bigmat", "nonbigmat"])
def test_op4_of_pyyeti_comes_back_to_the_last_bit(tmp_path, binary, layout):
    K, M = symmetric(), np.diag(np.arange(1.0, 13.0))
    file = tmp_path / "blade.op4"
    op4.write(os.fspath(file), {"KAA": K, "MAA": M}, binary=binary, digits=16, sparse=layout)
    np.testing.assert_array_equal(ss.read_matrix(file, "KAA"), K)
    np.testing.assert_array_equal(ss.read_matrix(file, "maa"), M)
    with pytest.raises(ModelError, match="choose one with key"):
        ss.read_matrix(file)
    with pytest.raises(ModelError, match="did you mean 'KAA'"):
        ss.read_matrix(file, "KAB")


def test_dmig_of_pyyeti_comes_back_to_its_digits(tmp_path):
    pandas = pytest.importorskip("pandas")
    from pyyeti import nastran

    index = pandas.MultiIndex.from_product([(7, 101), (1, 2, 3)], names=["id", "dof"])
    K, M = symmetric(6), np.diag(np.arange(1.0, 7.0))
    file = tmp_path / "blade.pch"
    frames = {"KAAX": pandas.DataFrame(K, index, index), "MAAX": pandas.DataFrame(M, index, index)}
    nastran.wtdmig(os.fspath(file), frames)
    np.testing.assert_allclose(ss.read_matrix(file, "KAAX"), K, atol=5e-10 * np.abs(K).max())
    np.testing.assert_array_equal(ss.read_matrix(file, "MAAX"), M)
    assert ss.read_dofs(file, "KAAX") == ("7.1", "7.2", "7.3", "101.1", "101.2", "101.3")
    assert ss.read_dofs(file) == ss.read_dofs(file, "KAAX")
    with pytest.raises(ModelError, match="choose one with key"):
        ss.read_matrix(file)
    with pytest.raises(ModelError, match="unknown key"):
        ss.read_dofs(file, "BAAX")
    whole = nastran.rddmig(os.fspath(file))["kaax"].to_numpy()
    np.testing.assert_array_equal(ss.read_matrix(file, "KAAX"), whole)


def test_dmig_in_narrow_and_free_fields(tmp_path):
    file = tmp_path / "narrow.pch"
    file.write_text(
        "$ a spring of two grid points\n"
        "GRID    27              0.      0.      0.\n"
        "DMIG    STIF    0       6       2       0\n"
        "DMIG    STIF    27      1               27      1       3.+5\n"
        "        2       3       -1.25D+5\n"
        "DMIG,STIF,2,3,,2,3,4.0E5\n"
    )
    np.testing.assert_array_equal(ss.read_matrix(file, "STIF"), [[4e5, -1.25e5], [-1.25e5, 3e5]])
    assert ss.read_dofs(file) == ("2.3", "27.1")


@pytest.mark.parametrize("head", ["DMIG*", "DMIG   *"])
def test_dmig_in_wide_fields_wherever_the_star_stands(tmp_path, head):
    file = tmp_path / "wide.pch"
    file.write_text(
        "DMIG    STIF    0       6       2       0\n"
        f"{head:<8}{'STIF':<16}{27:<16}{1:<16}\n"
        f"{'*':<8}{27:<16}{1:<16}{'3.0000000001D+5':<16}\n"
    )
    np.testing.assert_array_equal(ss.read_matrix(file, "STIF"), [[3.0000000001e5]])


def test_calculix_matrices_have_its_frequencies():
    # written by ccx 2.20 of Debian from bar.inp, whose job printed the frequencies in bar.dat
    K, M = (ss.read_matrix(DATA / f"bar{end}") for end in (".sti", ".mas"))
    assert ss.read_dofs(DATA / "bar.sti") == ss.read_dofs(DATA / "bar.dof")
    assert ss.read_dofs(DATA / "bar.sti")[:4] == ("5.1", "5.2", "5.3", "6.1")
    hertz = np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)) / (2.0 * np.pi)
    printed = [
        float(line.split()[3])
        for line in (DATA / "bar.dat").read_text().splitlines()
        if len(line.split()) == 5 and line.split()[0].isdigit()
    ]
    assert len(printed) == 4
    np.testing.assert_allclose(hertz[:4], printed, rtol=2e-6)


def test_calculix_substructure_in_the_format_of_abaqus():
    # the same bar; ccx 2.20 holds the nodes that are not retained, and prints 13 digits
    K = ss.read_matrix(DATA / "bar-substructure.mtx")
    names = ss.read_dofs(DATA / "bar-substructure.mtx")
    assert names == ("9.1", "9.2", "9.3", "11.1", "11.2", "11.3")
    full, rows = ss.read_matrix(DATA / "bar.sti"), ss.read_dofs(DATA / "bar.dof")
    kept = [rows.index(name) for name in names]
    np.testing.assert_allclose(K, full[np.ix_(kept, kept)], rtol=0.0, atol=1e-12 * np.abs(K).max())


@pytest.mark.parametrize("whole", [True, False])
def test_abaqus_coordinates_and_matrix_input(tmp_path, whole):
    # the layout of *MATRIX OUTPUT, as in files that Abaqus wrote: "1 25 -8.459980339667306e+09"
    K = symmetric(6)
    places = [(i, j) for i in range(6) for j in range(6) if whole or i >= j]
    coordinates = "".join(f"{i + 1} {j + 1} {K[i, j]: .15e}\n" for i, j in places)
    (tmp_path / "job_STIF1.mtx").write_text(coordinates)
    np.testing.assert_allclose(ss.read_matrix(tmp_path / "job_STIF1.mtx"), K, rtol=1e-15)
    with pytest.raises(ModelError, match="does not name its rows"):
        ss.read_dofs(tmp_path / "job_STIF1.mtx")
    named = "".join(
        f"{i // 3 + 4},{i % 3 + 1}, {j // 3 + 4},{j % 3 + 1}, {K[i, j]:.15e}\n" for i, j in places
    )
    (tmp_path / "job_STIF2.mtx").write_text("** matrix input\n*MATRIX INPUT, NAME=K\n" + named)
    np.testing.assert_allclose(ss.read_matrix(tmp_path / "job_STIF2.mtx"), K, rtol=1e-15)
    assert ss.read_dofs(tmp_path / "job_STIF2.mtx") == ("4.1", "4.2", "4.3", "5.1", "5.2", "5.3")


def test_ansys_full_as_its_reader_reads_it():
    reader = pytest.importorskip("ansys.mapdl.reader", reason=NO_ANSYS)
    file = Path(reader.__file__).parent / "examples" / "file.full"
    K, names = ss.read_matrix(file, "stiffness"), ss.read_dofs(file, "stiffness")
    assert K.shape == (len(names), len(names)) == (900, 900)
    dofs, upper, _ = reader.read_binary(os.fspath(file)).load_km(sort=False)
    rows = {f"{node}.{way + 1}": row for row, (node, way) in enumerate(dofs)}
    own = np.array([rows[name] for name in names])
    expected = (upper + scipy.sparse.triu(upper, 1).T)[own][:, own]
    np.testing.assert_array_equal(K, expected.toarray())


def test_ansys_full_without_its_reader_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    (tmp_path / "file.full").write_bytes(b"x" * 1000)
    with pytest.raises(ModelError, match=r"pip install 'stickslip\[ansys\]'.* HBMAT"):
        ss.read_matrix(tmp_path / "file.full", "mass")


@pytest.mark.skipif(CCX is None, reason=NO_CCX)
def test_ccx_writes_the_stored_matrices_again(tmp_path):
    shutil.copy(DATA / "bar.inp", tmp_path)
    subprocess.run([CCX, "bar"], cwd=tmp_path, check=True, capture_output=True)
    for end in (".sti", ".mas"):
        stored, made = (ss.read_matrix(folder / f"bar{end}") for folder in (DATA, tmp_path))
        np.testing.assert_allclose(made, stored, rtol=0.0, atol=1e-12 * np.abs(stored).max())


def test_study_files_take_a_named_matrix_of_a_file(tmp_path):
    K, M = symmetric(3), np.diag([1.0, 2.0, 3.0])
    op4.write(os.fspath(tmp_path / "blade.op4"), {"KAA": K, "MAA": M})
    (tmp_path / "study.toml").write_text(
        '[structure]\nmass = { file = "blade.op4", key = "MAA" }\n'
        'stiffness = { file = "blade.op4", key = "KAA" }\ndamping = { modal = 0.001 }\n'
        '[[force]]\ndof = "0"\namplitude = 1.0\n'
        "[analysis]\nomega = [1.0, 2.0]\nharmonics = 1\n"
    )
    study = ss.study.Study.load(tmp_path / "study.toml")
    np.testing.assert_allclose(study.model.structure.stiffness, K, rtol=1e-15)

"""Numbers as programs and countries write them: none is silently another one."""

import os

import numpy as np
import pytest

import stickslip as ss
from stickslip.io import read_dofs, read_matrix
from stickslip.io.curve import read_curve


@pytest.mark.parametrize(
    "text",
    [
        "20.5,0.0012\n21.5,-1.3E-3\n",
        "20.5, 0.0012,\n21.5, -1.3E-3,\n",
        "20.5;0.0012;\n21.5;-1.3E-3;\n",
        "20.5, 0.0012;\n21.5, -1.3E-3;\n",
        "20.5 0.0012,\n21.5 -1.3E-3,\n",
        "20.5;0.0012,\n21.5;-1.3E-3; \n",
        "20.5\t0.0012 # here\n21.5\t-1.3E-3\n",
        "2.05D1 0.0012\n\n2.15+1 -1.3-3\n",
        # a comma is a decimal point where something else separates the fields
        "20,5;0,0012\n21,5;-1,3E-3\n",
        "Frequenz [Hz]; Weg [m]\n20,5; 0,0012\n21,5; -1,3E-3\n",
        "20,5\t0,0012\n21,5\t-1,3E-3\n",
        "20,5   0,0012\n21,5  -1,3E-3\n",
        "# 7, 8\nf, x\nHz, m\n2\n20.5, 0.0012\n21.5, -1.3E-3\n",
    ],
)
def test_columns(tmp_path, text):
    (tmp_path / "a.csv").write_text(text)
    x, y = read_curve(tmp_path / "a.csv")
    assert (x.tolist(), y.tolist()) == ([20.5, 21.5], [0.0012, -0.0013])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        # an empty field is no reason to take the next one
        ("1,2,3\n1,,3\n", "line 2: an empty field"),
        ("1;;3\n1;2;3\n", "line 1: an empty field"),
        (",1,2\n3,4,5\n", "line 1: an empty field"),
        ("1.000,5;2\n", "line 1: '1.000,5' has a comma beside a point"),
        # a first line of numbers is no heading, whatever stands behind them
        ("20,0.001 first\n30,0.002\n", "line 1: '20,0.001' has a comma beside a point"),
        ("20,5;0,0012 m\n21,5;0,0013 m\n", "line 1: '0.0012 m' is no"),
        # a decimal comma is none between fields where the second one is missing
        ("20,5;0,0012\n21,5;\n", "line 2: 1 number"),
        ("20,5;\n21,5;0,0012\n", "line 1: 1 number"),
        ("1;2\n1,000,5;2\n", "line 2: '1,000,5' has a comma beside a point"),
    ],
)
def test_columns_that_can_be_misread_are_refused(tmp_path, text, says):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(ss.ModelError, match=r"a\.csv") as error:
        read_curve(tmp_path / "a.csv")
    assert says in str(error.value)


@pytest.mark.parametrize(
    "text",
    [
        "2e4,-1.5,0\n-1.5,3,-7\n0,-7,4\n",
        "\ufeff2e4;-1,5;0;\n-1,5;3;-7;\n0;-7;4;\n",
        "% K [N/m]\n2e4  -1.5 0\n\n-1.5 3 -7\n0 -7\t4",
        "x, y, z\n2D4, -1.5, 0\n-1.5, 3, -7\n0, -7, 4\n",
    ],
)
def test_a_matrix_in_rows_of_text(tmp_path, text):
    (tmp_path / "K.csv").write_text(text, encoding="utf-8")
    assert read_matrix(tmp_path / "K.csv").tolist() == [[2e4, -1.5, 0], [-1.5, 3, -7], [0, -7, 4]]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1,2\n3\n", "line 2: 1 number; give a row of numbers per line"),
        ("1,2\n3,4,5\n", "line 2: 3 numbers; give"),
        ("1,2\n3,\n4,5\n", "line 2: 1 number; give"),
        ("1;2\n3;4 N/m\n", "line 2: '4 N/m' is no"),
        (",x,y\nx,1,2\ny,2,4\n", "line 2: 'x' is no"),
        ("1;2 N\n3;4\n", "line 1: '2 N' is no"),
        ("1;2;3x4;5\n3;4\n", "line 1: '3x4' is no"),
        ("1,nan\nnan,4\n", "finite"),
        (",,,", "line 1: 0 numbers; give a row"),
        (",\n,\n", "line 1: 0 numbers; give a row"),
        (";;\n", "line 1: 0 numbers; give a row"),
        (",,\n1,2\n3,4\n", "line 1: 0 numbers; give a row"),
    ],
)
def test_rows_of_text_that_are_no_matrix_are_refused(tmp_path, text, says):
    (tmp_path / "K.csv").write_text(text)
    with pytest.raises(ss.ModelError, match=r"K\.csv") as error:
        read_matrix(tmp_path / "K.csv")
    assert says in str(error.value)


@pytest.mark.parametrize(("kind", "mirrored"), [("UNSYMMETRIC", 0.0), ("SYMMETRIC", 5.0)])
def test_abaqus_says_whether_a_triangle_is_all(tmp_path, kind, mirrored):
    file = tmp_path / "k.mtx"
    file.write_text(f"*Matrix Input, name=K, type={kind}\n1,1,1,1,4.\n1,1,1,2,5.\n1,2,1,2,3.\n")
    np.testing.assert_array_equal(read_matrix(file), [[4.0, 5.0], [mirrored, 3.0]])
    assert read_dofs(file) == ("1.1", "1.2")


@pytest.mark.parametrize("written", ["(1P,3(D12.5))", "(1P,3D12.5)", "(1p3d12.5)", "(3(E12.5E3))"])
def test_harwell_boeing_formats_with_a_group(tmp_path, written):
    lines = [
        "title".ljust(72) + "key",
        "".join(f"{one:14d}" for one in (3, 1, 1, 1)),
        "RSA".ljust(14) + "".join(f"{one:14d}" for one in (2, 2, 3, 0)),
        f"{'(3I4)':16}{'(3I4)':16}{written:20}",
        "   1   3   4",
        "   1   2   2",
        " 4.00000D+00-1.50000D+00 3.00000D+00",
    ]
    (tmp_path / "k.hb").write_text("\n".join([*lines, ""]))
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.hb"), [[4.0, -1.5], [-1.5, 3.0]])
    text = (tmp_path / "k.hb").read_text().replace(written, "(2(1X,D11.5))")
    (tmp_path / "k.hb").write_text(text)
    with pytest.raises(ss.ModelError, match="unsupported number format"):
        read_matrix(tmp_path / "k.hb")


def universal(path, units=None, **labels):
    """Write a measured function, and the units of the file before it."""
    pyuff = pytest.importorskip("pyuff", reason="pip install 'stickslip[fe]'")
    sets = []
    if units:
        code, length, force = units
        sets.append(
            pyuff.prepare_164(
                units_code=code,
                units_description="units",
                temp_mode=1,
                length=length,
                force=force,
                temp=1.0,
                temp_offset=0.0,
            )
        )
    sets.append(
        pyuff.prepare_58(
            binary=0,
            func_type=4,
            rsp_node=17,
            rsp_dir=3,
            ref_node=4,
            ref_dir=1,
            data=np.array([1.0, 2.0j, 3.0]),
            x=np.array([1.0, 2.0, 4.0]),
            abscissa_spacing=0,
            abscissa_spec_data_type=18,
            ordinate_spec_data_type=12,
            orddenom_spec_data_type=13,
            **labels,
        )
    )
    pyuff.UFF(os.fspath(path)).write_sets(sets, mode="add")
    return path


@pytest.mark.parametrize("units", [None, (1, 1.0, 1.0), (9, 1.0, 1.0)])
@pytest.mark.parametrize("label", ["", "NONE", "m/s^2", "(m/s2)/N", "accel in m/s^2"])
def test_functions_in_si_units_are_read(tmp_path, units, label):
    path = universal(tmp_path / "a.uff", units, ordinate_axis_units_lab=label)
    (frf,) = ss.read_frf(path)
    np.testing.assert_array_equal(frf.values, [1.0, 2.0j, 3.0])


@pytest.mark.parametrize(
    ("units", "labels", "says"),
    [
        ((5, 1000.0, 1000.0), {}, "its units are those of code 5; export it in m, s and N"),
        ((7, 39.37, 0.2248), {}, "code 7"),
        (None, {"ordinate_axis_units_lab": "mm/s^2"}, "its response is in 'mm/s^2'"),
        (None, {"ordinate_axis_units_lab": "g"}, "its response is in 'g'"),
        (None, {"ordinate_axis_units_lab": "in/s^2"}, "its response is in 'in/s^2'"),
        (None, {"ordinate_axis_units_lab": "accel (in/s^2)"}, "its response is in 'accel"),
        (None, {"ordinate_axis_units_lab": "accel in in/s^2"}, "its response is in 'accel"),
        (None, {"orddenom_axis_units_lab": "lbf"}, "its force is in 'lbf'"),
    ],
)
def test_functions_in_other_units_are_refused(tmp_path, units, labels, says):
    path = universal(tmp_path / "a.uff", units, **labels)
    with pytest.raises(ss.ModelError, match=r"a\.uff") as error:
        ss.read_frf(path)
    assert says in str(error.value)


def test_dmig_in_wide_free_fields(tmp_path):
    """A line of wide fields has four of them, parted by columns or by commas."""
    (tmp_path / "k.pch").write_text(
        "DMIG,STIF,0,6,2,0\nDMIG*,STIF,27,1,\n*,27,1,3.+5,\n*,2,3,-1.25D+5\nDMIG,STIF,2,3,,2,3,4.0E5\n"
    )
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.pch"), [[4e5, -1.25e5], [-1.25e5, 3e5]])
    assert read_dofs(tmp_path / "k.pch") == ("2.3", "27.1")


def test_dmig_of_scalar_points(tmp_path):
    (tmp_path / "k.pch").write_text("DMIG,STIF,0,6,2,0\nDMIG,STIF,101,,,101,,5.\n")
    assert read_dofs(tmp_path / "k.pch") == ("101.0",)
    (tmp_path / "k.pch").write_text("INCLUDE 'rest'\nDMIG,STIF,0,6,2,0\nDMIG,STIF,101,,,101,,5.\n")
    with pytest.raises(ss.ModelError, match="line 1: INCLUDE: write the matrices into one file"):
        read_matrix(tmp_path / "k.pch")


def output4(written, exponent="E+00", form=6):
    """Return a matrix of OUTPUT4 as text."""
    columns = [(1, (4.0, -1.0)), (2, (-1.0, 3.0)), (3, (1.0,))]
    lines = [f"{2:8d}{2:8d}{form:8d}{2:8d}{'K':8s}{written}"]
    for column, values in columns:
        lines.append(f"{column:8d}{1:8d}{len(values):8d}")
        numbers = "".join(f"{one:23.16E}" for one in values)
        lines.append(numbers.replace("E+00", exponent))
    return "\n".join([*lines, ""])


@pytest.mark.parametrize(
    ("written", "exponent"),
    [
        ("1P,3E23.16", "E+00"),
        ("1P3E23.16", "e+00"),
        ("1P,3D23.16", "D+00"),
        ("(1P,3E23.16)", "E+00"),
        (" 1P, 3E23.16", "E+00"),
        ("1P,3E23.16E3", "+000"),
    ],
)
def test_op4_formats(tmp_path, written, exponent):
    (tmp_path / "k.op4").write_text(output4(written, exponent))
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.op4"), [[4.0, -1.0], [-1.0, 3.0]])


@pytest.mark.parametrize(("form", "kind"), [(3, "diagonal"), (8, "identity")])
def test_op4_matrices_that_are_packed_are_refused(tmp_path, form, kind):
    (tmp_path / "k.op4").write_text(output4("1P,3E23.16", form=form))
    with pytest.raises(ss.ModelError, match=f"'K' is a packed {kind} one; export it as square"):
        read_matrix(tmp_path / "k.op4")

"""Frequency response functions in Universal Files."""

import os
import signal

import numpy as np
import pytest

import stickslip as ss
from stickslip.errors import ModelError

pyuff = pytest.importorskip("pyuff", reason="pip install 'stickslip[fe]'")

HERTZ = np.linspace(10.0, 50.0, 30)
VALUES = np.exp(1j * HERTZ / 7.0) * 1e-6 / HERTZ


def written(path, **changes):
    """Write a measured function as a test-bench program does."""
    entries = {
        "binary": 0,
        "func_type": 4,
        "rsp_node": 17,
        "rsp_dir": -3,
        "ref_node": 4,
        "ref_dir": 1,
        "data": VALUES,
        "x": HERTZ,
        "abscissa_spacing": 0,
        "abscissa_spec_data_type": 18,
        "ordinate_spec_data_type": 12,
        "orddenom_spec_data_type": 13,
    }
    # pyuff 2.5 loses binary sets that it writes with mode="overwrite"
    pyuff.UFF(os.fspath(path)).write_sets(pyuff.prepare_58(**entries | changes), mode="add")
    return path


# pyuff 2.5 leaves the file open that it has written binary sets to
@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("binary", [0, 1])
def test_measured_functions_are_read_to_their_digits(tmp_path, binary):
    (found,) = ss.read_frf(written(tmp_path / "bench.uff", binary=binary))
    assert (found.dof, found.reference, found.quantity) == ("17.3-", "4.1", "acceleration")
    digits = 1e-15 if binary else 5e-6
    np.testing.assert_allclose(found.omega, 2.0 * np.pi * HERTZ, rtol=digits)
    np.testing.assert_allclose(found.values, VALUES, rtol=1e-15 if binary else 1e-11)
    np.testing.assert_allclose(found.receptance(), -found.values / found.omega**2)


def test_computed_functions_reach_other_programs(tmp_path):
    model = ss.reference.snecma_beam()
    curve = ss.forced_response(model, omega=np.linspace(150.0, 250.0, 30), harmonics=3)
    frf = ss.Frf.of(curve, "damper", "tip")
    expected = curve.coefficients("damper")[:, 1] / 20.313
    np.testing.assert_allclose(frf.values, expected)
    ss.write_frf(
        tmp_path / "beam.uff", [frf, ss.Frf(frf.omega, frf.values, "9.1", "9.2", "velocity")]
    )
    theirs = pyuff.UFF(os.fspath(tmp_path / "beam.uff")).read_sets()
    assert [one["ordinate_spec_data_type"] for one in theirs] == [8, 11]
    assert [one["rsp_node"] for one in theirs] == [0, 9]
    assert theirs[0]["rsp_ent_name"].strip() == "damper"
    np.testing.assert_allclose(theirs[0]["data"], expected, rtol=1e-11)
    np.testing.assert_allclose(theirs[0]["x"], curve.omega / (2.0 * np.pi), rtol=5e-6)
    again = ss.read_frf(tmp_path / "beam.uff")
    assert [(one.dof, one.reference, one.quantity) for one in again] == [
        ("damper", "tip", "displacement"),
        ("9.1", "9.2", "velocity"),
    ]
    assert list(tmp_path.iterdir()) == [tmp_path / "beam.uff"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"func_type": 1, "data": VALUES.real}, "holds no frequency response function"),
        ({"ordinate_spec_data_type": 2}, "neither displacement, nor velocity, nor acceleration"),
        ({"orddenom_spec_data_type": 8}, "a response per something else than force"),
        ({"abscissa_spec_data_type": 17}, "a function of something else than frequency"),
        ({"x": HERTZ[::-1]}, "the frequencies do not ascend"),
    ],
)
def test_other_functions_are_refused(tmp_path, changes, message):
    with pytest.raises(ModelError, match=message):
        ss.read_frf(written(tmp_path / "bench.uff", **changes))


def test_bad_functions_are_refused(tmp_path):
    with pytest.raises(ModelError, match="give two lists of one length"):
        ss.Frf([1.0, 2.0], [1.0], "1.1", "1.1")
    with pytest.raises(ModelError, match="not finite"):
        ss.Frf([1.0, 2.0], [1.0, np.nan], "1.1", "1.1")
    with pytest.raises(ModelError, match="unknown choice 'speed'"):
        ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.1", "speed")
    long = ss.Frf([1.0, 2.0], [1.0, 2.0], "leading-edge", "1.1")
    with pytest.raises(ModelError, match="'leading-edge' has 12 characters; the format holds 10"):
        ss.write_frf(tmp_path / "long.uff", long)
    assert list(tmp_path.iterdir()) == []
    curve = ss.forced_response(ss.reference.snecma_beam(), omega=[150.0, 160.0], harmonics=1)
    with pytest.raises(ModelError, match="no force at 'damper'"):
        ss.Frf.of(curve, "tip", "damper")
    spring = ss.Cubic("x", stiffness=5e7)
    single = ss.Structure([[1.0]], [[1e4]], [[1.0]], ["x"])
    folded = ss.forced_response(ss.Model(single, [spring], [ss.Force("x", 2.0)]), (80.0, 160.0))
    with pytest.raises(ModelError, match="the curve folds 2 times, so that it has several values"):
        ss.Frf.of(folded, "x", "x")
    with pytest.raises(ModelError, match="no such file"):
        ss.read_frf(tmp_path / "missing.uff")


def test_what_tells_functions_apart_is_one_line(tmp_path):
    about = "preload = 1 N\nlevel = 2" + 99 * "x"
    given = ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.1", about=about)
    ss.write_frf(tmp_path / "a.uff", [given, ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.1")])
    named, plain = ss.read_frf(tmp_path / "a.uff")
    assert (named.about, plain.about) == (f"preload = 1 N level = 2{57 * 'x'}", "")
    with pytest.raises(ss.ModelError, match=r"about: .* has a control character"):
        ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.1", about="a\0b")


def test_a_table_is_sent_to_what_reads_it(tmp_path):
    path = tmp_path / "level-100.csv"
    path.write_text("Frequency [Hz];Amplitude [mm]\n20,5;0,0012\n21;0,0015\n")
    with pytest.raises(ModelError, match="no Universal File; read_curve reads a table"):
        ss.read_frf(path)
    frequency, amplitude = ss.read_curve(path)
    assert frequency.tolist() == [20.5, 21.0]
    assert amplitude.tolist() == [0.0012, 0.0015]


@pytest.mark.parametrize(("old", "new"), [("    -1\n", "    -1   \n"), ("\n    58", "\n     58")])
def test_functions_that_pyuff_passes_over_are_missed(tmp_path, old, new):
    """Blanks beside one of the delimiters, or before the number of a dataset."""
    path = tmp_path / "two.uff"
    ss.write_frf(path, 2 * [ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.2")])
    content = path.read_text()
    assert len(ss.read_frf(path)) == 2
    head, found, rest = content.rpartition(old)
    assert found
    path.write_text(head + new + rest)
    with pytest.raises(ModelError, match="of 2 datasets 58 1 can be found: blanks beside"):
        ss.read_frf(path)
    path.write_text("".join(f"{line:80}\n" for line in content.splitlines()))
    assert len(ss.read_frf(path)) == 2


@pytest.fixture
def pressed(monkeypatch):
    """Press Ctrl-C in a function of pyuff, at the first call that has some arguments."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def press(module, name, work, fits=lambda *_: True):
        left = [signal.SIGINT]

        def stopped(*arguments):
            if left and fits(*arguments):
                signal.raise_signal(left.pop())
            return work(*arguments)

        stopped.dtype = np.dtype(int)  # numpy takes what stands for int as a type
        monkeypatch.setattr(module, name, stopped, raising=False)
        return left

    yield press
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_reaches_who_writes(tmp_path, pressed):
    head = pyuff.datasets.dataset_58
    left = pressed(head, "_opt_fields", head._opt_fields)
    with pytest.raises(KeyboardInterrupt):
        ss.write_frf(tmp_path / "a.uff", ss.Frf([1.0, 2.0], [1.0, 2.0], "1.1", "1.1"))
    assert not left
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", ["dataset", "kind", "count"])
def test_ctrl_c_reaches_who_reads(tmp_path, pressed, place):
    path = written(tmp_path / "bench.uff")
    head = pyuff.datasets.dataset_58
    if place == "dataset":
        left = pressed(head, "_parse_header_line", head._parse_header_line)
    else:
        # pyuff passes over what is raised at the kind of a dataset, and goes on
        kind = b"    58" if place == "kind" else 1
        left = pressed(pyuff.pyuff, "int", int, lambda value: value == kind)
    with pytest.raises(KeyboardInterrupt):
        ss.read_frf(path)
    assert not left

"""The package: its exports, and libraries that wait for their use."""

import subprocess
import sys

import pytest

import stickslip as ss
from stickslip.reference import snecma_beam

# the package


def test_everything_exported_is_there():
    for name in ss.__all__:
        assert getattr(ss, name) is not None
        assert name in dir(ss)
    assert set(ss._HOMES) | set(ss._MODULES) == set(ss.__all__)
    assert ss.plot.curves is not None
    assert ss.study.Study is not None
    assert ss.reference.snecma_beam is snecma_beam


def test_unknown_export_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'stickslip' has no attribute 'Jenkin'"):
        _ = ss.Jenkin


def test_heavy_libraries_wait_for_their_use():
    heavy = ("scipy", "xarray", "matplotlib", "pint", "pydantic", "typer", "rich", "h5netcdf")
    code = (
        "import sys, stickslip as ss; "
        "ss.Model(ss.Structure([[1.0]], [[1.0]]), [], [ss.Force('0', 1.0)]); "
        f"print([name for name in {heavy} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"

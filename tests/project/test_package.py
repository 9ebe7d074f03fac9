"""The package: its exports, and libraries that wait for their use."""

import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

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
    # Python looks here for what may have been meant.
    with pytest.raises(AttributeError) as told:
        _ = ss.Boucwen
    assert (told.value.name, told.value.obj) == ("Boucwen", ss)


def test_heavy_libraries_wait_for_their_use():
    heavy = ("scipy", "xarray", "matplotlib", "pint", "pydantic", "typer", "rich", "h5netcdf")
    code = (
        "import sys, stickslip as ss; "
        "ss.Model(ss.Structure([[1.0]], [[1.0]]), [], [ss.Force('0', 1.0)]); "
        f"print([name for name in {heavy} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_show_reads_a_file_without_what_draws_and_parses(tmp_path):
    model = ss.Model(ss.Structure([[1.0]], [[1.0]], [[0.1]]), [], [ss.Force("0", 1.0)])
    ss.forced_response(model, [0.5], 1).save(tmp_path / "it.nc")
    heavy = ("scipy", "xarray", "pandas", "matplotlib", "pint", "h5netcdf", "stickslip.study")
    code = (
        "import atexit, sys; from stickslip.cli import app; "
        f"atexit.register(lambda: print([name for name in {heavy} if name in sys.modules])); "
        "app(['show', sys.argv[1]])"
    )
    command = [sys.executable, "-c", code, str(tmp_path / "it.nc")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.slow
def test_the_stub_has_the_keys_of_the_settings():
    """What editors read is what `docs/make_stub.py` writes of the signatures at run time."""
    sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
    try:
        make_stub = importlib.import_module("make_stub")
    finally:
        del sys.path[0]
    text = make_stub.stub()
    assert "max_samples: int = 16384" in text
    assert make_stub.STUB.read_text("utf-8") == text


def test_help_names_every_key():
    for name in ss.__all__:
        value = getattr(ss, name)
        if not hasattr(value, "__settings__"):
            continue
        for key in inspect.signature(value).parameters:
            assert re.search(rf"^(\w+, )*{key}(, \w+)* : ", value.__doc__, re.M), (name, key)


def test_the_command_is_a_module_too():
    command = [sys.executable, "-m", "stickslip", "run", "none.toml"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, "error: none.toml: no such study file\n")

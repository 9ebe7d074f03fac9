"""Uncertain parameters from study files, from the file to the picture."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

import stickslip as ss
from small_study import PAD
from stickslip.cli import app
from stickslip.study import Study

STUDY = (
    PAD
    + """
[analysis]
kind = "uncertainty"
samples = 20
harmonics = 1

[analysis.parameters]
"pad.slip_force" = {distribution = "uniform", loc = 1.5, scale = 1}
"damping.ratio" = {distribution = "lognorm", s = 0.1, scale = 0.005}

[analysis.quantity]
"""
)
PEAK = 'kind = "highest-peak"\ndof = "tip"\nomega = {from = "10 Hz", to = "25 Hz"}'
KINDS = {
    "peak": PEAK,
    "optimum": 'kind = "optimum"\ndof = "tip"\nbounds = [0.05, 50]',
    "backbone": 'kind = "backbone"\namplitude = [1e-4, 1e-3, 1e-2]',
}
QUANTITIES = {
    "peak": ss.HighestPeak("tip", (20 * np.pi, 50 * np.pi)),
    "optimum": ss.Optimum("tip", bounds=(0.05, 50.0)),
    "backbone": ss.Backbone([1e-4, 1e-3, 1e-2]),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_says_what_a_call_does(kind):
    study = Study.parse(STUDY + KINDS[kind])
    settings = study.tables.analysis
    assert settings.quantity == QUANTITIES[kind]
    own = settings.parameters["damping.ratio"]
    assert own == {"distribution": "lognorm", "s": 0.1, "loc": 0.0, "scale": 0.005}
    json.dumps(settings.model_dump())


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_it_runs_from_the_file_to_the_picture(kind, tmp_path):
    file = tmp_path / "it.toml"
    file.write_text(STUDY.replace("samples = 20", "samples = 4") + KINDS[kind], encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "out" / "it.db").is_file()
    found = ss.load(tmp_path / "out" / "it.nc")
    called = ss.uncertainty(
        found.model,
        {
            "pad.slip_force": stats.uniform(1.5, 1.0),
            "damping.ratio": stats.lognorm(0.1, scale=0.005),
        },
        QUANTITIES[kind],
        samples=4,
        harmonics=1,
    )
    np.testing.assert_array_equal(found.arrays.value, called.arrays.value)
    assert found.settings == called.settings
    for command in (["show"], ["plot", "--out", str(tmp_path / "it.png")]):
        shown = CliRunner().invoke(app, [command[0], str(tmp_path / "out" / "it.nc"), *command[1:]])
        if "No such command" not in shown.output:
            assert shown.exit_code == 0, shown.output


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ((PEAK, 'kind = "amplitude"'), "amplitude"),
        (('to = "25 Hz"', 'to = "10 Hz"'), "two different ends"),
        (('distribution = "lognorm"', 'distribution = "lognrm"'), "did you mean 'lognorm'"),
        (("s = 0.1, ", ""), "lognorm lacks 's'"),
        (('dof = "tip"\nomega', "omega"), "dof"),
        (("samples = 20", "samples = 0"), "samples"),
    ],
)
def test_what_a_file_has_wrong_is_named(changed, message):
    text = (STUDY + PEAK).replace(*changed)
    with pytest.raises(ss.ModelError) as caught:
        Study.parse(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)

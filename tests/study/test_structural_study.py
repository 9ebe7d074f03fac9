"""Study files that vary the parameters of a structure-like damper."""

import numpy as np
import pytest
from typer.testing import CliRunner

from stickslip.cli import app
from stickslip.study import Study

STUDY = """
[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[4e4, 0.0], [0.0, 5e4]]
damping = {{ modal = 0.005 }}
dofs = ["left", "right"]

[[contact]]
law = "structural"
dofs = ["left", "right", "ground"]
stiffness = [[9e4, -6e4, -3e4], [-6e4, 6e4, 0], [-3e4, 0, 3e4]]
slip_forces = ["2 N", "4 N", inf]

[[force]]
dof = "left"
amplitude = "1 N"

[analysis]
kind = "damper-curve"
dof = "left"
{varied}
"""


def study(tmp_path, varied):
    path = tmp_path / "study.toml"
    path.write_text(STUDY.format(varied=varied), encoding="utf-8")
    return path


@pytest.mark.slow
def test_study_files_vary_factors_and_points(tmp_path, monkeypatch):
    path = study(tmp_path, 'slip_force = [0.5, 1, 2]\ncommon = "factor"\nharmonics = 5')
    monkeypatch.chdir(tmp_path)
    told = CliRunner().invoke(app, ["run", str(path)])
    assert told.exit_code == 0, told.output
    (written,) = (tmp_path / "results").glob("*.nc")
    told = CliRunner().invoke(app, ["show", str(written)])
    assert "slip_force of structural[0], structural[1]" in told.output

    path = study(
        tmp_path, 'slip_force = ["1 N", "3 N"]\ncontacts = [["structural", 1]]\nharmonics = 5'
    )
    (curve,) = Study.load(path).run()
    assert curve.model_at(3.0).contacts[0].slip_forces == (2.0, 3.0, np.inf)


@pytest.mark.parametrize(
    ("varied", "message"),
    [
        ('slip_force = [1]\ncontacts = [["structural", "1"]]', "[name, point] for one of its"),
        ('slip_force = [1]\ncontacts = [["structural", 7]]', "has 3, at 0 to 2"),
        ("stiffness = [1e6]", "takes no value"),
    ],
)
def test_study_files_that_vary_what_is_not_there(tmp_path, varied, message):
    told = CliRunner().invoke(app, ["run", str(study(tmp_path, varied))])
    assert told.exit_code != 0
    assert message in " ".join(told.output.split())

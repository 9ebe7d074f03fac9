"""Limit cycles and maps of their limits, by a study file and the command."""

import numpy as np
import pytest

import stickslip as ss

STUDY = """
[structure]
mass = [[944.6]]
stiffness = [[2.4e7]]
dofs = ["mass"]

[[contact]]
law = "jenkins"
dof = "mass"
stiffness = 2.4e7
slip_force = 246.048

[analysis]
kind = "limit-cycles"
negative_damping = "c.npz"
harmonics = 9
"""


@pytest.mark.slow
def test_study_files_and_the_command(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from stickslip.cli import app
    from stickslip.study import Study

    monkeypatch.chdir(tmp_path)
    np.savez(tmp_path / "c.npz", c=[[-7699.054]])
    (branch,) = Study.parse(STUDY + "ratio = { from = 0.1, to = 2 }\n", folder=tmp_path).run()
    assert (branch.ratio[0], branch.ratio[-1]) == pytest.approx((0.1, 2.0))
    assert branch.limit is None
    (points,) = Study.parse(
        STUDY + "ratio = [1]\nstiffness = {from = 1e6, to = 1e8}\n", folder=tmp_path
    ).run()
    assert points.limit.value / 2.4e7 == pytest.approx(0.167108, rel=1e-3)
    both = "stiffness = {from = 1e6, to = 1e8}\nslip_force = {from = 1, to = 2}\n"
    with pytest.raises(ss.ModelError, match="follow one of them"):
        Study.parse(STUDY + both, folder=tmp_path)
    (tmp_path / "mass.toml").write_text(STUDY + "ratio = [1, 5]\n")
    for arguments in (["run", "mass.toml"], ["show", "results/mass.nc"]):
        told = CliRunner().invoke(app, arguments)
        assert told.exit_code == 0, told.output
        assert "197.41" in told.output or "harmonic balance" in told.output
    model, negative = ss.reference.flutter_mass()
    ss.stability_map(model, negative, stiffness=[2.4e7]).save("map.nc")
    told = CliRunner().invoke(app, ["show", "map.nc"])
    assert told.exit_code == 0, told.output
    assert "5.14799" in told.output

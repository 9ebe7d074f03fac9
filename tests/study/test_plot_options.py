"""Options of ``stickslip plot``: what they change, and where they change nothing."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

import stickslip as ss
from stickslip.cli import app
from stickslip.cli.drawing import Wanted
from stickslip.reference import snecma_beam


def plotted(file, *options):
    return CliRunner().invoke(app, ["plot", str(file), *options])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--per-force"], "--per-force: changes nothing of a damper curve; leave it out"),
        (["--linear"], "--linear: changes nothing of a damper curve; leave it out"),
        (["--dof", "damper"], "--dof: unknown dof 'damper'; known: 'tip'"),
    ],
)
def test_options_that_change_nothing_of_a_damper_curve_are_refused(tmp_path, options, message):
    curve = ss.damper_curve(
        snecma_beam(), dof="tip", slip_force=[100.0, 200.0], omega=(150.0, 250.0), harmonics=1
    )
    curve.save(tmp_path / "curve.nc")
    result = plotted(tmp_path / "curve.nc", *options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert plotted(tmp_path / "curve.nc", "--dof", "tip").exit_code == 0


def test_frequencies_in_rpm_are_of_the_rotor_as_the_axes_are():
    blade = ss.Structure([[1.0]], [[4e4]], damping=ss.ModalDamping(0.01), dofs=["tip"])
    damper = ss.Jenkins("tip", stiffness=1e4, slip_force=1.0)
    disk = ss.BladedDisk(blade, 12, [], [damper], [ss.Force("tip", 1.0)], engine_order=4)
    curve = ss.forced_response(disk, [200.0, 220.0, 240.0], harmonics=1)
    rotor = f"{220.0 / 4 * 30 / np.pi} rpm"

    def title(unit, omega):
        wanted = Wanted(None, unit, log=True, per_force=False, contact="0")
        _, (panel,) = wanted.picture({"loop": omega}, [("disk", curve)])
        panel(ax=(ax := Figure().add_subplot()))
        return ax.get_title()

    assert title("rpm", rotor) == title("rpm", "220 rad/s") == title("rpm", "220")
    assert title("rpm", rotor).startswith("jenkins at n = 525.21 rpm")
    with pytest.raises(ss.ModelError, match="55 rad/s lies outside the computed 200 to 240"):
        title("rad/s", rotor)

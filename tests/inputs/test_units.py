import math
from fractions import Fraction

import numpy as np
import pytest

import stickslip as ss
from stickslip import ModelError
from stickslip.settings.motion import BasinKeys
from stickslip.units import quantity


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (20.3, "N", 20.3),
        (7, "N", 7.0),
        (np.float64(1.5), "m", 1.5),
        ("20.3 N", "N", 20.3),
        ("2.5 daN", "N", 25.0),
        ("20.3N", "N", 20.3),
        ("  -1.5e1 mN ", "N", -0.015),
        ("2 kgf", "N", 19.6133),
        ("1 lbf", "N", 4.4482216152605),
        ("24 kN/mm", "N/m", 2.4e7),
        ("1 N/µm", "N/m", 1e6),
        ("1 N/μm", "N/m", 1e6),
        ("1 N/um", "N/m", 1e6),
        ("1 lbf/in", "N/m", 175.12683524647636),
        ("25 Hz", "rad/s", 50 * math.pi),
        ("0.025 kHz", "rad/s", 50 * math.pi),
        ("1500 rpm", "rad/s", 50 * math.pi),
        ("25 rev/s", "rad/s", 50 * math.pi),
        ("350 rad/s", "rad/s", 350.0),
        ("90 deg", "rad", math.pi / 2),
        ("90°", "rad", math.pi / 2),
        ("0.5 rad", "rad", 0.5),
        ("0.5 %", "", 0.005),
        ("0.5", "", 0.5),
        ("7.49 1/s", "1/s", 7.49),
        ("7.49 s^-1", "1/s", 7.49),
        ("0.026 ms", "s", 2.6e-5),
        ("10 µm", "m", 1e-5),
        ("3 N*m", "J", 3.0),
        ("0.0e-400 N", "N", 0.0),
        ("5\u00a0N", "N", 5.0),
        ("1e-300 N", "N", 1e-300),
    ],
)
def test_a_number_or_a_text_with_a_unit_is_read_in_si(value, unit, expected):
    assert quantity(value, unit, "entry") == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("value", "unit", "problem"),
    [
        (
            "20 kg",
            "N",
            r"'20 kg' is not a force \[N\]; write for instance '20.3 N' or a number in N",
        ),
        ("20", "N", "'20' has no unit"),
        ("", "N", "'' is not a force"),
        ("twenty N", "N", "'twenty N' is not a force"),
        ("nan N", "N", "'nan N' is not a force"),
        ("1e400 N", "N", "'1e400 N' is not finite"),
        ("1e-400 N", "N", "'1e-400 N' is too small"),
        ("-0.02e-400 N", "N", "'-0.02e-400 N' is too small"),
        ("1e-320 nN", "N", "'1e-320 nN' is too small"),
        (Fraction(1, 10**400), "N", "is too small"),
        ("1_0 N", "N", "'1_0 N' has an unknown unit '_0 N'"),
        ("\u0661\u0662 N", "N", "is not a force"),
        ("1\u0662 N", "N", "has an unknown unit"),
        ("1 " + "*".join(["N"] * 3000), "N", "has a unit of 5999 characters"),
        ("1 " + "(" * 3000 + "N" + ")" * 3000, "N", "has a unit of 6001 characters"),
        ("1" * 5000 + " N", "N", "is not finite"),
        ("20,5 N", "N", "'20,5 N' has a decimal comma"),
        ("20.3 n", "N", "has an unknown unit 'n'"),
        ("20.3 Newtons!", "N", "has an unknown unit 'Newtons!'"),
        ("20 N)", "N", r"has an unknown unit 'N\)'"),
        ("20 N # 3", "N", "has an unknown unit 'N # 3'"),
        ("20 3 N", "N", "has an unknown unit '3 N'"),
        ("20 (((N", "N", "has an unknown unit"),
        ("20 N**9**9**9", "N", r"has an unknown unit 'N\*\*9\*\*9\*\*9'"),
        ("20 N*9²²²²²²²²²²", "N", "has an unknown unit"),
        ("20 N**N", "N", "has an unknown unit"),
        ("20 N..m", "N", "has an unknown unit 'N..m'"),
        ("25 Hz", "N", r"'25 Hz' is not a force \[N\]"),
        ("300 1/s", "rad/s", r"'300 1/s' is not a frequency \[rad/s\]; .* '25 Hz'"),
        ("25 Hz", "1/s", r"'25 Hz' is not a rate \[1/s\]"),
        ("5 %", "rad", r"'5 %' is not an angle \[rad\]; .* '90 deg'"),
        ("90 deg", "", "'90 deg' is not a ratio; .* '0.5 %' or a plain number"),
        ("1 kg", "J", r"is not a quantity \[J\]; .* '1 J'"),
        (math.nan, "N", "nan is not finite"),
        (-math.inf, "N", "-inf is not finite"),
        (10**400, "N", "is too large; write for instance '20.3 N'"),
        (np.complex128(1), "N", "is not a force"),
        (True, "N", "True is not a force"),
        (None, "N", "None is not a force"),
        ([1.0], "N", r"\[1.0\] is not a force .*, but a list; give a single one"),
        (np.array([1.0]), "N", "is not a force"),
        (1j, "N", "1j is not a force"),
    ],
)
def test_what_is_no_quantity_of_the_unit_is_refused_in_one_line(value, unit, problem):
    with pytest.raises(ModelError, match=problem) as caught:
        quantity(value, unit, "force 1: amplitude")
    message = str(caught.value)
    assert message.startswith("force 1: amplitude = ")
    assert "\n" not in message


@pytest.mark.slow
def test_numbers_do_not_load_pint():
    import subprocess
    import sys

    code = (
        "import sys; from stickslip.units import quantity; quantity(1.0, 'N', 'x'); "
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def _two_masses(**changes):
    values = {"stiffness": "1e4 N/m", "slip_force": "2 N"} | changes
    structure = ss.Structure(
        np.eye(2),
        [[2e4, -1e4], [-1e4, 1e4]],
        ss.Rayleigh(mass="3 1/s", stiffness="10 us"),
        ["a", "b"],
    )
    return ss.Model(structure, [ss.Jenkins("a", **values)], [ss.Force("b", "20 N", "90 deg")])


def _facing(tolerance):
    """Two shells of which one lies a millimetre above the other."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) * 1e-3
    cells = [("quad", [[0, 1, 2, 3], [4, 7, 6, 5]])]
    raised = square + np.array([0, 0, 1e-3])
    mesh, lower = ss.Mesh(np.vstack([square, raised]), cells), np.arange(8) < 4
    pair = ss.ContactInterface.from_surfaces
    return pair(mesh, lower, mesh, ~lower, tolerance=tolerance)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        (lambda: ss.Jenkins("a", stiffness="24 kN/mm", slip_force="246 N").stiffness, 24e6),
        (lambda: ss.Iwan("a", stiffness="1 kN/m", slip_force=1, chi=-0.5, beta="20 %").beta, 0.2),
        (lambda: ss.Stop("a", stiffness=1.0, gap="0.3 mm").gap, 3e-4),
        (lambda: ss.Cubic("a", stiffness="2 N/mm^3").stiffness, 2e9),
        (lambda: ss.ParallelJenkins("a", stiffness=[1], slip_forces=["1 kN"]).slip_forces[0], 1e3),
        (lambda: ss.Coulomb(["a", "b"], normal=None, friction="30 %", tangential_stiffness=1.0,
                            preload="1.2 kN").preload, 1200.0),
        (lambda: ss.Force("a", "20 mN", "180 deg").phase, np.pi),
        (lambda: ss.Rayleigh(stiffness="26 us").stiffness, 26e-6),
        (lambda: ss.ModalDamping(["0.1 %", 0.002]).ratio[0], 1e-3),
        (lambda: ss.Coupling("a", stiffness="1 kN/mm", damping="2 N s/mm").damping, 2e3),
        (lambda: ss.Centrifugal("300 mm", "3000 rpm").speed, 100 * np.pi),
        (lambda: ss.WedgeDamper(angle="0.5 rad", mass="12 g", friction=0.5, tangential_stiffness=1,
                                normal_stiffness=1, load="120 N").angle, np.rad2deg(0.5)),
        (lambda: ss.State(_two_masses(), {"a": "2 mm"}, {"b": "1 mm/s"}).displacement[0], 2e-3),
        (lambda: ss.forced_response(_two_masses(), ["10 Hz", 70.0], 3).omega[0], 20 * np.pi),
        (lambda: ss.forced_response(_two_masses(), ("5 Hz", "900 rpm"), 3).omega[-1], 30 * np.pi),
        (lambda: ss.damper_curve(_two_masses(), dof="b", slip_force=["2 kN"]).values[0], 2e3),
        (lambda: ss.transient(_two_masses(), omega="10 Hz", periods=3).omega, 20 * np.pi),
        (lambda: ss.Measurement(["10 Hz"], "a", ["2 um"], noise="1 um").noise, 1e-6),
        (lambda: ss.Optimum("a", bounds=("2 N", "1 kN")).bounds[1], 1e3),
        (lambda: ss.nonlinear_modes(_two_masses(), amplitude=[1e-4, 1e-3], harmonics=1)
            .forced_response(ss.Force("a", "1 N"), ["9 Hz"]).omega[0], 18 * np.pi),
        (lambda: ss.ModalForces([[1.0, 2.0], [3.0, 6.0]], speeds=[0.0, 20 * np.pi])
            .at_speed("5 Hz").values[1], 4.0),
        (lambda: BasinKeys.of(
            axes={"a": ["0 mm", "1 mm"], "b": [0.0, 1.0]}).axes["a"][1], 1e-3),
        (lambda: _facing("2 mm").gap.max(), 1e-3),
    ],
)  # fmt: skip
def test_python_takes_texts_with_units(text, number):
    assert text() == pytest.approx(number, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: _two_masses(stiffness="24 kg"), r"'a': stiffness = '24 kg' is not a stiffness"),
        (lambda: _two_masses(slip_force="3 Nm"), "slip_force = '3 Nm' has an unknown unit 'Nm'"),
        (lambda: _two_masses(slip_force="20,5 N"), "has a decimal comma"),
        (lambda: ss.forced_response(_two_masses(), ["10 Hz", "6 mm"], 3),
         "omega = '6 mm' is not a frequency"),
        (lambda: ss.forced_response(_two_masses(), ("10 Hz", "6 mm"), 3),
         "omega: end of the range = '6 mm' is not a frequency"),
        (lambda: ss.damper_curve(_two_masses(), dof="b", slip_force=["1 N/m"]),
         r"slip_force.* = '1 N/m' is not a force"),
        (lambda: ss.optimal_damper(_two_masses(), dof="b", bounds=("1 N", "1 m")),
         "bounds = '1 m' is not a force"),
        (lambda: ss.fit(_two_masses(), [], parameters={"slip_force": ("1 N", "1 m")}),
         r"slip_force.*'1 m' is not a force"),
        (lambda: ss.State(_two_masses(), ["1 N", 0.0]), r"\[0\] = '1 N' is not a length"),
    ],
)  # fmt: skip
def test_python_names_a_wrong_dimension(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call()

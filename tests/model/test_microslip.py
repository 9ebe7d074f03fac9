"""Laws without sliders as contacts: values, files, study tables and refusals."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from small_study import TWO_MASSES
from stickslip.model.laws import contact_from_spec
from stickslip.study import Study

STUDY = (
    TWO_MASSES
    + """
[[contact]]
law = "iwan"
dof = "tip"
stiffness = "1 N/mm"
slip_force = "2 N"
chi = -0.5
[[contact]]
law = "masing"
dofs = ["tip", "root"]
displacement = ["1 mm", "3 mm"]
force = ["2 N", 3.0]
[[contact]]
law = "masing"
dof = "root"
stiffness = 10.0
slip_force = 3.0
backbone = "shear-layer"
shear_lag = 2.0
name = "strap"
[[contact]]
law = "bouc-wen"
dof = "root"
stiffness = 10.0
slip_force = 3.0
[[force]]
dof = "tip"
amplitude = "1 N"
[analysis]
omega = [1.0, 1.1]
"""
)
CONTACTS = [
    ss.Iwan("a", "b", stiffness=2e6, slip_force=1e3, chi=-0.5, beta=0.0),
    ss.Iwan("a", stiffness=1.0, slip_force=np.inf, chi=0.0, beta=2.0, name="bolt"),
    ss.Masing("a", "b", stiffness=3.0, slip_force=2.0, backbone="exponential"),
    ss.Masing("a", stiffness=3.0, slip_force=2.0, backbone="shear-layer", shear_lag=0.4),
    ss.Masing("a", backbone=([0.0, 1.0, 2.0], [0.0, 3.0, 4.0])),
    ss.BoucWen("a", "b", stiffness=3.0, slip_force=2.0, exponent=2.0, beta=0.7),
]


def test_study_tables_read_units():
    (model,) = Study.parse(STUDY).models()
    iwan, table, strap, wen = model.contacts
    assert iwan == ss.Iwan("tip", stiffness=1000.0, slip_force=2.0, chi=-0.5, name="iwan")
    own = ss.Masing("tip", "root", backbone=([1e-3, 3e-3], [2.0, 3.0]), name="masing")
    assert table == own
    assert (own.stiffness, own.slip_force) == (2000.0, 3.0)
    assert (strap.shear_lag, wen.exponent) == (2.0, 1.0)


@pytest.mark.parametrize("contact", CONTACTS)
def test_contacts_go_through_plain_values(contact):
    assert contact_from_spec(contact.to_spec()) == contact
    assert contact.scaled(2.0).slip_force == 2.0 * contact.slip_force


def test_the_displacement_of_gross_slip():
    joint = ss.Iwan("a", stiffness=0.25, slip_force=0.2, chi=-0.5)
    assert joint.gross_slip_displacement == pytest.approx(2.4)


def test_a_table_is_stretched_to_other_values():
    table = ss.Masing("a", backbone=([1.0, 2.0], [3.0, 4.0]))
    assert table.adjusted("slip_force", [8.0]).stiffness == 3.0
    assert table.adjusted("stiffness", [6.0]).slip_force == 4.0


NUMBERS = {"stiffness": 1.0, "slip_force": 1.0}


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ss.Iwan("x", **NUMBERS, chi=-1.0), "iwan contact at 'x': chi -1 is outside"),
        (lambda: ss.Iwan("x", **NUMBERS, chi=0.2), "chi 0.2 is outside -1 < chi <= 0"),
        (lambda: ss.Iwan("x", **NUMBERS, chi=-0.5, beta=-1), "beta -1 is negative"),
        (lambda: ss.Iwan("x", stiffness=-1, slip_force=1.0, chi=0), "stiffness -1 is negative"),
        (
            lambda: ss.Iwan("x", stiffness="-1 kN/m", slip_force=1.0, chi=0),
            "stiffness -1000 is negative",
        ),
        (lambda: ss.Iwan("x", **NUMBERS, chi="20 %"), "chi 0.2 is outside -1 < chi <= 0"),
        (lambda: ss.Masing("x", **NUMBERS, backbone="dahl"), "backbone 'dahl' is unknown"),
        (lambda: ss.Masing("x", stiffness=1.0, backbone="exponential"), "slip_force is missing"),
        (lambda: ss.Masing("x", **NUMBERS, backbone="shear-layer"), "shear_lag None"),
        (
            lambda: ss.Masing("x", **NUMBERS, backbone="shear-layer", shear_lag=0.0),
            "shear_lag 0 is not positive",
        ),
        (lambda: ss.Masing("x", backbone=([1, 2, 3], [1, 2, 4])), "row 2, 3 m and 4 N: the slope"),
        (lambda: ss.Masing("x", backbone=([1, 1], [1, 2])), "row 1, 1 m and 2 N: the displacement"),
        (lambda: ss.Masing("x", backbone=([1, 2], [2, 1])), "row 1, 2 m and 1 N: the force falls"),
        (lambda: ss.Masing("x", backbone=([1, 2], [2])), "2 displacements and 1 forces"),
        (lambda: ss.Masing("x", backbone=([0.0], [0.0])), "no row beyond zero"),
        (lambda: ss.Masing("x", backbone=([1, np.nan], [2, 3])), "displacement.1.: nan"),
        (lambda: ss.BoucWen("x", **NUMBERS, exponent=0.5), "exponent 0.5 is below 1"),
        (lambda: ss.BoucWen("x", **NUMBERS, exponent=1e8), r"exponent 1e\+08 is above 1000"),
        (lambda: ss.BoucWen("x", **NUMBERS, beta=0.2), "beta 0.2 is outside 0.5 to 1"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(ss.ModelError, match=message):
        make()

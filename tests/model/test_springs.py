"""Stops and cubic springs as contacts: values, files, study tables, refusals, and linear limits."""

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
law = "stop"
dof = "tip"
stiffness = "1 N/mm"
gap = "2 mm"
[[contact]]
law = "cubic"
dofs = ["tip", "root"]
stiffness = "-2e9 N/m^3"
[[force]]
dof = "tip"
amplitude = "1 N"
[analysis]
omega = [1.0, 1.1]
"""
)


def test_study_tables_read_units():
    (model,) = Study.parse(STUDY).models()
    stop, cubic = model.contacts
    assert stop == ss.Stop("tip", stiffness=1000.0, gap=0.002, name="stop")
    assert cubic == ss.Cubic("tip", "root", stiffness=-2e9, name="cubic")


@pytest.mark.parametrize(
    "contact",
    [ss.Stop("a", "b", stiffness=3.0, gap=-0.1), ss.Cubic("a", stiffness=-2.0, name="soft")],
)
def test_contacts_go_through_plain_values(contact):
    assert contact_from_spec(contact.to_spec()) == contact


def test_the_interface_runs_as_designed():
    assert ss.Stop("tip", stiffness=1e6, gap=1e-3).dofs == ("tip",)
    assert ss.Cubic("tip", "root", stiffness=1e9).dofs == ("tip", "root")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ss.Stop("x", stiffness=-1.0, gap=0.0), "stop at 'x': stiffness -1 is negative"),
        (lambda: ss.Stop("x", stiffness=np.inf, gap=0.0), "stiffness: inf"),
        (lambda: ss.Stop("x", stiffness=1.0, gap=np.nan), "gap: nan"),
        (lambda: ss.Cubic("x", stiffness=np.inf), "cubic spring at 'x': stiffness: inf"),
        (lambda: ss.Cubic("x", "x", stiffness=1.0), "both ends at dof 'x'"),
    ],
)
def test_what_cannot_be_is_refused(make, message):
    with pytest.raises(ss.ModelError, match=message):
        make()


def one(contact, **forces):
    structure = ss.Structure([[1.0]], [[1.0]], damping=[[0.05]], dofs=["x"])
    return ss.Model(structure, [contact], [ss.Force("x", amplitude=0.3)])


def test_a_stop_is_linear_while_it_stays_open_or_closed():
    omega = np.array([0.4, 0.5])
    for gap, stiffness in ((10.0, 1.0), (-10.0, 4.0)):
        frf = ss.forced_response(one(ss.Stop("x", stiffness=3.0, gap=gap)), omega)
        expected = 0.3 / np.abs(stiffness - omega**2 + 0.05j * omega)
        np.testing.assert_allclose(frf.amplitude("x"), expected, rtol=1e-9)
        mean = 0.0 if gap > 0.0 else 3.0 * gap / 4.0
        np.testing.assert_allclose(frf.coefficients("x")[:, 0].real, mean, atol=1e-9)
        assert (frf.stability == "stable").all()
        assert (frf.slip_fraction(0) == 0.0).all()
        assert (frf.dissipation(0) == 0.0).all()


def test_springs_have_their_linear_limit_at_rest():
    assert ss.Cubic("x", stiffness=3.0).linear_limit(stuck=True) is None
    assert ss.Stop("x", stiffness=3.0, gap=1.0).linear_limit(stuck=True) is None
    closed = ss.Stop("x", stiffness=3.0, gap=-1.0)
    assert closed.linear_limit(stuck=False).stiffness == 3.0
    np.testing.assert_allclose(ss.natural_frequencies(one(closed)), 2.0)


def test_analyses_by_events_refuse_them_by_name():
    for contact in (ss.Stop("x", stiffness=3.0, gap=1.0), ss.Cubic("x", stiffness=1.0)):
        model = one(contact)
        with pytest.raises(ss.ModelError, match=f"the law {contact.law} has no events"):
            ss.exact_response(model, [0.5])
        with pytest.raises(ss.ModelError, match=f"the law {contact.law} has no events"):
            ss.transient(model, omega=0.5, periods=2)
    with pytest.raises(ss.ModelError, match="describing function, got stop"):
        ss.single_harmonic(one(ss.Stop("x", stiffness=3.0, gap=1.0)), [0.5])


def test_a_single_harmonic_is_the_balance_of_one():
    model, omega = one(ss.Cubic("x", stiffness=0.5)), np.linspace(0.3, 0.9, 7)
    single, balance = ss.single_harmonic(model, omega), ss.forced_response(model, omega, 1)
    np.testing.assert_allclose(single.amplitude("x"), balance.amplitude("x"), rtol=1e-10)


def test_a_stop_alone_holds_a_static_load():
    free = ss.Structure([[1.0]], [[0.0]], damping=[[0.1]], dofs=["x"])
    forces = [ss.Force("x", amplitude=0.1), ss.Force("x", amplitude=1.0, harmonic=0)]
    held = ss.Model(free, [ss.Stop("x", stiffness=5.0, gap=0.0)], forces)
    frf = ss.forced_response(held, [0.5, 1.0])
    np.testing.assert_allclose(frf.coefficients("x")[:, 0].real, 0.2, rtol=1e-9)
    open_ = ss.Model(free, [ss.Stop("x", stiffness=5.0, gap=0.1)], forces)
    with pytest.raises(ss.ModelError, match="a structure that moves freely"):
        ss.forced_response(open_, [0.5])


@pytest.mark.slow
def test_disks_with_springs_bend_their_tuned_and_mistuned_curves_alike():
    sector = ss.Structure(
        np.eye(2), [[2.0, -1.0], [-1.0, 1.5]], damping=0.02 * np.eye(2), dofs=["tip", "root"]
    )
    disk = ss.BladedDisk(
        sector,
        sectors=4,
        couplings=[ss.Coupling("tip", stiffness=0.1)],
        contacts=[ss.Stop("tip", stiffness=3.0, gap=0.3)],
        forces=[ss.Force("tip", amplitude=0.1)],
        engine_order=1,
    )
    tuned = ss.forced_response(disk, (0.6, 1.2), 3)
    ring = ss.forced_response(disk.mistuned(np.zeros(4)), (0.6, 1.2), 3)
    assert tuned.folds.size >= 2
    np.testing.assert_allclose(tuned.omega[tuned.folds], ring.omega[ring.folds], rtol=1e-7)
    np.testing.assert_allclose(
        tuned.amplitude("tip")[tuned.folds], ring.amplitude("0.tip")[ring.folds], rtol=1e-5
    )
    assert (tuned.stability == "not decided").all()
    assert {"stable", "unstable"} <= set(ring.stability)

"""Laws, structures and disks at the edge of what they take: vanishing and extreme parameters."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import stickslip as ss

MARCHED = {"harmonics": 9, "evaluation": "marched", "samples": 1024}
EXACT = {"harmonics": 7}


def pair(contact: ss.Contact, dofs: str = "ab") -> ss.Model:
    """Return two masses on a contact, both driven."""
    structure = ss.Structure(
        mass=np.eye(2),
        stiffness=[[2e4, -1e4], [-1e4, 1.5e4]],
        damping=[[4.0, -1.0], [-1.0, 3.0]],
        dofs=list(dofs),
    )
    forces = [ss.Force(dofs[1], amplitude=1.0), ss.Force(dofs[0], amplitude=0.5, phase=0.7)]
    return ss.Model(structure, [contact], forces)


def bouc_wen(**given: float) -> ss.Contact:
    return ss.BoucWen("a", **({"stiffness": 1e4, "slip_force": 0.5} | given))


def iwan(**given: float) -> ss.Contact:
    return ss.Iwan("a", **({"stiffness": 1e4, "slip_force": 0.5, "beta": 0.0} | given))


def pad(**given: float) -> ss.Contact:
    stiffness = {"tangential_stiffness": 1e4, "preload": 1.0}
    return ss.Coulomb(["a", "b"], normal=[0, 1], friction=0.3, **(stiffness | given))


@pytest.mark.parametrize(
    ("law", "parameter", "value", "step", "settings"),
    [
        (bouc_wen, "exponent", 1.0, 1e-4, EXACT),
        (bouc_wen, "beta", 0.5, 1e-4, EXACT),
        (bouc_wen, "beta", 1.0, -1e-4, EXACT),
        (iwan, "chi", -0.5, 1e-4, MARCHED),
        (iwan, "chi", 0.0, -1e-4, MARCHED),
        (pad, "normal_stiffness", 0.0, 1.0, EXACT),
    ],
)
def test_slopes_at_the_edge_of_a_parameter_are_differences_to_one_side(
    law: Callable[..., ss.Contact], parameter: str, value: float, step: float, settings: dict
) -> None:
    def response(at: float) -> ss.ForcedResponse:
        return ss.forced_response(pair(law(**{parameter: at})), [105.0], **settings)

    at_edge = response(value)
    beside = response(value + step).amplitude("b") - at_edge.amplitude("b")
    slope = at_edge.sensitivity("b", parameter=parameter)
    np.testing.assert_allclose(slope, beside / step, rtol=2e-3)


@pytest.mark.parametrize("exponent", [180.0, 1000.0])
def test_a_sharp_knee_is_that_of_a_jenkins_element(exponent: float) -> None:
    sharp = ss.forced_response(pair(bouc_wen(exponent=exponent)), [105.0], harmonics=3)
    jenkins = ss.Jenkins("a", stiffness=1e4, slip_force=0.5)
    corner = ss.forced_response(pair(jenkins), [105.0], harmonics=3)
    np.testing.assert_allclose(sharp.amplitude("b"), corner.amplitude("b"), rtol=1e-2)
    assert sharp.converged.all()


def test_massless_dofs_have_no_natural_frequency() -> None:
    structure = ss.Structure(
        mass=np.diag([1.0, 0.7, 0.0]),
        stiffness=[[2e4, -1e4, 0.0], [-1e4, 2.5e4, -8e3], [0.0, -8e3, 1.4e4]],
        damping=np.diag([2.0, 3.0, 0.0]),
        dofs=["a", "b", "c"],
    )
    contacts = [ss.Jenkins("c", stiffness=5e3, slip_force=0.1)]
    forces = [ss.Force("a", amplitude=1.0)]
    held = np.array([[2e4, -1e4], [-1e4, 2.5e4 - 8e3**2 / 1.9e4]])
    expected = np.sqrt(np.linalg.eigvals(held / np.array([[1.0], [0.7]])))
    disk = ss.BladedDisk(structure, 4, [], contacts, forces, engine_order=1)
    alone = ss.natural_frequencies(ss.Model(structure, contacts, forces))
    np.testing.assert_allclose(alone, np.sort(expected), rtol=1e-12)
    np.testing.assert_allclose(ss.natural_frequencies(disk), alone, rtol=1e-12)
    ring = ss.natural_frequencies(disk.mistuned(np.zeros(4)))
    np.testing.assert_allclose(ring, np.repeat(alone, 4), rtol=1e-9)


def test_a_mode_that_neither_damping_nor_contact_holds_resonates() -> None:
    structure = ss.Structure(
        mass=np.eye(2),
        stiffness=np.diag([1e4, 4e4]),
        damping=ss.ModalDamping([0.0, 0.01]),
        dofs=["a", "b"],
    )
    forces = [ss.Force("a", amplitude=1.0), ss.Force("b", amplitude=1.0)]
    model = ss.Model(structure, [ss.Jenkins("b", stiffness=1e4, slip_force=1.0)], forces)
    with pytest.raises(ss.ModelError, match="hits the undamped natural frequency 100"):
        ss.forced_response(model, [100.0], harmonics=3)
    beside = 100.0 * (1.0 + 1e-9)
    found = ss.forced_response(model, [beside], harmonics=3)
    np.testing.assert_allclose(found.amplitude("a"), 1.0 / abs(1e4 - beside**2), rtol=1e-6)


def test_models_without_contacts_are_solved_by_every_method() -> None:
    blade = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 2e4]], damping=np.diag([0.0, 2.0]), dofs=["a", "b"]
    )
    forces = [ss.Force("a", amplitude=1.0), ss.Force("a", amplitude=2.0, harmonic=0)]
    alone = ss.Model(blade, [], forces)
    bounded = ss.forced_response(alone, [80.0, 110.0], harmonics=3, residual="bounds")
    np.testing.assert_allclose(bounded.upper("a"), bounded.amplitude("a"))
    links = [ss.Coupling("a", stiffness=1e3)]
    ring = ss.BladedDisk(blade, 4, links, [], forces, engine_order=1).mistuned([0, 0.1, 0, 0.05])
    assert ss.static_response(ring).status == ss.Status.CONVERGED
    newton, broyden = (
        ss.forced_response(ring, [80.0, 110.0], harmonics=3, method=method)
        for method in ("newton", "broyden")
    )
    np.testing.assert_allclose(broyden.amplitude("1.a"), newton.amplitude("1.a"), rtol=1e-9)

"""Contacts in a plane that move many millions of times as far as they slip."""

from collections.abc import Callable

import numpy as np
import pytest

import stickslip as ss


def pushed(contacts: list[ss.Coulomb]) -> ss.Model:
    """Return two degrees of freedom under loads out of phase, and a third one beside them."""
    stiffness = [[1e4, -2e3, 0.0], [-2e3, 1.3e4, 0.0], [0.0, 0.0, 2e4]]
    structure = ss.Structure(np.eye(3), stiffness, ss.ModalDamping(1e-2), ["a", "b", "z"])
    forces = [ss.Force("a", 10.0), ss.Force("b", 5.0, phase=1.0), ss.Force("z", 1.0)]
    return ss.Model(structure, contacts, forces)


def plane(stiffness: float, preload: float) -> ss.Coulomb:
    return ss.Coulomb(
        ["a", "b"], normal=None, friction=0.5, tangential_stiffness=stiffness, preload=preload
    )


def space(stiffness: float, preload: float) -> ss.Coulomb:
    return ss.Coulomb(
        ["a", "b", "z"],
        normal=[0, 0, 1],
        friction=0.5,
        tangential_stiffness=stiffness,
        normal_stiffness=1e3 * preload,
        preload=preload,
    )


def answer(contacts: list[ss.Coulomb], harmonics: int | str = "auto") -> ss.ForcedResponse:
    frf = ss.forced_response(pushed(contacts), [90.0], harmonics)
    assert frf.converged.all(), frf.status
    return frf


@pytest.mark.parametrize("contact", [plane, space])
@pytest.mark.parametrize("stiffness", [3e2, 3e7])
def test_next_to_no_friction_leaves_the_free_response(
    contact: Callable[..., ss.Coulomb], stiffness: float
) -> None:
    free, frf = answer([], 1), answer([contact(stiffness, 1e-9)])
    for dof in ("a", "b"):
        assert frf.amplitude(dof) == pytest.approx(free.amplitude(dof), rel=1e-9)


@pytest.mark.parametrize("contact", [plane, space])
def test_friction_of_a_stiff_contact_depends_on_its_limit_alone(
    contact: Callable[..., ss.Coulomb],
) -> None:
    # The softer spring moves 2e7 times as far as it slips: its traction lags behind the velocity
    # by less than 1e-6.
    soft, stiff = (answer([contact(stiffness, 1e-3)], 7) for stiffness in (1e6, 1e10))
    free = answer([], 1)
    for dof in ("a", "b"):
        rubbed = soft.amplitude(dof) - free.amplitude(dof)
        assert abs(rubbed) > 1e-6 * free.amplitude(dof)
        assert stiff.amplitude(dof) - free.amplitude(dof) == pytest.approx(rubbed, rel=1e-2)
    assert stiff.dissipation(0).sum() == pytest.approx(soft.dissipation(0).sum(), rel=1e-5)
    histories = [frf.contact_force(0, 0, samples=64) for frf in (soft, stiff)]
    assert histories[1] == pytest.approx(histories[0], abs=1e-5 * 0.5 * 1e-3)
    traction = np.hypot(histories[1][:, 0], histories[1][:, 1])
    if contact is plane:
        assert traction == pytest.approx(0.5e-3, rel=1e-9)


def test_orbits_of_slip_too_stiff_to_be_followed_say_so_at_once() -> None:
    found = ss.exact_response(pushed([plane(3e7, 1e-9)]), [90.0])
    assert list(found.status) == [ss.Status.STEPS_LIMIT]
    # It was granted four million steps.
    assert found.counters["evaluations"] < 100_000


@pytest.mark.parametrize("slip_force", [1e-3, 1e-2])
def test_bouc_wen_peaks_far_beyond_slip_take_few_points(slip_force):
    structure = ss.Structure([[1.0]], [[1.0]], [[2e-4]], ["a"])
    peaks, points = {}, {}
    for law in (ss.BoucWen, ss.Jenkins):
        contact = law("a", stiffness=1.0, slip_force=slip_force)
        model = ss.Model(structure, [contact], [ss.Force("a", 1.0)])
        curve = ss.damper_curve(model, slip_force=[slip_force], dof="a")
        assert list(curve.status) == ["converged"]
        peaks[law], points[law] = curve.amplitude[0], curve.counters["points"]
    # Both are Coulomb friction there, but for the samples of the one.
    assert peaks[ss.BoucWen] == pytest.approx(peaks[ss.Jenkins], rel=1e-5)
    assert points[ss.BoucWen] < 4 * points[ss.Jenkins]

"""Contacts so stiff that rounding hides the structure beside them."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row


def chain(size: int, contacts: int, stiffness: float, *, proportional: bool) -> ss.Model:
    """Return a chain whose contacts do not slip."""
    springs = 2e4 * np.eye(size) - 1e4 * (np.eye(size, k=1) + np.eye(size, k=-1))
    uneven = np.diag(np.random.default_rng(0).uniform(0.5, 2.0, size))
    damping = ss.Rayleigh(mass=0.5, stiffness=1e-5) if proportional else uneven
    dofs = [f"x{number}" for number in range(size)]
    structure = ss.Structure(np.eye(size), springs, damping, dofs)
    pads = [
        ss.Jenkins(dofs[number], stiffness=stiffness, slip_force=1e3, name=f"pad {number}")
        for number in range(1, 1 + contacts)
    ]
    return ss.Model(structure, pads, [ss.Force("x0", 3.0), ss.Force(dofs[-1], 3.0)])


@pytest.mark.parametrize("proportional", [True, False])
@pytest.mark.parametrize(("size", "contacts"), [(5, 1), (40, 3), (200, 130)])
def test_rigid_contacts_hold_their_dofs_or_are_refused(
    size: int, contacts: int, proportional: bool
) -> None:
    def ends(stiffness: float) -> list[float]:
        model = chain(size, contacts, stiffness, proportional=proportional)
        frf = ss.forced_response(model, [90.0], harmonics=3, stability=False)
        assert frf.converged.all()
        return [float(frf.amplitude(dof)[0]) for dof in (frf.dofs[0], frf.dofs[-1])]

    # The distance from rigid falls with the stiffness, until rounding leaves but some digits.
    assert ends(1e8) == pytest.approx(ends(1e11), rel=1e-3)
    assert ends(1e11) == pytest.approx(ends(1e12), rel=1e-6)
    assert ends(1e15) == pytest.approx(ends(1e12), rel=1e-3)
    for absurd in (1e17, 1e100, 1e308):
        with pytest.raises(ss.ModelError, match="entries of absurd size"):
            ends(absurd)


def sliding(size: int, contacts: int, ratio: float) -> ss.Model:
    """Return an uneven chain whose contacts, so many times as stiff, slip at low frequencies."""
    rng = np.random.default_rng(0)
    springs = in_a_row(1e4 * rng.uniform(0.8, 1.2, size + 1))
    dofs = [f"x{number}" for number in range(size)]
    structure = ss.Structure(np.eye(size), springs, ss.ModalDamping(1e-2), dofs)
    places = np.linspace(1, size - 2, contacts).astype(int) if contacts > 1 else [size // 2]
    pads = [
        ss.Jenkins(dofs[place], stiffness=1e4 * ratio, slip_force=float(rng.uniform(0.2, 0.6)))
        for place in places
    ]
    return ss.Model(structure, pads, [ss.Force(dofs[size // 3], 2.0)])


@pytest.mark.slow
def test_orbits_of_rigid_contacts_are_given_up_before_their_matrices_take_a_quarter_minute() -> (
    None
):
    frf = ss.forced_response(sliding(200, 1, 1e7), [20.0])
    # The amplitude of the exact orbit.
    assert frf.status[0] == "effort limit"
    assert abs(frf.amplitude("x0")[0] - 2.5980e-4) < 5.0 * frf.error_estimate("x0")[0]


def test_stalled_points_name_the_contacts_that_are_nearly_rigid() -> None:
    frf = ss.forced_response(sliding(6, 2, 1e9), [20.0], 7)
    assert frf.status[0] == "stalled"
    (told,) = [one for one in frf.diagnostics if one.code == "rigid-contacts"]
    assert told.severity == "caution"
    assert told.data["points"] == 1
    assert 1e8 < told.data["ratio"] < 1e9
    assert str(told).startswith("Nearly rigid: 'jenkins'")
    # A further contact that never slips does not make the motion one of many.
    model = sliding(6, 2, 1e7)
    held = ss.Jenkins("x5", stiffness=1e3, slip_force=1e3)
    frf = ss.forced_response(
        ss.Model(model.structure, [*model.contacts, held], model.forces), [20.0], 7
    )
    assert frf.status[0] == "stalled"
    assert "rigid-contacts" in [one.code for one in frf.diagnostics]
    solved = ss.forced_response(sliding(6, 2, 1e5), [20.0], 7)
    assert not any(one.code == "rigid-contacts" for one in solved.diagnostics)


ELASTIC = {
    "iwan": lambda dof, k, limit: ss.Iwan(dof, stiffness=k, slip_force=limit, chi=-0.5, beta=0.0),
    "masing": lambda dof, k, limit: ss.Masing(
        dof, stiffness=k, slip_force=limit, backbone="exponential"
    ),
    "parallel-jenkins": lambda dof, k, limit: ss.ParallelJenkins(
        dof, stiffness=[0.5 * k, 0.5 * k], slip_forces=[0.25 * limit, 0.75 * limit]
    ),
    "structural": lambda dof, k, limit: ss.StructuralDamper(
        [dof], stiffness=[[k]], slip_forces=[limit]
    ),
    "coulomb": lambda dof, k, limit: ss.Coulomb(
        [dof], normal=None, friction=0.5, tangential_stiffness=k, preload=2.0 * limit
    ),
}


@pytest.mark.parametrize("law", ELASTIC)
def test_contacts_of_every_law_are_named(law: str) -> None:
    """The advice was that of Jenkins elements alone."""
    model = sliding(6, 2, 1e9)
    contacts = [ELASTIC[law](one.dof, 1e13, one.slip_force) for one in model.contacts]
    soft = ss.Jenkins("x0", stiffness=1e3, slip_force=0.1, name="soft")
    frf = ss.forced_response(
        ss.Model(model.structure, [*contacts, soft], model.forces), [20.0], 7, stability=False
    )
    assert frf.status[0] == "stalled"
    (told,) = [one for one in frf.diagnostics if one.code == "rigid-contacts"]
    assert str(told).startswith(f"Nearly rigid: '{law}', '{law}-2', up to ")
    assert told.data["ratio"] == pytest.approx(1e13 / model.structure.stiffness[1, 1], rel=0.3)


def test_a_point_at_a_limit_is_told_of_them_too() -> None:
    frf = ss.forced_response(sliding(6, 2, 1e7), [20.0], max_harmonics=9)
    assert frf.status[0] in ("harmonics limit", "effort limit", "stalled")
    assert "rigid-contacts" in [one.code for one in frf.diagnostics]
    held = ss.forced_response(sliding(6, 2, 1e3), [20.0], max_harmonics=3)
    assert held.status[0] == "harmonics limit"
    assert not any(one.code == "rigid-contacts" for one in held.diagnostics)


@pytest.mark.parametrize(("stiffness", "solved"), [(1e11, 1), (1e16, 0)])
def test_what_rounding_has_left_of_a_rigid_stop_is_no_solution(stiffness, solved):
    """Small steps say nothing of forces 1e7 and more times as stiff: the equations have to hold."""
    springs = 1e4 * np.array([[2.0, -1.0], [-1.0, 2.0]])
    structure = ss.Structure(np.eye(2), springs, 1e-4 * springs + 2.0 * np.eye(2), ["a", "b"])
    stop = ss.Stop("a", stiffness=stiffness, gap=1e-4)
    model = ss.Model(structure, [stop], [ss.Force("b", 10.0)])
    frf = ss.forced_response(model, np.linspace(80.0, 130.0, 6), harmonics=7)
    assert frf.arrays.residual.max() > 1.0
    assert frf.converged.sum() >= solved
    assert (frf.arrays.residual[frf.converged] < 1e-8).all()

"""Forces and slip limits that are small against everything else, or against nothing."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row
from stickslip import _core
from stickslip.settings.balance import BalanceSettings

OMEGA = [7.0, 12.0, 19.0]


def twins(slip_force, load, kind):
    """Two equal structures that move alike, so that what joins them feels rounding alone."""
    own = np.array([[300.0, -90.0, 0.0], [-90.0, 270.0, -70.0], [0.0, -70.0, 130.0]])
    stiff = np.kron(np.eye(2), own)
    tips = [2, 5]
    stiff[np.ix_(tips, tips)] += 37.3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    mass = np.kron(np.eye(2), np.diag([1.0, 1.3, 0.7]))
    dofs = [f"{body}.{dof}" for body in (1, 2) for dof in "abc"]
    structure = ss.Structure(mass, stiff, 0.002 * stiff, dofs)
    if kind == "two points":
        damper = ss.StructuralDamper(
            ["1.a", "2.a"],
            stiffness=[[47.0, -47.0], [-47.0, 47.0]],
            slip_forces=[slip_force, 0.7 * slip_force],
        )
    else:
        block = np.array([[61.0, 23.0], [23.0, 41.0]])
        damper = ss.StructuralDamper(
            ["1.a", "1.b", "2.a", "2.b"],
            stiffness=np.block([[block, -block], [-block, block]]),
            slip_forces=[slip_force, np.inf, 0.7 * slip_force, 0.3 * slip_force],
        )
    forces = [ss.Force(f"{body}.{dof}", load * size) for body in (1, 2) for dof, size in SIZES]
    return ss.Model(structure, [damper], forces)


SIZES = [("a", 0.7), ("b", 1.9), ("c", 1.1)]


@pytest.mark.parametrize("kind", ["two points", "four points"])
@pytest.mark.parametrize("load", [1.0, 1e-30, 1e6])
@pytest.mark.parametrize("share", [0.0, 1e-300, 1e-20, 1e-16, 1e-14, 1e-9, 1.0])
def test_contacts_that_feel_rounding_alone_are_solved_and_have_forces(kind, load, share):
    model = twins(share * load, load, kind)
    free = ss.forced_response(ss.Model(model.structure, [], model.forces), OMEGA, harmonics=3)
    for result in (
        ss.forced_response(model, OMEGA, harmonics=3),
        ss.exact_response(model, OMEGA, harmonics=3),
    ):
        assert result.converged.all()
        assert result.amplitude("2.c") == pytest.approx(free.amplitude("2.c"), rel=1e-9)
        for index in range(3):
            assert np.abs(result.contact_force(0, index)).max() < 1e-9 * load
            result.contact_states(0, index)
    start = result.state(0)
    ss.transient(model, omega=OMEGA[0], periods=1, start=start)


@pytest.mark.parametrize(("mass", "length", "time"), [(1e3, 1e-3, 1.0), (1e-9, 1e6, 1e-3)])
def test_other_units_give_the_same_motion(mass, length, time):
    def amplitudes(mass, length, time):
        spring, force = mass / time**2, mass * length / time**2
        stiff = spring * np.array([[300.0, -100.0, 0.0], [-100.0, 250.0, -80.0], [0, -80.0, 90.0]])
        structure = ss.Structure(
            mass * np.diag([1.0, 1.5, 0.8]), stiff, 0.002 * time * stiff, ["a", "b", "c"]
        )
        model = ss.Model(
            structure,
            [
                ss.Jenkins("a", stiffness=60.0 * spring, slip_force=0.1 * force),
                ss.Jenkins("b", "c", stiffness=30.0 * spring, slip_force=0.2 * force),
            ],
            [ss.Force("c", force)],
        )
        omega = np.array([6.0, 9.0, 15.0]) / time
        return [
            ss.forced_response(model, omega, harmonics=7).amplitude("a") / length,
            ss.exact_response(model, omega).amplitude("a") / length,
            ss.single_harmonic(model, omega).amplitude("a") / length,
        ]

    for one, other in zip(amplitudes(1.0, 1.0, 1.0), amplitudes(mass, length, time), strict=True):
        assert other == pytest.approx(one, rel=1e-9)


UNIT = np.eye(2)


@pytest.mark.parametrize(
    "matrix",
    [np.ones(2), np.eye(2, dtype=int), UNIT.astype("f4"), UNIT * 1j, None, [[1.0, 0.0]], "mass"],
)
def test_arrays_of_another_kind_are_refused_in_one_line(matrix):
    with pytest.raises(TypeError, match="expected an array of float64 in 2 dimensions, got") as one:
        _core.Problem(matrix, UNIT, UNIT, [], [], False)
    assert "\n" not in str(one.value)


@pytest.mark.parametrize("omega", [[1.0], np.array([1]), np.ones((1, 1)), None, "1 rad/s"])
def test_frequencies_of_another_kind_are_refused_in_one_line(omega):
    problem = _core.Problem(UNIT, UNIT, UNIT, [], [], False)
    with pytest.raises(TypeError, match=r"expected \(from, to\) or an array") as one:
        _core.forced_response(
            problem, omega, np.array([0]), np.arange(0), BalanceSettings.of(), None
        )
    assert "\n" not in str(one.value)


@pytest.mark.parametrize("samples", [10**13, 2**62])
def test_histories_that_memory_cannot_hold_are_refused(samples):
    model = twins(1.0, 1.0, "two points")
    for result in (
        ss.forced_response(model, OMEGA, harmonics=3),
        ss.exact_response(model, OMEGA, harmonics=3),
    ):
        with pytest.raises(ss.ModelError, match="samples"):
            result.contact_force(0, 0, samples=samples)


def test_small_numbers_are_named_with_an_exponent():
    with pytest.raises(ValueError, match=r"= -1e-200: ") as one:
        _core.Problem(UNIT, UNIT, UNIT, [("jenkins", UNIT[:1], SMALL)], [], False)
    assert len(str(one.value)) < 150


SMALL = {"stiffness": 1.0, "slip_force": -1e-200}


@pytest.mark.parametrize("ratio", [1e-7, 1e-9, 1e-10])
@pytest.mark.parametrize("harmonics", [1, 3])
def test_damping_bounds_resonances_whatever_little_it_is(ratio, harmonics):
    stiffness = in_a_row([1e4, 1.3e4, 0.8e4, 0.9e4])
    squared, shapes = np.linalg.eigh(stiffness)
    structure = ss.Structure(np.eye(3), stiffness, ss.ModalDamping(ratio), list("abc"))
    contact = ss.Jenkins("b", stiffness=1e3, slip_force=1e-5)
    model = ss.Model(structure, [contact], [ss.Force("a", 1.0)])
    natural = np.sqrt(squared[0])
    height = abs(shapes[0, 0] * shapes[2, 0]) / (2.0 * ratio * squared[0])
    frf = ss.forced_response(model, [natural], harmonics)
    # Friction takes a 1e-5th of it.
    assert frf.amplitude("c")[0] == pytest.approx(height, rel=1e-4)
    over_range = ss.forced_response(model, (0.9 * natural, 1.1 * natural), harmonics)
    assert over_range.peak("c").amplitude == pytest.approx(height, rel=1e-4)

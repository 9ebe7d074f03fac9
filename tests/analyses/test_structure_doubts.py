"""What results say of structures whose numbers look like a slip of sign or unit."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses.assumptions import _two_frequencies
from stickslip.results.diagnostic import Severity

MASS = np.diag([1.0, 0.5])
STIFFNESS = np.array([[3e4, -1e4], [-1e4, 2.5e4]])
DOUBTS = {
    "overdamped",
    "negative-stiffness",
    "phase-unit",
    "mistuning-unit",
    "friction-unit",
    "angle-unit",
    "two-frequencies",
}


def model(stiffness=STIFFNESS, damping=None, contacts=None, forces=None):
    if damping is None:
        damping = np.diag([3.0, 2.0])
    structure = ss.Structure(MASS, stiffness, damping, ["x", "y"])
    if contacts is None:
        contacts = [ss.Jenkins("x", stiffness=1e3, slip_force=1.0)]
    return ss.Model(structure, contacts, forces or [ss.Force("y", 1.0)])


def unstable(**parts):
    return model(STIFFNESS * [[1, 1], [1, -1]], **parts)


def doubts(result):
    return {one.code: one for one in result.diagnostics if one.code in DOUBTS}


ANALYSES = {
    "balance": lambda m: ss.forced_response(m, [150.0], harmonics=3),
    "single": lambda m: ss.single_harmonic(m, [150.0]),
    "orbits": lambda m: ss.exact_response(m, [150.0]),
    "exact transient": lambda m: ss.transient(m, omega=150.0, periods=3),
}
OF_STABLE = ANALYSES | {
    "free": lambda m: ss.classify(m, {"x": 1e-6}),
    "mode": lambda m: ss.nonlinear_modes(m, amplitude=[1e-6], harmonics=1),
    "cycles": lambda m: ss.limit_cycles(
        m, ss.Rayleigh(mass=-40.0), ratio=[1.5], harmonics=1, stability=False
    ),
    "damper": lambda m: ss.damper_curve(m, slip_force=[1.0], dof="y", omega=(100, 300)),
}


@pytest.mark.parametrize("name", OF_STABLE)
def test_percents_taken_for_a_ratio_are_a_caution(name):
    damping = ss.ModalDamping([0.01, 2.0])
    found = doubts(OF_STABLE[name](model(damping=damping)))
    assert list(found) == ["overdamped"]
    assert found["overdamped"].severity is Severity.CAUTION
    assert found["overdamped"].text == (
        "Damping ratio 2 is 200% of critical: such a mode does not oscillate; for 2 % give 0.02."
    )
    assert not doubts(OF_STABLE[name](model(damping=ss.ModalDamping([0.01, 0.99]))))


def test_blades_of_a_disk_are_asked_too():
    blade = model(damping=ss.ModalDamping(1.0)).structure
    coupling = [ss.Coupling("x", stiffness=10.0)]
    disk = ss.BladedDisk(blade, 4, coupling, forces=[ss.Force("y", 1.0)], engine_order=1)
    study = ss.mistuning_study(
        disk, deviation=0.01, patterns=2, omega=(150, 250), harmonics=1, seed=1
    )
    for result in (ANALYSES["balance"](disk), ANALYSES["balance"](disk.mistuned(0)), study):
        assert list(doubts(result)) == ["overdamped"]


def small_disk():
    coupling = [ss.Coupling("x", stiffness=10.0)]
    blade = model().structure
    return ss.BladedDisk(blade, 3, coupling, forces=[ss.Force("y", 1.0)], engine_order=1)


def test_percents_taken_for_deviations_of_blades_are_a_caution():
    disk = small_disk()

    def found(*given, **parts):
        return doubts(ANALYSES["balance"](disk.mistuned(*given, **parts)))

    assert found([0.02, 2.0, -0.5])["mistuning-unit"].text == (
        "The stiffness of blade 1 deviates by 2, which is 200%; for 2 % give 0.02."
    )
    assert found(mass=[0.0, 0.5, -0.6])["mistuning-unit"].text == (
        "The mass of blade 2 deviates by -0.6, which is -60%; for -0.6 % give -0.006."
    )
    stiffer = ss.Structure(MASS, 3.0 * STIFFNESS, None, ["x", "y"])
    tuned = disk.structure
    assert list(found(structures=[tuned, stiffer, tuned])) == ["mistuning-unit"]
    assert not found([0.3, -0.4, 0.0], mass=[0.1, -0.2, 0.3])


@pytest.mark.parametrize(
    ("patterns", "doubtful"), [([[1.0, 0.5, 2.0]], True), ([[0.1, 0, -0.2]], False)]
)
def test_percents_taken_for_patterns_of_a_study_are_a_caution(patterns, doubtful):
    study = ss.mistuning_study(
        small_disk(), deviation=[0.1, 1.0], patterns=patterns, omega=(100, 400), harmonics=1
    )
    assert ("mistuning-unit" in doubts(study)) is doubtful


@pytest.mark.parametrize("name", ANALYSES)
def test_a_negative_stiffness_is_a_caution_with_its_dof(name):
    (found,) = doubts(ANALYSES[name](unstable())).values()
    assert (found.code, found.data["dof"]) == ("negative-stiffness", "y")
    assert found.severity is Severity.CAUTION


def test_statics_of_a_negative_stiffness_are_a_caution():
    at_rest = ss.static_response(unstable(forces=[ss.Force("y", 1.0, harmonic=0)]))
    assert list(doubts(at_rest)) == ["negative-stiffness"]


def test_motions_on_a_negative_stiffness_are_not_called_stable():
    assert ANALYSES["balance"](model()).stable.tolist() == [True]
    for contacts in ([], None):
        assert ANALYSES["balance"](unstable(contacts=contacts)).stable.tolist() == [None]


@pytest.mark.parametrize("name", ["mode", "cycles", "free"])
def test_the_lowest_mode_of_a_negative_stiffness_is_refused_as_such(name):
    with pytest.raises(ss.ModelError, match="statically unstable"):
        OF_STABLE[name](unstable())


def test_a_spring_that_holds_while_contacts_stick_leaves_the_mode_alone():
    held = unstable(contacts=[ss.Jenkins("y", stiffness=8e4, slip_force=1.0)])
    assert list(doubts(OF_STABLE["mode"](held))) == ["negative-stiffness"]


@pytest.mark.parametrize("digits", [16, 9])
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_rigid_bodies_are_not_taken_for_unstable(digits, scale):
    size = 60
    chain = 2.0 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1)
    chain[0, 0] = chain[-1, -1] = 1.0
    stiffness = chain @ np.diag(np.linspace(1.0, 7.0, size)) @ chain * scale
    printed = np.array([[float(f"{entry:.{digits}g}") for entry in row] for row in stiffness])
    structure = ss.Structure(np.eye(size), 0.5 * (printed + printed.T))
    assert structure.unstable_dof is None


def free_beam(elements=30, spring=0.0):
    """Mass and stiffness of a free beam of 1 m, with a spring to ground at its end."""
    length = 1.0 / elements
    bend = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    move = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
    sizes = np.array([1.0, length, 1.0, length])
    mass, stiffness = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for element in range(elements):
        at = slice(2 * element, 2 * element + 4)
        mass[at, at] += length / 420.0 * move * sizes * sizes[:, None]
        stiffness[at, at] += 100.0 / length**3 * bend * sizes * sizes[:, None]
    stiffness[-2, -2] += spring
    return mass, stiffness


@pytest.mark.parametrize("modes", [3, 5, 12])
@pytest.mark.parametrize("ends", [(0, 60), (0, 1), (10, 40)])
def test_rigid_motions_that_a_reduction_keeps_are_not_taken_for_unstable(ends, modes):
    reduced = ss.craig_bampton(*free_beam(), dict(zip("ab", ends, strict=True)), modes=modes)
    structure = reduced.structure()
    assert structure.unstable_dof is None
    held = ss.craig_bampton(*free_beam(spring=-1.0), {"a": 0, "b": 60}, modes=modes)
    assert held.structure().unstable_dof == "b"


@pytest.mark.parametrize("left", [1e-9, -1e-9])
def test_the_motion_that_grows_fastest_is_named_not_what_rounding_left(left):
    stiffness = np.diag([left, -1.0, 1e5])
    assert ss.Structure(np.eye(3), stiffness, None, list("abc")).unstable_dof == "b"


@pytest.mark.parametrize("spring", [1e3, -1e3, 0.0])
@pytest.mark.parametrize("ends", [(0, 60), (0, 1)])
def test_massless_dofs_at_rigid_motions_are_judged_by_what_they_hold(ends, spring):
    """Two massless dofs in series, the second of them loose or held to ground."""
    beam = ss.craig_bampton(*free_beam(), dict(zip("ab", ends, strict=True)), modes=3).structure()
    size = len(beam)
    mass, stiffness = np.zeros((2, size + 2, size + 2))
    mass[:size, :size], stiffness[:size, :size] = beam.mass, beam.stiffness
    chain = np.array([[1e3, -1e3, 0], [-1e3, 1e3 + spring, -spring], [0, -spring, spring]])
    rows = [beam.index("a"), size, size + 1]
    stiffness[np.ix_(rows, rows)] += chain
    free = ss.Structure(mass, stiffness, None, [*beam.dofs, "p", "q"])
    assert (free.unstable_dof is None) is (spring >= 0.0)
    stiffness[rows[0], rows[0]] -= 1.0
    pulled = ss.Structure(mass, stiffness, None, [*beam.dofs, "p", "q"])
    assert pulled.unstable_dof is not None


def test_massless_dofs_and_units_leave_the_judgement_alone():
    turned = np.diag([1e6, 1e-3]) + np.array([[0.0, 20.0], [20.0, 0.0]])
    assert ss.Structure(MASS, turned, None, ["x", "rz"]).unstable_dof is None
    beyond = np.diag([1e6, 1e-3]) + np.array([[0.0, 40.0], [40.0, 0.0]])
    fitting = np.diag([1.0, 0.5e-9])
    assert ss.Structure(fitting, beyond, None, ["x", "rz"]).unstable_dof == "rz"
    assert ss.Structure(np.diag([1.0, 0.0]), beyond, None, ["x", "rz"]).unstable_dof == "rz"


@pytest.mark.parametrize("name", ANALYSES)
def test_degrees_taken_for_radians_are_a_caution(name):
    def driven(phase):
        forces = [ss.Force("x", 1.0), ss.Force("y", 1.0, phase=phase)]
        return doubts(ANALYSES[name](model(forces=forces)))

    for phase in (180.0, -90, 45):
        assert driven(phase)["phase-unit"].text == (
            f"Force 2 at 'y' has a phase of {phase:g} rad; for degrees write '{phase:g} deg'."
        )
    for phase in ("180 deg", 12 * np.pi, 2 * np.pi * 3 * 35 / 36, 5.0, 7.3):
        assert not driven(phase)


def pressed(friction):
    stiffness = {"tangential_stiffness": 1e4, "normal_stiffness": 1e4, "preload": 5.0}
    return ss.Coulomb(["x", "y"], normal=[0, 1], friction=friction, **stiffness, name="pad")


@pytest.mark.parametrize("name", sorted(ANALYSES.keys() - {"single"}))
def test_percents_taken_for_a_coefficient_of_friction_are_a_caution(name):
    found = doubts(ANALYSES[name](model(contacts=[pressed(30.0)])))
    assert found["friction-unit"].text == (
        "The coefficient of friction of 'pad' is 30; for 30 % give 0.3."
    )
    for friction in (0.3, 1.5, 1e6):
        assert not doubts(ANALYSES[name](model(contacts=[pressed(friction)])))


def test_statics_ask_for_what_concerns_them_alone():
    at_rest = ss.static_response(model(damping=ss.ModalDamping(2.0), contacts=[pressed(30.0)]))
    assert list(doubts(at_rest)) == ["friction-unit"]


def between(kind, angle, **parts):
    """Two blades with a damper of some angle between them."""
    damper = kind(
        angle=angle,
        mass=0.1,
        friction=0.5,
        tangential_stiffness=3e5,
        normal_stiffness=3e5,
        load=120.0,
        **parts,
    )
    blade = ss.Structure(np.eye(2), np.diag([4e4, 9e4]), np.diag([4.0, 6.0]), ["x", "y"])
    ends = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    return damper.between(blade, blade, **ends, forces=[ss.Force("left.x", 1.0)])


@pytest.mark.parametrize("kind", [ss.WedgeDamper, ss.SplitDamper])
def test_radians_taken_for_degrees_are_a_caution(kind):
    def found(angle):
        return doubts(ss.forced_response(between(kind, angle), [150.0], harmonics=1))

    text = "The face {!r} of a damper is inclined by {} deg; for {} rad write '{} rad'."
    assert found(0.6)["angle-unit"].text == text.format("left", *3 * ["0.6"])
    assert found((30.0, 1.2))["angle-unit"].text == text.format("right", *3 * ["1.2"])
    for angle in (0.0, 2.0, 34.0, "0.6 rad"):
        assert not found(angle)


def test_radians_of_a_cylinder_are_a_caution_of_its_statics():
    cylinder = between(ss.CylinderDamper, 0.6, cylinder_radius=0.01)
    assert list(doubts(ss.static_response(cylinder))) == ["angle-unit"]


@pytest.mark.parametrize("analysis", [ss.forced_response, ss.single_harmonic, ss.exact_response])
def test_two_frequencies_that_look_like_a_range_are_a_caution(analysis):
    held = model()
    found = doubts(analysis(held, ["20 Hz", "50 Hz"]))
    assert found["two-frequencies"].text == (
        "omega = [125.664, 314.159] are two frequencies, and nothing between them was computed; "
        "a range is omega = (125.664, 314.159), in study files { from = 125.664, to = 314.159 }."
    )
    for omega in ([150.0, 160.0], [100.0, 200.0, 300.0], [150.0]):
        assert not doubts(analysis(held, omega))


def test_a_range_is_none_of_two_frequencies():
    assert not doubts(ss.forced_response(model(), (120.0, 300.0), harmonics=1))


def test_two_frequencies_that_a_run_came_to_are_none_of_a_range():
    """Of a longer list that Ctrl-C has ended."""
    arrays = ss.forced_response(model(), [100.0, 200.0], harmonics=1).arrays
    assert _two_frequencies(arrays, 2) is not None
    assert _two_frequencies(arrays, 3) is None

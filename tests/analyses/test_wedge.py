"""Wedges between blades and in disks: statics, motion in time, limits of mass, and free flight."""

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from wedges import ENDS, WEDGE


def pair(*, damping=100.0, force=150.0, phase=np.pi, load=240.0, **changes):
    """Two blades of the published system with a wedge between them."""
    wedge = replace(WEDGE, **{"angle": 60.0, "friction": 0.2, "load": load} | changes)
    blades = (
        ss.Structure(10.0 * np.eye(2), stiffness, damping * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    forces = [ss.Force("left.x", force), ss.Force("right.x", force, phase=phase)]
    return wedge.between(*blades, **ENDS, forces=forces)


def test_normal_forces_that_statics_allow():
    at_rest = ss.static_response(WEDGE.between(None, None))
    for side in ("left", "right"):
        least, greatest = at_rest.normal_force_range(side)
        assert least == pytest.approx(104.19226170, abs=1e-8)
        assert greatest == pytest.approx(315.48073651, abs=1e-8)
    smooth = ss.static_response(replace(WEDGE, friction=0.0).between(None, None))
    assert smooth.contact_force("left")[1] == pytest.approx(156.64887472, abs=1e-8)
    assert not WEDGE.locks
    steep = replace(WEDGE, friction=1.0 / np.tan(np.deg2rad(40.0)) + 1e-6)
    assert steep.locks
    locked = ss.static_response(steep.between(None, None))
    assert locked.normal_force_range("left")[1] == np.inf


@pytest.mark.parametrize("angles", [(40.0, 20.0), (60.0, 10.0)])
def test_roof_locks_where_its_friction_cones_face_each_other(angles):
    """Statics finds no greatest force from the friction on that `locks` names."""
    limit = 1.0 / np.tan(np.deg2rad(sum(angles) / 2.0))
    for factor, locks in ((0.99, False), (1.01, True)):
        roof = replace(WEDGE, angle=angles, friction=factor * limit)
        assert roof.locks == locks
        greatest = ss.static_response(roof.between(None, None)).normal_force_range("left")[1]
        assert (greatest == np.inf) == locks


PAIRS = {
    "out of phase": ({}, (105.0, 110.0)),
    "flatter": ({"angle": 50.0}, (99.5, 102.5)),
    "lighter load": ({"load": 120.0}, (99.0, 101.5)),
    "roof": ({"angle": (60.0, 45.0), "phase": 2.2}, (99.0, 102.0)),
    "separating": (
        {"damping": 200.0, "phase": 2.2, "load": 40.0, "mass": 0.5},
        (99.5, 101.5),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_peaks_of_two_blades_are_those_of_time_integration(name):
    changes, span = PAIRS[name]
    model = pair(**changes)
    grid = np.linspace(*span, 5)
    curve = ss.forced_response(model, grid, harmonics=31)
    assert curve.converged.all()
    slips = max(curve.slip_fraction(side).max() for side in ("left", "right"))
    assert slips > 0.2
    opens = [curve.open_fraction(side).max() for side in ("left", "right")]
    assert (max(opens) > 0.02) == (name == "separating")
    assert min(opens) <= 0.0
    amplitudes = curve.amplitude("left.x")
    highest = int(amplitudes.argmax())
    run = ss.transient(model, omega=grid[highest], periods=300, scheme="exact")
    assert run.change[-1] < 1e-6
    assert amplitudes[highest] == pytest.approx(run.amplitude("left.x"), rel=5e-4)


SETS = {
    "as drawn": ({"damping": 100.0}, (97.0, 115.0)),
    "light load": ({"angle": 54.0, "mass": 0.2, "friction": 0.3, "load": 120.0}, (97.0, 112.0)),
    "stiff faces": (
        {
            "angle": 50.0,
            "mass": 0.3,
            "friction": 0.25,
            "tangential_stiffness": 4e5,
            "normal_stiffness": 5e5,
            "load": 480.0,
            "force": 250.0,
        },
        (97.0, 112.0),
    ),
    "one face separates": (
        {
            "angle": 48.0,
            "mass": 0.4,
            "friction": 0.35,
            "load": 200.0,
            "force": 200.0,
            "phase": 2.6,
        },
        (97.0, 112.0),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SETS)
def test_found_peaks_are_those_of_time_integration(name):
    """The peak that the program finds, and the response there and on either side of it."""
    changes, span = SETS[name]
    model = pair(**changes)
    curve = ss.forced_response(model, np.linspace(*span, 31), harmonics=47, stability=False)
    peak = curve.peak("left.x")
    assert not peak.at_edge
    beside = peak.omega + np.array([-0.3, 0.0, 0.3])
    grid = np.append(np.linspace(span[0], beside[0], 3)[:2], beside)
    fine = ss.forced_response(model, grid, harmonics=63, stability=False)
    opens = max(fine.open_fraction(side)[2:].max() for side in ("left", "right"))
    assert (opens > 0.01) == (name == "one face separates")
    run = [
        ss.transient(model, omega=omega, periods=600, scheme="exact", tolerance=1e-7, keep=1)
        for omega in beside
    ]
    assert {one.status for one in run} == {"settled"}
    integrated = [one.amplitude("left.x") for one in run]
    np.testing.assert_allclose(fine.amplitude("left.x")[2:], integrated, rtol=5e-5)
    assert peak.amplitude == pytest.approx(max(integrated), rel=5e-4)
    assert integrated[1] == max(integrated)


def sprung(load, factor):
    """Two blades, coupled to one another, on a wedge with a spring of its own: a published system.

    Its numbers stand in published scripts: blades of 1 kg, 20 kg/s, three springs of 3e5 N/m each,
    7e5 N/m between them; a wedge of 0.1 kg, 30 degrees, friction 0.5, 120 N; forces of -20 and 5 N.
    """
    blade = ss.Structure(np.eye(2), [[6e5, -3e5], [-3e5, 6e5]], 20.0 * np.eye(2), ["x", "y"])
    between = [ss.Coupling(f"left.{one}", f"right.{one}", stiffness=7e5) for one in "xy"]
    wedge = replace(WEDGE, angle=30.0, friction=0.5, load=load)
    model = wedge.inside(
        ss.join({"left": blade, "right": blade}, between),
        left_dofs=["left.x", "left.y"],
        right_dofs=["right.x", "right.y"],
        forces=[ss.Force("left.y", -20.0 * factor), ss.Force("right.x", 5.0 * factor)],
    )
    free = model.structure
    own = np.array([[one == f"damper.{axis}" for one in free.dofs] for axis in "xy"], dtype=float)
    spring = 3e5 * np.outer(own[0] - own[1], own[0] - own[1])
    stiffness = free.stiffness + spring
    return model.with_structure(ss.Structure(free.mass, stiffness, free.damping, free.dofs))


@pytest.mark.slow
@pytest.mark.parametrize(("load", "factor"), [(120.0, 1.0), (120.0, 3.0)])
def test_peaks_of_a_published_system_are_those_of_time_integration(load, factor):
    """One face separates at the peak."""
    model = sprung(load, factor)
    grid = 2.0 * np.pi * np.linspace(145.0, 235.0, 121)
    curve = ss.forced_response(model, grid, 31, observe=["left.y"], stability=False)
    peak = curve.peak("left.y")
    assert not peak.at_edge
    at = ss.forced_response(model, [peak.omega], 31, observe=["left.y"], stability=False)
    opens = [at.open_fraction(side)[0, 0] for side in ("left", "right")]
    assert max(opens) > 0.2
    assert min(opens) <= 0.0
    run = ss.transient(model, omega=peak.omega, periods=600, scheme="exact", keep=1)
    assert peak.amplitude == pytest.approx(run.amplitude("left.y"), rel=5e-4)


@pytest.mark.slow
def test_what_nothing_stays_on_is_said_to_be_unstable():
    """Under half the load the peak is unstable; time integration comes to the motion before it."""
    model = sprung(60.0, 1.0)
    omega = 2.0 * np.pi * np.array([158.02, 158.394])
    exact = ss.exact_response(model, omega, observe=["left.y"])
    balance = ss.forced_response(model, omega, 31, observe=["left.y"])
    np.testing.assert_allclose(balance.amplitude("left.y"), exact.amplitude("left.y"), rtol=1e-5)
    assert list(balance.stable) == [True, False]
    assert list(exact.stable) == [True, False]
    runs = [ss.transient(model, omega=one, periods=1000, tolerance=1e-8, keep=1) for one in omega]
    assert [run.status for run in runs] == ["settled", "not settled"]
    assert balance.amplitude("left.y")[0] == pytest.approx(runs[0].amplitude("left.y"), rel=1e-6)


@pytest.mark.parametrize(
    ("parameter", "step"),
    [("friction", 1e-4), ("tangential_stiffness", 30.0), ("normal_stiffness", 30.0)],
)
def test_sensitivities_against_differences(parameter, step):
    value = getattr(replace(WEDGE, friction=0.2), parameter)

    def solved(left):
        model = pair(**{parameter: (left, value)})
        return ss.forced_response(model, [100.0], harmonics=5, stability=False)

    up, down = (solved(value + side * step).amplitude("left.x")[0] for side in (1.0, -1.0))
    found = solved(value).sensitivity("left.x", "left", parameter)[0]
    assert found == pytest.approx((up - down) / (2.0 * step), rel=1e-4)


def test_mass_to_zero_is_a_wedge_without_mass():
    omega = [100.0, 104.0]

    def solved(mass):
        model = pair(mass=mass)
        result = ss.forced_response(model, omega, harmonics=7, stability=False)
        assert result.converged.all()
        assert result.slip_fraction("left").min() > 0.1
        return result.coefficients("left.x")[:, 1]

    none = solved(0.0)
    far, near = (np.abs(solved(mass) - none).max() for mass in (1e-2, 1e-3))
    # What is left is proportional to the mass.
    assert near == pytest.approx(0.1 * far, rel=0.05)
    assert near < 1e-3 * np.abs(none).max()


@pytest.mark.slow
def test_flat_damper_of_hardly_any_mass_is_a_structural_damper():
    """Under a constant load both are two sliders in series, beside a rigid body."""
    blades = [
        ss.Structure(np.diag([mass, 1.0]), np.diag([4e4, 1e5]), np.diag([4.0, 4.0]), ["x", "y"])
        for mass in (1.0, 1.2)
    ]
    flat = replace(
        WEDGE, angle=0.0, mass=1e-5, friction=(0.3, 0.2), tangential_stiffness=2e4, load=100.0
    )
    forces = [ss.Force("left.x", 30.0), ss.Force("right.x", 20.0, phase=2.0)]
    body = flat.between(*blades, **ENDS, forces=forces)
    series = 1e4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damper = ss.StructuralDamper(["left.x", "right.x"], stiffness=series, slip_forces=[15.0, 10.0])
    structure = ss.join(dict(zip(("left", "right"), blades, strict=True)))
    omega = np.linspace(210.0, 228.0, 10)
    one, other = (
        ss.forced_response(model, omega, harmonics=9, stability=False)
        for model in (body, ss.Model(structure, [damper], forces))
    )
    assert one.converged.all()
    assert other.converged.all()
    assert other.slip_fraction(0).max(axis=-1).min() > 0.3
    # The balance leaves out harmonics of the body's own motion, which the law has condensed.
    assert one.amplitude("left.x") == pytest.approx(other.amplitude("left.x"), rel=3e-3)
    # By itself every point has a solution as well, the same.
    for place, frequency in enumerate(omega):
        alone = ss.forced_response(body, [frequency], harmonics=9, stability=False)
        assert alone.converged.all()
        assert alone.residual.max() < 1e-8
        swept = one.amplitude("left.x")[place]
        assert alone.amplitude("left.x") == pytest.approx(swept, rel=1e-6)


def disk(sectors=24, **changes):
    blade = ss.Structure(np.eye(2), [[4e4, -5e3], [-5e3, 2e5]], ss.Rayleigh(mass=8.0), ["x", "y"])
    wedge = replace(
        WEDGE,
        angle=60.0,
        mass=0.05,
        friction=0.2,
        tangential_stiffness=5e4,
        normal_stiffness=5e4,
        load=60.0,
    )
    ring = [ss.Coupling("x", stiffness=2e3)]
    return wedge.in_disk(
        blade,
        sectors,
        engine_order=max(sectors // 8, 1),
        forces=[ss.Force("x", 15.0)],
        couplings=ring,
        **ENDS,
        **changes,
    )


@pytest.mark.slow
@pytest.mark.parametrize(("axes", "sectors"), [("sector", 24), ("parallel", 8)])
def test_one_sector_is_the_ring(axes, sectors):
    tuned = disk(sectors, axes=axes)
    march = {"evaluation": "marched", "samples": 192, "harmonics": 2, "stability": False}
    wave = ss.forced_response(tuned, [212.0], **march)
    every = ss.forced_response(tuned.mistuned(0.0), [212.0], **march)
    assert wave.converged.all()
    assert every.converged.all()
    for side in ("left", "right"):
        assert wave.slip_fraction(side)[0, 0] > 0.2
    for blade in (0, 5, sectors - 1):
        for dof in ("x", "damper.y"):
            own = every.coefficients(f"{blade}.{dof}")
            turned = wave.sector(blade).coefficients(dof)
            np.testing.assert_allclose(turned, own, rtol=0.0, atol=1e-9 * np.abs(own).max())


def test_mistuned_disk_has_a_damper_behind_every_blade():
    mistuned = disk(sectors=3).mistuned([0.02, -0.02, 0.0])
    assert mistuned.contact_names[:3] == ("0.left", "0.right", "1.left")
    assert mistuned.contacts[5].dofs == (
        "2.damper.x",
        "2.damper.y",
        "0.x",
        "0.y",
        "0.x",
        "0.y",
    ) or (set(mistuned.contacts[5].dofs) == {"2.damper.x", "2.damper.y", "0.x", "0.y"})
    result = ss.forced_response(mistuned, [205.0], harmonics=3, stability=False)
    assert result.converged.all()
    assert np.ptp([result.amplitude(f"{blade}.x")[0] for blade in range(3)]) > 0.0


@pytest.mark.slow
def test_amplification_of_mistuned_disks_with_wedges():
    """A study finds the highest blade of every pattern, as by its disk one by one."""
    tuned, span = disk(sectors=6), (205.0, 235.0)
    patterns = np.random.default_rng(4).normal(size=(2, 6))
    options = {"harmonics": 1, "omega": span}
    study = ss.mistuning_study(tuned, 0.02, patterns=patterns, dofs=["x"], **options)

    def highest(pattern):
        grid = np.linspace(*span, 61)
        frf = ss.forced_response(
            tuned.mistuned(0.02 * np.array(pattern)), grid, harmonics=1, stability=False
        )
        assert frf.converged.all()
        assert max(frf.slip_fraction(one).max() for one in ("0.left", "3.right")) > 0.2
        return max(frf.peak(f"{blade}.x").amplitude for blade in range(6))

    reference = highest(np.zeros(6))
    own = [highest(pattern) / reference for pattern in patterns]
    np.testing.assert_allclose(study.amplification("x").ravel(), own, rtol=1e-3)
    assert max(own) > 1.03


def test_free_flight_is_named():
    light = replace(WEDGE, friction=0.2, load=5.0)
    model = light.between(None, None, forces=[ss.Force("damper.y", 20.0)])
    result = ss.forced_response(model, [300.0], harmonics=7, stability=False)
    (flight,) = [one for one in result.diagnostics if one.code == "free-flight"]
    assert flight.severity == ss.Severity.CAUTION
    assert flight.data["body"] == "damper"
    assert flight.data["share"] == pytest.approx(result.open_fraction("left")[0, 0], abs=0.02)
    held = light.between(None, None, forces=[ss.Force("damper.y", 1.0)])
    calm = ss.forced_response(held, [300.0], harmonics=7, stability=False)
    assert not any(one.code == "free-flight" for one in calm.diagnostics)


def test_turning_wedge_moves_as_the_wedge_where_nothing_turns_it():
    """Pressed in the middle by equal blades that move alike, a wedge does not turn."""
    blade = ss.Structure(np.eye(2), np.diag([4e4, 6e4]), np.diag([8.0, 8.0]), ["x", "y"])
    turning = replace(
        WEDGE, inertia=2e-5, positions=[(-0.012, 0.002), (-0.008, 0.006)], friction=0.3
    )
    plain = replace(WEDGE, friction=0.3)
    forces = [ss.Force("left.y", 60.0), ss.Force("right.y", 60.0)]
    one, other = (
        ss.forced_response(
            wedge.between(blade, blade, **ENDS, forces=forces),
            [180.0],
            harmonics=5,
            stability=False,
        )
        for wedge in (turning, plain)
    )
    np.testing.assert_allclose(
        one.coefficients("damper.y"),
        other.coefficients("damper.y"),
        atol=1e-6 * np.abs(other.coefficients("damper.y")).max(),
    )
    assert np.abs(one.coefficients("damper.rotation")).max() < 1e-9


def test_verdicts_where_a_face_touches_its_limit():
    """Rounding decides whether the face slips for an instant: the verdict does not depend on it."""
    blade = ss.Structure(np.eye(2), [[6e5, -3e5], [-3e5, 6e5]], 20.0 * np.eye(2), ["x", "y"])
    links = [ss.Coupling(f"left.{a}", f"right.{a}", stiffness=7e5) for a in "xy"]
    wedge = replace(WEDGE, angle=30.0, friction=0.5, load=60.0)
    dofs = {f"{side}_dofs": [f"{side}.x", f"{side}.y"] for side in ("left", "right")}
    forces = [ss.Force("left.y", -20.0), ss.Force("right.x", 5.0)]
    model = wedge.inside(ss.join({"left": blade, "right": blade}, links), **dofs, forces=forces)
    own = model.structure
    stiffness = own.stiffness.copy()
    at = [own.index("damper.x"), own.index("damper.y")]
    stiffness[np.ix_(at, at)] += 3e5 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    model = model.with_structure(ss.Structure(own.mass, stiffness, own.damping, own.dofs))
    omega = 2.0 * np.pi * np.linspace(156.30, 156.42, 7)
    orbits = ss.exact_response(model, omega)
    balance = ss.forced_response(model, omega, 31)
    assert list(orbits.stable) == 7 * [False]
    assert list(balance.stable) == list(orbits.stable)
    for number in range(7):
        assert orbits.slip_fraction("right")[number].max() == 0.0
    largest = np.abs(orbits.multipliers).max(axis=1)
    assert np.abs(np.diff(largest)).max() < 0.05

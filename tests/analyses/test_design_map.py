"""Peaks over two parameters of a design, and responses along a speed that changes the model."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from slow_law import Slow
from wedges import WEDGE

FLAT = replace(WEDGE, angle=60.0, friction=0.2)


def pair(mass=0.1, angle=60.0, wedge=FLAT):
    blades = (
        ss.Structure(10.0 * np.eye(2), stiffness, 100.0 * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    forces = [ss.Force("left.x", 150.0), ss.Force("right.x", 150.0, phase=np.pi)]
    damper = replace(wedge, mass=mass, angle=angle)
    ends = ["x", "y"]
    return damper.between(*blades, left_dofs=ends, right_dofs=ends, forces=forces)


@pytest.mark.slow
def test_peaks_of_a_map_are_those_of_fine_curves():
    values = {"mass": [0.05, 0.2], "angle": [50.0, 60.0]}
    found = ss.design_map(pair, values, dof="left.x", omega=(95.0, 120.0), threads=1)
    assert found.amplitude.shape == (2, 2)
    assert found.status == 2 * (2 * ("converged",),)
    for row, mass in enumerate(values["mass"]):
        for column, angle in enumerate(values["angle"]):
            near = found.omega[row, column] + np.linspace(-2.0, 2.0, 9)
            fine = ss.forced_response(pair(mass, angle), near, 63, stability=False)
            expected = np.nanmax(fine.amplitude("left.x"))
            assert found.amplitude[row, column] == pytest.approx(expected, rel=1e-2)
    best = found.optimum
    assert found.amplitude.min() == pytest.approx(
        found.amplitude[values["mass"].index(best["mass"]), values["angle"].index(best["angle"])]
    )
    axes = found.plot(length_unit="mm", ax=Figure().add_subplot())
    assert axes.get_xlabel() == "mass"


@pytest.mark.slow
def test_a_peak_that_wants_more_harmonics_says_so():
    values = {"mass": [1e-2], "angle": [45.0]}
    span = {"dof": "left.x", "omega": (95.0, 120.0)}
    found = ss.design_map(pair, values, **span)
    assert found.status == (("harmonics limit",),)
    assert "max_harmonics" in found.status[0][0].advice
    enough = ss.design_map(pair, values, **span, max_harmonics=255)
    assert enough.status == (("converged",),)
    np.testing.assert_allclose(found.amplitude, enough.amplitude, rtol=1e-4)
    few = ss.design_map(pair, values, **span, max_harmonics=5)
    assert few.status == (("harmonics limit",),)
    assert np.isnan(few.amplitude).all()


@pytest.mark.parametrize("varied", ["mass", "angle"])
def test_one_parameter_is_a_curve(varied):
    """A parameter with a single value stays; the least peak is marked."""
    values = {"mass": [0.1], "angle": [60.0]} | {varied: [0.2, 0.004, 0.1]}
    found = ss.design_map(
        lambda mass, angle: pair(
            mass if varied == "mass" else 0.1, 60.0 * (1.0 + mass * angle / 1e3)
        ),
        values,
        dof="left.x",
        omega=(95.0, 120.0),
        max_harmonics=15,
    )
    ax = found.plot(length_unit="mm", ax=Figure().add_subplot())
    curve, star = ax.lines[:2]
    np.testing.assert_array_equal(curve.get_xdata(), [0.004, 0.1, 0.2])
    places = [values[varied].index(one) for one in curve.get_xdata()]
    np.testing.assert_allclose(curve.get_ydata(), 1e3 * found.amplitude.ravel()[places])
    assert star.get_xdata()[0] == found.optimum[varied]
    assert ax.get_xlabel() == varied
    assert ax.get_xscale() == "log"
    assert ax.get_ylabel() == "peak of left.x [mm]"
    other = "angle" if varied == "mass" else "mass"
    assert ax.get_title() == f"{other} = {values[other][0]:g}"


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"mass": [0.1]}, "give two, .* one value for a parameter that stays"),
        ({"mass": [0.1], "angle": ["x"]}, "angle: 'x' is not a number"),
    ],
)
def test_refused_parameters(parameters, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.design_map(pair, parameters, dof="left.x", omega=(95.0, 120.0))


def test_refused_models():
    values = {"mass": [0.1], "angle": [60.0]}
    with pytest.raises(ss.ModelError, match="build: 3 is no Model"):
        ss.design_map(lambda mass, angle: 3, values, dof="left.x", omega=(95.0, 120.0))
    with pytest.raises(ss.ModelError, match="give 0 < from < to"):
        ss.design_map(pair, values, dof="left.x", omega=(95.0, 95.0))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"build": 3}, "build: 3 cannot be called"),
        ({"build": lambda mass: None}, "build: .*angle"),
        ({"parameters": {"mass": [], "angle": [60.0]}}, "'mass' has no values"),
        ({"omega": 150.0}, "omega: 150.0 is not a list"),
        ({"omega": []}, "give 0 < from < to"),
        ({"omega": (90.0, 95.0, 100.0)}, "give 0 < from < to"),
        ({"points": 2}, "points"),
        ({"points": "x"}, "points"),
        ({"points": 10**30}, "points"),
        ({"threads": -3}, "threads"),
        ({"threads": "two"}, "threads"),
    ],
)
def test_refused_arguments(wrong, message):
    given = {"build": pair, "parameters": {"mass": [0.1], "angle": [60.0]}}
    given |= {"dof": "left.x", "omega": (95.0, 120.0)} | wrong
    with pytest.raises(ss.ModelError, match=message):
        ss.design_map(**given)


def test_speed_changes_loads_and_stiffness():
    """A linear blade that stiffens, and the wedge whose load grows with the square of the speed."""
    blade = ss.Structure([[1.0]], [[4e4]], [[4.0]], ["x"])
    at = ss.spinning(blade, [[0.5]], softening=[[1.0]])
    speeds = np.array([40.0, 90.0])
    found = ss.speed_response(
        lambda speed: ss.Model(at(speed), forces=[ss.Force("x", 3.0)]),
        speeds,
        engine_order=2,
        dof="x",
        harmonics=1,
    )
    omega = 2.0 * speeds
    dynamic = 4e4 - 0.5 * speeds**2 - omega**2 + 4j * omega
    np.testing.assert_allclose(found.amplitude, 3.0 / np.abs(dynamic), rtol=1e-12)
    np.testing.assert_array_equal(found.omega, omega)
    spun = [
        pair(wedge=replace(FLAT, load=ss.Centrifugal(radius=0.4, speed=speed))).forces[0]
        for speed in speeds
    ]
    np.testing.assert_allclose([one.amplitude for one in spun], 0.1 * 0.4 * speeds**2)
    with pytest.raises(ss.ModelError, match=r"stiffening: \(2, 2\)"):
        ss.spinning(blade, np.eye(2))
    with pytest.raises(ss.ModelError, match="give numbers above zero"):
        ss.speed_response(at, [0.0], engine_order=2, dof="x")


def test_engine_orders_over_the_speed_of_the_rotor():
    blade = ss.Structure([[1.0]], [[4e4]], [[4.0]], ["x"])
    turning = ss.spinning(blade, [[0.5]])

    def at(speed):
        return ss.Model(turning(speed), forces=[ss.Force("x", 3.0)])

    speeds = np.linspace(50.0, 120.0, 8)
    found = [
        ss.speed_response(at, speeds, engine_order=order, dof="x", harmonics=1) for order in (2, 3)
    ]
    diagram = ss.campbell(at, speed=speeds, orders=[2, 3])
    ax = ss.plot.speed_response(found, diagram=diagram)
    assert ax.get_xlabel() == "rotor speed [rpm]"
    lines = {line.get_label(): line for line in ax.lines}
    np.testing.assert_array_equal(lines["EO 3"].get_ydata(), found[1].amplitude)
    np.testing.assert_allclose(lines["EO 3"].get_xdata(), speeds * 30.0 / np.pi)
    # The orders meet K + W^2 / 2 = (E W)^2.
    for order in (2, 3):
        met = np.sqrt(4e4 / (order**2 - 0.5)) * 30.0 / np.pi
        (drawn, _) = lines[f"resonances of EO {order}"].get_xdata()
        np.testing.assert_allclose(drawn, met, rtol=5e-3)
    (above,) = found[0].plot().child_axes
    assert above.get_xlabel() == "frequency [Hz]"
    with pytest.raises(ss.ModelError, match="it has the engine orders 2, 3, not 5"):
        ss.speed_response(at, speeds, engine_order=5, dof="x").plot(diagram=diagram)


def damped(limit, stiffness):
    blade = ss.Structure([[1.0]], [[1e4]], damping=ss.ModalDamping(1e-4), dofs=["x"])
    contact = ss.Jenkins("x", stiffness=stiffness, slip_force=limit)
    return ss.Model(blade, [contact], [ss.Force("x", 1.0)])


def test_a_resonance_between_the_points_of_the_coarse_grid_is_found():
    values = {"limit": [0.1, 5.0], "stiffness": [1e2, 3e3]}
    found = ss.design_map(damped, values, dof="x", omega=(60.0, 140.0), points=5)
    for row, limit in enumerate(values["limit"]):
        for column, stiffness in enumerate(values["stiffness"]):
            curve = ss.damper_curve(
                damped(limit, stiffness), dof="x", slip_force=[limit], omega=(60.0, 140.0)
            )
            assert found.amplitude[row, column] == pytest.approx(curve.amplitude[0], rel=1e-2)


@pytest.mark.slow
def test_ctrl_c_keeps_the_cells_that_are_done():
    shares = []

    def press(share):
        shares.append(share)
        if share > 0.2:
            raise KeyboardInterrupt

    values = {"limit": np.geomspace(0.1, 5.0, 40), "stiffness": np.geomspace(1e2, 1e4, 40)}
    span = {"dof": "x", "omega": (60.0, 140.0), "threads": 1}
    with pytest.raises(ss.Interrupted, match=r"design map interrupted after \d+ of 1600") as caught:
        ss.design_map(damped, values, **span, progress=press)
    kept = caught.value.result
    assert kept.interrupted
    done = kept.codes != ss.Status.NOT_COMPUTED.code
    assert 0.2 * 1600 < done.sum() < 1600
    assert np.isfinite(kept.amplitude[done]).all()
    assert np.isnan(kept.amplitude[~done]).all()
    first = {name: one[:1] for name, one in values.items()}
    whole = ss.design_map(damped, first, **span, progress=shares.append)
    assert whole.amplitude[0, 0] == kept.amplitude[0, 0]
    assert not whole.interrupted
    assert shares[-1] == 1.0


@pytest.mark.slow
def test_cells_that_are_done_are_kept_where_the_last_one_cannot_be_stopped(monkeypatch):
    """A step of a law, as a factorisation, asks nobody whether to go on."""

    def build(mass, slow):
        body = ss.Structure([[mass]], [[1e4]], ss.ModalDamping(0.01), ["x"])
        quick = ss.Jenkins("x", stiffness=1e3, slip_force=1.0)
        return ss.Model(body, [Slow(["x"]) if slow else quick], [ss.Force("x", 1.0)])

    def press(share):
        monkeypatch.setattr(Slow, "pause", 2.0)
        if share > 0.0:
            raise KeyboardInterrupt

    values = {"mass": [1.0], "slow": [0.0, 1.0]}
    span = {"dof": "x", "omega": (60.0, 140.0), "threads": 1}
    with pytest.raises(ss.Interrupted, match="interrupted after 1 of 2 cells") as caught:
        ss.design_map(build, values, **span, progress=press)
    assert caught.value.result.status[0] == ("converged", "not computed")


def test_an_undamped_mode_that_no_damper_sees_ends_its_cells_alone() -> None:
    """Equal blades moving together, at a frequency that the grid meets."""
    blades = ss.Structure(np.eye(2), np.eye(2), dofs=["x", "y"])

    def build(limit: float, damping: float) -> ss.Model:
        body = ss.Structure(blades.mass, blades.stiffness, damping * np.eye(2), blades.dofs)
        contact = ss.Jenkins("x", "y", stiffness=1.0, slip_force=limit)
        return ss.Model(body, [contact], [ss.Force("x", 0.3)])

    found = ss.design_map(
        build, {"limit": [1.0, 2.0], "damping": [0.0, 0.02]}, dof="x", omega=(0.9, 1.1)
    )
    assert [[str(one) for one in row] for row in found.status] == 2 * [["singular", "converged"]]
    assert (np.isnan(found.amplitude) == [[True, False]]).all()


class Failing(ss.ContactLaw):
    """Sticks, and fails where a spring is stiff."""

    odd = monotone = True
    state_size = 1

    def __init__(self, *ends, k, **options):
        super().__init__(*ends, **options)
        self.k = k

    def stiffness(self):
        return [[self.k]]

    def step(self, before, after, state):
        if self.k > 1e3:
            raise RuntimeError("too stiff")
        force = state + self.k * (after - before)
        one = np.ones((1, 1))
        return force, force, ss.Tangents(one, -self.k * one, self.k * one, one, 0.0 * one)


def test_laws_of_all_models_are_heeded():
    structure = ss.Structure(np.eye(1), [[1e4]], [[2.0]], ["x"])
    models = []

    def build(k, load):
        models.append(ss.Model(structure, [Failing(["x"], k=k)], [ss.Force("x", load)]))
        return models[-1]

    span = {"dof": "x", "omega": (90.0, 120.0), "threads": 1}
    ss.design_map(build, {"k": [5e2, 1e3], "load": [1.0]}, **span)
    assert [one.contacts[0]._answers for one in models] == [None, None]
    with pytest.raises(ss.ModelError, match="step raised RuntimeError: too stiff"):
        ss.design_map(build, {"k": [1e3, 2e3], "load": [1.0]}, **span)

"""Every answer is the same in every consistent system of units, also with one for each dof."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

import stickslip as ss


class Units(NamedTuple):
    """Sizes of the units in SI, and those of the dofs over that of the length."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0
    dofs: tuple[float, ...] = (1.0, 1.0, 1.0)

    @property
    def force(self):
        return self.mass * self.length / self.time**2

    def stiffness(self, dof=0):
        """Return one N/m of a contact at a dof."""
        return self.dofs[dof] ** 2 * self.length / self.force

    def load(self, dof=0):
        """Return one N at a dof."""
        return self.dofs[dof] / self.force

    def distance(self, dof=0):
        """Return one m at a dof."""
        return 1.0 / (self.dofs[dof] * self.length)


SI = Units()
SYSTEMS = {
    "mm and t": Units(1e-3, 1e3),
    "nm and ms": Units(1e-9, 1e-12, 1e-3),
    "km and h": Units(1e3, 1e6, 3600.0),
    "angles": Units(dofs=(1.0, 1.0, 1e-3)),
    "angles and mm": Units(1e-3, 1e3, dofs=(1.0, 1.0, 1e3)),
}

LAWS = {
    "jenkins": lambda u: ss.Jenkins("x", stiffness=3 * u.stiffness(), slip_force=u.load()),
    "iwan": lambda u: ss.Iwan(
        "x", stiffness=3 * u.stiffness(), slip_force=u.load(), chi=-0.5, beta=0.5
    ),
    "masing": lambda u: ss.Masing(
        "x", stiffness=3 * u.stiffness(), slip_force=u.load(), backbone="exponential"
    ),
    "bouc-wen": lambda u: ss.BoucWen(
        "x", stiffness=3 * u.stiffness(), slip_force=u.load(), exponent=1.5
    ),
    "cubic": lambda u: ss.Cubic("x", stiffness=0.5 * u.load() / u.distance() ** 3),
    "stop": lambda u: ss.Stop("x", stiffness=3 * u.stiffness(), gap=0.4 * u.distance()),
    "preload": lambda u: pad(u, preload=2.0 * u.load()),
    "gap": lambda u: pad(u, gap=0.2 * u.distance()),
}
EXACT = ["jenkins", "iwan", "masing", "preload", "gap"]


def pad(u, **closure):
    springs = {"tangential_stiffness": 3 * u.stiffness(), "normal_stiffness": 4 * u.stiffness()}
    return ss.Coulomb(["x", "y"], normal=[0, 1], friction=0.4, **springs, **closure)


def model(seed, law, units, load=1.0):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3))
    stiffness = root @ root.T + np.diag(rng.uniform(1.5, 6.0, 3))
    mass = np.diag(rng.uniform(0.5, 2.0, 3))
    damping = 0.02 * mass + 0.01 * stiffness + np.diag(rng.uniform(0.0, 0.02, 3))
    dofs = np.diag(units.dofs)
    structure = ss.Structure(
        dofs @ mass @ dofs / units.mass,
        dofs @ stiffness @ dofs * units.length / units.force,
        dofs @ damping @ dofs * units.length / (units.force * units.time),
        ["x", "y", "z"],
    )
    forces = [
        ss.Force("x", load * units.load(0)),
        ss.Force("z", 0.5 * load * units.load(2), phase=0.7),
    ]
    return ss.Model(structure, [LAWS[law](units)], forces if load else [])


def amplitudes(result, units):
    return np.stack([result.amplitude(dof) / units.distance(i) for i, dof in enumerate("xyz")])


OMEGA = np.array([0.9, 1.4, 2.1])


def balanced(seed, law, units):
    result = ss.forced_response(model(seed, law, units), OMEGA * units.time, 5)
    slope = result.sensitivity("x", parameter="level") / units.distance()
    return [amplitudes(result, units), slope, result.stability == "stable"]


def automatic(seed, law, units):
    result = ss.forced_response(model(seed, law, units), OMEGA * units.time)
    return [amplitudes(result, units), result.harmonics]


def at_rest(seed, law, units):
    return [ss.natural_frequencies(model(seed, law, units)) / units.time]


def followed(seed, law, units):
    own = model(seed, law, units)
    exact = ss.exact_response(own, OMEGA * units.time)
    free = ss.classify(model(seed, law, units, 0.0), {"x": 2.0 * units.distance()}, periods=40)
    return [amplitudes(exact, units), exact.status == "converged", [free.reason == "held"]]


def stepped(seed, law, units):
    return [ss.transient(model(seed, law, units), 1.4 * units.time, 5, scheme="rk4").change]


def modes(seed, law, units):
    amplitude = np.array([0.1, 1.0, 3.0]) / (units.length * np.sqrt(units.mass))
    found = ss.nonlinear_modes(model(seed, law, units), mode=0, amplitude=amplitude, harmonics=3)
    return [found.omega / units.time, found.damping_ratio]


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("analysis", [at_rest, balanced, automatic, stepped, followed, modes])
def test_answers_do_not_depend_on_the_units(analysis, law):
    if analysis is followed and law not in EXACT:
        pytest.skip("the law has no events that an exact motion could be followed by")
    for seed in range(3):
        expected = analysis(seed, law, SI)
        for name, units in SYSTEMS.items():
            for one, same in zip(analysis(seed, law, units), expected, strict=True):
                size = np.abs(np.asarray(same, dtype=float)).max()
                np.testing.assert_allclose(
                    one, same, rtol=0.0, atol=1e-9 * size, err_msg=f"{seed} {name}"
                )

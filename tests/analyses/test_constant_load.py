"""Under a constant normal load and in one direction a Coulomb contact is a Jenkins element."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import stickslip as ss
from stickslip.model import Contact

STRUCTURE = ss.Structure(
    np.eye(3),
    [[3e4, -1e4, 0.0], [-1e4, 3e4, -1e4], [0.0, -1e4, 2e4]],
    ss.Rayleigh(mass=3.0),
    ["a", "b", "c"],
)
FORCES = [ss.Force("a", 30.0), ss.Force("c", 10.0, phase=0.4)]
STATIC = ss.Force("b", 4.0, harmonic=0)
GRID = np.linspace(60.0, 260.0, 9)
UNSTABLE = -12.0 * np.diag([0.0, 0.0, 1.0])
LOAD = {"friction": 0.25, "tangential_stiffness": 8e3, "preload": 40.0}


def jenkins() -> Contact:
    return ss.Jenkins("a", stiffness=8e3, slip_force=10.0, name="pad")


def along_a_line() -> Contact:
    return ss.Coulomb(["a"], normal=None, **LOAD, name="pad")


def as_a_face() -> Contact:
    return ss.Coulomb([["a"]], normal=None, **LOAD, name="pad")


def without_normal_stiffness() -> Contact:
    return ss.Coulomb(["a", "c"], normal=[0, 1], normal_stiffness=0.0, **LOAD, name="pad")


def model(contact: Contact, *static: ss.Force) -> ss.Model:
    return ss.Model(STRUCTURE, [contact], [*FORCES, *static])


def amplitudes(result: ss.ForcedResponse | ss.ExactResponse | ss.Transient) -> NDArray[np.float64]:
    return np.array([result.amplitude(dof) for dof in "abc"])


def cycles(contact: Contact, method: str) -> NDArray[np.float64]:
    found = ss.limit_cycles(
        ss.Model(STRUCTURE, [contact], []),
        negative_damping=UNSTABLE,
        mode=0,
        harmonics=7,
        method=method,
        ratio=[0.5, 0.6],
    )
    return np.concatenate([found.ratio, found.omega, found.amplitude("a")])


def disk(contact: Contact) -> ss.BladedDisk:
    return ss.BladedDisk(
        STRUCTURE,
        sectors=5,
        couplings=[ss.Coupling("c", stiffness=3e3)],
        contacts=[contact],
        forces=FORCES[:1],
        engine_order=1,
    )


def bounds(contact: Contact) -> NDArray[np.float64]:
    found = ss.forced_response(model(contact, STATIC), GRID[::4], 7, residual="bounds")
    return np.array([found.lower("a"), found.upper("a")])


def modes(contact: Contact) -> NDArray[np.float64]:
    found = ss.nonlinear_modes(model(contact), mode=0, amplitude=np.geomspace(1e-3, 0.1, 5))
    return np.array([found.omega, found.damping_ratio])


def fate(contact: Contact) -> NDArray[np.float64]:
    found = ss.classify(ss.Model(STRUCTURE, [contact], []), {"a": 1e-2})
    return found.final.displacement


def peaks(contact: Contact) -> NDArray[np.float64]:
    levels = {"slip_force": [3.0, 30.0]}
    if isinstance(contact, ss.Coulomb):
        levels = {"preload": [12.0, 120.0]}
    found = ss.damper_curve(model(contact), dof="c", harmonics=5, **levels)
    return np.array([found.amplitude, found.omega])


ANALYSES: dict[str, Callable[[Contact], NDArray[np.float64]]] = {
    "forced response": lambda c: amplitudes(ss.forced_response(model(c), GRID, 7)),
    "automatic harmonics": lambda c: amplitudes(ss.forced_response(model(c), GRID)),
    "samples": lambda c: amplitudes(
        ss.forced_response(model(c), GRID, 7, evaluation="marched", samples=256)
    ),
    "static load": lambda c: amplitudes(ss.forced_response(model(c, STATIC), GRID, 7)),
    "slip": lambda c: ss.forced_response(model(c), GRID, 7).slip_fraction("pad").ravel(),
    "dissipation": lambda c: ss.forced_response(model(c), GRID, 7).dissipation("pad").ravel(),
    "bounds": bounds,
    "exact response": lambda c: amplitudes(ss.exact_response(model(c), GRID)),
    "multipliers": lambda c: np.sort(np.abs(ss.exact_response(model(c), GRID).multipliers)),
    "exact transient": lambda c: amplitudes(ss.transient(model(c), 150.0, 10, "exact")),
    "Runge-Kutta": lambda c: amplitudes(ss.transient(model(c), 150.0, 10, "rk4")),
    "statics": lambda c: [ss.static_response(model(c, STATIC)).displacement(dof) for dof in "abc"],
    "modes": modes,
    "limit cycles": lambda c: cycles(c, "newton"),
    "exact limit cycles": lambda c: cycles(c, "exact"),
    "classify": fate,
    "damper curve": peaks,
    "tuned disk": lambda c: amplitudes(ss.forced_response(disk(c), GRID, 5)),
    "mistuned disk": lambda c: ss.forced_response(
        disk(c).mistuned([0.02, -0.01, 0.03, 0.0, -0.02]), GRID[::3], 5
    ).amplitude("2.a"),
}


@pytest.mark.parametrize("pad", [along_a_line, as_a_face, without_normal_stiffness])
@pytest.mark.parametrize("name", ANALYSES)
def test_every_analysis_has_the_numbers_of_the_element(
    name: str, pad: Callable[[], Contact]
) -> None:
    expected = np.asarray(ANALYSES[name](jenkins()))
    assert np.isfinite(expected).all()
    assert np.abs(expected).max() > 0.0
    found = np.asarray(ANALYSES[name](pad()))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("pad", [along_a_line, as_a_face])
def test_its_errors_are_estimated_alike(pad: Callable[[], Contact]) -> None:
    expected = ss.forced_response(model(jenkins()), GRID, 7).error_estimate("a")
    found = ss.forced_response(model(pad()), GRID, 7).error_estimate("a")
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("pad", [along_a_line, as_a_face])
def test_the_method_of_a_single_harmonic_takes_it(pad: Callable[[], Contact]) -> None:
    expected = amplitudes(ss.single_harmonic(model(jenkins()), GRID))
    found = amplitudes(ss.single_harmonic(model(pad()), GRID))
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("dofs", [["a"], ["a", "b"]])
def test_a_contact_without_friction_is_none(dofs: list[str]) -> None:
    pad = ss.Coulomb(dofs, normal=None, **(LOAD | {"friction": 0.0}))
    bare = ss.forced_response(ss.Model(STRUCTURE, [], FORCES), GRID, 3)
    for evaluation in ("exact", "marched"):
        found = ss.forced_response(model(pad), GRID, 3, evaluation=evaluation)
        np.testing.assert_allclose(amplitudes(found), amplitudes(bare), rtol=1e-9)
        assert not found.dissipation(0).any()
    orbits = ss.exact_response(model(pad), GRID)
    np.testing.assert_allclose(amplitudes(orbits), amplitudes(bare), rtol=1e-9)

"""Error estimates and automatic harmonics on mixes of soft and stiff contacts, by exact orbits."""

import numpy as np
import pytest

import stickslip as ss


def mixed(seed: int) -> tuple[ss.Model, np.ndarray]:
    """A random chain or full system of 2 to 8 DOFs with contacts of 6e-6 to 1.5e3 its stiffness."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    if rng.random() < 0.5:
        k = 10 ** rng.uniform(3, 5, n + 1)
        stiffness = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
        mass = np.diag(10 ** rng.uniform(-0.5, 0.5, n))
    else:
        a = rng.normal(size=(n, n))
        stiffness = 1e4 * (a @ a.T / n + 0.05 * np.eye(n))
        a = rng.normal(size=(n, n))
        mass = a @ a.T / n + 0.5 * np.eye(n)
    ratio = float(rng.choice([0.0, 1e-5, 1e-4, 1e-3, 5e-3, 2e-2]))
    names = [f"x{i}" for i in range(n)]
    damping = ss.ModalDamping(ratio) if ratio else None
    structure = ss.Structure(mass=mass, stiffness=stiffness, damping=damping, dofs=names)
    count = int(rng.integers(1, min(3, n) + 1))
    base = float(np.mean(np.diag(stiffness)))
    contacts = []
    for i in rng.choice(n, count, replace=False):
        spring = base * 10 ** rng.uniform(np.log10(6e-6), np.log10(1.5e3))
        limit = 10 ** rng.uniform(-1.5, 1.0)
        other = None
        if rng.random() < 0.3 and n > 1:
            other = names[int(rng.choice([d for d in range(n) if d != i]))]
        dofs = (names[i],) if other is None else (names[i], other)
        contacts.append(ss.Jenkins(*dofs, stiffness=spring, slip_force=limit))
    model = ss.Model(structure, contacts, [ss.Force(names[int(rng.integers(n))], 1.0)])
    free = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
    ends = np.log(0.3 * free[0]), np.log(1.2 * free[-1])
    return model, np.sort(np.exp(rng.uniform(*ends, 10)))


# Of 160 systems these four have a degree of freedom whose error is above 5 estimates: contacts that
# stick in the truncated solution slip in the true one, which one Newton step does not foresee.
MISJUDGED = [
    pytest.param(seed, marks=pytest.mark.xfail(strict=True, reason="slip that no tangent foresees"))
    for seed in (22, 26, 40, 59)
]


@pytest.mark.parametrize("seed", [1, 2, 3, 5, *MISJUDGED])
def test_no_error_is_far_above_its_estimate(seed: int) -> None:
    model, omega = mixed(seed)
    exact = ss.exact_response(model, omega)
    for harmonics in (1, 3, 7, 15):
        frf = ss.forced_response(model, omega, harmonics)
        for dof in frf.dofs:
            error = np.abs(frf.amplitude(dof) - exact.amplitude(dof))
            rounding = 1e-5 * exact.amplitude(dof) + 1e-7 * max(map(exact_size(exact), frf.dofs))
            assert (error <= 5.0 * frf.error_estimate(dof) + rounding).all(), (harmonics, dof)


def exact_size(exact: ss.ExactResponse):
    return lambda dof: np.nanmax(exact.amplitude(dof))


@pytest.mark.parametrize("seed", [1, 2, 22, 59])
def test_automatic_harmonics_keep_the_tolerance(seed: int) -> None:
    model, omega = mixed(seed)
    exact = ss.exact_response(model, omega)
    frf = ss.forced_response(model, omega)
    for dof in frf.dofs:
        size = np.maximum(exact.amplitude(dof), 1e-3 * np.nanmax(frf.amplitude(dof)))
        error = np.abs(frf.amplitude(dof) - exact.amplitude(dof)) / size
        assert (error[frf.converged] < 3e-3).all(), dof


def test_modal_coordinates_are_observed_if_they_are_named() -> None:
    blade = ss.reference.turbine_blade()
    frf = ss.forced_response(blade, (1508.0, 1747.0))
    assert frf.dofs == ("damper", "tip")
    assert frf.omega.size < 400
    assert frf.harmonics.max() < 60
    named = ss.forced_response(blade, [1600.0], 3, observe=["mode-2"])
    assert named.dofs == ("mode-2",)

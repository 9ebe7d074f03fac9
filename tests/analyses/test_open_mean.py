"""Bodies that contacts alone hold: where these slip and open, nothing holds the mean."""

import numpy as np
import pytest

import stickslip as ss

PLATES = 100


def on_the_floor(ground: float) -> ss.Model:
    """Plates linked in a row that stand on the floor; `ground` holds each of them, too [N/m]."""
    link = 2.0 * np.eye(PLATES) - np.eye(PLATES, k=1) - np.eye(PLATES, k=-1)
    link[0, 0] = link[-1, -1] = 1.0
    names = [f"{way}{plate}" for way in "xz" for plate in range(PLATES)]
    structure = ss.Structure(
        mass=np.eye(2 * PLATES),
        stiffness=np.kron(np.eye(2), 1e7 * link + ground * np.eye(PLATES)),
        damping=ss.Rayleigh(mass=20.0, stiffness=0.0),
        dofs=names,
    )
    floor = ss.Coulomb(
        [[f"x{plate}", f"z{plate}"] for plate in range(PLATES)],
        normal=[0.0, -1.0],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=2e4,
        preload=10.0,
    )
    shaken = [ss.Force(f"x{plate}", 10.0) for plate in range(PLATES)]
    lifted = [ss.Force(f"z{plate}", 3.0, phase=-0.5) for plate in range(PLATES)]
    return ss.Model(structure, [floor], [*shaken, *lifted])


@pytest.mark.parametrize(("ground", "status"), [(0.0, "free"), (2e3, "converged")])
def test_what_nothing_holds_is_said_at_once(ground: float, status: str) -> None:
    frf = ss.forced_response(
        on_the_floor(ground),
        [110.0],
        harmonics=3,
        evaluation="marched",
        samples=64,
        stability=False,
        observe=["x0"],
    )
    assert frf.status == (status,)
    # It took thousands of evaluations, and the name was wrong.
    assert frf.counters["evaluations"] < 100
    assert np.isnan(frf.amplitude("x0")[0]) == (status == "free")


@pytest.mark.parametrize(("ground", "status"), [(0.0, "free"), (50.0, "converged")])
def test_orbits_name_a_body_that_may_stand_anywhere(ground: float, status: str) -> None:
    structure = ss.Structure(
        mass=np.diag([1.0, 1.0]),
        stiffness=np.diag([1e4, ground]),
        damping=np.diag([10.0, 10.0]),
        dofs=["x", "z"],
    )
    floor = ss.Coulomb(
        ["x", "z"],
        normal=[0.0, -1.0],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=2e4,
        gap=0.01,
    )
    model = ss.Model(structure, [floor], [ss.Force("x", 5.0), ss.Force("z", 10.0)])
    orbit = ss.exact_response(model, [90.0])
    assert orbit.status == (status,)
    assert orbit.status[0].advice.count("ground the body") == (status == "free")


@pytest.mark.parametrize("harmonics", [1, 9])
def test_a_mean_that_only_rounding_moves_is_free(harmonics: int) -> None:
    """The contact is open throughout, and the structure turns without stiffness."""
    row = np.array([134.07950, -3.57433])
    structure = ss.Structure(
        mass=np.diag([0.84659, 1.7232]),
        stiffness=np.outer(row, row),
        damping=np.diag([2.0, 0.5]),
        dofs=["x", "z"],
    )
    floor = ss.Coulomb(
        ["x", {"x": 0.013033, "z": -0.029218}],
        normal=[0.0, 1.0],
        friction=0.308959,
        tangential_stiffness=9973.29,
        normal_stiffness=35659.6,
        gap=-3.30823e-3,
    )
    loads = [ss.Force("x", 189.28, phase=1.30157), ss.Force("z", -65.44869, phase=-2.12742)]
    frf = ss.forced_response(ss.Model(structure, [floor], loads), [115.6996], harmonics)
    assert frf.status[0] in ("free", "converged")
    if frf.status[0] == "converged":
        assert [one.code for one in frf.diagnostics].count("free-flight") == 1


def test_a_body_that_a_static_load_drives_away_is_free() -> None:
    """One contact with preload holds a structure of six degrees of freedom; it stalled before."""
    modes = np.array(
        [
            [1.5, 5.93, 69.83, 3.38, -2.32, 31.62],
            [-87.02, -23.59, 5.73, -61.28, 9.85, 3.18],
            [28.36, -128.66, 92.06, -2.21, -65.1, -185.12],
            [-32.68, -12.21, 39.12, 94.25, 269.27, -72.87],
            [-179.71, -50.04, -21.29, 257.48, -103.03, 29.82],
        ]
    )
    damping = np.array(
        [
            [3.23, 0.47, 0.21, -1.49, 0.19, -0.42],
            [0.47, 1.42, -0.52, -0.4, 0.56, 1.09],
            [0.21, -0.52, 1.57, -0.08, 0.26, -0.72],
            [-1.49, -0.4, -0.08, 3.49, 0.01, 0.04],
            [0.19, 0.56, 0.26, 0.01, 5.09, -0.4],
            [-0.42, 1.09, -0.72, 0.04, -0.4, 2.31],
        ]
    )
    mass = np.diag([1.886, 1.037, 1.116, 0.803, 1.465, 0.773])
    names = ["q0", "q1", "q2", "q3", "q4", "q5"]
    structure = ss.Structure(mass, modes.T @ modes, damping, names)
    contact = ss.Coulomb(
        ["q2", "q3"],
        normal=[0, 1],
        friction=0.328,
        tangential_stiffness=4928.0,
        normal_stiffness=6715.0,
        preload=2.053,
    )
    loads = [
        ("q0", 1.88, 0.71, 1),
        ("q1", -3.8, -5.66, 1),
        ("q2", 2.67, -0.84, 1),
        ("q3", 4.4, 1.85, 1),
        ("q5", 8.74, -3.3, 1),
        ("q1", 3.25, 0.0, 0),
        ("q2", 5.12, 0.0, 0),
        ("q3", 1.39, 0.0, 0),
    ]
    forces = [
        ss.Force(dof, abs(complex(re, im)), phase=float(np.angle(complex(re, im))), harmonic=order)
        if order
        else ss.Force(dof, re, harmonic=0)
        for dof, re, im, order in loads
    ]
    frf = ss.forced_response(ss.Model(structure, [contact], forces), [92.72], harmonics=9)
    assert frf.status == ("free",)
    assert frf.counters["evaluations"] < 1000

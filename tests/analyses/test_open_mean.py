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

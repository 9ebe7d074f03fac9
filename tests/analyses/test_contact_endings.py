"""How computations with friction contacts end where solutions are hard to find or not alone."""

import numpy as np
import pytest

import stickslip as ss


def nearly_locking_wedge() -> ss.Model:
    """Two blades and a wedge whose loads push it in until it sticks for good."""
    sine = 0.68724
    cosine = np.sqrt(1.0 - sine**2)
    names = ["x1", "y1", "x2", "y2", "xD", "yD"]
    stiffness = np.zeros((6, 6))
    stiffness[:2, :2] = [[1.55028e6, 1.73114e5], [1.73114e5, 8.69512e5]]
    stiffness[2:4, 2:4] = [[4.87512e5, 4.55003e5], [4.55003e5, 1.238814e6]]
    damping = 7.9364e-5 * stiffness + np.diag(np.repeat([20.0, 20.0, 0.0], 2))
    masses = np.diag(np.repeat([13.551, 11.285, 0.374], 2))
    faces = [
        ss.Coulomb(
            ["xD", "yD"],
            [f"x{blade}", f"y{blade}"],
            normal=[side * sine, cosine],
            friction=1.037,
            tangential_stiffness=5.4986e5,
            normal_stiffness=6.7686e5,
        )
        for blade, side in ((1, -1.0), (2, 1.0))
    ]
    forces = [
        ss.Force("x1", 136.74),
        ss.Force("x2", 136.74, phase=-2.1752),
        ss.Force("yD", 557.55, harmonic=0),
    ]
    return ss.Model(ss.Structure(masses, stiffness, damping, names), faces, forces)


@pytest.mark.slow
def test_a_motion_that_its_history_decides_is_called_so() -> None:
    model, omega = nearly_locking_wedge(), 194.0
    orbit = ss.exact_response(model, [omega])
    assert orbit.converged.all()
    # It sticks for good, with one of many tractions.
    assert not orbit.slip_fraction(0).any()
    assert not orbit.slip_fraction(1).any()
    assert np.count_nonzero(np.abs(orbit.multipliers[0] - 1.0) < 1e-9) == 2
    balance = ss.forced_response(model, [omega], 9)
    assert balance.status == ("history",)
    assert not balance.status[0].solved
    assert "exact_response" in balance.status[0].advice
    assert np.isnan(balance.amplitude("x1")).all()


@pytest.mark.parametrize("friction", [0.1, 0.0])
def test_orbits_of_bodies_that_static_loads_carry_away_are_free(friction: float) -> None:
    chain = np.array([[1.0, -1.0], [-1.0, 1.0]])
    structure = ss.Structure(np.diag([1.0, 2.0]), 2e4 * chain, 3.0 * chain, ["a", "b"])
    pad = ss.Coulomb(["a"], normal=None, friction=friction, tangential_stiffness=1e4, preload=10.0)
    model = ss.Model(structure, [pad], [ss.Force("b", 20.0), ss.Force("b", 3.0, harmonic=0)])
    assert ss.exact_response(model, [90.0]).status == ("free",)
    assert ss.forced_response(model, [90.0], 5).status == ("free",)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("share", "status"), [(0.95, "converged"), (1.1, "free")])
def test_a_body_on_one_node_slides_away_under_more_than_its_friction(
    seed: int, share: float, status: str
) -> None:
    random = np.random.default_rng(seed)
    root = np.sqrt(np.diag(random.uniform(0.5, 2.0, 3)))
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    shapes = root @ turn
    rates = np.array([0.0, *np.sort(random.uniform(100.0, 600.0, 2))])
    stiffness = shapes @ np.diag(rates**2) @ shapes.T
    stiffness = (stiffness + stiffness.T) / 2.0
    structure = ss.Structure(root**2, stiffness, 1e-4 * stiffness, ["a", "b", "c"])
    pad = ss.Coulomb(["c"], normal=None, friction=0.34, tangential_stiffness=1.6e5, preload=100.0)
    rigid = np.linalg.solve(root**2, shapes[:, 0])
    load = np.array([15.0, 28.0, 40.0])
    load *= share * 34.0 * rigid[2] / (load @ rigid)
    static = [ss.Force(dof, float(f), harmonic=0) for dof, f in zip("abc", load, strict=True)]
    assert ss.static_response(ss.Model(structure, [pad], static)).status == status
    if status == "free":
        model = ss.Model(structure, [pad], [*static, ss.Force("a", 60.0)])
        assert ss.exact_response(model, [350.0]).status == ("free",)
        assert ss.forced_response(model, [350.0], 5).status == ("free",)


def test_orbits_that_no_load_from_rest_leads_to_are_free() -> None:
    """Pressed far enough against a face by hand, bodies stick there; from rest they are lost."""
    chain = np.array([[1.0, -1.0], [-1.0, 1.0]])
    structure = ss.Structure(np.diag([1.0, 2.0]), 2e4 * chain, 3.0 * chain, ["a", "b"])
    # A load along the face that lifts it off: it would hold where the load presses.
    pad = ss.Coulomb(
        ["a", {"a": -1.0}],
        normal=[0.0, 1.0],
        friction=0.9,
        tangential_stiffness=2e4,
        normal_stiffness=9e3,
        preload=9.0,
    )
    forces = [ss.Force("b", 2.0), ss.Force("b", 60.0, harmonic=0)]
    model = ss.Model(structure, [pad], forces)
    assert ss.static_response(model).status == "free"
    assert ss.exact_response(model, [60.0]).status == ("free",)
    assert ss.forced_response(model, [60.0], 5).status == ("free",)


def bouncing() -> ss.Model:
    """Five degrees of freedom, of which one bounces against a stiff face once per period."""
    masses = np.array(
        [
            [0.60741, 0.00088, 0.00218, -0.00140, -0.00036],
            [0.00088, 1.9572, 0.01179, -0.01798, -0.00522],
            [0.00218, 0.01179, 0.81522, -0.00792, -0.00295],
            [-0.00140, -0.01798, -0.00792, 1.2781, 0.00186],
            [-0.00036, -0.00522, -0.00295, 0.00186, 1.6314],
        ]
    )
    stiffness = np.array(
        [
            [56433.0, 17193.0, 11599.0, -3920.0, -304.63],
            [17193.0, 16973.0, 3137.7, 5203.7, -1054.4],
            [11599.0, 3137.7, 10945.0, 904.36, -2812.6],
            [-3920.0, 5203.7, 904.36, 8612.2, 3322.6],
            [-304.63, -1054.4, -2812.6, 3322.6, 23217.0],
        ]
    )
    damping = np.array(
        [
            [9.1145, 2.6744, 1.8051, -0.61042, -0.047579],
            [2.6744, 3.7286, 0.49454, 0.79928, -0.16689],
            [1.8051, 0.49454, 2.1558, 0.13624, -0.43906],
            [-0.61042, 0.79928, 0.13624, 2.0505, 0.51777],
            [-0.047579, -0.16689, -0.43906, 0.51777, 4.5184],
        ]
    )
    face = ss.Coulomb(
        ["d2", "d1"],
        normal=[0, 1],
        friction=0.0,
        tangential_stiffness=2830.0,
        normal_stiffness=192911.0,
        gap=0.01129,
    )
    forces = [
        ss.Force("d0", -166.08, phase=1.6906),
        ss.Force("d1", 32.406, phase=1.9652),
        ss.Force("d2", 203.93, phase=2.6184),
        ss.Force("d4", 27.841, phase=0.67733),
    ]
    dofs = [f"d{i}" for i in range(5)]
    return ss.Model(ss.Structure(masses, stiffness, damping, dofs), [face], forces)


def test_few_harmonics_do_not_call_a_bouncing_motion_stable_that_is_not() -> None:
    model, omega = bouncing(), 87.4555
    orbit = ss.exact_response(model, [omega])
    assert orbit.stable[0] is False
    assert np.abs(orbit.multipliers[0]).max() == pytest.approx(1.0376, abs=2e-3)
    verdicts = [ss.forced_response(model, [omega], count).stable[0] for count in (5, 9, 15, 25)]
    assert True not in verdicts
    assert verdicts[-1] is False


def springs_that_lift_off() -> ss.Model:
    """Four degrees of freedom between faces without friction and a stop."""
    stiffness = np.array(
        [
            [29275.0, -3401.5, 5233.9, 4098.8],
            [-3401.5, 9870.5, -410.69, 402.73],
            [5233.9, -410.69, 11635.0, -1961.9],
            [4098.8, 402.73, -1961.9, 7725.5],
        ]
    )
    damping = np.array(
        [
            [7.82, -0.46108, 0.6933, 0.54026],
            [-0.46108, 3.9605, -0.057093, 0.048558],
            [0.6933, -0.057093, 5.9153, -0.24666],
            [0.54026, 0.048558, -0.24666, 4.3224],
        ]
    )
    masses = np.diag([1.0731, 0.72651, 1.1998, 0.90539])

    def face(v: dict[str, float], stiffness: float, **closure: float) -> ss.Coulomb:
        return ss.Coulomb(
            ["d0", v],
            normal=[0, 1],
            friction=0.0,
            tangential_stiffness=1e4,
            normal_stiffness=stiffness,
            **closure,
        )

    contacts = [
        face({"d1": -0.86762, "d2": -1.6923}, 5633.4, gap=-0.0013156),
        face({"d3": 1.0}, 59102.0, preload=5.548),
        face({"d0": 2.7537, "d2": -0.47039}, 9851.5, preload=45.126),
        ss.Stop("d1", stiffness=6439.9, gap=0.00043457),
    ]
    forces = [ss.Force("d2", -8.9971, phase=2.9878), ss.Force("d3", -35.956, phase=1.3529)]
    dofs = [f"d{i}" for i in range(4)]
    return ss.Model(ss.Structure(masses, stiffness, damping, dofs), contacts, forces)


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [5, 9, 15])
def test_a_motion_that_settles_is_found_where_nothing_else_leads(harmonics: int) -> None:
    # A stop has no events that an exact orbit could be followed by.
    model, omega = springs_that_lift_off(), 139.327
    found = ss.forced_response(model, [omega], harmonics)
    assert found.converged.all()
    settled = ss.transient(model, omega, 400, "rk4", steps=1024, keep=1, samples=256)
    for dof in found.dofs:
        assert found.amplitude(dof)[0] == pytest.approx(settled.amplitude(dof), rel=0.02)

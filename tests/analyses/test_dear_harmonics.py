"""More harmonics than a motion is found with: given up soon, with what fewer ones have found."""

import numpy as np
import pytest

import stickslip as ss

LIGHT = 1e-4
"""Mass of a wedge [kg] that resonates on its contacts near the 130th harmonic."""


@pytest.fixture(scope="module")
def disk():
    mesh_module = pytest.importorskip("skfem")
    grids = (np.linspace(0.0, 0.12, 13), np.linspace(0.0, 0.03, 4), np.linspace(0.0, 0.004, 2))
    solid = ss.Solid(
        mesh_module.MeshHex.init_tensor(*grids), young=210e9, poisson=0.3, density=7850.0
    )
    free = np.flatnonzero(np.repeat(solid.nodes[:, 0] > 1e-9, 3))
    boundary = {
        f"{name}.{axis + 1}": solid.dofs[3 * solid.nearest(at) + axis]
        for name, at in (
            ("a", (0.03, 0.0, 0.0)),
            ("b", (0.03, 0.03, 0.0)),
            ("tip", (0.12, 0.0, 0.004)),
        )
        for axis in range(3)
    }
    reduced = ss.craig_bampton(
        solid.mass[free][:, free],
        solid.stiffness[free][:, free],
        boundary,
        modes=8,
        dofs=[solid.dofs[place] for place in free],
    )
    wedge = ss.WedgeDamper(
        angle=45.0,
        mass=LIGHT,
        friction=0.3,
        tangential_stiffness=2e6,
        normal_stiffness=2e6,
        load=32.4,
    )
    return wedge.in_disk(
        reduced.structure(ss.ModalDamping(0.001)),
        40,
        left_dofs=["b.2", "b.3"],
        right_dofs=["a.2", "a.3"],
        engine_order=8,
        forces=[ss.Force("tip.3", 1.0)],
    )


def at(disk, hertz, harmonics, **keywords):
    omega = [2.0 * np.pi * hertz]
    return ss.forced_response(
        disk, omega, harmonics, observe=["tip.3"], stability=False, **keywords
    )


@pytest.mark.slow
def test_automatic_harmonics_keep_the_best_that_is_solved(disk):
    """The next level costs about as much as it takes to see that it fails."""
    found = at(disk, 240.2, "auto")
    assert found.status == ("effort limit",)
    assert found.harmonics[0] >= 83
    fixed = at(disk, 240.2, 95)
    assert fixed.status == ("converged",)
    error = abs(found.amplitude("tip.3") - fixed.amplitude("tip.3"))
    assert error < 2.0 * found.error_estimate("tip.3")
    assert found.counters["factorisations"] < 200


@pytest.mark.slow
def test_given_harmonics_are_given_up_soon(disk):
    """Homotopies and further starts had taken half a minute to the same end."""
    failed = at(disk, 239.0, 127)
    assert failed.status == ("stalled",)
    assert failed.counters["homotopies"] == 0
    assert failed.counters["factorisations"] < 400
    # From fewer harmonics, where these lead up to it.
    assert at(disk, 240.0, 127).status == ("converged",)


@pytest.mark.slow
def test_products_that_lead_nowhere_are_no_resonance():
    """Of 25 dampers the Jacobian of 95 harmonics is too large to be formed."""

    def number(i):
        return np.modf(np.modf(43758.5453 * np.sin(12.9898 * (i + 1)))[0] + 1.0)[0]

    springs = 10 ** (3.0 + 2.0 * number(np.arange(34)))
    stiffness = np.diag(springs[:-1] + springs[1:])
    stiffness -= np.diag(springs[1:-1], 1) + np.diag(springs[1:-1], -1)
    names = [f"x{i}" for i in range(33)]
    structure = ss.Structure(np.eye(33), stiffness, 0.5 * np.eye(33), names)
    dampers = [
        ss.Jenkins(
            names[i],
            stiffness=10 ** (3.0 + 2.5 * number(100 + i)),
            slip_force=10 ** (3.0 * number(200 + i) - 2.0),
        )
        for i in range(25)
    ]
    model = ss.Model(structure, dampers, [ss.Force("x16", 50.0)])
    found = ss.forced_response(model, [5.45], stability=False)
    assert found.status == ("effort limit",)
    (exact,) = ss.exact_response(model, [5.45]).amplitude("x16")
    assert abs(found.amplitude("x16")[0] - exact) < 1e-3 * exact

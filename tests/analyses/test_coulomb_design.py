"""Peaks along the parameters of Coulomb contacts, and their derivatives; disks with them."""

import numpy as np
import pytest

import stickslip as ss

VALUES = {"friction": 0.4, "tangential_stiffness": 5e4, "normal_stiffness": 8e4}


def mass_on_a_plane(force=30.0, **changes):
    dofs = ["x", "y", "z"]
    stiffness, damping = np.diag([4e4, 9e4, 1.6e5]), np.diag([8.0, 10.0, 16.0])
    pad = ss.Coulomb(dofs, normal=[0, 0, 1], **VALUES | {"preload": 40.0} | changes, name="pad")
    forces = [ss.Force("x", force), ss.Force("y", 25.0, phase=-1.5), ss.Force("z", 20.0)]
    return ss.Model(ss.Structure(np.eye(3), stiffness, damping, dofs), [pad], forces)


@pytest.mark.parametrize(
    ("parameter", "values"),
    [
        ("friction", [0.3, 0.5]),
        ("preload", [30.0, 60.0]),
        ("tangential_stiffness", [4e4]),
        ("normal_stiffness", [6e4]),
    ],
)
def test_damper_curves(parameter, values):
    options = {"harmonics": 3, "omega": (200.0, 290.0), "tolerance": 1e-5}
    curve = ss.damper_curve(mass_on_a_plane(), dof="x", **{parameter: values}, **options)
    assert curve.arrays.solved.all()
    assert curve.parameter == parameter
    for value, omega, amplitude in zip(values, curve.omega, curve.amplitude, strict=True):
        there = mass_on_a_plane(**{parameter: value})
        beside = omega * np.array([0.999, 1.0, 1.001])
        found = ss.forced_response(there, beside, 3, tolerance=1e-5)
        low, peak, high = found.amplitude("x")
        assert amplitude == pytest.approx(peak, rel=2e-5)
        assert omega < 201.0 or peak > max(low, high)


def test_the_best_preload_is_the_best_slip_force():
    structure = ss.Structure([[1.0]], [[4e4]], ss.ModalDamping(0.01), ["x"])
    values = {"friction": 0.25, "tangential_stiffness": 1e4, "preload": 40.0}
    options = {"dof": "x", "harmonics": 1}
    found = [
        ss.optimal_damper(
            ss.Model(structure, [pad], [ss.Force("x", 30.0)]),
            parameter=parameter,
            bounds=(factor * 2.0, factor * 200.0),
            **options,
        )
        for pad, parameter, factor in (
            (ss.Coulomb(["x"], normal=None, **values), "preload", 4.0),
            (ss.Jenkins("x", stiffness=1e4, slip_force=10.0), "slip_force", 1.0),
        )
    ]
    # The contact is sampled, the element is not; the minimum is flat.
    assert found[0].value == pytest.approx(4.0 * found[1].value, rel=1e-3)
    assert found[0].amplitude == pytest.approx(found[1].amplitude, rel=1e-5)


def test_bounds_are_needed():
    with pytest.raises(ss.ModelError, match="bounds: there is no default for the friction"):
        ss.optimal_damper(mass_on_a_plane(), dof="x", parameter="friction")


def face(**changes):
    """Two nodes of a body of four degrees of freedom, of which one may lift off."""
    dofs = ["1.x", "1.z", "2.x", "2.z"]
    random = np.random.default_rng(2).normal(size=(4, 4))
    structure = ss.Structure(
        np.eye(4), 1e4 * (random @ random.T + 3.0 * np.eye(4)), ss.Rayleigh(mass=5.0), dofs
    )
    values = {"friction": 0.5, "tangential_stiffness": 2e4, "normal_stiffness": 3e4}
    nodes = [dofs[:2], dofs[2:]]
    pad = ss.Coulomb(nodes, normal=[0, 1], **values | {"gap": 1e-5} | changes, name="face")
    forces = [
        ss.Force("1.x", 20.0),
        ss.Force("2.z", 15.0, phase=0.5),
        ss.Force("1.z", 10.0, harmonic=0),
    ]
    return ss.Model(structure, [pad], forces)


@pytest.mark.parametrize(
    ("parameter", "value", "step"),
    [
        ("friction", 0.5, 1e-3),
        ("gap", 1e-5, 1e-8),
        ("gap", 0.0, 1e-8),
        ("gap", -2e-5, 1e-8),
        ("tangential_stiffness", 2e4, 20.0),
        ("normal_stiffness", 3e4, 30.0),
    ],
)
def test_sensitivities_against_differences(parameter, value, step):
    def amplitude(*values):
        return ss.forced_response(face(**{parameter: [*values]}), [150.0], 5)

    result = amplitude(value, value)
    assert result.converged.all()
    whole = result.sensitivity("1.x", "face", parameter)[0]
    parts = [result.sensitivity("1.x", ("face", node), parameter)[0] for node in range(2)]
    assert sum(parts) == pytest.approx(whole, rel=1e-12)
    known = result.sensitivity("1.x")
    assert known[("face", 1), parameter][0] == parts[1]
    for node in range(2):
        sides = [
            amplitude(*(value + side * step * (node == other) for other in range(2)))
            for side in (1.0, -1.0)
        ]
        up, down = (one.amplitude("1.x")[0] for one in sides)
        slope = (up - down) / (2.0 * step)
        scale = max(map(abs, parts))
        assert parts[node] == pytest.approx(slope, abs=2e-3 * scale)


def sector(*contacts):
    dofs = ["x", "z"]
    blade = ss.Structure(np.eye(2), np.diag([4e4, 6e4]), ss.Rayleigh(mass=6.0), dofs)
    forces = [ss.Force("x", 20.0), ss.Force("z", 15.0, phase=0.4)]
    ring = [ss.Coupling("x", stiffness=2e3)]
    return ss.BladedDisk(blade, 5, ring, contacts, forces, engine_order=2)


SHROUD = {"friction": 0.4, "tangential_stiffness": 2e4, "normal_stiffness": 3e4, "preload": 12.0}


def test_tuned_disks_are_assemblies_of_equal_sectors():
    shroud = ss.Coulomb(["x", "z"], ["next.x", "next.z"], normal=[0.6, 0.8], **SHROUD)
    disk = sector(shroud)
    omega = [190.0, 260.0]
    wave = ss.forced_response(disk, omega, 5)
    every = ss.forced_response(disk.mistuned(0.0), omega, 5)
    assert wave.converged.all()
    assert every.converged.all()
    assert wave.slip_fraction(0).max() > 0.2
    assert wave.open_fraction(0).max() > 0.05
    for blade in (0, 3):
        own = every.coefficients(f"{blade}.x")
        turned = wave.sector(blade).coefficients("x")
        # 1024 samples are no multiple of 5 sectors.
        np.testing.assert_allclose(turned, own, atol=2e-4 * np.abs(own).max())
    np.testing.assert_allclose(
        every.contact_force("0.coulomb", 1, 60),
        wave.contact_force("coulomb", 1, 60),
        atol=2e-2 * wave.contact_force(0, 1, 60).max(),
    )


def test_constant_load_on_disks_is_a_jenkins_element():
    pads = (
        ss.Coulomb(
            ["x"], ["next.x"], normal=None, friction=0.5, tangential_stiffness=2e4, preload=10.0
        ),
        ss.Jenkins("x", "next.x", stiffness=2e4, slip_force=5.0),
    )
    marched = {"evaluation": "marched", "samples": 320}
    pattern = 0.03 * np.sin(np.arange(5))
    for of in (lambda disk: disk, lambda disk: disk.mistuned(pattern)):
        one, other = (ss.forced_response(of(sector(pad)), [205.0], 5, **marched) for pad in pads)
        dof = one.dofs[-2]
        np.testing.assert_allclose(one.amplitude(dof), other.amplitude(dof), rtol=1e-9)


def test_mistuning_studies_have_nodes():
    disk = sector(ss.Coulomb(["x", "z"], normal=[0, 1], **SHROUD))
    span, pattern = (195.0, 215.0), [[0.5, -1.0, 0.8, -0.2, 0.3]]
    study = ss.mistuning_study(disk, 0.02, patterns=pattern, omega=span, harmonics=1)
    tuned = ss.forced_response(disk, span, 1).peak("x").amplitude
    blades = ss.forced_response(disk.mistuned(0.02 * np.array(pattern[0])), span, 1)
    highest = max(blades.peak(f"{blade}.x").amplitude for blade in range(5))
    assert study.amplification("x").item() == pytest.approx(highest / tuned, rel=1e-6)


def test_nodal_diameters_slip_and_stick():
    disk = sector(ss.Coulomb(["x", "z"], ["next.x", "next.z"], normal=[0, 1], **SHROUD))
    found = disk.nodal_diameters()
    # A wave of nodal diameter 0 does not move one sector against the next.
    np.testing.assert_allclose(found.stuck[0], found.slipping[0])
    assert found.stuck[2, 0] > found.slipping[2, 0]


@pytest.mark.parametrize("closure", [{"preload": 40.0}, {"preload": None, "gap": 1e-4}])
def test_the_first_trace_of_a_tangential_spring_counts(closure):
    """Without one there is no traction, and the derivative is that of one side."""

    def response(stiffness):
        model = mass_on_a_plane(tangential_stiffness=stiffness, **closure)
        return ss.forced_response(model, [190.0, 250.0], 5)

    without, little = response(0.0), 1e-2
    slope = without.sensitivity("x", "pad", "tangential_stiffness")
    change = (response(little).amplitude("x") - without.amplitude("x")) / little
    np.testing.assert_allclose(slope, change, rtol=1e-4)

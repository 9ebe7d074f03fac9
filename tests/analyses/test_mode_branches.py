"""Branches of nonlinear modes: corners, turns, many contacts, and where they end."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from joints import JENKINS, bar, chain, describing, jointed, one_mass, wedge


def test_random_joints_are_solved_or_say_why_not():
    rng = np.random.default_rng(7)
    for _ in range(12):
        size = int(rng.integers(2, 5))
        root = rng.normal(size=(size, size))
        stiffness = 1e4 * (root @ root.T + np.eye(size))
        dofs = [f"d{i}" for i in range(size)]
        structure = ss.Structure(
            mass=np.diag(rng.uniform(0.5, 2.0, size)),
            stiffness=stiffness,
            damping=ss.ModalDamping(0.002),
            dofs=dofs,
        )
        kinds = [
            ss.Jenkins("d0", stiffness=5e3, slip_force=1.0, name="a"),
            ss.Cubic("d1", stiffness=1e8, name="b"),
            ss.Stop("d1", stiffness=5e3, gap=2e-4, name="c"),
            ss.Coulomb(
                ["d0", "d1"],
                normal=[0.0, 1.0],
                friction=0.3,
                tangential_stiffness=4e3,
                normal_stiffness=6e3,
                preload=2.0,
                name="d",
            ),
        ]
        chosen = rng.choice(len(kinds), size=int(rng.integers(1, 4)), replace=False)
        model = ss.Model(structure, contacts=[kinds[i] for i in chosen])
        mode = ss.nonlinear_modes(
            model, mode=int(rng.integers(size)), amplitude=np.geomspace(1e-5, 1e-2, 7), harmonics=5
        )
        codes = {one.code for one in mode.diagnostics}
        solved = np.array([status.solved for status in mode.status])
        assert solved.all() or "mode-not-reached" in codes
        assert np.isfinite(mode.omega[solved]).all()
        assert (mode.friction_ratio[solved] > -1e-6).all()
        assert (mode.arrays.residual[solved] < 1e-6).all()


@pytest.mark.slow
def test_corners_of_random_joints_are_passed():
    for seed in range(40):
        model, mode = jointed(np.random.default_rng([11, seed]))
        amplitudes = np.geomspace(1e-6, 1e-2, 9)
        branch = ss.nonlinear_modes(model, mode=mode, amplitude=amplitudes, harmonics=5)
        assert "mode-not-reached" not in {one.code for one in branch.diagnostics}, seed
        assert all(status.solved for status in branch.status), seed
        assert branch.amplitude == pytest.approx(amplitudes, rel=1e-12)
        assert branch.arrays.residual.max() < 1e-6


@pytest.mark.slow
def test_a_branch_that_ends_says_why():
    model, mode = jointed(np.random.default_rng([11, 48]))
    amplitudes = np.geomspace(1e-6, 1e-2, 9)
    branch = ss.nonlinear_modes(model, mode=mode, amplitude=amplitudes, harmonics=5)
    told = {one.code: str(one) for one in branch.diagnostics}
    assert "turned back" in told["mode-not-reached"]
    solved = np.array([status.solved for status in branch.status])
    assert np.isnan(branch.omega[~solved]).all()
    whole = ss.nonlinear_modes(model, mode=mode, amplitude=(1e-6, 1e-2), harmonics=5)
    told = {one.code: str(one) for one in whole.diagnostics}
    assert "turned back" in told["mode-not-reached"]
    assert "harmonic 2 meets" in told["internal-resonance"]
    # A damper body that rattles: its contacts change what they do within every short step.
    rattling = ss.nonlinear_modes(
        wedge(), mode=4, amplitude=(1e-6, 1e-1), harmonics=5, residual="centred"
    )
    told = {one.code: str(one) for one in rattling.diagnostics}
    assert "steps became too short" in told["mode-not-reached"]
    # A force that hardly drives this mode moves others more.
    light = chain(ss.Force("z", 1.0))
    weak = ss.Structure(np.eye(2), np.diag([1e4, 1.001e4]), ss.ModalDamping(0.01), ["x", "y"])
    driven = [ss.Force("x", 1.0), ss.Force("y", 1e-3)]
    lost = ss.nonlinear_modes(
        ss.Model(weak, light.contacts[:0], driven),
        mode=1,
        amplitude=[1e-3],
        method="phase-resonance",
    )
    assert "No motion near the linear mode" in str(lost.diagnostics)


def test_an_internal_resonance_between_the_amplitudes_is_named():
    for seed in (29, 53, 146):
        model, mode = jointed(np.random.default_rng([11, seed]))
        keys = {"mode": mode, "harmonics": 5}
        branch = ss.nonlinear_modes(model, amplitude=np.geomspace(1e-6, 1e-2, 5), **keys)
        (told,) = [one for one in branch.diagnostics if one.code == "internal-resonance"]
        assert not branch.arrays.resonance_order.any()
        whole = ss.nonlinear_modes(model, amplitude=(1e-6, 1e-2), **keys)
        strongest = np.nanargmax(whole.arrays.resonance_share)
        assert whole.arrays.resonance_order[strongest] == told.data["order"]
        assert whole.amplitude[strongest] == pytest.approx(told.data["amplitude"], rel=0.2)
        assert whole.arrays.resonance_share[strongest] > 0.9 * told.data["share"]
    quiet = ss.nonlinear_modes(one_mass(JENKINS), amplitude=[1e-4, 1e-2])
    assert "internal-resonance" not in {one.code for one in quiet.diagnostics}


def test_a_joint_of_many_contacts_loses_what_they_do():
    # 122 elements in 8 orders: too many slip loads to be solved for directly.
    amplitudes = np.geomspace(1e-5, 1.0, 20)
    mode = ss.nonlinear_modes(bar(122), amplitude=amplitudes, harmonics=7)
    assert all(status.solved for status in mode.status)
    assert mode.counters["products"] > 0
    assert mode.counters["evaluations"] < 20 * 20
    mass = np.diag(mode.model.structure.mass)
    orders = np.arange(mode.arrays.displacement.shape[1]) ** 2
    kinetic = np.einsum("k,nki,i->n", orders, np.abs(mode.arrays.displacement) ** 2, mass)
    work = sum(mode.dissipation((contact, 0)) for contact in range(122))
    friction = work / (2.0 * np.pi * mode.omega**2 * kinetic)
    assert friction == pytest.approx(mode.friction_ratio, rel=1e-6, abs=1e-9)


def test_a_body_that_only_contacts_hold_has_a_mode():
    # Along the plane nothing but friction holds the block: its mean place is where it was.
    structure = ss.Structure(
        np.eye(3), np.diag([0.0, 1e4, 4e4]), np.diag([0.0, 1.0, 2.0]), ["x", "y", "z"]
    )
    pad = ss.Coulomb(
        ["x", "z"],
        normal=[0.0, 1.0],
        friction=0.4,
        tangential_stiffness=5e4,
        normal_stiffness=8e4,
        preload=20.0,
    )
    amplitudes = np.array([1e-5, 1.6e-4, 2e-4, 5e-4, 1e-3])
    mode = ss.nonlinear_modes(ss.Model(structure, [pad]), mode=1, amplitude=amplitudes, harmonics=1)
    assert all(status.solved for status in mode.status)
    # The normal force does not vary in this motion.
    stiffness = np.array([describing(one, 5e4, 8.0) for one in amplitudes])
    assert mode.omega == pytest.approx(np.sqrt(stiffness.real), rel=1e-9)
    ratio = stiffness.imag / (2.0 * stiffness.real)
    assert mode.damping_ratio == pytest.approx(ratio, rel=1e-8, abs=1e-12)


@pytest.mark.parametrize("diameter", [8, 15])
def test_automatic_harmonics_pass_the_windings_of_a_branch(diameter):
    # Where more harmonics were taken in the middle of a winding, the branch turned back or ended.
    beam = ss.reference.snecma_beam().structure
    disk = ss.BladedDisk(
        ss.Structure(beam.mass, beam.stiffness, ss.Rayleigh(mass=0.5), beam.dofs),
        36,
        [ss.Coupling(beam.dofs[1], stiffness=1e4)],
        [ss.Jenkins(beam.dofs[0], stiffness=2.4e7, slip_force=246.0)],
        engine_order=1,
    )
    amplitudes = np.geomspace(3.5e-4, 7.3e-2, 41)
    mode = ss.nonlinear_modes(disk, nodal_diameter=diameter, amplitude=amplitudes)
    assert "mode-not-reached" not in {one.code for one in mode.diagnostics}
    assert np.isfinite(mode.omega).all()
    assert mode.arrays.residual.max() < 1e-6


@pytest.mark.parametrize("masses", [1, 2])
@pytest.mark.parametrize("damping", [-0.2, -1.0, -1.9, -2.0, -2.1])
def test_a_branch_passes_the_zeros_of_its_damping(masses, damping):
    """Friction takes what a negative damping feeds at two amplitudes: those of the limit cycles."""
    if masses == 1:
        own, fed = one_mass(JENKINS, damping=damping), np.array([[damping]])
    else:
        fed = damping * np.eye(2)
        stiffness = np.array([[2e4, -1e4], [-1e4, 2e4]])
        body = ss.Structure(np.eye(2), stiffness, fed, ["x", "y"])
        own = ss.Model(body, [JENKINS])
    span = (1e-5, 1.2e-2 * 2.0 / abs(damping))
    branch = ss.nonlinear_modes(own, amplitude=span)
    assert "mode-not-reached" not in {one.code for one in branch.diagnostics}
    assert branch.amplitude[[0, -1]] == pytest.approx(span, rel=1e-9)
    assert all(status == ss.Status.CONVERGED for status in branch.status)

    structure = own.structure
    bare = ss.Structure(structure.mass, structure.stiffness, 0.0 * fed, structure.dofs)
    cycles = ss.limit_cycles(
        ss.Model(bare, [JENKINS]), negative_damping=fed, ratio=[1.0], harmonics=31
    )
    known = np.sort(modal_amplitudes(cycles, structure))
    at = np.flatnonzero(np.diff(np.sign(branch.damping_ratio)))
    share = branch.damping_ratio[at] / (branch.damping_ratio[at] - branch.damping_ratio[at + 1])
    zeros = branch.amplitude[at] * (branch.amplitude[at + 1] / branch.amplitude[at]) ** share
    assert zeros == pytest.approx(known, rel=2e-3)

    # There the damping is zero, and known as well as anywhere.
    listed = ss.nonlinear_modes(own, amplitude=known)
    assert all(status == ss.Status.CONVERGED for status in listed.status)
    rest = abs(branch.linear_damping_ratio)
    np.testing.assert_allclose(listed.damping_ratio, 0.0, atol=1e-2 * rest)


def test_a_zero_of_damping_between_points_of_one_size_is_seen():
    """From -0.00226 to +0.00233 is a long way, though both are of one size."""
    three = chain()
    structure = ss.Structure(
        three.structure.mass,
        three.structure.stiffness,
        np.diag([2.0, -4.0, 1.0]),
        three.structure.dofs,
    )
    own = ss.Model(structure, three.contacts)
    branch = ss.nonlinear_modes(own, amplitude=(1e-5, 2e-2))
    (at,) = np.flatnonzero(np.diff(np.sign(branch.damping_ratio)))
    before, after = branch.damping_ratio[at : at + 2]
    share = before / (before - after)
    zero = branch.amplitude[at] * (branch.amplitude[at + 1] / branch.amplitude[at]) ** share
    listed = ss.nonlinear_modes(own, amplitude=[zero])
    rest = abs(branch.linear_damping_ratio)
    np.testing.assert_allclose(listed.damping_ratio, 0.0, atol=1e-2 * rest)


def test_a_branch_passes_dampers_that_begin_to_slip_one_after_the_other():
    """Each doubles the damping: it asks for some two hundred short steps."""
    number = np.arange(12)
    stiffness = 1e4 * 2.0**number / (2.0**number).sum()
    limits = 1e-4 * np.exp(0.02 * number) * stiffness
    pairs = zip(stiffness.tolist(), limits.tolist(), strict=True)
    dampers = [ss.Jenkins("x", stiffness=k, slip_force=limit) for k, limit in pairs]
    own = one_mass(*dampers, damping=0.0)
    branch = ss.nonlinear_modes(own, amplitude=(5e-5, 3e-3), harmonics=5)
    assert "mode-not-reached" not in {one.code for one in branch.diagnostics}
    listed = ss.nonlinear_modes(own, amplitude=[1.2e-4, 3e-4, 3e-3], harmonics=5)
    between = np.interp(np.log(listed.amplitude), np.log(branch.amplitude), branch.damping_ratio)
    # From point to point damping changes by no more than 4 %.
    np.testing.assert_allclose(between, listed.damping_ratio, rtol=0.02)


def modal_amplitudes(cycles, structure):
    """Return (X_1^H M X_1)^(1/2) of limit cycles."""
    first = np.array([cycles.coefficients(dof)[:, 1] for dof in structure.dofs])
    return np.sqrt(np.einsum("in,ij,jn->n", first.conj(), structure.mass, first).real)

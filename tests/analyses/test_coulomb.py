"""Responses with Coulomb contacts: printed cases, frames, nodes, and a constant load."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss

OMEGA = [180.0, 260.0, 340.0]
FINE = 1e-5
"""Tolerance, of which a quarter is for samples."""
PEAKS = np.array(
    [
        [1.79793e-3, 3.20807e-4, 9.63298e-5],
        [1.39417e-3, 8.77593e-4, 1.159755e-4],
        [4.46050e-4, 1.13998e-3, 1.606182e-4],
    ]
)
STIFFNESS = {"tangential_stiffness": 5e4, "normal_stiffness": 8e4}
LOADS = np.array([30.0, 25.0 * np.exp(-0.5j * np.pi), 20.0 * np.exp(-0.7j)])


def rotation(turn):
    """Rotate about x, then y, then z."""
    made = np.eye(3)
    for axis, angle in enumerate(turn):
        cos, sin = np.cos(angle), np.sin(angle)
        one = np.array([[cos, -sin], [sin, cos]])
        plane = np.eye(3)
        others = [k for k in range(3) if k != axis]
        plane[np.ix_(others, others)] = one
        made = plane @ made
    return made


def plane_mass(turn=(0.0, 0.0, 0.0), contacts=None):
    """One mass on a plane, in axes that are turned against those of the structure."""
    turned = rotation(turn)
    matrices = [turned @ np.diag(one) @ turned.T for one in ([4e4, 9e4, 1.6e5], [8.0, 10.0, 16.0])]
    dofs = ["x", "y", "z"]
    if contacts is None:
        normal = turned[:, 2]
        contacts = [ss.Coulomb(dofs, normal=normal, friction=0.4, preload=40.0, **STIFFNESS)]
    forces = [
        ss.Force(dof, abs(load), phase=np.angle(load))
        for dof, load in zip(dofs, turned @ LOADS, strict=True)
    ]
    return ss.Model(ss.Structure(np.eye(3), *matrices, dofs), contacts, forces)


@pytest.fixture(scope="module")
def response():
    return ss.forced_response(plane_mass(), OMEGA, 31, tolerance=FINE)


def test_mass_on_a_plane(response):
    assert response.converged.all()
    found = np.array([response.amplitude(dof, "max") for dof in "xyz"]).T
    np.testing.assert_allclose(found, PEAKS, rtol=3e-5)


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.7), (0.3, 0.0, 0.0), (1.2, -0.8, 2.0)])
@pytest.mark.slow
def test_frames_do_not_matter(response, turn):
    turned = ss.forced_response(plane_mass(turn), OMEGA, 31, tolerance=FINE)
    series = np.stack([turned.coefficients(dof) for dof in "xyz"], axis=-1) @ rotation(turn)
    expected = np.stack([response.coefficients(dof) for dof in "xyz"], axis=-1)
    np.testing.assert_allclose(series, expected, atol=1e-10 * np.abs(expected).max())
    force, straight = turned.contact_force(0, 1), response.contact_force(0, 1)
    inside = force @ turned.model.contacts[0].frame @ rotation(turn)
    np.testing.assert_allclose(inside, straight, atol=1e-8 * np.abs(straight).max())
    # Instants are located to the accuracy of the slip equation, which forces do not feel.
    np.testing.assert_allclose(
        turned.slip_fraction("coulomb"), response.slip_fraction("coulomb"), rtol=1e-6
    )


def test_forces_obey_the_cone_and_the_spring(response):
    for index in range(3):
        force = response.contact_force("coulomb", index, 1024)
        motion = response.contact_waveform("coulomb", index, 1024)
        assert force.shape == motion.shape == (1024, 3)
        traction = np.hypot(force[:, 0], force[:, 1])
        assert (traction <= 0.4 * force[:, 2] * (1.0 + 1e-12)).all()
        np.testing.assert_allclose(force[:, 2], 40.0 + 8e4 * motion[:, 2], rtol=1e-9)
        slips = (traction > 0.4 * force[:, 2] * (1.0 - 1e-9)).mean()
        assert slips == pytest.approx(response.slip_fraction("coulomb")[index, 0], abs=3e-3)


def test_power_goes_where_it_is_said(response):
    assert response.energy.imbalance == pytest.approx(0.0, abs=1e-3)
    motion, force = response.contact_waveform(0, 0, 4096), response.contact_force(0, 0, 4096)
    rate = 0.5 * (np.roll(motion, -1, 0) - np.roll(motion, 1, 0))
    work = float((rate * force).sum())
    assert response.dissipation(0).shape == (3, 1)
    assert response.dissipation(0)[0, 0] == pytest.approx(work, rel=1e-4)
    assert response.dissipation(("coulomb", 0))[0] == response.dissipation(0)[0, 0]


SEPARATION = [
    (40.0, 60.0, 5.0, (4.16212, 5.665875, -0.89573, 2.304388)),
    (40.0, 120.0, 3.0, (6.79384, 6.443992, -1.81509, 2.197012)),
    (80.0, 120.0, 8.0, (2.27893, 6.228533, -1.73474, 2.199940)),
]


@pytest.mark.parametrize(("across", "along", "omega", "expected"), SEPARATION)
def test_separation(across, along, omega, expected):
    damping = np.diag([0.346410162, 2.0])
    structure = ss.Structure(np.eye(2), np.diag([12.0, 21.0]), damping, ["t", "n"])
    values = {"friction": 0.85, "tangential_stiffness": 5.0, "normal_stiffness": 21.0}
    pad = ss.Coulomb(["t", "n"], normal=[0, 1], **values)
    forces = [ss.Force("n", 100.0, harmonic=0), ss.Force("t", across), ss.Force("n", along)]
    result = ss.forced_response(ss.Model(structure, [pad], forces), [omega], 61)
    assert result.converged.all()
    normal = result.waveform("n", 0, 8192)
    found = [result.amplitude("n", "max")[0], normal.min(), result.coefficients("n")[0, 0].real]
    np.testing.assert_allclose(found, expected[1:], rtol=1e-5)
    assert result.amplitude("t", "max")[0] == pytest.approx(expected[0], rel=3e-4)
    pressing = result.contact_force(0, 0, 8192)[:, 1]
    assert pressing.min() == 0.0
    assert (pressing == 0.0).mean() == pytest.approx(result.open_fraction(0)[0, 0], abs=2e-3)
    assert result.slip_fraction(0)[0, 0] + result.open_fraction(0)[0, 0] < 1.0


def two_bodies(contacts):
    dofs = [f"{body}.{axis}" for body in "ab" for axis in "xyz"]
    random = np.random.default_rng(7).normal(size=(6, 6))
    stiffness = 1e4 * (random @ random.T + 4.0 * np.eye(6))
    structure = ss.Structure(np.eye(6), stiffness, ss.Rayleigh(mass=4.0, stiffness=1e-5), dofs)
    forces = [ss.Force("a.x", 30.0), ss.Force("b.y", 20.0, phase=1.0), ss.Force("a.z", 10.0)]
    return ss.Model(structure, contacts, forces)


NODES = {
    "friction": [0.3, 0.5],
    "tangential_stiffness": [2e4, 5e4],
    "normal_stiffness": [3e4, 1e4],
    "preload": [10.0, 25.0],
    "normal": [[0.0, 0.0, 1.0], [1.0, 1.0, 0.0]],
}
FACES = [["a.x", "a.y", "a.z"]] * 2, [["b.x", "b.y", "b.z"]] * 2
FREQUENCIES = [150.0, 190.0]


@pytest.mark.slow
def test_one_contact_of_many_nodes_is_many_contacts_of_one():
    one = two_bodies([ss.Coulomb(*FACES, **NODES, name="face")])
    apart = [
        ss.Coulomb(FACES[0][n], FACES[1][n], **{key: of[n] for key, of in NODES.items()})
        for n in range(2)
    ]
    face, nodes = (ss.forced_response(m, FREQUENCIES, 7) for m in (one, two_bodies(apart)))
    assert face.converged.all()
    np.testing.assert_array_equal(face.coefficients("b.z"), nodes.coefficients("b.z"))
    force = face.contact_force("face", 1, 64)
    assert force.shape == (64, 2, 3)
    assert face.slip_fraction("face").shape == face.open_fraction("face").shape == (2, 2)
    assert face.slip_fraction("face").any(axis=0).all()
    # Not even open for -0 of the period.
    assert not np.signbit(face.open_fraction("face")).any()
    for node in range(2):
        alone = nodes.contact_force(node, 1, 64)
        np.testing.assert_array_equal(force[:, node], alone)
        np.testing.assert_array_equal(face.contact_force(("face", node), 1, 64), alone)
        for of in ("slip_fraction", "open_fraction", "dissipation"):
            whole, part = getattr(face, of)("face"), getattr(face, of)(("face", node))
            np.testing.assert_array_equal(whole[:, node], getattr(nodes, of)(node)[:, 0])
            np.testing.assert_array_equal(whole[:, node], part)
    assert face.contact_waveform("face", 0, 32).shape == (32, 2, 3)


def test_results_survive_storage(tmp_path):
    result = ss.forced_response(two_bodies([ss.Coulomb(*FACES, **NODES, name="face")]), [150.0], 5)
    result.save(tmp_path / "face.nc")
    again = ss.load(tmp_path / "face.nc")
    np.testing.assert_array_equal(again.contact_force("face", 0), result.contact_force("face", 0))
    np.testing.assert_array_equal(again.open_fraction("face"), result.open_fraction("face"))
    names = [f"face[{node}].{part}" for node in range(2) for part in ("t1", "t2", "N")]
    assert list(again.to_dataset()["point"].values) == names


@pytest.mark.parametrize("harmonics", [1, 9])
def test_constant_load_in_one_direction_is_a_jenkins_element(harmonics):
    structure = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 2e4]], ss.Rayleigh(mass=3.0), ["a", "b"]
    )
    values = {"friction": 0.25, "tangential_stiffness": 8e3, "preload": 40.0}
    pads = (
        ss.Jenkins("a", "b", stiffness=8e3, slip_force=10.0),
        ss.Coulomb(["a"], ["b"], normal=None, **values),
        ss.Coulomb([["a"]], [["b"]], normal=None, **values),
    )
    omega = np.linspace(90.0, 230.0, 15)
    jenkins, *others = (
        ss.forced_response(
            ss.Model(structure, [pad], [ss.Force("a", 30.0)]),
            omega,
            harmonics,
            evaluation="marched",
            samples=1024,
        )
        for pad in pads
    )
    for other, shape in zip(others, [(64, 1), (64, 1, 1)], strict=True):
        assert other.half_wave
        np.testing.assert_allclose(other.amplitude("a"), jenkins.amplitude("a"), rtol=1e-9)
        force = other.contact_force(0, 3, 64).ravel()
        np.testing.assert_allclose(force, jenkins.contact_force(0, 3, 64).ravel(), atol=1e-8)
        lost = jenkins.dissipation(0).ravel()
        np.testing.assert_allclose(other.dissipation(0).ravel(), lost, rtol=1e-8, atol=1e-12)
        # A step in which the contact lets go slips in part, that of the element as a whole.
        slips = jenkins.slip_fraction(0)[:, 0]
        np.testing.assert_allclose(other.slip_fraction(0)[:, 0], slips, atol=4 / 1024)
        assert other.contact_force(0, 3, 64).shape == shape
        assert not other.open_fraction(0).any()
    assert jenkins.slip_fraction(0).any()


def test_forces_are_in_equilibrium_with_the_motion():
    """What the contact and the structure do to the mass is what accelerates it."""
    turn = rotation((0.4, 0.3, 0.2))
    normal = turn[:, 2]
    pad = ss.Coulomb(["x", "y", "z"], normal=normal, friction=0.4, gap=-5e-4, **STIFFNESS)
    model = plane_mass((0.4, 0.3, 0.2), [pad])
    result = ss.forced_response(model, [180.0], 31)
    count = 256
    theta = 2.0 * np.pi * np.arange(count) / count
    structure, omega = model.structure, 180.0
    series = np.stack([result.coefficients(dof)[0] for dof in "xyz"], axis=1)
    order = np.arange(len(series))[:, None]
    phases = np.exp(1j * np.outer(theta, order.ravel()))
    place, speed, rate = (
        (phases @ (series * (1j * order * omega) ** power)).real for power in range(3)
    )
    driven = np.stack([abs(f.coefficient) * np.cos(theta + f.phase) for f in model.forces], axis=1)
    contact = rate @ structure.mass + speed @ structure.damping + place @ structure.stiffness
    found = result.resultant("coulomb", 0, count)
    assert found.shape == (count, 3)
    # The balance holds up to the harmonic 31; corners of the force lie beyond.
    np.testing.assert_allclose(found, contact - driven, atol=0.02 * np.abs(found).max())


def test_another_level_of_preload():
    model = plane_mass().scaled(slip_force=2.0)
    assert model.contacts[0].preload == 80.0
    gap = ss.Coulomb(["x", "y", "z"], normal=[0, 0, 1], friction=0.4, **STIFFNESS)
    assert plane_mass(contacts=[gap]).scaled(force=2.0).contacts[0].gap == 0.0
    with pytest.raises(ss.ModelError, match="a gap has no slip force to multiply"):
        plane_mass(contacts=[gap]).scaled(slip_force=2.0)


def test_unsolved_points_have_no_numbers():
    result = ss.forced_response(plane_mass(), [180.0], 31, max_iterations=1, evaluation="marched")
    assert not result.arrays.solved.any()
    assert np.isnan(result.contact_force(0, 0)).all()
    assert result.contact_force(0, 0, 16).shape == (16, 3)
    assert np.isnan(result.slip_fraction(0)).all()
    assert np.isnan(result.open_fraction(0)).all()


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_faces_obey_the_law(seed):
    """Whatever is solved keeps N >= 0 and the cone, dissipates, and closes its energy balance."""
    random = np.random.default_rng(seed)
    nodes = int(random.integers(1, 4))
    dofs = [[f"{node}.t", f"{node}.n"] for node in range(nodes)]
    names = [name for node in dofs for name in node]
    part = random.normal(size=(len(names), len(names)))
    stiffness = 1e4 * (part @ part.T / len(names) + np.eye(len(names)))
    structure = ss.Structure(
        np.eye(len(names)), stiffness, ss.Rayleigh(mass=10.0, stiffness=1e-4), names
    )
    closure = {"preload": random.uniform(0.0, 30.0, nodes)}
    if random.random() < 0.5:
        closure = {"gap": random.normal(0.0, 5e-4, nodes)}
    face = ss.Coulomb(
        dofs,
        normal=random.normal(size=2),
        friction=random.uniform(0.0, 1.2, nodes),
        tangential_stiffness=random.uniform(1e3, 3e4, nodes),
        normal_stiffness=random.uniform(1e3, 3e4, nodes),
        name="face",
        **closure,
    )
    forces = [ss.Force(name, random.normal(0.0, 20.0)) for name in names]
    forces.append(ss.Force(names[1], random.normal(0.0, 10.0), harmonic=0))
    model = ss.Model(structure, [face], forces)
    result = ss.forced_response(model, [random.uniform(50.0, 250.0)], 9, tolerance=1e-4)
    if not result.arrays.solved.all():
        return
    force = result.contact_force("face", 0, 512)
    traction, normal = np.abs(force[..., 0]), force[..., 1]
    assert (normal >= 0.0).all()
    assert (traction <= face.friction_limit(force) * (1.0 + 1e-9) + 1e-12).all()
    shares = result.slip_fraction("face") + result.open_fraction("face")
    assert (shares <= 1.0 + 1e-9).all()
    lost = result.dissipation("face")
    assert (lost >= -1e-9 * np.abs(lost).max()).all()
    assert abs(result.energy.imbalance[0]) < 2e-3

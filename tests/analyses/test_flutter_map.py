"""Travelling waves in a flow: given damping comes back, limit cycles, stability in the ring."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import eigh

import stickslip as ss
from stickslip.results.flutter_map import FATES, FlutterMap, _crossings


def one_dof(sectors, contact, coupling=4e3, damping=0.5, flow=0.0):
    law = ss.Rayleigh(mass=damping + flow)
    blade = ss.Structure([[0.1]], [[1.6e5]], law, ["tip"])
    return ss.BladedDisk(
        blade, sectors, [ss.Coupling("tip", stiffness=coupling)], [contact], engine_order=1
    )


GROUND = ss.Jenkins("tip", stiffness=2e4, slip_force=5.0)
RATIOS = [-0.002, -0.008, -0.004, -0.003, 0.003, 0.004]


def test_24_blades():
    # computed independently: frequencies [Hz] and damping ratios of a tuned cascade
    mass, omega = 0.1, 2.0 * np.pi * 200.0
    blade = ss.Structure([[mass]], [[mass * omega**2]], None, ["tip"])
    given = {0: -30 + 60j, 1: 25 + 18j, -1: -10 - 40j, 2: 4 - 6j, -2: -3 + 2j}
    disk = ss.BladedDisk(blade, 24, engine_order=1)
    waves = ss.aerodynamic_waves(disk, ss.InfluenceCoefficients(given, dof="tip"))
    known = {
        0: (200.00886657, -1.076442124e-4),
        6: (200.05636179, -3.132857982e-4),
        12: (200.02786748, -2.469015676e-4),
    }
    for diameter, (frequency, ratio) in known.items():
        root = waves.eigenvalue[diameter]
        assert root.imag / (2.0 * np.pi) == pytest.approx(frequency, abs=5e-9)
        assert -root.real / abs(root) == pytest.approx(ratio, abs=5e-14)


def rough_disk(rng, sectors):
    """A random disk with phases inside the sector: its contacts touch the next one."""
    size = int(rng.integers(1, 4))
    root = rng.normal(size=(size, size))
    dofs = [f"d{i}" for i in range(size)]
    mass = np.diag(rng.uniform(0.5, 2.0, size))
    blade = ss.Structure(mass, 1e4 * root @ root.T + 2e4 * np.eye(size), None, dofs)
    contact = ss.Jenkins(dofs[0], f"next.{dofs[-1]}", stiffness=5e3, slip_force=2.0)
    return ss.BladedDisk(
        blade, sectors, [ss.Coupling(dofs[0], stiffness=3e3)], [contact], engine_order=1
    )


@pytest.mark.parametrize("seed", range(6))
def test_damping_given_is_the_damping_of_the_linear_disk(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 12))
    disk, given = rough_disk(rng, n), rng.uniform(-0.02, 0.02, n)
    mode = int(rng.integers(len(disk.structure)))
    waves = ss.aerodynamic_waves(disk, ss.AerodynamicDamping(ratio=given), mode)
    np.testing.assert_allclose(waves.aerodynamic_ratio, given, rtol=1e-12)
    decrement = 2.0 * np.pi * given / np.sqrt(1.0 - given**2)
    signed = {d - n if 2 * d > n else d: float(x) for d, x in enumerate(decrement)}
    same = ss.aerodynamic_waves(disk, ss.AerodynamicDamping(decrement=signed), mode)
    np.testing.assert_allclose(same.aerodynamic_ratio, given, rtol=1e-12)
    forces = ss.ModalForces(-2j * given * waves.omega**2)
    again = ss.aerodynamic_waves(disk, forces, mode)
    np.testing.assert_allclose(again.aerodynamic_ratio, given, rtol=1e-12)
    # the whole first-order problem of the wave with the matrix that limit_cycles takes
    for d in range(n):
        mass, _, stiffness = disk.matrices.wave(disk.angle(d))
        (contact,) = disk.contacts
        own, following = disk.contact_rows(contact)
        row = own + np.exp(1j * disk.angle(d)) * following
        held = stiffness + contact.stiffness * row.conj().T @ row
        fed = waves.negative_damping(d)[d]
        size = len(mass)
        lower = -np.linalg.solve(mass, np.hstack([held, fed]))
        poles = np.linalg.eigvals(np.vstack([np.eye(size, 2 * size, size), lower]))
        root = poles[np.argmin(np.abs(np.abs(poles) - waves.omega[d]) - (poles.imag > 0))]
        assert -root.real / abs(root) == pytest.approx(given[d], rel=1e-8)


@pytest.mark.slow
def test_limit_cycles_of_the_dissertation():
    model, negative = ss.reference.flutter_mass()
    (mass,), omega = model.structure.mass[0], ss.natural_frequencies(model)[0]
    disk = ss.BladedDisk(model.structure, 2, contacts=model.contacts, engine_order=0)
    for ratio in (1.0, 3.0, 5.0):
        damping = ratio * negative[0, 0] / (2.0 * mass * omega)
        found = ss.flutter_map(disk, ss.AerodynamicDamping(ratio=[damping] * 2), harmonics=31)
        cycles = ss.limit_cycles(model, negative, ratio=[ratio], method="exact")
        first, last = found.cycles(0)
        sizes = [found.amplitude("mass", which)[0] for which in ("bounding", "leaving")]
        np.testing.assert_allclose(sizes, cycles.amplitude("mass"), rtol=1e-5)
        np.testing.assert_allclose([first.omega, last.omega], cycles.omega, rtol=1e-5)
        assert [first.stability, last.stability] == list(cycles.stability)
        assert found.fate(0) == "limit cycle, kick"
        assert max(first.error, last.error) < 1e-5


@pytest.mark.parametrize(("seed", "least"), [(1, 0.1), (4, 0.0), (33, 0.02)])
@pytest.mark.slow
def test_a_limit_cycle_knows_how_far_it_is_from_that_of_the_whole_equations(seed, least):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 9))
    disk = rough_disk(rng, n)
    flow = ss.AerodynamicDamping(ratio=rng.uniform(-0.01, 0.002, n) * rng.choice([0.1, 1, 3]))
    found, waves = ss.flutter_map(disk, flow, harmonics=9), ss.aerodynamic_waves(disk, flow)
    errors = []
    for wave in {one.diameter % n for one in found.cycles()}:
        negative = waves.negative_damping(wave)
        still = waves.disk_of(wave, ratio=0.0)
        cycles = ss.limit_cycles(still, negative, ratio=[1.0], harmonics=9, stability=False)
        errors += [one.error for one in found.cycles(wave)]
        for which in ("bounding", "leaving"):
            sizes = np.array([found.amplitude(dof, which)[wave] for dof in disk.structure.dofs])
            if np.isfinite(sizes).all():
                dof = disk.structure.dofs[sizes.argmax()]
                off = np.abs(sizes.max() / cycles.amplitude(dof) - 1.0).min()
                assert np.abs(np.array(errors) - off).min() < 1e-9
    assert len(errors) == len(found.cycles()) > 0
    assert least <= max(errors) < (0.01 if least == 0.0 else 0.3)
    codes = {one.code for one in found.diagnostics}
    assert ("cycles-differ" in codes) == (max(errors) > 0.01)
    without = ss.flutter_map(disk, flow, harmonics=9, direct=False)
    assert np.isnan([one.error for one in without.cycles()]).all()


def test_a_kick_destabilises_a_disk_that_is_stable_at_rest():
    # As the contact slips b moves more, where the flow acts, and a less, where the damping is.
    mass, stiffness = np.diag([1.0, 0.5]), np.array([[3e4, -1e4], [-1e4, 2e4]])
    squares, shapes = eigh(stiffness + np.diag([0.0, 3e4]), mass)
    second = mass @ shapes[:, 1]
    held = 1.05 * 600.0 / np.sqrt(squares[0]) * shapes[1, 1] ** 2  # the second mode stays at rest
    damping = np.diag([0.3, 0.0]) + held * np.outer(second, second)
    blade = ss.Structure(mass, stiffness, damping, ["a", "b"])
    contact = ss.Jenkins("b", stiffness=3e4, slip_force=5.0)
    disk = ss.BladedDisk(blade, 3, [], [contact], engine_order=1)
    flow = ss.InfluenceCoefficients({0: 600.0j}, dof="b")
    waves = ss.aerodynamic_waves(disk, flow)
    assert (waves.ratio > 0.0).all()
    found = ss.flutter_map(disk, flow, harmonics=9)
    assert [found.fate(d) for d in (0, 1, -1)] == ["kick"] * 3
    (cycle,) = found.cycles(0)
    assert cycle.stability == "unstable"
    assert np.isnan(found.amplitude("b")).all()
    fed = ss.Structure(mass, stiffness, damping + waves.negative_damping(0)[0], blade.dofs)
    a, b = (found.amplitude(dof, "leaving")[0] for dof in ("a", "b"))
    model = ss.Model(fed, [contact])
    fates = [ss.classify(model, {"a": x * a, "b": x * b}).motion for x in (0.95, 1.05)]
    assert fates == ["decaying", "unbounded"]


@pytest.mark.parametrize(("diameter", "state"), [(0, "unstable"), (2, "stable")])
@pytest.mark.slow
def test_multipliers_are_what_the_ring_does_in_time(diameter, state):
    # the same damping forwards and backwards, so that the flow is a damping matrix of the ring
    ratios = np.array([-0.003, -0.008, -0.004, -0.008])
    disk, n = one_dof(4, GROUND), 4
    flow = ss.AerodynamicDamping(ratio=ratios)
    found = ss.flutter_map(disk, flow, harmonics=31, multipliers=True)
    cycle = found.cycles(diameter)[0]
    assert cycle.stability == state
    modal = 2.0 * 0.1 * ratios * ss.aerodynamic_waves(disk, flow).omega
    turns = np.exp(2j * np.pi * np.outer(np.arange(n), np.arange(n)) / n)
    matrix = (turns @ np.diag(modal) @ turns.conj() / n).real
    model = ss.destabilised(disk.mistuned(0.0), matrix, 1.0)
    amplitude, rng = found.amplitude("tip")[diameter], np.random.default_rng(0)
    start = {
        f"{j}.tip": amplitude * turns[diameter, j].real * (1.0 + 1e-3 * rng.normal())
        for j in range(n)
    }
    run = ss.transient(model, cycle.omega, 160, start=start, keep=160, samples=16)
    motion = np.stack([run.displacement(dof) for dof in model.structure.dofs], axis=1)
    waves = np.abs(np.fft.fft(motion[:2560].reshape(160, 16, n), axis=2)).max(axis=1)
    others = np.delete(waves, diameter, axis=1).max(axis=1)
    # once the fastest of the disturbances is left, and before it is as large as the wave
    first, last = (20, 120) if state == "stable" else (50, 100)
    growth = (others[last] / others[first]) ** (1.0 / (last - first))
    assert growth == pytest.approx(cycle.multiplier, abs=4e-3)


@pytest.mark.slow
def test_waves_are_stable_in_the_ring_or_not():
    disk = one_dof(6, GROUND)
    flow = ss.AerodynamicDamping(ratio=RATIOS)
    found = ss.flutter_map(disk, flow, harmonics=15, multipliers=True)
    by_slope = ss.flutter_map(disk, flow, harmonics=15)
    assert found.least_stable == 1
    states = {(one.diameter, one.slope > 0.0): one for one in found.cycles()}
    assert states[1, True].stability == "stable"
    assert 0.0 < states[1, True].multiplier < 1.0
    # by itself stable, but the wave that is fed more grows on it
    assert states[0, True].stability == "unstable"
    assert [one.stability for one in by_slope.cycles(0)] == ["stable", "unstable"]
    assert all(one.stability == "unstable" for (_, up), one in states.items() if not up)


def test_limits_over_aerodynamic_damping():
    disk = one_dof(4, GROUND, damping=0.0)
    found = ss.flutter_map(disk, ss.AerodynamicDamping(ratio=[-0.01] * 4), points=81, harmonics=5)
    held = found.held_ratio
    grid = found.limit_amplitude("tip", [-0.01, 2.0 * held.min()])
    assert grid.shape == (4, 2, 2)
    np.testing.assert_allclose(grid[:, 0, 0], found.amplitude("tip"), rtol=0.02)
    np.testing.assert_allclose(grid[:, 0, 1], found.amplitude("tip", "leaving"), rtol=0.02)
    assert np.isnan(grid[:, 1]).all()


@pytest.mark.slow
def test_files_and_figures(tmp_path):
    disk = one_dof(6, GROUND)
    found = ss.flutter_map(disk, ss.AerodynamicDamping(ratio=RATIOS), harmonics=3)
    found.save(tmp_path / "map.nc")
    again = ss.load(tmp_path / "map.nc")
    assert repr(again.cycles()) == repr(found.cycles())
    ax = found.plot("tip", length_unit="um")
    assert {line.get_label() for line in ax.lines} >= {"stable", "unstable"}
    found.plot_limits("tip")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.AerodynamicDamping(), "exactly one"),
        (lambda: ss.AerodynamicDamping(ratio=[1.5]), "between -1 and 1"),
        (lambda: ss.AerodynamicDamping(ratio=[np.nan]), "finite"),
        (lambda: ss.AerodynamicDamping(ratio=0.1), "per nodal diameter"),
        (lambda: ss.AerodynamicDamping(ratio={"a": 0.1}), "no whole number"),
        (lambda: ss.AerodynamicDamping(ratio=[1j]), "real"),
        (lambda: ss.AerodynamicDamping(ratio={-1: 10**400}), "give a finite real number"),
        (lambda: ss.ModalForces([10**400]), "give a finite real or complex number"),
        (lambda: ss.ModalForces([[1.0]], speeds=[10**400]), "give numbers of shape"),
        (lambda: ss.ModalForces([]), "none"),
        (lambda: ss.ModalForces([[1.0, 2.0]], speeds=[1.0, 2.0]), "row"),
        (lambda: ss.ModalForces([[1.0], [2.0]], speeds=[2.0, 1.0]), "sort them"),
        (lambda: ss.ModalForces([[1.0], [2.0]], speeds=[1.0, 2.0]).at_speed(3.0), "outside"),
        (
            lambda: ss.flutter_map(one_dof(4, GROUND), ss.AerodynamicDamping(ratio=[0.1] * 3)),
            "none at nodal diameter 3",
        ),
        (
            lambda: ss.flutter_map(
                one_dof(4, GROUND), ss.AerodynamicDamping(ratio={-1: 0.1, 3: 0.2})
            ),
            "given twice",
        ),
        (lambda: ss.flutter_map(one_dof(4, GROUND), [0.1] * 4), "AerodynamicDamping"),
        (
            lambda: ss.flutter_map(
                one_dof(4, ss.Cubic("tip", stiffness=1e9)),
                ss.AerodynamicDamping(ratio=[0.1] * 4),
            ),
            "give amplitude",
        ),
    ],
)
def test_nonsense_is_refused(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call()


def test_speeds_are_interpolated():
    forces = ss.ModalForces([[1.0, 2j], [3.0, 4j]], speeds=[100.0, 200.0])
    waves = ss.aerodynamic_waves(one_dof(2, GROUND), forces.at_speed(150.0))
    np.testing.assert_allclose(waves.forces.coefficients, [2.0, 3j])


def test_waves_of_opposite_sense_share_a_mode_where_they_meet_the_same_sector():
    disk = one_dof(5, GROUND)
    given = ss.AerodynamicDamping(ratio=[-0.004, -0.003, -0.002, -0.001, -0.005])
    found = ss.flutter_map(disk, given, harmonics=5, direct=False)
    keys = {"amplitude": found.modal_amplitude, "harmonics": 5}
    modes = [ss.nonlinear_modes(disk, nodal_diameter=d, **keys) for d in range(5)]
    for d, mode in enumerate(modes):
        shape = mode.displacement_amplitude("tip")
        np.testing.assert_allclose(found.arrays.displacement[d, :, 0], shape, rtol=1e-9)
    # Nothing is unstable, so that no cycle asks for more amplitudes than these two.
    calm, keys = ss.AerodynamicDamping(ratio=[0.01] * 5), {"amplitude": [1e-4, 1e-3]}
    coupled = one_dof(5, ss.Jenkins("tip", "next.tip", stiffness=2e4, slip_force=5.0))
    for one, waves in ((disk, range(3)), (coupled, range(5))):
        whole = ss.flutter_map(one, calm, harmonics=5, **keys)
        each = [ss.nonlinear_modes(one, nodal_diameter=d, harmonics=5, **keys) for d in waves]
        assert not whole.cycles()
        assert whole.counters["evaluations"] == sum(mode.counters["evaluations"] for mode in each)


@pytest.mark.parametrize(
    ("total", "stable", "unstable"),
    [
        ([-1.0, 1.0, 1.0, -1.0], 1.5, 3.5),
        ([1.0, -1.0, 1.0, -1.0], 2.5, 3.5),  # what falls first is unstable below the stable one
        ([1.0, -1.0, 1.0, 1.0], 2.5, np.nan),
        ([1.0, 1.0, 1.0, -1.0], np.nan, 3.5),
    ],
)
def test_the_unstable_cycle_lies_beyond_the_stable_one(total, stable, unstable):
    found = _crossings(np.array(total), np.exp([1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_allclose(np.log(found), [stable, unstable])


@pytest.mark.parametrize(
    ("rest", "slopes", "fate"),
    [
        (1.0, [], "decays"),
        (-1.0, [], "grows"),
        (-1.0, [1.0], "limit cycle"),
        (-1.0, [1.0, -1.0], "limit cycle, kick"),
        (-1.0, [1.0, -1.0, 1.0], "limit cycle"),
        (1.0, [-1.0], "kick"),
        # small motions die out, so that not every amplitude comes to the cycle
        (1.0, [-1.0, 1.0], "decays, limit cycle"),
        (1.0, [-1.0, 1.0, -1.0], "decays, limit cycle, kick"),
    ],
)
def test_what_becomes_of_a_wave_follows_from_its_crossings(rest, slopes, fate):
    cycles = [SimpleNamespace(slope=slope) for slope in slopes]
    wave = SimpleNamespace(
        _place=lambda d: d, cycles=lambda place: cycles, rest_ratio=np.array([rest])
    )
    assert FlutterMap.fate(wave, 0) == fate
    assert fate in FATES


def test_what_friction_holds_of_a_wave_that_was_not_found_is_not_known():
    ratio = np.array([[0.01, 0.02], [np.nan, np.nan]])
    arrays = SimpleNamespace(participation=np.ones((2, 2)))
    found = FlutterMap.held_ratio.fget(SimpleNamespace(disk_ratio=ratio, arrays=arrays))
    np.testing.assert_array_equal(found, [-0.02, np.nan])

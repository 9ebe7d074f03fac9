"""Tuned bladed disks: one sector of a travelling wave against the whole assembly and the table."""

import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip.disk import BladedDisk, Interface
from stickslip.model import Model

# computed independently: tuned ring of 36, coupling 1e5 N/m, engine order 2; peak of the damper [m]
TUNED_PEAKS = {1: 8.0014e-5, 3: 8.3035e-5, 7: 8.6130e-5, 15: 8.3912e-5, 35: 8.4116e-5}


def shrouded(sectors=8, engine_order=3, **options):
    """Return a ring with dampers to ground, inside the sector, and between neighbours."""
    return BladedDisk(
        ss.reference.snecma_structure(),
        sectors,
        [ss.Coupling("tip", stiffness=1e5), ss.Coupling("mode", "tip", stiffness=2e3, damping=5.0)],
        [
            ss.Jenkins("damper", stiffness=2.4e7, slip_force=246.048),
            ss.Jenkins("damper", "mode", stiffness=1e5, slip_force=20.0),
            ss.Jenkins("tip", "next.tip", stiffness=2e5, slip_force=8.0, name="shroud"),
        ],
        [ss.Force("tip", 20.313, 0.4), ss.Force("mode", 3.0, harmonic=3)],
        engine_order=engine_order,
        **options,
    )


def general_interface(sectors=7, seed=7):
    """Return a disk coupled by blocks of mass, damping and stiffness that are not symmetric."""
    size, rng = 4, np.random.default_rng(seed)
    part = rng.standard_normal((size, size))
    mass = np.eye(size) + 0.1 * part @ part.T
    stiffness = 4e4 * (np.diag([3.0, 4.0, 5.0, 6.0]) + 0.1 * (part + part.T))
    blocks = [rng.standard_normal((size, size)) for _ in range(3)]
    return BladedDisk(
        ss.Structure(mass, stiffness, ss.Rayleigh(mass=2.0, stiffness=1e-5), ["a", "b", "c", "d"]),
        sectors,
        contacts=[
            ss.Jenkins("a", stiffness=5e4, slip_force=2.0),
            ss.Jenkins("b", "next.c", stiffness=3e4, slip_force=1.0),
        ],
        forces=[ss.Force("d", 4.0), ss.Force("b", 1.0, 0.3, harmonic=2)],
        engine_order=int(rng.integers(1, 12)),
        interface=Interface(2e3 * blocks[0], 0.02 * blocks[1], 0.1 * blocks[2]),
    )


def assert_sectors_move_as_the_assembly(disk, omega, harmonics):
    one = ss.forced_response(disk, omega, harmonics)
    whole = ss.forced_response(disk.mistuned(0), omega, harmonics)
    assert one.converged.all()
    assert whole.converged.all()
    size = np.abs(one.arrays.displacement).max()
    force = np.abs(one.arrays.contact_force).max()
    for number in range(disk.sectors):
        sector = one.sector(number)
        for dof in disk.structure.dofs:
            gap = sector.coefficients(dof) - whole.coefficients(f"{number}.{dof}")
            assert np.abs(gap).max() < 1e-9 * size
        for place, name in enumerate(disk.contact_names):
            column = number * len(disk.contacts) + place
            gap = (
                sector.arrays.contact_force[:, :, place] - whole.arrays.contact_force[:, :, column]
            )
            assert np.abs(gap).max() < 1e-9 * force
            assert sector.slip_fraction(name) == pytest.approx(
                whole.slip_fraction(f"{number}.{name}"), abs=1e-8
            )
    return one


@pytest.mark.parametrize(("harmonics", "expected"), TUNED_PEAKS.items())
def test_the_tuned_ring_peaks_as_tabulated(harmonics, expected):
    ring = ss.reference.beam_ring()
    frf = ss.forced_response(ring, np.linspace(150.0, 270.0, 121), harmonics)
    assert frf.converged.all()
    assert frf.peak("damper").amplitude == pytest.approx(expected, rel=1e-4)
    assert np.abs(frf.energy.imbalance).max() < 1e-9


def test_automatic_harmonics_and_steps_meet_the_converged_peak():
    frf = ss.forced_response(ss.reference.beam_ring(), (180.0, 240.0), observe=["damper"])
    assert frf.peak("damper").amplitude == pytest.approx(8.4116e-5, rel=1e-3)


def test_the_ring_of_36_moves_as_its_assembly_20_degrees_per_blade():
    ring = ss.reference.beam_ring()
    one = assert_sectors_move_as_the_assembly(ring, [190.0, 205.0, 211.0, 240.0], 7)
    for number in (1, 5, 35):
        lead = one.sector(number).phase("tip") - one.phase("tip")
        assert np.exp(1j * lead) == pytest.approx(np.exp(1j * np.deg2rad(20.0 * number)), rel=1e-12)
    assert one.sector(0) is one


@pytest.mark.parametrize("engine_order", [0, 1, 3, 4, 11])
def test_friction_between_blades_moves_as_the_assembly(engine_order):
    omega = np.linspace(160.0, 640.0, 13)
    disk = shrouded(engine_order=engine_order).scaled(force=4.0)
    one = assert_sectors_move_as_the_assembly(disk, omega, 5)
    # In phase nothing moves between blades; elsewhere the shrouds slip.
    assert (one.slip_fraction("shroud").max() > 0.1) == (engine_order != 0)
    assert one.slip_fraction("jenkins").max() > 0.1
    assert np.abs(one.energy.imbalance).max() < 1e-9


@pytest.mark.parametrize(("sectors", "seed"), [(2, 1), (3, 2), (4, 3), (7, 4), (8, 5), (9, 6)])
def test_general_interface_blocks_move_as_the_assembly(sectors, seed):
    one = assert_sectors_move_as_the_assembly(
        general_interface(sectors, seed), np.linspace(120.0, 320.0, 9), 4
    )
    assert max(one.slip_fraction(contact).max() for contact in (0, 1)) > 0.1
    assert np.abs(one.energy.imbalance).max() < 1e-9


def test_static_loads_act_on_all_sectors_alike():
    disk = shrouded(engine_order=2)
    disk = disk.replaced(forces=[*disk.forces, ss.Force("tip", 5.0, harmonic=0)])
    assert_sectors_move_as_the_assembly(disk, [180.0, 230.0], 4)


def test_springs_and_interface_blocks_are_the_same():
    beam, k, c = ss.reference.snecma_structure(), 1e5, 12.0
    K1, C1 = np.zeros((2, 3, 3))
    K1[1, 1], C1[1, 1] = -k, -c
    K0, C0 = beam.stiffness - 2.0 * K1, beam.damping - 2.0 * C1
    springs = BladedDisk(beam, 9, [ss.Coupling("tip", stiffness=k, damping=c)], engine_order=2)
    blocks = BladedDisk(
        ss.Structure(beam.mass, K0, C0, beam.dofs),
        9,
        engine_order=2,
        interface=ss.Interface(K1, damping=C1),
    )
    for harmonic in range(4):
        for one, other in zip(
            springs.matrices_at(harmonic), blocks.matrices_at(harmonic), strict=True
        ):
            assert one == pytest.approx(other, rel=1e-14, abs=1e-9)
    assert springs.mistuned(0).structure.stiffness == pytest.approx(
        blocks.mistuned(0).structure.stiffness
    )


def test_a_sector_with_two_cuts_is_joined_to_the_next():
    # A chain of masses along the rim, cut in the middle of a mass: the rim has n times two.
    half, whole, k, n = 0.5, 1.0, 1e4, 6
    chain = ss.Structure(
        np.diag([half, whole, half]),
        k * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]]) + 100.0 * np.eye(3),
        ss.Rayleigh(mass=0.3, stiffness=1e-4),
        ["left", "middle", "right"],
    )
    sector, interface = ss.cyclic_sector(chain, {"right": "left"})
    assert sector.dofs == ("left", "middle")
    assert interface.stiffness == pytest.approx(np.array([[0.0, 0.0], [-k, 0.0]]))
    disk = BladedDisk(sector, n, engine_order=1, interface=interface)
    assembled = disk.mistuned(0).structure
    rim = np.zeros((2 * n, 2 * n))
    for place in range(2 * n):
        after = (place + 1) % (2 * n)
        rim[place, place] += k
        rim[after, after] += k
        rim[place, after] -= k
        rim[after, place] -= k
    rim += np.diag([200.0, 100.0] * n)
    assert assembled.stiffness == pytest.approx(rim)
    assert assembled.mass == pytest.approx(np.eye(2 * n))
    assert assembled.damping == pytest.approx(0.3 * np.eye(2 * n) + 1e-4 * rim)
    assert sector.damping_law == chain.damping_law


def test_digits_of_a_damping_matrix_are_no_skew_part():
    stiffness = [[1.2e5, -1e5, 0.0], [-1e5, 2e5, -1e5], [0.0, -1e5, 1.2e5]]
    damping = 1e-5 * np.array(stiffness)
    damping[0, 1] *= 1.0 + 1e-12

    def cut(matrix):
        whole = ss.Structure(np.diag([0.5, 1.0, 0.5]), stiffness, matrix, ["left", "mid", "right"])
        return ss.cyclic_sector(whole, {"right": "left"})

    sector, interface = cut(damping)
    np.testing.assert_array_equal(sector.damping, sector.damping.T)
    assert interface.damping == pytest.approx(1e-5 * interface.stiffness)
    damping[0, 1] *= 1.1
    with pytest.raises(ss.ModelError, match="its damping is not symmetric; give the blocks"):
        cut(damping)


def test_engine_orders_that_make_one_wave_are_computed_others_need_the_assembly():
    forces = [ss.Force("tip", 20.313), ss.Force("tip", 8.0, harmonic=3)]
    one_wave = shrouded(sectors=8, engine_order=3, engine_orders={3: 1}).replaced(forces=forces)
    assert_sectors_move_as_the_assembly(one_wave, [190.0, 220.0], 5)
    several = shrouded(sectors=8, engine_order=3, engine_orders={3: 2}).replaced(forces=forces)
    with pytest.raises(ss.ModelError, match=r"^force 2 at 'tip': harmonic 3 of engine order 2"):
        ss.forced_response(several, [190.0])
    assert ss.forced_response(several.mistuned(0), [190.0], 5).converged.all()
    assert ss.natural_frequencies(several, nodal_diameter=1) == pytest.approx(
        ss.natural_frequencies(one_wave, nodal_diameter=1)
    )


def test_natural_frequencies_are_those_of_the_assembly():
    for disk in (shrouded(), general_interface()):
        whole = disk.mistuned(0)
        for slips in (False, True):
            own = range(len(disk.contacts)) if slips else []
            every = range(len(whole.contacts)) if slips else []
            waves = [
                ss.natural_frequencies(disk, own, nodal_diameter=d) for d in range(disk.sectors)
            ]
            assert np.sort(np.concatenate(waves)) == pytest.approx(
                ss.natural_frequencies(whole, every), rel=1e-9
            )


def test_the_table_of_nodal_diameters_has_both_states():
    ring = ss.reference.beam_ring()
    table = ring.nodal_diameters()
    assert table.diameters.tolist() == list(range(19))
    assert table.stuck.shape == table.slipping.shape == (19, 3)
    # Without coupling motion the sectors are beams by themselves.
    assert table.stuck[0] == pytest.approx([225.6623, 1404.3759, 3273.7922], rel=1e-6)
    assert table.slipping[0] == pytest.approx([159.5927, 901.7589, 2167.5410], rel=1e-6)
    assert table.stuck[2] == pytest.approx(ss.natural_frequencies(ring))
    only = shrouded().nodal_diameters(["shroud"])
    assert only.slipping[3] == pytest.approx(
        ss.natural_frequencies(shrouded(), ["shroud"], nodal_diameter=3)
    )


def test_the_blisk_has_its_published_frequencies():
    blisk = ss.reference.laxalde_blisk()
    published = {
        0: [88.26374399, 249.31165161, 619.34330474],
        1: [169.3441295],
        2: [189.3018526],
        12: [195.67605066],
    }
    for diameter, expected in published.items():
        hertz = ss.natural_frequencies(blisk, nodal_diameter=diameter) / (2.0 * np.pi)
        digits = 8 if diameter in (0, 12) else 7
        for value, printed in zip(hertz, expected, strict=False):
            assert round(value, digits) == printed


def test_a_disk_is_a_model_of_its_sector_0():
    disk = shrouded()
    assert isinstance(disk, Model)
    assert disk.contact_names == ("jenkins", "jenkins-2", "shroud")
    assert "8 x Structure(3 dofs" in repr(disk)
    louder = disk.scaled(force=2.0, slip_force=0.5)
    assert isinstance(louder, BladedDisk)
    assert louder.forces[0].amplitude == pytest.approx(40.626)
    assert louder.contacts[2].parameters()["slip_force"] == 4.0
    again = pickle.loads(pickle.dumps(disk))
    assert (again.contacts, again.forces, again.couplings, again.engine_order) == (
        disk.contacts,
        disk.forces,
        disk.couplings,
        disk.engine_order,
    )


def test_a_sector_seen_from_elsewhere_is_solved_again_alike():
    frf = ss.forced_response(shrouded(), [200.0, 210.0, 220.0], 5)
    third = frf.sector(3)
    direct = ss.forced_response(third.model, [200.0, 210.0, 220.0], 5)
    size = np.abs(frf.arrays.displacement).max()
    assert np.abs(direct.arrays.displacement - third.arrays.displacement).max() < 1e-9 * size
    assert third.energy.work == pytest.approx(frf.energy.work, rel=1e-9)
    assert third.sector(5).coefficients("tip") == pytest.approx(frf.coefficients("tip"), rel=1e-12)
    assert any("nodal diameter k E modulo n" in text for text in frf.assumptions)


def test_the_wave_has_no_motion_of_its_own_in_time():
    ring = ss.reference.beam_ring(sectors=4)
    with pytest.raises(ss.ModelError, match=r"travelling wave.*disk\.mistuned\(0\)"):
        ss.transient(ring, 200.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    "contact",
    [
        ss.Jenkins("tip", "next.tip", stiffness=1e5, slip_force=5.0),
        ss.StructuralDamper(
            ["tip", "next.tip"], stiffness=[[1e5, -1e5], [-1e5, 1e5]], slip_forces=[5.0, 5.0]
        ),
    ],
    ids=["jenkins", "structural"],
)
def test_dampers_between_sectors_are_designed_as_those_of_all_sectors(contact, tmp_path):
    disk = BladedDisk(
        ss.reference.snecma_structure(),
        sectors=6,
        couplings=[ss.Coupling("tip", stiffness=1e4)],
        contacts=[contact],
        forces=[ss.Force("tip", 20.0)],
        engine_order=2,
    )
    options = {"harmonics": 3, "common": "factor"}
    tuned = ss.damper_curve(disk, stiffness=[0.5, 1.0, 2.0], dof="tip", **options)
    whole = ss.damper_curve(
        disk.mistuned(0.0),
        stiffness=[0.5, 1.0, 2.0],
        dof="0.tip",
        omega=tuned.settings.span,
        **options,
    )
    np.testing.assert_allclose(tuned.amplitude, whole.amplitude, rtol=1e-6)
    if contact.law == "jenkins":
        rigid = ss.damper_curve(disk, stiffness=[1e6, np.inf], dof="tip", harmonics=3)
        assert rigid.amplitude[1] < rigid.amplitude[0]
    for parameter in ("slip_force", "stiffness"):
        best = ss.optimal_damper(disk, parameter=parameter, dof="tip", **options)
        assert best.amplitude <= tuned.amplitude.min() * (1.0 + 1e-3)
        best.save(tmp_path / "best.nc")
        stored = ss.load(tmp_path / "best.nc")
        assert stored.minima == best.minima
        assert stored.curve.model.contacts == disk.contacts

"""Mistuned disks: assembly, names, amplification factors, blades side by side, files, figures."""

import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip import plot
from stickslip.disk import BladedDisk, MistunedDisk
from stickslip.model import Model

PATTERN = ss.mistuning_pattern(36, 0.07, "uniform", seed=0)
OMEGA = np.linspace(150.0, 260.0, 56)


def small(sectors=6, engine_order=1, **options):
    ring = ss.reference.beam_ring(sectors, 7e3, engine_order)
    shroud = ss.Jenkins("tip", "next.tip", stiffness=5e4, slip_force=5.0, name="shroud")
    return BladedDisk(
        ring.structure,
        sectors,
        ring.couplings,
        [*ring.contacts, shroud],
        ring.forces,
        engine_order=engine_order,
        **options,
    )


@pytest.fixture(scope="module")
def ring():
    return ss.reference.beam_ring(coupling=7e3, engine_order=3)


@pytest.fixture(scope="module")
def tuned(ring):
    return ss.forced_response(ring, OMEGA, 3)


@pytest.fixture(scope="module")
def mistuned(ring):
    observe = [f"{blade}.damper" for blade in range(36)]
    return ss.forced_response(ring.mistuned(PATTERN), OMEGA, 3, observe=observe)


def test_the_pattern_is_that_of_the_table():
    bound = np.sqrt(3.0)
    drawn = np.random.default_rng(0).uniform(-bound, bound, 36)
    assert pytest.approx(0.07 * drawn, rel=1e-15) == PATTERN
    normal = ss.mistuning_pattern(20000, 0.05, seed=3)
    assert normal.std() == pytest.approx(0.05, rel=0.02)
    assert np.array_equal(
        ss.mistuning_pattern(9, 0.1, seed=4), ss.mistuning_pattern(9, 0.1, seed=4)
    )


def test_sectors_names_and_phases():
    disk = small().mistuned(0.0)
    assert isinstance(disk, MistunedDisk)
    assert disk.structure.dofs[:4] == ("0.damper", "0.tip", "0.mode", "1.damper")
    assert disk.contact_names[:3] == ("0.jenkins", "0.shroud", "1.jenkins")
    assert disk.contacts[-1].dofs == ("5.tip", "0.tip")
    assert [force.dof for force in disk.forces] == [f"{blade}.tip" for blade in range(6)]
    phases = [force.phase for force in disk.forces]
    assert phases == pytest.approx(2.0 * np.pi * np.arange(6) / 6)


def test_each_sector_has_its_own_stiffness_mass_and_damping():
    disk, pattern = small(), 0.05 * np.arange(6)
    beam, assembled = disk.structure, disk.mistuned(pattern, mass=-pattern / 2)
    spring = np.diag([0.0, 7e3 * 2, 0.0])
    for blade, factor in enumerate(pattern):
        rows = slice(3 * blade, 3 * blade + 3)
        M, K = (1.0 - factor / 2) * beam.mass, (1.0 + factor) * beam.stiffness
        assert assembled.structure.mass[rows, rows] == pytest.approx(M)
        assert assembled.structure.stiffness[rows, rows] == pytest.approx(K + spring)
        # The law of the structure makes the damping of each; couplings have none.
        assert assembled.structure.damping[rows, rows] == pytest.approx(7.49 * M + 2.6e-5 * K)
    given = BladedDisk(
        ss.Structure(beam.mass, beam.stiffness, np.asarray(beam.damping), beam.dofs),
        6,
        engine_order=1,
    )
    assert given.mistuned(pattern).structure.damping[3:6, 3:6] == pytest.approx(beam.damping)


def test_the_ring_and_the_assembly_are_one_problem():
    disk = small().mistuned([0.1, -0.05, 0.0, 0.02, 0.08, -0.1], mass=[0, 0.01, 0, 0, 0, -0.02])
    plain = Model(disk.structure, disk.contacts, disk.forces)
    omega = np.linspace(160.0, 280.0, 13)
    by_sectors, whole = (ss.forced_response(one, omega, 5) for one in (disk, plain))
    assert by_sectors.converged.all()
    size = np.abs(whole.arrays.displacement).max()
    gap = by_sectors.arrays.displacement - whole.arrays.displacement
    assert np.abs(gap).max() < 1e-9 * size
    assert by_sectors.slip_fraction("2.shroud").max() > 0.1
    assert by_sectors.energy.imbalance == pytest.approx(np.zeros(13), abs=1e-9)
    assert ss.natural_frequencies(disk, ["0.jenkins"]) == pytest.approx(
        ss.natural_frequencies(plain, ["0.jenkins"])
    )
    ring = disk.ring
    assert ring.assembled(disk.disk.structure.dofs).stiffness == pytest.approx(
        disk.structure.stiffness
    )
    assert [one.sector for one in ring.contacts] == [n // 2 for n in range(12)]
    assert ring.contacts[1].next[0, 1] == -1.0
    assert ring.loads[0][1].shape == (6, 3)


@pytest.mark.slow
def test_exact_orbits_and_time_integration_agree_with_the_balance():
    disk = small(3).mistuned([0.08, -0.06, 0.0])
    balance = ss.forced_response(disk, [200.0], 61)
    orbit = ss.exact_response(disk, [200.0])
    run = ss.transient(disk, 200.0, 400, tolerance=1e-8)
    for dof in ("0.damper", "1.tip", "2.tip"):
        assert balance.amplitude(dof) == pytest.approx(orbit.amplitude(dof), rel=2e-4)
        assert run.amplitude(dof) == pytest.approx(float(orbit.amplitude(dof)[0]), rel=1e-5)
    certificate = ss.certify(balance).certificate
    assert certificate is not None
    assert np.abs(certificate.relative).max() < 1e-3


def test_amplitudes_of_all_blades_side_by_side(mistuned, tuned):
    amplitudes = mistuned.blade_amplitudes("damper")
    assert amplitudes.shape == (56, 36)
    assert np.array_equal(amplitudes[:, 7], mistuned.amplitude("7.damper"))
    assert mistuned.blades("damper") == tuple(range(36))
    blade, peak = mistuned.highest_blade("damper")
    assert blade == 13
    assert peak.amplitude >= amplitudes.max()
    # The friction localises: the quietest blade sticks where the loudest slips.
    assert amplitudes.max(axis=0).max() > 3.0 * amplitudes.max(axis=0).min()
    assert mistuned.amplification(tuned, "damper").blade == 13


def test_the_highest_blade_is_the_highest_of_all_refined_peaks(mistuned):
    blade, peak = mistuned.highest_blade("damper")
    tops = mistuned.blade_amplitudes("damper").max(axis=0)
    rivals = np.flatnonzero(tops > 0.98 * tops.max())
    refined = {int(one): mistuned.peak(f"{one}.damper") for one in rivals}
    best = max(refined, key=lambda one: refined[one].amplitude)
    assert blade == best
    assert peak.amplitude == pytest.approx(refined[best].amplitude, rel=1e-7)
    assert peak.omega == pytest.approx(refined[best].omega, rel=1e-4)
    # At a single frequency there is nothing between the points.
    lone = ss.forced_response(mistuned.model, [193.0], 3, observe=mistuned.dofs)
    blade, peak = lone.highest_blade("damper")
    assert peak.amplitude == lone.blade_amplitudes("damper").max()
    assert peak.at_edge


def test_some_blades_only():
    frf = ss.forced_response(
        small().mistuned(0.0), [200.0], 3, observe=["4.tip", "1.tip", "0.mode"]
    )
    assert frf.blades("tip") == (1, 4)
    assert frf.blade_amplitudes("tip").shape == (1, 2)
    with pytest.raises(ss.ModelError, match="dof 'damper': it was observed at no blade"):
        frf.blades("damper")


def test_one_structure_per_blade():
    disk = small(3)
    beam = disk.structure
    stiffer = ss.Structure(beam.mass, 1.1 * beam.stiffness, beam.damping, beam.dofs)
    made = disk.mistuned(structures=[beam, stiffer, beam])
    assert made.structure.stiffness[4, 4] == pytest.approx(1.1 * beam.stiffness[1, 1] + 1.4e4)
    assert made.blades == (beam, stiffer, beam)


def test_levels_and_other_parameters_keep_the_kind():
    disk = small().mistuned(0.0)
    louder = disk.scaled(force=2.0, slip_force=3.0)
    assert isinstance(louder, MistunedDisk)
    assert louder.contacts[0].parameters()["slip_force"] == pytest.approx(3 * 246.048)
    assert louder.ring.contacts[0].parameters["slip_force"] == pytest.approx(3 * 246.048)
    again = pickle.loads(pickle.dumps(louder))
    assert again.contacts == louder.contacts
    with pytest.raises(ss.ModelError, match="contacts: 1 for 12 of the disk"):
        disk.replaced(contacts=disk.contacts[:1])


@pytest.mark.slow
def test_results_of_disks_come_back_from_files(tmp_path, mistuned):
    K1 = np.zeros((3, 3))
    K1[0, 1] = -50.0
    disk = small(engine_orders={3: 3}, interface=ss.Interface(K1))
    frf = ss.forced_response(disk, [190.0, 200.0], 3)
    frf.save(tmp_path / "tuned.nc")
    back = ss.load(tmp_path / "tuned.nc")
    assert isinstance(back.model, BladedDisk)
    assert np.array_equal(back.arrays.displacement, frf.arrays.displacement)
    assert (back.model.contacts, back.model.forces, back.model.couplings) == (
        disk.contacts,
        disk.forces,
        disk.couplings,
    )
    assert dict(back.model.engine_orders) == {3: 3}
    assert back.model.structure.damping_law == disk.structure.damping_law
    assert np.array_equal(back.model.matrices.stiffness.next, disk.matrices.stiffness.next)
    # Seen from another sector all phases differ, and with them the rounding.
    top = frf.peak("tip").amplitude
    assert back.sector(2).peak("tip").amplitude == pytest.approx(top, rel=1e-12)
    mistuned.save(tmp_path / "mistuned.nc")
    back = ss.load(tmp_path / "mistuned.nc")
    model = back.model
    assert isinstance(model, MistunedDisk)
    assert np.array_equal(model.structure.stiffness, mistuned.model.structure.stiffness)
    assert np.array_equal(model.structure.damping, mistuned.model.structure.damping)
    assert (model.contacts, model.forces) == (mistuned.model.contacts, mistuned.model.forces)
    assert np.array_equal(back.blade_amplitudes("damper"), mistuned.blade_amplitudes("damper"))


@pytest.mark.slow
def test_figures_of_blades(mistuned, tuned):
    ax = mistuned.plot_blades("damper", tuned=tuned, length_unit="um")
    heights = [patch.get_height() for patch in ax.patches]
    assert heights == pytest.approx(1e6 * mistuned.blade_amplitudes("damper").max(axis=0))
    level = ax.lines[0].get_ydata()[0]
    assert level == pytest.approx(1e6 * tuned.peak("damper").amplitude)
    ax = plot.blade_bars(mistuned, "damper", index=20, tuned=tuned)
    heights = [patch.get_height() for patch in ax.patches]
    assert heights == pytest.approx(mistuned.blade_amplitudes("damper")[20])
    ax = plot.blade_bars(mistuned, "damper", index=20, omega_unit="rpm")
    speed = 30.0 / np.pi * mistuned.omega[20] / mistuned.model.disk.engine_order
    assert ax.get_title() == f"n = {speed:.5g} rpm"
    ax = mistuned.plot_blade_curves("damper", [3, 13], tuned=tuned, omega_unit="Hz", log=False)
    assert [line.get_label() for line in ax.lines] == ["blade 3", "blade 13", "tuned"]
    assert ax.lines[1].get_ydata() == pytest.approx(mistuned.amplitude("13.damper"))
    assert len(plot.blade_curves(mistuned, "damper").lines) == 36
    tuned.plot("damper")
    ss.forced_response(small(), (170.0, 230.0), 3).plot("tip")


def test_the_linear_limits_of_a_disk_are_those_of_the_wave():
    from stickslip.plot.limits import limit_curve

    disk = small()
    for stuck in (True, False):
        omega, amplitude = limit_curve(disk, "tip", (150.0, 260.0), "half_range", stuck=stuck)
        whole = disk.mistuned(0.0)
        _, expected = limit_curve(whole, "0.tip", (150.0, 260.0), "half_range", stuck=stuck)
        top = expected.max()
        assert amplitude.max() == pytest.approx(top, rel=1e-3)
        assert np.isfinite(omega).all()


@pytest.mark.slow
def test_figures_of_nodal_diameters():
    ring = ss.reference.beam_ring()
    table = ring.nodal_diameters()
    ax = table.plot(omega_unit="rad/s")
    assert [line.get_label() for line in ax.lines if line.get_label()[0] != "_"] == [
        "stuck",
        "slipping",
    ]
    assert ax.lines[0].get_ydata() == pytest.approx(table.stuck[:, 0])
    ax = plot.safe(ring, 100.0, orders=[2, 20, 37], omega_unit="rad/s", slipping=False)
    marks = ax.lines[-1]
    # Engine order 20 is nodal diameter 16 running backwards, 37 is 1.
    assert marks.get_xdata().tolist() == [2.0, 16.0, 1.0]
    assert marks.get_ydata().tolist() == [200.0, 2000.0, 3700.0]
    line = ax.lines[-2]
    assert line.get_xdata().max() == 18.0
    assert np.interp(1800.0, line.get_ydata(), line.get_xdata()) == pytest.approx(18.0)
    odd = plot.safe(ss.reference.beam_ring(7), 100.0, orders=7, omega_unit="rad/s")
    assert np.interp(350.0, odd.lines[-2].get_ydata(), odd.lines[-2].get_xdata()) == 3.5
    assert ss.reference.laxalde_blisk().nodal_diameters().plot_safe(500.0).lines


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: small().mistuned(), "pattern: missing; give one deviation per sector"),
        (lambda: small().mistuned([0.1, 0.2]), r"pattern: shape \(2,\) for 6 sectors"),
        (lambda: small().mistuned([0.1] * 5 + [-1.0]), r"pattern\[5\] is -1; give deviations"),
        (lambda: small().mistuned([np.nan] * 6), r"pattern\[0\] is nan"),
        (lambda: small().mistuned("much"), "pattern: 'much' holds no real numbers"),
        (lambda: small().mistuned(0, mass=[1]), r"mass: shape \(1,\) for 6 sectors"),
        (
            lambda: small().mistuned(0, structures=[]),
            "structures: given beside pattern or mass",
        ),
        (
            lambda: small().mistuned(structures=[small().structure]),
            "structures: 1 for 6 sectors",
        ),
        (
            lambda: small(2).mistuned(structures=[small().structure, 3]),
            r"structures\[1\]: 3 is no Structure",
        ),
        (
            lambda: small(2).mistuned(
                structures=[small().structure, ss.Structure([[1.0]], [[1.0]], dofs=["tpi"])]
            ),
            r"structures\[1\]: unknown dof 'tpi'; did you mean 'tip'",
        ),
        (lambda: MistunedDisk(ss.reference.snecma_beam(), []), "is no BladedDisk"),
        (
            lambda: ss.forced_response(small(), [200.0], 1).blade_amplitudes("tip"),
            "the model is no MistunedDisk",
        ),
        (
            lambda: ss.forced_response(small().mistuned(0), [200.0], 1).blades("tpi"),
            "unknown dof of a sector 'tpi'; did you mean 'tip'",
        ),
        (
            lambda: ss.forced_response(small().mistuned(0), [200.0], 1).amplification(3, "tip"),
            "tuned: 3 is not the response of a BladedDisk",
        ),
        (
            lambda: ss.forced_response(small().mistuned(0), [200.0], 1).plot_blade_curves(
                "tip", [9]
            ),
            "blades: 9 was not observed at 'tip'",
        ),
        (lambda: plot.safe(small(), 0.0), "speed: 0 is not above zero"),
        (lambda: plot.nodal_diameters(ss.reference.snecma_beam()), "is no BladedDisk"),
        (lambda: ss.mistuning_pattern(5, -1.0), "deviation: -1 is negative"),
        (lambda: ss.mistuning_pattern(5, 0.1, "gamma"), "distribution: unknown choice 'gamma'"),
    ],
)
def test_bad_mistuning_is_refused_in_one_line(call, message):
    with pytest.raises(ss.ModelError, match=message) as refusal:
        call()
    assert "\n" not in str(refusal.value)

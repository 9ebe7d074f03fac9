"""Negative damping as it is given: modal ratios, the readings of (5.30), influence coefficients."""

import json

import numpy as np
import pytest
from scipy.linalg import eig, eigh

import stickslip as ss
from stickslip import plot
from stickslip.disk import AerodynamicWaves
from stickslip.model.laws import law_from_spec
from stickslip.reference import beam_pair, beam_ring, snecma_beam


def bare_beam():
    model = snecma_beam()
    structure = model.structure
    bare = ss.Structure(structure.mass, structure.stiffness, None, structure.dofs)
    return ss.Model(bare, model.contacts)


def unit_shapes():
    """Return the eigenvectors of unit Euclidean length that (5.29) uses, and their omega."""
    structure = snecma_beam().structure
    squares, shapes = eigh(structure.stiffness, structure.mass)
    return shapes / np.linalg.norm(shapes, axis=0), np.sqrt(squares)


def coefficients(values):
    """Return modal damping of coefficients c_j: zeta_j = c_j / (2 m_j omega_j)."""
    shapes, omega = unit_shapes()
    modal_mass = np.diag(shapes.T @ snecma_beam().structure.mass @ shapes)
    return ss.modal_damping(list(np.asarray(values) / (2.0 * modal_mass * omega)))


def test_the_printed_coefficients_stand_in_reverse_order():
    shapes, omega = unit_shapes()
    projected = np.diag(shapes.T @ snecma_beam().structure.damping @ shapes)
    # of (5.30), printed as c_1 = 5.789, c_2 = 27.627, c_3 = 12.095
    assert projected == pytest.approx([12.0954, 27.6267, 5.7892], rel=1e-5)
    assert omega == pytest.approx([159.5927, 901.7589, 2167.5410], rel=1e-6)


def test_modal_damping_is_5_29_corrected():
    shapes, _ = unit_shapes()
    inverse = np.linalg.inv(shapes)
    given = [5.789, 27.627, -12.095]
    expected = inverse.T @ np.diag(given) @ inverse
    model = ss.destabilised(bare_beam(), coefficients(given))
    np.testing.assert_allclose(model.structure.damping, expected, rtol=1e-9, atol=1e-9)
    # the same law as the damping of a structure
    structure = snecma_beam().structure
    same = ss.Structure(structure.mass, structure.stiffness, coefficients(given), structure.dofs)
    np.testing.assert_array_equal(same.damping, model.structure.damping)


# The three readings of (5.30): which mode is driven, and with what coefficient.
READINGS = {
    # as printed: c_3 = -12.095 on the third mode. r_max computed beforehand: 3.118469
    "literal": (lambda r: [5.78919, 27.6267, -12.09545 * r], 2, 3.1184, 3.119),
    # the coefficient -12.095 on the mode it belongs to, the first
    "first mode": (lambda r: [-12.0954 * r, 27.6267, 5.7892], 0, None, None),
    # the third mode with the coefficient that belongs to it
    "third mode": (lambda r: [12.0954, 27.6267, -5.7892 * r], 2, None, None),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", READINGS)
def test_one_driven_mode_settles_on_it(name):
    values, mode, below, above = READINGS[name]
    beam = bare_beam()
    stiffness = beam.structure.stiffness + np.diag([2.4e7, 0.0, 0.0])
    shape = eigh(stiffness, beam.structure.mass)[1][:, mode]
    start = ss.State(beam, 1.2e-5 * shape / shape[0])
    for ratio in (1.0, 3.0):
        motion = ss.classify(ss.destabilised(beam, coefficients(values(ratio))), start)
        assert (motion.motion, motion.mode) == ("settled", mode)
    if below is None:
        return
    # up to the fold the motion follows the branch, past it friction cannot hold it
    for ratio in (3.1, 3.115, below):
        motion = ss.classify(ss.destabilised(beam, coefficients(values(ratio))), motion.final)
        assert (motion.motion, motion.mode) == ("settled", 2)
    assert motion.omega == pytest.approx(2675.34, rel=5e-3)
    beyond = ss.destabilised(beam, coefficients(values(above)))
    past = ss.classify(beyond, motion.final)
    assert past.motion == "unbounded"


def test_stuck_modes_are_those_of_the_stuck_structure():
    model = beam_pair()
    structure = model.structure
    law = ss.modal_damping(0.01, stuck=model)
    matrix = law.matrix(structure.mass, structure.stiffness, structure.dofs)
    held = structure.stiffness.copy()
    for contact in model.contacts:
        rows = contact.rows(structure)
        held += contact.stiffness * rows.T @ rows
    squares, shapes = eigh(held, structure.mass)
    ratios = np.diag(shapes.T @ matrix @ shapes) / (2.0 * np.sqrt(squares))
    np.testing.assert_allclose(ratios, 0.01, rtol=1e-9)
    assert np.sqrt(squares) == pytest.approx(ss.natural_frequencies(model))
    assert law == ss.ModalDamping(0.01, model.contacts)
    assert law_from_spec(json.loads(json.dumps(law.to_spec()))) == law
    free = ss.modal_damping(0.01)
    assert "stuck" not in free.to_spec()
    assert np.abs(free.matrix(structure.mass, structure.stiffness) - matrix).max() > 1.0


@pytest.mark.slow
def test_the_law_of_stuck_modes_is_saved(tmp_path):
    model = snecma_beam()
    structure = model.structure
    law = ss.modal_damping([0.001, 0.002, 0.003], stuck=model)
    damped = ss.Structure(structure.mass, structure.stiffness, law, structure.dofs)
    curve = ss.forced_response(ss.Model(damped, model.contacts, model.forces), [150.0], 3)
    curve.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc").model.structure
    assert again.damping_law == law
    np.testing.assert_array_equal(again.damping, damped.damping)


def test_a_ratio_adds_to_what_there_is_and_a_disk_stays_one():
    disk = beam_ring(sectors=6)
    driven = ss.destabilised(disk, ss.Rayleigh(mass=-7.49), 0.5)
    assert isinstance(driven, ss.BladedDisk)
    assert (driven.sectors, driven.couplings, driven.forces) == (6, disk.couplings, disk.forces)
    added = driven.structure.damping - disk.structure.damping
    np.testing.assert_allclose(added, -0.5 * 7.49 * disk.structure.mass, rtol=1e-9)
    whole = disk.mistuned(0.0)
    size = len(whole.structure)
    matrix = np.arange(size * size, dtype=float).reshape(size, size)
    other = ss.destabilised(whole, matrix, 2.0)
    assert type(other) is ss.Model
    np.testing.assert_allclose(other.structure.damping - whole.structure.damping, 2.0 * matrix)


L = {0: -200.0 - 60.0j, 1: 60.0 + 900.0j, -1: -50.0 + 700.0j, 2: 5.0 - 80.0j, -2: 3.0 + 40.0j}


def eigenvalues(disk, influence, diameter):
    """Return the eigenvalues of a wave from the whole first-order problem."""
    n = disk.sectors
    delta = 2.0 * np.pi * diameter / n
    direction = influence.direction(disk.structure)
    force = influence.at(diameter, n) * np.outer(direction, direction)
    stiffness = disk.matrices.stiffness.wave(delta) + np.diag([2.4e7, 0.0, 0.0]) - force
    inverse = np.linalg.inv(disk.matrices.mass.wave(delta))
    zero, one = np.zeros((3, 3)), np.eye(3)
    damping = disk.matrices.damping.wave(delta)
    values = eig(np.block([[zero, one], [-inverse @ stiffness, -inverse @ damping]]))[0]
    values = values[values.imag > 0.0]
    return values[np.argsort(values.imag)]


@pytest.mark.slow
@pytest.mark.parametrize("place", [{"dof": "tip"}, {"mode": 0}])
def test_waves_have_the_damping_of_the_whole_problem(place):
    disk = beam_ring(sectors=18)
    scale = 1.0 if "dof" in place else 0.5
    influence = ss.InfluenceCoefficients({j: scale * one for j, one in L.items()}, **place)
    waves = ss.aerodynamic_waves(disk, influence)
    for diameter in range(18):
        value = eigenvalues(disk, influence, diameter)[0]
        # to first order in the damping
        assert waves.omega[diameter] == pytest.approx(abs(value), rel=2e-3)
        assert waves.ratio[diameter] == pytest.approx(-value.real / abs(value), rel=2e-2, abs=2e-5)
    assert waves.least_stable == int(waves.ratio.argmin())
    # neighbours make the S: waves forward and backward differ
    assert abs(waves.aerodynamic_ratio[3] - waves.aerodynamic_ratio[15]) > 1e-4


def test_the_matrices_of_a_wave():
    disk = beam_ring(sectors=18)
    influence = ss.InfluenceCoefficients(L, dof="tip")
    waves = ss.aerodynamic_waves(disk, influence)
    wave = waves.wave()
    assert wave.diameter == waves.least_stable
    for matrix in (wave.mass, wave.damping, wave.stiffness):
        np.testing.assert_allclose(matrix, matrix.conj().T, atol=1e-9)
    total = sum(one * np.exp(2j * np.pi * wave.diameter * j / 18) for j, one in L.items())
    assert wave.added_stiffness[1, 1] == pytest.approx(-total.real)
    assert wave.negative_damping[1, 1] == pytest.approx(-total.imag / wave.omega)
    shape = eigh(wave.stiffness + np.diag([2.4e7, 0.0, 0.0]), wave.mass)[1][:, 0]
    ratio = (shape.conj() @ wave.damping @ shape).real / (2.0 * wave.omega)
    assert ratio == pytest.approx(waves.ratio[wave.diameter], rel=1e-3)
    # the disk that carries it meets the same matrices at its fundamental
    carried = waves.disk_of()
    assert carried.diameter(1) == wave.diameter
    for mine, theirs in zip(
        carried.matrices_at(1), (wave.mass, wave.damping, wave.stiffness), strict=True
    ):
        np.testing.assert_allclose(mine, theirs, rtol=1e-12, atol=1e-9)
    half = waves.disk_of(3, ratio=0.5)
    np.testing.assert_allclose(
        half.structure.damping - disk.structure.damping, 0.5 * waves.wave(3).negative_damping
    )


def test_slipping_contacts_and_one_blade_alone():
    disk = beam_ring(sectors=18)
    alone = ss.InfluenceCoefficients({0: 100.0j}, mode=1)
    waves = ss.aerodynamic_waves(disk, alone, 1, slipping=[0])
    frequencies = [ss.natural_frequencies(disk, [0], nodal_diameter=d)[1] for d in range(18)]
    assert waves.omega == pytest.approx(frequencies, rel=1e-9)
    # of a blade by itself: q'' + omega^2 q = L q
    single = ss.BladedDisk(disk.structure, 4, engine_order=0)
    square = ss.natural_frequencies(ss.Model(disk.structure))[1] ** 2
    ratio = ss.aerodynamic_waves(single, alone, 1).aerodynamic_ratio
    np.testing.assert_allclose(ratio, -100.0 / (2.0 * square), rtol=1e-9)


def test_the_s_curve():
    disk = beam_ring(sectors=9)
    waves = ss.aerodynamic_waves(disk, ss.InfluenceCoefficients(L, dof="tip"))
    ax = waves.plot()
    flow = ax.lines[1]
    assert flow.get_xdata().tolist() == list(range(-4, 5))
    expected = 100.0 * np.roll(waves.aerodynamic_ratio, 4)
    np.testing.assert_allclose(flow.get_ydata(), expected)
    assert isinstance(waves, AerodynamicWaves)
    with pytest.raises(ss.ModelError, match="aerodynamic_waves"):
        plot.aerodynamic(disk)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.modal_damping([0.1, "a"]), "position 1"),
        (lambda: ss.modal_damping(0.1, stuck=[1]), "is no contact"),
        (lambda: ss.modal_damping(0.1, stuck=3), "is no contact"),
        (
            lambda: ss.destabilised(bare_beam(), ss.modal_damping([-0.1])),
            "1 ratios for 3 modes",
        ),
        (
            lambda: ss.destabilised(
                bare_beam(),
                ss.modal_damping(0.1, stuck=[ss.Jenkins("a", stiffness=1, slip_force=1)]),
            ),
            "unknown dof 'a'",
        ),
        (lambda: ss.InfluenceCoefficients({}, dof="tip"), "is no mapping|influence"),
        (lambda: ss.InfluenceCoefficients({0.5: 1.0}, dof="tip"), "no whole number"),
        (lambda: ss.InfluenceCoefficients({0: np.inf}, dof="tip"), "no finite number"),
        (lambda: ss.InfluenceCoefficients({0: 10**400}, dof="tip"), "no finite number"),
        (lambda: ss.InfluenceCoefficients({0: 1.0}), "exactly one"),
        (lambda: ss.InfluenceCoefficients({0: 1.0}, dof="tip", mode=0), "exactly one"),
        (
            lambda: ss.aerodynamic_waves(
                beam_ring(), ss.InfluenceCoefficients({0: 1.0}, dof="tpi")
            ),
            "did you mean 'tip'",
        ),
        (
            lambda: ss.aerodynamic_waves(beam_ring(), ss.InfluenceCoefficients({0: 1.0}, mode=3)),
            "mode 3; a blade has 3",
        ),
        (
            lambda: ss.aerodynamic_waves(snecma_beam(), ss.InfluenceCoefficients({0: 1j}, mode=0)),
            "no tuned BladedDisk",
        ),
        (lambda: ss.aerodynamic_waves(beam_ring(), L), "influence"),
        (
            lambda: ss.aerodynamic_waves(beam_ring(), ss.InfluenceCoefficients({0: 1j}, mode=0), 3),
            "mode: 3; a sector has 3",
        ),
        (
            lambda: ss.aerodynamic_waves(
                beam_ring(), ss.InfluenceCoefficients({0: 1e12}, dof="tip")
            ),
            "smaller coefficients",
        ),
        (
            lambda: ss.aerodynamic_waves(
                beam_ring(), ss.InfluenceCoefficients({0: 1j}, mode=0)
            ).wave(36),
            "36 sectors have 0 to 35",
        ),
    ],
)
def test_nonsense_is_refused(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call()


def test_the_least_stable_wave_has_a_limit_cycle():
    beam = ss.reference.snecma_structure()
    light = ss.Structure(beam.mass, beam.stiffness, ss.Rayleigh(mass=0.2), beam.dofs)
    coupling = ss.Coupling("tip", stiffness=2e4)
    damper = ss.Jenkins("damper", stiffness=2.4e7, slip_force=246.048)
    disk = ss.BladedDisk(light, 7, [coupling], [damper], engine_order=2)
    flow = ss.InfluenceCoefficients({0: -200 - 600j, 1: 600 + 2200j, -1: -500 - 1800j}, dof="tip")
    waves = ss.aerodynamic_waves(disk, flow)
    assert waves.ratio[waves.least_stable] < 0.0
    bare, fed = waves.disk_of(ratio=0.0), waves.negative_damping()
    cycles = ss.limit_cycles(bare, fed, harmonics=9)

    # With all contacts stuck the wave is undamped where its limit cycles begin.
    delta = 2.0 * np.pi * waves.least_stable / 7
    blocks, begin = bare.matrices, float(cycles.ratio[0])
    stiffness = blocks.stiffness.wave(delta) + np.diag([2.4e7, 0.0, 0.0])
    damping = blocks.damping.wave(delta) + begin * fed[waves.least_stable]
    lower = -np.linalg.solve(blocks.mass.wave(delta), np.hstack([stiffness, damping]))
    poles = np.linalg.eigvals(np.vstack([np.eye(3, 6, 3), lower]))
    critical = poles[np.argmin(np.abs(poles - 1j * cycles.omega[0]))]
    assert abs(critical - 1j * cycles.omega[0]) < 2e-4 * cycles.omega[0]

    # The flow as it is: one cycle on either side of the turn.
    assert cycles.limit.ratio > 1.0
    actual = ss.limit_cycles(bare, fed, harmonics=9, ratio=[1.0])
    assert list(actual.branch) == ["sticking", "slipping"]

"""Natural frequencies against LAPACK's, and the modes that damping laws keep."""

import numpy as np
import pytest
from scipy.linalg import eigh

import stickslip as ss
from chains import in_a_row
from stickslip.model.structure import Structure

RNG = np.random.default_rng(5)


def chain(size, springs=1e6, mass=0.1):
    return mass * np.eye(size), in_a_row(np.broadcast_to(springs, size + 1))


def joint(size, decades):
    """Springs of structure and joints that differ by decades."""
    return chain(size, 1e4 * 10 ** (decades * np.random.default_rng(size).random(size + 1)))


def dense(size, decades):
    turned, _ = np.linalg.qr(RNG.standard_normal((size, size)))
    factor = RNG.standard_normal((size, size))
    stiffness = (turned * np.geomspace(1e3, 1e3 * 10**decades, size)) @ turned.T
    return factor @ factor.T / size + np.eye(size), 0.5 * (stiffness + stiffness.T)


def ring(size, spring=1e8):
    turn = np.roll(np.eye(size), 1, axis=0)
    return np.eye(size), spring * (2.1 * np.eye(size) - turn - turn.T)


def component_modes(size, modes):
    """Fixed-interface modes of a chain beside its first and last mass, as Craig and Bampton."""
    mass, stiffness = chain(size, 1e8)
    kept, inner = [0, size - 1], np.arange(1, size - 1)
    shapes = eigh(stiffness[np.ix_(inner, inner)], mass[np.ix_(inner, inner)])[1][:, :modes]
    static = -np.linalg.solve(stiffness[np.ix_(inner, inner)], stiffness[np.ix_(inner, kept)])
    basis = np.zeros((size, 2 + modes))
    basis[kept, [0, 1]] = 1.0
    basis[inner, :2], basis[inner, 2:] = static, shapes
    reduced = [basis.T @ matrix @ basis for matrix in (mass, stiffness)]
    return tuple(0.5 * (matrix + matrix.T) for matrix in reduced)


def model(structure, stiffness=1e5):
    dofs = structure.dofs
    damper = ss.Jenkins(dofs[len(dofs) // 2], stiffness=stiffness, slip_force=1e9)
    return ss.Model(structure, [damper], [ss.Force(dofs[0], 1.0)])


STRUCTURES = {
    "chain-129": chain(129, 1e8),
    "chain-300": chain(300),
    "chain-600": chain(600, 1e7),
    "uneven-300": chain(300, 1e7 * (1.0 + np.random.default_rng(2).random(301))),
    "joint-37": joint(37, 6),
    "joint-85": joint(85, 6),
    "dense-250": dense(250, 6),
    "ring-240": ring(240),
    "component-modes": component_modes(260, 150),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", STRUCTURES)
def test_frequencies_are_those_of_lapack(name):
    mass, stiffness = STRUCTURES[name]
    plain = model(Structure(mass, stiffness))
    for slipping, held in (([0], stiffness), ([], None)):
        if held is None:
            rows = plain.contacts[0].rows(plain.structure)
            held = stiffness + 1e5 * rows.T @ rows
        exact = np.sqrt(eigh(held, mass, eigvals_only=True))
        found = ss.natural_frequencies(plain, slipping)
        assert np.abs(found - exact).max() <= 1e-12 * exact[-1]


@pytest.mark.slow
def test_frequencies_of_waves_of_a_large_sector_are_those_of_lapack():
    mass, stiffness = chain(150, 1e8)
    coupling = ss.Coupling("3", stiffness=3e7)
    disk = ss.BladedDisk(Structure(mass, stiffness), 12, [coupling], engine_order=2)
    for diameter in (0, 2, 6):
        held = stiffness.copy()
        held[3, 3] += 3e7 * (2.0 - 2.0 * np.cos(2.0 * np.pi * diameter / 12))
        exact = np.sqrt(eigh(held, mass, eigvals_only=True))
        found = ss.natural_frequencies(disk, nodal_diameter=diameter)
        assert np.abs(found - exact).max() <= 1e-12 * exact[-1]


@pytest.mark.slow
@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("law", [ss.ModalDamping(1e-3), ss.Rayleigh(mass=2.0, stiffness=1e-6)])
def test_a_law_keeps_the_modes_of_the_free_structure(name, law):
    mass, stiffness = STRUCTURES[name]
    structure = Structure(mass, stiffness, law)
    assert model(structure).problem.modal_base == "free modes"


@pytest.mark.slow
def test_a_long_chain_responds_as_its_matrices_do():
    mass, stiffness = chain(300)
    law = ss.ModalDamping(1e-3)
    structure = Structure(mass, stiffness, law)
    stuck = model(structure)
    first = ss.natural_frequencies(stuck)[0]
    omega = first * np.array([0.5, 1.0, 1.002, 2.2])
    frf = ss.forced_response(stuck, omega, harmonics=1)
    rows = stuck.contacts[0].rows(structure)
    held = stiffness + 1e5 * rows.T @ rows
    exact = [
        np.linalg.solve(held + 1j * w * structure.damping - w**2 * mass, np.eye(300)[0])
        for w in omega
    ]
    found = np.array([frf.coefficients(dof)[:, 1] for dof in structure.dofs]).T
    assert np.abs(found - exact).max() <= 1e-8 * np.abs(exact).max()
    (said,) = [text for text in frf.assumptions if "proportional" in text]
    assert "real modes" in said
    # The matrix that the law makes is known for what it is, another one is not.
    assert model(Structure(mass, stiffness, structure.damping)).problem.modal_base == "free modes"
    other = structure.damping.copy()
    other[7, 7] *= 1.01
    assert model(Structure(*chain(40), other[:40, :40])).problem.modal_base == "complex modes"


@pytest.mark.slow
def test_parts_with_laws_of_their_own_are_joined_with_their_modes():
    parts = {
        "1": Structure(*chain(40), ss.ModalDamping(1e-3)),
        "2": Structure(*chain(40), ss.ModalDamping(4e-2)),
        "3": Structure(*joint(45, 6), ss.Rayleigh(mass=1.0, stiffness=1e-6)),
        "4": Structure(*chain(5)),
    }
    whole = ss.join(parts)
    assert whole.proportional
    contact = ss.Jenkins("1.3", "2.4", stiffness=1e7, slip_force=1e9)
    between = ss.Jenkins("2.9", "3.4", stiffness=1e7, slip_force=1e9)
    stuck = ss.Model(whole, [contact, between], [ss.Force("1.0", 1.0)])
    assert stuck.problem.modal_base == "free modes"
    held = whole.stiffness.copy()
    for one in stuck.contacts:
        rows = one.rows(whole)
        held = held + 1e7 * rows.T @ rows
    omega = 1.0005 * ss.natural_frequencies(stuck)[:3]
    frf = ss.forced_response(stuck, omega, harmonics=1)
    found = np.array([frf.coefficients(dof)[:, 1] for dof in whole.dofs]).T
    exact = [
        np.linalg.solve(held + 1j * w * whole.damping - w**2 * whole.mass, np.eye(len(whole))[0])
        for w in omega
    ]
    assert np.abs(found - exact).max() <= 1e-7 * np.abs(exact).max()
    unknown = Structure(*chain(5), damping=np.diag([1.0, 0.0, 0.0, 0.0, 0.0]))
    assert not ss.join({**parts, "5": unknown}).proportional


@pytest.mark.slow
def test_negative_damping_of_a_law_keeps_the_modes():
    blade = model(Structure(*chain(150), ss.ModalDamping(1e-3)))
    driven = ss.destabilised(blade, ss.modal_damping([-1e-2, *np.zeros(149)]), 0.05)
    assert driven.structure.proportional
    assert driven.problem.modal_base == "free modes"
    held = ss.destabilised(blade, ss.modal_damping([-1e-2, *np.zeros(149)], stuck=blade))
    assert not held.structure.proportional


def test_sectors_keep_their_law_unless_couplings_break_it():
    law = ss.Rayleigh(mass=1.0, stiffness=1e-6)
    mass, stiffness = chain(5)
    block = np.zeros((5, 5))
    block[4, 0] = -1e5
    spring = ss.Coupling("3", stiffness=3e5)

    def disk(damping, **options):
        return ss.BladedDisk(Structure(mass, stiffness, damping), 6, engine_order=1, **options)

    kept = [
        disk(law),
        disk(ss.ModalDamping(1e-3)),
        disk(ss.Rayleigh(mass=1.0), couplings=[spring]),
        disk(law, interface=ss.Interface(block, damping=law)),
    ]
    lost = [
        disk(law, couplings=[spring]),
        disk(ss.ModalDamping(1e-3), couplings=[spring]),
        disk(law, interface=ss.Interface(block)),
    ]
    pattern = [0.1, 0.0, -0.05, 0.02, 0.0, 0.03]
    for tuned in kept + lost:
        known = any(tuned is one for one in kept)
        assert tuned.matrices.proportional is known
        assert tuned.mistuned(pattern).ring.proportional is known
        assert tuned.mistuned(pattern).structure.proportional is known


@pytest.mark.slow
def test_files_keep_what_is_known_of_damping(tmp_path):
    joined = ss.join({"1": Structure(*chain(3), ss.ModalDamping(1e-3)), "2": Structure(*chain(2))})
    sector = ss.BladedDisk(
        Structure(*chain(3), ss.ModalDamping(1e-3)),
        4,
        contacts=[ss.Jenkins("1", stiffness=1e5, slip_force=1.0)],
        forces=[ss.Force("0", 1.0)],
        engine_order=1,
    )
    for number, saved in enumerate([model(joined), sector, sector.mistuned([0.1, 0, 0, 0])]):
        path = tmp_path / f"{number}.nc"
        ss.forced_response(saved, [100.0], harmonics=1).save(path)
        read = ss.load(path).model
        assert saved.structure.proportional
        assert read.structure.proportional
        assert read.problem.modal_base == saved.problem.modal_base


def test_direct_solution_names_itself_its_cost_and_its_reason():
    # The first mass is damped critically with its contact stuck, which makes its pole a double one;
    # a damper between the others couples their modes.
    stiffness = np.array([[3.0, 0.0, 0.0], [0.0, 5.0, -2.0], [0.0, -2.0, 2.0]])
    damping = np.diag([4.0, 0.0, 0.3])
    row = Structure(np.eye(3), stiffness, damping)
    contact, force = ss.Jenkins("0", stiffness=1.0, slip_force=1e9), ss.Force("0", 1.0)
    free = ss.Model(row, [contact], [force])
    assert free.problem.modal_base == "direct"
    disk = ss.BladedDisk(row, 4, contacts=[contact], forces=[force], engine_order=1)
    for one in (free, disk, disk.mistuned([0.1, 0.0, 0.0, 0.0])):
        said = ss.forced_response(one, [1.0, 3.0], harmonics=1).assumptions
        assert "a factorisation of the whole dynamic stiffness per harmonic" in " ".join(said)
        assert "complex modes miss a direct solution" in " ".join(said)
        assert not any("real modes" in text or "over the complex" in text for text in said)
    curve = ss.damper_curve(free, slip_force=[1.0, 2.0], dof="0", omega=(0.5, 3.0), harmonics=1)
    assert any("factorisation" in text for text in curve.assumptions)
    # A law leaves the same masses their modes.
    law = Structure(np.eye(3), stiffness, ss.Rayleigh(stiffness=1e-3))
    said = ss.forced_response(ss.Model(law, [contact], [force]), [1.0], harmonics=1).assumptions
    assert not any("factorisation" in text for text in said)

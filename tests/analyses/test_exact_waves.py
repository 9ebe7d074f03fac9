"""Exact orbits of tuned disks: travelling waves against all sectors."""

import numpy as np
import pytest

import stickslip as ss

BLADE = ss.Structure(
    [[2.0, 0.0], [0.0, 1.0]],
    [[6e4, -1.5e4], [-1.5e4, 2e4]],
    ss.Rayleigh(mass=2.0, stiffness=1e-5),
    dofs=["root", "tip"],
)
GROUND = ss.Jenkins("root", stiffness=2e4, slip_force=3.0, name="ground")
SHROUD = ss.Jenkins("tip", "next.tip", stiffness=1e4, slip_force=2.0, name="shroud")
PUSH = ss.Force("tip", 10.0)


def disk_of(sectors: int, order: int, contacts: list[ss.Jenkins], *forces: ss.Force):
    return ss.BladedDisk(
        BLADE,
        sectors,
        couplings=[ss.Coupling("tip", stiffness=4e3)],
        contacts=contacts,
        forces=[PUSH, *forces],
        engine_order=order,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sectors", "order", "forces"),
    [
        (8, 3, []),
        (7, 2, []),
        (6, 3, []),
        (6, 4, [ss.Force("tip", 3.0, harmonic=2)]),
        (5, 0, []),
    ],
)
def test_the_wave_is_the_orbit_of_all_sectors(sectors, order, forces, tmp_path):
    disk = disk_of(sectors, order, [GROUND, SHROUD], *forces)
    omega = np.array([0.8, 1.0]) * ss.natural_frequencies(disk)[0]
    wave = ss.exact_response(disk, omega)
    whole = ss.exact_response(disk.mistuned(0), omega)
    assert wave.converged.all()
    assert whole.slip_fraction("0.ground").max() > 0.01
    assert wave.peak("tip").amplitude == pytest.approx(whole.peak("0.tip").amplitude, rel=1e-6)
    assert wave.stability.tolist() == ["not decided"] * 2
    energy, total = wave.energy, whole.energy
    np.testing.assert_allclose(sectors * energy.friction, total.friction, rtol=1e-7)
    np.testing.assert_allclose(sectors * energy.work, total.work, rtol=1e-7)
    with pytest.raises(ss.ModelError, match=r"exact_response\(disk.mistuned\(0\)\)"):
        wave.state(0)
    wave.save(tmp_path / "wave.nc")
    loaded = ss.load(tmp_path / "wave.nc")
    for one in (wave, loaded, loaded.sector(2)):
        number = 2 if one.model is not loaded.model and one is not wave else 0
        for dof in ("root", "tip"):
            name = f"{number}.{dof}"
            size = whole.amplitude(name).max()
            np.testing.assert_allclose(one.amplitude(dof), whole.amplitude(name), rtol=1e-8)
            np.testing.assert_allclose(
                one.coefficients(dof), whole.coefficients(name), rtol=0, atol=1e-8 * size
            )
            for index in (0, 1):
                np.testing.assert_allclose(
                    one.waveform(dof, index), whole.waveform(name, index), rtol=0, atol=1e-8 * size
                )
                np.testing.assert_allclose(
                    one.contact_force("ground", index),
                    whole.contact_force(f"{number}.ground", index),
                    rtol=0,
                    atol=1e-6,
                )
                events, every = one.events(index), whole.events(index)
                contact = whole.model.contact_index(f"{number}.ground")
                there = every.number == contact
                np.testing.assert_allclose(
                    events.time[events.number == 0], every.time[there], rtol=0, atol=1e-8
                )
                np.testing.assert_array_equal(events.code[events.number == 0], every.code[there])


def test_a_range_and_a_study_take_tuned_disks():
    disk = disk_of(6, 1, [GROUND])
    first = ss.natural_frequencies(disk)[0]
    exact = ss.exact_response(disk, (0.95 * first, 1.05 * first), observe="tip")
    balance = ss.forced_response(disk, exact.omega, observe="tip")
    np.testing.assert_allclose(balance.amplitude("tip"), exact.amplitude("tip"), rtol=3e-3)

"""Disks under forces of other harmonics than the first, whose waves are met at other diameters."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

import stickslip as ss
from stickslip.results.status import Status


def disk(ratio: float = 0.01, harmonic: int = 2, engine_order: int = 2) -> ss.BladedDisk:
    """Return twelve strongly coupled blades, each a mass on a damper."""
    blade = ss.Structure([[1.0]], [[4e4]], damping=ss.ModalDamping(ratio), dofs=["tip"])
    damper = ss.Jenkins("tip", stiffness=1e4, slip_force=1.0)
    force = ss.Force("tip", 1.0, harmonic=harmonic)
    links = [ss.Coupling("tip", stiffness=4e4)]
    return ss.BladedDisk(blade, 12, links, [damper], [force], engine_order=engine_order)


def test_the_default_range_is_that_of_the_harmonic_of_the_forces() -> None:
    limits = {"dof": "tip", "slip_force": [0.5, 1.0, 2.0], "harmonics": 2}
    by_default = ss.damper_curve(disk(), **limits)
    wide = ss.damper_curve(disk(), **limits, omega=(80.0, 250.0))
    np.testing.assert_allclose(by_default.amplitude, wide.amplitude, rtol=1e-9)


def test_the_default_range_of_a_mistuned_disk_has_the_resonances_of_all_blades() -> None:
    ring = disk(harmonic=1, engine_order=4).mistuned(np.linspace(-0.02, 0.02, 12))
    found = ss.damper_curve(ring, dof="3.tip", slip_force=[1.0], harmonics=1)
    low, high = found.settings.span
    free = ss.natural_frequencies(ring, range(12))
    assert low < free[0]
    assert high > ss.natural_frequencies(ring)[-1]
    whole = ss.damper_curve(ring, dof="3.tip", slip_force=[1.0], harmonics=1, omega=(100.0, 600.0))
    np.testing.assert_allclose(found.amplitude, whole.amplitude, rtol=1e-9)
    with pytest.raises(ss.ModelError, match="mode: 1; the structure has 1, counted from 0"):
        ss.damper_curve(ring, dof="3.tip", slip_force=[1.0], harmonics=1, mode=1)


def test_linear_limits_of_a_figure_are_those_of_the_harmonic_of_the_forces() -> None:
    limits = {"dof": "tip", "slip_force": [0.01, 0.1], "harmonics": 2, "omega": (180.0, 220.0)}
    ax = ss.damper_curve(disk(2e-4), **limits).plot()
    (free,) = (line for line in ax.get_lines() if "free" in str(line.get_label()))
    assert free.get_ydata()[0] == pytest.approx(1.0 / (2 * 2e-4 * 4e4 * 2.0), rel=0.01)


def blocks(damping: ss.ModalDamping | ss.Rayleigh, order: int, own: object) -> ss.BladedDisk:
    """Return a disk of masses between springs that are given as blocks."""
    blade = ss.Structure([[1.0]], [[4.1e5]], damping, dofs=["tip"])
    interface = ss.Interface([[-2e5]], damping=own)
    forces = [ss.Force("tip", 1.0)]
    return ss.BladedDisk(blade, 12, interface=interface, forces=forces, engine_order=order)


@pytest.mark.parametrize("order", [0, 1, 3, 6])
def test_waves_that_are_damped_otherwise_than_their_law_says_are_told(order: int) -> None:
    rayleigh = ss.Rayleigh(mass=0.1, stiffness=1e-5)
    model = blocks(ss.ModalDamping(0.01), order, None)
    mass, damping, stiffness = (one.real.item() for one in model.matrices_at(1))
    ratio = damping / (2.0 * np.sqrt(mass * stiffness))
    told = ss.forced_response(model, [90.0], 1).diagnostics
    told = [one for one in told if one.code == "wave-damping"]
    assert len(told) == (order != 3)
    assert all(one.data["ratio"] == pytest.approx(ratio) for one in told)
    of_both = ss.forced_response(blocks(rayleigh, order, rayleigh), [90.0], 1)
    assert "wave-damping" not in {one.code for one in of_both.diagnostics}


def test_modal_damping_of_a_sector_that_is_cut_is_refused_with_what_gives_its_ratio() -> None:
    stiffness = [[1.2e5, -1e5, 0.0], [-1e5, 2e5, -1e5], [0.0, -1e5, 1.2e5]]
    mass, dofs = np.diag([0.5, 1.0, 0.5]), ["left", "mid", "right"]
    modal = ss.Structure(mass, stiffness, ss.ModalDamping(0.01), dofs)
    told = r"join every sector to all others.*ss\.Rayleigh\(stiffness=2 \* ratio / omega\)"
    with pytest.raises(ss.ModelError, match=told):
        ss.cyclic_sector(modal, {"right": "left"})
    plain, joined = ss.cyclic_sector(ss.Structure(mass, stiffness, dofs=dofs), {"right": "left"})
    omega = ss.natural_frequencies(disk_of(plain, joined), nodal_diameter=2)[0]
    damped = ss.Structure(mass, stiffness, ss.Rayleigh(stiffness=2 * 0.01 / omega), dofs)
    m, c, k = disk_of(*ss.cyclic_sector(damped, {"right": "left"})).matrices_at(1)
    values, shapes = scipy.linalg.eigh(k, m)
    ratio = (shapes[:, 0].conj() @ c @ shapes[:, 0]).real / (2.0 * np.sqrt(values[0]))
    assert ratio == pytest.approx(0.01, rel=1e-10)


def disk_of(sector: ss.Structure, joined: ss.Interface) -> ss.BladedDisk:
    forces = [ss.Force("mid", 1.0)]
    return ss.BladedDisk(sector, 8, forces=forces, engine_order=2, interface=joined)


def test_a_crossing_at_a_computed_speed_is_one() -> None:
    random = np.random.default_rng(0)
    for _ in range(100):
        speeds = np.sort(random.uniform(0.0, 100.0, 6))
        mass = ss.Structure([[1.0]], [[(4.0 * speeds[2]) ** 2]], dofs=["a"])
        found = ss.campbell(ss.Model(mass, [], [ss.Force("a", 1.0)]), speed=speeds, orders=[4])
        assert [one.speed for one in found.crossings()] == pytest.approx([speeds[2]])


def test_figures_of_amplification_show_the_interval_of_what_was_not_found() -> None:
    model = disk(harmonic=1)
    study = ss.mistuning_study(
        model, 0.03, omega=(180.0, 460.0), patterns=60, harmonics=1, dofs=["tip"]
    )
    study.arrays.amplitude.flags.writeable = study.arrays.status.flags.writeable = True
    study.arrays.amplitude[0, 0, :3] = np.nan
    study.arrays.status[0, 0, :3] = Status.STALLED.code
    _, low, high = study.percentile("tip", 80.0, method="empirical")
    ax = study.plot_deviation("tip", percentile=80.0)
    ((ends,),) = (bars.lines[2][0].get_segments() for bars in ax.containers)
    np.testing.assert_allclose(ends[:, 1], [low, high])

"""Nonlinear modes against closed forms, other computations and an independent code."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss


def one_mass(*contacts, force=None, damping=2.0):
    """Return a mass of 1 kg on a spring of 1e4 N/m."""
    structure = ss.Structure(mass=[[1.0]], stiffness=[[1e4]], damping=[[damping]], dofs=["x"])
    return ss.Model(structure, contacts=contacts, forces=[] if force is None else [force])


JENKINS = ss.Jenkins("x", stiffness=4e3, slip_force=1.0)


def describing(amplitude, stiffness=4e3, limit=1.0):
    """Return the complex stiffness of a Jenkins element (Griffin 1980)."""
    onset = limit / stiffness
    if amplitude <= onset:
        return stiffness + 0j
    angle = np.arccos(1.0 - 2.0 * onset / amplitude)
    real = stiffness / np.pi * (angle - 0.5 * np.sin(2.0 * angle))
    work = 4.0 * limit * (amplitude - onset)
    return real + 1j * work / (np.pi * amplitude**2)


def chain(force=None):
    """Return three masses with two elements of one joint."""
    structure = ss.Structure(
        mass=np.diag([1.0, 0.5, 0.3]),
        stiffness=[[3e4, -1e4, 0.0], [-1e4, 2.5e4, -5e3], [0.0, -5e3, 2e4]],
        damping=ss.ModalDamping(0.003),
        dofs=["x", "y", "z"],
    )
    contacts = [
        ss.Jenkins("x", stiffness=4e3, slip_force=1.0),
        ss.Jenkins("y", "z", stiffness=2e3, slip_force=0.7),
    ]
    return ss.Model(structure, contacts=contacts, forces=[] if force is None else [force])


def wedge():
    """Return two blades and a wedge with the parameters of Balaji and Ferhatoglu (2025)."""
    stiffness = np.zeros((6, 6))
    blocks = [(1e6, -9e5), (4e5, -3e5), (1e6, -1e6)]
    for place, (own, other) in enumerate(blocks):
        stiffness[2 * place : 2 * place + 2, 2 * place : 2 * place + 2] = [
            [own, other],
            [other, own],
        ]
    structure = ss.Structure(
        mass=np.diag([10.0, 10.0, 10.0, 10.0, 0.1, 0.1]),
        stiffness=stiffness,
        damping=np.diag([20.0, 20.0, 20.0, 20.0, 0.0, 0.0]),
        dofs=["x1", "y1", "x2", "y2", "xD", "yD"],
    )
    cos, sin = np.cos(np.deg2rad(40.0)), np.sin(np.deg2rad(40.0))
    keys = {"friction": 0.6, "tangential_stiffness": 3e5, "normal_stiffness": 3e5}
    contacts = [
        ss.Coulomb(["xD", "yD"], other=["x1", "y1"], normal=[-sin, cos], **keys),
        ss.Coulomb(["xD", "yD"], other=["x2", "y2"], normal=[sin, cos], **keys),
    ]
    return ss.Model(structure, contacts=contacts, forces=[ss.Force("yD", 240.0, harmonic=0)])


def test_one_jenkins_element_has_its_closed_form():
    amplitudes = np.array([1e-5, 2.5e-4, 2.6e-4, 1e-3, 1e-2])
    mode = ss.nonlinear_modes(one_mass(JENKINS), mode=0, amplitude=amplitudes, harmonics=1)
    assert mode.amplitude.tolist() == pytest.approx(amplitudes.tolist(), rel=1e-14)
    for index, amplitude in enumerate(amplitudes):
        stiffness = describing(amplitude)
        omega = np.sqrt(1e4 + stiffness.real)
        ratio = (2.0 + stiffness.imag / omega) / (2.0 * omega)
        assert mode.omega[index] == pytest.approx(omega, rel=1e-9)
        assert mode.damping_ratio[index] == pytest.approx(ratio, rel=1e-9)
    assert mode.viscous_ratio == pytest.approx(1.0 / mode.omega, rel=1e-9)
    assert mode.dissipation((0, 0))[3] == pytest.approx(4.0 * (1e-3 - 2.5e-4), rel=1e-9)


def test_friction_work_is_the_friction_part_of_the_damping():
    mode = ss.nonlinear_modes(chain(), mode=1, amplitude=(1e-5, 1e-1), tolerance=1e-4)
    mass = mode.model.structure.mass
    series = mode.arrays.displacement
    orders = np.arange(series.shape[1]) ** 2
    kinetic = np.einsum("k,nki,ij,nkj->n", orders, series.conj(), mass, series).real
    work = sum(mode.dissipation((contact, 0)) for contact in range(2))
    friction = work / (2.0 * np.pi * mode.omega**2 * kinetic)
    assert friction == pytest.approx(mode.friction_ratio, rel=1e-6, abs=1e-9)
    assert mode.amplitude[0] == pytest.approx(1e-5)
    assert mode.amplitude[-1] == pytest.approx(1e-1)
    # From stuck to slipping natural frequency.
    stuck = ss.natural_frequencies(mode.model)[1]
    free = ss.natural_frequencies(mode.model, slipping=[(0, 0), (1, 0)])[1]
    # Damping of the free modes couples the stuck ones by a little.
    assert mode.omega[0] == pytest.approx(stuck, rel=1e-7)
    assert mode.omega[-1] == pytest.approx(free, rel=1e-3)


def test_two_blades_and_a_wedge():
    # From an independent code; where contacts slip both ways no residual traction is left.
    logs = np.array([-2.2, -2.0, -1.5])
    hertz = [43.135809, 42.639235, 42.198362]
    ratio = [0.03804438, 0.02785888, 0.01230350]
    mode = ss.nonlinear_modes(
        wedge(), mode=2, amplitude=10.0**logs, harmonics=5, residual="centred"
    )
    assert mode.omega / (2.0 * np.pi) == pytest.approx(hertz, rel=1e-4)
    assert mode.damping_ratio == pytest.approx(ratio, rel=1e-3)
    assert mode.linear_omega / (2.0 * np.pi) == pytest.approx(49.421406, rel=1e-8)
    held = ss.nonlinear_modes(
        wedge(), mode=2, amplitude=[10.0**-2.9, 10.0**-2.8], harmonics=5, residual=-200.0
    )
    # At -mu N nothing slips at first.
    assert held.damping_ratio[0] == pytest.approx(0.00321991, rel=1e-5)
    assert held.omega[1] / (2.0 * np.pi) == pytest.approx(49.187874, rel=1e-4)
    assert held.damping_ratio[1] == pytest.approx(0.01547973, rel=1e-3)


def test_bounds_over_residual_tractions():
    # -μN and its opposite, and none, of contact 1, which sticks up to lg a = -2.3
    logs = np.array([-2.9, -2.8, -2.7, -2.5, -2.3, -2.0])
    keys = {"mode": 2, "amplitude": 10.0**logs, "harmonics": 5}
    found = ss.nonlinear_modes(wedge(), residual="bounds", **keys)
    low, high = (found.omega_bounds / (2.0 * np.pi)).T
    least, most = found.damping_bounds.T
    # independently computed: 49.187874 Hz and .01547973 with -μN, 48.048205 Hz without
    assert high[1] == pytest.approx(49.187874, rel=1e-5)
    assert least[1] == pytest.approx(0.01547973, rel=1e-3)
    assert low[1] < 48.048205
    assert (high[:4] > 1.005 * low[:4]).all()
    assert high[5] == pytest.approx(low[5], rel=1e-6)
    for residual in (-60.0, -8.0, 0.0, 2.0, 45.0, "centred", "from_rest"):
        one = ss.nonlinear_modes(wedge(), residual=residual, **keys)
        ends = ((one.omega / (2.0 * np.pi), low, high), (one.damping_ratio, least, most))
        for value, below, above in ends:
            assert (value > below * (1.0 - 1e-6)).all()
            assert (value < above * (1.0 + 1e-6)).all()
    (told,) = [one for one in found.diagnostics if one.code == "bounds"]
    assert told.data["points"] in (4, 5)
    assert found.settings.residual == "from_rest"
    plain = ss.nonlinear_modes(wedge(), **keys)
    assert np.isnan(plain.omega_bounds).all()
    np.testing.assert_array_equal(plain.omega, found.omega)
    with pytest.raises(ss.ModelError, match="quasi-static"):
        ss.nonlinear_modes(wedge(), residual="bounds", method="quasi-static", **keys)
    whole = ss.nonlinear_modes(wedge(), mode=2, amplitude=(1e-3, 5e-3), residual="bounds")
    ax = whole.plot()
    assert [one.get_label() for one in ax.collections] == ["all residual tractions"]


def test_four_decades_of_a_wedge_are_followed():
    mode = ss.nonlinear_modes(
        wedge(), mode=2, amplitude=(1e-6, 1e-1), harmonics=5, residual="centred"
    )
    assert all(status.solved for status in mode.status)
    assert mode.amplitude[0] == pytest.approx(1e-6)
    assert mode.amplitude[-1] == pytest.approx(1e-1)
    assert mode.arrays.residual.max() < 1e-7
    assert (np.diff(np.log(mode.amplitude)) < 0.3).all()


def test_a_cubic_spring_stiffens():
    model = one_mass(ss.Cubic("x", stiffness=1e9), damping=0.0)
    mode = ss.nonlinear_modes(model, mode=0, amplitude=[1e-4, 1e-3, 1e-2], harmonics=1)
    expected = np.sqrt(1e4 + 0.75e9 * mode.amplitude**2)
    assert mode.omega == pytest.approx(expected, rel=1e-9)
    assert mode.damping_ratio == pytest.approx(0.0, abs=1e-12)


def test_a_stop_beyond_its_gap_has_the_frequency_of_its_exact_motion():
    # Far beyond the gap: half a period with the spring of the stop, half a period without.
    model = one_mass(ss.Stop("x", stiffness=3e4, gap=1e-4), damping=0.0)
    mode = ss.nonlinear_modes(model, mode=0, amplitude=[1e-5, 1.0])
    assert mode.omega[0] == pytest.approx(100.0, rel=1e-9)
    assert mode.omega[1] == pytest.approx(2.0 / (1.0 / 100.0 + 1.0 / 200.0), rel=1e-3)


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


def jointed(rng):
    """Return a random chain with contacts of all kinds, and a mode of it."""
    size = int(rng.integers(2, 7))
    springs = 10.0 ** rng.uniform(3.5, 4.5, size + 1)
    stiffness = np.diag(springs[:-1] + springs[1:])
    stiffness -= np.diag(springs[1:-1], 1) + np.diag(springs[1:-1], -1)
    dofs = [f"d{i}" for i in range(size)]
    structure = ss.Structure(
        mass=np.diag(rng.uniform(0.2, 2.0, size)),
        stiffness=stiffness,
        damping=ss.ModalDamping(rng.choice([0.0005, 0.003, 0.01])),
        dofs=dofs,
    )
    contacts = []
    for place in range(int(rng.integers(1, 5))):
        first = int(rng.integers(size))
        ends = [dofs[first], dofs[(first + 1 + int(rng.integers(size - 1))) % size]]
        spring, force = 10.0 ** rng.uniform(3.0, 4.5), 10.0 ** rng.uniform(-1.0, 1.0)
        at = ends[: int(rng.integers(1, 3))]
        angle = rng.uniform(0.0, np.pi)
        pad = {
            "normal": [-np.sin(angle), np.cos(angle)],
            "friction": rng.uniform(0.1, 0.8),
            "tangential_stiffness": spring,
            "normal_stiffness": 10.0 ** rng.uniform(3.0, 4.5),
            "name": f"c{place}",
        }
        kinds = [
            ss.Jenkins(*at, stiffness=spring, slip_force=force, name=f"c{place}"),
            ss.Stop(*at, stiffness=spring, gap=force / spring, name=f"c{place}"),
            ss.Coulomb(ends, preload=force, **pad),
            ss.Coulomb(ends, gap=force / spring * rng.uniform(-1.0, 1.0), **pad),
        ]
        contacts.append(kinds[rng.integers(4)])
    loaded = [ss.Force(dofs[0], float(10.0 ** rng.uniform(-1.0, 1.0)), harmonic=0)]
    model = ss.Model(structure, contacts=contacts, forces=loaded if rng.random() < 0.4 else [])
    return model, int(rng.integers(size))


def test_corners_of_random_joints_are_passed():
    for seed in range(40):
        model, mode = jointed(np.random.default_rng([11, seed]))
        amplitudes = np.geomspace(1e-6, 1e-2, 9)
        branch = ss.nonlinear_modes(model, mode=mode, amplitude=amplitudes, harmonics=5)
        assert "mode-not-reached" not in {one.code for one in branch.diagnostics}, seed
        assert all(status.solved for status in branch.status), seed
        assert branch.amplitude == pytest.approx(amplitudes, rel=1e-12)
        assert branch.arrays.residual.max() < 1e-6


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


def bar(count):
    """Return a clamped bar on Jenkins elements of all slip forces."""
    step = 1.0 / count
    stiff = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    stiff[-1, -1] = 1.0
    limits = np.geomspace(3.0, 3e4, count)[np.random.default_rng(1).permutation(count)]
    names = [f"n{place}" for place in range(count)]
    structure = ss.Structure(
        8.0 * step * np.eye(count), 4e5 / step * stiff, ss.ModalDamping(0.001), names
    )
    contacts = [
        ss.Jenkins(name, stiffness=6e5 * step, slip_force=limit * step)
        for name, limit in zip(names, limits, strict=True)
    ]
    return ss.Model(structure, contacts)


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


def test_decaying_vibration_has_the_same_frequency_and_damping():
    model = one_mass(ss.Jenkins("x", stiffness=300.0, slip_force=0.1), damping=0.2)
    free = ss.transient(model, omega=100.0, periods=60, scheme="exact", start={"x": 3e-3})
    mode = ss.nonlinear_modes(model, mode=0, amplitude=(1e-4, 5e-3), tolerance=1e-5)
    t, x = free.time, free.displacement("x")
    top = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])) + 1
    peaks = []
    for at in top:
        curve = np.polyfit(t[at - 1 : at + 2] - t[at], x[at - 1 : at + 2], 2)
        place = -0.5 * curve[1] / curve[0]
        peaks.append((t[at] + place, np.polyval(curve, place)))
    times, heights = np.array(peaks).T
    lapse, height = times[10:20:9], heights[10:20:9]
    omega = 2.0 * np.pi * 9 / (lapse[1] - lapse[0])
    decay = np.log(height[0] / height[1]) / (2.0 * np.pi * 9)
    log = np.log(np.sqrt(height[0] * height[1]))
    known = np.log(mode.displacement_amplitude("x"))
    assert omega == pytest.approx(np.interp(log, known, mode.omega), rel=1e-3)
    assert decay == pytest.approx(np.interp(log, known, mode.damping_ratio), rel=1e-2)


def test_limit_cycles_are_where_the_damping_vanishes():
    negative = ss.Rayleigh(mass=-1.0)
    model = one_mass(JENKINS)
    cycles = ss.limit_cycles(model, negative, ratio=[4.0], harmonics=15)
    mode = ss.nonlinear_modes(model, mode=0, amplitude=(1e-4, 1e-1), harmonics=15)
    excess = mode.damping_ratio * 2.0 * mode.omega - 4.0
    log = np.log(mode.amplitude)
    places = np.flatnonzero(excess[:-1] * excess[1:] < 0.0)
    assert places.size == cycles.omega.size == 2
    for place, fundamental in zip(places, cycles.amplitude("x", "fundamental"), strict=True):
        root = brentq(lambda one: np.interp(one, log, excess), log[place], log[place + 1])
        exact = ss.nonlinear_modes(
            model, mode=0, amplitude=np.exp(root + np.array([-1e-2, 0.0, 1e-2])), harmonics=15
        )
        rest = exact.damping_ratio * 2.0 * exact.omega - 4.0
        slope = np.polyfit(np.log(exact.amplitude), rest, 2)
        roots = np.roots(slope)
        nearest = roots[np.argmin(np.abs(roots - root))].real
        assert np.exp(nearest) == pytest.approx(fundamental, rel=1e-3)


def test_a_tuned_disk_has_modes_by_nodal_diameter():
    blade = ss.Structure(mass=np.eye(2), stiffness=[[2e4, -1e4], [-1e4, 1e4]], dofs=["root", "tip"])
    disk = ss.BladedDisk(
        blade,
        sectors=6,
        couplings=[ss.Coupling("root", stiffness=5e3)],
        contacts=[ss.Jenkins("tip", stiffness=2e3, slip_force=1.0)],
        engine_order=1,
    )
    found = [
        ss.nonlinear_modes(disk, mode=0, amplitude=[1e-6, 1e-2], nodal_diameter=d).omega
        for d in (0, 1, 2, 3)
    ]
    stuck = np.array([[2e4, -1e4], [-1e4, 1.2e4]])
    for diameter, omega in enumerate(found):
        coupled = stuck + np.diag([5e3 * (2 - 2 * np.cos(2 * np.pi * diameter / 6)), 0.0])
        assert omega[0] == pytest.approx(np.sqrt(np.linalg.eigvalsh(coupled)[0]), rel=1e-9)
        assert omega[1] < omega[0]


def test_results_are_kept(tmp_path):
    mode = ss.nonlinear_modes(chain(), mode=0, amplitude=(1e-5, 1e-2))
    mode.save(tmp_path / "mode.nc")
    again = ss.load(tmp_path / "mode.nc")
    assert np.array_equal(again.omega, mode.omega)
    assert np.array_equal(again.amplitude, mode.amplitude)
    assert again.diagnostics == mode.diagnostics
    assert mode.plot().get_xscale() == "log"
    assert mode.to_dataset()["modal_amplitude"].attrs["units"] == "m kg^(1/2)"


def test_what_does_not_exist_is_refused():
    with pytest.raises(ss.ModelError, match=r"mode = 3: the structure has modes 0 to 2"):
        ss.nonlinear_modes(chain(), mode=3, amplitude=[1e-3])
    with pytest.raises(ss.ModelError, match="nodal_diameter"):
        ss.nonlinear_modes(chain(), mode=0, amplitude=[1e-3], nodal_diameter=1)
    mode = ss.nonlinear_modes(chain(), mode=0, amplitude=[1e-3, 1e-2])
    with pytest.raises(ss.ModelError, match="forces"):
        mode.forced_response([ss.Force("x", 1.0, harmonic=3)], [100.0])


def test_the_quasi_static_mode_of_one_jenkins_element_has_its_closed_form():
    amplitudes = np.array([1e-5, 2.6e-4, 1e-3, 1e-2])
    mode = ss.nonlinear_modes(one_mass(JENKINS), amplitude=amplitudes, method="quasi-static")
    squared = 1e4 + np.minimum(4e3, 1.0 / amplitudes)
    lost = 4.0 * np.maximum(amplitudes - 2.5e-4, 0.0)
    assert mode.omega == pytest.approx(np.sqrt(squared), rel=1e-9)
    assert mode.dissipation((0, 0)) == pytest.approx(lost, rel=1e-9, abs=1e-15)
    friction = lost / (2.0 * np.pi * squared * amplitudes**2)
    assert mode.friction_ratio == pytest.approx(friction, rel=1e-8, abs=1e-12)
    assert mode.viscous_ratio == pytest.approx(1.0 / mode.omega, rel=1e-9)


@pytest.mark.parametrize(
    "law",
    [
        ss.Jenkins("x", stiffness=100.0, slip_force=0.1),
        ss.Iwan("x", stiffness=100.0, slip_force=0.1, chi=-0.5),
    ],
)
def test_a_quasi_static_mode_with_light_friction_is_the_periodic_one(law):
    # Frequencies of a secant and of a fundamental differ by less than the whole softening.
    amplitudes = np.geomspace(2e-4, 2e-2, 7)
    static, periodic = (
        ss.nonlinear_modes(one_mass(law), amplitude=amplitudes, method=method)
        for method in ("quasi-static", "periodic")
    )
    assert static.omega == pytest.approx(periodic.omega, rel=1e-3)
    assert static.damping_ratio == pytest.approx(periodic.damping_ratio, rel=5e-3)


def test_a_quasi_static_mode_of_several_contacts_loses_what_they_do():
    mode = ss.nonlinear_modes(chain(), amplitude=(1e-5, 1e-2), method="quasi-static")
    work = mode.dissipation((0, 0)) + mode.dissipation((1, 0))
    friction = work / (2.0 * np.pi * mode.omega**2 * mode.amplitude**2)
    # Springs give back what the load has put into them.
    assert friction == pytest.approx(mode.friction_ratio, rel=1e-7, abs=1e-12)
    stuck = ss.natural_frequencies(mode.model)[0]
    assert mode.omega[0] == pytest.approx(stuck, rel=1e-9)


def test_phase_resonance_is_at_quadrature_of_the_direct_response():
    model = chain(ss.Force("x", 0.3))
    amplitudes = np.geomspace(1e-4, 1e-2, 5)
    mode = ss.nonlinear_modes(model, amplitude=amplitudes, harmonics=9, method="phase-resonance")
    for index, level in enumerate(mode.force_level):
        force = ss.Force("x", 0.3 * float(level))
        direct = ss.forced_response(chain(force), [mode.omega[index]], harmonics=9)
        series = direct.coefficients("x")[0]
        assert np.angle(series[1]) == pytest.approx(-0.5 * np.pi, abs=1e-5)
        assert np.abs(series) == pytest.approx(np.abs(mode.coefficients("x")[index]), rel=1e-5)


def test_phase_resonance_of_one_mass_is_its_mode():
    # Its shape cannot change, and no harmonic tells force and damping apart.
    amplitudes = np.geomspace(1e-4, 1e-2, 5)
    keys = {"amplitude": amplitudes, "harmonics": 1}
    mode = ss.nonlinear_modes(one_mass(JENKINS), **keys)
    model = one_mass(JENKINS, force=ss.Force("x", 2.0))
    driven = ss.nonlinear_modes(model, method="phase-resonance", **keys)
    assert driven.omega == pytest.approx(mode.omega, rel=1e-9)
    assert driven.damping_ratio == pytest.approx(mode.damping_ratio, rel=1e-8)
    force = 2.0 * mode.damping_ratio * mode.omega**2 * amplitudes
    assert 2.0 * driven.force_level == pytest.approx(force, rel=1e-8)
    assert np.isnan(mode.force_level).all()


def test_true_maxima_are_beside_quadrature_where_damping_is_strong():
    for stiffness, slip, light in ((300.0, 0.1, True), (2e4, 5.0, False)):
        joint = ss.Jenkins("x", stiffness=stiffness, slip_force=slip)
        model = one_mass(joint, force=ss.Force("x", 1.0), damping=0.2)
        amplitudes = 3.0 * slip / stiffness * np.array([1.0, 2.0])
        keys = {"amplitude": amplitudes, "tolerance": 1e-5}
        mode = ss.nonlinear_modes(model, method="phase-resonance", **keys)
        omega, height = mode.direct_peaks("x")
        quadrature = mode.displacement_amplitude("x")
        assert (height > quadrature * (1.0 - 1e-5)).all()
        beside = np.abs(omega / mode.omega - 1.0)
        assert (mode.damping_ratio < 0.011).all() if light else (mode.damping_ratio > 0.1).all()
        assert (beside < 2e-5).all() if light else (beside > 2e-4).all()
    with pytest.raises(ss.ModelError, match="phase-resonance"):
        ss.nonlinear_modes(one_mass(joint), amplitude=amplitudes).direct_peaks("x")


def test_methods_say_what_they_do_not_take():
    with pytest.raises(ss.ModelError, match="give forces of harmonic 1"):
        ss.nonlinear_modes(chain(), amplitude=[1e-3], method="phase-resonance")
    force = ss.Force("x", 1.0, harmonic=3)
    with pytest.raises(ss.ModelError, match="give forces of harmonic 1"):
        ss.nonlinear_modes(chain(force), amplitude=[1e-3], method="phase-resonance")
    with pytest.raises(ss.ModelError, match="method"):
        ss.nonlinear_modes(chain(), amplitude=[1e-3], method="static")

"""Nonlinear modes against closed forms, other computations and an independent code."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from joints import JENKINS, chain, describing, one_mass, wedge


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


TABLE = [  # lg a, f [Hz] and ζ of an independent code, whose contact 1 sticks up to -2.5
    (-2.9, 49.284475, 0.01192553),
    (-2.8, 48.048205, 0.03795028),
    (-2.7, 46.700724, 0.05025316),
    (-2.6, 45.536036, 0.05402437),
    (-2.5, 44.644986, 0.05236346),
]


@pytest.mark.parametrize(("log", "hertz", "ratio"), TABLE)
def test_a_wedge_whose_contact_sticks_with_the_traction_of_another_code(log, hertz, ratio):
    # That code marches from zero traction, one of 256 samples before y1 passes zero upwards. The
    # traction at rest that leads to zero at this instant makes the same motion.
    model = wedge()
    rows = np.vstack([contact.rows(model.structure) for contact in model.contacts])
    load = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 240.0])

    def computed(residual):
        mode = ss.nonlinear_modes(
            model, mode=2, amplitude=[10.0**log], harmonics=5, residual=residual
        )
        series = mode.arrays.displacement[0]
        mean, *_ = np.linalg.lstsq(
            rows.T, load - model.structure.stiffness @ series[0].real, rcond=None
        )
        instant = -0.5 * np.pi - np.angle(series[1, 1]) - 2.0 * np.pi / 256
        orders = np.arange(1, series.shape[0])
        swing = (rows[0] @ series[1:].T * np.exp(1j * instant * orders)).real.sum()
        return mode, mean[0] + 3e5 * swing

    held = brentq(lambda residual: computed(residual)[1], 0.0, 20.0, xtol=1e-6)
    mode, _ = computed(held)
    assert mode.omega[0] / (2.0 * np.pi) == pytest.approx(hertz, rel=1e-5)
    assert mode.damping_ratio[0] == pytest.approx(ratio, rel=2e-4)


@pytest.mark.slow
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


@pytest.mark.parametrize(("count", "insets"), [(5, 3), (40, 0)])
def test_shapes_are_drawn_of_few_degrees_of_freedom(count, insets):
    stiffness = 1e4 * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    chain = ss.Structure(np.eye(count), stiffness, dofs=[f"x{n}" for n in range(count)])
    model = ss.Model(chain, [ss.Jenkins("x0", stiffness=1e3, slip_force=1.0)])
    modes = ss.nonlinear_modes(model, amplitude=[1e-3], harmonics=1)
    ax = modes.plot(damping=False)
    assert sum(one.get_title() == "shape" for one in ax.child_axes) == insets


def test_many_amplitudes_are_no_hard_place() -> None:
    """Each takes some evaluations of its own, which count for no step of the branch."""
    wanted = np.geomspace(1e-6, 1e-2, 1500)
    modes = ss.nonlinear_modes(ss.reference.snecma_beam(), amplitude=wanted, harmonics=1)
    assert (modes.arrays.status == 0).all()
    assert not [one for one in modes.diagnostics if one.severity != "note"]

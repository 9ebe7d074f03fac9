"""Figures of one point: waveforms, loops and slip."""

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import plot
from stickslip.cli.drawing import Wanted
from stickslip.plot.style import prefixed
from stickslip.reference import snecma_beam

GRID = np.linspace(150.0, 250.0, 60)


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_waveform(frf, ax):
    plot.waveform(frf, "tip", 20, ax=ax, length_unit="mm", samples=64)
    (wave,) = ax.lines
    np.testing.assert_allclose(wave.get_ydata()[:-1], 1e3 * frf.waveform("tip", 20, 64))
    assert wave.get_ydata()[0] == wave.get_ydata()[-1]
    np.testing.assert_allclose(wave.get_xdata(), np.arange(65) / 64)
    assert ax.get_xlabel() == "time over period t/T"
    assert ax.get_ylabel() == "displacement of tip [mm]"
    assert ax.get_title() == f"ω = {GRID[20]:.5g} rad/s"


def test_waveforms(frf, ax):
    plot.waveform(frf, ["tip", "mode"], -1, ax=ax)
    assert legend(ax) == ["tip", "mode"]
    assert ax.get_ylabel() == "displacement [µm]"


def test_hysteresis(frf, ax):
    index = frf.index(195.0)
    plot.hysteresis(frf, 0, index, ax=ax, length_unit="um", samples=4096)
    loop, *limits = ax.lines
    u, f = loop.get_data()
    assert (u[0], f[0]) == (u[-1], f[-1])
    area = 0.5e-6 * np.sum((f[1:] + f[:-1]) * np.diff(u))
    assert area == pytest.approx(frf.dissipation((0, 0))[index], rel=1e-4)
    assert sorted(line.get_ydata()[0] for line in limits) == [-246.048, 246.048]
    assert ax.get_xlabel() == "relative displacement u [µm]"
    assert ax.get_ylabel() == "contact force f [N]"
    lost = prefixed(frf.dissipation((0, 0))[index], "J")
    assert ax.get_title() == f"jenkins at ω = {frf.omega[index]:.5g} rad/s: {lost} per cycle"


def test_hysteresis_loops(frf, ax):
    chosen = [frf.index(omega) for omega in (155.0, 180.0, 200.0)]
    plot.hysteresis(frf, ("jenkins", 0), np.array(chosen), ax=ax)
    assert ax.get_title() == "jenkins[0]"
    texts = legend(ax)
    assert texts[0] == f"ω = {frf.omega[chosen[0]]:.5g} rad/s: sticks"
    assert all(text.endswith("per cycle") for text in texts[1:])


def test_slip(frf, ax):
    plot.slip(frf, ax=ax, omega_unit="Hz")
    (share,) = ax.lines
    np.testing.assert_array_equal(share.get_ydata(), frf.slip_fraction((0, 0)))
    assert ax.get_title() == "jenkins"
    assert ax.get_ylim() == (-0.03, 1.03)
    assert ax.get_xlabel() == "frequency [Hz]"


def test_slip_of_several(ax):
    single = snecma_beam()
    contacts = [
        ss.Jenkins(dof, stiffness=1e6, slip_force=20.0, name=dof) for dof in ("damper", "tip")
    ]
    model = ss.Model(single.structure, contacts, single.forces)
    frf = ss.forced_response(model, GRID[:5], 5)
    plot.slip(frf, ax=ax)
    assert legend(ax) == ["damper", "tip"]
    plot.slip(frf, ("tip", 0), ax=(other := Figure().add_subplot()))
    assert other.get_title() == "tip[0]"


def test_nothing_to_draw(ax):
    frf = ss.forced_response(snecma_beam(), GRID, 9, max_iterations=1)
    failed = int(np.flatnonzero(~frf.converged)[0])
    for draw in (plot.waveform, plot.hysteresis):
        what = "tip" if draw is plot.waveform else 0
        with pytest.raises(ss.ModelError, match=r"has no solution to draw \(stalled\)"):
            draw(frf, what, failed, ax=ax)
    with pytest.raises(ss.ModelError, match="index: empty"):
        plot.hysteresis(frf, 0, [], ax=ax)
    with pytest.raises(ss.ModelError, match="dof: empty"):
        plot.waveform(frf, [], 0, ax=ax)
    linear = ss.forced_response(ss.Model(snecma_beam().structure), [1.0], 1)
    with pytest.raises(ss.ModelError, match="the model has none, so that nothing slips"):
        plot.slip(linear, ax=ax)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0 J"),
        (0.0761, "76.1 mJ"),
        (3.2e-5, "32 µJ"),
        (1.0, "1 J"),
        (4567.0, "4.57 kJ"),
        (1e-15, "1e-06 nJ"),
        (np.nan, "nan J"),
    ],
)
def test_prefixes(value, text):
    assert prefixed(value, "J") == text


def _block(**keys):
    values = {"normal": [0, 0, 1], "tangential_stiffness": 1e5, "normal_stiffness": 1e5} | keys
    structure = ss.Structure(np.eye(3), 1e6 * np.eye(3), ss.ModalDamping(0.05), ["x", "y", "z"])
    return ss.Model(structure, [ss.Coulomb(["x", "y", "z"], **values)], [ss.Force("x", 2.0)])


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"friction": 0.3, "gap": 1e-3}, "open"),
        ({"friction": 0.0, "preload": 10.0}, "slips without friction"),
        ({"friction": 0.3, "preload": 10.0}, "sticks"),
    ],
)
def test_a_loop_without_work_says_why(ax, keys, said):
    plot.hysteresis(ss.forced_response(_block(**keys), [110.0], 3), 0, 0, ax=ax)
    assert legend(ax) == [f"t1, {said}", f"t2, {said}"]


def test_a_spring_does_not_stick(ax):
    structure = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.05), ["x"])
    stop = ss.Stop("x", stiffness=2e4, gap=1e-3)
    model = ss.Model(structure, [stop], [ss.Force("x", 2.0)])
    plot.hysteresis(ss.forced_response(model, [110.0], 9), 0, 0, ax=ax)
    assert ax.get_title() == "stop at ω = 110 rad/s: elastic"


def test_the_sum_of_forces_that_does_not_vanish_is_shown():
    structure = ss.Structure(np.eye(2), 1e6 * np.eye(2), ss.ModalDamping(0.05), ["x", "y"])
    held = ss.StructuralDamper(["x", "y"], stiffness=np.diag([1e5, 2e5]), slip_forces=[1.0, 1.0])
    model = ss.Model(structure, [held], [ss.Force("x", 200.0), ss.Force("y", 100.0)])
    *_, whole = plot.contact_forces(ss.forced_response(model, [900.0], 9), 0, 0)
    low, high = whole.get_ylim()
    largest = np.abs(whole.lines[0].get_ydata()).max()
    assert largest > 1.0
    assert low < -largest < largest < high
    plt.close("all")


def test_what_is_shaded_dotted_or_a_line_has_a_name(frf, fitted):
    slipping = int(np.argmax(frf.slip_fraction(0)))
    try:
        assert legend(plot.contact_forces(frf, 0, slipping)[0]) == [
            "stuck, linear",
            "force",
            "slips",
        ]
        assert legend(plot.fit(fitted)) == ["1: tip", "1: tip, predicted"]
        assert "2 x scatter of" in legend(plot.fit_residuals(fitted))[1]
        assert plot.fit_intervals(fitted).get_xlabel().startswith("95 % interval")
        modes = ss.nonlinear_modes(snecma_beam(), amplitude=[1e-4, 1e-3], harmonics=1)
        assert legend(plot.mode_damping(modes)) == ["mode 0", "mode 0, viscous part"]
    finally:
        plt.close("all")


@pytest.fixture(scope="module")
def fitted():
    amplitude = ss.forced_response(snecma_beam(), GRID, 1).amplitude("tip")
    measured = ss.Measurement(GRID, "tip", amplitude, relative_noise=0.02)
    return ss.fit(snecma_beam(), measured, parameters={"slip_force": (10.0, 1e3)}, harmonics=1)


def test_springs_have_no_share_of_slip(ax):
    model = ss.Model(
        snecma_beam().structure, [ss.Cubic("tip", stiffness=1e6)], [ss.Force("tip", 1.0)]
    )
    frf = ss.forced_response(model, GRID, 1)
    with pytest.raises(ss.ModelError, match="springs, which neither slip nor open"):
        plot.slip(frf, ax=ax)


def test_a_share_that_is_open_is_said_beside_the_axis(ax):
    pad = ss.Coulomb(
        ["damper", "tip"],
        normal=[0.0, 1.0],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=1e4,
        preload=0.1,
    )
    model = ss.Model(snecma_beam().structure, [pad], [ss.Force("tip", 20.0)])
    frf = ss.forced_response(model, [140.0, 150.0], 3)
    assert (frf.open_fraction(0) > 0.0).any()
    assert "open" in plot.slip(frf, ax=ax).get_ylabel()


def test_the_error_of_a_single_point_is_seen(ax):
    frf = ss.forced_response(snecma_beam(), [187.0], 3)
    plot.curves(frf, "tip", ax=ax)
    (bar,) = (one for one in ax.collections if one.get_label() == "estimated truncation error")
    (((_, low), (_, high)),) = bar.get_segments()
    assert low < frf.amplitude("tip")[0] < high


@pytest.mark.parametrize(("unit", "symbol"), [("Hz", "f"), ("rpm", "n")])
def test_titles_have_the_unit_that_is_asked_for(frf, ax, unit, symbol):
    index = frf.index(195.0)
    factor = {"Hz": 0.5, "rpm": 30.0}[unit] / np.pi
    said = f"{symbol} = {factor * frf.omega[index]:.5g} {unit}"
    plot.waveform(frf, "tip", index, ax=ax, omega_unit=unit)
    assert ax.get_title() == said
    plot.hysteresis(frf, 0, index, ax=(loop := Figure().add_subplot()), omega_unit=unit)
    assert f" at {said}: " in loop.get_title()
    plot.events(frf, index, ax=(strips := Figure().add_subplot()), omega_unit=unit)
    assert strips.get_title().startswith(f"{said}: ")
    axes = plot.contact_forces(frf, 0, index, omega_unit=unit)
    assert axes[0].get_title(loc="left") == f"jenkins, {said}"
    plt.close(axes[0].figure)


def test_the_command_gives_titles_the_unit_of_its_axes(frf):
    for picture, dofs, place in (("waveform", ["tip"], "f = "), ("loop", None, "jenkins at f = ")):
        wanted = Wanted(dofs, omega_unit="Hz", log=True, per_force=False, contact=None)
        _, (panel,) = wanted.picture({picture: "31 Hz"}, [("beam", frf)])
        one = panel(ax=Figure().add_subplot())
        assert one.get_title().startswith(place)
        assert " Hz" in one.get_title()

"""Figures of exact orbits, transients and certificates show what is meant, and are drawn."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import plot
from stickslip.reference import beam_pair, snecma_beam


@pytest.fixture(scope="module")
def exact():
    return ss.exact_response(snecma_beam(25.0), np.linspace(150.0, 300.0, 31))


@pytest.fixture(scope="module")
def run():
    return ss.transient(snecma_beam(), 170.0, 30)


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


# ---------------------------------------------------------------------------------- orbits


def test_multipliers(exact, ax):
    plot.multipliers(exact, ax=ax, omega_unit="Hz")
    circle, hollow = ax.lines
    np.testing.assert_allclose(np.hypot(*circle.get_data()), 1.0)
    np.testing.assert_allclose(hollow.get_data()[0], 1.0, atol=1e-9)
    (cloud,) = ax.collections
    count = int(exact.multipliers.size - exact.neutral.sum())
    assert len(cloud.get_offsets()) == count
    assert hollow.get_data()[0].size == exact.neutral.sum() > 0
    assert ax.figure.axes[-1].get_ylabel() == "frequency [Hz]"
    plot.multipliers(exact, index=exact.index(200.0), ax=(one := Figure().add_subplot()))
    np.testing.assert_allclose(
        np.sort_complex([complex(*point) for point in one.collections[0].get_offsets()]),
        np.sort_complex(exact.multipliers[exact.index(200.0)]),
    )
    assert one.get_title() == "ω = 200 rad/s"


def test_events_strip(exact, ax):
    index = exact.index(200.0)
    plot.events(exact, index, ax=ax)
    assert ax.get_title() == "ω = 200 rad/s: 12 events per period"
    assert [text.get_text() for text in ax.get_yticklabels()] == ["jenkins"]
    assert set(legend(ax)) == {"stuck", "slips forward", "slips backward"}
    lengths = {}
    for strip in ax.collections:
        for path in strip.get_paths():
            left, right = path.vertices[:, 0].min(), path.vertices[:, 0].max()
            colour = tuple(strip.get_facecolor()[0])
            lengths[colour] = lengths.get(colour, 0.0) + right - left
    assert sum(lengths.values()) == pytest.approx(1.0)
    stuck = mpl.colors.to_rgba("0.85")
    share = exact.slip_fraction((0, 0))[index]
    assert lengths[stuck] == pytest.approx(1.0 - share, rel=1e-9)


def test_events_of_several_contacts(ax):
    exact = ss.exact_response(beam_pair(), [200.0])
    plot.events(exact, 0, ax=ax)
    assert len(ax.get_yticks()) == 3
    stuck = ss.exact_response(snecma_beam(0.5), [300.0])
    plot.events(stuck, 0, ax=(other := Figure().add_subplot()))
    assert "0 events" in other.get_title()


def test_orbits_in_the_figures_of_forced_responses(exact, ax):
    plot.curves(exact, "tip", ax=ax)
    assert not any("not solved" in text for text in legend(ax))
    balance = ss.forced_response(exact.model, exact.omega, 5)
    plot.curves([exact, balance], "tip", ax=(both := Figure().add_subplot()))
    assert legend(both)[-2:] == ["exact", "H = 5"]
    plot.waveform(exact, "tip", 10, ax=(wave := Figure().add_subplot()))
    np.testing.assert_array_equal(wave.lines[0].get_ydata()[:-1], exact.waveform("tip", 10, 512))
    plot.hysteresis(exact, 0, 10, ax=(loop := Figure().add_subplot()))
    assert np.abs(loop.lines[0].get_ydata()).max() == 246.048


# ---------------------------------------------------------------------------------- certificates


@pytest.mark.slow
def test_certificate_is_marked(ax):
    frf = ss.forced_response(snecma_beam(31.475), np.linspace(150.0, 200.0, 41), 15)
    certified = ss.certify(frf, 9)
    plot.curves(certified, "tip", ax=ax, length_unit="mm", stuck=False, free=False)
    (marks,) = [line for line in ax.lines if line.get_marker() == "D"]
    certificate = certified.certificate
    column = certificate.column("tip")
    np.testing.assert_array_equal(marks.get_xdata(), certificate.omega)
    np.testing.assert_allclose(marks.get_ydata(), 1e3 * certificate.amplitude[:, column])
    bars = [one for one in ax.collections if len(one.get_paths()) == 9]
    ends = np.array([path.vertices[:, 1] for path in bars[0].get_paths()])
    np.testing.assert_allclose(
        ends[:, 1] - ends[:, 0], 1e3 * certificate.error[:, column], atol=1e-12
    )
    largest = np.abs(certificate.relative[:, column]).max()
    assert f"exact (error ≤ {largest:.2g})" in legend(ax)
    plot.curves(certified, "tip", ax=(bare := Figure().add_subplot()), measure="max")
    assert not [line for line in bare.lines if line.get_marker() == "D"]
    only = ss.certify(frf, 3, dofs="mode")
    plot.curves(only, "tip", ax=(other := Figure().add_subplot()))
    assert not [line for line in other.lines if line.get_marker() == "D"]


# ---------------------------------------------------------------------------------- transients


def test_history(run, ax):
    plot.history(run, ["tip", "damper"], ax=ax, length_unit="um", last=2)
    first, _ = ax.lines
    assert first.get_xdata().size == 2 * 128 + 1
    np.testing.assert_allclose(first.get_ydata(), 1e6 * run.displacement("tip")[-257:])
    assert legend(ax) == ["tip", "damper"]
    assert ax.get_ylabel() == "displacement [µm]"
    assert ax.get_title() == "ω = 170 rad/s, completed"
    plot.history(run, "tip", ax=(other := Figure().add_subplot()), omega_unit="Hz")
    assert other.get_title() == f"f = {85.0 / np.pi:.5g} Hz, completed"


def test_contact_history(run, ax):
    plot.contact_history(run, "jenkins", ax=ax)
    force, *limits = ax.lines
    np.testing.assert_array_equal(force.get_ydata(), run.contact_force((0, 0)))
    assert sorted(line.get_ydata()[0] for line in limits) == [-246.048, 246.048]


def test_phase_plane(run, ax):
    plot.phase(run, "tip", ax=ax, last=3)
    motion, sections = ax.lines
    np.testing.assert_array_equal(motion.get_ydata(), run.velocity("tip")[-385:])
    assert sections.get_xdata().size == 4
    assert ax.get_ylabel() == "velocity of tip [mm/s]"


def test_poincare_section(run, ax):
    plot.poincare(run, "tip", ax=ax, skip=5, length_unit="mm")
    (cloud,) = ax.collections
    x, v = run.poincare("tip")
    np.testing.assert_allclose(cloud.get_offsets(), 1e3 * np.stack([x, v], axis=1)[5:])
    assert cloud.get_array().tolist() == list(range(5, 31))


def test_spectrum(ax):
    run = ss.transient(snecma_beam(), 170.0, 30, samples=16)
    plot.spectrum(run, "tip", ax=ax, last=8, omega_unit="rad/s")
    *marks, line = ax.lines
    found = run.spectrum("tip", last=8)
    np.testing.assert_allclose(line.get_xdata(), 2 * np.pi * found.frequency)
    assert line.get_xdata()[np.nanargmax(line.get_ydata())] == pytest.approx(170.0)
    assert [mark.get_xdata()[0] for mark in marks][:2] == pytest.approx([170.0, 340.0])
    assert len(marks) == 8
    assert ax.get_yscale() == "log"
    assert ax.get_ylabel() == "power spectral density of tip [m²/Hz]"


def test_what_cannot_be_drawn(exact, run, ax):
    frf = ss.forced_response(snecma_beam(), [170.0], 3)
    with pytest.raises(ss.ModelError, match=r"result: .* is not an ExactResponse"):
        plot.multipliers(frf, ax=ax)
    for draw, what in (
        (plot.history, ["tip"]),
        (plot.contact_history, [0]),
        (plot.phase, ["tip"]),
        (plot.poincare, ["tip"]),
        (plot.spectrum, ["tip"]),
    ):
        with pytest.raises(ss.ModelError, match=r"result: .* is not a Transient"):
            draw(frf, *what, ax=ax)
    for draw, message in (
        (lambda: plot.multipliers(exact, index=[], ax=ax), "index: empty"),
        (lambda: plot.multipliers(exact, index=99, ax=ax), "index: 99; there are 31 points"),
        (lambda: plot.multipliers(exact, omega_unit="kHz", ax=ax), "omega_unit: unknown"),
        (lambda: plot.history(run, "tpi", ax=ax), "unknown dof 'tpi'"),
        (lambda: plot.history(run, "tip", last=31, ax=ax), "last: 31 is too large"),
        (lambda: plot.poincare(run, "tip", skip=31, ax=ax), "skip: 31 is too large"),
        (lambda: plot.contact_history(run, "x", ax=ax), "unknown contact 'x'"),
        (lambda: plot.curves(run, "tip", ax=ax), "results: .* is not a ForcedResponse"),
    ):
        with pytest.raises(ss.ModelError, match=message):
            draw()
    linear = ss.exact_response(ss.Model(snecma_beam().structure), [100.0])
    with pytest.raises(ss.ModelError, match="the model has no contact"):
        plot.events(linear, 0, ax=ax)


@pytest.mark.slow
def test_methods_make_figures(exact, run, tmp_path):
    made = [
        exact.plot("tip"),
        exact.plot_multipliers(),
        exact.plot_events(10),
        run.plot("tip"),
        run.plot_contact_force(0, last=2),
        run.plot_phase("tip"),
        run.plot_poincare("tip"),
        run.plot_spectrum("tip"),
    ]
    for position, drawn in enumerate(made):
        target = tmp_path / f"{position}.png"
        drawn.figure.savefig(target)
        assert target.stat().st_size > 5_000


def test_gaps_of_both_signs_are_drawn_on_a_linear_axis():
    blade = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 1e4]], damping=ss.ModalDamping(0.01), dofs=["a", "b"]
    )
    pad = ss.Coulomb(
        ["a", "b"], normal=[0.0, 1.0], friction=0.3, tangential_stiffness=1e4, normal_stiffness=1e4
    )
    model = ss.Model(blade, [pad], [ss.Force("b", 1.0)])
    gaps = [-3e-3, -1e-4, 1e-4, 1e-3]
    curve = ss.damper_curve(model, dof="b", gap=gaps, omega=(40.0, 200.0), harmonics=3)
    ax = curve.plot(limits=False)
    assert ax.get_xscale() == "linear"
    assert ax.get_lines()[0].get_xdata().size == 4
    assert f"at {1e3 * gaps[np.argmin(curve.amplitude)]:g} mm" in legend(ax)[-1]


def test_maps_are_drawn_in_the_order_of_their_values():
    def mass(k, f):
        blade = ss.Structure([[1.0]], [[1e4]], damping=ss.ModalDamping(0.01), dofs=["a"])
        return ss.Model(blade, [ss.Jenkins("a", stiffness=k, slip_force=f)], [ss.Force("a", 1.0)])

    def shades(stiffnesses, forces):
        values = {"k": stiffnesses, "f": forces}
        found = ss.design_map(mass, values, dof="a", omega=(80.0, 160.0))
        return found.plot().collections[0].get_array()

    given = shades([2e4, 5e3, 1e4], [2.0, 0.5])
    np.testing.assert_array_equal(given, shades([5e3, 1e4, 2e4], [0.5, 2.0]))

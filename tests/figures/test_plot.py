"""Figures: the right numbers on axes that say what they show."""

import io

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import plot
from stickslip.plot import style
from stickslip.plot.limits import force_level, limit_curve, limit_model
from stickslip.reference import snecma_beam

GRID = np.linspace(150.0, 250.0, 60)


@pytest.fixture(scope="module")
def levels():
    return [ss.forced_response(snecma_beam(force), GRID, 5) for force in (0.938, 20.313, 38.438)]


def lines(ax, group):
    return [line for line in ax.lines if line.get_gid() == group]


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def direct(model, omega, dof, stiffness):
    """Solve for a linear response one frequency after the other."""
    structure = model.structure
    load = np.zeros(len(structure), complex)
    for force in model.forces:
        load[structure.index(force.dof)] += force.coefficient
    return np.array(
        [
            abs(
                np.linalg.solve(
                    stiffness + 1j * w * structure.damping - w**2 * structure.mass, load
                )
            )[structure.index(dof)]
            for w in omega
        ]
    )


# ---------------------------------------------------------------------------------- curves


def test_curve(frf, ax):
    assert plot.curves(frf, "tip", ax=ax) is ax
    (response,) = lines(ax, "response")
    np.testing.assert_array_equal(response.get_xdata(), GRID)
    np.testing.assert_array_equal(response.get_ydata(), frf.amplitude("tip"))
    assert ax.get_xlabel() == "angular frequency ω [rad/s]"
    assert ax.get_ylabel() == "half peak-to-peak of tip [mm]"
    assert ax.get_yscale() == "log"
    assert ax.get_xlim() == (150.0, 250.0)
    texts = legend(ax)
    assert texts[:3] == ["stuck (linear)", "free (linear)", "P = 20.313 N"]
    peak = frf.peak("tip")
    assert texts[-1] == f"peak {1e3 * peak.amplitude:.4g} mm at {peak.omega:.5g} rad/s"


def test_units(frf, ax):
    plot.curves(frf, "tip", ax=ax, omega_unit="Hz", length_unit="um", log=False, measure="max")
    (response,) = lines(ax, "response")
    np.testing.assert_allclose(response.get_xdata(), GRID / (2 * np.pi))
    np.testing.assert_allclose(response.get_ydata(), 1e6 * frf.amplitude("tip", "max"))
    assert ax.get_xlabel() == "frequency [Hz]"
    assert ax.get_ylabel() == "largest displacement of tip [µm]"
    assert ax.get_yscale() == "linear"
    assert ax.get_ylim() == (0.0, pytest.approx(1.15e6 * frf.amplitude("tip", "max").max()))


def test_limits_are_direct_solutions(frf, ax):
    plot.curves(frf, "mode", ax=ax)
    stuck, free = lines(ax, "limit")
    K = frf.model.structure.stiffness
    for line, stiffness in ((stuck, K + np.diag([2.4e7, 0.0, 0.0])), (free, K)):
        omega = line.get_xdata()
        assert (omega[0], omega[-1]) == (150.0, 250.0)
        np.testing.assert_allclose(
            line.get_ydata(), direct(frf.model, omega, "mode", stiffness), rtol=1e-8
        )


def test_limits_show_sharp_resonances():
    structure = ss.Structure(np.eye(1), [[100.0]], ss.ModalDamping(1e-4), ["x"])
    model = ss.Model(structure, [ss.Jenkins("x", stiffness=44.0, slip_force=1.0)])
    model = ss.Model(structure, model.contacts, [ss.Force("x", 1.0)])
    for stuck, stiffness, damping in ((False, 100.0, 2e-3), (True, 144.0, 2e-3)):
        _, amplitude = limit_curve(model, "x", (1.0, 50.0), "half_range", stuck=stuck)
        peak = 1.0 / (damping * np.sqrt(stiffness))
        assert amplitude.max() == pytest.approx(peak, rel=1e-3)


def test_limits_of_contacts_that_never_or_always_slip():
    structure = ss.Structure(np.eye(3), np.eye(3), None, ["a", "b", "c"])
    contacts = [
        ss.Jenkins("a", stiffness=2.0, slip_force=np.inf),
        ss.Jenkins("b", stiffness=3.0, slip_force=0.0),
        ss.Jenkins("c", "b", stiffness=5.0, slip_force=1.0),
    ]
    model = ss.Model(structure, contacts)
    np.testing.assert_array_equal(
        limit_model(model, stuck=True).structure.stiffness,
        [[3.0, 0.0, 0.0], [0.0, 6.0, -5.0], [0.0, -5.0, 6.0]],
    )
    np.testing.assert_array_equal(
        limit_model(model, stuck=False).structure.stiffness, np.diag([3.0, 1.0, 1.0])
    )


# At its resonance the contact slips under the static load, and nothing holds it.
@pytest.mark.filterwarnings("ignore:peak of 'x'.*could not be solved everywhere")
def test_limits_of_a_free_structure_with_a_static_load(ax):
    """Its contact holds it; without, the half range exists all the same, the mean does not."""
    structure = ss.Structure([[1.0]], [[0.0]], [[0.1]], ["x"])
    loads = [ss.Force("x", 1.0), ss.Force("x", 2.0, harmonic=0)]
    model = ss.Model(structure, [ss.Jenkins("x", stiffness=4.0, slip_force=9.0)], loads)
    frf = ss.forced_response(model, [1.0, 1.5, 2.5], 5, residual="from_rest")
    plot.curves(frf, "x", ax=ax)
    assert len(lines(ax, "limit")) == 2
    with pytest.raises(ss.ModelError, match="moves freely"):
        plot.curves(frf, "x", ax=ax, measure="max")
    plot.curves(frf, "x", ax=ax, measure="max", free=False)


def test_undamped_limits(ax):
    """Frequencies on an undamped resonance, here 2 and 3, have no amplitude and are left out."""
    structure = ss.Structure([[2.0]], [[8.0]], dofs=["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=1.0)
    model = ss.Model(structure, [contact], [ss.Force("x", 0.5)])
    plot.curves(ss.forced_response(model, [1.0, 1.5, 4.0, 5.0], 3), "x", ax=ax, peaks=False)
    for line in lines(ax, "limit"):
        assert np.isfinite(line.get_ydata()).all()


def test_limits_are_prepared_once_per_model(monkeypatch, ax):
    made = []
    whole = ss.plot.limits.limit_model
    monkeypatch.setattr(
        "stickslip.plot.limits.limit_model", lambda *a, **o: made.append(a) or whole(*a, **o)
    )
    frf = ss.forced_response(snecma_beam(), GRID[::6], 5)
    for dof in ("tip", "damper", "tip"):
        plot.curves(frf, dof, ax=ax, peaks=False)
    assert len(made) == 2
    assert len(lines(ax, "limit")) == 6


def test_levels_per_force(levels, ax):
    plot.curves(levels, "tip", ax=ax, normalise="force", length_unit="mm")
    assert ax.get_ylabel() == "half peak-to-peak of tip per force [mm/N]"
    responses = lines(ax, "response")
    for result, force, line in zip(levels, (0.938, 20.313, 38.438), responses, strict=True):
        np.testing.assert_allclose(line.get_ydata(), 1e3 * result.amplitude("tip") / force)
    stuck, _ = lines(ax, "limit")
    lowest = np.interp(GRID, stuck.get_xdata(), stuck.get_ydata())
    np.testing.assert_allclose(responses[0].get_ydata(), lowest, rtol=5e-3)
    assert len({line.get_color() for line in responses}) == 3
    assert legend(ax) == [
        "stuck (linear)",
        "free (linear)",
        "P = 0.938 N",
        "P = 20.313 N",
        "P = 38.438 N",
    ]


def test_levels_as_they_are(levels, ax):
    """Limits belong to one force: the largest."""
    plot.curves(levels, "tip", ax=ax)
    assert legend(ax)[:2] == ["stuck (linear, 38.438 N)", "free (linear, 38.438 N)"]
    _, free = lines(ax, "limit")
    K = snecma_beam().structure.stiffness
    expected = direct(levels[2].model, free.get_xdata(), "tip", K)
    np.testing.assert_allclose(free.get_ydata(), expected, rtol=1e-8)


def test_peaks_are_marked(levels, ax):
    plot.curves(levels, "tip", ax=ax, stuck=False, free=False)
    marks = [line for line in ax.lines if line.get_marker() == "o"]
    assert [(m.get_xdata()[0], m.get_ydata()[0]) for m in marks] == [
        (result.peak("tip").omega, result.peak("tip").amplitude) for result in levels
    ]
    plot.curves(levels, "tip", ax=(other := Figure().add_subplot()), peaks=False)
    assert not [line for line in other.lines if line.get_marker() == "o"]


def test_peak_at_an_edge_is_not_marked(ax):
    plot.curves(ss.forced_response(snecma_beam(), GRID[30:], 5), "tip", ax=ax)
    assert not [line for line in ax.lines if line.get_marker() == "o"]


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (
            lambda m: [(m.scaled(slip_force=s), 3) for s in (0.5, 1)],
            ["$F_d$ = 123 N", "$F_d$ = 246 N"],
        ),
        (lambda m: [(m, h) for h in (1, 3)], ["H = 1", "H = 3"]),
        (
            lambda m: [(m, 1), (m.scaled(force=2), 3)],
            ["P = 20.313 N, H = 1", "P = 40.626 N, H = 3"],
        ),
        (lambda m: [(m, 1), (m, 1)], ["result 0", "result 1"]),
    ],
)
def test_labels_say_what_differs(make, expected, ax):
    runs = [ss.forced_response(model, [180.0, 200.0], h) for model, h in make(snecma_beam())]
    plot.curves(runs, "tip", ax=ax, stuck=False, free=False)
    assert legend(ax) == expected


def test_error_band(frf, levels, ax):
    plot.curves(levels, "tip", ax=ax)
    assert not ax.collections
    plot.curves(frf, "tip", ax=ax)
    (band,) = ax.collections
    top = band.get_paths()[0].vertices[:, 1].max()
    assert top == pytest.approx((frf.amplitude("tip") + frf.error_estimate("tip")).max())
    plot.curves(frf, "tip", ax=(other := Figure().add_subplot()), error_band=False)
    assert not other.collections


@pytest.mark.slow
def test_failed_points_leave_gaps_and_crosses(ax):
    frf = ss.forced_response(snecma_beam(), GRID, 9, max_iterations=1)
    with pytest.warns(UserWarning, match="beside the maximum"):
        plot.curves(frf, "tip", ax=ax)
    assert not [line for line in ax.lines if line.get_marker() == "o"]
    failed = ~frf.converged
    assert np.isnan(lines(ax, "response")[0].get_ydata()[failed]).all()
    (crosses,) = [line for line in ax.lines if line.get_marker() == "x"]
    np.testing.assert_array_equal(crosses.get_xdata(), GRID[failed])
    assert f"{failed.sum()} not solved" in legend(ax)


@pytest.mark.slow
def test_single_point_and_linear_model(ax):
    plot.curves(ss.forced_response(snecma_beam(), [200.0], 3), "tip", ax=ax)
    beam = ss.Model(snecma_beam().structure, forces=[ss.Force("tip", 1.0)])
    plot.curves(ss.forced_response(beam, GRID, 1), "tip", ax=ax)
    assert not lines(ax, "limit")
    still = ss.Model(beam.structure, snecma_beam().contacts)
    plot.curves(ss.forced_response(still, GRID, 1), "tip", ax=(other := Figure().add_subplot()))
    assert other.get_yscale() == "linear"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"omega_unit": "kHz"}, "omega_unit: unknown choice 'kHz'; did you mean 'Hz'"),
        ({"length_unit": "nm"}, "length_unit: unknown choice 'nm'"),
        ({"normalise": "forces"}, r"normalise: unknown choice 'forces'; did you mean 'force'\?"),
        ({"measure": "peak"}, "measure: unknown choice 'peak'"),
        ({"labels": ["a", "b"]}, "labels: 2 for 1 results; give one each"),
        ({"labels": "a"}, "labels: 'a' is not a list; give one text per result"),
        ({"labels": 1.0}, "labels: 1.0 is not a list"),
        ({"labels": [1.0]}, r"labels\[0\]: 1.0 is not text"),
        ({"normalise": np.array(["force"])}, r"normalise: array.* is not text"),
        ({"normalise": ["force"]}, r"normalise: .* is not text"),
        ({"omega_unit": ["Hz"]}, r"omega_unit: .* is not text"),
        ({"length_unit": np.array(["m", "mm"])}, r"length_unit: .* is not text"),
        ({"measure": ["max"]}, r"measure: .* is not text"),
        ({"ax": "x"}, "ax: 'x' is not a matplotlib Axes"),
    ],
)
def test_wrong_options(frf, options, message):
    before = Figure().add_subplot()
    with pytest.raises(ss.ModelError, match=message):
        plot.curves(frf, "tip", **{"ax": before} | options)
    assert not before.lines


def test_wrong_results(frf, ax):
    with pytest.raises(ss.ModelError, match="results: empty"):
        plot.curves([], "tip", ax=ax)
    with pytest.raises(ss.ModelError, match="unknown dof 'tpi'; did you mean 'tip'"):
        plot.curves(frf, "tpi", ax=ax)
    for dof in (["tip"], np.array(["tip", "mode"]), None):
        with pytest.raises(ss.ModelError, match=r"dof: .* is not text"):
            plot.curves(frf, dof, ax=ax)
    for wrong in ("x", 1.0, None):
        with pytest.raises(ss.ModelError, match=r"results: .* is not a ForcedResponse"):
            plot.curves(wrong, "tip", ax=ax)
        for draw, what in ((plot.waveform, ["tip", 0]), (plot.hysteresis, [0, 0]), (plot.slip, [])):
            with pytest.raises(ss.ModelError, match=r"result: .* is not a ForcedResponse"):
                draw(wrong, *what, ax=ax)
    with pytest.raises(ss.ModelError, match=r"results\[1\]: 'x' is not a ForcedResponse"):
        plot.curves([frf, "x"], "tip", ax=ax)
    for wrong in (3, [3]):
        with pytest.raises(ss.ModelError, match=r"dof.*: 3 is not text"):
            plot.waveform(frf, wrong, 0, ax=ax)
    still = ss.forced_response(ss.Model(frf.model.structure), GRID, 1)
    with pytest.raises(ss.ModelError, match="needs a harmonic force, and a result has none"):
        plot.curves([frf, still], "tip", ax=ax, normalise="force")


def test_force_level():
    beam = snecma_beam()
    loads = [ss.Force("tip", 50.0, harmonic=0), ss.Force("tip", -3.0), ss.Force("mode", 2.0)]
    assert force_level(ss.Model(beam.structure, forces=loads)) == 3.0
    assert force_level(ss.Model(beam.structure)) == 0.0


# ---------------------------------------------------------------------------------- figures


@pytest.mark.slow
def test_methods_make_figures(frf, levels, tmp_path):
    index = frf.index(195.0)
    made = [
        frf.plot("tip", normalise="force"),
        frf.plot_waveform("tip", index),
        frf.plot_hysteresis(0, [index, 0]),
        frf.plot_slip(),
        plot.curves([*levels, *levels], "tip"),
    ]
    try:
        for position, drawn in enumerate(made):
            target = tmp_path / f"{position}.png"
            drawn.figure.savefig(target)
            assert target.stat().st_size > 10_000
    finally:
        plt.close("all")


@pytest.mark.parametrize(
    ("size", "unit", "written"),
    [
        (3.2e-5, "m", "[µm]"),
        (4.5e-4, "m", "[µm]"),
        (2e-3, "m/N", "[mm/N]"),
        (0.9, "m", "[mm]"),
        (1.5, "m", "[m]"),
        (24e6, "N/m", "[MN/m]"),
        (4200.0, "N", "[kN]"),
        (0.02, "s", "[s]"),
    ],
)
def test_axes_get_the_prefix_that_suits_the_data(ax, size, unit, written):
    ax.plot([0.0, 1.0], [0.0, size])
    ax.set(ylabel=f"amplitude [{unit}]", ylim=(0.0, size))
    style.finish(ax, made=True)
    assert ax.get_ylabel() == f"amplitude {written}"
    # What is drawn stays in SI.
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), [0.0, size])
    numbers = [
        text for text in ax.yaxis.get_major_formatter().format_ticks(ax.get_yticks()) if text
    ]
    largest = float(numbers[-1].replace("\N{MINUS SIGN}", "-"))
    assert 0.5 < largest < 2000.0 or unit == "s"


def test_a_named_unit_gets_no_prefix(frf, ax):
    plot.curves(frf, "tip", ax=ax, length_unit="m")
    assert ax.get_ylabel() == "half peak-to-peak of tip [m]"


def test_rotor_speeds_of_a_disk(ax):
    beam = snecma_beam()
    disk = ss.BladedDisk(
        beam.structure, 4, contacts=beam.contacts, forces=beam.forces, engine_order=2
    )
    disk_response = ss.forced_response(disk, GRID, 3)
    plot.curves(disk_response, "tip", ax=ax, omega_unit="rpm", stuck=False, free=False)
    assert ax.get_xlabel() == "rotor speed at engine order 2 [rpm]"
    line = next(one for one in ax.lines if one.get_gid() == style.RESPONSE)
    np.testing.assert_allclose(line.get_xdata(), disk_response.omega * 30 / np.pi / 2, rtol=1e-12)
    (above,) = ax.child_axes
    ax.figure.savefig(io.BytesIO())
    hertz = np.array(ax.get_xlim()) * 2 / 60  # two periods of the force per turn
    np.testing.assert_allclose(above.get_xlim(), hertz, rtol=1e-12)
    assert above.get_xlabel() == "frequency [Hz]"

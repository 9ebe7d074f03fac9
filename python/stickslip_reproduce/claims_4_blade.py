"""Claims of chapter IV on the blade and on the time that it takes."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT, exact, optimum
from stickslip_reproduce.blade_orbits import blade_at_optimum
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution


@cache
def levels() -> tuple[tuple[float, float, float, float], ...]:
    """Return ratio F_d / F_d0, peak over the stuck one, its frequency [rad/s], slip fraction."""
    blade = ss.reference.turbine_blade()
    best = ss.optimal_damper(blade, dof="tip", omega=_around(0), mode=0).slip_force
    stuck = ss.forced_response(ss.reference.turbine_blade(inf), _around(0)).peak("tip").amplitude
    rows = []
    for ratio in (0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 20.0, 100.0):
        shown = ss.forced_response(ss.reference.turbine_blade(ratio * best), _around(0), 9)
        top = shown.peak("tip")
        at = int(np.abs(shown.omega - top.omega).argmin())
        rows.append(
            (ratio, top.amplitude / stuck, top.omega, float(shown.slip_fraction((0, 0))[at]))
        )
    return tuple(rows)


def _around(mode: int, margin: float = 0.05) -> tuple[float, float]:
    """Return the range of frequencies around a mode of the blade [rad/s]."""
    blade = ss.reference.turbine_blade()
    low = float(ss.natural_frequencies(blade, slipping=[0])[mode])
    return (1.0 - margin) * low, (1.0 + margin) * float(ss.natural_frequencies(blade)[mode])


@claim(
    "three-groups-of-the-blade",
    "4.3",
    "As noticed for the beam system in Section 4.2.1, three groups of frequency responses can be "
    "observed. [...] The energy dissipation by friction is optimal in these latter cases.",
    """Open blade, nine slip forces from 0.01 to 100 F_d0: curves that slip more than half of the
    period at the peak, within 1 % of the slipping frequency; that slip less than a twentieth,
    within 1 % of the stuck one; and those between, whose lowest peak is the best.""",
    rule=lambda n: verdict(
        min(n["slipping"], n["sticking"], n["between"]) > 0 and n["best between"] == 1.0
    ),
    see="fig-4.10 fig-4.11",
)
def three_groups(resolution: Resolution) -> Found:
    """Return the number of curves in each group."""
    blade = ss.reference.turbine_blade()
    free = float(ss.natural_frequencies(blade, slipping=[0])[0])
    held = float(ss.natural_frequencies(blade)[0])
    slipping = [row for row in levels() if row[3] > 0.5 and abs(row[2] / free - 1.0) < 0.01]
    sticking = [row for row in levels() if row[3] < 0.05 and abs(row[2] / held - 1.0) < 0.01]
    between = [row for row in levels() if row not in slipping and row not in sticking]
    best = min(levels(), key=lambda row: row[1])
    return Found(
        (
            Fact("slipping", len(slipping)),
            Fact("sticking", len(sticking)),
            Fact("between", len(between)),
            Fact("best between", float(best in between)),
        )
    )


@claim(
    "like-the-beam",
    "4.3",
    "the overall aspect of the frequency response, Figs. 4.10-4.13, is very similar to the one of "
    "the frequency response of the beam system",
    """Maxima of the exact curve of the tip above half its peak at the best slip force, of the open
    blade and of the beam at its best load; 3 ω₁ / ω₂ of the stuck blade; and the error of one
    harmonic. The groups are the same, but the third harmonic of the blade meets its second mode:
    this internal resonance makes two humps, of which one harmonic knows nothing.""",
    rule=lambda n: verdict(
        n["humps of the blade"] == n["humps of the beam"] and n["error of one harmonic"] < 20.0,
        n["3 ω₁ / ω₂"] > 0.0,
    ),
    see="fig-4.10 fig-4.11 fig-4.12 fig-4.13",
)
def like_the_beam(resolution: Resolution) -> Found:
    """Humps and internal resonance of the blade."""
    true, rough = blade_at_optimum()
    beam = exact(float(optimum("tip").value))
    stuck = ss.natural_frequencies(ss.reference.turbine_blade())
    error = rough.peak("tip").amplitude / true.peak("tip").amplitude - 1.0
    series = (
        Series("exact orbits", true.omega, true.amplitude("tip"), "limit"),
        Series("one harmonic", rough.omega, rough.amplitude("tip")),
    )
    plot = Plot(
        Axis("angular frequency ω", "rad/s"),
        Axis("amplitude of the tip", "m", "µm", 1e6),
        (Panel(series, "open blade, F_d = F_d0"),),
    )
    return Found(
        (
            Fact("humps of the blade", _humps(true)),
            Fact("humps of the beam", _humps(beam)),
            Fact("3 ω₁ / ω₂", float(3.0 * stuck[0] / stuck[1])),
            Fact("error of one harmonic", 100.0 * float(error), "%"),
        ),
        plot,
    )


def _humps(curve: ss.ExactResponse) -> int:
    values = curve.amplitude("tip")
    inner = values[1:-1]
    tops = (inner > values[:-2]) & (inner >= values[2:]) & (inner > 0.5 * values.max())
    return int(tops.sum())


@claim(
    "fifth-mode",
    "4.3",
    "Of particular interest here is the fifth mode of vibration, which has been shown to yield a "
    "large response amplitude at the tip of the blade",
    """Open blade: stuck peak of the tip around mode 5 over that around mode 1, and what the best
    slip force leaves of it. The blade of the text is proprietary, and nothing that is published
    decides it: open. Of the open blade it is the first mode that moves the tip most, so that its
    figures show that one.""",
    rule=lambda n: "holds" if n["mode 5 over mode 1, stuck"] > 1.0 else "open",
)
def fifth_mode(resolution: Resolution) -> Found:
    """Response around mode 5 for several slip forces."""
    span = _around(4, 0.01)
    stuck = ss.forced_response(ss.reference.turbine_blade(inf), span)
    first = ss.forced_response(ss.reference.turbine_blade(inf), _around(0)).peak("tip")
    best = ss.optimal_damper(ss.reference.turbine_blade(), dof="tip", omega=span, mode=4)
    top = stuck.peak("tip").amplitude
    series = []
    for ratio in (0.01, 0.3, 1.0, 3.0, 1e4):
        shown = ss.forced_response(
            ss.reference.turbine_blade(ratio * best.slip_force),
            span,
            9,
            tolerance=resolution.tolerance,
        )
        series.append(
            Series(
                f"F_d / F_d0 = {ratio:g}",
                shown.omega / stuck.peak("tip").omega,
                shown.amplitude("tip") / top,
            )
        )
    plot = Plot(
        Axis("frequency ω / ω of the stuck peak"),
        Axis("x₂ of the tip over its stuck peak", log=True),
        (Panel(tuple(series), "open blade around its fifth mode"),),
    )
    facts = (
        Fact("mode 5 over mode 1, stuck", top / first.amplitude),
        Fact("best over stuck, mode 5", best.amplitude / top),
        Fact("F_d0 of mode 5", best.slip_force, "N"),
    )
    return Found(facts, plot)


@claim(
    "ten-thousand-cycles",
    "4.3",
    "the time integration calculations had to be performed over a very large number of cycles "
    "(> 10000) in order to reach steady state",
    """Periods from rest until a period changes the state of the open blade by less than 1e-6, the
    slowest of the frequencies of Fig. 4.12.""",
    rule=lambda n: verdict(n["periods"] > 10000, n["periods"] > 1000),
    see="fig-4.12",
)
def ten_thousand(resolution: Resolution) -> Found:
    """Periods of the slowest motion of the blade."""
    shown = numbers_of("fig-4.12", resolution)
    return Found((Fact("periods", shown.fact("periods until the slowest motion is steady")),))


@claim(
    "virtually-identical",
    "4.3",
    "The results predicted by the two methods are virtually identical.",
    """Open blade at the best slip force: largest difference of 9 harmonics to exact orbits, over
    the peak, and of Runge-Kutta to exact orbits.""",
    rule=lambda n: verdict(
        n["9 harmonics"] < 2.0 and n["Runge-Kutta"] < 0.1, n["9 harmonics"] < 5.0
    ),
    see="fig-4.12 fig-4.13",
)
def virtually_identical(resolution: Resolution) -> Found:
    """Differences of 9 harmonics and of Runge-Kutta."""
    both = [numbers_of(name, resolution) for name in ("fig-4.12", "fig-4.13")]
    what = {
        "9 harmonics": "largest difference of 9 harmonics to exact orbits, over the peak",
        "Runge-Kutta": "largest difference of Runge-Kutta to exact orbits",
    }
    return Found(
        tuple(Fact(name, max(one.fact(of) for one in both), "%") for name, of in what.items())
    )


@claim(
    "hundreds-of-times",
    "4.4",
    "the time integration requires several hundreds more times computational time than the hybrid "
    "frequency/time method",
    """Beam, 400 frequencies: Runge-Kutta over Broyden's method in one run, at its fastest and its
    slowest number of harmonics, both compiled. Several hundreds is above 200 for all.""",
    rule=lambda n: verdict(n["least"] > 200.0, n["most"] > 200.0),
    see="table-4.1",
)
def hundreds_of_times(resolution: Resolution) -> Found:
    """Runge-Kutta over Broyden."""
    table = numbers_of("table-4.1", resolution).table
    assert table is not None
    times = [
        float(taken or 0.0)
        for method, taken in zip(
            table.column("method"), table.column("ours: Runge-Kutta takes [times]"), strict=True
        )
        if method == "Broyden"
    ]
    return Found((Fact("least", min(times), "times"), Fact("most", max(times), "times")))


@claim(
    "slowest-near-optimum",
    "4.4",
    "correspond to a near optimal damping situation where the Broyden method is the slowest",
    """Iterations of Broyden's method with 15 harmonics over 400 frequencies at the eight loads: the
    load that takes most, and 20.313 N over it. Near optimal damping is from 6.563 to 25 N.""",
    rule=lambda n: verdict(n["20.313 N over the slowest"] == 1.0, 6.5 < n["slowest load"] < 26.0),
)
def slowest(resolution: Resolution) -> Found:
    """Return the iterations by load."""
    omega = np.linspace(20.0, 350.0, resolution.count(400))
    taken = {
        load: ss.forced_response(
            ss.reference.snecma_beam(load), omega, 15, method="broyden"
        ).counters["iterations"]
        for load in EIGHT
    }
    most = max(taken, key=taken.__getitem__)
    return Found(
        (
            Fact("slowest load", most, "N", 20.313),
            Fact("20.313 N over the slowest", taken[20.313] / taken[most]),
        )
    )


@claim(
    "even-with-21-harmonics",
    "4.4",
    "The hybrid frequency/time method is much faster than the numerical time integration, even "
    "when as many as 21 temporal harmonics are retained in the solution.",
    """Runge-Kutta over Broyden's method with 21 harmonics, beam and blade of Table 4.1; much is ten
    times.""",
    rule=lambda n: verdict(min(n.values()) > 10.0, max(n.values()) > 10.0),
    see="table-4.1",
)
def even_with_21(resolution: Resolution) -> Found:
    """Runge-Kutta over Broyden with 21 harmonics."""
    table = numbers_of("table-4.1", resolution).table
    assert table is not None
    (cells,) = (one for one in table.rows if one[:2] == ("Broyden", 21))
    row = dict(zip(table.columns, cells, strict=True))
    return Found(
        tuple(
            Fact(what, float(row[column] or 0.0), "times")
            for what, column in (
                ("beam", "ours: Runge-Kutta takes [times]"),
                ("blade", "blade, ours: Runge-Kutta takes [times]"),
            )
        )
    )

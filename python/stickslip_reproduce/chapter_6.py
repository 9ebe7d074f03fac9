"""Chapter VI, section 6.4: two SNECMA beams joined by a damper that is a structure of its own."""

from __future__ import annotations

from math import inf

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import FREQUENCY, PERIOD_SHARE, curve, maxima, over_period
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import Float, Resolution

SPAN = (500.0, 700.0)
LOW = (20.0, 30.0, 40.0, 50.0, 55.0, 60.0)
HIGH = (70.0, 80.0, 90.0, 100.0, 110.0, 120.0)
"""Amplitudes of the forces [N]."""

DOFS = ("1.damper", "2.damper", "1.tip", "2.tip")
"""Where contacts 1 to 4 of the damper touch."""

NAMES = ("f₁", "f₂", "f₃", "f₄")

HARMONICS = 15

NEAR = 0.01
"""How far the exact peak may be from that of 15 harmonics, over its frequency."""

FORCE = Axis("contact force", "N")
DISPLACEMENT = Axis("amplitude", "m", "µm", 1e6)

PRINTED = {
    (): (541.26, 1090.2, 2026.59),
    (1,): (336.38, 680.84, 1004.61),
    (2,): (342.83, 693.58, 1006.11),
    (3,): (191.15, 678.17, 1358.67),
    (1, 2): (159.59, 512.98, 901.76),
    (1, 3): (159.59, 901.76, 2167.54),
    (2, 3): (159.59, 664.94, 901.76),
    (1, 2, 3): (159.59, 901.76, 2167.54),
}
"""Frequencies of Table 6.4 by slipping contacts, double ones once [rad/s]."""


@reproduces(
    "fig-6.4",
    """A small force: no contact slips, the damper is a mere spring, and its forces are those of the
    stuck one. Their sum is zero.""",
)
def figure_6_4(resolution: Resolution) -> Numbers:
    """Contact forces at 250 rad/s, 15 N."""
    return _forces(250.0, 15.0, printed_at_once=0)


@reproduces(
    "fig-6.5",
    """Contact 1 slips, and the others feel it: the force of contact 2 has corners though it never
    slips.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_5(resolution: Resolution) -> Numbers:
    """Contact forces at 550 rad/s, 35 N."""
    return _forces(550.0, 35.0, printed_at_once=1)


@reproduces(
    "fig-6.6",
    """At 140 N contact 1 still slips alone, most of the time; the forces of contacts 2 and 3 stay
    within their limits of 100 and 246 N. Contact 3 carries more than it would if all stuck.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_6(resolution: Resolution) -> Numbers:
    """Contact forces at 550 rad/s, 140 N."""
    return _forces(550.0, 140.0, printed_at_once=2)


@reproduces(
    "fig-6.7",
    """At 550 N up to three contacts slip at once. While they do all four forces are constant.""",
)
def figure_6_7(resolution: Resolution) -> Numbers:
    """Contact forces at 550 rad/s, 550 N."""
    return _forces(550.0, 550.0, printed_at_once=3)


def _forces(omega: float, force: float, printed_at_once: int) -> Numbers:
    pair = ss.reference.damped_pair(force)
    exact = ss.exact_response(pair, [omega])
    stuck = ss.forced_response(_stuck(pair), [omega], harmonics=1)
    found, linear = (result.contact_force(0, 0) for result in (exact, stuck))
    total = over_period("sum", exact.resultant(0, 0), pair=4)
    panels = []
    for points in ((0, 1), (2, 3)):
        series = [
            *(
                over_period(f"{NAMES[point]}, stuck", linear[:, point], kind="limit", pair=point)
                for point in points
            ),
            *(over_period(NAMES[point], found[:, point], pair=point) for point in points),
        ]
        title = f"contacts {points[0] + 1} and {points[1] + 1}"
        panels.append(Panel((*series, total), f"{title}, ω = {omega:g} rad/s, {force:g} N"))
    sets = exact.contact_states(0, 0).sets
    facts = [
        Fact(f"largest force f{point + 1}", float(np.abs(found[:, point]).max()), "N")
        for point in range(4)
    ]
    facts += [
        Fact("contacts that slip at once", float(max(map(len, sets))), "", float(printed_at_once)),
        Fact("contacts that slip at all", float(len(set().union(*sets)))),
        Fact("largest sum of the forces", float(np.abs(exact.resultant(0, 0)).max()), "N", 0.0),
    ]
    return Numbers(Plot(PERIOD_SHARE, FORCE, tuple(panels)), tuple(facts))


def _stuck(pair: ss.Model, stiffness: Float | None = None) -> ss.Model:
    """Return the pair with contacts that never slip, and perhaps another stiffness."""
    (damper,) = pair.contacts
    matrix = damper.stuck_stiffness if stiffness is None else stiffness
    held = ss.StructuralDamper(list(DOFS), stiffness=matrix, slip_forces=[inf] * 4)
    return pair.replaced(contacts=[held])


@reproduces(
    "fig-6.8",
    """At 20 N nothing slips and both beams move alike. From 30 N on contact 1 slips, the peaks fall
    to lower frequencies, and contacts 1 and 2 part.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_8(resolution: Resolution) -> Numbers:
    """Contacts 1 and 2 over frequency, 20 to 60 N."""
    return _curves(LOW, (0, 1), resolution)


@reproduces(
    "fig-6.9",
    """The peaks go on to lower frequencies. From 80 N on the curves rise again at the end of the
    range, towards the resonance of the pair with contact 1 slipping, 715 rad/s.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_9(resolution: Resolution) -> Numbers:
    """Contacts 1 and 2 over frequency, 70 to 120 N."""
    return _curves(HIGH, (0, 1), resolution)


@reproduces(
    "fig-6.10",
    """The tips part as soon as contact 1 slips: the tip of beam 1, where contact 3 is, moves more
    than that of beam 2.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_10(resolution: Resolution) -> Numbers:
    """Contacts 3 and 4 over frequency, 20 to 60 N."""
    return _curves(LOW, (2, 3), resolution)


@reproduces(
    "fig-6.11",
    """At contact 3 the peak keeps growing and moving to lower frequencies; at contact 4 the curves
    are nearly flat from 530 rad/s on, until they rise towards 715 rad/s.""",
    corrected=(errata.PRELOAD,),
)
def figure_6_11(resolution: Resolution) -> Numbers:
    """Contacts 3 and 4 over frequency, 70 to 120 N."""
    return _curves(HIGH, (2, 3), resolution)


def _curves(levels: tuple[float, ...], points: tuple[int, int], resolution: Resolution) -> Numbers:
    panels, facts = [], []
    for force in levels:
        pair = ss.reference.damped_pair(force)
        shown = ss.forced_response(pair, SPAN, HARMONICS, tolerance=resolution.tolerance)
        curves = [curve(shown, DOFS[point], f"contact {point + 1}") for point in points]
        panels.append(Panel(tuple(curves), f"{force:g} N"))
        for point, drawn in zip(points, curves, strict=True):
            dof = DOFS[point]
            # Of the tops: from 90 N on the curve rises above them at the end of the range.
            top, _ = max(maxima(drawn), key=lambda found: found[1])
            near = np.abs(shown.omega / top - 1.0) < NEAR
            peak = ss.exact_response(pair, shown.omega[near], observe=dof).peak(dof)
            facts += [
                Fact(f"exact peak at contact {point + 1}, {force:g} N", peak.amplitude, "m"),
                Fact(f"at, contact {point + 1}, {force:g} N", peak.omega, "rad/s"),
            ]
    end = ss.exact_response(ss.reference.damped_pair(levels[-1]), [SPAN[1]])
    facts += [
        Fact(
            f"exact at contact {point + 1}, {levels[-1]:g} N, {SPAN[1]:g} rad/s",
            float(end.amplitude(DOFS[point])[0]),
            "m",
        )
        for point in points
    ]
    free = ss.natural_frequencies(ss.reference.damped_pair(), slipping=[("structural", 0)])
    facts.append(Fact("natural frequency with contact 1 slipping", float(free[1]), "rad/s"))
    return Numbers(Plot(FREQUENCY, DISPLACEMENT, tuple(panels)), tuple(facts))


@reproduces(
    "table-6.4",
    """With contacts slipping the damper is condensed, not cut: the free contacts still carry forces
    from one stuck contact to another. Cut links give the printed values.""",
    corrected=(errata.CUT_LINKS,),
)
def table_6_4(resolution: Resolution) -> Numbers:
    """Natural frequencies by slipping contacts."""
    pair = ss.reference.damped_pair()
    whole = pair.contacts[0].stuck_stiffness
    found = {
        tuple(point + 1 for _, point in slipping): _first(omega)
        for slipping, omega in ss.slip_configurations(pair).items()
    }
    rows: list[tuple[str | float | None, ...]] = []
    facts = []
    for slipping, printed in PRINTED.items():
        name = " and ".join(map(str, slipping)) or "none"
        cut = _first(ss.natural_frequencies(_stuck(pair, _cut(whole, slipping))))
        for number, values in enumerate(zip(found[slipping], cut, printed, strict=True)):
            rows.append((name, number + 1, *map(float, values)))
        facts += [
            Fact(f"slipping {name}: second", float(found[slipping][1]), "rad/s", printed[1]),
            Fact(f"links of {name} cut: second", float(cut[1]), "rad/s", printed[1]),
        ]
    columns = ("slipping", "number", "ours [rad/s]", "links cut [rad/s]", "printed [rad/s]")
    places = np.repeat(np.arange(len(PRINTED)), 3)
    names = tuple(" + ".join(map(str, slipping)) or "none" for slipping in PRINTED)
    series = tuple(
        Series(label, places, [row[column] for row in rows], "marks")  # type: ignore[arg-type]
        for label, column in (("condensed", 2), ("links cut", 3), ("printed", 4))
    )
    x = Axis("slipping contacts", names=names)
    y = Axis("natural frequency", "rad/s")
    return Numbers(Plot(x, y, (Panel(series),)), tuple(facts), Table(columns, tuple(rows)))


def _first(omega: Float) -> Float:
    """Return the first three frequencies, double ones once."""
    return omega[np.flatnonzero(np.diff(omega, prepend=0.0) > 1e-3 * omega)][:3]


def _cut(stiffness: Float, slipping: tuple[int, ...]) -> Float:
    """Return the stiffness of a damper that nothing else holds without the links of contacts."""
    links = np.diag(np.diag(stiffness)) - stiffness
    gone = [contact - 1 for contact in slipping]
    links[gone, :] = 0.0
    links[:, gone] = 0.0
    return np.asarray(np.diag(links.sum(axis=1)) - links)

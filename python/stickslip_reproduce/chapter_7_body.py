"""Chapter VII, section 7.2: dampers that are bodies, a wedge and one with mass."""

from __future__ import annotations

from functools import partial
from math import atan, pi, radians, tan

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_7_contact import MEANT
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Fact, Numbers
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.variants import SHOWN, Variant, compared

STIFFNESS = ss.reference.DAMPER_STIFFNESS
SLIP_FORCE = ss.reference.DAMPER_SLIP_FORCE

ANGLE = 45.0
"""Angle between the normals of the faces of the wedge and its load [deg]."""

FRICTION = 0.3
WEIGHT = 0.05
"""Mass of the wedge [kg]."""

ORBITS = (*range(100, 150, 10), *np.arange(150.0, 230.0, 2.5), *range(230, 301, 10))
"""Frequencies of exact orbits [rad/s]."""

SHARES = (0.03, 0.1)
"""Mass of the damper over that of the beam at the damper."""


@reproduces(
    "7.2-wedge",
    """A wedge under the platforms of two beams, pressed by a static load. In opposition it works
    like an elementary damper between each beam and the ground: the normal forces change at every
    reversal, but while both faces slip the load fixes them, and the loop lies between two constant
    forces. Where half its height is the slip force the peaks are those of Figs 4.3 and 4.4 to
    0.6 %. But a wedge damps relative motion only: with the phase of engine order 2 it lowers the
    peak by half a percent and in phase it goes along with the beams, at any load.""",
    inferred=(
        MEANT,
        "Angle of the faces 45 degrees, friction 0.3, mass 0.05 kg, stiffnesses 2.4e7 N/m of each "
        "face; its load makes half the height of the loop of a slow cycle in opposition 246.048 N. "
        "Platforms move with x₁, across the load.",
    ),
)
def wedge(resolution: Resolution) -> Numbers:
    """Wedge between two beams in opposition and with the phase of engine order 2."""
    variants = [
        Variant("wedge, in opposition", partial(_wedge, pi), "left.", orbits=ORBITS),
        Variant("wedge, 20 degrees", partial(_wedge, pi / 9), "left.", orbits=ORBITS),
    ]
    facts = [Fact("load of the wedge", _wedge_load(), "N")]
    for load in SHOWN:
        together = ss.forced_response(_wedge(0.0, load), (155.0, 165.0), 3)
        top = together.peak("left.tip").amplitude / load
        facts.append(Fact(f"peak / P of x₂, {load:g} N, in phase", top, "m/N"))
    free = ss.forced_response(
        ss.reference.snecma_beam(1.0).replaced(contacts=[]), (155.0, 165.0), 1
    )
    facts.append(Fact("peak / P of x₂ without any damper", free.peak("tip").amplitude, "m/N"))
    return compared(variants, resolution, *facts)


def _wedge_load() -> float:
    """Return the load under which half the loop of a slow cycle is the slip force [N].

    About to come out a face needs the force load / 2 tan(a + arctan mu), about to move in
    load / 2 tan(a - arctan mu).
    """
    a, cone = radians(ANGLE), atan(FRICTION)
    return 4.0 * SLIP_FORCE / (tan(a + cone) - tan(a - cone))


def _wedge(phase: float, load: float) -> ss.Model:
    """Return two beams with a wedge between them, the right one ahead by a phase."""
    beam = ss.reference.snecma_structure()
    damper = ss.WedgeDamper(
        angle=ANGLE,
        mass=WEIGHT,
        friction=FRICTION,
        tangential_stiffness=STIFFNESS,
        normal_stiffness=STIFFNESS,
        load=_wedge_load(),
    )
    platform: list[str | dict[str, float]] = ["damper", {"damper": 0.0}]
    forces = [ss.Force("left.tip", load), ss.Force("right.tip", load, phase)]
    return damper.between(beam, beam, left_dofs=platform, right_dofs=platform, forces=forces)


@reproduces(
    "7.2-damper-mass",
    """A damper with a mass between its spring and its friction contact. Up to a tenth of the mass
    of the beam it changes little: stuck it is far below its own resonance, and slipping it is a
    mass at a place that hardly moves in the first mode, whose frequency falls by 0.2 %, while that
    of the second falls by 4 %. The peak of the tip is 7 % lower near optimal damping and 4 % lower
    at a large load, but 2 % higher at 20.313 N.""",
    inferred=(
        MEANT,
        "The mass of the beam is the 6.68 kg that it has at the damper, entry (1, 1) of its "
        "matrix. The damper is two springs of 4.8e7 N/m in series, that of the body and that of "
        "its contact, with the mass between them: without mass it is the elementary damper.",
    ),
)
def damper_mass(resolution: Resolution) -> Numbers:
    """Damper mass from nothing to a tenth of the beam's."""
    variants = [
        Variant(f"{share:g} of the beam's mass", partial(_heavy, share), "beam.")
        for share in SHARES
    ]
    facts = []
    for share in SHARES:
        model = _heavy(share, 1.0)
        for name, slipping in (("stuck", []), ("slipping", [0])):
            omega = ss.natural_frequencies(model, slipping=slipping)
            facts += [
                Fact(f"{name} frequency {number}, {share:g} of the mass", float(one), "rad/s")
                for number, one in enumerate(omega[:2], 1)
            ]
        near = np.linspace(180.0, 205.0, 26)
        best = ss.exact_response(_heavy(share, 20.313), near, observe="beam.tip").peak("beam.tip")
        facts.append(
            Fact(f"peak / P of x₂, 20.313 N, {share:g} of the mass", best.amplitude / 20.313, "m/N")
        )
    return compared(variants, resolution, *facts)


def _heavy(share: float, load: float) -> ss.Model:
    """Return the beam with a damper that has a share of its mass."""
    beam = ss.reference.snecma_structure()
    body = ss.Structure(mass=[[share * beam.mass[0, 0]]], stiffness=[[0.0]], dofs=["mass"])
    spring = ss.Coupling("beam.damper", "damper.mass", stiffness=2.0 * STIFFNESS)
    contact = ss.Jenkins("damper.mass", stiffness=2.0 * STIFFNESS, slip_force=SLIP_FORCE)
    whole = ss.join({"beam": beam, "damper": body}, [spring])
    return ss.Model(whole, [contact], [ss.Force("beam.tip", load)])

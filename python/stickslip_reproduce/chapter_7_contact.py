"""Chapter VII, section 7.2: other contacts than the elementary damper, on the beam of Fig. 4.3."""

from __future__ import annotations

from functools import partial

import numpy as np

import stickslip as ss
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Fact, Numbers
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.variants import REFERENCE, SHOWN, Variant, compared

STIFFNESS = ss.reference.DAMPER_STIFFNESS
SLIP_FORCE = ss.reference.DAMPER_SLIP_FORCE

FRICTION = 0.5
"""Coefficient of friction where the normal load varies."""

SLOPES = (5.0, 15.0)
"""Angles of the contact plane against the motion of the beam [deg]."""

MEANT = "The dissertation names the subject and computes nothing: system and parameters are ours."


@reproduces(
    "7.2-microslip",
    """A contact that slips little by little has no threshold: below the load at which the
    elementary damper begins to slip it damps already, and takes a fifth off the peak of the tip at
    0.938 N. Where friction damps best it damps less, since part of it always sticks: the lowest
    peaks of the tip are a quarter (exponential) and a fifth (Iwan) above that of the elementary
    damper. At large loads all three slip as a whole and differ by a few percent.""",
    inferred=(
        MEANT,
        "All three have the same stiffness at rest, 2.4e7 N/m, and the same largest force, "
        "246.048 N; the Iwan model has chi = -0.5 and beta = 0.",
        "Peaks of microslip laws are those of 15 harmonics.",
    ),
)
def microslip(resolution: Resolution) -> Numbers:
    """Exponential and Iwan microslip against the elementary damper."""
    variants = [
        Variant("exponential", _exponential, exact=False),
        Variant("Iwan", _iwan, exact=False),
    ]
    facts = []
    for variant in (REFERENCE, *variants):
        model = variant.model(1.0)
        best = ss.optimal_damper(model, dof="tip", parameter="level", mode=0)
        small = ss.forced_response(variant.model(0.938), (200.0, 240.0), 15).peak("tip")
        facts += [
            Fact(f"optimal load of x₂, {variant.label}", best.value, "N"),
            Fact(f"peak x₂ / P there, {variant.label}", best.amplitude / best.value, "m/N"),
            Fact(f"peak x₂ / P at 0.938 N, {variant.label}", small.amplitude / 0.938, "m/N"),
        ]
    return compared(variants, resolution, *facts)


def _exponential(load: float) -> ss.Model:
    damper = ss.Masing("damper", stiffness=STIFFNESS, slip_force=SLIP_FORCE, backbone="exponential")
    return ss.reference.snecma_beam(load).replaced(contacts=[damper])


def _iwan(load: float) -> ss.Model:
    damper = ss.Iwan("damper", stiffness=STIFFNESS, slip_force=SLIP_FORCE, chi=-0.5)
    return ss.reference.snecma_beam(load).replaced(contacts=[damper])


@reproduces(
    "7.2-normal-load",
    """The contact plane is inclined, so that the beam loads and unloads it as it bends. While all
    sticks nothing changes. As it slips the normal load follows the motion: on a slope of 5 degrees
    the peak of the tip is 14 % lower near optimal damping and 10 % higher at a large load, where
    the contact is open for 40 % of the period. On 15 degrees it opens near optimal damping, too,
    the peak there is twice as high and the curve bends back: a damper that lifts off cannot be laid
    out with a constant normal load.""",
    inferred=(
        MEANT,
        "Slope of the contact 5 and 15 degrees, friction 0.5, preload 492 N, so that it slips at "
        "246.048 N at rest; both stiffnesses 2.4e7 N/m, so that it is as stiff as the elementary "
        "damper while it sticks.",
    ),
)
def normal_load(resolution: Resolution) -> Numbers:
    """Contact with variable normal load and separation, on two slopes."""
    variants = [
        Variant(f"slope of {slope:g} degrees", partial(_inclined, slope)) for slope in SLOPES
    ]
    facts = []
    for variant in variants:
        for load in SHOWN:
            shown = ss.forced_response(variant.model(load), (150.0, 230.0), 15)
            open_ = 100.0 * abs(float(shown.open_fraction(0).max()))
            facts.append(
                Fact(f"share of the period open at {load:g} N, {variant.label}", open_, "%")
            )
    return compared(variants, resolution, *facts)


def _inclined(slope: float, load: float) -> ss.Model:
    """Return the beam with a contact whose plane is inclined against its motion [deg]."""
    along, across = np.cos(np.radians(slope)), np.sin(np.radians(slope))
    contact = ss.Coulomb(
        [{"damper": float(along)}, {"damper": float(across)}],
        normal=[0.0, 1.0],
        friction=FRICTION,
        tangential_stiffness=STIFFNESS,
        normal_stiffness=STIFFNESS,
        preload=SLIP_FORCE / FRICTION,
    )
    return ss.reference.snecma_beam(load).replaced(contacts=[contact])


@reproduces(
    "7.2-two-directions",
    """The beam bends in two planes and is driven around an ellipse or a circle; friction acts
    against the direction of slip. Driven in one plane only it is the beam of Figs 4.3 and 4.4, and
    so it would be with one elementary damper per plane. On a circle the contact slips without ever
    stopping: near optimal damping the peak of the tip is 30 % lower. At large loads one slip force
    has to damp the motion of both planes, and the peak is 30 % higher. A circle has neither
    subresonances nor higher harmonics.""",
    inferred=(
        MEANT,
        "The beam is equally stiff in both planes, with the matrices of Eq. (2.32) in each. The "
        "force of the second plane is 90 degrees behind, as large (circle) or half as large "
        "(ellipse); curves are those of the first plane.",
    ),
)
def two_directions(resolution: Resolution) -> Numbers:
    """Friction in two tangential directions, on an ellipse and on a circle."""
    variants = [
        Variant("ellipse", partial(_in_two_planes, 0.5), "1."),
        Variant("circle", partial(_in_two_planes, 1.0), "1.", exact=False, harmonics=1),
    ]
    straight = _in_two_planes(0.0, 16.563)
    round_ = ss.forced_response(_in_two_planes(1.0, 16.563), [198.61], 15)
    coefficients = np.abs(round_.coefficients("1.tip")[0])
    facts = (
        Fact(
            "peak / P of x₂, 16.563 N, driven in one plane",
            ss.exact_response(straight, np.linspace(185.0, 205.0, 41)).peak("1.tip").amplitude
            / 16.563,
            "m/N",
        ),
        Fact(
            "largest higher harmonic of x₂ on a circle over the first",
            float(coefficients[2:].max() / coefficients[1]),
        ),
    )
    return compared(variants, resolution, *facts)


def _in_two_planes(ratio: float, load: float) -> ss.Model:
    """Return the beam in both planes, driven in the second by a share of the force."""
    beam = ss.reference.snecma_structure()
    contact = ss.Coulomb(
        ["1.damper", "2.damper"],
        normal=None,
        friction=1.0,
        preload=SLIP_FORCE,
        tangential_stiffness=STIFFNESS,
    )
    forces = [ss.Force("1.tip", load), ss.Force("2.tip", ratio * load, phase=-np.pi / 2)]
    return ss.Model(ss.join({"1": beam, "2": beam}), [contact], forces[: 2 if ratio else 1])

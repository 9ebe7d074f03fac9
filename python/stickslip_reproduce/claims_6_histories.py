"""Claims of chapter VI on motions in time."""

from __future__ import annotations

from math import inf

import numpy as np

import stickslip as ss
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.pair_orbits import LIMITS, forces_at, middle, orbit, stuck
from stickslip_reproduce.resolution import Float, Resolution


@claim(
    "mere-stiffness",
    "6.4.1",
    "In Fig. 6.4, the damper structure acts like a mere stiffness and there is no non-linearity.",
    """Largest difference of the forces at 250 rad/s, 15 N to those of contacts that never slip.""",
    rule=lambda n: verdict(n["largest difference"] < 1e-6),
    see="fig-6.4",
)
def mere_stiffness(resolution: Resolution) -> Found:
    """Return the forces without slip."""
    found, linear = (
        np.abs(forces_at(250.0, 15.0)).max(axis=0),
        np.abs(stuck(250.0, 15.0)).max(axis=0),
    )
    return Found((Fact("largest difference", float(np.abs(found - linear).max()), "N"),))


@claim(
    "non-smooth",
    "6.4.1",
    "the force at damper 2 is non-smooth, although damper 2 is never slipping",
    """Largest jump of the slope of f₂ from one sample of the period to the next, over the largest
    slope, at 550 rad/s, 35 N, and of the force if all stuck; whether contact 2 slips.""",
    rule=lambda n: verdict(n["jump"] > 5.0 * n["jump if stuck"] and n["contact 2 slips"] == 0),
    see="fig-6.5",
)
def non_smooth(resolution: Resolution) -> Found:
    """Corners of the force of contact 2."""
    jumps = [_jump(one(550.0, 35.0)[:, 1]) for one in (forces_at, stuck)]
    slipping = set().union(*orbit(550.0, 35.0).contact_states(0, 0).sets)
    return Found(
        (
            Fact("jump", jumps[0]),
            Fact("jump if stuck", jumps[1]),
            Fact("contact 2 slips", float(1 in slipping)),
        )
    )


@claim(
    "offset-forces",
    "6.4.1",
    "the forces at dampers 3 and 4 are offset with respect to the values they would have if all "
    "dampers were sticking all the time",
    """Middle of the range of f₃ and f₄ of the exact orbit at 550 rad/s, 35 N. Steady motion is
    symmetric; the printed offset is the preload of section 6.3.4.""",
    rule=lambda n: verdict(max(n.values()) > 0.1),
    see="fig-6.5",
)
def offset(resolution: Resolution) -> Found:
    """Offsets of the forces of contacts 3 and 4."""
    found = np.abs(middle(forces_at(550.0, 35.0)))
    return Found((Fact("f₃", float(found[2]), "N"), Fact("f₄", float(found[3]), "N")))


@claim(
    "two-at-once",
    "6.4.1",
    "there are times when damper 1 alone is slipping, times when damper 1 and 2 are slipping, and "
    "times when dampers 1 and 3 are slipping. For this particular force amplitude and at this "
    "frequency, two dampers at most are slipping at the same time.",
    """Most contacts that slip at once on the exact orbit at 550 rad/s, 140 N, and the largest share
    of its limit that contact 2 or 3 takes.""",
    rule=lambda n: verdict(n["slip at once"] == 2),
    see="fig-6.6",
)
def two_at_once(resolution: Resolution) -> Found:
    """Contacts that slip at 140 N."""
    forces = np.abs(forces_at(550.0, 140.0)).max(axis=0)
    return Found(
        (
            Fact(
                "slip at once",
                max(map(len, orbit(550.0, 140.0).contact_states(0, 0).sets)),
                "",
                2.0,
            ),
            Fact("share of the limit", float((forces / LIMITS)[1:3].max())),
        )
    )


@claim(
    "greater-than-stuck",
    "6.4.1",
    "The force transmitted by a slipping damper point can be greater than the force this damper "
    "interface would transmit if all the dampers were sticking",
    """Largest force over that of contacts that never slip, of a contact that slips and of any, at
    550 rad/s and 35, 140 and 550 N.""",
    rule=lambda n: verdict(n["of one that slips"] > 1.0, n["of any"] > 1.0),
    see="fig-6.6 fig-6.7",
)
def greater(resolution: Resolution) -> Found:
    """Return the forces over those of the stuck damper."""
    slipping, any_one = 0.0, 0.0
    for force in (35.0, 140.0, 550.0):
        found, linear = (np.abs(one(550.0, force)).max(axis=0) for one in (forces_at, stuck))
        ratio = found / linear
        slips = set().union(*orbit(550.0, force).contact_states(0, 0).sets)
        any_one = max(any_one, float(ratio.max()))
        slipping = max([slipping, *(float(ratio[point]) for point in slips)])
    return Found((Fact("of one that slips", slipping), Fact("of any", any_one)))


@claim(
    "never-with-elementary",
    "6.4.1",
    "for an elementary friction damper, the friction force is always smaller than the force the "
    "damper would transmit if it was never slipping",
    """Beam at eight loads, 100 to 300 rad/s: the most by which the amplitude of the force of a
    slipping damper exceeds that of one that never slips, as a factor.""",
    rule=lambda n: verdict(n["largest ratio"] <= 1.0),
)
def never_elementary(resolution: Resolution) -> Found:
    """Force of the elementary damper over that of a stuck one."""
    omega = np.linspace(100.0, 300.0, 201)
    worst = 0.0
    for load in ss.reference.SNECMA_LOADS:
        model = ss.reference.snecma_beam(load)
        held = model.replaced(
            contacts=[ss.Jenkins("damper", stiffness=ss.reference.DAMPER_STIFFNESS, slip_force=inf)]
        )
        true = ss.forced_response(model, omega, 15)
        linear = ss.forced_response(held, omega, 1).damper_amplitude((0, 0))
        slips = true.slip_fraction((0, 0)) > 0.0
        ratio = np.where(slips, true.damper_amplitude((0, 0)) / linear, 0.0)
        worst = max(worst, float(ratio.max()))
    return Found((Fact("largest ratio", worst),))


@claim(
    "three-at-once",
    "6.4.1",
    "when three dampers are slipping, all four friction forces are constant",
    """Contacts that slip at once at 550 rad/s, 550 N, and the largest change of any force from
    sample to sample while all three are on their limits, over the largest change of all.""",
    rule=lambda n: verdict(n["slip at once"] == 3 and n["largest change"] < 1e-9),
    see="fig-6.7",
)
def three_at_once(resolution: Resolution) -> Found:
    """Return the forces while three contacts slip."""
    forces = forces_at(550.0, 550.0)
    on = (np.abs(np.abs(forces[:, :3]) - LIMITS[:3]) < 1e-9 * LIMITS[:3]).all(axis=1)
    change = np.abs(np.diff(forces, axis=0))
    both = on[1:] & on[:-1] & (np.sign(forces[1:]) == np.sign(forces[:-1])).all(axis=1)
    return Found(
        (
            Fact(
                "slip at once",
                max(map(len, orbit(550.0, 550.0).contact_states(0, 0).sets)),
                "",
                3.0,
            ),
            Fact("largest change", float(change[both].max() / change.max())),
        )
    )


@claim(
    "force-4-non-smooth",
    "6.4.1",
    "even the force transmitted by the non-slipping damper, damper 4, is non-smooth. It can also "
    "be seen that there are discontinuities in the force derivatives",
    """Largest jump of the slope of f₄ from one of 128 instants to the next, over the largest slope,
    at 550 rad/s, 140 N, and of the force if all stuck.""",
    rule=lambda n: verdict(n["jump"] > 3.0 * n["jump if stuck"], n["jump"] > n["jump if stuck"]),
    see="fig-6.6",
)
def force_4(resolution: Resolution) -> Found:
    """Corners of the force of contact 4."""
    return Found(
        tuple(
            Fact(name, _jump(forces[:, 3]))
            for name, forces in (
                ("jump", forces_at(550.0, 140.0)),
                ("jump if stuck", stuck(550.0, 140.0)),
            )
        )
    )


@claim(
    "like-an-elementary-damper",
    "6.4.1",
    "The time history of the friction force at damper 1 is very similar to the time histories of "
    "elementary friction dampers.",
    """Share of the period at the limit, largest force over the limit, and turns of the force per
    period, of contact 1 at 550 rad/s, 35 N, and of the beam's damper at 20.313 N, 170 rad/s. Both
    are cut off; between the limits contact 1 goes back and forth, the elementary one does not.""",
    rule=lambda n: verdict(
        0.0 < n["share at the limit"] < 1.0 and n["turns"] == n["turns of the elementary damper"],
        0.0 < n["share at the limit"] < 1.0 and n["largest over the limit"] < 1.0 + 1e-9,
    ),
    see="fig-6.5 fig-4.1",
)
def like_elementary(resolution: Resolution) -> Found:
    """Shape of the force of contact 1."""
    force = forces_at(550.0, 35.0)[:, 0] / LIMITS[0]
    one = ss.exact_response(ss.reference.snecma_beam(20.313), [170.0])
    other = np.asarray(one.contact_force((0, 0), 0))
    return Found(
        (
            Fact("share at the limit", float((np.abs(force) > 1.0 - 1e-9).mean())),
            Fact("largest over the limit", float(np.abs(force).max())),
            Fact("turns", _turns(force)),
            Fact("turns of the elementary damper", _turns(other)),
        )
    )


def _turns(force: Float) -> int:
    change = np.diff(force, append=force[0])
    signs = np.sign(change[np.abs(change) > 1e-9 * np.ptp(force)])
    return int((signs != np.roll(signs, 1)).sum())


def _jump(force: Float) -> float:
    every = max(len(force) // 128, 1)
    slope = np.diff(np.append(force[::every], force[0]))
    return float(np.abs(slope - np.roll(slope, 1)).max() / np.abs(slope).max())

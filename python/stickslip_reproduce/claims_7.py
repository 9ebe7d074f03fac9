"""What chapter VII proposes, and whether it is done on the dissertation's beam."""

from __future__ import annotations

import numpy as np

from stickslip_reproduce.catalogue import items
from stickslip_reproduce.claims import Claim, Found, claim, verdict
from stickslip_reproduce.curves import PERIOD_SHARE
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution

PROPOSED = {
    "7.2-microslip": "more refined models of the friction interface have to be used in order to "
    "accurately predict the energy dissipated at an interface undergoing microslip",
    "7.2-normal-load": "It might be important to consider the effects of the variations of the "
    "normal load across the frictional interface.",
    "7.2-two-directions": "This assumption may not always be valid, especially if there is "
    "coupling between motions of the structure in more than one direction",
    "7.2-wedge": "the dampers may need to be considered as wedge elements connecting two adjacent "
    "blades",
    "7.2-damper-mass": "In some cases, the mass of the damper may need to be taken into account in "
    "the model.",
}
"""Future work by the name of the reproduction that does it."""


def _proposal(name: str, quote: str) -> Claim:
    def compute(_: Resolution) -> Found:
        return Found((Fact("reproductions that show it", float(name in items())),))

    made = claim(
        f"proposed-{name.removeprefix('7.2-')}",
        "7.2",
        quote,
        "Future work of the dissertation, done on its own beam: what changes is told there.",
        rule=lambda n: "holds" if n["reproductions that show it"] > 0 else "open",
        see=name,
    )
    return made(compute)


PROPOSALS = tuple(_proposal(name, quote) for name, quote in PROPOSED.items())

NODES = 40
"""Nodes of the shear layer."""

ELEMENTS = 400
"""Elements in parallel that stand for it."""

LAYER = np.diag(np.full(NODES, 2.0)) - np.eye(NODES, k=1) - np.eye(NODES, k=-1)
"""Stiffness of a bar that is pulled at its first node, over that of one of its pieces."""

LAYER[-1, -1] = 1.0

SHEAR = 0.02
"""Stiffness of the layer at a node over that of a piece of the bar; its slip force is this, too."""


@claim(
    "third-approach",
    "7.2",
    "Even if this third approach seems more general, it does not seem to bring more accuracy than "
    "the first two methods",
    """A bar on an elastoplastic shear layer, 40 nodes, pulled at its end with two harmonics so that
    it slips partly, then as a whole: largest difference of its force from that of 400 elastoplastic
    elements in parallel with the same first loading, over the largest force.""",
    rule=lambda n: verdict(n["largest difference"] < 1.0, n["largest difference"] < 5.0),
    see="7.2-microslip",
)
def third_approach(_: Resolution) -> Found:
    """Difference of a shear layer from elements in parallel."""
    angle = np.linspace(0.0, 4.0 * np.pi, 401)
    pulled = 40.0 * (np.sin(angle) + 0.5 * np.sin(3.0 * angle))
    loading = np.linspace(0.0, 1.1 * np.abs(pulled).max(), ELEMENTS + 1)
    elements = _elements(loading, _layer(loading))
    continuous, parallel = _layer(pulled), _parallel(pulled, *elements)
    apart = np.abs(continuous - parallel).max() / np.abs(continuous).max()
    series = (
        Series("shear layer", angle / (2.0 * np.pi), continuous, "limit"),
        Series("elements in parallel", angle / (2.0 * np.pi), parallel),
    )
    y = Axis("force over the slip force of a node")
    plot = Plot(PERIOD_SHARE, y, (Panel(series),))
    return Found((Fact("largest difference", 100.0 * float(apart), "%"),), plot)


def _layer(pulled: Float) -> Float:
    """Return the force at the end of the bar, over the slip force of a node."""
    moved, sliders, force = np.zeros(NODES), np.zeros(NODES), np.zeros_like(pulled)
    for place, end in enumerate(pulled):
        held = np.zeros(NODES)
        for _ in range(100):
            stuck = np.abs(moved - sliders) < 1.0
            held = np.clip(moved - sliders, -1.0, 1.0)
            residual = LAYER @ moved + SHEAR * held
            residual[0] -= end
            if np.abs(residual).max() < 1e-12 * (1.0 + abs(end)):
                break
            moved = moved - np.linalg.solve(LAYER + SHEAR * np.diag(stuck * 1.0), residual)
        sliders = moved - held
        force[place] = (end - moved[0]) / SHEAR
    return force


def _elements(loading: Float, force: Float) -> tuple[Float, Float]:
    """Return stiffnesses and slip displacements whose first loading is a given one."""
    slopes = np.diff(force) / np.diff(loading)
    return slopes - np.append(slopes[1:], 0.0), loading[1:]


def _parallel(pulled: Float, stiffness: Float, limit: Float) -> Float:
    held, force = np.zeros_like(limit), np.zeros_like(pulled)
    for place, change in enumerate(np.diff(pulled, prepend=0.0)):
        held = np.clip(held + change, -limit, limit)
        force[place] = stiffness @ held
    return force

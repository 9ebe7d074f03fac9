"""What chapter VII proposes, and whether it is done on the dissertation's beam."""

from __future__ import annotations

from stickslip_reproduce.catalogue import items
from stickslip_reproduce.claims import Claim, Found, claim
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution

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

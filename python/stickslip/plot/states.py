"""How stable, unstable and undecided motions look, and their names in the legend."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from stickslip.plot import style
from stickslip.plot.style import Colour, Looks
from stickslip.results.stability import STATES, States

__all__ = ["LINES", "marks", "name_states", "pieces"]

LINES = {"stable": "-", "unstable": "--", "not decided": ":"}
"""Style of the line by state."""


def marks(state: str, colour: Colour) -> Looks:
    """Return how single motions of a state are marked: full and hollow circles, and crosses."""
    fill = {"stable": colour, "unstable": "white", "not decided": "none"}[state]
    return style.mark("x" if state == "not decided" else "o", 4, colour, fill)


def name_states(ax: Axes, states: Iterable[States], *, single: bool = False) -> None:
    """Name the lines, or the marks of single motions, of the states that occur."""
    occurring = {str(state) for some in states for state in some}
    for state in STATES:
        if state in occurring:
            looks = (
                marks(state, style.GREY) if single else {"color": style.GREY, "ls": LINES[state]}
            )
            ax.plot([], [], label=state, **looks)


def pieces(states: States) -> list[tuple[slice, str]]:
    """Return the runs of equal states along a line, each joined to the one before it."""
    if not states.size:
        return []
    breaks = [0, *(np.flatnonzero(states[1:] != states[:-1]) + 1).tolist(), states.size]
    return [(slice(max(start - 1, 0), end), str(states[start])) for start, end in pairwise(breaks)]

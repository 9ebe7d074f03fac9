"""Bounds of a nonlinear mode over the residual tractions that Coulomb allows.

The mode is followed once more with all sliders at one limit or the other of what they may hold, as
the motion pushes them there, and half-way: in every corner of up to three contact points, of more
in eight that differ. What is found is attained, so that these are inner bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from stickslip import _core
from stickslip.analyses.run import Run
from stickslip.analyses.texts import told
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.fields import Float
from stickslip.settings.modes import ModeSettings

_CORNERS = 3
"""Contact points of which all corners are tried."""
_SHARES = (1.0, 0.5)
"""Of what contacts can hold at rest."""
_NO_WIDTH = 1e-6
"""Width of bounds, relative to them, that is none."""


@dataclass(frozen=True)
class ModeBounds:
    """The least and the largest frequency and damping of a mode at its amplitudes."""

    omega: Float
    """(n, 2) [rad/s]; not-a-number where they were not asked for."""
    damping: Float
    """(n, 2)."""
    corners: int
    """How many places of the sliders were tried; 0 if bounds were not asked for, ..."""
    lost: int
    """... and in how many of them some amplitude was not reached."""
    interrupted: bool

    @cached_property
    def told(self) -> tuple[Diagnostic, ...]:
        """At how many amplitudes residual tractions matter."""
        if not self.corners:
            return ()
        wide, known = np.zeros(len(self.omega), np.bool_), np.isfinite(self.omega[:, 0])
        for low, high in (self.omega.T, self.damping.T):
            wide |= high - low > _NO_WIDTH * np.abs(high)
        data = {"points": int(wide.sum()), "corners": self.corners}
        lost = {"places": self.lost, "corners": self.corners}
        return present(
            (
                told("bounds/modes", **data, _known=int(known.sum())),
                self.lost > 0 and told("bounds-not-found/modes", **lost),
            )
        )


def mode_bounds(
    model: Model, settings: ModeSettings, solution: _core.NonlinearMode, run: Run
) -> ModeBounds:
    """Return the bounds that belong to a mode, at the amplitudes of its way up.

    Nothing but not-a-number if the settings do not ask for them, or the mode was interrupted.
    """
    amplitude = solution.columns["amplitude"]
    nominal = np.stack([solution.columns[name] for name in ("omega", "damping_ratio")])
    bounds = np.full((2, amplitude.size, 2), np.nan)
    solved = np.isfinite(nominal[0])
    rising = np.flatnonzero(solved & (amplitude >= np.maximum.accumulate(amplitude)))
    if not settings.bounds or not rising.size or solution.interrupted:
        return ModeBounds(bounds[0], bounds[1], 0, 0, interrupted=solution.interrupted)
    known = np.unique(amplitude[rising])
    place = np.searchsorted(known, amplitude[rising])
    listed = settings.model_copy(update={"amplitudes": tuple(known.tolist()), "whole": False})
    points = sum(contact.points for contact in model.contacts)
    seen, interrupted, tried, lost = [nominal[:, rising]], False, 0, 0
    for corner in product(range(2 ** min(points, _CORNERS)), _SHARES):
        pushed = _core.nonlinear_mode(model.problem, listed, corner, run)
        if interrupted := pushed.interrupted:
            break
        columns = pushed.solution(run).columns
        seen.append(np.stack([columns[name] for name in ("omega", "damping_ratio")])[:, place])
        tried += 1
        lost += bool(np.isnan(seen[-1]).any())
    bounds[:, rising, 0] = np.nanmin(seen, axis=0)
    bounds[:, rising, 1] = np.nanmax(seen, axis=0)
    return ModeBounds(bounds[0], bounds[1], tried, lost, interrupted=interrupted)

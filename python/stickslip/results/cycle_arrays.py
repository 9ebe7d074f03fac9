"""The numbers of limit cycles along a branch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import ClassVar

import numpy as np

from stickslip.results.arrays import SHARE, Bool, Code, Complex, Float, Int, constant
from stickslip.results.fields import Columns, Numbers, column
from stickslip.results.status import Status

__all__ = ["CHANGE_KINDS", "CycleArrays"]

CHANGE_KINDS = ("fold", "complex pair", "symmetry", "grazing")
"""What can happen where stability changes."""


class CycleArrays(Columns):
    """The numbers of limit cycles along a branch.

    What only exact orbits have is not-a-number of other cycles.
    """

    labels: ClassVar[Mapping[str, Sequence[str]]] = {
        "side": ("low", "high"),
        "turn_entry": ("value", "omega"),
    }

    value: Float = column("cycle", "{unit}", "{followed} that is followed")
    ratio: Float = column("cycle", "1", "factor r on the negative damping")
    omega: Float = column("cycle", "rad/s", "angular frequency of the limit cycle", least=0.0)
    slipping: Bool = column("cycle", "1", "whether it lies on the slipping side")
    status: Code = column("cycle", "1", "how the point ended", codes=Status)
    harmonics: Int = column(
        "cycle",
        "1",
        "highest harmonic kept, or reported of exact orbits",
        least=0,
        file_name="harmonics_kept",
    )
    displacement: Complex = column(
        "cycle harmonic dof",
        "m",
        "harmonics of the displacement, x(t) = Re sum_k X_k exp(i k omega t)",
    )
    contact_displacement: Complex = column(
        "cycle harmonic point", "m", "harmonics of the relative displacement at the contacts"
    )
    contact_force: Complex = column(
        "cycle harmonic point",
        "N",
        "harmonics of the contact force against the relative displacement",
    )
    error_estimate: Float = column(
        "cycle dof",
        "m",
        "what the discarded harmonics could still change, 0 of exact orbits",
        least=0.0,
    )
    slip_fraction: Float = column(
        "cycle point", "1", "share of the period that the contact slips", least=0.0, most=SHARE
    )
    dissipation: Float = column("cycle point", "J", "friction work per cycle")
    range: Float = column("cycle dof side", "m", "lowest and highest displacement of exact orbits")
    state: Float = column(
        "cycle state_entry", "1", "state at t = 0 of exact orbits (x in m, v in m/s, f in N)"
    )
    multipliers: Complex = column(
        "cycle multiplier", "1", "Floquet multipliers over the period, without that of the phase"
    )
    neutral: Int = column("cycle", "1", "how many multipliers are neutral, exactly 1", least=0)
    closed: Bool = column("cycle", "1", "whether multipliers are of an exact orbit")
    turn: Float = column(
        "turn_entry", "1", "value and omega where the branch turns for good, if it does"
    )
    folds: Float = column("fold turn_entry", "1", "value and omega where it turns")
    change: Float = column(
        "change_of_stability turn_entry", "1", "value and omega where its stability changes"
    )
    change_after: Int = column(
        "change_of_stability",
        "1",
        "position of the cycle before the change",
        least=0,
        most="cycle",
    )
    change_kind: Int = column("change_of_stability", "1", "what happens there", codes=CHANGE_KINDS)
    change_unstable: Int = column(
        "change_of_stability side",
        "1",
        "multipliers outside the unit circle before and after",
        least=0,
    )
    negative_damping: Numbers = column(
        "diameter row column",
        "kg/s",
        "C_neg of the damping C + r C_neg; of a tuned disk by nodal diameter",
        optional=True,
    )

    @property
    def limit(self) -> tuple[float, float] | None:
        """Value and frequency where the branch turns for good, if it does."""
        value, omega = self.turn
        return None if np.isnan(value) else (float(value), float(omega))

    @cached_property
    def known(self) -> Bool:
        """(n,) Whether the multipliers of a cycle are known."""
        return constant(np.isfinite(self.multipliers).all(axis=1) & (self.multipliers.shape[1] > 0))

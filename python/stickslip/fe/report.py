"""What a reduction is checked for before it is trusted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import diags_array

from stickslip.checks import whole_number
from stickslip.fe.sparse import Factor, lowest_modes

if TYPE_CHECKING:
    from stickslip.fe.reduction import Reduction

__all__ = ["ReductionReport", "reported"]

_RIGID = 1e-3
"""A mode below this part of the first elastic one is a rigid-body mode."""


@dataclass(frozen=True, eq=False)
class ReductionReport:
    """Checks of a reduction.

    Attributes
    ----------
    sizes : tuple of int
        Degrees of freedom: full, boundary, fixed-interface modes.
    asymmetry : tuple of float
        Of mass and stiffness as given, as a part of the largest entry.
    decoupling : float
        Stiffness between constraint and fixed-interface modes, 0 but for rounding, as a part of the
        largest entry.
    rigid : int
        Rigid-body modes of the full structure: 0 is grounded, 6 is free.
    masses : dict of str to float
        Mass that a translation moves [kg], by direction "1", "2", "3"; empty without names such as
        "17.3". Clamped degrees of freedom are not in it.
    grounding : dict of str to float
        Force that it takes to move the whole structure by a unit translation, as a part of the sum
        of its stiffnesses: 0 where it is free to move.
    full, reduced : ndarray of float64, shape (frequencies,)
        Natural frequencies [rad/s], ascending.
    """

    sizes: tuple[int, int, int]
    asymmetry: tuple[float, float]
    decoupling: float
    rigid: int
    masses: dict[str, float]
    grounding: dict[str, float]
    full: NDArray[np.float64]
    reduced: NDArray[np.float64]

    @property
    def errors(self) -> NDArray[np.float64]:
        """How much higher the reduced frequencies are, relative; nan of rigid-body modes."""
        errors = np.full(self.full.size, np.nan)
        elastic = slice(self.rigid, None)
        errors[elastic] = self.reduced[elastic] / self.full[elastic] - 1.0
        return errors

    def __str__(self) -> str:
        full, boundary, modes = self.sizes
        lines = [
            f"{full} dofs reduced to {boundary} of the boundary and {modes} fixed-interface modes",
            f"asymmetry          mass {self.asymmetry[0]:.1e}, stiffness {self.asymmetry[1]:.1e}",
            f"decoupling         {self.decoupling:.1e} of the largest stiffness",
            f"rigid-body modes   {self.rigid}" + ("" if self.rigid else ": the structure is held"),
        ]
        for way, mass in self.masses.items():
            part = self.grounding[way]
            held = "free to move" if part < 1e-10 else "held"
            lines.append(f"direction {way}        {mass:.6g} kg, {held} ({part:.1e})")
        lines.append("mode   full [Hz]      reduced [Hz]   error")
        for mode, (one, other, error) in enumerate(
            zip(self.full, self.reduced, self.errors, strict=True), 1
        ):
            shown = "rigid body" if np.isnan(error) else f"{error:.1e}"
            hertz, reduced = one / (2.0 * np.pi), other / (2.0 * np.pi)
            lines.append(f"{mode:4d}   {hertz:<12.6g}   {reduced:<12.6g}   {shown}")
        return "\n".join(lines)


def reported(
    reduction: Reduction, frequencies: int, springs: Mapping[int, float]
) -> ReductionReport:
    """Return the report; `springs` by position in the boundary [N/m]."""
    count = whole_number(frequencies, "frequencies", smallest=1, largest=reduction.size - 1)
    count = min(count, len(reduction.dofs))
    K, M = reduction.full_stiffness, reduction.full_mass
    reduced = reduction.stiffness.copy()
    added = np.zeros(reduction.size)
    for place, value in springs.items():
        added[reduction.rows[place]] += value
        reduced[place, place] += value
    K = (K + diags_array(added)).tocsc()
    # Below 0, so that a free structure can be factored too.
    shift = -0.1 * float(reduction.omega[0]) ** 2
    factor = Factor((K - shift * M).tocsc())
    squares, _ = lowest_modes(K, M, count, factor, shift)
    own = eigh(reduced, reduction.mass, eigvals_only=True)[:count]
    omegas = np.sqrt(np.clip(squares, 0.0, None))
    masses, grounding = _translations(reduction)
    return ReductionReport(
        (reduction.size, len(reduction.boundary), reduction.omega.size),
        reduction.asymmetry,
        reduction.decoupling,
        int((omegas < _RIGID * reduction.omega[0]).sum()),
        masses,
        grounding,
        omegas,
        np.sqrt(np.clip(own, 0.0, None)),
    )


def _translations(reduction: Reduction) -> tuple[dict[str, float], dict[str, float]]:
    """Return mass and resistance of the whole structure against translations."""
    masses: dict[str, float] = {}
    grounding: dict[str, float] = {}
    ways = [name.rpartition(".")[2] for name in reduction.row_names or ()]
    for way in ("1", "2", "3"):
        moved = np.array([one == way for one in ways], dtype=np.float64)
        if moved.any():
            total = float(moved @ (reduction.full_stiffness.diagonal() * moved))
            masses[way] = float(moved @ (reduction.full_mass @ moved))
            held = float(np.abs(reduction.full_stiffness @ moved).sum())
            grounding[way] = held / total if total else 0.0
    return masses, grounding

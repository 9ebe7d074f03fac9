"""Aerodynamic influence coefficients of the blades of a tuned disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Complex
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, text, whole_number
from stickslip.errors import ModelError
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    pass

__all__ = ["InfluenceCoefficients"]


@dataclass(frozen=True)
class InfluenceCoefficients:
    """Aerodynamic force on a blade per displacement of itself and of its neighbours.

    A blade that moves as Re x exp(i omega t) exerts Re L_j x exp(i omega t) on the blade j places
    before it; in a travelling wave of nodal diameter d of n blades, each ahead of the one before by
    2 pi d / n, the force on every blade is its own displacement times

        L(d) = sum_j L_j exp(2 pi i d j / n).

    Its real part is a stiffness less, its imaginary part over omega a damping less: a positive
    imaginary part feeds energy into the wave.

    Parameters
    ----------
    coefficients : mapping of int to complex
        L_j by the place j of the moving blade: 0 the blade itself, 1 the next, -1 the one before.
        In N/m at a `dof`; of a `mode` with unit modal mass in 1/s^2.
    dof : str, optional
        The degree of freedom that moves and is acted on.
    mode : int, optional
        Instead: the mode of a blade by itself, counted from 0, along which it moves.

    Raises
    ------
    ModelError
        If there is no coefficient, one is not finite, or not exactly one of dof and mode is given.

    References
    ----------
    Hanamura, Tanaka and Yamaguchi (1980); Crawley (1988) on travelling-wave and influence
    coefficients.
    """

    coefficients: Mapping[int, complex]
    dof: str | None = None
    mode: int | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.coefficients, Mapping) or not self.coefficients:
            raise ModelError(
                f"influence coefficients: {brief(self.coefficients)} is no mapping; give "
                "{0: ..., 1: ..., -1: ...}"
            )
        checked: dict[int, complex] = {}
        for place, value in self.coefficients.items():
            if isinstance(place, bool) or not isinstance(place, int | np.integer):
                raise ModelError(f"influence coefficients: place {brief(place)} is no whole number")
            if not isinstance(value, Complex) or not np.isfinite(complex(value)):
                raise ModelError(
                    f"influence coefficient {place}: {brief(value)} is no finite number; give L_j "
                    "in N/m"
                )
            checked[int(place)] = complex(value)
        if (self.dof is None) == (self.mode is None):
            raise ModelError("influence coefficients: give exactly one of dof and mode")
        if self.dof is not None:
            text(self.dof, "influence coefficients: dof")
        else:
            whole_number(self.mode, "influence coefficients: mode")
        object.__setattr__(self, "coefficients", MappingProxyType(checked))

    def at(self, diameter: int, sectors: int) -> complex:
        """Return L(d), the coefficient of a travelling wave.

        Parameters
        ----------
        diameter : int
            Nodal diameter d, 0 to n-1; n - d runs the other way round.
        sectors : int
            Number n of blades.

        Returns
        -------
        complex
            In the unit of the coefficients.
        """
        turn = 2j * np.pi * diameter / sectors
        return complex(sum(L * np.exp(turn * j) for j, L in self.coefficients.items()))

    def direction(self, structure: Structure) -> NDArray[np.float64]:
        """Return the vector p of the force p L p^T x on a blade, shape (N,).

        Parameters
        ----------
        structure : Structure
            A blade by itself.

        Returns
        -------
        ndarray of float64, shape (N,)
            The unit vector of the dof, or M phi of the mode phi with unit modal mass.

        Raises
        ------
        ModelError
            If the blade has no such dof or mode.
        """
        if self.dof is not None:
            unit: NDArray[np.float64] = np.eye(len(structure))[structure.index(self.dof)]
            return unit
        from scipy.linalg import eigh

        mode = whole_number(self.mode, "influence coefficients: mode")
        if mode >= len(structure):
            raise ModelError(
                f"influence coefficients: mode {mode}; a blade has {len(structure)}, counted from 0"
            )
        _, shapes = eigh(structure.stiffness, structure.mass)
        return np.asarray(structure.mass @ shapes[:, mode], dtype=np.float64)

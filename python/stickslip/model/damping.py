"""Damping laws: what makes a damping matrix of mass and stiffness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from stickslip.checks import Matrix, brief, real_number
from stickslip.errors import ModelError

__all__ = ["DampingLaw", "ModalDamping", "Rayleigh", "law_from_spec"]


@dataclass(frozen=True, kw_only=True)
class Rayleigh:
    """Proportional damping, C = mass * M + stiffness * K.

    Parameters
    ----------
    mass : float, optional
        Factor on the mass matrix [1/s].
    stiffness : float, optional
        Factor on the stiffness matrix [s]. Negative factors describe negative damping.

    Raises
    ------
    ModelError
        If a factor is not a finite number.
    """

    mass: float = 0.0
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", real_number(self.mass, "Rayleigh mass factor"))
        factor = real_number(self.stiffness, "Rayleigh stiffness factor")
        object.__setattr__(self, "stiffness", factor)

    def to_spec(self) -> dict[str, object]:
        """Return the law in plain values; see `law_from_spec`."""
        return {"law": "rayleigh", "mass": self.mass, "stiffness": self.stiffness}

    def matrix(self, mass: Matrix, stiffness: Matrix) -> Matrix:
        """Return the damping matrix.

        Parameters
        ----------
        mass, stiffness : ndarray of float64, shape (N, N)
            The structure's matrices [kg], [N/m].

        Returns
        -------
        ndarray of float64, shape (N, N)
            Damping [kg/s].

        Raises
        ------
        ModelError
            If it is not finite.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            return _finite(self.mass * mass + self.stiffness * stiffness, self)


@dataclass(frozen=True)
class ModalDamping:
    """Damping ratios of the structure's own modes, its contacts being free.

    With mass-normalised modes Phi, C = M Phi diag(2 zeta omega) Phi^T M. Rigid-body modes stay
    undamped.

    Parameters
    ----------
    ratio : float or sequence of float
        Fraction of critical damping: one for all modes, or one per mode in ascending frequency.

    Raises
    ------
    ModelError
        If a ratio is not a finite number; on use, if the number of ratios is not the number of
        modes or the stiffness matrix has a negative eigenvalue.
    """

    ratio: float | Sequence[float]

    def __post_init__(self) -> None:
        given = self.ratio.tolist() if isinstance(self.ratio, np.ndarray) else self.ratio
        ratio: float | tuple[float, ...]
        if isinstance(given, Sequence) and not isinstance(given, str):
            ratio = tuple(
                real_number(value, f"damping ratio at position {mode}")
                for mode, value in enumerate(given)
            )
        else:
            ratio = real_number(given, "damping ratio")
        object.__setattr__(self, "ratio", ratio)

    def to_spec(self) -> dict[str, object]:
        """Return the law in plain values; see `law_from_spec`."""
        ratio = list(self.ratio) if isinstance(self.ratio, Sequence) else self.ratio
        return {"law": "modal", "ratio": ratio}

    def matrix(self, mass: Matrix, stiffness: Matrix) -> Matrix:
        """Return the damping matrix.

        Parameters
        ----------
        mass, stiffness : ndarray of float64, shape (N, N)
            The structure's matrices [kg], [N/m].

        Returns
        -------
        ndarray of float64, shape (N, N)
            Damping [kg/s].

        Raises
        ------
        ModelError
            If there are not N ratios, an eigenvalue is negative, or the damping is not finite.
        """
        from scipy.linalg import eigh

        size = len(mass)
        ratios = np.asarray(self.ratio, dtype=np.float64)
        if ratios.ndim == 1 and ratios.size != size:
            raise ModelError(
                f"damping: {ratios.size} ratios for {size} modes; give one per mode, or one for all"
            )
        squares, modes = eigh(stiffness, mass)
        if squares[0] < -1e-8 * np.abs(squares).max():
            raise ModelError(
                f"damping: the lowest mode has omega^2 = {squares[0]:.6g} < 0, a ratio means "
                "nothing there; give a damping matrix"
            )
        # The eigenvalues of rigid-body modes are rounding noise of either sign.
        omega = np.sqrt(np.clip(squares, 0.0, None))
        shapes = mass @ modes
        with np.errstate(over="ignore", invalid="ignore"):
            damping = (shapes * (2.0 * ratios * omega)) @ shapes.T
        return _finite(np.asarray(damping, dtype=np.float64), self)


def _finite(damping: Matrix, law: Rayleigh | ModalDamping) -> Matrix:
    if not np.isfinite(damping).all():
        raise ModelError(f"damping: {brief(law)} makes entries beyond 1e308; give smaller numbers")
    return damping


DampingLaw: TypeAlias = Rayleigh | ModalDamping
"""What makes a damping matrix of mass and stiffness."""


def law_from_spec(spec: Mapping[str, object]) -> DampingLaw:
    """Build a damping law from the plain values of its `to_spec`.

    Parameters
    ----------
    spec : mapping
        `law`, "rayleigh" or "modal", and its numbers.

    Returns
    -------
    Rayleigh or ModalDamping
        The law.

    Raises
    ------
    ModelError
        If there is no such law, or it refuses a number.
    """
    values = {key: value for key, value in spec.items() if key != "law"}
    laws = {"rayleigh": Rayleigh, "modal": ModalDamping}
    if spec.get("law") not in laws:
        raise ModelError(f"damping: unknown law {brief(spec.get('law'))}; known: {list(laws)}")
    made: DampingLaw = laws[str(spec["law"])](**values)
    return made

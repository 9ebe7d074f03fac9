"""Damping laws: what makes a damping matrix of mass and stiffness; modes of these two."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, brief, members, set_fields
from stickslip.errors import ModelError
from stickslip.interruption import beside
from stickslip.model.dofs import Dofs
from stickslip.units import physical_number

_SMALL = 300
"""Rows up to which it is solved at once: some hundredths of a second."""


def eigen_pencil(first: NDArray[Any], second: NDArray[Any]) -> tuple[Matrix, NDArray[Any]]:
    """Return values, rising, and vectors of A x = value B x, with x^H B x = 1.

    A is Hermitian, B positive definite too; `numpy.linalg.LinAlgError` says that B is not. It is
    LAPACK's way, Cholesky's method and divide and conquer, step by step: SciPy's own lets no other
    thread run until it ends, and so hears no Ctrl-C.
    """
    from scipy.linalg import eigh, solve_triangular

    if len(first) <= _SMALL:
        values, vectors = eigh(first, second)
        return values, vectors

    def work() -> tuple[Matrix, NDArray[Any]]:
        lower = np.linalg.cholesky(second)
        half = solve_triangular(lower, first, lower=True)
        standard = solve_triangular(lower, half.conj().T, lower=True)
        values, turned = np.linalg.eigh(0.5 * (standard + standard.conj().T))
        return values, solve_triangular(lower, turned, lower=True, trans="C")

    return beside(work)


_ROUNDING = 1e-13
# Ratio of stiffness over mass between dofs from which their order decides how many digits slow
# modes keep.
_GRADED = 1e6


@runtime_checkable
class Restraint(Protocol):
    """What holds a structure while it sticks: a contact."""

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while it sticks [N/m], shape (points, points)."""

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x, shape (points, N)."""

    def to_spec(self) -> dict[str, object]:
        """Return it in plain values."""


class _DampingLaw(ABC):
    """What makes a damping matrix of mass and stiffness."""

    @property
    @abstractmethod
    def proportional(self) -> bool:
        """Whether it couples no modes of the structure by itself."""

    @abstractmethod
    def matrix(self, mass: Matrix, stiffness: Matrix, dofs: Sequence[str] | None = None) -> Matrix:
        """Return the damping matrix [kg/s] of mass and stiffness [kg], [N/m], shape (N, N).

        Stuck contacts find their places by the names `dofs` of the structure.
        """


@dataclass(frozen=True, kw_only=True)
class Rayleigh(_DampingLaw):
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
        for name, unit in (("mass", "1/s"), ("stiffness", "s")):
            factor = physical_number(getattr(self, name), unit, f"Rayleigh {name} factor")
            object.__setattr__(self, name, factor)

    @property
    def proportional(self) -> bool:
        """Whether it couples no modes of the structure by itself: always."""
        return True

    def to_spec(self) -> dict[str, object]:
        """Return the law in plain values; see `law_from_spec`."""
        return {"law": "rayleigh", "mass": self.mass, "stiffness": self.stiffness}

    def matrix(self, mass: Matrix, stiffness: Matrix, dofs: Sequence[str] | None = None) -> Matrix:
        """Return the damping matrix [kg/s] of mass and stiffness [kg], [N/m], shape (N, N)."""
        with np.errstate(over="ignore", invalid="ignore"):
            damping = self.mass * mass
            damping += self.stiffness * stiffness
            return _finite(damping, self)


@dataclass(frozen=True)
class ModalDamping(_DampingLaw):
    """Damping ratios of modes, as `modal_damping` gives them.

    With mass-normalised modes Phi, C = M Phi diag(2 zeta omega) Phi^T M. Rigid-body modes stay
    undamped.

    Parameters
    ----------
    ratio : float or sequence of float
        Fraction of critical damping: one for all modes, or one per mode in ascending frequency.
        Negative ratios feed energy into a mode.
    stuck : iterable of Contact, optional
        Contacts that stick in these modes. Default: none, the modes of the structure by itself.

    Raises
    ------
    ModelError
        If a ratio is not a finite number; on use, if the number of ratios is not the number of
        modes or the stiffness matrix has a negative eigenvalue.
    """

    ratio: float | Sequence[float]
    stuck: Iterable[Restraint] = ()

    def __post_init__(self) -> None:
        given = self.ratio.tolist() if isinstance(self.ratio, np.ndarray) else self.ratio
        ratio: float | tuple[float, ...]
        if isinstance(given, Sequence) and not isinstance(given, str):
            ratio = tuple(
                physical_number(value, "", f"damping ratio at position {mode}")
                for mode, value in enumerate(given)
            )
        else:
            ratio = physical_number(given, "", "damping ratio")
        set_fields(self, ratio=ratio, stuck=_contacts(self.stuck))

    @property
    def proportional(self) -> bool:
        """Whether it couples no modes of the structure by itself: unless contacts are `stuck`."""
        return not self.stuck

    def to_spec(self) -> dict[str, object]:
        """Return the law in plain values; see `law_from_spec`."""
        ratio = list(self.ratio) if isinstance(self.ratio, Sequence) else self.ratio
        stuck = [contact.to_spec() for contact in self.stuck]
        return {"law": "modal", "ratio": ratio, **({"stuck": stuck} if stuck else {})}

    def matrix(self, mass: Matrix, stiffness: Matrix, dofs: Sequence[str] | None = None) -> Matrix:
        """Return the damping matrix [kg/s] of mass and stiffness [kg], [N/m], shape (N, N)."""
        size = int(mass.any(axis=1).sum())
        ratios = np.asarray(self.ratio, dtype=np.float64)
        if ratios.ndim == 1 and ratios.size != size:
            raise ModelError(
                f"damping: {ratios.size} ratios for {size} modes; give one per mode, or one for all"
            )
        held = stiffness
        if self.stuck:
            names = Dofs(map(str, range(len(mass))) if dofs is None else dofs)
            held = held_stiffness(stiffness, names, self.stuck)
        squares, modes = modes_of(held, mass)
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


DampingLaw: TypeAlias = Rayleigh | ModalDamping


def modes_of(stiffness: NDArray[Any], mass: NDArray[Any]) -> tuple[Matrix, NDArray[Any]]:
    """Return squares of natural frequencies, shape (n,), and mass-normalised modes, shape (N, n).

    There are as many as degrees of freedom with mass; those without follow statically.
    """
    own = mass.any(axis=1)
    if not own.all():
        try:
            carried = -np.linalg.solve(stiffness[np.ix_(~own, ~own)], stiffness[np.ix_(~own, own)])
        except np.linalg.LinAlgError:
            raise ModelError(
                "modes: nothing holds a dof without mass but contacts; give it a mass, or a spring"
            ) from None
        held = stiffness[np.ix_(own, own)] + stiffness[np.ix_(own, ~own)] @ carried
        squares, shapes = modes_of(0.5 * (held + held.conj().T), mass[np.ix_(own, own)])
        modes = np.empty((len(mass), len(shapes)), shapes.dtype)
        modes[own], modes[~own] = shapes, carried @ shapes
        return squares, modes
    order = _graded(stiffness, mass)
    squares, modes = eigen_pencil(stiffness[np.ix_(order, order)], mass[np.ix_(order, order)])
    return squares, modes[np.argsort(order)]


def _graded(stiffness: Matrix, mass: Matrix) -> NDArray[np.intp]:
    """Return the order of dofs in which their modes keep their digits: the lightest first."""
    rates = np.abs(np.diag(stiffness)) / np.diag(mass).real
    if not rates.max() > _GRADED * rates.min():
        return np.arange(len(mass))
    return np.argsort(-rates, kind="stable")


def held_stiffness(stiffness: Matrix, dofs: Dofs, contacts: Iterable[Restraint]) -> Matrix:
    """Return the stiffness of a structure with contacts stuck, shape (N, N) [N/m]."""
    for contact in contacts:
        rows = contact.rows(dofs)
        stiffness = stiffness + rows.T @ contact.stuck_stiffness @ rows
    return stiffness


def _contacts(stuck: object) -> tuple[Restraint, ...]:
    given = members(stuck, "stuck", "stuck=[...]") if isinstance(stuck, Iterable) else (stuck,)
    for contact in given:
        if not isinstance(contact, Restraint):
            raise ModelError(
                f"stuck: {brief(contact)} is no contact; give a model, or its contacts"
            )
    return tuple(given)


def _finite(damping: Matrix, law: DampingLaw) -> Matrix:
    if not np.isfinite(damping).all():
        raise ModelError(f"damping: {brief(law)} makes entries beyond 1e308; give smaller numbers")
    return damping


def makes_blocks(law: DampingLaw | None, blocks: Iterable[tuple[Matrix, Matrix, Matrix]]) -> bool:
    """Tell whether Rayleigh damping of a sector holds with what couples it to its neighbours.

    The blocks are mass, damping and stiffness of the sector and of its coupling, or of several
    sectors. A law of modes does not know those of the coupled sectors.
    """
    if not isinstance(law, Rayleigh):
        return False
    return all(
        bool(np.abs(law.matrix(M, K) - C).max() <= _ROUNDING * np.abs(C).max())
        for M, C, K in blocks
    )

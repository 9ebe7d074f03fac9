"""Damping laws: what makes a damping matrix of mass and stiffness."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, brief, members, real_number, set_fields
from stickslip.errors import ModelError

if TYPE_CHECKING:
    from stickslip.model.contact import Contact
    from stickslip.model.model import Model
    from stickslip.model.structure import Structure

_ROUNDING = 1e-13
# Ratio of stiffness over mass between dofs from which their order decides how many digits slow
# modes keep.
_GRADED = 1e6


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
        for name in ("mass", "stiffness"):
            factor = real_number(getattr(self, name), f"Rayleigh {name} factor")
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
            return _finite(self.mass * mass + self.stiffness * stiffness, self)


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
    stuck: Iterable[Contact] = ()

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
        from scipy.linalg import eigh

        from stickslip.model.structure import Structure

        size = len(mass)
        ratios = np.asarray(self.ratio, dtype=np.float64)
        if ratios.ndim == 1 and ratios.size != size:
            raise ModelError(
                f"damping: {ratios.size} ratios for {size} modes; give one per mode, or one for all"
            )
        held = stiffness
        if self.stuck:
            held = held_stiffness(Structure(mass, stiffness, dofs=dofs), self.stuck)
        order = _graded(held, mass)
        squares, modes = eigh(held[np.ix_(order, order)], mass[np.ix_(order, order)])
        modes = modes[np.argsort(order)]
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


def _graded(stiffness: Matrix, mass: Matrix) -> NDArray[np.intp]:
    """Return the order of dofs in which their modes keep their digits: the lightest first."""
    rates = np.abs(np.diag(stiffness)) / np.diag(mass)
    if not rates.max() > _GRADED * rates.min():
        return np.arange(len(mass))
    return np.argsort(-rates, kind="stable")


def held_stiffness(structure: Structure, contacts: Iterable[Contact]) -> Matrix:
    """Return the stiffness of a structure with contacts stuck, shape (N, N) [N/m]."""
    held = structure.stiffness
    for contact in contacts:
        rows = contact.rows(structure)
        held = held + rows.T @ contact.stuck_stiffness @ rows
    return held


def modal_damping(
    ratio: float | Sequence[float], *, stuck: Model | Iterable[Contact] = ()
) -> ModalDamping:
    """Damping given by ratios of critical damping, mode by mode.

    C = M Phi diag(2 zeta omega) Phi^T M with mass-normalised modes Phi.

    The aerodynamic input of a flutter analysis: negative ratios of the modes that the flow drives.
    It serves wherever a damping matrix does: as `damping` of a `Structure`, and as the
    `negative_damping` that `destabilised` adds.

    Parameters
    ----------
    ratio : float or sequence of float, shape (N,)
        As of `ModalDamping`; 0 leaves a mode alone.
    stuck : Model or iterable of Contact, optional
        Whose modes: with these contacts stuck, of a model all of them. Default: none, the modes of
        the structure by itself, in which all contacts slip without friction. The former are those
        that flutter sets in with, the latter those of a structure computed without its dampers.

    References
    ----------
    Guillen (1999), eq. (5.29), corrected: T^T M T = diag(m) and C = T^-T diag(c) T^-1, of which
    this is the form with m = 1 and c = 2 zeta omega.

    Examples
    --------
    >>> import stickslip as ss
    >>> beam = ss.reference.snecma_beam()
    >>> aero = ss.modal_damping([-0.01, 0.0, 0.002], stuck=beam)
    >>> ss.destabilised(beam, aero, ratio=0.5).structure.damping.shape
    (3, 3)
    """
    from stickslip.model.model import Model

    return ModalDamping(ratio, stuck.contacts if isinstance(stuck, Model) else stuck)


def _contacts(stuck: object) -> tuple[Contact, ...]:
    from stickslip.model.contact import Contact

    given = members(stuck, "stuck", "stuck=[...]") if isinstance(stuck, Iterable) else (stuck,)
    for contact in given:
        if not isinstance(contact, Contact):
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


def law_from_spec(spec: Mapping[str, Any]) -> DampingLaw:
    """Build a damping law from the plain values of its `to_spec`."""
    from stickslip.model.laws import contact_from_spec

    values = {key: value for key, value in spec.items() if key != "law"}
    if isinstance(values.get("stuck"), list):
        values["stuck"] = [contact_from_spec(one) for one in values["stuck"]]
    laws: dict[object, type[DampingLaw]] = {"rayleigh": Rayleigh, "modal": ModalDamping}
    if spec.get("law") not in laws:
        raise ModelError(f"damping: unknown law {brief(spec.get('law'))}; known: {list(laws)}")
    return laws[spec["law"]](**values)

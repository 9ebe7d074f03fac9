"""Linear structures: mass, damping and stiffness matrices with named degrees of freedom."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import (
    Matrix,
    MatrixLike,
    as_list,
    brief,
    members,
    real_matrix,
    require_finite,
    require_square,
    set_fields,
    text,
)
from stickslip.errors import ModelError
from stickslip.model.coupling import Coupling
from stickslip.model.damping import DampingLaw
from stickslip.model.dofs import Dofs
from stickslip.model.matrix_units import MatrixUnits, Units
from stickslip.model.stability import ROUNDING, scaled_pivots, unstable_row

ASYMMETRY = 1e-8
"""Asymmetry, over the largest entry, that rounded digits of printed matrices may leave."""
_SHOWN = 6


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Structure(Dofs):
    """A linear structure, M x'' + C x' + K x = forces.

    Parameters
    ----------
    mass : array_like or scipy.sparse matrix, shape (N, N)
        Symmetric and positive definite [kg]. A row of zeros is a degree of freedom without mass:
        stiffness and contacts alone decide how it moves, and nothing may damp it.
    stiffness : array_like or scipy.sparse matrix, shape (N, N)
        Symmetric [N/m]. It may be singular: a free structure has rigid-body modes. An asymmetry of
        mass or stiffness up to 1e-8 of the largest entry, as printed digits leave it, is averaged
        out.
    damping : array_like, scipy.sparse matrix, Rayleigh, ModalDamping or None, optional
        Viscous damping [kg/s], any real matrix (gyroscopic terms are skew). None is no damping.
    dofs : sequence of str, optional
        One name per degree of freedom, by which contacts, forces and results refer to it.
        Default "0", "1", ...
    units : str, optional
        Mass, length and time of the matrices: "t-mm-s" for tonne, millimetre and second, so that
        stiffnesses are in N/mm. Rotations ("12.4", "tip.rx") stay radians. Default: SI.

    Raises
    ------
    ModelError
        If a matrix is complex, not finite, not square or of another size than the mass; if mass
        or stiffness is not symmetric; if the mass is not positive definite; if damping acts on a
        degree of freedom without mass; if a name is missing, empty or given twice.

    Examples
    --------
    >>> import stickslip as ss
    >>> ss.Structure(mass=[[2.0]], stiffness=[[8.0]], damping=ss.ModalDamping(0.01), dofs=["tip"])
    Structure(1 dof: tip)
    """

    mass: Matrix
    stiffness: Matrix
    damping: Matrix
    dofs: tuple[str, ...]
    damping_law: DampingLaw | None
    """What the damping was made of; None where it was given as a matrix."""
    proportional: bool
    """Whether the damping couples none of the structure's modes because of what it was made of: a
    law, or parts of `join` that each have one. Of a matrix rounding decides whether it does."""
    accurate_to: float
    """Angular frequency up to which it is as right as what it was reduced from [rad/s], see
    `Reduction`; infinite where that is not known."""

    def __init__(
        self,
        mass: MatrixLike,
        stiffness: MatrixLike,
        damping: MatrixLike | DampingLaw | None = None,
        dofs: Iterable[str] | None = None,
        *,
        units: Units = None,
    ) -> None:
        M, K = real_matrix(mass, "mass"), real_matrix(stiffness, "stiffness")
        if not M.size:
            raise ModelError("mass: 0 x 0; a structure needs at least one dof")
        require_square(M, "mass")
        names = _names(names_of_tables(dofs, (mass, stiffness, damping)), len(M))
        if units is not None:
            known = MatrixUnits.of(units)
            M, K = known.in_si(M, "mass", names), known.in_si(K, "stiffness", names)
            if damping is not None and not isinstance(damping, DampingLaw):
                damping = known.in_si(real_matrix(damping, "damping"), "damping", names)
        M, K = _symmetric(M, "mass", names), _symmetric(K, "stiffness", names)
        massless = np.asarray(~M.any(axis=1))
        _require_positive(M, ~massless, names)
        C = _damping(damping, M, K, names)
        _require_undamped(C, massless, names)
        law = damping if isinstance(damping, DampingLaw) else None
        proportional = law.proportional if law is not None else not C.any()
        set_fields(self, mass=M, stiffness=K, damping=C, dofs=names)
        set_fields(self, damping_law=law, proportional=proportional, accurate_to=np.inf)

    def __repr__(self) -> str:
        shown = ", ".join(self.dofs[:_SHOWN]) + (", ..." if len(self) > _SHOWN else "")
        return f"Structure({len(self)} dof{'s' if len(self) > 1 else ''}: {shown})"

    def __reduce__(self) -> tuple[object, ...]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        matrices = self.mass, self.stiffness, self.damping
        how = self.damping_law, self.proportional, self.accurate_to
        return Structure.of_law, (*matrices, self.dofs, *how)

    @cached_property
    def is_damped(self) -> bool | None:
        """Whether the damping takes energy out of every motion; None if it does so of some alone.

        False if it feeds energy into one.
        """
        # Gyroscopic terms are skew and do no work: only the symmetric part takes energy out.
        if scaled_pivots(self.damping, -1e-13) is not None:
            return True
        return None if scaled_pivots(self.damping, ROUNDING) is not None else False

    @cached_property
    def unstable_dof(self) -> str | None:
        """Name of the dof that moves most where the stiffness is negative; None if it never is.

        By itself such a structure is statically unstable.
        """
        row = unstable_row(self.stiffness, self.mass)
        return None if row is None else self.dofs[row]

    @classmethod
    def of_law(
        cls,
        mass: MatrixLike,
        stiffness: MatrixLike,
        damping: MatrixLike | None,
        dofs: Iterable[str] | None,
        law: DampingLaw | None,
        proportional: bool | None = None,
        accurate_to: float = np.inf,
    ) -> Structure:
        """Return a structure with a damping matrix that a law made, to the last bit.

        `proportional` says whether the damping is known to couple no modes; by default what the law
        says.
        """
        made = cls(mass, stiffness, damping, dofs)
        if proportional is None and law is not None:
            proportional = law.proportional
        set_fields(made, damping_law=law, proportional=made.proportional or bool(proportional))
        set_fields(made, accurate_to=accurate_to)
        return made

    def made_of(self, *parts: Structure) -> Structure:
        """Return it, as accurate as the least accurate structure that it is made of."""
        set_fields(self, accurate_to=min(one.accurate_to for one in parts))
        return self


def join(structures: Mapping[str, Structure], couplings: Iterable[Coupling] = ()) -> Structure:
    """Put several structures, by name, side by side, and perhaps springs between them.

    The matrices are block-diagonal but for the couplings; the degree of freedom "tip" of part "1"
    is named "1.tip".

    Parameters
    ----------
    structures : mapping of str to Structure
        The parts by name.
    couplings : iterable of Coupling, optional
        Linear springs between two degrees of freedom each, of the same part or of two. The damping
        laws of the parts do not see them.

    Raises
    ------
    ModelError
        If there is no part, a name or a part is none, or a coupling names an unknown degree of
        freedom or the same one at both ends.

    Examples
    --------
    >>> import stickslip as ss
    >>> beam = ss.reference.snecma_structure()
    >>> pair = ss.join({"1": beam, "2": beam}, [ss.Coupling("1.tip", "2.tip", stiffness=1e4)])
    >>> bool(pair.stiffness[pair.index("1.tip"), pair.index("2.tip")] == -1e4)
    True
    """
    if not isinstance(structures, Mapping):
        raise ModelError(
            f'join: {brief(structures)} names no parts; write join({{"1": a, "2": b}})'
        )
    if not structures:
        raise ModelError("join: no parts; give at least one structure")
    for name, structure in structures.items():
        text(name, "join: name of a part")
        if not isinstance(structure, Structure):
            raise ModelError(f"join: part {brief(name)} is {brief(structure)}; give a Structure")
    dofs = [f"{name}.{dof}" for name, part in structures.items() for dof in part.dofs]
    return coupled(side_by_side(structures.values(), dofs), couplings)


def coupled(structure: Structure, couplings: Iterable[Coupling]) -> Structure:
    """Return a structure with linear springs between its degrees of freedom."""
    springs = members(couplings, "couplings", "couplings=[...]")
    if not springs:
        return structure
    stiffness, damping = structure.stiffness.copy(), structure.damping.copy()
    for number, spring in enumerate(springs, 1):
        if not isinstance(spring, Coupling):
            raise ModelError(f"coupling {number}: {brief(spring)} is no coupling; give a Coupling")
        try:
            one = spring.within(structure)
        except ModelError as error:
            entry = f"coupling {number}: "
            raise ModelError(f"{entry}{error}", study=f"{entry}{error.study}") from None
        stiffness += spring.stiffness * one
        damping += spring.damping * one
    return Structure(structure.mass, stiffness, damping, structure.dofs).made_of(structure)


def side_by_side(structures: Iterable[Structure], dofs: Iterable[str]) -> Structure:
    """Put several structures side by side, uncoupled, under names of all their dofs."""
    parts = list(structures)
    starts = np.cumsum([0, *map(len, parts)])
    blocks = {name: np.zeros((starts[-1],) * 2) for name in ("mass", "stiffness", "damping")}
    for name, whole in blocks.items():
        for start, part in zip(starts, parts, strict=False):
            block = slice(start, start + len(part))
            whole[block, block] = getattr(part, name)
    proportional = all(part.proportional for part in parts)
    matrices = blocks["mass"], blocks["stiffness"], blocks["damping"]
    return Structure.of_law(*matrices, dofs, None, proportional).made_of(*parts)


def _names(dofs: Iterable[str] | None, size: int) -> tuple[str, ...]:
    if dofs is None:
        return tuple(map(str, range(size)))
    given = members(dofs, "dofs", 'dofs=["tip", ...]')
    names = tuple(text(name, f"dofs: name {place}") for place, name in enumerate(given, 1))
    if len(names) != size:
        raise ModelError(f"dofs: {len(names)} names for {size} dofs; give one name per matrix row")
    if len(set(names)) < size:
        twice = next(name for position, name in enumerate(names) if name in names[:position])
        raise ModelError(
            f"dofs: {brief(twice)} is given more than once; give every dof its own name"
        )
    return tuple(map(str, names))


def _symmetric(matrix: Matrix, entry: str, names: tuple[str, ...]) -> Matrix:
    """Average out rounded digits, in place; refuse what cannot be rounding."""
    require_square(matrix, entry, len(names))
    require_finite(matrix, entry, names)
    if np.array_equal(matrix, matrix.T):
        return matrix
    with np.errstate(over="ignore"):
        difference = matrix - matrix.T
    np.abs(difference, out=difference)
    if difference.max() > ASYMMETRY * max(matrix.max(), -matrix.min()):
        row, column = np.unravel_index(difference.argmax(), difference.shape)
        triangular = not (np.tril(matrix, -1).any() and np.triu(matrix, 1).any())
        remedy = (
            "only one triangle is filled: mirror it"
            if triangular
            else "give a symmetric matrix (skew terms belong to damping)"
        )
        one, other = brief(names[row]), brief(names[column])
        raise ModelError(
            f"{entry}: {matrix[row, column]:.9g} at ({one}, {other}) but "
            f"{matrix[column, row]:.9g} at ({other}, {one}); {remedy}"
        )
    # Large matrices have no room for more of their size.
    matrix *= 0.5
    np.copyto(difference, matrix.T)
    matrix += difference
    return matrix


def _require_undamped(damping: Matrix, massless: NDArray[np.bool_], names: tuple[str, ...]) -> None:
    acting = massless & (damping.any(axis=0) | damping.any(axis=1))
    if acting.any():
        raise ModelError(
            f"damping: it acts on dof {brief(names[int(acting.argmax())])}, which has no mass; "
            "give this dof a mass, or leave its damping out"
        )


def _require_positive(mass: Matrix, inert: NDArray[np.bool_], names: tuple[str, ...]) -> None:
    if not inert.any() or _is_positive(mass if inert.all() else mass[np.ix_(inert, inert)]):
        return
    values, vectors = np.linalg.eigh(mass)
    name = names[int(np.abs(vectors[:, 0]).argmax())]
    raise ModelError(
        f"mass: smallest eigenvalue {values[0]:.6g} (mostly dof {brief(name)}), largest "
        f"{values[-1]:.6g}; it must be positive definite: condense massless dofs out"
    )


def _is_positive(mass: Matrix) -> bool:
    # Scaled to a unit diagonal, so that rotations in kg m^2 beside masses in kg, or any other
    # choice of units, do not look singular.
    if not (np.diag(mass) > 0.0).all():
        return False
    pivots = scaled_pivots(mass)
    return pivots is not None and bool(pivots.min() > 16.0 * len(mass) * np.finfo(np.float64).eps)


def _damping(
    damping: MatrixLike | DampingLaw | None, mass: Matrix, stiffness: Matrix, names: tuple[str, ...]
) -> Matrix:
    if damping is None:
        return np.zeros_like(mass)
    if isinstance(damping, DampingLaw):
        return damping.matrix(mass, stiffness, names)
    if isinstance(damping, Real | str):
        raise ModelError(
            f"damping: {brief(damping)} is not a matrix; write ModalDamping({brief(damping)})"
        )
    matrix = real_matrix(damping, "damping")
    require_square(matrix, "damping", len(mass))
    require_finite(matrix, "damping", names)
    return matrix


def names_of_tables(
    dofs: Iterable[str] | None, matrices: tuple[object, object, object]
) -> Iterable[str] | None:
    """Return the names of the dofs: those given, else those of the columns of tables.

    Rows and columns by the same names in another order, from table to table, or than `dofs` says,
    would put numbers at other dofs, and are refused.
    """
    known: tuple[Any, ...] | None = None
    if dofs is not None:
        given = as_list(dofs)
        if given is None:
            return dofs
        dofs = known = given
    for entry, matrix in zip(("mass", "stiffness", "damping"), matrices, strict=True):
        for axis in ("columns", "index"):
            names = _axis_names(matrix, axis)
            if names is None:
                continue
            known = known or names
            if names != known and (dofs is None or set(names) == set(known)):
                raise ModelError(
                    f"{entry}: its {axis} are {brief(list(names))}, beside {brief(list(known))}; "
                    "give all matrices and dofs in one order, as table.loc[dofs, dofs]"
                )
    return dofs if dofs is not None else known


def _axis_names(matrix: object, axis: str) -> tuple[str, ...] | None:
    """Return names of rows or columns; None if they are numbers, or there are none."""
    names = as_list(getattr(matrix, axis, None))
    return names if names and all(isinstance(one, str) for one in names) else None

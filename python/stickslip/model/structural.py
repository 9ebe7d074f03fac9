"""The structure-like damper: a massless elastic body with several slipping contacts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import (
    Matrix,
    MatrixLike,
    brief,
    members,
    real_matrix,
    require_finite,
    set_fields,
    text,
)
from stickslip.errors import ModelError
from stickslip.model.contact import Sliders, real_numbers
from stickslip.model.dofs import Dofs

_PRINTED = 1e-6
"""Asymmetry, or row sum, relative to the largest stiffness, that printed digits may leave."""

_ROUNDING = 1e-12
"""Condensed stiffness, relative to the largest entry, that is none."""


class StructuralDamper(Sliders):
    """A massless elastic damper that touches its neighbours at several points, each of which slips.

    With the displacements u of its contacts and their slip s the forces are f = D (u - s); each is
    held to abs(f_i) <= F_i, and its slip moves along f_i = +-F_i alone. The forces are unique. The
    slip is, too, unless all contacts of a floating part slip at once: then its sharing among them
    is not determined.

    Parameters
    ----------
    dofs : sequence of str or None
        The degree of freedom that each contact touches, of one or several structures (see `join`);
        None is the ground.
    stiffness : array_like, shape (points, points)
        Stiffness D of the damper by itself [N/m], symmetric and positive semidefinite. Where its
        rows do not sum to zero the damper is also held by the ground; results say so.
    slip_forces : sequence of float
        Slip limit F_i of each contact [N]; 0 is no friction, infinity never slips.
    name : str, optional
        By which results and settings refer to it. Default: "structural".

    Raises
    ------
    ModelError
        If there are not as many contacts, rows and limits, all contacts lie at the ground, D is not
        symmetric or positive semidefinite, a limit is negative, or a number is not finite where it
        has to be.

    References
    ----------
    Guillen (1999), chapter VI; its explicit update (Procedure 2) replaced by the implicit problem.
    """

    law: ClassVar[str] = "structural"

    stiffness: Matrix
    slip_forces: tuple[float, ...]
    _dofs: tuple[str | None, ...]

    def __init__(
        self,
        dofs: Iterable[str | None],
        *,
        stiffness: MatrixLike,
        slip_forces: Iterable[float],
        name: str | None = None,
    ) -> None:
        super().__init__(name=name)
        entry = "structural contact"
        listed = members(dofs, f"{entry}: dofs", "dofs=[...]")
        ends = tuple(None if dof is None else text(dof, f"{entry}: dofs") for dof in listed)
        if not any(ends):
            raise ModelError(
                f"{entry}: dofs {brief(list(ends))} are all the ground; name at least one dof"
            )
        limits = real_numbers(slip_forces, "N", entry, "slip_forces", finite=False)
        if len(limits) != len(ends):
            raise ModelError(
                f"{entry}: {len(limits)} slip_forces for {len(ends)} dofs; give one per contact, "
                "inf where it never slips"
            )
        set_fields(self, _dofs=ends, slip_forces=limits, stiffness=_stiffness(stiffness, len(ends)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, StructuralDamper):
            return NotImplemented
        return self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[object, ...]:
        # Without negative zeros, whose bytes are others.
        return self._dofs, self.slip_forces, self.name, (self.stiffness + 0.0).tobytes()

    def __repr__(self) -> str:
        limits = ", ".join(f"{force:g}" for force in self.slip_forces)
        return f"StructuralDamper({list(self._dofs)}, slip_forces=[{limits}], name={self.name!r})"

    def __reduce__(self) -> tuple[object, ...]:
        return StructuralDamper.from_parameters, (self._dofs, self._values(), self.name)

    @property
    def dofs(self) -> tuple[str | None, ...]:
        """Names of the degrees of freedom it touches, contact by contact; None is the ground."""
        return self._dofs

    @property
    def points(self) -> int:
        """Number of contacts."""
        return len(self._dofs)

    @property
    def limits(self) -> tuple[float, ...]:
        """Slip limit of each contact [N]."""
        return self.slip_forces

    @property
    def stuck_stiffness(self) -> Matrix:
        """D [N/m], shape (points, points)."""
        return self.stiffness

    def linear_limit(self, *, stuck: bool) -> StructuralDamper | None:
        """Return the damper without slip in a linear limit, its slipping points condensed."""
        limits = np.array(self.slip_forces)
        sticks = limits > 0.0 if stuck else np.isinf(limits)
        if not any(dof for dof, stays in zip(self._dofs, sticks, strict=True) if stays):
            return None
        condensed = condensed_stiffness(self.stiffness, sticks)
        condensed[np.abs(condensed) <= _ROUNDING * np.abs(self.stiffness).max()] = 0.0
        return StructuralDamper(
            self._dofs, stiffness=condensed, slip_forces=[np.inf] * self.points, name=self.name
        )

    @property
    def grounding(self) -> float:
        """Largest row sum of the stiffness that is more than rounding, 0 if it floats [N/m].

        A damper that no support holds is in equilibrium with itself: the rows sum to zero, and so
        do its forces.
        """
        largest = float(np.abs(self.stiffness).max())
        sums = self.stiffness.sum(axis=1)
        worst = float(sums[np.argmax(np.abs(sums))])
        return worst if abs(worst) > _PRINTED * largest else 0.0

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x; a row of zeros at the ground. See `Contact.rows`."""
        rows = np.zeros((self.points, len(dofs)))
        for row, dof in zip(rows, self._dofs, strict=True):
            if dof is not None:
                row[dofs.index(dof)] = 1.0
        return rows

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return `stiffness`, row by row [N/m], and `slip_forces` [N]."""
        return [{"stiffness": self.stiffness.ravel().tolist(), "slip_forces": [*self.slip_forces]}]

    def summary(self) -> str:
        """Return the slip limits in words."""
        limits = ", ".join(f"{force:g}" for force in self.slip_forces)
        return f"{self.points} points, slip_forces {limits}"


def condensed_stiffness(stiffness: Matrix, sticks: NDArray[np.bool_]) -> Matrix:
    """Return the stiffness left when only some points stick, the others being free of force."""
    left, slips = np.zeros_like(stiffness), ~sticks
    across = stiffness[np.ix_(slips, sticks)]
    inverse = np.linalg.pinv(stiffness[np.ix_(slips, slips)], hermitian=True)
    left[np.ix_(sticks, sticks)] = stiffness[np.ix_(sticks, sticks)] - across.T @ inverse @ across
    return left


def _stiffness(value: MatrixLike, points: int) -> Matrix:
    """Return D, checked."""
    entry = "structural contact: stiffness"
    matrix = real_matrix(value, entry)
    if matrix.shape != (points, points):
        rows, columns = matrix.shape
        raise ModelError(f"{entry}: {rows} x {columns} for {points} dofs; give {points} x {points}")
    require_finite(matrix, entry)
    largest = float(np.abs(matrix).max())
    skew = np.abs(matrix - matrix.T)
    if skew.max() > _PRINTED * largest:
        row, column = np.unravel_index(np.argmax(skew), skew.shape)
        raise ModelError(
            f"{entry}: {matrix[row, column]:g} at ({row}, {column}), but "
            f"{matrix[column, row]:g} at ({column}, {row}); an elastic body has a symmetric one"
        )
    symmetric: Matrix = 0.5 * (matrix + matrix.T)
    lowest = float(np.linalg.eigvalsh(symmetric)[0])
    if lowest < -_PRINTED * largest:
        raise ModelError(
            f"{entry}: not positive semidefinite (eigenvalue {lowest:g}), so that the damper would "
            "give energy away; check its signs, and give it more than six digits"
        )
    return symmetric

"""The structure-like damper: a massless elastic body with several slipping contacts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar, Self

import numpy as np

from stickslip.checks import (
    Matrix,
    MatrixLike,
    brief,
    members,
    real_matrix,
    real_number,
    text,
    unknown,
)
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.structure import Structure

__all__ = ["StructuralDamper"]

_PRINTED = 1e-6
"""Asymmetry, or row sum, relative to the largest stiffness, that printed digits may leave."""

_ROUNDING = 1e-12
"""Condensed stiffness, relative to the largest entry, that is none."""


class StructuralDamper(Contact):
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

    Attributes
    ----------
    stiffness : ndarray of float64, shape (points, points)
        D [N/m].
    slip_forces : tuple of float
        F [N].

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
    factors: ClassVar[frozenset[str]] = frozenset({"stiffness"})

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
        given = members(slip_forces, f"{entry}: slip_forces", "slip_forces=[...]")
        limits = tuple(
            real_number(force, f"{entry}: slip_forces[{place}]", finite=False)
            for place, force in enumerate(given)
        )
        if len(limits) != len(ends):
            raise ModelError(
                f"{entry}: {len(limits)} slip_forces for {len(ends)} dofs; give one per contact, "
                "inf where it never slips"
            )
        for place, force in enumerate(limits):
            if force < 0.0:
                raise ModelError(
                    f"{entry}: slip_forces[{place}] {force:g} is negative; give N, 0 for no "
                    "friction"
                )
        matrix = _stiffness(stiffness, len(ends))
        matrix.flags.writeable = False
        object.__setattr__(self, "_dofs", ends)
        object.__setattr__(self, "slip_forces", limits)
        object.__setattr__(self, "stiffness", matrix)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, StructuralDamper):
            return NotImplemented
        own = self._dofs, self.slip_forces, self.name
        return own == (other._dofs, other.slip_forces, other.name) and np.array_equal(
            self.stiffness, other.stiffness
        )

    def __hash__(self) -> int:
        return hash((self._dofs, self.slip_forces, self.name, self.stiffness.tobytes()))

    def __repr__(self) -> str:
        limits = ", ".join(f"{force:g}" for force in self.slip_forces)
        return f"StructuralDamper({list(self._dofs)}, slip_forces=[{limits}], name={self.name!r})"

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuilt, (self._dofs, self.stiffness, self.slip_forces, self.name)

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

    def held(self, *, stuck: bool) -> StructuralDamper | None:
        """Return the damper without slip in a linear limit, its slipping points condensed.

        Parameters and returns are those of `Contact.held`.
        """
        limits = np.array(self.slip_forces)
        sticks = limits > 0.0 if stuck else np.isinf(limits)
        if not any(dof for dof, stays in zip(self._dofs, sticks, strict=True) if stays):
            return None
        slips = ~sticks
        condensed = np.zeros_like(self.stiffness)
        across = self.stiffness[np.ix_(slips, sticks)]
        inverse = np.linalg.pinv(self.stiffness[np.ix_(slips, slips)], hermitian=True)
        condensed[np.ix_(sticks, sticks)] = (
            self.stiffness[np.ix_(sticks, sticks)] - across.T @ inverse @ across
        )
        condensed[np.abs(condensed) <= _ROUNDING * np.abs(self.stiffness).max()] = 0.0
        return type(self)(
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

    def rows(self, structure: Structure) -> Matrix:
        """Return B of u = B x.

        Parameters
        ----------
        structure : Structure
            The structure that the contact acts on, of N degrees of freedom.

        Returns
        -------
        ndarray of float64, shape (points, N)
            +1 at the degree of freedom of each contact; a row of zeros at the ground.

        Raises
        ------
        ModelError
            If the structure lacks a degree of freedom.
        """
        rows = np.zeros((self.points, len(structure)))
        for row, dof in zip(rows, self._dofs, strict=True):
            if dof is not None:
                row[structure.index(dof)] = 1.0
        return rows

    def parameters(self) -> dict[str, float]:
        """Return the parameters that are single numbers: none."""
        return {}

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return `stiffness`, a factor on D, and `slip_force` of each contact [N]."""
        return {"stiffness": (1.0,), "slip_force": self.slip_forces}

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the damper with D times a factor, or with other slip limits.

        Parameters, returns and raises are those of `Contact.adjusted`.
        """
        if parameter == "slip_force":
            return self._like(self._dofs, values, self.name)
        factor = real_number(values[0], "structural contact: factor on the stiffness")
        if factor < 0.0:
            raise ModelError(
                f"structural contact: factor {factor:g} on the stiffness is negative; give >= 0"
            )
        stiffness = factor * self.stiffness
        return type(self)(
            self._dofs, stiffness=stiffness, slip_forces=self.slip_forces, name=self.name
        )

    def law_parameters(self) -> dict[str, float | list[float]]:
        """Return `stiffness`, row by row [N/m], and `slip_forces` [N]."""
        return {"stiffness": self.stiffness.ravel().tolist(), "slip_forces": [*self.slip_forces]}

    def described(self) -> str:
        """Return the slip limits in words."""
        limits = ", ".join(f"{force:g}" for force in self.slip_forces)
        return f"{self.points} points, slip_forces {limits}"

    def scaled(self, slip_force: float) -> Self:
        """Return a contact with its slip limits multiplied; those that never slip stay so."""
        limits = [force if np.isinf(force) else force * slip_force for force in self.slip_forces]
        return self._like(self._dofs, limits, self.name)

    def named(self, name: str) -> Self:
        """Return the contact with another name."""
        return self._like(self._dofs, self.slip_forces, name)

    def moved(self, dofs: Sequence[str | None], name: str | None) -> Self:
        """Return the contact at other degrees of freedom."""
        return self._like(dofs, self.slip_forces, name)

    def _like(
        self, dofs: Sequence[str | None], slip_forces: Sequence[float], name: str | None
    ) -> Self:
        return type(self)(dofs, stiffness=self.stiffness, slip_forces=slip_forces, name=name)

    def to_spec(self) -> dict[str, object]:
        """Return the contact in plain values; see `Contact.to_spec`."""
        limits = [force if np.isfinite(force) else str(force) for force in self.slip_forces]
        parameters = {"stiffness": self.stiffness.tolist(), "slip_forces": limits}
        return {
            "law": self.law,
            "dofs": list(self._dofs),
            "parameters": parameters,
            "name": self.name,
        }

    @classmethod
    def from_parameters(
        cls, dofs: tuple[str | None, ...], parameters: Mapping[str, object], name: str | None
    ) -> Self:
        """Build the contact from what `dofs`, `parameters` and `name` hold.

        Raises
        ------
        ModelError
            If there are other parameters than the law's two, or they are refused.
        """
        known = ("stiffness", "slip_forces")
        for key in parameters:
            if key not in known:
                raise ModelError(f"structural contact: {unknown('parameter', key, known)}")
        for key in known:
            if key not in parameters:
                raise ModelError(f"structural contact: {key} is missing; give {key}")
        limits = parameters["slip_forces"]
        if not isinstance(limits, list | tuple):
            raise ModelError(
                f"structural contact: slip_forces {brief(limits)} is not a list; give one per dof"
            )
        return cls(
            dofs,
            stiffness=parameters["stiffness"],  # type: ignore[arg-type]
            slip_forces=[np.inf if force == "inf" else force for force in limits],
            name=name,
        )


def _stiffness(value: MatrixLike, points: int) -> Matrix:
    """Return D, checked."""
    entry = "structural contact: stiffness"
    matrix = real_matrix(value, entry)
    if matrix.shape != (points, points):
        rows, columns = matrix.shape
        raise ModelError(f"{entry}: {rows} x {columns} for {points} dofs; give {points} x {points}")
    if not np.isfinite(matrix).all():
        row, column = np.argwhere(~np.isfinite(matrix))[0]
        raise ModelError(
            f"{entry}: {matrix[row, column]} at ({row}, {column}); every entry must be finite"
        )
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


def _rebuilt(
    dofs: tuple[str | None, ...], stiffness: Matrix, limits: tuple[float, ...], name: str | None
) -> StructuralDamper:
    return StructuralDamper(dofs, stiffness=stiffness, slip_forces=limits, name=name)

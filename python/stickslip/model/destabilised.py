"""A model under negative damping: C(r) = C + r C_neg."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import Matrix, MatrixLike, brief, real_matrix, real_number
from stickslip.errors import ModelError
from stickslip.model.damping import DampingLaw
from stickslip.model.model import Model
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from stickslip.disk import BladedDisk

__all__ = ["destabilised", "is_proportional", "negative_matrix"]


def destabilised(
    model: Model, negative_damping: MatrixLike | DampingLaw, ratio: float = 1.0
) -> Model:
    """Return a model at a ratio of negative damping, C(r) = C + r C_neg.

    Parameters
    ----------
    model : Model
        The model as it is, with its own damping C.
    negative_damping : array_like, scipy.sparse matrix, Rayleigh or ModalDamping
        C_neg, what the flow adds [kg/s]: a matrix, shape (N, N), or a law such as
        ``ss.modal_damping([-0.01, 0, 0])`` or ``ss.Rayleigh(mass=-7.49)``. Of a `BladedDisk` that
        of each sector, of a `MistunedDisk` that of all sectors.
    ratio : float, optional
        The ratio r.

    Returns
    -------
    Model
        With the damping of the ratio as a matrix, for any other analysis. A `BladedDisk` stays one;
        a `MistunedDisk` becomes a plain `Model` of all its degrees of freedom.

    Raises
    ------
    ModelError
        If `model` is no `Model`, the ratio is not a finite number, or the matrix does not fit.

    References
    ----------
    Guillen (1999), eqs. (5.22) and (5.31).
    """
    if not isinstance(model, Model):
        raise ModelError(f"model: {brief(model)} is not a Model; give ss.Model(structure, ...)")
    added = real_number(ratio, "ratio") * negative_matrix(negative_damping, model.structure)
    own = model.structure
    damping = own.damping + added
    proportional = own.proportional and is_proportional(negative_damping)
    structure = Structure.of_law(own.mass, own.stiffness, damping, own.dofs, None, proportional)
    if not model.travels:
        return Model(structure, model.contacts, model.forces)
    from stickslip.disk import BladedDisk

    disk: BladedDisk = model  # type: ignore[assignment]
    return BladedDisk(
        structure,
        disk.sectors,
        disk.couplings,
        disk.contacts,
        disk.forces,
        engine_order=disk.engine_order,
        engine_orders=disk.engine_orders,
        interface=disk.interface,
    )


def is_proportional(damping: MatrixLike | DampingLaw) -> bool:
    """Tell whether negative damping is known to couple no modes of the structure."""
    return isinstance(damping, DampingLaw) and damping.proportional


def negative_matrix(damping: MatrixLike | DampingLaw, structure: Structure) -> Matrix:
    """Return negative damping as a matrix that fits a structure.

    Parameters
    ----------
    damping : array_like, scipy.sparse matrix, Rayleigh or ModalDamping
        A matrix [kg/s], or a law that makes one.
    structure : Structure
        Of N degrees of freedom.

    Returns
    -------
    ndarray of float64, shape (N, N)
        [kg/s].

    Raises
    ------
    ModelError
        If it is of another size or not finite.
    """
    if isinstance(damping, DampingLaw):
        return damping.matrix(structure.mass, structure.stiffness, structure.dofs)
    matrix = real_matrix(damping, "negative_damping")
    size = len(structure)
    if matrix.shape != (size, size):
        reason = (
            f"negative_damping: {' x '.join(map(str, matrix.shape))}, but the structure has {size} "
            f"dofs; give {size} x {size}, or"
        )
        raise ModelError(f"{reason} modal_damping([...])", study=f"{reason} {{modal = [...]}}")
    if not np.isfinite(matrix).all():
        row, column = np.argwhere(~np.isfinite(matrix))[0]
        raise ModelError(
            f"negative_damping: {matrix[row, column]} at ({row}, {column}); every entry must be "
            "finite"
        )
    return matrix

"""A model under negative damping, C(r) = C + r C_neg, and damping ratios of its modes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from stickslip.checks import Matrix, MatrixLike, real_matrix, real_number, require_finite
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.damping import DampingLaw, ModalDamping
from stickslip.model.model import Model, require_model
from stickslip.model.structure import Structure


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
    require_model(model)
    added = real_number(ratio, "ratio") * negative_matrix(negative_damping, model.structure)
    own = model.structure
    damping = own.damping + added
    proportional = own.proportional and is_proportional(negative_damping)
    structure = Structure.of_law(own.mass, own.stiffness, damping, own.dofs, None, proportional)
    return model.with_structure(structure.made_of(own))


def is_proportional(damping: MatrixLike | DampingLaw) -> bool:
    """Tell whether negative damping is known to couple no modes of the structure."""
    return isinstance(damping, DampingLaw) and damping.proportional


def negative_matrix(damping: MatrixLike | DampingLaw, structure: Structure) -> Matrix:
    """Return negative damping, a matrix or a law, as a matrix that fits a structure [kg/s]."""
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
    require_finite(matrix, "negative_damping")
    return matrix


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
    return ModalDamping(ratio, stuck.contacts if isinstance(stuck, Model) else stuck)

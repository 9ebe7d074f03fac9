"""Component modes: a large structure by its boundary and a few modes of its inside."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, members, text, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.fe.reduced_modes import MASSLESS
from stickslip.fe.reduction import Reduction, panels
from stickslip.fe.sparse import DENSE, CscArray, Factor, lowest_modes, symmetric_sparse
from stickslip.model.matrix_units import MatrixUnits, Units
from stickslip.units import physical_number

Dof: TypeAlias = int | str
_FIRST = 20
"""Modes computed at first where a frequency says how many are wanted."""
_NOISE = 1e3
"""Eigenvalues below this many rounding errors of the largest are rigid-body motions."""


def craig_bampton(
    mass: object,
    stiffness: object,
    boundary: Iterable[Dof] | Mapping[str, Dof],
    *,
    modes: int | None = None,
    omega: float | None = None,
    dofs: Iterable[str] | None = None,
    units: Units = None,
) -> Reduction:
    """Reduce a structure to boundary degrees of freedom and fixed-interface modes.

    The motion is x = T q. The first columns of T are constraint modes, the static shapes of a unit
    displacement at one boundary degree of freedom with the others held, so that contacts, forces
    and outputs keep their physical meaning; the others are natural modes of the structure held at
    its boundary.

    Parameters
    ----------
    mass, stiffness : scipy.sparse array or matrix, or array_like, shape (N, N)
        Symmetric [kg], [N/m], without the rows of clamped degrees of freedom.
    boundary : iterable or mapping
        Degrees of freedom to be kept: positions from 0, or names of `dofs`. A mapping gives them
        new names: ``{"tip": "4711.2"}``.
    modes : int, optional
        How many fixed-interface modes. Give this or `omega`.
    omega : float, optional
        All fixed-interface modes up to this angular frequency are kept [rad/s]; twice the highest
        one of interest is usual.
    dofs : iterable of str, optional
        Names of the N rows, as `read_dofs` gives them.
    units : str, optional
        Mass, length and time of the matrices, as of `Structure`: "t-mm-s". Default: SI.

    Returns
    -------
    Reduction
        The reduced matrices, what leads back to all N degrees of freedom, and a report of checks.

    Raises
    ------
    ModelError
        If a matrix is not symmetric, not finite or of another size, a boundary degree of freedom is
        unknown or given twice, neither or both of `modes` and `omega` are given, or the structure
        held at its boundary can still move as a rigid body.

    References
    ----------
    Craig and Bampton, "Coupling of substructures for dynamic analyses", AIAA Journal 6 (1968)
    1313-1319.

    Examples
    --------
    >>> import numpy as np, stickslip as ss
    >>> chain = 2.0 * np.eye(50) - np.eye(50, k=1) - np.eye(50, k=-1)
    >>> reduced = ss.craig_bampton(np.eye(50), 1e6 * chain, {"tip": 49}, modes=6)
    >>> reduced.structure(ss.ModalDamping(0.001))
    Structure(7 dofs: tip, mode-1, mode-2, mode-3, mode-4, mode-5, ...)
    """
    M, skew_mass = symmetric_sparse(mass, "mass")
    K, skew_stiffness = symmetric_sparse(stiffness, "stiffness")
    size = M.shape[0]
    if not M.diagonal().max() > 0.0:
        raise ModelError("mass: no entry of the diagonal is positive; give the mass matrix")
    if K.shape != M.shape:
        raise ModelError(f"stiffness: {K.shape[0]} rows, but the mass has {size}")
    rows = _row_names(dofs, size)
    if units is not None:
        known, ways = MatrixUnits.of(units), rows or ("",) * size
        M, K = known.in_si(M, "mass", ways).tocsc(), known.in_si(K, "stiffness", ways).tocsc()
    names, kept = _boundary(boundary, rows, size)
    inner = np.setdiff1d(np.arange(size), kept)
    K_ii, M_ii = K[inner][:, inner].tocsc(), M[inner][:, inner].tocsc()
    inertia = M_ii.diagonal()
    moving = inertia > max(MASSLESS * inertia.max(), 0.0)
    most = _most_modes(M_ii, moving, modes if isinstance(modes, int | np.integer) else _FIRST)
    count = _mode_count(modes, omega, most)
    try:
        factor = Factor(K_ii)
        squares, shapes = lowest_modes(K_ii, M_ii, count, factor)
    except (RuntimeError, np.linalg.LinAlgError):
        raise _moves_rigidly(names) from None
    except MemoryError:
        raise ModelError(
            f"stiffness: the factors of {inner.size} rows do not fit into memory; coarsen"
        ) from None
    coupling = K[inner][:, kept].tocsc()
    constraint = np.empty(coupling.shape)
    for panel in panels(*coupling.shape):
        constraint[:, panel] = factor.solve(coupling[:, panel].toarray())
    np.negative(constraint, out=constraint)
    highest = float((K_ii.diagonal()[moving] / inertia[moving]).max())
    if not squares[0] > _NOISE * np.finfo(np.float64).eps * highest:
        raise _moves_rigidly(names)
    if omega is not None:
        limit = physical_number(omega, "rad/s", "omega")
        while squares[-1] < limit**2 and count < most:
            most = _most_modes(M_ii, moving, min(2 * count, most))
            count = min(2 * count, most)
            squares, shapes = lowest_modes(K_ii, M_ii, count, factor)
        wanted = int(np.searchsorted(squares, limit**2))
        if not wanted:
            raise ModelError(
                f"omega: {limit:g} rad/s lies below every fixed-interface mode, the first at "
                f"{np.sqrt(squares[0]):.6g} rad/s; give a higher one, or modes=1"
            )
        squares, shapes = squares[:wanted], shapes[:, :wanted]
    asymmetry = skew_mass, skew_stiffness
    return Reduction(M, K, rows, names, kept, constraint, shapes, squares, asymmetry, factor)


def _row_names(dofs: Iterable[str] | None, size: int) -> tuple[str, ...] | None:
    if dofs is None:
        return None
    names = tuple(members(dofs, "dofs", 'dofs=["1.1", ...]'))
    if len(names) != size:
        raise ModelError(f"dofs: {len(names)} names for {size} rows; give one per matrix row")
    return names


def _boundary(
    boundary: Iterable[Dof] | Mapping[str, Dof], rows: tuple[str, ...] | None, size: int
) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Return names and rows of what is kept."""
    if isinstance(boundary, Mapping):
        given = [(text(name, "boundary: name"), dof) for name, dof in boundary.items()]
    else:
        listed = members(boundary, "boundary", 'boundary={"tip": 4711}')
        given = [(_own_name(dof, rows), dof) for dof in listed]
    if not given:
        raise ModelError("boundary: it is empty; keep at least the dofs of contacts and forces")
    places = {name: row for row, name in enumerate(rows or ())}
    kept = []
    for name, dof in given:
        if isinstance(dof, str):
            if rows is None:
                raise ModelError(f"boundary: {brief(dof)} is a name; give dofs=, or a position")
            if dof not in places:
                raise ModelError(f"boundary: {unknown('dof', dof, rows)}")
            kept.append(places[dof])
        else:
            kept.append(whole_number(dof, f"boundary: {name}", largest=size - 1))
    if len(set(kept)) < len(kept) or len({name for name, _ in given}) < len(kept):
        raise ModelError("boundary: a dof or a name is given twice; give each once")
    if len(kept) >= size:
        raise ModelError(f"boundary: all {size} dofs are kept; nothing is left to be reduced")
    return tuple(name for name, _ in given), np.array(kept, dtype=np.int64)


def _own_name(dof: Dof, rows: tuple[str, ...] | None) -> str:
    if isinstance(dof, str):
        return dof
    row = whole_number(dof, "boundary")
    return rows[row] if rows is not None and row < len(rows) else str(row)


def _most_modes(mass: CscArray, moving: NDArray[np.bool_], wanted: int | np.integer[Any]) -> int:
    """Return how many modes there are; at most, where few are wanted, or more than can be."""
    size, count = mass.shape[0], int(moving.sum())
    if not count or (size > DENSE and not count >= wanted >= 0.5 * size):
        return count
    # Rows with inertia may have combinations without any. Each counts in units of its own.
    inertia = mass[moving][:, moving].toarray()
    scale = 1.0 / np.sqrt(inertia.diagonal())
    return int(np.linalg.matrix_rank(scale[:, None] * inertia * scale, hermitian=True))


def _mode_count(modes: int | None, omega: float | None, most: int) -> int:
    """Return how many modes are computed at first; `most` is how many there are."""
    if (modes is None) == (omega is None):
        raise ModelError("modes: give either modes=16, their number, or omega=, their limit")
    if not most:
        raise ModelError(
            "mass: only boundary dofs have inertia, so that the others have no modes; condense "
            "them, K_bb - K_bi K_ii^-1 K_ib, and give the result to Structure"
        )
    if modes is not None:
        return whole_number(modes, "modes", smallest=1, largest=most)
    if physical_number(omega, "rad/s", "omega") <= 0.0:
        raise ModelError(f"omega: {omega:g} must be positive")
    return min(_FIRST, most)


def _moves_rigidly(names: tuple[str, ...]) -> ModelError:
    return ModelError(
        f"boundary: held at {', '.join(map(brief, names[:4]))} the structure can still move as a "
        "rigid body, or one of its dofs has no stiffness; clamp it, or keep more boundary dofs"
    )

"""A structure reduced to component modes, its checks, and the way back to all of its motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import Matrix, MatrixLike, constant, set_fields, whole_number
from stickslip.errors import ModelError
from stickslip.fe.accuracy import accurate_to
from stickslip.fe.reduced_modes import RIGID, natural_modes, shift_below, springs_of
from stickslip.fe.sparse import CscArray, Factor, lowest_modes
from stickslip.model import Force
from stickslip.model.damping import DampingLaw
from stickslip.model.structure import Structure
from stickslip.results.dataset import Record, Stored


class Reduction:
    """What `craig_bampton` makes of a structure; x = T q.

    Attributes
    ----------
    mass, stiffness : ndarray of float64, shape (n, n)
        Reduced matrices: boundary degrees of freedom first, fixed-interface modes behind.
    dofs : tuple of str
        Names of the n reduced degrees of freedom: those of the boundary, then "mode-1", ...
    boundary : tuple of str
        Names of the boundary degrees of freedom.
    rows : ndarray of int64, shape (boundary,)
        Where they stand in the full matrices.
    omega : ndarray of float64, shape (modes,)
        Natural frequencies of the fixed-interface modes [rad/s].
    size : int
        N, degrees of freedom of the full structure.
    accurate_to : float
        Angular frequency up to which natural frequencies with a free boundary are less than 1 % too
        high, as the modes that were left out tell [rad/s]; infinite if all are. Results beyond it
        say so.
    """

    def __init__(
        self,
        mass: CscArray,
        stiffness: CscArray,
        row_names: tuple[str, ...] | None,
        boundary: tuple[str, ...],
        rows: NDArray[np.int64],
        constraint: NDArray[np.float64],
        shapes: NDArray[np.float64],
        squares: NDArray[np.float64],
        asymmetry: tuple[float, float],
        factor: Factor,
    ) -> None:
        self.full_mass, self.full_stiffness = mass, stiffness
        self.row_names, self.asymmetry = row_names, asymmetry
        self.boundary, self.rows, self.size = boundary, rows, mass.shape[0]
        self.omega = np.sqrt(squares)
        self.dofs = _dofs(boundary, len(squares))
        self._basis = np.zeros((self.size, len(self.dofs)))
        inner = np.setdiff1d(np.arange(self.size), rows)
        kept = len(rows)
        self._basis[rows, np.arange(kept)] = 1.0
        self._basis[inner, :kept] = constraint
        self._basis[inner, kept:] = shapes
        M, K = _projected(mass, self._basis), _projected(stiffness, self._basis)
        # Constraint and fixed-interface modes are orthogonal in the stiffness: rounding otherwise.
        self.decoupling = float(np.abs(K[:kept, kept:]).max(initial=0.0) / np.abs(K).max())
        K[:kept, kept:] = K[kept:, :kept] = 0.0
        K[kept:, kept:] = np.diag(squares)
        M[kept:, kept:] = np.eye(len(squares))
        self.mass: Matrix = 0.5 * (M + M.T)
        self.stiffness: Matrix = 0.5 * (K + K.T)
        self.accurate_to = accurate_to(self, factor)
        self._freeze()

    def _freeze(self) -> None:
        for array in (self.mass, self.stiffness, self.rows, self.omega, self._basis):
            constant(array)

    def __repr__(self) -> str:
        return (
            f"Reduction({self.size} dofs to {len(self.boundary)} of the boundary and "
            f"{self.omega.size} modes)"
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the reduction to a NetCDF file, whole or not at all.

        Parameters
        ----------
        path : path-like
            The file; an existing one is replaced. Read it with `load`.

        Raises
        ------
        ModelError
            If the file cannot be written.
        """
        from stickslip.results.store import save_record

        save_record(path, KIND, record_of(self))

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Reduction:
        """Read a reduction that `save` wrote; it is equal to that one, bit by bit.

        Parameters
        ----------
        path : path-like
            The file.

        Raises
        ------
        ModelError
            If there is no such file, or it is damaged or holds something else.
        """
        from stickslip.results.store import load_record

        return load_record(path, KIND, reduction_of)

    def structure(self, damping: MatrixLike | DampingLaw | None = None) -> Structure:
        """Return the reduced structure, with the degrees of freedom `dofs`.

        Its viscous damping is given as that of `Structure`.
        """
        made = Structure(self.mass, self.stiffness, damping, self.dofs)
        set_fields(made, accurate_to=self.accurate_to)
        return made

    def recover(self, reduced: ArrayLike) -> NDArray[np.generic]:
        """Return the motion of all degrees of freedom, x = T q, shape (..., N).

        `reduced` is the motion of the reduced structure, shape (..., n), real or complex: a
        harmonic, an instant, many of them.
        """
        q = np.asarray(reduced)
        if not q.ndim or q.shape[-1] != len(self.dofs):
            raise ModelError(
                f"recover: shape {q.shape}; the last dimension must be {len(self.dofs)}, one per "
                "reduced dof"
            )
        return np.asarray(q @ self._basis.T)

    def forces(self, load: ArrayLike, harmonic: int = 1) -> list[Force]:
        """Return what a distributed load does to the reduced structure, T^T f.

        The load is on all degrees of freedom, shape (N,) [N]; complex numbers have phases, as those
        of a travelling wave: f(t) = Re(load exp(i k omega t)), k being the `harmonic`. There is one
        force per reduced degree of freedom that it moves.
        """
        given = np.asarray(load)
        if given.shape != (self.size,) or not np.isfinite(given).all():
            raise ModelError(f"load: shape {given.shape}; give {self.size} finite numbers")
        if harmonic == 0 and np.iscomplexobj(given):
            raise ModelError("load: complex numbers, but a static load has no phases")
        work = self._basis.T @ given
        return [
            Force(dof, float(np.real(value)), harmonic=harmonic)
            if np.isreal(value)
            else Force(dof, abs(value), float(np.angle(value)), harmonic)
            for dof, value in zip(self.dofs, work.tolist(), strict=True)
            if value != 0.0
        ]

    def report(
        self, frequencies: int = 10, springs: Mapping[str, float] | None = None
    ) -> ReductionReport:
        """Check the reduction against the full structure.

        `frequencies` says how many natural frequencies to compare; the full structure is factored
        once more. `springs` to ground at boundary degrees of freedom [N/m] are added to both
        structures: stuck dampers.
        """
        count = whole_number(frequencies, "frequencies", smallest=1, largest=self.size - 1)
        from scipy.sparse import diags_array

        own, _ = natural_modes(self, springs)
        count, added = min(count, own.size), np.zeros(self.size)
        for place, spring in springs_of(self, springs):
            added[self.rows[place]] += spring
        K, M = (self.full_stiffness + diags_array(added)).tocsc(), self.full_mass
        shift = shift_below(self)
        squares, _ = lowest_modes(K, M, count, Factor((K - shift * M).tocsc()), shift)
        omegas = np.sqrt(np.clip(squares, 0.0, None))
        return ReductionReport(
            (self.size, len(self.boundary), self.omega.size),
            self.asymmetry,
            self.decoupling,
            int((omegas < RIGID * self.omega[0]).sum()),
            *self._translations(),
            omegas,
            np.sqrt(np.clip(own[:count], 0.0, None)),
        )

    def _translations(self) -> tuple[dict[str, float], dict[str, float]]:
        """Return mass and resistance of the whole structure against translations."""
        masses: dict[str, float] = {}
        grounding: dict[str, float] = {}
        ways = [name.rpartition(".")[2] for name in self.row_names or ()]
        for way in ("1", "2", "3"):
            moved = np.array([one == way for one in ways], dtype=np.float64)
            if moved.any():
                total = float(moved @ (self.full_stiffness.diagonal() * moved))
                masses[way] = float(moved @ (self.full_mass @ moved))
                held = float(np.abs(self.full_stiffness @ moved).sum())
                grounding[way] = held / total if total else 0.0
        return masses, grounding


KIND = "reduction"
"""What files call it."""


def record_of(reduction: Reduction) -> Record:
    """Return a reduction as a record of everything that it has."""
    variables: dict[str, Any] = {
        "reduced_mass": (("dof", "other_dof"), reduction.mass, "kg", "reduced mass matrix"),
        "reduced_stiffness": (
            ("dof", "other_dof"),
            reduction.stiffness,
            "N/m",
            "reduced stiffness matrix",
        ),
        "basis": (("row", "dof"), reduction._basis, "1", "T of x = T q"),
        "rows": ("boundary", reduction.rows, "1", "rows of the boundary in the full matrices"),
        "boundary": ("boundary", np.array(reduction.boundary, np.str_), "1", "names of boundary"),
        "omega": ("mode", reduction.omega, "rad/s", "frequency of the fixed-interface modes"),
    }
    for name, unit, matrix in (
        ("mass", "kg", reduction.full_mass),
        ("stiffness", "N/m", reduction.full_stiffness),
    ):
        for part in _SPARSE:
            meaning = f"{part} of the compressed columns of the full {name} matrix"
            own = unit if part == "data" else "1"
            along = f"{name}_column" if part == "indptr" else f"{name}_entry"
            variables[f"{name}_{part}"] = (along, getattr(matrix, part), own, meaning)
    if reduction.row_names is not None:
        names = np.array(reduction.row_names, np.str_)
        variables["row_names"] = ("row", names, "1", "names of the rows")
    about = {
        "title": "Structure reduced to component modes",
        "decoupling": reduction.decoupling,
        "asymmetry": np.array(reduction.asymmetry),
        "accurate_to": reduction.accurate_to,
    }
    return Record(attrs=about).assign(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in variables.items()
        }
    )


def reduction_of(dataset: Stored) -> Reduction:
    """Return the reduction that a dataset holds; a ValueError if its parts do not fit together."""
    made = Reduction.__new__(Reduction)
    basis = dataset["basis"].values
    made.size, count = basis.shape
    made._basis = basis
    made.mass, made.stiffness = dataset["reduced_mass"].values, dataset["reduced_stiffness"].values
    made.rows, made.omega = dataset["rows"].values, dataset["omega"].values
    made.boundary = tuple(map(str, dataset["boundary"].values))
    made.dofs = _dofs(made.boundary, made.omega.size)
    made.full_mass = _sparse_of(dataset, "mass", made.size)
    made.full_stiffness = _sparse_of(dataset, "stiffness", made.size)
    named = "row_names" in dataset
    made.row_names = tuple(map(str, dataset["row_names"].values)) if named else None
    first, second = map(float, dataset.attrs["asymmetry"])
    made.asymmetry, made.decoupling = (first, second), float(dataset.attrs["decoupling"])
    made.accurate_to = float(dataset.attrs.get("accurate_to", np.inf))
    shapes = made.mass.shape, made.stiffness.shape, made.rows.shape
    if shapes != ((count, count), (count, count), (len(made.boundary),)):
        raise ValueError(f"matrices of shape {shapes[0]} for {count} columns of the basis")
    if len(made.dofs) != count or (named and len(made.row_names or ()) != made.size):
        raise ValueError(f"{len(made.dofs)} names for {count} columns of the basis")
    if ((made.rows < 0) | (made.rows >= made.size)).any():
        raise ValueError("the boundary lies outside the full matrices")
    made._freeze()
    return made


_SPARSE = ("data", "indices", "indptr")


def _sparse_of(dataset: Stored, name: str, size: int) -> CscArray:
    from scipy.sparse import csc_array

    data, indices, indptr = (dataset[f"{name}_{part}"].values for part in _SPARSE)
    matrix = csc_array((data, indices, indptr), shape=(size, size))
    # Wrong indices would lead outside the vectors that it is multiplied with.
    matrix.check_format(full_check=True)
    return matrix


def panels(rows: int, columns: int) -> Iterator[slice]:
    """Yield the columns of a matrix that is not to be copied as a whole, some at a time."""
    width = max(1, _PANEL // (8 * rows))
    for first in range(0, columns, width):
        yield slice(first, min(first + width, columns))


def _projected(matrix: CscArray, basis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return T^T A T; A T as a whole would be as large as T."""
    projected = np.empty((basis.shape[1],) * 2)
    for panel in panels(*basis.shape):
        projected[:, panel] = basis.T @ (matrix @ basis[:, panel])
    return projected


def _dofs(boundary: tuple[str, ...], modes: int) -> tuple[str, ...]:
    return (*boundary, *(f"mode-{mode}" for mode in range(1, modes + 1)))


_PANEL = 1 << 26
"""Bytes that are worked on at a time: freed parts below 32 MB may stay with the allocator."""


@dataclass(frozen=True, eq=False)
class ReductionReport:
    """Checks of a reduction."""

    sizes: tuple[int, int, int]
    """Degrees of freedom: full, boundary, fixed-interface modes."""
    asymmetry: tuple[float, float]
    """Of mass and stiffness as given, as a part of the largest entry."""
    decoupling: float
    """Stiffness between constraint and fixed-interface modes, 0 but for rounding, as a part of the
    largest entry."""
    rigid: int
    """Rigid-body modes of the full structure: 0 is grounded, 6 is free."""
    masses: dict[str, float]
    """Mass that a translation moves [kg], by direction "1", "2", "3"; empty without names such as
    "17.3". Clamped degrees of freedom are not in it."""
    grounding: dict[str, float]
    """Force that it takes to move the whole structure by a unit translation, as a part of the sum
    of its stiffnesses: 0 where it is free to move."""
    full: NDArray[np.float64]
    """(frequencies,) Natural frequencies of the full structure [rad/s], ascending."""
    reduced: NDArray[np.float64]
    """(frequencies,) Those of the reduced one [rad/s]."""

    @property
    def errors(self) -> NDArray[np.float64]:
        """How much higher the reduced frequencies are, relative; nan of rigid-body modes."""
        errors = np.full(self.full.size, np.nan)
        elastic = slice(self.rigid, None)
        errors[elastic] = self.reduced[elastic] / self.full[elastic] - 1.0
        return errors

    def __str__(self) -> str:
        full, boundary, modes = self.sizes
        lines = [
            f"{full} dofs reduced to {boundary} of the boundary and {modes} fixed-interface modes",
            f"asymmetry          mass {self.asymmetry[0]:.1e}, stiffness {self.asymmetry[1]:.1e}",
            f"decoupling         {self.decoupling:.1e} of the largest stiffness",
            f"rigid-body modes   {self.rigid}" + ("" if self.rigid else ": the structure is held"),
        ]
        for way, mass in self.masses.items():
            part = self.grounding[way]
            held = "free to move" if part < 1e-10 else "held"
            lines.append(f"direction {way}        {mass:.6g} kg, {held} ({part:.1e})")
        lines.append("mode   full [Hz]      reduced [Hz]   error")
        for mode, (one, other, error) in enumerate(
            zip(self.full, self.reduced, self.errors, strict=True), 1
        ):
            shown = "rigid body" if np.isnan(error) else f"{error:.1e}"
            hertz, reduced = one / (2.0 * np.pi), other / (2.0 * np.pi)
            lines.append(f"{mode:4d}   {hertz:<12.6g}   {reduced:<12.6g}   {shown}")
        return "\n".join(lines)

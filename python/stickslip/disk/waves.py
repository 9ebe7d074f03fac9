"""Travelling waves of a tuned disk in a flow, and their damping."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, finite_complex, members, set_fields, text, whole_number
from stickslip.disk.aerodynamics import (
    AerodynamicDamping,
    AerodynamicForces,
    Aerodynamics,
    Family,
    ModalForces,
)
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model.damping import modes_of
from stickslip.model.model import AnyMatrix, PointRef
from stickslip.model.structural import condensed_stiffness
from stickslip.model.structure import Structure

_PHASES = 1e-12
"""Imaginary part, relative to the whole, that is rounding."""


@dataclass(frozen=True, eq=False)
class Wave:
    """One travelling wave under aerodynamic forces, M x'' + C x' + K x = 0 of a sector."""

    diameter: int
    """Nodal diameter, 0 to n-1."""
    omega: float
    """Angular frequency with the aerodynamic stiffness [rad/s]."""
    mass: AnyMatrix
    """(N, N) Hermitian [kg]."""
    damping: AnyMatrix
    """(N, N) Of the disk and of the flow [kg/s]; Hermitian but for gyroscopic terms of the disk."""
    stiffness: AnyMatrix
    """(N, N) Hermitian, without the contacts [N/m]."""
    negative_damping: AnyMatrix
    """(N, N) What the flow adds to the damping [kg/s], Hermitian; real at a dof."""
    added_stiffness: AnyMatrix
    """(N, N) What the flow adds to the stiffness [N/m], Hermitian; real at a dof."""


@dataclass(frozen=True, eq=False)
class AerodynamicWaves:
    """The travelling waves of one mode family under aerodynamic forces."""

    disk: BladedDisk
    """The disk."""
    influence: Aerodynamics
    """What the flow does, as it was given."""
    diameters: NDArray[np.int64]
    """(n,) Nodal diameters 0 to n-1; those above n/2 run backwards."""
    omega: NDArray[np.float64]
    """(n,) Angular frequency with the aerodynamic stiffness [rad/s]."""
    aerodynamic_ratio: NDArray[np.float64]
    """(n,) Damping ratio of the flow alone; negative where it feeds energy in."""
    ratio: NDArray[np.float64]
    """(n,) Damping ratio of flow and disk together, without friction."""
    eigenvalue: NDArray[np.complex128]
    """(n,) Root s of s^2 + c s + omega_0^2 = L of the mode, exact in L [rad/s]."""
    forces: AerodynamicForces
    """What the flow does, per nodal diameter."""
    shapes: NDArray[np.complex128]
    """(n, N) The mode phi of unit modal mass, without flow."""

    @property
    def least_stable(self) -> int:
        """Nodal diameter of the wave with the least damping ratio, 0 to n-1."""
        return int(self.diameters[self.ratio.argmin()])

    def wave(self, diameter: int | None = None) -> Wave:
        """Return the matrices of a wave, as arrays for its limit cycle.

        Its nodal diameter is from 0 to n-1. Default: the least stable.
        """
        chosen = self.least_stable if diameter is None else whole_number(diameter, "diameter")
        n = self.disk.sectors
        if chosen >= n:
            raise ModelError(f"diameter: {chosen}; {n} sectors have 0 to {n - 1}")
        omega = float(self.omega[chosen])
        force, plane = self.forces.coefficients[chosen], self._plane(chosen)
        added, fed = -force.real * plane, -force.imag / omega * plane
        mass, damping, stiffness = self.disk.matrices.wave(self.disk.angle(chosen))
        return Wave(
            diameter=chosen,
            omega=omega,
            mass=mass,
            damping=damping + fed,
            stiffness=stiffness + added,
            negative_damping=fed,
            added_stiffness=added,
        )

    def negative_damping(self, diameter: int | None = None) -> AnyMatrix:
        """Return what the flow damps in a wave, in the form that `stickslip.limit_cycles` takes.

        Of shape (n, N, N) [kg/s]: -Im L(k d) / (k omega_d) by the nodal diameter k d modulo n that
        harmonic k meets, of the lowest odd k; 0 where none comes. The default wave is the least
        stable, and its stiffness is in `disk_of`.
        """
        wave, n = self.wave(diameter), self.disk.sectors
        planes = [self._plane(place) for place in range(n)]
        matrices = np.zeros((n, *planes[0].shape), dtype=np.result_type(*planes))
        met = set()
        for order in range(1, 2 * n, 2):
            place = order * wave.diameter % n
            if place not in met:
                met.add(place)
                fed = -self.forces.coefficients[place].imag / (order * wave.omega)
                matrices[place] = fed * planes[place]
        return matrices

    def _plane(self, diameter: int) -> AnyMatrix:
        """Return p p^H, real where no phase lies in it."""
        direction = self.forces.directions[diameter]
        plane = np.outer(direction, direction.conj())
        real = np.abs(plane.imag).max() <= _PHASES * np.abs(plane).max()
        return np.ascontiguousarray(plane.real) if real else plane

    def disk_of(self, diameter: int | None = None, ratio: float = 1.0) -> BladedDisk:
        """Return the disk in which a wave has the aerodynamic stiffness, and damping.

        It has no forces, and the nodal diameter of the wave as engine order. It is right for the
        fundamental of that wave; its harmonics see the same coefficients. `ratio` is a factor on
        the aerodynamic damping: 0 for `stickslip.limit_cycles`, which adds it.
        """
        wave, own = self.wave(diameter), self.disk.structure
        flow = wave.added_stiffness, ratio * wave.negative_damping
        if any(np.iscomplexobj(one) and one.any() for one in flow):
            raise ModelError(
                "disk_of: this mode runs through a sector with phases, so that its aerodynamic "
                "stiffness is no matrix of one sector; use ss.flutter_map, or "
                "ss.InfluenceCoefficients at a dof"
            )
        added, fed = (np.real(one) for one in flow)
        structure = Structure(
            own.mass,
            own.stiffness + added,
            own.damping + fed,
            own.dofs,
        ).made_of(own)
        return self.disk._like(
            structure=structure, forces=(), engine_order=wave.diameter, engine_orders=None
        )

    plot = Drawn("aerodynamic")


def aerodynamic_waves(
    disk: BladedDisk,
    influence: Aerodynamics,
    mode: int = 0,
    *,
    slipping: Iterable[PointRef] = (),
) -> AerodynamicWaves:
    """Damping ratio of every travelling wave of a tuned disk in a flow.

    Parameters
    ----------
    disk : BladedDisk
        The disk; its forces play no part.
    influence : InfluenceCoefficients, AerodynamicDamping or ModalForces
        What the flow does.
    mode : int, optional
        Mode of the sector whose waves these are, counted from 0 at every nodal diameter.
    slipping : iterable of int, str or (int or str, int), optional
        The contact points that slip. Default: all stick, as when flutter sets in.

    Returns
    -------
    AerodynamicWaves
        Frequencies and damping ratios, to first order in the aerodynamic forces, which are small
        against those of stiffness and inertia.

    Raises
    ------
    ModelError
        If `disk` is no tuned `BladedDisk`; if there is no such mode, dof or contact; if a wave
        has no stiffness.

    References
    ----------
    Crawley (1988), eqs. for the eigenvalues of a tuned cascade.
    """
    if not isinstance(disk, BladedDisk):
        raise ModelError(f"disk: {brief(disk)} is no tuned BladedDisk; give ss.BladedDisk(...)")
    if not isinstance(influence, InfluenceCoefficients | AerodynamicDamping | ModalForces):
        raise ModelError(
            f"influence: {brief(influence)} is none; give ss.InfluenceCoefficients(...), "
            "ss.AerodynamicDamping(...) or ss.ModalForces(...)"
        )
    family = whole_number(mode, "mode")
    if family >= len(disk.structure):
        raise ModelError(f"mode: {family}; a sector has {len(disk.structure)}, counted from 0")
    refs = members(slipping, "slipping", "slipping=[...]")
    slips = {disk.point(ref) for ref in refs}
    n = disk.sectors
    found = [_mode(disk, slips, d, family) for d in range(n)]
    shapes = np.array([one.shape for one in found])
    momenta = np.array([one.momentum for one in found])
    squares, own = (np.array([getattr(one, name) for one in found]) for name in ("square", "own"))
    natural = np.sqrt(np.maximum(squares, 0.0))
    forces = influence.forces(Family(disk.structure, natural, momenta))
    moved = np.abs(np.einsum("dn,dn->d", forces.directions.conj(), shapes)) ** 2
    flow = forces.coefficients * moved
    left = squares - flow.real
    for diameter in np.flatnonzero(~(left > 0.0)).tolist():
        raise ModelError(
            f"mode {family} of nodal diameter {diameter}: omega^2 = {left[diameter]:.6g} with the "
            "aerodynamic stiffness; give smaller coefficients, or ground the structure"
        )
    omega = np.sqrt(left)
    ratio = -flow.imag / (2.0 * left)
    root = -0.5 * own + 1j * np.sqrt(squares - flow - 0.25 * own**2)
    total = ratio + own / (2.0 * omega)
    waves = AerodynamicWaves(
        disk, influence, np.arange(n), omega, ratio, total, np.asarray(root), forces, shapes
    )
    set_fields(waves, **vars(waves))
    return waves


class _Mode(NamedTuple):
    """A wave without flow."""

    square: float
    """omega^2."""
    own: float
    """Damping of the disk, phi^H C phi [1/s]."""
    shape: NDArray[np.complex128]
    """phi, of unit modal mass."""
    momentum: NDArray[np.complex128]
    """M phi."""


def _mode(disk: BladedDisk, slips: set[tuple[int, int]], diameter: int, mode: int) -> _Mode:
    delta = disk.angle(diameter)
    mass, damping, stiffness = disk.matrices.wave(delta)
    stiffness = stiffness + _stuck(disk, slips, delta)
    _, shapes = modes_of(stiffness, mass)
    shape = np.asarray(shapes[:, mode], dtype=np.complex128)
    square, own = ((shape.conj() @ one @ shape).real for one in (stiffness, damping))
    return _Mode(float(square), float(own), shape, mass @ shape)


def _stuck(disk: BladedDisk, slips: set[tuple[int, int]], delta: float) -> AnyMatrix:
    """Return the stiffness of the sticking contact points in a wave."""
    size = len(disk.structure)
    total = np.zeros((size, size), dtype=np.complex128)
    for number, contact in enumerate(disk.contacts):
        own, following = disk.contact_rows(contact)
        rows = own + np.exp(1j * delta) * following
        sticks = np.array([(number, point) not in slips for point in range(contact.points)])
        total += rows.conj().T @ condensed_stiffness(contact.stuck_stiffness, sticks) @ rows
    return total


@dataclass(frozen=True)
class InfluenceCoefficients:
    """Aerodynamic force on a blade per displacement of itself and of its neighbours.

    A blade that moves as Re x exp(i omega t) exerts Re L_j x exp(i omega t) on the blade j places
    before it; in a travelling wave of nodal diameter d of n blades, each ahead of the one before by
    2 pi d / n, the force on every blade is its own displacement times

        L(d) = sum_j L_j exp(2 pi i d j / n).

    Its real part is a stiffness less, its imaginary part over omega a damping less: a positive
    imaginary part feeds energy into the wave.

    Parameters
    ----------
    coefficients : mapping of int to complex
        L_j by the place j of the moving blade: 0 the blade itself, 1 the next, -1 the one before.
        In N/m at a `dof`; of a `mode` with unit modal mass in 1/s^2.
    dof : str, optional
        The degree of freedom that moves and is acted on.
    mode : int, optional
        Instead: the mode of a blade by itself, counted from 0, along which it moves.

    Raises
    ------
    ModelError
        If there is no coefficient, one is not finite, or not exactly one of dof and mode is given.

    References
    ----------
    Hanamura, Tanaka and Yamaguchi (1980); Crawley (1988) on travelling-wave and influence
    coefficients.
    """

    coefficients: Mapping[int, complex]
    dof: str | None = None
    mode: int | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.coefficients, Mapping) or not self.coefficients:
            raise ModelError(
                f"influence coefficients: {brief(self.coefficients)} is no mapping; give "
                "{0: ..., 1: ..., -1: ...}"
            )
        checked: dict[int, complex] = {}
        for place, value in self.coefficients.items():
            if isinstance(place, bool) or not isinstance(place, int | np.integer):
                raise ModelError(f"influence coefficients: place {brief(place)} is no whole number")
            number = finite_complex(value)
            if number is None:
                raise ModelError(
                    f"influence coefficient {place}: {brief(value)} is no finite number; give L_j "
                    "in N/m"
                )
            checked[int(place)] = number
        if (self.dof is None) == (self.mode is None):
            raise ModelError("influence coefficients: give exactly one of dof and mode")
        if self.dof is not None:
            text(self.dof, "influence coefficients: dof")
        else:
            whole_number(self.mode, "influence coefficients: mode")
        object.__setattr__(self, "coefficients", MappingProxyType(checked))

    def forces(self, family: Family) -> AerodynamicForces:
        """Return the forces on the waves of a family."""
        n, direction = family.omega.size, self.direction(family.structure)
        coefficients = np.array([self.at(d, n) for d in range(n)])
        return AerodynamicForces(coefficients, np.tile(direction.astype(np.complex128), (n, 1)))

    def at(self, diameter: int, sectors: int) -> complex:
        """Return L(d), the coefficient of a travelling wave of nodal diameter d, from 0 to n-1.

        n - d runs the other way round.
        """
        turn = 2j * np.pi * diameter / sectors
        return complex(sum(L * np.exp(turn * j) for j, L in self.coefficients.items()))

    def direction(self, structure: Structure) -> NDArray[np.float64]:
        """Return the vector p of the force p L p^T x on a blade by itself, shape (N,).

        It is the unit vector of the dof, or M phi of the mode phi with unit modal mass.
        """
        if self.dof is not None:
            unit: NDArray[np.float64] = np.eye(len(structure))[structure.index(self.dof)]
            return unit
        mode = whole_number(self.mode, "influence coefficients: mode")
        if mode >= len(structure):
            raise ModelError(
                f"influence coefficients: mode {mode}; a blade has {len(structure)}, counted from 0"
            )
        _, shapes = modes_of(structure.stiffness, structure.mass)
        return np.asarray(structure.mass @ shapes[:, mode], dtype=np.float64)

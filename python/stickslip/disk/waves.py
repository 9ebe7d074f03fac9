"""Travelling waves of a tuned disk in a flow: their damping, and their matrices."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, brief, members, whole_number
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.influence import InfluenceCoefficients
from stickslip.errors import ModelError
from stickslip.model.model import AnyMatrix, PointRef
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from typing import Unpack

    from matplotlib.axes import Axes

    from stickslip.plot.options import Drawing

__all__ = ["AerodynamicWaves", "Wave", "aerodynamic_waves"]


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
    negative_damping: Matrix
    """(N, N) What the flow adds to the damping [kg/s], real and symmetric."""
    added_stiffness: Matrix
    """(N, N) What the flow adds to the stiffness [N/m], real and symmetric."""


@dataclass(frozen=True, eq=False)
class AerodynamicWaves:
    """The travelling waves of one mode family under aerodynamic forces."""

    disk: BladedDisk
    """The disk."""
    influence: InfluenceCoefficients
    """What the flow does."""
    diameters: NDArray[np.int64]
    """(n,) Nodal diameters 0 to n-1; those above n/2 run backwards."""
    omega: NDArray[np.float64]
    """(n,) Angular frequency with the aerodynamic stiffness [rad/s]."""
    aerodynamic_ratio: NDArray[np.float64]
    """(n,) Damping ratio of the flow alone; negative where it feeds energy in."""
    ratio: NDArray[np.float64]
    """(n,) Damping ratio of flow and disk together, without friction."""

    @property
    def least_stable(self) -> int:
        """Nodal diameter of the wave with the least damping ratio, 0 to n-1."""
        return int(self.diameters[self.ratio.argmin()])

    def wave(self, diameter: int | None = None) -> Wave:
        """Return the matrices of a wave, as arrays for its limit cycle.

        Parameters
        ----------
        diameter : int, optional
            Nodal diameter, 0 to n-1. Default: the least stable.

        Returns
        -------
        Wave
            Its matrices.

        Raises
        ------
        ModelError
            If there is no such nodal diameter.
        """
        chosen = self.least_stable if diameter is None else whole_number(diameter, "diameter")
        n = self.disk.sectors
        if chosen >= n:
            raise ModelError(f"diameter: {chosen}; {n} sectors have 0 to {n - 1}")
        omega = float(self.omega[chosen])
        direction = self.influence.direction(self.disk.structure)
        plane = np.outer(direction, direction)
        force = self.influence.at(chosen, n)
        added, fed = -force.real * plane, -force.imag / omega * plane
        delta = 2.0 * np.pi * chosen / n
        blocks = self.disk.matrices
        return Wave(
            diameter=chosen,
            omega=omega,
            mass=blocks.mass.wave(delta),
            damping=blocks.damping.wave(delta) + fed,
            stiffness=blocks.stiffness.wave(delta) + added,
            negative_damping=fed,
            added_stiffness=added,
        )

    def negative_damping(self, diameter: int | None = None) -> NDArray[np.float64]:
        """Return what the flow damps in a wave, in the form that `stickslip.limit_cycles` takes.

        Parameters
        ----------
        diameter : int, optional
            Nodal diameter d of the wave, 0 to n-1. Default: the least stable.

        Returns
        -------
        ndarray of float64, shape (n, N, N)
            -Im L(k d) / (k omega_d) by the nodal diameter k d modulo n that harmonic k meets, of
            the lowest odd k [kg/s]; 0 where none comes. Its stiffness is in `disk_of`.

        Raises
        ------
        ModelError
            If there is no such nodal diameter.
        """
        wave, n = self.wave(diameter), self.disk.sectors
        direction = self.influence.direction(self.disk.structure)
        matrices = np.zeros((n, len(direction), len(direction)))
        met = set()
        for order in range(1, 2 * n, 2):
            place = order * wave.diameter % n
            if place not in met:
                met.add(place)
                fed = -self.influence.at(place, n).imag / (order * wave.omega)
                matrices[place] = fed * np.outer(direction, direction)
        return matrices

    def disk_of(self, diameter: int | None = None, ratio: float = 1.0) -> BladedDisk:
        """Return the disk in which a wave has the aerodynamic stiffness, and damping.

        Parameters
        ----------
        diameter : int, optional
            Nodal diameter, 0 to n-1. Default: the least stable.
        ratio : float, optional
            Factor on the aerodynamic damping; 0 for `stickslip.limit_cycles`, which adds it.

        Returns
        -------
        BladedDisk
            Without forces, its engine order the nodal diameter. Right for the fundamental of that
            wave; its harmonics see the same coefficients.
        """
        wave, disk = self.wave(diameter), self.disk
        own = disk.structure
        return BladedDisk(
            Structure(
                own.mass,
                own.stiffness + wave.added_stiffness,
                own.damping + ratio * wave.negative_damping,
                own.dofs,
            ),
            disk.sectors,
            disk.couplings,
            disk.contacts,
            engine_order=wave.diameter,
            interface=disk.interface,
        )

    def plot(self, **options: Unpack[Drawing]) -> Axes:
        """Draw the damping ratio over the nodal diameter; see `stickslip.plot.aerodynamic`."""
        from stickslip import plot

        return plot.aerodynamic(self, **options)


def aerodynamic_waves(
    disk: BladedDisk,
    influence: InfluenceCoefficients,
    mode: int = 0,
    *,
    slipping: Iterable[PointRef] = (),
) -> AerodynamicWaves:
    """Damping ratio of every travelling wave of a tuned disk under influence coefficients.

    Parameters
    ----------
    disk : BladedDisk
        The disk; its forces play no part.
    influence : InfluenceCoefficients
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
    if not isinstance(influence, InfluenceCoefficients):
        raise ModelError(
            f"influence: {brief(influence)} is none; give ss.InfluenceCoefficients(...)"
        )
    family = whole_number(mode, "mode")
    if family >= len(disk.structure):
        raise ModelError(f"mode: {family}; a sector has {len(disk.structure)}, counted from 0")
    refs = members(slipping, "slipping", "slipping=[...]")
    slips = {disk.point(ref) for ref in refs}
    direction = influence.direction(disk.structure)
    n = disk.sectors
    rows = [_wave(disk, slips, direction, influence.at(d, n), d, family) for d in range(n)]
    omega, flow, total = np.array(rows).T
    diameters = np.arange(n)
    for array in (diameters, omega, flow, total):
        array.flags.writeable = False
    return AerodynamicWaves(disk, influence, diameters, omega, flow, total)


def _wave(
    disk: BladedDisk,
    slips: set[tuple[int, int]],
    direction: NDArray[np.float64],
    force: complex,
    diameter: int,
    mode: int,
) -> tuple[float, float, float]:
    """Return frequency and both damping ratios of a wave."""
    from scipy.linalg import eigh

    delta = 2.0 * np.pi * diameter / disk.sectors
    blocks = disk.matrices
    stiffness = blocks.stiffness.wave(delta) + _stuck(disk, slips, delta)
    _, shapes = eigh(stiffness, blocks.mass.wave(delta))
    shape = shapes[:, mode]
    moved = abs(direction @ shape) ** 2
    square = (shape.conj() @ stiffness @ shape).real - force.real * moved
    if not square > 0.0:
        raise ModelError(
            f"mode {mode} of nodal diameter {diameter}: omega^2 = {square:.6g} with the "
            "aerodynamic stiffness; give smaller coefficients, or ground the structure"
        )
    omega = float(np.sqrt(square))
    own = (shape.conj() @ blocks.damping.wave(delta) @ shape).real
    flow = -force.imag * moved / (2.0 * square)
    return omega, float(flow), float(flow + own / (2.0 * omega))


def _stuck(disk: BladedDisk, slips: set[tuple[int, int]], delta: float) -> AnyMatrix:
    """Return the stiffness of the sticking contact points in a wave."""
    size = len(disk.structure)
    total = np.zeros((size, size), dtype=np.complex128)
    for number, contact in enumerate(disk.contacts):
        own, following = disk.contact_rows(contact)
        rows = own + np.exp(1j * delta) * following
        sticks = [point for point in range(contact.points) if (number, point) not in slips]
        total += rows.conj().T @ _condensed(contact.stuck_stiffness, sticks) @ rows
    return total


def _condensed(spring: Matrix, sticks: list[int]) -> Matrix:
    """Return the stiffness left when only some points stick, the others being free of force."""
    left = np.zeros_like(spring)
    if len(sticks) == len(spring):
        return spring
    if sticks:
        free = [point for point in range(len(spring)) if point not in sticks]
        held, cross = spring[np.ix_(sticks, sticks)], spring[np.ix_(sticks, free)]
        loose = spring[np.ix_(free, free)]
        left[np.ix_(sticks, sticks)] = held - cross @ np.linalg.solve(loose, cross.T)
    return left

"""A disk of equal blades, as one sector of a travelling wave."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _core
from stickslip.checks import brief, members, set_fields, whole_number
from stickslip.disk.mistuned import MistunedDisk, deviating
from stickslip.disk.sector import Sector
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model.configurations import every_point, natural_frequencies
from stickslip.model.model import AnyMatrix, Model, PointRef, from_core
from stickslip.model.structure import Structure

ALL_SECTORS = "mistuning = {deviation = 0.0} in [disk]"
"""How study files ask for all sectors of a tuned disk."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class BladedDisk(Sector):
    """A disk of n equal sectors under forces of an engine order.

    It is a `Model` of sector 0. In the steady state every sector moves as the one before it, ahead
    by the time in which the forces come round by one sector; one sector with these phases is the
    whole disk, exactly, friction between sectors included. Harmonic k meets the disk at nodal
    diameter k E mod n.

    Parameters
    ----------
    structure : Structure
        A sector by itself. Its damping law sees neither couplings nor interface.
    sectors : int
        Number n of sectors, at least 2.
    couplings : iterable of Coupling, optional
        Springs between neighbouring sectors, also from sector n-1 to 0.
    contacts : iterable of Contact, optional
        Friction contacts of each sector: ``Jenkins("damper", ...)`` to ground, ``Jenkins("a", "b",
        ...)`` inside the sector, ``Jenkins("tip", "next.tip", ...)`` to the next sector.
    forces : iterable of Force, optional
        Forces on sector 0. Those on sector i are ahead by 2 pi E_k i / n, E_k being the engine
        order of their harmonic k.
    engine_order : int
        Engine order E, not negative; n - E runs the other way round.
    engine_orders : mapping of int to int, optional
        Engine orders E_k of forces by their harmonic k. Default: k E, a pattern of pressure that
        stands still while the disk turns. Others than k E modulo n are no single travelling wave:
        only ``mistuned(0)`` computes those.
    interface : Interface, optional
        Blocks of cyclic matrices that couple each sector to the next.

    Raises
    ------
    ModelError
        If a number is outside its range; if a coupling, contact or force names a degree of freedom
        that the sector lacks; if the interface has another size than the structure; if a contact
        touches the next sector only.

    Examples
    --------
    >>> import stickslip as ss
    >>> blade = ss.Structure(mass=[[1.0]], stiffness=[[4.0e4]], dofs=["tip"])
    >>> ring = ss.Coupling("tip", stiffness=1e3)
    >>> disk = ss.BladedDisk(blade, sectors=12, couplings=[ring], engine_order=2)
    >>> ss.natural_frequencies(disk, nodal_diameter=6).round(3)
    array([209.762])
    """

    travels: ClassVar[bool] = True

    def __repr__(self) -> str:
        return (
            f"BladedDisk({self.sectors} x {self.structure!r}, {self._listed} of engine order "
            f"{self.engine_order})"
        )

    def diameter(self, harmonic: int) -> int:
        """Return the nodal diameter at which a harmonic of the motion meets the disk, 0 to n-1."""
        return harmonic * self.engine_order % self.sectors

    def matrices_at(self, harmonic: int) -> tuple[AnyMatrix, AnyMatrix, AnyMatrix]:
        """Return mass, damping and stiffness as a harmonic of the motion meets them, complex."""
        mass, damping, stiffness = self.matrices.wave(self.angle(self.diameter(harmonic)))
        return mass, damping, stiffness

    def angle(self, diameter: int) -> float:
        """Return by how much a wave of a nodal diameter is ahead from sector to sector [rad]."""
        return 2.0 * pi * diameter / self.sectors

    def seen_from(self, sector: int) -> BladedDisk:
        """Return the disk, under forces ahead by those of a sector from 0 to n-1, as from there."""
        number = whole_number(sector, "sector")
        if number >= self.sectors:
            raise ModelError(f"sector: {number}; there are {self.sectors}, 0 to {self.sectors - 1}")
        return self.replaced(forces=self.forces_on(number)) if number else self

    @cached_property
    def problem(self) -> _core.Problem:
        """One sector of the wave as the compiled core sees it, built once; forces must make one."""
        for number, force in enumerate(self.forces, 1):
            k, order = force.harmonic, self.order_of(force.harmonic)
            if (order - k * self.engine_order) % self.sectors:
                reason = (
                    f"force {number} at {brief(force.dof)}: harmonic {k} of engine order {order} "
                    f"does not travel with {k} x {self.engine_order} modulo {self.sectors} "
                    "sectors, so that the motion is no single wave; compute all sectors"
                )
                raise ModelError(f"{reason}, disk.mistuned(0)", study=f"{reason}, {ALL_SECTORS}")
        return self._wave_problem(self._loads())

    def mistuned(
        self,
        pattern: ArrayLike | None = None,
        *,
        mass: ArrayLike | None = None,
        structures: Iterable[Structure] | None = None,
    ) -> MistunedDisk:
        """Return the assembly of all sectors, which may differ: a `Model`.

        Its degrees of freedom are "0.tip", "1.tip", ..., its contacts "0.jenkins", ...

        Parameters
        ----------
        pattern : array_like, shape (n,), or float, optional
            Deviations of stiffness, 0.02 or "2 %": that of sector i is (1 + pattern[i]) times that
            of the structure. Couplings and interface do not deviate. A damping law makes the
            damping anew, a damping matrix stays. 0 is the tuned assembly.
        mass : array_like, shape (n,), or float, optional
            Deviations of mass, likewise.
        structures : iterable of Structure, optional
            Instead of both: one sector structure each, with the same degrees of freedom.

        Raises
        ------
        ModelError
            If there is not one entry per sector, a deviation is not above -1, a structure has other
            degrees of freedom, or nothing or too much is given.
        """
        return MistunedDisk(self, deviating(self, pattern, mass, structures))

    def nodal_diameters(self, slipping: Iterable[PointRef] | None = None) -> NodalDiameters:
        """Return the natural frequencies at all nodal diameters, stuck and slipping.

        `slipping` are the contact points that slip, as of `natural_frequencies`. Default: all.
        """
        given = every_point(self) if slipping is None else slipping
        slips = members(given, "slipping", "slipping=[...]")
        diameters = np.arange(self.sectors // 2 + 1)
        stuck, free = (
            np.stack([natural_frequencies(self, points, nodal_diameter=int(d)) for d in diameters])
            for points in ((), slips)
        )
        found = NodalDiameters(self, diameters, stuck, free)
        set_fields(found, **vars(found))
        return found

    def frequencies(
        self, points: list[tuple[int, int]], nodal_diameter: int | None
    ) -> NDArray[np.float64]:
        """Return natural frequencies at a nodal diameter; see `natural_frequencies`."""
        diameter = self.diameter(1)
        if nodal_diameter is not None:
            diameter = whole_number(nodal_diameter, "nodal_diameter")
        if diameter >= self.sectors:
            raise ModelError(
                f"nodal_diameter: {diameter}; {self.sectors} sectors have 0 to {self.sectors // 2}"
            )
        return self._unforced.natural_frequencies(self._slipping(points), diameter)

    @cached_property
    def _unforced(self) -> _core.Problem:
        return self._wave_problem([])

    def _wave_problem(self, loads: list[tuple[int, NDArray[np.complex128]]]) -> _core.Problem:
        return from_core(
            _core.Problem.travelling_wave,
            self.matrices.mass,
            self.matrices.damping,
            self.matrices.stiffness,
            self.sectors,
            self.engine_order % self.sectors,
            self._core_contacts(),
            loads,
            self.matrices.proportional,
        )


@dataclass(frozen=True, eq=False, repr=False)
class NodalDiameters:
    """Natural frequencies at the nodal diameters 0 to n/2, rounded down.

    A wave of nodal diameter d that runs the other way round, n - d, has the same frequencies unless
    gyroscopic terms part them; those belong to the damping, which plays no part here.
    """

    disk: BladedDisk
    """The disk."""
    diameters: NDArray[np.int64]
    """(D,) Nodal diameters."""
    stuck: NDArray[np.float64]
    """(D, N) With all contacts stuck [rad/s], ascending at each diameter."""
    slipping: NDArray[np.float64]
    """(D, N) With the chosen contact points slipping [rad/s]."""

    def __repr__(self) -> str:
        last, modes = self.diameters[-1], self.stuck.shape[1]
        return f"NodalDiameters(0 to {last} of {self.disk.sectors} sectors, {modes} modes each)"

    plot = Drawn("nodal_diameters")
    plot_safe = Drawn("safe")


def rotor_order(model: Model) -> float:
    """Return the frequency over the speed of the rotor: the engine order of a disk.

    It is 0 where that is not known, as of a model that is no disk.
    """
    disk = model.disk if isinstance(model, MistunedDisk) else model
    return disk.engine_order if isinstance(disk, BladedDisk) else 0

"""How the sectors of a bladed disk move, one beside the other."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple, Self, TypeAlias

import numpy as np

from stickslip.checks import brief, constant, text, unknown
from stickslip.disk import BladedDisk, MistunedDisk
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.results.arrays import Measure
from stickslip.results.contact_motion import ContactMotion
from stickslip.results.fields import Float
from stickslip.results.peaks import Peak

SectorDof: TypeAlias = str
"""Of the equal sectors of a disk."""


class Amplification(NamedTuple):
    """The highest peak of any blade of a mistuned disk, against that of the tuned one."""

    factor: float
    """Ratio of the two peak amplitudes."""
    blade: int
    """Blade of the highest peak, counted from 0."""
    peak: Peak
    """The highest peak of the mistuned disk."""
    tuned: Peak
    """The peak of the tuned disk."""


class BladeMotion(ContactMotion):
    """The part of a result that concerns the sectors of a disk."""

    plot_blades = Drawn("blade_bars")
    plot_blade_curves = Drawn("blade_curves")

    def sector(self, number: int) -> Self:
        """Return the motion of another sector of a tuned disk.

        The same result seen from that sector: harmonic k of everything, contacts and forces
        included, is ahead by 2 pi k E number / n.

        Raises ModelError if the result is not one of a `BladedDisk`, or there is no such sector.

        Parameters
        ----------
        number : int
            The sector, from 0 to n-1.
        """
        disk = self._tuned_disk()
        model = disk.seen_from(number)
        if model is disk:
            return self
        orders = np.arange(self.arrays.displacement.shape[1])
        # Whole turns are dropped before the angle is formed: high harmonics keep all digits.
        turns = orders * (disk.engine_order % disk.sectors) * number % disk.sectors
        turn = np.exp(2j * np.pi * turns / disk.sectors)[:, np.newaxis]

        names = ("displacement", "contact_displacement", "contact_force")
        turned = {name: getattr(self.arrays, name) * turn for name in names}
        return replace(self, model=model, arrays=replace(self.arrays, **turned))

    def blades(self, dof: SectorDof) -> tuple[int, ...]:
        """Return the blades of a mistuned disk at which a degree of freedom was observed.

        Ascending, counted from 0.

        Raises ModelError if the result is not one of a `MistunedDisk`, or the dof was observed at
        no blade.
        """
        disk = self._mistuned_disk()
        known = disk.disk.structure.dofs
        if text(dof, "dof") not in known:
            raise ModelError(unknown("dof of a sector", dof, known))
        seen = tuple(n for n in range(disk.sectors) if f"{n}.{dof}" in self.dofs)
        if not seen:
            raise ModelError(
                f"dof {dof!r}: it was observed at no blade; add f'{{i}}.{dof}' to observe and run "
                "again"
            )
        return seen

    def blade_amplitudes(self, dof: SectorDof, measure: Measure = "half_range") -> Float:
        """Return the amplitudes of one degree of freedom at all blades of a mistuned disk.

        Of those that `blades` returns, shape (n, blades) [m].

        Raises ModelError as `blades`.
        """
        columns = [self.amplitude(f"{blade}.{dof}", measure) for blade in self.blades(dof)]
        return constant(np.stack(columns, axis=1))

    def highest_blade(self, dof: SectorDof, measure: Measure = "half_range") -> tuple[int, Peak]:
        """Return the blade with the highest peak, counted from 0, and the peak.

        All observed blades are followed together over the range of the computed points, between
        which the peak is refined.

        Raises ModelError as `blades`; if no point is solved.
        """
        if not self.arrays.solved.any():
            raise ModelError(f"peak of {dof!r}: no point is solved; see status")
        blades = self.blades(dof)
        index, peak = self._highest_of([f"{blade}.{dof}" for blade in blades], measure)
        return blades[index], peak

    def amplification(
        self, tuned: BladeMotion, dof: SectorDof, measure: Measure = "half_range"
    ) -> Amplification:
        """Return the amplification factor of a mistuned disk.

        The highest peak over the computed frequencies and the observed blades, over the peak of the
        tuned disk.

        Factor, blade and both peaks.

        Raises ModelError as `highest_blade`; if `tuned` is not a result of a `BladedDisk`.

        Parameters
        ----------
        tuned : ForcedResponse
            The response of the tuned disk.
        """
        reference = response_of_disk(tuned)
        blade, peak = self.highest_blade(dof, measure)
        known = reference.peak(dof, measure)
        return Amplification(peak.amplitude / known.amplitude, blade, peak, known)

    def _tuned_disk(self) -> BladedDisk:
        if not isinstance(self.model, BladedDisk):
            raise ModelError(
                "sector: the model has no equal sectors; a MistunedDisk has all its sectors among "
                "the dofs, '3.tip'"
            )
        return self.model

    def _mistuned_disk(self) -> MistunedDisk:
        if not isinstance(self.model, MistunedDisk):
            raise ModelError(
                "blades: the model is no MistunedDisk; the blades of a tuned disk are all alike, "
                "see sector"
            )
        return self.model


def response_of_disk(tuned: object) -> BladeMotion:
    """Return the response of a tuned disk, or refuse anything else."""
    if not isinstance(tuned, BladeMotion) or not tuned.model.travels:
        raise ModelError(
            f"tuned: {brief(tuned)} is not the response of a BladedDisk; give "
            "forced_response(disk, ...)"
        )
    return tuned

"""The tuned disks of a mistuning study, their peaks, and what tells the study from others."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from numpy.typing import ArrayLike

from stickslip.analyses.arguments import require_held
from stickslip.analyses.mistuning_arguments import numbers_of
from stickslip.analyses.pattern_store import Identity, Row, digest
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.coupling import Coupling
from stickslip.errors import ModelError
from stickslip.results.arrays import Float
from stickslip.results.status import Status
from stickslip.settings.peaks import MistuningSettings

if TYPE_CHECKING:
    from stickslip.disk.mistuned import MistunedDisk

__all__ = ["Series", "coupled_disks", "identity_of", "tuned_peaks"]


class Series(NamedTuple):
    """The disks of one stiffness of the couplings."""

    disk: BladedDisk
    coupling: float
    """Stiffness of the couplings [N/m]; not-a-number: they have several, or there is none."""
    tuned: tuple[Row, ...]
    """Peaks of the tuned disk, one per degree of freedom."""


def tuned_peaks(
    disk: BladedDisk, settings: MistuningSettings, dofs: Sequence[str]
) -> tuple[Row, ...]:
    """Return the peaks of the tuned disk, by one sector if its motion is one wave."""
    from stickslip import _core

    model: BladedDisk | MistunedDisk = disk
    groups = [[dof] for dof in dofs]
    if not _is_one_wave(disk):
        model = disk.mistuned(0.0)
        groups = [[f"{blade}.{dof}" for blade in range(disk.sectors)] for dof in dofs]
    require_held(model, settings.residual)
    try:
        found = _core.summits(
            model.problem,
            [[model.structure.index(dof) for dof in group] for group in groups],
            settings.measure,
            settings.span,
            settings,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error
    rows = tuple(Row(*row) for row in found)
    for dof, row in zip(dofs, rows, strict=True):
        status = Status.from_code(row.status)
        if not status.solved:
            raise ModelError(
                f"dof {dof!r}: the peak of the tuned disk was not found ({status}), and "
                f"nothing can be compared with it. {status.advice}"
            )
        if row.amplitude == 0.0:
            raise ModelError(f"dof {dof!r}: it does not move; give the disk forces that reach it")
    return rows


def coupled_disks(disk: BladedDisk, stiffness: ArrayLike | None) -> list[tuple[float, BladedDisk]]:
    """Return the disk with each stiffness of its couplings."""
    own = {coupling.stiffness for coupling in disk.couplings}
    if stiffness is None:
        return [(own.pop() if len(own) == 1 else math.nan, disk)]
    if not disk.couplings:
        reason = "coupling_stiffness: the disk has no couplings that could take it; give it"
        raise ModelError(
            f"{reason} couplings=[ss.Coupling(...)]", study=f"{reason} a table [[coupling]]"
        )
    values = numbers_of(stiffness, "coupling_stiffness", "stiffnesses in N/m").tolist()
    return [
        (value, _coupled(disk, [replace(one, stiffness=value) for one in disk.couplings]))
        for value in values
    ]


def _coupled(disk: BladedDisk, couplings: Sequence[Coupling]) -> BladedDisk:
    return BladedDisk(
        disk.structure,
        disk.sectors,
        couplings,
        disk.contacts,
        disk.forces,
        engine_order=disk.engine_order,
        engine_orders=disk.engine_orders,
        interface=disk.interface,
    )


def _is_one_wave(disk: BladedDisk) -> bool:
    """Tell whether the forces, and so the motion of the tuned disk, travel as a single wave."""
    ahead = (disk.order_of(one.harmonic) - one.harmonic * disk.engine_order for one in disk.forces)
    return all(order % disk.sectors == 0 for order in ahead)


def identity_of(
    disk: BladedDisk,
    settings: MistuningSettings,
    dofs: tuple[str, ...],
    patterns: Float,
    *,
    given: bool,
) -> Identity:
    """Return what makes a study, but for how many patterns, which deviations and couplings."""
    from stickslip._core import __version__

    structure, law = disk.structure, disk.structure.damping_law
    couplings = [one.to_spec() for one in disk.couplings]
    if given or len({one.stiffness for one in disk.couplings}) == 1:
        # Every row says which stiffness it is of.
        couplings = [one | {"stiffness": None} for one in couplings]
    interface = disk.interface
    blocks = () if interface is None else (interface.mass, interface.damping, interface.stiffness)
    return {
        "version": __version__,
        "structure": digest(structure.mass, structure.damping, structure.stiffness),
        "damping": None if law is None else law.to_spec(),
        "sector": list(structure.dofs),
        "sectors": disk.sectors,
        "engine_order": disk.engine_order,
        "engine_orders": {str(k): order for k, order in disk.engine_orders.items()},
        "couplings": couplings,
        "interface": digest(*blocks),
        "contacts": [one.to_spec() for one in disk.contacts],
        "forces": [one.to_spec() for one in disk.forces],
        "dofs": list(dofs),
        "omega": list(settings.span),
        "patterns": digest(patterns) if settings.distribution is None else "drawn",
        **{name: value for name, value in settings if name != "span"},
    }

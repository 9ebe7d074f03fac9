"""How often forces act on a sector while the rotor turns once."""

from __future__ import annotations

from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.mistuned import MistunedDisk
from stickslip.model import Model


def rotor_order(model: Model) -> float:
    """Return the frequency over the speed of the rotor: the engine order of a disk.

    It is 0 where that is not known, as of a model that is no disk.
    """
    disk = model.disk if isinstance(model, MistunedDisk) else model
    return disk.engine_order if isinstance(disk, BladedDisk) else 0

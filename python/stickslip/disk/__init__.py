"""Bladed disks: equal sectors in a travelling wave, and rings of sectors that differ."""

from stickslip.calls import checked_names
from stickslip.disk.aerodynamics import AerodynamicDamping, ModalForces
from stickslip.disk.bladed_disk import BladedDisk, NodalDiameters
from stickslip.disk.coupling import Interface, cyclic_sector
from stickslip.disk.mistuned import MistunedDisk, Ring
from stickslip.disk.pattern import frequency_pattern, mistuning_pattern
from stickslip.disk.waves import AerodynamicWaves, InfluenceCoefficients, aerodynamic_waves
from stickslip.model.coupling import Coupling

__all__ = [
    "AerodynamicDamping",
    "AerodynamicWaves",
    "BladedDisk",
    "Coupling",
    "InfluenceCoefficients",
    "Interface",
    "MistunedDisk",
    "ModalForces",
    "NodalDiameters",
    "Ring",
    "aerodynamic_waves",
    "cyclic_sector",
    "frequency_pattern",
    "mistuning_pattern",
]

checked_names(globals(), __all__)

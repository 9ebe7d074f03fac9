"""The problem in the user's words: structure, contacts, forces."""

from stickslip.calls import checked_names
from stickslip.model.configurations import (
    SlipConfigurations,
    natural_frequencies,
    slip_configurations,
)
from stickslip.model.contact import Contact
from stickslip.model.contact_law import ContactLaw, Tangents
from stickslip.model.coulomb import Coulomb
from stickslip.model.damping import ModalDamping, Rayleigh
from stickslip.model.force import Force
from stickslip.model.jenkins import Jenkins, ParallelJenkins
from stickslip.model.microslip import BoucWen, Iwan, Masing
from stickslip.model.model import ContactRef, Model, PointRef
from stickslip.model.springs import Cubic, Stop
from stickslip.model.structural import StructuralDamper
from stickslip.model.structure import Structure, join

__all__ = [
    "BoucWen",
    "Contact",
    "ContactLaw",
    "ContactRef",
    "Coulomb",
    "Cubic",
    "Force",
    "Iwan",
    "Jenkins",
    "Masing",
    "ModalDamping",
    "Model",
    "ParallelJenkins",
    "PointRef",
    "Rayleigh",
    "SlipConfigurations",
    "Stop",
    "StructuralDamper",
    "Structure",
    "Tangents",
    "join",
    "natural_frequencies",
    "slip_configurations",
]

checked_names(globals(), __all__)

"""The problem in the user's words: structure, contacts, forces."""

from stickslip.model.contact import LAWS, Contact, Jenkins, contact_from_spec
from stickslip.model.force import Force, force_from_spec
from stickslip.model.model import ContactRef, Model, PointRef, natural_frequencies
from stickslip.model.structure import ModalDamping, Rayleigh, Structure, join

__all__ = [
    "LAWS",
    "Contact",
    "ContactRef",
    "Force",
    "Jenkins",
    "ModalDamping",
    "Model",
    "PointRef",
    "Rayleigh",
    "Structure",
    "contact_from_spec",
    "force_from_spec",
    "join",
    "natural_frequencies",
]

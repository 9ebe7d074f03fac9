"""Dampers as bodies: rigid or elastic, between blades, platforms and disks."""

from stickslip.calls import checked_names
from stickslip.damper.body import Centrifugal, ContactPoint, FlexibleBody, RigidBody
from stickslip.damper.damper import BodyDamper, Damper, Face
from stickslip.damper.ready import CylinderDamper, SplitDamper, StripDamper, WedgeDamper

__all__ = [
    "BodyDamper",
    "Centrifugal",
    "ContactPoint",
    "CylinderDamper",
    "Damper",
    "Face",
    "FlexibleBody",
    "RigidBody",
    "SplitDamper",
    "StripDamper",
    "WedgeDamper",
]

checked_names(globals(), __all__)

"""Reference systems with published results, for tests, examples and comparisons.

Sources: J. Guillen, "Studies of the dynamics of dry-friction-damped blade assemblies" (University
of Michigan, 1999); M. Scheel, T. Weigele and M. Krack, "Challenging an experimental nonlinear modal
analysis method with a new strongly friction-damped structure", J. Sound Vib. 485 (2020) 115580; D.
Laxalde, F. Thouverez, J.-J. Sinou and J.-P. Lombard, "Qualitative analysis of forced response of
blisks with friction ring dampers", Eur. J. Mech. A/Solids 26 (2007) 676-687.
"""

from stickslip.calls import checked_names
from stickslip.reference.beams import (
    DAMPER_SLIP_FORCE,
    DAMPER_STIFFNESS,
    SNECMA_LOADS,
    beam_pair,
    damped_pair,
    flutter_beam,
    flutter_mass,
    negative_damping,
    single_dof,
    snecma_beam,
    snecma_structure,
)
from stickslip.reference.disks import RING_COUPLINGS, beam_ring, laxalde_blisk
from stickslip.reference.elements import (
    BLADE_DAMPER_STIFFNESS,
    BLADE_SLIP_FORCE,
    rubber_beam,
    turbine_blade,
)

__all__ = [
    "BLADE_DAMPER_STIFFNESS",
    "BLADE_SLIP_FORCE",
    "DAMPER_SLIP_FORCE",
    "DAMPER_STIFFNESS",
    "RING_COUPLINGS",
    "SNECMA_LOADS",
    "beam_pair",
    "beam_ring",
    "damped_pair",
    "flutter_beam",
    "flutter_mass",
    "laxalde_blisk",
    "negative_damping",
    "rubber_beam",
    "single_dof",
    "snecma_beam",
    "snecma_structure",
    "turbine_blade",
]

checked_names(globals(), __all__)

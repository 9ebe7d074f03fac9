"""What the dissertation numbers besides tables and figures of results, and where it is here."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["NUMBERED"]

NUMBERED: Mapping[str, tuple[str, str]] = {
    "Fig. 2.1": ("sketch of one mass with a damper", "stickslip.reference.single_dof"),
    "Fig. 2.2": ("hysteresis of the damper", "stickslip.Jenkins"),
    "Fig. 2.7": ("sketch of the beam", "stickslip.reference.snecma_beam"),
    "Fig. 3.1": ("sketch of a damper between two degrees of freedom", "stickslip.Jenkins"),
    "Fig. 4.9": ("the blade, which is proprietary", "stickslip.reference.turbine_blade"),
    "Fig. 4.14": ("photograph of shrouds", "none"),
    "Fig. 4.15": ("sketch of the ring", "stickslip.reference.beam_ring"),
    "Fig. 6.1": ("sketch of the elementary damper", "stickslip.Jenkins"),
    "Fig. 6.2": ("sketch of a structure-like damper", "stickslip.StructuralDamper"),
    "Fig. 6.3": ("sketch of the pair of beams", "stickslip.reference.damped_pair"),
    "Table 2.1": ("improved damper displacement", "claim improved-damper"),
    "Table 2.2": ("parameters of one mass", "stickslip.reference.single_dof"),
    "Table 3.1": ("update of the force; false as printed", "claim never-unloads"),
    "Table 5.1": ("parameters of one mass", "stickslip.reference.flutter_mass"),
    "Table 6.1": ("update of the force, as Table 3.1", "claim never-unloads"),
    "Table 6.2": ("the same by increments; a return map here", "claim overshooting"),
    "Table 6.3": ("slip forces of the structure-like damper", "stickslip.reference.damped_pair"),
    "Procedure 1": ("hybrid frequency/time method", "claim hybrid-method"),
    "Procedure 2": ("time-marching step", "claim overshooting"),
    "Property 1": ("force at the largest displacement", "claim property-1"),
    "Property 2": ("sum of the forces", "claim property-2"),
}
"""Subject and place by heading: a function or class, or a claim."""

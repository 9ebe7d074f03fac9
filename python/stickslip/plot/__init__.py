"""Plots of results on Matplotlib axes."""

from stickslip.calls import checked_names
from stickslip.plot.basins import basins, lines
from stickslip.plot.blades import blade_bars, blade_curves
from stickslip.plot.bodies import damper_drawing
from stickslip.plot.contacts import contact_forces, events, hysteresis, static_forces, waveform
from stickslip.plot.curves import curves, slip
from stickslip.plot.cycles import cycle_multipliers, limit_cycles, multipliers, stability_map
from stickslip.plot.damper import damper, design_map
from stickslip.plot.diameters import (
    aerodynamic,
    aerodynamic_limits,
    flutter_map,
    nodal_diameters,
    safe,
)
from stickslip.plot.fit import fit, fit_backbone, fit_intervals, fit_residuals
from stickslip.plot.interface import contact_map
from stickslip.plot.mistuning import amplification, distribution
from stickslip.plot.modes import backbone, mode_damping
from stickslip.plot.speeds import campbell, speed_response
from stickslip.plot.transients import contact_history, history, phase, poincare, spectrum
from stickslip.plot.uncertainty import backbone_band, sobol_indices, uncertainty_distribution

__all__ = [
    "aerodynamic",
    "aerodynamic_limits",
    "amplification",
    "backbone",
    "backbone_band",
    "basins",
    "blade_bars",
    "blade_curves",
    "campbell",
    "contact_forces",
    "contact_history",
    "contact_map",
    "curves",
    "cycle_multipliers",
    "damper",
    "damper_drawing",
    "design_map",
    "distribution",
    "events",
    "fit",
    "fit_backbone",
    "fit_intervals",
    "fit_residuals",
    "flutter_map",
    "history",
    "hysteresis",
    "limit_cycles",
    "lines",
    "mode_damping",
    "multipliers",
    "nodal_diameters",
    "phase",
    "poincare",
    "safe",
    "slip",
    "sobol_indices",
    "spectrum",
    "speed_response",
    "stability_map",
    "static_forces",
    "uncertainty_distribution",
    "waveform",
]

checked_names(globals(), __all__)

"""Plots of results on Matplotlib axes."""

from stickslip.plot.blades import BladeBarOptions, BladeCurveOptions, blade_bars, blade_curves
from stickslip.plot.charts import (
    CurveOptions,
    Frame,
    LoopOptions,
    curves,
    hysteresis,
    slip,
    waveform,
)
from stickslip.plot.contacts import contact_forces
from stickslip.plot.damper import DamperOptions, damper
from stickslip.plot.diameters import DiameterOptions, SafeOptions, nodal_diameters, safe
from stickslip.plot.orbits import MultiplierOptions, events, multipliers
from stickslip.plot.transients import (
    HistoryOptions,
    PoincareOptions,
    SpectrumOptions,
    contact_history,
    history,
    phase,
    poincare,
    spectrum,
)

__all__ = [
    "BladeBarOptions",
    "BladeCurveOptions",
    "CurveOptions",
    "DamperOptions",
    "DiameterOptions",
    "Frame",
    "HistoryOptions",
    "LoopOptions",
    "MultiplierOptions",
    "PoincareOptions",
    "SafeOptions",
    "SpectrumOptions",
    "blade_bars",
    "blade_curves",
    "contact_forces",
    "contact_history",
    "curves",
    "damper",
    "events",
    "history",
    "hysteresis",
    "multipliers",
    "nodal_diameters",
    "phase",
    "poincare",
    "safe",
    "slip",
    "spectrum",
    "waveform",
]

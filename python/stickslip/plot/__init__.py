"""Plots of results on Matplotlib axes."""

from stickslip.calls import checked_names
from stickslip.plot.basins import BasinOptions, LineOptions, basins, lines
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
from stickslip.plot.cycles import CycleOptions, cycle_multipliers, limit_cycles
from stickslip.plot.damper import DamperOptions, damper
from stickslip.plot.diameters import DiameterOptions, SafeOptions, nodal_diameters, safe
from stickslip.plot.mistuning import (
    DistributionOptions,
    TrendOptions,
    amplification,
    distribution,
)
from stickslip.plot.orbits import MultiplierOptions, events, multipliers
from stickslip.plot.stability_map import stability_map
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
from stickslip.plot.waves import WaveOptions, aerodynamic

__all__ = [
    "BasinOptions",
    "BladeBarOptions",
    "BladeCurveOptions",
    "CurveOptions",
    "CycleOptions",
    "DamperOptions",
    "DiameterOptions",
    "DistributionOptions",
    "Frame",
    "HistoryOptions",
    "LineOptions",
    "LoopOptions",
    "MultiplierOptions",
    "PoincareOptions",
    "SafeOptions",
    "SpectrumOptions",
    "TrendOptions",
    "WaveOptions",
    "aerodynamic",
    "amplification",
    "basins",
    "blade_bars",
    "blade_curves",
    "contact_forces",
    "contact_history",
    "curves",
    "cycle_multipliers",
    "damper",
    "distribution",
    "events",
    "history",
    "hysteresis",
    "limit_cycles",
    "lines",
    "multipliers",
    "nodal_diameters",
    "phase",
    "poincare",
    "safe",
    "slip",
    "spectrum",
    "stability_map",
    "waveform",
]

checked_names(globals(), __all__)

"""Plots of results on Matplotlib axes."""

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
from stickslip.plot.damper import DamperOptions, damper
from stickslip.plot.diameters import DiameterOptions, SafeOptions, nodal_diameters, safe
from stickslip.plot.mistuning import (
    DistributionOptions,
    TrendOptions,
    amplification,
    distribution,
)
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
from stickslip.plot.waves import WaveOptions, aerodynamic

__all__ = [
    "BasinOptions",
    "BladeBarOptions",
    "BladeCurveOptions",
    "CurveOptions",
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
    "contact_history",
    "curves",
    "damper",
    "distribution",
    "events",
    "history",
    "hysteresis",
    "lines",
    "multipliers",
    "nodal_diameters",
    "phase",
    "poincare",
    "safe",
    "slip",
    "spectrum",
    "waveform",
]

"""Plots of results on Matplotlib axes."""

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
    "CurveOptions",
    "DamperOptions",
    "Frame",
    "HistoryOptions",
    "LoopOptions",
    "MultiplierOptions",
    "PoincareOptions",
    "SpectrumOptions",
    "contact_history",
    "curves",
    "damper",
    "events",
    "history",
    "hysteresis",
    "multipliers",
    "phase",
    "poincare",
    "slip",
    "spectrum",
    "waveform",
]

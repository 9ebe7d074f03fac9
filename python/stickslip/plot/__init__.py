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

__all__ = ["CurveOptions", "Frame", "LoopOptions", "curves", "hysteresis", "slip", "waveform"]

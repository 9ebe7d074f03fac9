"""What tests have measured of a structure: response curves, peaks, hysteresis loops, backbones."""

from stickslip.model.measurement.backbone import MeasuredBackbone
from stickslip.model.measurement.curve import MeasuredLoop, MeasuredPeak, Measurement
from stickslip.model.measurement.measured import Measured

__all__ = ["Measured", "MeasuredBackbone", "MeasuredLoop", "MeasuredPeak", "Measurement"]

"""What tests have measured of a structure: response curves, peaks, hysteresis loops, backbones."""

from stickslip.model.measurement.backbone import MeasuredBackbone
from stickslip.model.measurement.curve import Measurement
from stickslip.model.measurement.loop import MeasuredLoop
from stickslip.model.measurement.measured import Measured
from stickslip.model.measurement.peak import MeasuredPeak

__all__ = ["Measured", "MeasuredBackbone", "MeasuredLoop", "MeasuredPeak", "Measurement"]

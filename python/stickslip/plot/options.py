"""Keywords of the drawing functions, as methods of results pass them on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, TypedDict

from stickslip.plot.style import LengthUnit, OmegaUnit
from stickslip.results.arrays import Measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip.results import ForcedResponse


class WaveOptions(TypedDict, total=False):
    """Keywords of `aerodynamic`."""

    ax: Axes | None


class Frame(WaveOptions, total=False):
    """Where, and in which unit, a displacement is drawn."""

    length_unit: LengthUnit


BasinOptions = Frame


class _Frequency(WaveOptions, total=False):
    omega_unit: OmegaUnit


class _Amplitude(Frame, total=False):
    measure: Measure


class _Labelled(Frame, _Frequency, total=False):
    labels: Sequence[str] | None


class LoopOptions(Frame, total=False):
    """Keywords of `hysteresis`."""

    samples: int


class CurveOptions(_Labelled, _Amplitude, total=False):
    """Keywords of `curves`."""

    normalise: Literal["force"] | None
    log: bool
    stuck: bool
    free: bool
    peaks: bool
    error_band: bool | None


class DamperOptions(_Labelled, total=False):
    """Keywords of `damper`."""

    normalise: Literal["force"] | None
    frequency: bool
    limits: bool
    optimum: bool


class CycleOptions(_Labelled, _Amplitude, total=False):
    """Keywords of `limit_cycles`."""

    frequency: bool


class MultiplierOptions(_Frequency, total=False):
    """Keywords of `multipliers`."""

    index: int | Sequence[int] | None


class BladeBarOptions(_Amplitude, total=False):
    """Keywords of `blade_bars`."""

    index: int | None
    tuned: ForcedResponse | None


class BladeCurveOptions(_Amplitude, _Frequency, total=False):
    """Keywords of `blade_curves`."""

    tuned: ForcedResponse | None
    log: bool


class DiameterOptions(_Frequency, total=False):
    """Keywords of `nodal_diameters`."""

    slipping: bool


class SafeOptions(DiameterOptions, total=False):
    """Keywords of `safe`."""

    orders: int | Sequence[int] | None


class HistoryOptions(Frame, total=False):
    """Keywords of `history` and `phase`."""

    last: int | None


class PoincareOptions(Frame, total=False):
    """Keywords of `poincare`."""

    skip: int


class SpectrumOptions(_Frequency, total=False):
    """Keywords of `spectrum`."""

    last: int | None
    segment: int | None
    window: str


class LineOptions(_Frequency, total=False):
    """Keywords of `lines`."""

    most: int


class TrendOptions(WaveOptions, total=False):
    """Keywords of `amplification`."""

    percentile: float
    confidence: float


class DistributionOptions(WaveOptions, total=False):
    """Keywords of `distribution`."""

    deviation: float | None
    coupling: float | None
    percentile: float | None
    confidence: float

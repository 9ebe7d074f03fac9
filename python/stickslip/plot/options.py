"""Keywords of the functions that draw, each once: type, default and meaning.

`figure` of `figure.py` makes signatures and documentation of them; results pass them on.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, TypedDict

from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from stickslip.plot.style import LengthUnit, OmegaUnit
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Measure
from stickslip.results.campbell import Campbell
from stickslip.results.contact_map import MapField


class Drawing(TypedDict, total=False):
    """Keywords of all figures."""

    ax: Annotated[Axes | None, None, "Where to draw. Default: a new figure."]


class Frame(Drawing, total=False):
    """Keywords of figures of displacements."""

    length_unit: Annotated[
        LengthUnit, "auto", "Unit of displacements. Default: m with a prefix that suits the data."
    ]


class Swept(Drawing, total=False):
    """Keywords of figures over frequency."""

    omega_unit: Annotated[OmegaUnit, "rad/s", "Unit of frequencies."]


class Spectral(Drawing, total=False):
    """Keywords of figures over frequency in Hz."""

    omega_unit: Annotated[OmegaUnit, "Hz", "Unit of frequencies."]


class Amplitude(Frame, total=False):
    """Keywords of figures of amplitudes."""

    measure: Annotated[Measure, "half_range", "Measure of the amplitude."]


class Several(Frame, Swept, total=False):
    """Keywords of figures of several results."""

    labels: Annotated[Sequence[str] | None, None, "One per result. Default: what tells them apart."]


class LoopOptions(Frame, Swept, total=False):
    """Keywords of figures of one period."""

    samples: Annotated[int, 512, "Instants per period."]


class HysteresisOptions(LoopOptions, total=False):
    """Keywords of `hysteresis`."""

    plane: Annotated[
        bool,
        False,
        "Draw instead the traction in the plane of sliding, t2 against t1, inside the circles of "
        "the least and the largest friction limit.",
    ]


class ForceOptions(TypedDict, total=False):
    """Keywords of `contact_forces`."""

    omega_unit: Annotated[OmegaUnit, "rad/s", "Unit of frequencies."]
    stuck: Annotated[bool, True, "Draw, dashed, the forces if no contact of the model slipped."]
    samples: Annotated[int, 1024, "Instants per period."]


class CurveOptions(Several, Amplitude, total=False):
    """Keywords of `curves`."""

    normalise: Annotated[
        Literal["force"] | None, None, "Divide every curve by its largest force amplitude."
    ]
    log: Annotated[
        bool,
        True,
        "Logarithmic amplitude axis. A linear one ends above the curves and cuts the limits.",
    ]
    stuck: Annotated[
        bool,
        True,
        "Draw the linear response with every contact stuck. Unless normalised, it is that to the "
        "largest force among the results.",
    ]
    free: Annotated[bool, True, "Draw the same without any contact."]
    peaks: Annotated[bool, True, "Mark the refined peaks."]
    error_band: Annotated[
        bool | None,
        None,
        "Shade what the discarded harmonics could still change. Default: for a single curve.",
    ]


class FitOptions(Frame, Swept, total=False):
    """Keywords of `fit`."""

    log: Annotated[bool, True, "Logarithmic amplitude axis."]


class FitBackboneOptions(Frame, Swept, total=False):
    """Keywords of `fit_backbone`."""

    damping: Annotated[
        bool | None,
        None,
        "Draw damping ratios instead of frequencies. Default: if no frequencies were measured.",
    ]


class DamperOptions(Several, total=False):
    """Keywords of `damper`."""

    normalise: Annotated[
        Literal["force"] | None,
        None,
        "Divide amplitudes by the largest force, and show curves over the level against the force "
        "over the slip force, P/F_d. Without it curves over the level rise with the force.",
    ]
    frequency: Annotated[bool, True, "Draw the frequency of the peak too, dashed, at the right."]
    limits: Annotated[
        bool,
        True,
        "Draw the peaks of the two linear limits: all contacts free, and all stuck unless the "
        "stiffness was varied.",
    ]
    optimum: Annotated[bool, True, "Mark the lowest computed peak."]


class CycleOptions(Several, Amplitude, total=False):
    """Keywords of `limit_cycles`."""

    frequency: Annotated[bool, True, "Draw the frequency too, on axes below those of a new figure."]


class SpeedOptions(Frame, total=False):
    """Keywords of `speed_response`."""

    omega_unit: Annotated[OmegaUnit, "rpm", "Unit of the speed of the rotor."]
    labels: Annotated[Sequence[str] | None, None, "One per result. Default: the engine orders."]
    log: Annotated[bool, True, "Logarithmic amplitude axis."]
    diagram: Annotated[
        Campbell | None,
        None,
        "What `campbell` returned of the same orders: lines at the speeds of its resonances.",
    ]


class DampingOptions(Drawing, total=False):
    """Keywords of `mode_damping`."""

    labels: Annotated[Sequence[str] | None, None, "One per result. Default: the modes."]


class BackboneOptions(DampingOptions, Swept, total=False):
    """Keywords of `backbone`."""

    damping: Annotated[bool, True, "Draw the damping ratio too, below on a new figure."]
    shapes: Annotated[
        bool, True, "Show the shape at three amplitudes, of up to 30 degrees of freedom."
    ]


class MultiplierOptions(Swept, total=False):
    """Keywords of `multipliers`."""

    index: Annotated[int | Sequence[int] | None, None, "Points of the sweep. Default: all."]


class BladeBarOptions(Amplitude, Swept, total=False):
    """Keywords of `blade_bars`."""

    index: Annotated[
        int | None,
        None,
        "Position of a point of the sweep. Default: the largest amplitude of each blade among the "
        "computed points.",
    ]
    tuned: Annotated[
        ForcedResponse | None,
        None,
        "The response of the tuned disk, drawn as a line: its peak, or its amplitude at the "
        "computed frequency nearest to that of `index`.",
    ]


class BladeCurveOptions(Amplitude, Swept, total=False):
    """Keywords of `blade_curves`."""

    tuned: Annotated[ForcedResponse | None, None, "That of the tuned disk, drawn beside them."]
    log: Annotated[bool, True, "Logarithmic amplitude axis."]


class LimitOptions(Frame, total=False):
    """Keywords of `aerodynamic_limits`."""

    aerodynamic_ratio: Annotated[
        ArrayLike | None, None, "Damping ratios of the flow. Default: as far as friction holds."
    ]


class DiameterOptions(Spectral, total=False):
    """Keywords of `nodal_diameters` and `campbell`."""

    slipping: Annotated[bool, True, "Draw the frequencies with slipping contacts too."]


class SafeOptions(DiameterOptions, total=False):
    """Keywords of `safe`."""

    orders: Annotated[
        int | Sequence[int] | None,
        None,
        "Engine orders to mark, or up to which. Default: the engine order of the disk and the "
        "harmonics of it that its forces have.",
    ]
    modes: Annotated[
        int | None,
        None,
        "How many modes to draw, from the lowest. Default: those near the marked orders.",
    ]


class LastOptions(Drawing, total=False):
    """Keywords of figures of the last periods."""

    last: Annotated[int | None, None, "Draw this many periods, the last. Default: all kept."]


class ContactHistoryOptions(Swept, LastOptions, total=False):
    """Keywords of `contact_history`."""


class HistoryOptions(Frame, ContactHistoryOptions, total=False):
    """Keywords of `history`."""


class PhaseOptions(Frame, LastOptions, total=False):
    """Keywords of `phase`."""


class PoincareOptions(Frame, total=False):
    """Keywords of `poincare`."""

    skip: Annotated[int, 0, "How many of the first periods to leave out."]


class SpectrumOptions(Spectral, LastOptions, total=False):
    """Keywords of `spectrum`."""

    segment: Annotated[int | None, None, "As of `Transient.spectrum`."]
    window: Annotated[str, "boxcar", "As of `Transient.spectrum`."]


class LineOptions(Spectral, total=False):
    """Keywords of `lines`."""

    most: Annotated[int, 8, "How many lines to mark at most."]


class Confidence(Drawing, total=False):
    """Keywords of figures of statistics."""

    confidence: Annotated[float, 0.95, "Probability that the interval holds the percentile."]


class TrendOptions(Confidence, total=False):
    """Keywords of `amplification`."""

    percentile: Annotated[float, 99.0, "The percentile."]


class DistributionOptions(Confidence, total=False):
    """Keywords of `distribution`."""

    deviation: Annotated[float | None, None, "See `MistuningStudy.factors`."]
    coupling: Annotated[float | None, None, "See `MistuningStudy.factors`."]
    percentile: Annotated[float | None, 99.9, "That of the fit that is marked, with its interval."]


class PercentileOptions(Confidence, total=False):
    """Keywords of `uncertainty_distribution`."""

    percentiles: Annotated[Sequence[float], (5.0, 50.0, 95.0), "Percentiles that are marked."]


class ShareOptions(Drawing, total=False):
    """Keywords of `sobol_indices`."""

    confidence: Annotated[float, 0.95, "Probability that an interval holds the share."]


class BandOptions(Spectral, total=False):
    """Keywords of `backbone_band`."""

    band: Annotated[tuple[float, float], (5.0, 95.0), "Percentiles at the sides of the band."]
    damping: Annotated[bool, False, "Draw the damping ratio instead of the frequency."]


class ContactMapOptions(Drawing, total=False):
    """Keywords of `contact_map`."""

    field: Annotated[MapField, "pressure", "What is drawn: a field of the map."]

"""Power spectral density of a sampled motion, over windows of whole periods."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.checks import constant
from stickslip.results.fields import Float


class Spectrum(NamedTuple):
    """One-sided power spectral density."""

    frequency: Float
    """(m,) From 0 to half the sampling rate [Hz]."""
    density: Float
    """(m,) [m^2/Hz]. Its integral is the mean square of the motion about its mean."""


def spectrum_of(motion: Float, *, samples: int, rate: float, segment: int, window: str) -> Spectrum:
    """Return the spectrum of whole periods of a motion by Welch's method.

    `samples` are taken per period, `rate` per second. The windows have `segment` periods each,
    overlap by half, in whole periods, and are averaged.

    References
    ----------
    P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE
    Trans. Audio Electroacoust. 15 (1967) 70-73.
    """
    from scipy.signal import welch

    frequency, density = welch(
        motion,
        fs=rate,
        window=window,
        nperseg=segment * samples,
        noverlap=(segment // 2) * samples,
        detrend="constant",
        scaling="density",
    )
    return Spectrum(constant(frequency), constant(density))

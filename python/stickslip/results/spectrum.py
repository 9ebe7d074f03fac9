"""Power spectral density of a sampled motion, over windows of whole periods."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.results.arrays import Float, constant

__all__ = ["Spectrum", "spectrum_of"]


class Spectrum(NamedTuple):
    """One-sided power spectral density."""

    frequency: Float
    """(m,) From 0 to half the sampling rate [Hz]."""
    density: Float
    """(m,) [m^2/Hz]. Its integral is the mean square of the motion about its mean."""


def spectrum_of(motion: Float, *, samples: int, rate: float, segment: int, window: str) -> Spectrum:
    """Return the spectrum of a motion by Welch's method.

    Parameters
    ----------
    motion : ndarray of float64, shape (periods * samples,)
        Whole periods [m].
    samples : int
        Instants per period.
    rate : float
        Instants per second.
    segment : int
        Periods per window; windows overlap by half, in whole periods, and are averaged.
    window : str
        Name of the window, as `scipy.signal.get_window` has it.

    Returns
    -------
    Spectrum
        In steps of the excitation frequency over `segment`.

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

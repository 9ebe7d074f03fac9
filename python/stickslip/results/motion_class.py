"""What becomes of one free motion."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from stickslip.checks import real_number, whole_number
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model.state import State
from stickslip.results.fate_arrays import FateArrays, Motion, Reason
from stickslip.results.fields import Float, Shown, column
from stickslip.results.result import Attributes, ColumnResult
from stickslip.results.spectrum import Spectrum, spectrum_of
from stickslip.settings.motion import ClassifySettings

SEGMENTS = 8
"""Windows over which a spectrum is averaged, so that what is noise in one is level in the mean."""


class Line(NamedTuple):
    """One line of a spectrum."""

    frequency: float
    """[Hz]"""
    omega: float
    """Angular frequency [rad/s]."""
    amplitude: float
    """Amplitude of a harmonic motion of the same power [m]."""


class MotionArrays(FateArrays):
    """The numbers of one free motion."""

    tail: Float = column(
        "time dof",
        "m",
        "displacement once the motion was decided; none of one that decays, is unbounded or was "
        "interrupted",
    )


class MotionClass(ColumnResult):
    """What becomes of a free motion from one start.

    Attributes
    ----------
    step : float
        Time between the instants of `tail` [s].
    """

    kind: ClassVar[str] = "motion_class"
    title = "What becomes of a free motion with dry friction"
    headline = "amplitude"
    attributes: ClassVar[Attributes] = {"interrupted": bool, "step": float}

    settings: ClassifySettings
    arrays: MotionArrays
    step: float

    tail = Shown[Float]()

    plot = Drawn("lines")

    def __repr__(self) -> str:
        where = "" if self.mode is None else f" on mode {self.mode}"
        about = f" at {self.omega:.6g} rad/s" if self.motion == Motion.SETTLED else ""
        return f"MotionClass({self.motion}{where}{about}, decided after {self.time:.3g} s)"

    @property
    def motion(self) -> Motion:
        """What becomes of it: decaying, settled, aperiodic, unbounded or undecided."""
        return self.reason.motion

    @property
    def reason(self) -> Reason:
        """Why; ``reason.advice`` says what to do about it."""
        return Reason.from_code(int(self.arrays.reason[0]))

    @property
    def mode(self) -> int | None:
        """Stuck mode, counted from 0, with the most kinetic energy at the end.

        None of a motion that decays or is not bounded.
        """
        mode = int(self.arrays.mode[0])
        return None if mode < 0 else mode

    @property
    def share(self) -> float:
        """Share of the kinetic energy of that mode."""
        return float(self.arrays.share[0])

    @property
    def omega(self) -> float:
        """Angular frequency of a settled motion [rad/s]; not-a-number of others."""
        return float(self.arrays.omega[0])

    @property
    def time(self) -> float:
        """How long a motion it took to decide [s]."""
        return float(self.arrays.time[0])

    @cached_property
    def start(self) -> State:
        """The state at the start."""
        return State.of_vector(self.model, self.arrays.start[0])

    @cached_property
    def final(self) -> State:
        """The state once it was decided; ``classify(model, result.final)`` goes on.

        Raises ModelError if the motion has overflowed, and has no finite state.
        """
        return State.of_vector(self.model, self.arrays.final[0])

    def amplitude(self, dof: str) -> float:
        """Return half the range of a displacement at the end.

        [m]; of a settled motion over a period, not-a-number if it is unbounded.
        """
        return float(self.arrays.amplitude[0, self._column(dof)])

    def spectrum(self, dof: str) -> Spectrum:
        """Return the power spectral density of a displacement once it was decided.

        By Welch's method in Hann windows, which hold the leakage of a motion without period down.

        `frequency` [Hz] and `density` [m^2/Hz].

        Raises ModelError if there is no such motion.
        """
        column = self._column(dof)
        if not len(self.tail):
            raise ModelError(f"spectrum: the motion is {self.motion}; it has no spectrum")
        window = len(self.tail) * 2 // (SEGMENTS + 1)
        window -= window % 2
        return spectrum_of(
            self.tail[:, column],
            samples=2,
            rate=1.0 / self.step,
            segment=window // 2,
            window="hann",
        )

    def lines(self, dof: str, most: int = 8, least: float = 1e-3) -> list[Line]:
        """Return the lines of the spectrum of a displacement, the strongest first.

        A line is a peak of the density that stands out tenfold from what is around it; its power
        is that of the main lobe of the window, four steps of frequency to either side.

        Frequencies interpolated between the steps of the spectrum.

        Raises ModelError as `spectrum`; if a number is outside its range.

        Parameters
        ----------
        most : int, optional
            How many at most.
        least : float, optional
            Least amplitude relative to the strongest.
        """
        from scipy.signal import find_peaks

        count = whole_number(most, "most", smallest=1)
        floor = real_number(least, "least")
        frequency, density = self.spectrum(dof)
        if not density.max() > 0.0:
            return []
        level = np.log10(np.maximum(density, 1e-30 * density.max()))
        peaks, _ = find_peaks(level, prominence=1.0)
        step = frequency[1]
        lines = []
        for place in peaks:
            low, mid, high = level[place - 1 : place + 2]
            bend = low - 2.0 * mid + high
            shift = 0.5 * (low - high) / bend if bend < 0.0 else 0.0
            power = step * density[max(place - 4, 0) : place + 5].sum()
            where = float(frequency[place] + shift * step)
            lines.append(Line(where, 2.0 * np.pi * where, float(np.sqrt(2.0 * power))))
        lines.sort(key=lambda line: line.amplitude, reverse=True)
        return [line for line in lines[:count] if line.amplitude >= floor * lines[0].amplitude]

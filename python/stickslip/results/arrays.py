"""The numbers of a result, and the measures taken of harmonic series."""

from __future__ import annotations

import json
from functools import cached_property
from typing import Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.checks import constant, whole_number
from stickslip.results.dataset import Stored
from stickslip.results.fields import Bool, Code, Columns, Complex, Computed, Float, Int, column
from stickslip.results.status import Status

Measure: TypeAlias = Literal["half_range", "max", "fundamental"]
"""Half the peak-to-peak range over a period, the largest |x|, or |X_1|."""

STABILITY = ("unstable", "stable", "not decided")
"""What is known of the stability of a motion."""

UNIQUE = ("yes", "no", "shakedown", "not asked", "not found", "not decided")
"""Whether a vibration depends on the tractions that the past has left in contacts."""

SHARE = 1.0 + 1e-6
"""Largest share of a period: sums of times are rounded."""


def _samples(dataset: Stored) -> Int:
    """Return the samples that the first files name in their settings, unless they were chosen."""
    settings = json.loads(dataset.attrs["settings"])
    samples = settings["samples"] if settings.get("evaluation") == "marched" else 0
    if samples is None:
        raise KeyError("samples")
    return np.full(dataset.sizes["omega"], samples, np.int64)


class PeriodicArrays(Columns):
    """The numbers of periodic motions, along a curve or a branch.

    Coefficients are padded with zeros above the harmonics of their own point.
    """

    omega: Float = column("*", "rad/s", "angular frequency of the motion", least=0.0)
    harmonics: Int = column(
        "*",
        "1",
        "highest harmonic kept, or reported of exact orbits",
        least=0,
        file_name="harmonics_kept",
    )
    status: Code = column("*", "1", "how the point ended", codes=Status)
    displacement: Complex = column(
        "* harmonic dof",
        "m",
        "harmonics of the displacement, x(t) = Re sum_k X_k exp(i k omega t)",
    )
    contact_displacement: Complex = column(
        "* harmonic point", "m", "harmonics of the relative displacement at the contacts"
    )
    contact_force: Complex = column(
        "* harmonic point", "N", "harmonics of the contact force against the relative displacement"
    )
    error_estimate: Float = column(
        "* dof",
        "m",
        "what the discarded harmonics, and more samples, could still change",
        least=0.0,
    )
    slip_fraction: Float = column(
        "* point",
        "1",
        "share of the period that the contact point slips; of its component N, that it is open",
        least=0.0,
        most=SHARE,
    )
    dissipation: Float = column("* point", "J", "work lost to friction per cycle")


class ExactColumns(Columns):
    """What exact orbits have beside; a state is (x, v, f) of all dofs and contact points."""

    range: Float = column("* dof side", "m", "lowest and highest displacement of exact orbits")
    state: Float = column(
        "* state_entry", "1", "state at t = 0 of exact orbits (x in m, v in m/s, f in N)"
    )
    multipliers: Complex = column(
        "* multiplier",
        "1",
        "Floquet multipliers over the period, the neutral ones first, then by falling modulus; of "
        "limit cycles without that of the phase",
    )
    neutral: Int = column("*", "1", "how many multipliers are neutral, exactly 1", least=0)

    @cached_property
    def known(self) -> Bool:
        """(n,) Whether the multipliers are known: not those of travelling waves."""
        known = np.isfinite(self.multipliers).all(axis=1) & (self.multipliers.shape[1] > 0)
        return constant(known)


class Arrays(PeriodicArrays):
    """The numbers of a forced response.

    At points without any solution coefficients are not-a-number; at points that stalled they are
    the last iterate, and `error_estimate`, `sampling_error`, `slip_fraction` and `dissipation`
    not-a-number.
    """

    along = "omega"

    omega: Float = column("*", "rad/s", "angular frequency of the excitation", least=0.0)
    samples: Int = column(
        "*",
        "1",
        "samples per period of marched friction laws, 0 if not marched",
        least=0,
        absent=_samples,
    )
    residual: Float = column("*", "1", "relative residual of the balance equations", least=0.0)
    iterations: Int = column("*", "1", "iterations of the solver", least=0)
    fold: Bool = column(
        "*", "1", "whether the curve turns back in frequency at the point", absent=False
    )
    jump: Bool = column(
        "*", "1", "whether the sweep has come to the point from another branch", absent=False
    )
    further: Bool = column(
        "*", "1", "whether a further branch of the curve begins at the point", absent=False
    )
    stability: Code = column(
        "*", "1", "whether the motion is stable", codes=STABILITY, absent="not decided"
    )
    lower: Float = column(
        "* dof",
        "m",
        "least half range over the residual tractions",
        least=0.0,
        absent=np.nan,
    )
    upper: Float = column(
        "* dof",
        "m",
        "largest half range over the residual tractions",
        least=0.0,
        absent=np.nan,
    )
    unique: Code = column(
        "*",
        "1",
        "whether the vibration is the same for all residual tractions",
        codes=UNIQUE,
        absent="not asked",
    )
    guaranteed: Bool = column(
        "*",
        "1",
        "whether theory excludes half ranges outside of the bounds",
        absent=False,
    )
    sampling_error: Float = column(
        "* dof",
        "m",
        "part of the error estimate that is due to samples of marched friction laws",
        least=0.0,
        absent=np.nan,
    )

    @classmethod
    def of(cls, solution: Computed, **more: NDArray[Any]) -> Self:
        """Take over what the core returns, blanking the numbers that mean nothing."""
        values = {**solution.columns, **more}
        # Where nothing was solved the core keeps no harmonic, and zeros would look like motion.
        missing = values["harmonics"] == 0
        for name in ("displacement", "contact_displacement", "contact_force"):
            series = values[name]
            if series.shape[1] == 1:
                series = np.pad(series, ((0, 0), (0, 1), (0, 0)))
            values[name] = _blanked(series, missing, complex(np.nan, np.nan))
        for name in ("error_estimate", "sampling_error", "slip_fraction", "dissipation"):
            values[name] = _blanked(values[name], ~_solved(values["status"]), np.nan)
        return super().of(solution, **values)

    @cached_property
    def solved(self) -> Bool:
        """(n,) Whether the balance equations hold at the point."""
        return _solved(self.status)


def _blanked(values: NDArray[Any], missing: Bool, blank: complex) -> NDArray[Any]:
    """Blank rows in place; they are, if Ctrl-C met a result that had made its arrays constant."""
    if values.flags.writeable:
        values[missing] = blank
    return values


def period_of(series: Complex, samples: int) -> Float:
    """Return one period of a series from its harmonics 0 to H, shape (samples, ...)."""
    count = whole_number(samples, "samples", smallest=1)
    # Whole turns are dropped before the angle is formed: high harmonics keep all digits.
    turns = np.outer(np.arange(count), np.arange(len(series))) % count
    turn = np.exp(2j * np.pi / count * turns)
    return constant(np.ascontiguousarray((turn @ series).real))


def amplitude_of(coefficients: Complex, measure: Measure) -> Float:
    """Return the amplitudes of harmonic series (n, H+1); not-a-number where a coefficient is."""
    finite = np.isfinite(coefficients).all(axis=1)
    values = np.full(len(coefficients), np.nan)
    if finite.any():
        values[finite] = _core.amplitude(np.ascontiguousarray(coefficients[finite]), measure)
    return values


def amplitude_in(ranges: Float, measure: Measure) -> Float:
    """Return the amplitudes, half ranges or largest |x|, of ranges of shape (n, 2)."""
    low, high = ranges.T
    if measure == "max":
        return constant(np.maximum(np.abs(low), np.abs(high)))
    return constant(0.5 * (high - low))


def mean_forces(series: Complex, stiffness: float, slip_force: float) -> Float:
    """Return the mean forces (n, 2) that a contact point could hold with the same vibration.

    Lower and upper bound [N], 0 where the point slips; `series` are the harmonics (n, H+1) of its
    relative displacement.
    """
    half = amplitude_of(series, "half_range")
    # Lifted above zero the largest |u| is the maximum of u, which gives the mid-range.
    lift = np.abs(series).sum(axis=1)
    lifted = series.copy()
    lifted[:, 0] += lift
    middle = amplitude_of(lifted, "max") - lift - half
    room = slip_force - stiffness * half
    centre = stiffness * (series[:, 0].real - middle)
    bounds = np.stack([centre - room, centre + room], axis=1)
    bounds[room < 0.0] = 0.0
    return bounds


_SOLVED = np.zeros(256, dtype=bool)
"""Whether a status of each code says that the equations hold."""
_SOLVED[[one.code for one in Status if one.solved]] = True


def _solved(status: Code) -> Bool:
    return constant(_SOLVED[status])

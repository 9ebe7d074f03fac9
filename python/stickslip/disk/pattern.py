"""Mistuning patterns: drawn at random, or from measured frequencies."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import choice, real_array, whole_number
from stickslip.errors import ModelError
from stickslip.units import physical_number, without_units

Distribution: TypeAlias = Literal["normal", "uniform"]
DISTRIBUTIONS: tuple[str, ...] = get_args(Distribution)
"""What deviations may be drawn from."""


def mistuning_pattern(
    sectors: int, deviation: float, distribution: Distribution = "normal", *, seed: int = 0
) -> NDArray[np.float64]:
    """Draw deviations of the sectors of a disk, for `BladedDisk.mistuned`.

    Parameters
    ----------
    sectors : int
        Number of sectors.
    deviation : float
        Standard deviation S.
    distribution : {"normal", "uniform"}, optional
        Distribution of zero mean and that deviation; "uniform" reaches to sqrt(3) S.
    seed : int, optional
        Seed of NumPy's default generator: the same seed, the same pattern.

    Raises
    ------
    ModelError
        If a number is outside its range, or there is no such distribution.

    References
    ----------
    Guillen (1999), section 4.5: E_i = (1 + S r_i) E_0.
    """
    count = whole_number(sectors, "sectors", smallest=1)
    size = physical_number(deviation, "", "deviation")
    if size < 0.0:
        raise ModelError(f"deviation: {size:g} is negative; give 0.05 for 5 %")
    return size * _drawn(whole_number(seed, "seed"), count, distribution)


def frequency_pattern(deviations: ArrayLike) -> NDArray[np.float64]:
    """Make deviations of the stiffness of those of blade frequencies, for `BladedDisk.mistuned`.

    Frequencies of blades are measured, and deviate by (f - f0) / f0; stiffness goes with their
    square.

    Parameters
    ----------
    deviations : array_like of float
        Relative deviations of the frequencies of blades, 0.02 or "2 %": of any shape, one disk
        (sectors,), or many (patterns, sectors).

    Returns
    -------
    ndarray of float
        Deviations of the stiffness, (1 + deviation)^2 - 1, of the same shape.

    Raises
    ------
    ModelError
        If a deviation is not finite, or not between -1 and 1.
    """
    return stiffness_of(deviations, "deviations")


def stiffness_of(deviations: ArrayLike, entry: str) -> NDArray[np.float64]:
    """Return the deviations of the stiffness that belong to those of frequencies."""
    given = without_units(deviations, "", entry)
    relative = real_array(given, entry, "(f - f0) / f0, 0.02 for 2 %")
    wrong = np.argwhere(~(np.abs(relative) < 1.0))
    if wrong.size:
        place = "".join(f"[{one}]" for one in wrong[0])
        raise ModelError(
            f"{entry}{place} is {relative[tuple(wrong[0])]:g}; give (f - f0) / f0, 0.02 for 2 %"
        )
    return relative * (2.0 + relative)


def drawn_patterns(
    sectors: int, count: int, distribution: Distribution = "normal", *, seed: int = 0
) -> NDArray[np.float64]:
    """Draw patterns of zero mean and unit standard deviation, shape (count, sectors).

    Mean and deviation are those of the distribution: the 36 numbers of one pattern have others, as
    the blades of one disk do. Pattern i is drawn from ``SeedSequence(seed, spawn_key=(i,))`` of
    NumPy, the same however many there are.
    """
    size = whole_number(sectors, "sectors", smallest=1)
    number = whole_number(count, "patterns", smallest=1)
    entropy = whole_number(seed, "seed")
    seeds = (np.random.SeedSequence(entropy, spawn_key=(i,)) for i in range(number))
    return np.stack([_drawn(one, size, distribution) for one in seeds])


def _drawn(
    seed: int | np.random.SeedSequence, count: int, distribution: str
) -> NDArray[np.float64]:
    """Draw numbers of zero mean and unit deviation."""
    generator = np.random.default_rng(seed)
    if choice(distribution, "distribution", DISTRIBUTIONS) == "normal":
        return generator.standard_normal(count)
    bound = 3.0**0.5
    return generator.uniform(-bound, bound, count)

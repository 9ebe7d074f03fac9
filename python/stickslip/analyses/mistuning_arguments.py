"""Doors that the arguments of a mistuning study pass."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.memory import require_numbers
from stickslip.checks import brief, text, unknown, whole_number
from stickslip.disk.bladed_disk import NEXT, BladedDisk
from stickslip.disk.pattern import Distribution, drawn_patterns
from stickslip.errors import ModelError
from stickslip.results.arrays import Float

__all__ = ["dofs_of", "numbers_of", "patterns_of", "processors", "require_stiff"]


def patterns_of(
    patterns: int | ArrayLike, sectors: int, distribution: Distribution, seed: int
) -> tuple[Float, bool]:
    """Return the patterns, and whether they were drawn."""
    if isinstance(patterns, int | np.integer):
        count = whole_number(patterns, "patterns", smallest=1)
        what = f"patterns: {count} of {sectors} sectors"
        require_numbers(count * sectors, f"{what} each", "give fewer patterns")
        return drawn_patterns(sectors, count, distribution, seed=seed), True
    try:
        given = np.asarray(patterns)
    except ValueError:
        raise ModelError(f"patterns: ragged lists; give ({sectors},) numbers each") from None
    if given.dtype.kind not in "fiu" or given.ndim not in (1, 2) or not given.size:
        raise ModelError(f"patterns: {brief(patterns)}; give their number, or an array of them")
    rows = np.array(np.atleast_2d(given), dtype=np.float64)
    if rows.shape[1] != sectors:
        raise ModelError(
            f"patterns: shape {given.shape} for {sectors} sectors; give (p, {sectors})"
        )
    bad = np.argwhere(~np.isfinite(rows))
    if bad.size:
        place = ", ".join(map(str, bad[0]))
        raise ModelError(f"patterns[{place}] is {rows[tuple(bad[0])]}; give finite numbers")
    return rows, False


def require_stiff(deviations: Float, patterns: Float) -> None:
    """Refuse a blade without stiffness."""
    least, largest = patterns.min(), deviations.max(initial=0.0)
    if largest * least > -1.0:
        return
    pattern, blade = (int(at) for at in np.unravel_index(patterns.argmin(), patterns.shape))
    raise ModelError(
        f"deviation: {largest:g} leaves blade {blade} of pattern {pattern} the stiffness "
        f'{1.0 + largest * least:.3g} K; give a smaller one, or distribution="uniform"'
    )


def numbers_of(values: ArrayLike, entry: str, remedy: str) -> Float:
    """Return one or several finite numbers, none of them negative, each once."""
    try:
        given = np.atleast_1d(np.asarray(values))
    except ValueError:
        raise ModelError(f"{entry}: a ragged list; give {remedy}") from None
    if given.dtype.kind not in "fiu" or given.ndim != 1 or not given.size:
        raise ModelError(f"{entry}: {brief(values)}; give {remedy}, or a list of them")
    numbers = np.array(given, dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(numbers) & (numbers >= 0.0)))
    if bad.size:
        raise ModelError(f"{entry}[{bad[0]}] is {numbers[bad[0]]:g}; give {remedy}, not negative")
    if np.unique(numbers).size < numbers.size:
        raise ModelError(f"{entry}: {brief(values)} holds a value twice; give each once")
    return numbers


def dofs_of(dofs: Iterable[str] | str | None, disk: BladedDisk) -> tuple[str, ...]:
    """Return degrees of freedom of a sector, each known and named once."""
    known = disk.structure.dofs
    if dofs is None:
        ends = (dof for contact in disk.contacts for dof in contact.dofs)
        touched = [dof.removeprefix(NEXT) for dof in ends if dof is not None]
        loaded = [force.dof for force in disk.forces]
        return tuple(dict.fromkeys([*loaded, *touched])) or known
    if not isinstance(dofs, Iterable):
        raise ModelError(f"dofs: {brief(dofs)} is not a list of names; write [{known[0]!r}]")
    names = (dofs,) if isinstance(dofs, str) else tuple(dofs)
    for place, name in enumerate(names):
        if text(name, f"dofs[{place}]") not in known:
            raise ModelError(f"dofs: {unknown('dof of a sector', name, known)}")
        if name in names[:place]:
            raise ModelError(f"dofs: {name!r} is named twice; name it once")
    if not names:
        raise ModelError("dofs: no dof; name at least one, or leave it out")
    return names


def processors() -> int:
    """Return how many processors this program may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1

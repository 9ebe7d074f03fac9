"""Whether a result will fit into the memory of this machine, asked before it is computed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import local
from typing import NamedTuple

from stickslip.errors import ModelError

SHARE = 0.75
"""Share of the memory that an analysis may take."""

COPIES = 3.2
"""Copies of a result while it is saved: itself, its dataset, the file in the room it grows in."""

_PER_POINT = 80
"""Numbers that a point of the core takes beside its own: vectors, their allocation, its status."""


class _Family(NamedTuple):
    """Results that are in the memory together."""

    results: int = 1
    """All of them."""
    at_once: int = 1
    """Those that are computed at the same time."""
    saved: int = 1
    """Those that are saved as one."""


_OWN = local()
"""Knows to which family the results of this thread belong."""


@contextmanager
def one_of(results: int, at_once: int, *, together: bool) -> Iterator[None]:
    """Have an analysis reckon with others whose results are kept beside its own.

    There are so many `results` in all, some of them computed `at_once`, and saved `together` or one
    after the other; each of them may be a family itself.
    """
    before: _Family = getattr(_OWN, "family", _Family())
    saved = results if together else 1
    _OWN.family = _Family(before.results * results, before.at_once * at_once, before.saved * saved)
    try:
        yield
    finally:
        _OWN.family = before


def require_memory(
    points: int, harmonics: int, observed: int, contact_points: int, *, extra: int = 0
) -> None:
    """Refuse a curve that would not fit into the memory while it is computed and saved.

    `harmonics` is the highest that is at least kept, `extra` how many real numbers the result
    holds per point beside the series.
    """
    series = 2 * (harmonics + 1) * (observed + 2 * contact_points)
    kept = series + observed + 2 * contact_points + 7 + extra
    # The core keeps its unknowns and the sampling errors, too; the assumptions look at all dofs.
    core = kept + 2 * (harmonics + 1) * contact_points + 5 * observed + _PER_POINT
    require_numbers(
        points * kept,
        f"omega: the result of {points} points, {observed} dofs and harmonics up to {harmonics}",
        "name fewer dofs with observe=[...], or give fewer points",
        core=points * core,
    )


def require_numbers(numbers: int, what: str, remedy: str, *, core: int | None = None) -> None:
    """Refuse a result that would not fit into the memory while it is computed and saved.

    It holds `numbers` of eight bytes each, and is made from as many or `core` others; `what` names
    the entry that makes it large, and `remedy` how to need fewer.
    """
    family: _Family = getattr(_OWN, "family", _Family())
    # What the core has freed may lie in holes between what threads still hold, beside the copies.
    made = family.at_once * (numbers if core is None else core)
    others = max(family.results - family.at_once - family.saved, 0)
    needed = 8 * (made + (others + COPIES * family.saved) * numbers)
    there = physical_memory()
    if there is not None and needed > SHARE * there:
        several = (
            f", {family.results} times, {family.at_once} at once," if family.results > 1 else ""
        )
        raise ModelError(
            f"{what}{several} needs {needed / 1e9:.3g} GB of the {there / 1e9:.3g} GB of memory; "
            f"{remedy}"
        )


def physical_memory() -> int | None:
    """Return the bytes of memory that a process may have; None where the system does not tell."""
    known = []
    with suppress(AttributeError, ValueError, OSError):
        known.append(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    # A container may have less than the machine; "max" is no number.
    with suppress(ValueError, OSError):
        known.append(int(Path("/sys/fs/cgroup/memory.max").read_text(encoding="ascii")))
    return min((one for one in known if one > 0), default=None)

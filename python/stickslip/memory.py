"""Whether a result will fit into the memory of this machine, asked before it is computed."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from stickslip.errors import ModelError

SHARE = 0.75
"""Share of the memory that an analysis may take."""

COPIES = 3.2
"""Copies of a result while it is saved: itself, its dataset, the file in the room it grows in."""

_PER_POINT = 80
"""Numbers that a point of the core takes beside its own: vectors, their allocation, its status."""


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
    # What the core has freed may lie in holes between what threads still hold, beside the copies.
    needed = 8 * ((numbers if core is None else core) + COPIES * numbers)
    there = physical_memory()
    if there is not None and needed > SHARE * there:
        raise ModelError(
            f"{what} needs {needed / 1e9:.3g} GB of the {there / 1e9:.3g} GB of memory; {remedy}"
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

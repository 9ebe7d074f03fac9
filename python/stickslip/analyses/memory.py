"""Whether a result will fit into the memory of this machine, asked before it is computed."""

from __future__ import annotations

import os

from stickslip.errors import ModelError

__all__ = ["require_memory", "require_numbers"]

SHARE = 0.75
"""Share of the physical memory that a result may take."""


def require_memory(
    points: int, harmonics: int, observed: int, contact_points: int, *, extra: int = 0
) -> None:
    """Refuse a result that would not fit into the memory.

    Parameters
    ----------
    points : int
        Number of frequencies.
    harmonics : int
        Highest harmonic that is at least kept.
    observed : int
        Number of observed degrees of freedom.
    contact_points : int
        Number of contact points, of each of which displacement and force are kept.
    extra : int, optional
        How many real numbers more the result holds.

    Raises
    ------
    ModelError
        If the result takes more than `SHARE` of the physical memory.
    """
    require_numbers(
        2 * points * (harmonics + 1) * (observed + 2 * contact_points) + extra,
        f"the result of {points} points, {observed} dofs and harmonics up to {harmonics}",
        "name fewer dofs with observe=[...], or give fewer points",
    )


def require_numbers(numbers: int, what: str, remedy: str) -> None:
    """Refuse a result of so many real numbers that it would not fit into the memory.

    Parameters
    ----------
    numbers : int
        Real numbers of eight bytes.
    what : str
        What they are.
    remedy : str
        How to need fewer.

    Raises
    ------
    ModelError
        If they take more than `SHARE` of the physical memory.
    """
    needed = 8 * numbers
    there = physical_memory()
    if there is not None and needed > SHARE * there:
        raise ModelError(
            f"{what} needs {needed / 1e9:.3g} GB of the {there / 1e9:.3g} GB of memory; {remedy}"
        )


def physical_memory() -> int | None:
    """Return the bytes of physical memory; None where the system does not tell."""
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None
    return memory if memory > 0 else None

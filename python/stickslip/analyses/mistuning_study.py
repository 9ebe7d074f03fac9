"""Amplification factors of many mistuned disks."""

from __future__ import annotations

import os
import time

import numpy as np

from stickslip.analyses.arguments import require_forced
from stickslip.analyses.memory import require_numbers
from stickslip.analyses.mistuning_disks import (
    Series,
    coupled_disks,
    dofs_of,
    identity_of,
    patterns_of,
    require_stiff,
    tuned_peaks,
)
from stickslip.analyses.mistuning_run import Work
from stickslip.analyses.pattern_store import PatternStore
from stickslip.analyses.run import Progress, Run
from stickslip.checks import brief
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.results.mistuning import MistuningStudy
from stickslip.settings.peaks import MistuningKeys, MistuningSettings, PeakSettings
from stickslip.settings.settings import configured

__all__ = ["mistuning_study"]


@configured(MistuningKeys, "deviation")
def mistuning_study(
    disk: BladedDisk, *, settings: MistuningKeys, progress: Progress = None
) -> MistuningStudy:
    """Amplification factors of disks whose blades deviate at random, and their distribution.

    Of every disk the highest point over all blades and all frequencies of a range is found directly
    from some twenty solutions with exact slopes; no grid has to be fine enough. Its ratio to the
    peak of the tuned disk is the amplification factor. What is computed of a disk depends on
    nothing but its own pattern and the tuned disk, so that numbers are the same bit by bit with any
    number of threads, in one run or in several.

    Parameters
    ----------
    disk : BladedDisk
        The tuned disk.

    Returns
    -------
    MistuningStudy
        One amplification factor per deviation, coupling, pattern and degree of freedom.

    Raises
    ------
    ModelError
        If the peak of the tuned disk cannot be found, or the store holds another study.

    References
    ----------
    Guillen (1999), section 4.5 and Fig. 4.22, of one pattern.

    Examples
    --------
    >>> import stickslip as ss
    >>> ring = ss.reference.beam_ring(sectors=12, coupling=7e3, engine_order=3)
    >>> study = ss.mistuning_study(ring, 0.05, omega=(150, 260), patterns=2, seed=1, harmonics=3)
    >>> study.amplification("damper").shape
    (1, 1, 2)
    """
    if not isinstance(disk, BladedDisk):
        raise ModelError(f"disk: {brief(disk)} is no BladedDisk; give the tuned disk")
    rows, drawn = patterns_of(disk, settings)
    kept = MistuningSettings.of(
        **settings.part(PeakSettings),
        span=settings.omega,
        distribution=settings.distribution if drawn else None,
        seed=settings.seed if drawn else None,
    )
    names = dofs_of(settings.dofs, disk)
    deviations = np.atleast_1d(settings.deviation)
    require_stiff(deviations, rows)
    require_forced(disk, settings)
    disks = coupled_disks(disk, settings.coupling_stiffness)
    count = deviations.size * len(disks) * len(rows) * len(names)
    # Deviations and peaks; the core has its own of the former.
    each = disk.sectors * deviations.size * len(disks) * len(rows)
    held = 8 * count + disk.sectors * len(rows)
    what = f"patterns: the result of {count} peaks"
    require_numbers(held, what, "give fewer patterns", core=3 * each)
    start = time.perf_counter()
    series = [Series(one, value, tuned_peaks(one, kept, names)) for value, one in disks]
    work = Work(disk, kept, names, deviations, series, rows)
    with Run("mistuning study", progress) as run:
        if settings.store is None:
            complete = work.run(settings.threads, run, None)
        else:
            identity = identity_of(
                disk, kept, names, rows, given=settings.coupling_stiffness is not None
            )
            with PatternStore(settings.store, identity, run.heed) as kept_rows:
                work.recall(kept_rows)
                complete = work.run(settings.threads, run, kept_rows)
        result = work.result(time.perf_counter() - start, interrupted=not complete)
        rest = "" if settings.store is None else f"; {os.fspath(settings.store)} goes on from there"
        return run.ended(result, f"{work.done} of {work.total} disks", rest)

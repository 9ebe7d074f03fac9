"""Amplification factors of many mistuned disks."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _core
from stickslip.analyses.arguments import columns_of, known_dofs, require_forced, require_held
from stickslip.analyses.cluster import Client
from stickslip.analyses.mistuning_run import Series, Work
from stickslip.analyses.pattern_store import Identity, PatternStore, Row, digest
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.checks import brief, whole_number
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.mistuned import tuned_disk
from stickslip.disk.pattern import drawn_patterns
from stickslip.disk.sector import NEXT
from stickslip.errors import ModelError
from stickslip.memory import require_numbers
from stickslip.model import Model
from stickslip.results.fields import Float
from stickslip.results.mistuning import MistuningStudy
from stickslip.results.status import Status
from stickslip.settings.peaks import MistuningKeys, MistuningSettings, PeakSettings
from stickslip.settings.settings import configured


@configured(MistuningKeys, "deviation")
def mistuning_study(
    disk: BladedDisk,
    *,
    settings: MistuningKeys,
    client: Client | None = None,
    progress: Progress = None,
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
    client : distributed.Client, optional
        A Dask cluster that computes the disks, in batches; the numbers are the same as without.
        Rows go into the store of this program as they come.

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
    rows, drawn = _patterns_of(disk, settings)
    kept = MistuningSettings.of(
        **settings.part(PeakSettings),
        span=settings.omega,
        distribution=settings.distribution if drawn else None,
        seed=settings.seed if drawn else None,
    )
    names = _dofs_of(settings.dofs, disk)
    deviations = np.atleast_1d(settings.deviation)
    _require_stiff(deviations, rows)
    require_forced(disk, settings)
    disks = _coupled_disks(disk, settings.coupling_stiffness)
    # Refuses what it cannot make before anything is computed.
    tuned_disk(disk)
    count = deviations.size * len(disks) * len(rows) * len(names)
    # Deviations and peaks; the core has its own of the former.
    each = disk.sectors * deviations.size * len(disks) * len(rows)
    held = 8 * count + disk.sectors * len(rows)
    what = f"patterns: the result of {count} peaks"
    require_numbers(held, what, "give fewer patterns", core=3 * each)
    start = time.perf_counter()
    series = [Series(one, value, _tuned_peaks(one, kept, names)) for value, one in disks]
    work = Work(disk, kept, names, deviations, series, rows)
    with Run("mistuning study", progress) as run:
        if settings.store is None:
            complete = work.run(settings.threads, settings.portion, run, None, client)
        else:
            identity = _identity_of(
                disk, kept, names, rows, given=settings.coupling_stiffness is not None
            )
            with PatternStore(settings.store, identity, run.heed) as kept_rows:
                work.recall(kept_rows)
                complete = work.run(settings.threads, settings.portion, run, kept_rows, client)
        result = work.result(time.perf_counter() - start, interrupted=not complete)
        rest = "" if settings.store is None else f"; {os.fspath(settings.store)} goes on from there"
        return run.ended(result, f"{work.done} of {work.total} disks", rest)


def _patterns_of(disk: BladedDisk, settings: MistuningKeys) -> tuple[Float, bool]:
    """Return the patterns, and whether they were drawn."""
    patterns, sectors = settings.patterns, disk.sectors
    if isinstance(patterns, int | np.integer):
        count = whole_number(patterns, "patterns", smallest=1)
        what = f"patterns: {count} of {sectors} sectors"
        require_numbers(count * sectors, f"{what} each", "give fewer patterns")
        return drawn_patterns(sectors, count, settings.distribution, seed=settings.seed), True
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


def _require_stiff(deviations: Float, patterns: Float) -> None:
    """Refuse a blade without stiffness."""
    least, largest = patterns.min(), deviations.max(initial=0.0)
    if largest * least > -1.0:
        return
    pattern, blade = (int(at) for at in np.unravel_index(patterns.argmin(), patterns.shape))
    raise ModelError(
        f"deviation: {largest:g} leaves blade {blade} of pattern {pattern} the stiffness "
        f"{1.0 + largest * least:.3g} K; give a smaller one, 0.05 for 5 %, or "
        'distribution="uniform"'
    )


def _dofs_of(dofs: Iterable[str] | str | None, disk: BladedDisk) -> tuple[str, ...]:
    """Return degrees of freedom of a sector; by default those with a force or a contact."""
    if dofs is not None:
        return known_dofs(dofs, "dofs", "dof of a sector", disk)
    ends = (dof for contact in disk.contacts for dof in contact.dofs)
    touched = [dof.removeprefix(NEXT) for dof in ends if dof is not None]
    loaded = [force.dof for force in disk.forces]
    return tuple(dict.fromkeys([*loaded, *touched])) or disk.structure.dofs


def _tuned_peaks(
    disk: BladedDisk, settings: MistuningSettings, dofs: Sequence[str]
) -> tuple[Row, ...]:
    """Return the peaks of the tuned disk, by one sector if its motion is one wave."""
    model: Model = disk
    groups = [[dof] for dof in dofs]
    # The forces, and so the motion of the tuned disk, travel as a single wave.
    ahead = (disk.order_of(one.harmonic) - one.harmonic * disk.engine_order for one in disk.forces)
    if any(order % disk.sectors for order in ahead):
        model = disk.mistuned(0.0)
        groups = [[f"{blade}.{dof}" for blade in range(disk.sectors)] for dof in dofs]
    require_held(model, settings.residual)
    columns = [columns_of(group, model).tolist() for group in groups]
    with refusals(model):
        found = _core.summits(model.problem, columns, settings.measure, settings.span, settings)
    rows = tuple(Row(*row) for row in found)
    for dof, row in zip(dofs, rows, strict=True):
        status = Status.from_code(row.status)
        if not status.solved:
            raise ModelError(
                f"dof {dof!r}: the peak of the tuned disk was not found ({status}), and "
                f"nothing can be compared with it. {status.advice}"
            )
        if row.amplitude == 0.0:
            raise ModelError(f"dof {dof!r}: it does not move; give the disk forces that reach it")
    return rows


def _coupled_disks(disk: BladedDisk, stiffness: ArrayLike | None) -> list[tuple[float, BladedDisk]]:
    """Return the disk with each stiffness of its couplings."""
    own = {coupling.stiffness for coupling in disk.couplings}
    if stiffness is None:
        return [(own.pop() if len(own) == 1 else math.nan, disk)]
    if not disk.couplings:
        reason = "coupling_stiffness: the disk has no couplings that could take it; give it"
        raise ModelError(
            f"{reason} couplings=[ss.Coupling(...)]", study=f"{reason} a table [[coupling]]"
        )
    values = np.atleast_1d(np.asarray(stiffness, dtype=np.float64)).tolist()
    return [
        (value, disk._like(couplings=[replace(one, stiffness=value) for one in disk.couplings]))
        for value in values
    ]


def _identity_of(
    disk: BladedDisk,
    settings: MistuningSettings,
    dofs: tuple[str, ...],
    patterns: Float,
    *,
    given: bool,
) -> Identity:
    """Return what makes a study, but for how many patterns, which deviations and couplings."""
    structure, law = disk.structure, disk.structure.damping_law
    couplings = [one.to_spec() for one in disk.couplings]
    if given or len({one.stiffness for one in disk.couplings}) == 1:
        # Every row says which stiffness it is of.
        couplings = [one | {"stiffness": None} for one in couplings]
    interface = disk.interface
    blocks = () if interface is None else (interface.mass, interface.damping, interface.stiffness)
    return {
        "version": _core.__version__,
        "structure": digest(structure.mass, structure.damping, structure.stiffness),
        "damping": None if law is None else law.to_spec(),
        "sector": list(structure.dofs),
        "sectors": disk.sectors,
        "engine_order": disk.engine_order,
        "engine_orders": {str(k): order for k, order in disk.engine_orders.items()},
        "couplings": couplings,
        "interface": digest(*blocks),
        "contacts": [one.to_spec() for one in disk.contacts],
        "forces": [one.to_spec() for one in disk.forces],
        "dofs": list(dofs),
        "omega": list(settings.span),
        "patterns": digest(patterns) if settings.distribution is None else "drawn",
        **{name: value for name, value in settings if name != "span"},
    }

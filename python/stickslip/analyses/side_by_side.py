"""Independent parts of a work at the same time, in as many threads as there are processors.

What a part gives depends on nothing but itself: it is the same with any number of threads, and
comes in the order of the parts.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import partial
from itertools import islice
from threading import Event, local
from typing import TypeVar

from stickslip.analyses.run import Progress, share
from stickslip.model import Model
from stickslip.model.contact_law import ContactLaw

__all__ = ["at_once", "has_own_laws", "in_turn"]

_Kind = TypeVar("_Kind")

_LOOK = 0.05
"""Seconds between two looks at signals and progress."""

_WITHIN = local()
"""Knows whether this thread works on a part: its own parts come one after the other."""


def in_turn(
    parts: Sequence[Callable[[Progress], _Kind]],
    progress: Progress,
    *,
    alone: bool = False,
    threads: int | None = None,
    ahead: int = 1,
) -> Generator[_Kind, None, None]:
    """Yield what parts of a work give, in their order; `alone`, one after the other in this thread.

    Each part gets the progress that it has to tell; Ctrl-C, and what `progress` raises to end the
    work, reach it as `KeyboardInterrupt` of that. `progress` is called in this thread, with the
    share of the work done. `KeyboardInterrupt` comes behind the last part that was complete, or
    what the part raises that was not. No more than `ahead` times as many parts as threads are under
    way: what is complete waits in memory for those before it.
    """
    count = len(parts)
    threads = at_once(count, alone=alone, threads=threads)
    if threads <= 1:
        for number, part in enumerate(parts):
            yield part(share(progress, number / count, (number + 1) / count))
            if progress is not None:
                progress((number + 1) / count)
        return
    told: dict[int, float] = {}
    ended = Event()
    waiting: deque[Future[_Kind]] = deque()
    pool = ThreadPoolExecutor(threads, "stickslip")
    rest = iter(range(count))

    def computed(number: int) -> _Kind:
        def heard(done: float) -> None:
            told[number] = done
            if ended.is_set():
                raise KeyboardInterrupt

        _WITHIN.part = True
        heard(0.0)
        given = parts[number](heard)
        told[number] = 1.0
        return given

    try:
        for first in range(count):
            for number in islice(rest, ahead * threads - len(waiting)):
                told[number] = 0.0
                waiting.append(pool.submit(computed, number))
            done = partial(_share_done, first, told, count)
            stop = _awaited(waiting[0], done, progress)
            if stop is not None:
                ended.set()
            yield waiting.popleft().result()
            del told[first]
            if stop is not None:
                raise stop
    finally:
        ended.set()
        pool.shutdown(cancel_futures=True)


def at_once(count: int, *, alone: bool = False, threads: int | None = None) -> int:
    """Return how many of so many parts `in_turn` works on at the same time."""
    alone = alone or getattr(_WITHIN, "part", False)
    return 1 if alone else min(threads or processors(), count)


def has_own_laws(model: Model) -> bool:
    """Return whether a contact law is the user's own, which need not bear several threads."""
    return any(isinstance(contact, ContactLaw) for contact in model.contacts)


def processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _share_done(complete: int, told: Mapping[int, float], count: int) -> float:
    return (complete + sum(told.values())) / count


def _awaited(
    part: Future[_Kind], share_done: Callable[[], float], progress: Progress
) -> KeyboardInterrupt | None:
    """Wait for a part, or until the caller ends the work."""
    try:
        while True:
            done = wait([part], timeout=_LOOK).done
            if progress is not None:
                progress(share_done())
            if done:
                return None
    except KeyboardInterrupt as stop:
        return stop

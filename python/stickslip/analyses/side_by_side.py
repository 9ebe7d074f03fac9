"""Independent parts of a work at the same time, in as many threads as there are processors.

What a part gives depends on nothing but itself: it is the same with any number of threads, and
comes in the order of the parts.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from itertools import islice
from threading import Event, local
from typing import TypeVar, cast

from stickslip.analyses.run import Progress, share
from stickslip.errors import Interrupted
from stickslip.model import Model
from stickslip.model.contact_law import ContactLaw
from stickslip.results.result import Result

__all__ = ["at_once", "has_own_laws", "in_turn", "whole"]

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
    within: Callable[[], AbstractContextManager[None]] = nullcontext,
) -> Generator[_Kind, None, None]:
    """Yield what parts of a work give, in their order; `alone`, one after the other in this thread.

    Each part gets the progress that it has to tell; Ctrl-C, and what `progress` raises to end the
    work, reach it as `KeyboardInterrupt` of that. `progress` is called in this thread, with the
    share of the work done. `KeyboardInterrupt` comes behind all parts that were complete before one
    that was not, or what this raises; its `beside` has what later parts have come to. Parts in this
    thread are done `within` a context. No more than `ahead` times as many parts as threads are
    under way: what is complete waits in memory for those before it.
    """
    count = len(parts)
    threads = at_once(count, alone=alone, threads=threads)
    if threads <= 1:
        yield from _alone(parts, progress, within)
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

    stop: KeyboardInterrupt | None = None
    try:
        for first in range(count):
            if stop is None:
                for number in islice(rest, ahead * threads - len(waiting)):
                    told[number] = 0.0
                    waiting.append(pool.submit(computed, number))
                stop = _awaited(waiting[0], partial(_share_done, first, told, count), progress)
            if stop is not None:
                ended.set()
                if not waiting:
                    break
            part = waiting.popleft()
            error = part.exception()
            if stop is not None and isinstance(error, KeyboardInterrupt):
                vars(error)["beside"] = tuple(_kept(waiting, first + 1))
            yield part.result()
            del told[first]
        if stop is not None:
            raise stop
    finally:
        ended.set()
        pool.shutdown(cancel_futures=True)


def _kept(waiting: Iterable[Future[_Kind]], first: int) -> Iterator[tuple[int, Interrupted]]:
    """Yield what parts have come to that were told to end, by their number."""
    for number, part in enumerate(waiting, first):
        error = part.exception()
        if error is None:
            yield number, Interrupted("", part.result())
        elif isinstance(error, Interrupted):
            yield number, error


def _alone(
    parts: Sequence[Callable[[Progress], _Kind]],
    progress: Progress,
    within: Callable[[], AbstractContextManager[None]],
) -> Generator[_Kind, None, None]:
    """Yield what parts give, one after the other in this thread."""
    count = len(parts)
    for number, part in enumerate(parts):
        given: list[_Kind] = []
        stop: KeyboardInterrupt | None = None
        try:
            with within():
                given.append(part(share(progress, number / count, (number + 1) / count)))
        except KeyboardInterrupt as late:
            if not given:
                raise
            stop = late
        yield given[0]
        if stop is not None:
            raise stop
        if progress is not None:
            progress((number + 1) / count)


def at_once(count: int, *, alone: bool = False, threads: int | None = None) -> int:
    """Return how many of so many parts `in_turn` works on at the same time."""
    alone = alone or getattr(_WITHIN, "part", False)
    return 1 if alone else min(threads or processors(), count)


def whole(compute: Callable[[], Result]) -> Result:
    """Return what a part computes, also if it heard of the end when it was complete.

    In a thread of its own: who ended the work knows of it.
    """
    try:
        return compute()
    except Interrupted as stop:
        if not stop.complete or not getattr(_WITHIN, "part", False):
            raise
        return cast("Result", stop.result)


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

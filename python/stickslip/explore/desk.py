"""A desk at which one thing is worked on, always the newest: what is older is dropped."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Generic, TypeVar

from stickslip.explore.panes import Look

Task = TypeVar("Task")


class OutdatedError(Exception):
    """Nobody waits any more for what is being computed."""


class Desk(Generic[Task]):
    """A thread with room for one task in work and one that waits.

    Parameters
    ----------
    work : callable
        Takes a task and a look, to be called often, which raises `OutdatedError` once the task is
        no longer wanted. An analysis takes it as its `progress`.
    """

    def __init__(self, work: Callable[[Task, Look], None]) -> None:
        self._work = work
        self._change = threading.Condition()
        self._waiting: list[Task] = []
        self._dropped = self._ended = False
        # A daemon: the program may end while it computes.
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def give(self, task: Task) -> None:
        """Put the newest task on the desk, in place of those before."""
        with self._change:
            self._waiting, self._dropped = [task], True
            self._change.notify()

    def drop(self) -> None:
        """Want nothing of what was given any more."""
        with self._change:
            self._waiting, self._dropped = [], True

    def end(self) -> None:
        """Drop everything, for good."""
        with self._change:
            self._waiting, self._dropped, self._ended = [], True, True
            self._change.notify()

    def ended(self, patience: float) -> bool:
        """Wait until the thread has ended; False if it takes longer [s]."""
        self._thread.join(patience)
        return not self._thread.is_alive()

    def _look(self, _: float) -> None:
        if self._dropped:
            raise OutdatedError

    def _run(self) -> None:
        while True:
            with self._change:
                self._change.wait_for(lambda: self._waiting or self._ended)
                if self._ended:
                    return
                task, self._dropped = self._waiting.pop(), False
            with suppress(OutdatedError):
                self._work(task, self._look)

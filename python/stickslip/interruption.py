"""Ctrl-C while an analysis runs: heeded where what was computed can be kept."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, Self, TypeAlias, TypeVar

from stickslip.errors import Interrupted

SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals that end an analysis, where a handler in Python is installed for them."""

_IMPATIENT = 0.5
"""Seconds after which a second signal is one of its own, not an echo of the first."""

Kind = TypeVar("Kind")

Making: TypeAlias = Callable[[Callable[[float], None] | None], Kind]
"""Makes a result of what was computed; looks at signals by what it is given, if it is."""


class Interruption:
    """A block in which signals wait until what was computed is safe.

    Between the end of the core's work and the result, a `KeyboardInterrupt` at any line would lose
    both. So signals are noted, and their handlers called when the core asks how to go on, while the
    caller's own callback runs, and at the end. A second signal, half a second later or more, is
    heeded at once. Signals that are ignored or have no handler in Python are left alone, and all of
    them outside the main thread, which alone receives them. `progress` is called with the share of
    the work done.
    """

    def __init__(self, progress: Callable[[float], None] | None = None) -> None:
        self._progress = progress
        self._handlers: dict[int, Callable[[int, FrameType | None], Any]] = {}
        self._installed = self._handlers.copy()
        self._noted: tuple[int, float] | None = None
        self._at_once = False
        self._ended = False
        """Whether work was told to end, which may have been complete then."""
        self._outer: Interruption | None = None
        """The block around this one, in which signals wait, too."""
        self._whole: Interrupted | None = None
        """What a signal becomes once all is computed."""

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                handler = signal.getsignal(number)
                if callable(handler):
                    self._installed[number] = handler
                    # Within another such block that one must not put the signal off once more.
                    outer = getattr(handler, "__self__", None)
                    if isinstance(outer, Interruption):
                        self._outer = outer
                        handler = outer._handlers[number]
                    self._handlers[number] = handler
                    signal.signal(number, self._note)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            for number, handler in self._installed.items():
                signal.signal(number, handler)
            if not isinstance(error, KeyboardInterrupt):
                self.heed()
        except KeyboardInterrupt:
            kept = error if isinstance(error, Interrupted) else self._whole
            if kept is None:
                raise
            raise kept from None

    def _note(self, number: int, frame: FrameType | None) -> None:
        again = self._noted is not None and time.monotonic() > self._noted[1] + _IMPATIENT
        if self._at_once or again:
            # Python passes over what is raised while an object goes: it is heeded once more.
            self._noted = number, time.monotonic()
            self._handlers[number](number, frame)
            self._noted = None
        elif self._noted is None:
            self._noted = number, time.monotonic()

    def heed(self) -> None:
        """Call the handler of a signal that was noted, which may raise KeyboardInterrupt."""
        if self._noted is not None:
            number, self._noted = self._noted[0], None
            with self._ending():
                self._handlers[number](number, None)

    @contextmanager
    def _ending(self) -> Iterator[None]:
        """Remember Ctrl-C: work that hears of it may be complete by then, and say nothing of it."""
        try:
            yield
        except KeyboardInterrupt:
            self._ended = True
            raise

    def pass_on(self) -> None:
        """Heed a signal, unless it is the first one that waits in the block around this one."""
        outer = self._outer
        if outer is None or outer._at_once:
            self.heed()
        elif self._noted is not None and outer._noted is None:
            outer._noted, self._noted = self._noted, None
        elif outer._noted is not None and time.monotonic() > outer._noted[1] + _IMPATIENT:
            self.heed()

    @contextmanager
    def at_once(self) -> Iterator[None]:
        """Heed signals at any line of a block that can be left anywhere."""
        before, self._at_once = self._at_once, True
        try:
            self.heed()
            yield
        except KeyboardInterrupt:
            self._noted = None
            raise
        finally:
            self._at_once = before

    def __call__(self, share: float) -> None:
        """Heed signals, and tell how much of the work is done."""
        self.heed()
        if self._progress is not None:
            with self._ending(), self.at_once():
                self._progress(share)

    def completed(self, result: Kind, what: str) -> Kind:
        """Tell that all is done, and return the result.

        If a signal comes after the last point, until the block is left, `Interrupted` holds it.
        """
        return self.made(lambda _: result, what)

    def made(self, make: Making[Kind], what: str) -> Kind:
        """Return a `completed` result that is still to be made of what was computed.

        A signal ends the making, which then waits until `Interrupted` is asked for the result.
        """
        made: list[Kind] = []

        def once(look: Callable[[float], None] | None = None) -> Kind:
            if not made:
                made.append(make(look))
            return made[0]

        said = "interrupted when all was computed; the result of this exception is complete"
        self._whole = Interrupted.later(f"{what} {said}", once, complete=True)
        try:
            with self.at_once():
                result = once(self)
            self(1.0)
        except KeyboardInterrupt:
            raise self._whole from None
        if self._ended:
            raise self._whole
        return result


def beside(make: Callable[[], Kind]) -> Kind:
    """Run compiled code in a thread beside this one, which hears Ctrl-C meanwhile."""
    made: Future[Kind] = Future()

    def work() -> None:
        try:
            made.set_result(make())
        except BaseException as error:  # handed on to the caller below
            made.set_exception(error)

    threading.Thread(target=work, daemon=True).start()
    while not wait([made], 0.2).done:
        pass
    return made.result()


def stopped(what: str, count: str, result: object, advice: str = "") -> Interrupted:
    """Return the exception of an analysis that was stopped, which holds what was computed."""
    return Interrupted(_stopped(what, count, advice), result)


def stopped_before(what: str, count: str, make: Making[object]) -> Interrupted:
    """Return the exception of an analysis that was `stopped`, whose result is still to be made."""
    return Interrupted.later(_stopped(what, count), lambda: make(None), complete=False)


def _stopped(what: str, count: str, advice: str = "") -> str:
    return f"{what} interrupted after {count}, which the result of this exception holds{advice}"

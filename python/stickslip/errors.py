"""What the package raises."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property


class ModelError(ValueError):
    """Input that cannot be used; one line names the entry, its value and the remedy.

    Authors of study files are told the line `study`, where the remedy is another one for them.
    """

    def __init__(self, message: str = "", *, study: str | None = None) -> None:
        super().__init__(message)
        self.study = message if study is None else study


class EntryError(ModelError):
    """A value that an entry cannot have.

    `entry` is its name, empty where only the value is known; `said` what is wrong and the remedy,
    from the mark after the name on: ``: -1 lies below 0; ...``.
    """

    def __init__(self, entry: str, said: str) -> None:
        super().__init__(f"{entry}{said}")
        self.said = said

    def __reduce__(self) -> tuple[type[EntryError], tuple[str, str]]:
        return type(self), (str(self).removesuffix(self.said), self.said)


class CallError(ModelError, TypeError):
    """Arguments that do not fit a signature: a misspelt keyword, or one that is missing."""


class Interrupted(KeyboardInterrupt):
    """An analysis was stopped by Ctrl-C; what had been computed is kept.

    Its attribute `result` is the partial result, of the type that the analysis would have returned.
    Points that were not reached say so in their status. A large one, which takes a while to put
    together, is when it is asked for first; Ctrl-C ends that, and it can be asked for again.
    `complete` says whether nothing of it is missing. `beside` has the exceptions of other parts of
    the work, which were under way at the same time: each by its position among the parts.
    """

    def __init__(self, message: str, result: object) -> None:
        super().__init__(message)
        self.complete = not getattr(result, "interrupted", True)
        self.beside: tuple[tuple[int, Interrupted], ...] = ()
        self._make: Callable[[], object] = lambda: result

    @classmethod
    def later(cls, message: str, make: Callable[[], object], *, complete: bool) -> Interrupted:
        """Return an exception whose result is made when it is asked for."""
        stop = cls(message, None)
        stop._make, stop.complete = make, complete
        return stop

    @cached_property
    def result(self) -> object:
        """The partial result."""
        return self._make()

    def __reduce__(self) -> tuple[type[Interrupted], tuple[str, object]]:
        return type(self), (str(self), self.result)

"""What the package raises."""

from __future__ import annotations


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
    Points that were not reached say so in their status. `beside` has what other parts of the work,
    which were under way at the same time, had come to: each by its position among the parts.
    """

    def __init__(self, message: str, result: object) -> None:
        super().__init__(message)
        self.result = result
        self.beside: tuple[tuple[int, object], ...] = ()

    def __reduce__(self) -> tuple[type[Interrupted], tuple[str, object]]:
        return type(self), (str(self), self.result)

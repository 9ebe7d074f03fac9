"""What the package raises."""

from __future__ import annotations

__all__ = ["Interrupted", "ModelError"]


class ModelError(ValueError):
    """Input that cannot be used; one line names the entry, its value and the remedy."""


class Interrupted(KeyboardInterrupt):
    """An analysis was stopped by Ctrl-C; what had been computed is kept.

    Parameters
    ----------
    message : str
        What was stopped, and how far it had come.
    result : object
        The partial result, of the type the analysis would have returned. Points that were not
        reached say so in their status.

    Attributes
    ----------
    result : object
        The partial result.
    """

    def __init__(self, message: str, result: object) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type[Interrupted], tuple[str, object]]:
        return type(self), (str(self), self.result)

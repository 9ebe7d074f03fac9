"""What every analysis does around its own: it calls the core, and it ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any, TypeAlias, TypeVar

from stickslip import _core
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, Making, stopped, stopped_before
from stickslip.model import Model
from stickslip.model.pace import refusal
from stickslip.results.result import Result

Progress: TypeAlias = Callable[[float], None] | None

_Kind = TypeVar("_Kind", bound=Result)

REPORT_EVERY = 0.1
"""Seconds between two calls of a progress callback."""


class Run(Interruption):
    """A block in which an analysis computes; signals wait until what was computed is safe.

    A `model` is decomposed at once, while Ctrl-C still ends an analysis at any line: nothing is
    lost yet. `what` is computed, in words.
    """

    def __init__(self, what: str, progress: Progress, model: Model | None = None) -> None:
        super().__init__(progress)
        self._what, self._reported = what, monotonic()
        self._model = model
        _ = None if model is None else model.problem

    def __call__(self, share: float) -> None:
        """Heed signals and errors of the user's laws, and tell how much of the work is done."""
        if self._model is not None:
            self._model.raise_own()
        super().__call__(share)

    def reached(self, share: float) -> None:
        """Tell how much of the work is done, but not too often."""
        if monotonic() > self._reported + REPORT_EVERY:
            self(share)
            self._reported = monotonic()

    def ended(self, result: _Kind, count: str, advice: str = "") -> _Kind:
        """Return the result of a run that is complete, or raise `Interrupted`, which holds it.

        `count` says how much there is.
        """
        if result.interrupted:
            raise stopped(self._what, count, result, advice)
        return self.completed(result, self._what)

    def found(self, found: _core.Found[Any], count: str, make: Making[_Kind]) -> _Kind:
        """Return what is made of a solution of the core, or raise `Interrupted`, which makes it.

        `count` says of how many points it can be.
        """
        if found.interrupted:
            computed = "some" if found.computed is None else found.computed
            raise stopped_before(self._what, f"{computed}{count}", make)
        return self.made(make, self._what)


@contextmanager
def refusals(model: Model, *others: Model) -> Iterator[None]:
    """Say by the names of the model what the core refuses; heed the laws of all models."""
    models = model, *others
    try:
        _forget_own(models)
        yield
    except ModelError:
        raise
    except ValueError as error:
        _raise_own(models)
        raise refusal(error, model) from error
    finally:
        _forget_own(models)
    _raise_own(models)


def _forget_own(models: Iterable[Model]) -> None:
    for model in models:
        model.forget_own()


def _raise_own(models: Iterable[Model]) -> None:
    for model in models:
        model.raise_own()


def share(progress: Progress, start: float, end: float) -> Progress:
    """Return what a part of the work tells of its own progress."""
    if progress is None:
        return None
    return lambda done: progress((1.0 - done) * start + done * end)

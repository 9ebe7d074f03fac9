"""What one step of a user's own law answers: its shapes, and its tangents against differences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple, NoReturn

import numpy as np

from stickslip.checks import Matrix, brief
from stickslip.errors import ModelError

_STEPS = (1e-6, 1e-4)
"""Steps of differences, relative to what is moved: the cube root of rounding, a little less, and a
wider one, where rounding of parts that only the law knows fades."""
_PASSING = 1e-3
"""Least size of a state, relative to what the displacements would make of it without slip."""
_DIFFERS = 1e-4
"""Difference of a slope, relative to the largest of its kind, that rounding does not explain."""
_KEPT = 1 << 18
"""Numbers in answers that are kept: of a small law those of some periods."""
_ROUNDED = 16.0 * float(np.finfo(np.float64).eps)
"""Rounding of a force or a state, relative to the largest: what saturates has no other slope."""


class _Part(NamedTuple):
    """An array of an answer, and its place in the memory of all."""

    what: str
    place: slice
    shape: tuple[int, ...]


@cache
def _parts(n: int, d: int, m: int) -> tuple[_Part, ...]:
    """Return force, state and tangents of n nodes, d displacements and m numbers of state each."""
    shapes = {
        "force": (n, d),
        "state": (n, m),
        "tangents.state_by_state": (n, m, m),
        "tangents.state_by_before": (n, m, d),
        "tangents.state_by_after": (n, m, d),
        "tangents.force_by_state": (n, d, m),
        "tangents.force_by_after": (n, d, d),
    }
    ends = np.cumsum([0, *(int(np.prod(shape)) for shape in shapes.values())]).tolist()
    places = map(slice, ends, ends[1:])
    return tuple(map(_Part, shapes, places, shapes.values()))


class Answers:
    """The last answers of a law, by its displacements and state.

    The core marches through the same period again, to derive what it has evaluated: two of three
    steps have been taken before.
    """

    def __init__(self, sizes: tuple[int, int, int]) -> None:
        self._most = max(1, _KEPT // _parts(*sizes)[-1].place.stop)
        self._young: dict[bytes, list[Matrix]] = {}
        self._old: dict[bytes, list[Matrix]] = {}

    def find(self, key: bytes) -> list[Matrix] | None:
        """Return the answer, if it is known."""
        return self._young.get(key) or self._old.get(key)

    def keep(self, key: bytes, answer: list[Matrix]) -> None:
        """Keep an answer, and forget the oldest ones."""
        if len(self._young) >= self._most:
            self._young, self._old = {}, self._young
        self._young[key] = answer


def arrays_of(answer: Sequence[object], sizes: tuple[int, int, int], entry: str) -> list[Matrix]:
    """Return force, state and tangents of an answer, of their full shapes.

    Laws are called some hundred thousand times: all share one piece of memory, checked at once.
    """
    parts = _parts(*sizes)
    whole = np.empty(parts[-1].place.stop)
    arrays = [whole[part.place].reshape(part.shape) for part in parts]
    for value, array, part in zip(answer, arrays, parts, strict=True):
        _fill(array, value, entry, part.what)
    if not np.isfinite(whole).all():
        for array, part in zip(arrays, parts, strict=True):
            _require_finite(array, entry, part.what)
    return arrays


def array_of(value: object, shape: tuple[int, ...], entry: str, what: str) -> Matrix:
    """Return an array of a shape, to which what is given is repeated."""
    array = np.empty(shape)
    _fill(array, value, entry, what)
    _require_finite(array, entry, what)
    return array


def _fill(array: Matrix, value: Any, entry: str, what: str) -> None:
    if np.ndim(value) > array.ndim:
        _refuse_shape(array, value, entry, what)
    try:
        array[...] = value
    except (TypeError, ValueError):
        _refuse_shape(array, value, entry, what)


def _refuse_shape(array: Matrix, value: object, entry: str, what: str) -> NoReturn:
    got = f"of shape {value.shape}" if isinstance(value, np.ndarray) else brief(value)
    raise ModelError(f"{entry}: {what} {got}; give shape {array.shape}") from None


def _require_finite(array: Matrix, entry: str, what: str) -> None:
    if not np.isfinite(array).all():
        place = tuple(np.argwhere(~np.isfinite(array))[0].tolist())
        raise ModelError(f"{entry}: {what}{list(place)} is {array[place]}; give numbers")


def compare(
    step: Callable[..., list[Matrix]],
    given: dict[str, Matrix],
    answer: list[Matrix],
    state_stiffness: Matrix,
    entry: str,
) -> None:
    """Refuse tangents that are no derivative of a step."""
    force, new, by_state, by_before, by_after, force_by_state, force_by_after = answer
    middle = {"force": force, "state": new}
    wholes = {
        "state": (force_by_state @ by_state, by_state),
        "before": (force_by_state @ by_before, by_before),
        "after": (force_by_after + force_by_state @ by_after, by_after),
    }
    moved = max(np.abs(given[one]).max(initial=0.0) for one in ("before", "after"))
    for cause, (force_slope, state_slope) in wholes.items():
        size = moved
        if cause == "state":
            # One that passes zero is no measure of what it may be.
            reached = _PASSING * moved * np.abs(state_stiffness).max(initial=0.0)
            size = max(reached, np.abs(given[cause]).max(initial=0.0))
        if not size:
            continue
        slopes = {"force": force_slope, "state": state_slope}
        wrong = ""
        for width in (relative * size for relative in _STEPS):
            wrong = _contradiction(step, given, middle, cause, width, slopes)
            if not wrong:
                break
        if wrong:
            raise ModelError(f"{entry}: tangents of step: {wrong}; correct the derivative")


def _contradiction(
    step: Callable[..., list[Matrix]],
    given: dict[str, Matrix],
    middle: dict[str, Matrix],
    cause: str,
    width: float,
    slopes: dict[str, Matrix],
) -> str:
    """Say which slope differences about an answer contradict; nothing if there is none."""
    noise = {name: _ROUNDED * np.abs(one).max(initial=0.0) / width for name, one in middle.items()}
    for column in range(given[cause].shape[1]):
        sides: dict[str, list[Matrix]] = {name: [] for name in slopes}
        for side in (-width, width):
            there = given[cause].copy()
            there[:, column] += side
            for name, value in zip(slopes, step(**given | {cause: there}), strict=False):
                sides[name].append((value - middle[name]) / side)
        for name, tangent in slopes.items():
            slope = tangent[:, :, column]
            low, high = np.minimum(*sides[name]), np.maximum(*sides[name])
            scale = max(*(np.abs(one).max(initial=0.0) for one in (tangent, low, high)))
            # At a corner every slope between those of both sides is one.
            wrong = np.maximum(low - slope, slope - high) > _DIFFERS * scale + noise[name]
            if wrong.any():
                node, row = np.argwhere(wrong)[0]
                return (
                    f"{name}[{row}] by {cause}[{column}] of node {node} is "
                    f"{slope[node, row]:.6g}, differences give "
                    f"{0.5 * (low + high)[node, row]:.6g}"
                )
    return ""

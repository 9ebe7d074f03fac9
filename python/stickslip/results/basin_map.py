"""What becomes of many free motions: the basins of their steady states."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from stickslip.checks import constant, whole_number
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.state import State
from stickslip.results.dataset import Stored, labels
from stickslip.results.fate_arrays import FateArrays, Motion, Reason
from stickslip.results.fields import Float, Int
from stickslip.results.result import ColumnResult
from stickslip.settings.motion import BasinSettings


class Outcome(NamedTuple):
    """What some starts lead to."""

    motion: Motion
    """Class of the motion."""
    mode: int | None
    """Stuck mode with the most kinetic energy, counted from 0; None where there is none."""

    def __str__(self) -> str:
        return f"{self.motion}" if self.mode is None else f"{self.motion}, mode {self.mode}"


class BasinMap(ColumnResult):
    """What becomes of many starts; a map of two axes runs through the second axis first."""

    kind: ClassVar[str] = "basin_map"
    title = "What becomes of free motions with dry friction"
    headline = "amplitude"

    settings: BasinSettings
    arrays: FateArrays

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {outcome}" for outcome, count in self.outcomes.items())
        return f"BasinMap({len(self)} starts: {counts})"

    def __len__(self) -> int:
        return self.arrays.reason.size

    @property
    def shape(self) -> tuple[int, ...]:
        """(n_1, n_2) of a map over two axes, (n,) of a list of starts."""
        return tuple(len(values) for _, values in self.settings.axes) or (len(self),)

    @cached_property
    def reason(self) -> tuple[Reason, ...]:
        """Why each motion has its class, start by start."""
        return tuple(map(Reason.from_code, self.arrays.reason.tolist()))

    @cached_property
    def motion(self) -> tuple[Motion, ...]:
        """The class of each motion, start by start."""
        return tuple(reason.motion for reason in self.reason)

    @property
    def mode(self) -> Int:
        """Stuck mode with the most kinetic energy, shape `shape`; -1 where there is none."""
        return self.arrays.mode.reshape(self.shape)

    @property
    def omega(self) -> Float:
        """Angular frequency of settled motions, shape `shape` [rad/s]."""
        return self.arrays.omega.reshape(self.shape)

    @cached_property
    def outcomes(self) -> dict[Outcome, int]:
        """What the starts lead to, and how many of them, the most frequent first."""
        counts = Counter(self._outcomes)
        return dict(counts.most_common())

    @cached_property
    def codes(self) -> Int:
        """Position in `outcomes` of what each start leads to, shape `shape`."""
        places = {outcome: place for place, outcome in enumerate(self.outcomes)}
        codes = np.array([places[one] for one in self._outcomes], dtype=np.int64)
        return constant(codes.reshape(self.shape))

    @property
    def _outcomes(self) -> list[Outcome]:
        modes = self.arrays.mode
        return [
            Outcome(motion, int(mode) if mode >= 0 else None)
            for motion, mode in zip(self.motion, modes, strict=True)
        ]

    def amplitude(self, dof: str) -> Float:
        """Return half the range of a displacement at the end, shape `shape` [m].

        Not-a-number of unbounded motions.
        """
        return self.arrays.amplitude[:, self._column(dof)].reshape(self.shape)

    def start(self, *index: int) -> State:
        """Return a start, ``classify(map.model, map.start(i, j))`` looks at it closely.

        The state at the start.

        Raises ModelError if there is no such start.

        Parameters
        ----------
        *index : int
            Its position: one number in a list, two in a map.
        """
        if len(index) != len(self.shape):
            raise ModelError(f"start: {len(index)} positions; the map has {len(self.shape)} axes")
        for place, size in zip(index, self.shape, strict=True):
            if whole_number(place, "start") >= size:
                raise ModelError(f"start: {place}; there are {size} values, 0 to {size - 1}")
        row = int(np.ravel_multi_index(index, self.shape))
        return State.of_vector(self.model, self.arrays.start[row])

    @classmethod
    def from_dataset(cls, dataset: Stored, model: Model) -> Self:
        """Return the map that a dataset holds."""
        found = super().from_dataset(dataset, model)
        if np.prod(found.shape) != len(found):
            raise ValueError(f"{len(found)} starts do not fill the axes")
        return found

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        motion = labels("start_number", list(self.motion), "class of the motion")
        return {"motion": motion} if derived else {}

    plot = Drawn("basins")

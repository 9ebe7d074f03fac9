"""The store of samples of uncertain parameters, with the quantities that were found of each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

from stickslip.analyses.pattern_store import RowStore, kept
from stickslip.checks import brief


class Sample(NamedTuple):
    """What is found of one sample of the parameters."""

    values: tuple[float, ...]
    """The numbers of the quantity; not-a-number where there is none."""
    errors: tuple[float, ...]
    """What the discarded harmonics could still change; not-a-number: not estimated."""
    status: int
    reason: str
    """Why numbers are missing."""


class SampleStore(RowStore):
    """The results of a study of uncertain parameters."""

    application = 0x53745361  # "StSa"
    study = "a study of uncertain parameters"
    table = "sample"
    kinds = (int, int, float | None, float | None, int, str)
    remedy = "); delete the rows of this sample"
    tables: ClassVar[Mapping[int, set[str]]] = {
        1: {
            "CREATE TABLE identity (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
            """CREATE TABLE sample (
    sample INTEGER NOT NULL, number INTEGER NOT NULL, value REAL, error_estimate REAL,
    status INTEGER NOT NULL, reason TEXT NOT NULL, digest TEXT NOT NULL,
    PRIMARY KEY (sample, number)
) WITHOUT ROWID""",
        }
    }

    def rows(self) -> Iterator[tuple[int, Sample]]:
        """Yield the samples that are there, by their positions."""
        found: dict[int, list[list[Any]]] = {}
        for sample, _, *values in self._values():
            found.setdefault(sample, []).append(values)
        for sample, rows in found.items():
            numbers, errors, statuses, reasons = zip(*rows, strict=True)
            own = tuple(map(_number, numbers)), tuple(map(_number, errors))
            yield sample, Sample(*own, statuses[0], reasons[0])

    def add(self, sample: int, found: Sample) -> None:
        """Keep one sample, with all its numbers or not at all."""
        numbers = zip(found.values, found.errors, strict=True)
        self._keep(
            [
                (sample, number, kept(float(value)), kept(float(error)), found.status, found.reason)
                for number, (value, error) in enumerate(numbers)
            ]
        )

    @classmethod
    def place(cls, values: Sequence[Any]) -> str:
        """Say by its values which row it is."""
        return f"sample {brief(values[0])}"


def _number(value: float | None) -> float:
    return math.nan if value is None else value

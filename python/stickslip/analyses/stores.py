"""The store of samples of uncertain parameters, and stores of any study put together."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from stickslip.analyses.pattern_store import (
    Identity,
    PatternStore,
    RowStore,
    kept,
    looked_at,
    no_store,
)
from stickslip.checks import brief, file_path, is_file, members
from stickslip.errors import ModelError


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


def merge_stores(
    target: str | PathLike[str], sources: Iterable[str | PathLike[str]]
) -> dict[str, int]:
    """Put the rows of several stores of one study together, as runs of its parts made them.

    Parameters
    ----------
    target : path-like
        The store that takes all rows; made if there is none. One that is there may be a part, too.
    sources : iterable of path-like
        The other stores, which are left as they are.

    Returns
    -------
    dict of int
        How many rows each source held.

    Raises
    ------
    ModelError
        If a store is missing, damaged, or of another study.
    """
    files = [file_path(one, "store") for one in members(sources, "sources", "[...]")]
    counts: dict[str, int] = {}
    for file in files:
        if not is_file(file):
            raise ModelError(f"{file}: no such store")
        # A file that is no store is refused by any class of one.
        named = looked_at(file, "SELECT name FROM sqlite_master")
        kind: type[RowStore] = SampleStore if (SampleStore.table,) in named else PatternStore
        same = stored_identity(file)
        with kind(file, same) as source, kind(target, same) as whole:
            counts[str(file)] = whole.take(source)
    return counts


def stored_identity(file: Path) -> Identity:
    """Return what makes the study of a store, or refuse a file that is none."""
    found = dict(looked_at(file, "SELECT name, value FROM identity"))
    try:
        return {name: json.loads(value) for name, value in found.items()}
    except (ValueError, TypeError) as error:
        raise no_store(file, error) from None

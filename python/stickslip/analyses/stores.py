"""Stores of studies that are put together."""

from __future__ import annotations

import json
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from stickslip.analyses.pattern_store import (
    Identity,
    PatternStore,
    RowStore,
    looked_at,
    no_store,
)
from stickslip.analyses.sample_store import SampleStore
from stickslip.checks import file_path, is_file, members
from stickslip.errors import ModelError


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
        kind, same = _stored_kind(file), stored_identity(file)
        with kind(file, same) as source, kind(target, same) as whole:
            counts[str(file)] = whole.take(source)
    return counts


def _stored_kind(file: Path) -> type[RowStore]:
    """Return the class of a store; of a file that is none, any, which refuses it."""
    named = looked_at(file, "SELECT name FROM sqlite_master")
    return SampleStore if (SampleStore.table,) in named else PatternStore


def stored_identity(file: Path) -> Identity:
    """Return what makes the study of a store, or refuse a file that is none."""
    found = dict(looked_at(file, "SELECT name, value FROM identity"))
    try:
        return {name: json.loads(value) for name, value in found.items()}
    except (ValueError, TypeError) as error:
        raise no_store(file, error) from None

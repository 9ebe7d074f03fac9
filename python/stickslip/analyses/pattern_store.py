"""The file in which the results of a mistuning study are kept as they come.

It is an SQLite data base: a row is there whole or not at all, whatever ends the program.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
from collections.abc import Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, file_path, is_file
from stickslip.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["Identity", "Key", "PatternStore", "Row", "digest"]

FORMAT = 1
"""Version of the tables; it rises when an older reader could not read them."""

_APPLICATION = 0x53744D69
"""Marks the data bases that are ours, "StMi"."""

Identity: TypeAlias = Mapping[str, object]
"""What makes a study, by name, in plain values."""


class Key(NamedTuple):
    """What a row belongs to."""

    deviation: float
    """Standard deviation of the pattern."""
    coupling: float
    """Stiffness of the couplings; not-a-number: as the disk has them."""
    pattern: int
    """Position of the pattern."""


class Row(NamedTuple):
    """What is found of one degree of freedom, as the compiled core hands it over."""

    omega: float
    amplitude: float
    blade: int
    status: int
    harmonics: int
    error_estimate: float
    at_edge: bool


_TABLES = """
CREATE TABLE identity (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE summit (
    deviation REAL NOT NULL, coupling TEXT NOT NULL, pattern INTEGER NOT NULL, dof INTEGER NOT NULL,
    omega REAL, amplitude REAL, blade INTEGER NOT NULL, status INTEGER NOT NULL,
    harmonics INTEGER NOT NULL, error_estimate REAL, at_edge INTEGER NOT NULL,
    points INTEGER NOT NULL,
    PRIMARY KEY (deviation, coupling, pattern, dof)
) WITHOUT ROWID;
"""


class PatternStore:
    """The results of a study, in a file.

    Parameters
    ----------
    path : path-like
        The file; it is made if there is none.
    identity : mapping
        What makes the study; a file of another one is refused.

    Raises
    ------
    ModelError
        If the file holds another study, is of a newer format, damaged, no store, or cannot be
        written.
    """

    def __init__(self, path: object, identity: Identity) -> None:
        self.path = file_path(path, "store")
        is_file(self.path)
        if not self.path.parent.is_dir():
            raise ModelError(f"{self.path}: there is no folder {self.path.parent}; create it first")
        with self._named():
            self._base = sqlite3.connect(self.path, isolation_level=None, timeout=30.0)
        try:
            with self._named():
                self._open({name: json.dumps(value) for name, value in identity.items()})
        except BaseException:
            self._base.close()
            raise

    def __enter__(self) -> PatternStore:
        return self

    def __exit__(self, *_: object) -> None:
        self._base.close()

    def rows(self) -> Iterator[tuple[Key, int, Row, int]]:
        """Yield what is there: what it belongs to, the DOF, the row, and the solutions it took."""
        with self._named():
            found = self._base.execute(
                "SELECT deviation, coupling, pattern, dof, omega, amplitude, blade, status, "
                "harmonics, error_estimate, at_edge, points FROM summit"
            ).fetchall()
        for deviation, coupling, pattern, dof, *numbers, at_edge, points in found:
            omega, amplitude, blade, status, harmonics, error = numbers
            key = Key(deviation, float.fromhex(coupling), pattern)
            real = (math.nan if value is None else value for value in (omega, amplitude, error))
            omega, amplitude, error = real
            row = Row(omega, amplitude, blade, status, harmonics, error, bool(at_edge))
            yield key, dof, row, points

    def add(self, key: Key, rows: Sequence[Row], points: int) -> None:
        """Keep the rows of one pattern, one per DOF, together or not at all."""
        values = [
            (
                key.deviation,
                float(key.coupling).hex(),
                key.pattern,
                dof,
                *(None if isinstance(one, float) and math.isnan(one) else one for one in row),
                points,
            )
            for dof, row in enumerate(rows)
        ]
        marks = ", ".join("?" * 12)
        with self._named():
            self._base.execute("BEGIN IMMEDIATE")
            self._base.executemany(f"INSERT OR REPLACE INTO summit VALUES ({marks})", values)
            self._base.execute("COMMIT")

    def _open(self, identity: Mapping[str, str]) -> None:
        self._base.execute("PRAGMA synchronous = NORMAL")
        self._base.execute("BEGIN IMMEDIATE")
        if not self._base.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
            for statement in _TABLES.split(";"):
                self._base.execute(statement)
            self._base.execute(f"PRAGMA application_id = {_APPLICATION}")
            self._base.execute(f"PRAGMA user_version = {FORMAT}")
            self._base.executemany("INSERT INTO identity VALUES (?, ?)", identity.items())
            self._base.execute("COMMIT")
            return
        self._base.execute("COMMIT")
        self._require_ours()
        self._require_same(dict(self._base.execute("SELECT name, value FROM identity")), identity)

    def _require_ours(self) -> None:
        if self._base.execute("PRAGMA application_id").fetchone()[0] != _APPLICATION:
            raise ModelError(
                f"{self.path}: is no store of a mistuning study; give another name, nothing was "
                "changed"
            )
        version = self._base.execute("PRAGMA user_version").fetchone()[0]
        if version != FORMAT:
            raise ModelError(
                f"{self.path}: a store of format {version}, this version of stickslip reads format "
                f"{FORMAT}; upgrade stickslip, or give another store"
            )
        said = self._base.execute("PRAGMA quick_check").fetchone()[0]
        if said != "ok":
            raise sqlite3.DatabaseError(str(said).splitlines()[-1])

    def _require_same(self, there: Mapping[str, str], here: Mapping[str, str]) -> None:
        names = [name for name in {**here, **there} if there.get(name) != here.get(name)]
        if not names:
            return
        told = [
            f"{name} is {_shown(there.get(name))} there and {_shown(here.get(name))} here"
            for name in names
        ]
        raise ModelError(
            f"{self.path}: holds another study ({', '.join(told)}); give another store, "
            "remove it, or run the same study"
        )

    @contextmanager
    def _named(self) -> Iterator[None]:
        """Turn what the data base complains of into one line."""
        try:
            yield
        except sqlite3.OperationalError as error:
            raise ModelError(
                f"{self.path}: cannot be used as a store ({error}); see that it can be written and "
                "that no other program holds it"
            ) from None
        except sqlite3.DatabaseError as error:
            raise ModelError(
                f"{self.path}: no store, or a damaged one ({error}); give another name, or remove "
                "it to begin anew"
            ) from None


def digest(*arrays: NDArray[np.generic]) -> str:
    """Return a text that tells arrays from others, whatever the machine."""
    mark = hashlib.sha256()
    for array in arrays:
        mark.update(str(array.shape).encode())
        mark.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return mark.hexdigest()[:16]


def _shown(text: str | None) -> str:
    return "missing" if text is None else brief(json.loads(text))

"""The file in which the results of a study are kept as they come, and that of a mistuning study.

It is an SQLite data base: a row is there whole or not at all, whatever ends the program. Every row
carries a digest of itself and of its study, so that a row that was changed is no row.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep
from typing import Any, ClassVar, NamedTuple, Self, TypeAlias
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, file_path, is_file
from stickslip.errors import ModelError
from stickslip.files import require_place

FORMAT = 2
"""Version of the tables; it rises when an older reader could not read them. 1 had no digests."""

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


_IDENTITY = "CREATE TABLE identity (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"
_SUMMIT = """CREATE TABLE summit (
    deviation REAL NOT NULL, coupling TEXT NOT NULL, pattern INTEGER NOT NULL, dof INTEGER NOT NULL,
    omega REAL, amplitude REAL, blade INTEGER NOT NULL, status INTEGER NOT NULL,
    harmonics INTEGER NOT NULL, error_estimate REAL, at_edge INTEGER NOT NULL,
    points INTEGER NOT NULL,{}
    PRIMARY KEY (deviation, coupling, pattern, dof)
) WITHOUT ROWID"""
_TABLES = {
    1: {_IDENTITY, _SUMMIT.format("")},
    FORMAT: {_IDENTITY, _SUMMIT.format(" digest TEXT NOT NULL,")},
}
"""What makes the tables of each format."""

_KINDS = (
    *(float, str, int, int),
    *(float | None, float | None, int, int),
    *(int, float | None, int),
    int,
)
"""Of the columns but the digest."""

# Seconds to wait for a file that another program holds, and between two looks.
_PATIENCE = 30.0
_PAUSE = 0.05
_HELD = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)

_REMEDIES = {
    sqlite3.SQLITE_FULL: "make room there",
    sqlite3.SQLITE_IOERR: "make room there, or check the disk",
    sqlite3.SQLITE_READONLY: "see that it can be written",
    sqlite3.SQLITE_CANTOPEN: "see that it can be written",
    sqlite3.SQLITE_PERM: "see that it can be written",
    sqlite3.SQLITE_BUSY: "see that no other program holds it",
    sqlite3.SQLITE_LOCKED: "see that no other program holds it",
    sqlite3.SQLITE_NOMEM: "free memory",
}
"""What to do where the file itself is not at fault."""


class RowStore(ABC):
    """The results of a study, in a file; a kind of study names its table.

    The file is made if there is none. Refused is one of another study, of a newer format, damaged,
    no store, or that cannot be written. `look` is called several times per second while another
    program holds the file; it may raise.
    """

    application: ClassVar[int]
    """Marks the data bases of the kind."""
    study: ClassVar[str]
    """What the kind of study is called."""
    table: ClassVar[str]
    """Name of the table of the rows."""
    kinds: ClassVar[tuple[Any, ...]]
    """Types of its columns but the digest."""
    remedy: ClassVar[str]
    """What to do about a row that was changed."""
    tables: ClassVar[Mapping[int, set[str]]]
    """What makes the tables of each format, the newest last."""

    def __init__(
        self, path: object, identity: Identity, look: Callable[[], None] = lambda: None
    ) -> None:
        self._look = look
        self.path = file_path(path, "store")
        is_file(self.path)
        require_place(self.path)
        given = {name: json.dumps(value) for name, value in identity.items()}
        self._key = hashlib.blake2b(json.dumps(sorted(given.items())).encode()).digest()
        with self._named():
            self._base = sqlite3.connect(self.path, isolation_level=None, timeout=0.0)
        try:
            # Text that is none is shown, and differs from what is expected.
            self._base.text_factory = lambda text: text.decode(errors="replace")
            with self._named():
                self._open(given)
        except BaseException:
            self._base.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._base.close()

    @classmethod
    @abstractmethod
    def place(cls, values: Sequence[Any]) -> str:
        """Say by its values which row it is."""

    def take(self, other: RowStore) -> int:
        """Take over the rows of another store of the same study; return how many."""
        found = list(other._values())
        self._keep(found)
        return len(found)

    def _values(self) -> Iterator[list[Any]]:
        """Yield the values of all rows but their digests, which are right."""
        with self._named():
            found = self._execute(f"SELECT * FROM {self.table}").fetchall()
        for *values, mark in found:
            if mark != self._digest(values):
                raise self._damaged(values, "its digest differs")
            yield values

    def _keep(self, found: Sequence[Sequence[object]]) -> None:
        """Keep rows together or not at all."""
        with self._named(), self._transaction():
            self._insert(found)

    def _damaged(self, values: Sequence[Any], cause: str) -> ModelError:
        """Return the error that names a row which cannot be right."""
        return ModelError(
            f"{self.path}: the row of {self.place(values)} is damaged ({cause}{self.remedy} to "
            "compute it again, or remove the file to begin anew"
        )

    def _insert(self, found: Sequence[Sequence[object]]) -> None:
        marks = ", ".join("?" * (len(self.kinds) + 1))
        self._base.executemany(
            f"INSERT OR REPLACE INTO {self.table} VALUES ({marks})",
            [(*values, self._digest(values)) for values in found],
        )

    def _digest(self, values: Sequence[object]) -> str:
        """Return a text that tells a row of this study from all others."""
        # Python writes every number so that it comes back bit by bit.
        row = repr(tuple(values)).encode()
        return hashlib.blake2b(row, digest_size=16, key=self._key).hexdigest()

    def _open(self, identity: Mapping[str, str]) -> None:
        self._execute("PRAGMA synchronous = NORMAL")
        with self._transaction():
            if not self._execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                for statement in sorted(self.tables[self._newest()]):
                    self._execute(statement)
                self._execute(f"PRAGMA application_id = {self.application}")
                self._execute(f"PRAGMA user_version = {self._newest()}")
                self._base.executemany("INSERT INTO identity VALUES (?, ?)", identity.items())
                return
        version = self._required_format()
        self._require_same(dict(self._execute("SELECT name, value FROM identity")), identity)
        self._update(version)

    @classmethod
    def _newest(cls) -> int:
        return max(cls.tables)

    def _update(self, version: int) -> None:  # noqa: B027 (most have one format)
        """Bring a store of an older format to the newest."""

    def _required_format(self) -> int:
        if self._execute("PRAGMA application_id").fetchone()[0] != self.application:
            raise ModelError(
                f"{self.path}: is no store of {self.study}; give another name, nothing was changed"
            )
        version: int = self._execute("PRAGMA user_version").fetchone()[0]
        if version not in self.tables:
            raise ModelError(
                f"{self.path}: a store of format {version}, this version of stickslip reads format "
                f"1 to {self._newest()}; upgrade stickslip, or give another store"
            )
        there = {row[0] for row in self._execute("SELECT sql FROM sqlite_master")}
        if there != self.tables[version]:
            raise sqlite3.DatabaseError("its tables are not those of a store")
        said = self._execute("PRAGMA quick_check").fetchone()[0]
        if said != "ok":
            raise sqlite3.DatabaseError(str(said).splitlines()[-1])
        return version

    def _execute(self, statement: str) -> sqlite3.Cursor:
        """Execute a statement as soon as no other program holds the file."""
        end = monotonic() + _PATIENCE
        while True:
            try:
                return self._base.execute(statement)
            except sqlite3.OperationalError as error:
                held = error.sqlite_errorcode & 0xFF in _HELD
                if not held or monotonic() > end:
                    raise
            # SQLite's own waiting would be deaf to signals.
            self._look()
            sleep(_PAUSE)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        """Let all of it be done, or nothing."""
        self._execute("BEGIN IMMEDIATE")
        try:
            yield
            self._execute("COMMIT")
        except BaseException:
            # A disk that refuses a write may have ended the transaction already.
            if self._base.in_transaction:
                self._execute("ROLLBACK")
            raise

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
        except (sqlite3.Error, UnicodeError) as error:
            # A damaged schema may be quoted in the message, which then is no text.
            cause = " ".join(str(error).split())
            remedy = _REMEDIES.get(getattr(error, "sqlite_errorcode", 0) & 0xFF)
            if remedy is not None:
                raise ModelError(
                    f"{self.path}: cannot be used as a store ({cause}); {remedy}"
                ) from None
            raise ModelError(
                f"{self.path}: no store, or a damaged one ({cause}); give another name, or remove "
                "it to begin anew"
            ) from None


class PatternStore(RowStore):
    """The results of a mistuning study."""

    application = _APPLICATION
    study = "a mistuning study"
    table = "summit"
    kinds = _KINDS
    remedy = "); delete the rows of this pattern"
    tables = _TABLES

    def rows(self) -> Iterator[tuple[Key, int, Row, int]]:
        """Yield what is there: what it belongs to, the DOF, the row, and the solutions it took."""
        for deviation, coupling, pattern, dof, *numbers, points in self._values():
            yield Key(deviation, float.fromhex(coupling), pattern), dof, _row(numbers), points

    def add(self, key: Key, rows: Sequence[Row], points: int) -> None:
        """Keep the rows of one pattern, one per DOF, together or not at all."""
        self._keep(
            [
                (
                    key.deviation,
                    float(key.coupling).hex(),
                    key.pattern,
                    dof,
                    *map(kept, row),
                    points,
                )
                for dof, row in enumerate(rows)
            ]
        )

    @classmethod
    def place(cls, values: Sequence[Any]) -> str:
        """Say by its values which row it is."""
        return f"deviation {brief(values[0])}, pattern {brief(values[2])}"

    def damaged(self, deviation: object, pattern: object, cause: str) -> ModelError:
        """Return the error that names a row which cannot be right."""
        return self._damaged((deviation, None, pattern), cause)

    def _update(self, version: int) -> None:
        """Bring a store of the first format, whose rows have no digest, to this one."""
        if version == FORMAT:
            return
        with self._transaction():
            found = self._execute("SELECT * FROM summit").fetchall()
            for values in found:
                kinds = zip(values, _KINDS, strict=True)
                if not all(isinstance(value, kind) for value, kind in kinds):
                    raise self._damaged(values, "not a number in every column")
                try:
                    float.fromhex(values[1])
                except (ValueError, OverflowError):
                    raise self._damaged(values, "its coupling is no number") from None
            self._execute("DROP TABLE summit")
            for statement in _TABLES[FORMAT] - _TABLES[1]:
                self._execute(statement)
            self._insert(found)
            self._execute(f"PRAGMA user_version = {FORMAT}")


def looked_at(file: Path, statement: str) -> list[Any]:
    """Return what a query finds in a file that is left as it is."""
    try:
        base = sqlite3.connect(f"file:{quote(str(file.resolve()))}?mode=ro", uri=True)
        try:
            return base.execute(statement).fetchall()
        finally:
            base.close()
    except sqlite3.Error as error:
        raise no_store(file, error) from None


def no_store(file: Path, error: Exception) -> ModelError:
    """Return the error that refuses a file which is no store."""
    cause = " ".join(str(error).split())
    return ModelError(f"{file}: no store, or a damaged one ({cause})")


def kept(value: float) -> float | None:
    """Return a number as SQLite gives it back: no not-a-number, no truth value, no -0."""
    if isinstance(value, float):
        return None if math.isnan(value) else float(value) + 0.0
    return int(value)


def _row(numbers: Sequence[Any]) -> Row:
    *values, at_edge = (math.nan if value is None else value for value in numbers)
    return Row(*values, bool(at_edge))  # type: ignore[call-arg, arg-type]


def digest(*arrays: NDArray[np.generic]) -> str:
    """Return a text that tells arrays from others, whatever the machine."""
    mark = hashlib.sha256()
    for array in arrays:
        mark.update(str(array.shape).encode())
        mark.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return mark.hexdigest()[:16]


def _shown(text: object) -> str:
    if text is None:
        return "missing"
    try:
        return brief(json.loads(text))  # type: ignore[arg-type]
    except (TypeError, ValueError, RecursionError):
        return brief(text)

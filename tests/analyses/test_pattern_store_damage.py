"""Stores of mistuning studies that were damaged by hand, or that a disk refuses to take."""

import random
import sqlite3
from contextlib import closing

import pytest
from test_pattern_store import PATTERNS, small, stored

import stickslip as ss
from mutations import mutated
from stickslip.analyses import pattern_store


def ended(store, **options):
    """Return the study, and the message with which it ended if it did not end well."""
    try:
        return small(store, **options), None
    except ss.ModelError as error:
        return None, str(error)


def change(store, *statements):
    with closing(sqlite3.connect(store)) as base:
        for statement in statements:
            base.execute(statement)
        base.commit()


def first_version(store):
    """Bring a store to the format of the first version, without digests."""
    change(
        store,
        "CREATE TABLE kept AS SELECT * FROM summit",
        "DROP TABLE summit",
        pattern_store._SUMMIT.format(""),
        "INSERT INTO summit SELECT deviation, coupling, pattern, dof, omega, amplitude, blade, "
        "status, harmonics, error_estimate, at_edge, points FROM kept",
        "DROP TABLE kept",
        "PRAGMA user_version = 1",
    )


def assert_refused(store, message):
    before = store.read_bytes()
    with pytest.raises(ss.ModelError) as caught:
        small(store)
    (line,) = str(caught.value).splitlines()
    assert line.startswith(f"{store}: ")
    assert message in line
    return before


DAMAGE = {
    "omega = -5": "omega is -5, outside 150 to 260",
    "omega = 300.0": "omega is 300, outside 150 to 260",
    "blade = 99999": "blade is 99999, outside 0 to 5",
    "blade = -1": "blade is -1, outside 0 to 5",
    "amplitude = -1": "amplitude is -1, outside",
    "amplitude = 1e999": "amplitude is inf, outside",
    "amplitude = 0": "amplitude is 0, outside",
    "status = 77": f"status is 77, outside 0 to {len(ss.Status) - 1}",
    "harmonics = 4": "harmonics is 4, outside 0 to 3",
    "amplitude = NULL": "it is converged, and its numbers are not",
    "status = 1": "it is stalled, and its numbers are not",
    "harmonics = 0": "it is converged, and its numbers are not",
    "error_estimate = -1e-9": "error_estimate is -1e-09, outside 0 to inf",
    "dof = 2": "dof is 2, outside 0 to 1",
    "pattern = -1": "pattern is -1, outside 0 to inf",
    "points = -1": "points is -1, outside",
    "omega = 'two hundred'": "not a number in every column",
    "omega = x'ff00'": "not a number in every column",
    "coupling = 'stiff'": "its coupling is no number",
    "coupling = x'ff'": "not a number in every column",
}


@pytest.mark.parametrize("changed", [*DAMAGE, "amplitude = 1e308", "points = 7", "at_edge = 1"])
def test_a_row_changed_by_hand_is_refused_by_its_digest(tmp_path, changed):
    store = tmp_path / "study.db"
    small(store)
    change(store, f"UPDATE summit SET {changed} WHERE pattern = 1 AND dof = 0")
    before = assert_refused(store, "is damaged (its digest differs); delete the rows of this pat")
    assert store.read_bytes() == before


@pytest.mark.slow
@pytest.mark.parametrize("changed", DAMAGE)
def test_rows_of_the_first_version_are_checked_by_value(tmp_path, changed):
    store = tmp_path / "study.db"
    small(store)
    first_version(store)
    change(store, f"UPDATE summit SET {changed} WHERE pattern = 1 AND dof = 0")
    assert_refused(store, DAMAGE[changed])
    # Refused once, it is not believed the next time.
    assert_refused(store, DAMAGE[changed])


def test_a_store_of_the_first_version_goes_on(tmp_path):
    store = tmp_path / "study.db"
    first = small(store)
    first_version(store)
    again = small(store, patterns=4)
    assert again.amplitude("tip")[..., :3].tobytes() == first.amplitude("tip").tobytes()
    assert again.counters["disks"] == 4
    change(store, "UPDATE summit SET amplitude = 1e-4 WHERE pattern = 2 AND dof = 1")
    assert_refused(store, "pattern 2 is damaged (its digest differs)")


def test_a_deleted_row_is_computed_again(tmp_path):
    store = tmp_path / "study.db"
    whole = small(store)
    change(store, "DELETE FROM summit WHERE pattern = 1 AND dof = 1")
    again = small(store)
    assert again.amplitude("tip").tobytes() == whole.amplitude("tip").tobytes()
    assert again.counters == whole.counters
    assert (again.arrays.status == 0).all()


def test_a_row_of_another_study_is_no_row_of_this_one(tmp_path):
    store, other = tmp_path / "study.db", tmp_path / "other.db"
    small(store)
    small(other, seed=2)
    change(
        store,
        f"ATTACH '{other}' AS other",
        "INSERT OR REPLACE INTO summit SELECT * FROM other.summit WHERE pattern = 0",
    )
    assert_refused(store, "pattern 0 is damaged (its digest differs)")


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("UPDATE identity SET value = '{'", "holds another study (version is '{' there and "),
        ("UPDATE identity SET value = x'ff7b'", "holds another study (version is "),
        ("UPDATE identity SET value = '[' || value", "holds another study (version is "),
        ("DELETE FROM identity", "holds another study (version is missing there and "),
        ("DROP TABLE identity", "a damaged one (its tables are not those of a store)"),
        ("ALTER TABLE summit DROP COLUMN at_edge", "its tables are not those of a store"),
        ("CREATE TRIGGER t AFTER INSERT ON summit BEGIN SELECT 1; END", "its tables are not"),
    ],
)
def test_a_store_with_other_tables_is_refused(tmp_path, statement, message):
    store = tmp_path / "study.db"
    small(store)
    change(store, statement)
    assert_refused(store, message)


@pytest.mark.slow
def test_mutated_stores_are_as_they_were_or_refused(tmp_path):
    store, chance = tmp_path / "study.db", random.Random(7)
    whole = small(store)
    first = store.read_bytes()
    ends = {"same": 0, "refused": 0}
    for _ in range(60):
        store.write_bytes(mutated(first, chance))
        again, line = ended(store)
        ends["same" if line is None else "refused"] += 1
        if line is not None:
            assert "\n" not in line
            continue
        for name in ("omega", "amplitude", "blade", "status", "harmonics", "error_estimate"):
            mine, theirs = (getattr(one.arrays, name) for one in (again, whole))
            assert mine.tobytes() == theirs.tobytes(), name
    assert min(ends.values()) > 5


# ------------------------------------------------------------------------------- refusing disks


def full_after(pages, monkeypatch):
    """Let a data base grow to so many pages of 4096 bytes, as on a full disk."""
    connect = sqlite3.connect

    def narrow(*arguments, **options):
        base = connect(*arguments, **options)
        base.execute(f"PRAGMA max_page_count = {pages}")
        return base

    monkeypatch.setattr(pattern_store.sqlite3, "connect", narrow)


@pytest.mark.slow
@pytest.mark.parametrize("pages", [2, 4, 6])
def test_a_full_disk_keeps_what_is_stored(tmp_path, monkeypatch, pages):
    store = tmp_path / "study.db"
    with monkeypatch.context() as patch:
        full_after(pages, patch)
        _, line = ended(store, patterns=PATTERNS)
    assert line.startswith(
        f"{store}: cannot be used as a store (database or disk is full); make room there"
    )
    assert "\n" not in line
    kept = stored(store)
    assert bool(kept) is (pages > 2)
    if kept:
        assert line.endswith(
            f"; {len(kept)} of 250 disks are stored, run again to go on from there"
        )
    again, unbroken = small(store, patterns=20), small(None, patterns=20)
    assert again.amplitude("tip").tobytes() == unbroken.amplitude("tip").tobytes()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "text", "remedy"),
    [
        (sqlite3.SQLITE_IOERR, "disk I/O error", "make room there, or check the disk"),
        (sqlite3.SQLITE_READONLY, "attempt to write a readonly database", "see that it can be wri"),
        (sqlite3.SQLITE_BUSY, "database is locked", "see that no other program holds it"),
    ],
)
def test_a_failing_disk_keeps_what_is_stored(tmp_path, monkeypatch, code, text, remedy):
    """Every statement fails in turn; what was stored before it stays, and is gone on from."""
    connect, unbroken = sqlite3.connect, small(None)
    monkeypatch.setattr(pattern_store, "_PATIENCE", 0.0)
    for allowed in range(40):
        calls = iter(range(allowed))

        class Failing(sqlite3.Connection):
            def fail(self, calls=calls):
                if next(calls, None) is None:
                    error = sqlite3.OperationalError(text)
                    error.sqlite_errorcode = code
                    raise error

            def execute(self, statement, *rest):
                if statement != "ROLLBACK":
                    self.fail()
                return super().execute(statement, *rest)

            def executemany(self, *rest):
                self.fail()
                return super().executemany(*rest)

        store = tmp_path / f"{allowed}.db"
        with monkeypatch.context() as patch:
            patch.setattr(
                pattern_store.sqlite3,
                "connect",
                lambda *a, factory=Failing, **o: connect(*a, factory=factory, **o),
            )
            _, line = ended(store)
        if line is None:
            break
        assert f"cannot be used as a store ({text}); {remedy}" in line
        assert "\n" not in line
        kept = stored(store)
        assert not kept or f"{len(kept)} of 3 disks are stored" in line
        assert small(store).amplitude("tip").tobytes() == unbroken.amplitude("tip").tobytes()
    assert 15 < allowed < 39

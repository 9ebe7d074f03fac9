"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from stickslip.checks import is_reserved
from stickslip.errors import ModelError

__all__ = ["whole"]

_STALE = 3600.0
"""Seconds after which a file without the number of its process is nobody's: writing takes less."""


@contextmanager
def whole(target: Path) -> Iterator[Path]:
    """Let a file be written beside its target, and put it there once it is complete.

    Parameters
    ----------
    target : Path
        The file; an existing one is replaced.

    Yields
    ------
    Path
        What to write instead.

    Raises
    ------
    ModelError
        If the folder does not exist or the file cannot be written; then nothing is changed.
    """
    if target.is_dir():
        raise ModelError(f"{target}: is a folder; give the name of a file in it")
    if not target.parent.is_dir():
        raise ModelError(f"{target}: there is no folder {target.parent}; create it first")
    if is_reserved(target.name):
        raise ModelError(f"{target}: is the name of a device on Windows; give another name")
    _remove_leftovers(target)
    temporary = target.with_name(f".{target.name}.{os.getpid()}-{secrets.token_hex(4)}.part")
    try:
        yield temporary
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        temporary.replace(target)
    except OSError as error:
        raise ModelError(
            f"{target}: cannot be written ({error.strerror or error}); nothing was changed"
        ) from error
    finally:
        with suppress(FileNotFoundError):
            temporary.unlink()


def _remove_leftovers(target: Path) -> None:
    """Remove the unfinished files of processes that were killed while they wrote the target."""
    name = re.compile(rf"\.{re.escape(target.name)}\.(?:(\d+)-)?[0-9a-f]{{8}}\.part")
    with suppress(OSError):
        for left in target.parent.iterdir():
            if (found := name.fullmatch(left.name)) and not _written_now(left, found[1]):
                with suppress(OSError):
                    left.unlink()


def _written_now(left: Path, process: str | None) -> bool:
    """Return whether another process, or another thread of this one, writes the file."""
    if process is None:
        with suppress(OSError):
            return time.time() - left.stat().st_mtime < _STALE
        return True
    if os.name == "nt":
        return False  # what is open cannot be removed there
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        pass
    return True

"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from stickslip.errors import ModelError

__all__ = ["whole"]


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
    temporary = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
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

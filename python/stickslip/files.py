"""Files are written whole or not at all.

Every file of the package is written here, except the stores of mistuning studies, which SQLite
writes. The content is made in memory first: HDF5, for one, crashes when a disk refuses its bytes.
"""

from __future__ import annotations

import errno
import os
import platform
import re
import secrets
import stat
import time
import zlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from stickslip.checks import is_reserved
from stickslip.errors import ModelError

_MARK, _END = ".stickslip-", ".part"
_HOST = f"{zlib.crc32(platform.node().encode()):08x}"
_TEMPORARY = re.compile(
    rf"(?:{re.escape(_MARK)}([0-9a-f]{{8}})-(\d{{1,9}})-|\..+\.)[0-9a-f]{{8}}{re.escape(_END)}"
)
"""Also as the first version named them, without host and process."""
_PART = 1 << 26
"""Bytes that are written, and seen onto the disk, between two looks at signals."""
_STALE = 3600.0
"""Seconds after which a temporary file is one of a killed run: bytes take seconds to be written."""

_FULL = "make room there, or choose another place"
_CLOSED = "choose a place that can be written"
_REMEDIES = {
    errno.ENOSPC: _FULL,
    errno.EDQUOT: _FULL,
    errno.EFBIG: _FULL,
    errno.EROFS: _CLOSED,
    errno.EACCES: _CLOSED,
    errno.EPERM: _CLOSED,
    errno.EEXIST: "name a folder, not a file",
    errno.ENOTDIR: "name a folder, not a file",
    errno.ENAMETOOLONG: "choose a shorter name",
}


def write(
    target: Path,
    content: bytes | bytearray | memoryview,
    look: Callable[[], None] = lambda: None,
) -> None:
    """Write a file whole, or leave everything as it was; an existing one is replaced.

    What `look` raises now and then ends it.
    """
    require_place(target)
    temporary = _beside(target)
    try:
        _write_anew(temporary, memoryview(content).cast("B"), look)
        os.replace(temporary, target)
    except OSError as error:
        raise refusal(target, "cannot be written", error) from error
    finally:
        with suppress(OSError):
            os.unlink(temporary)
    _remove_stale(target.parent)


def require_place(target: Path) -> None:
    """Refuse a file that could not be written because of what is or is not there.

    That is a folder or a device as target, or a folder that does not exist.
    """
    if os.path.isdir(target):
        raise ModelError(f"{target}: is a folder; give the name of a file in it")
    if not os.path.isdir(target.parent):
        raise ModelError(f"{target}: there is no folder {target.parent}; create it first")
    if is_reserved(target.name):
        raise ModelError(f"{target}: is the name of a device on Windows; give another name")
    with suppress(OSError):
        # A device would be replaced by a file.
        if not stat.S_ISREG(os.stat(target).st_mode):
            raise ModelError(f"{target}: is no regular file; give the name of a file")


def make_folder(folder: Path) -> None:
    """Make a folder and those above it, unless they are there."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise refusal(folder, "cannot be made", error) from error


def require_writable(folder: Path) -> None:
    """Refuse a folder in which no file can be made; better now than when all is computed."""
    probe = _beside(folder / "probe")
    try:
        _write_anew(probe, memoryview(b""), lambda: None)
    except OSError as error:
        raise refusal(folder, "cannot be written to", error) from error
    finally:
        with suppress(OSError):
            os.unlink(probe)


def refusal(path: Path, fault: str, error: OSError) -> ModelError:
    """Return the error that says why a disk refuses a file or folder."""
    cause = error.strerror or str(error) or type(error).__name__
    remedy = _REMEDIES.get(error.errno or 0, "check the disk, or choose another place")
    return ModelError(f"{path}: {fault} ({cause}); {remedy}")


def _beside(target: Path) -> Path:
    """Return a name that no other file of the folder has, whatever the length of the target's."""
    return target.with_name(f"{_MARK}{_HOST}-{os.getpid()}-{secrets.token_hex(4)}{_END}")


def _write_anew(file: Path, content: memoryview, look: Callable[[], None]) -> None:
    """Write bytes to a new file, and see them onto the disk."""
    # O_BINARY: Windows would translate the ends of lines.
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    handle = os.open(file, flags, 0o666)
    try:
        while content:
            look()
            count = os.write(handle, content[:_PART])
            if count == 0:
                raise OSError(errno.EIO, os.strerror(errno.EIO))
            content = content[count:]
            os.fsync(handle)
    finally:
        os.close(handle)


def _remove_stale(folder: Path) -> None:
    """Remove what killed runs have left in a folder."""
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            found = _TEMPORARY.fullmatch(entry.name)
            with suppress(OSError):
                if found and _is_stale(entry, *found.groups()):
                    os.unlink(entry.path)


def _is_stale(entry: os.DirEntry[str], host: str | None, process: str | None) -> bool:
    """Return whether the process that wrote a temporary file is gone, as far as one can tell."""
    if time.time() - entry.stat().st_mtime > _STALE:
        return True
    if process is None or host != _HOST or os.name == "nt":
        return False
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return True
    except OSError:
        pass
    return False

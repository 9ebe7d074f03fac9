"""A disk that refuses, played by the calls of the system, which fail for temporary files alone."""

import os


class Disk:
    """Takes the place of the calls of the system that write a file, and fails as it is told.

    Parameters
    ----------
    monkeypatch : pytest.MonkeyPatch
        Puts everything back.
    fails : dict of int
        Error number by name of the call: open, write, fsync, close, replace.
    room : int, optional
        Bytes that are taken before writing fails.
    most : int, optional
        Bytes that one call takes once it fails.
    after : int, optional
        Files that are written well before.
    """

    def __init__(self, monkeypatch, fails, *, room=0, most=2**30, after=0):
        self.fails, self.room, self.most, self.after = fails, room, most, after
        self.handles, self.contents, self.written = set(), [], 0
        self.calls = {name: getattr(os, name) for name in ("open", "write", "fsync", "close")}
        self.calls["replace"] = os.replace
        for name in self.calls:
            monkeypatch.setattr(os, name, getattr(self, name))

    def fail(self, name):
        if name in self.fails and self.after <= 0:
            raise OSError(self.fails[name], os.strerror(self.fails[name]))

    def open(self, path, flags, *rest, **options):
        if ".stickslip-" not in str(path):
            return self.calls["open"](path, flags, *rest, **options)
        self.fail("open")
        handle = self.calls["open"](path, flags, *rest, **options)
        self.handles.add(handle)
        self.contents.append(b"")
        return handle

    def write(self, handle, content):
        if handle not in self.handles:
            return self.calls["write"](handle, content)
        if len(content) > self.room or "write" not in self.fails:
            if not self.room:
                self.fail("write")
            most = self.most if self.after <= 0 else len(content)
            content = content[: min(most, self.room or most)]
        count = self.calls["write"](handle, content)
        self.room = max(self.room - count, 0)
        self.contents[-1] += bytes(content[:count])
        return count

    def fsync(self, handle):
        if handle in self.handles:
            self.fail("fsync")
        self.calls["fsync"](handle)

    def close(self, handle):
        self.calls["close"](handle)
        if handle in self.handles:
            self.handles.remove(handle)
            self.fail("close")

    def replace(self, source, target):
        if ".stickslip-" in str(source):
            self.fail("replace")
            self.after -= 1
        self.calls["replace"](source, target)
        self.written += ".stickslip-" in str(source)


def names(folder):
    return sorted(entry.name for entry in folder.iterdir())

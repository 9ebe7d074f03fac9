"""What a signal ends before anything is there to save."""

from __future__ import annotations

import os
from types import FrameType

STOPPED = 128
"""Exit code of a run that a signal has ended, beside the signal's number."""


def leave(number: int, _: FrameType | None) -> None:
    """End the program: modules that are half loaded hand no exception on."""
    try:
        # Not by a stream, whose lock may be held where the signal came.
        os.write(2, b"interrupted: nothing more was saved\n")
    finally:
        os._exit(STOPPED + number)

"""The command ``stickslip`` while its code is loaded.

Half a second passes until it is: a package of its own, because what `stickslip` loads comes before
the first line of any module in it.
"""

from __future__ import annotations

import os
import signal
from types import FrameType

STOPPED = 128
"""Exit code of a run that a signal has ended, beside the signal's number."""


def main() -> None:
    """Run the command; Ctrl-C ends it with a line from the start."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, leave)
    from stickslip.cli import app

    app(prog_name="stickslip")


def leave(number: int, _: FrameType | None) -> None:
    """End the program: modules that are half loaded hand no exception on."""
    try:
        # Not by a stream, whose lock may be held where the signal came.
        os.write(2, b"interrupted: nothing more was saved\n")
    finally:
        os._exit(STOPPED + number)

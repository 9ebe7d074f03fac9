"""The command ``stickslip`` while its code is loaded.

Half a second passes until it is: a package of its own, because what `stickslip` loads comes before
the first line of any module in it.
"""

from __future__ import annotations

import signal

from stickslip_command.stop import leave


def main() -> None:
    """Run the command; Ctrl-C ends it with a line from the start."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, leave)
    from stickslip.cli import app

    app(prog_name="stickslip")

"""The command line: ``stickslip run STUDY.toml``, ``show``, ``plot``, ``certify``, ``report``, ...

Exit codes: 0 all is well, 1 some points did not converge, 2 the input is refused, 70 a defect of
the program, 130 interrupted by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP: 128 and the signal's number.
"""

from importlib.metadata import entry_points

from stickslip.cli import commands as commands  # which join the application
from stickslip.cli.application import app, command

__all__ = ["app"]

for _found in entry_points(group="stickslip.commands"):
    command(name=_found.name)(_found.load())

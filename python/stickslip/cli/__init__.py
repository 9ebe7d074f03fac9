"""The command line."""

from importlib.metadata import entry_points

from stickslip.cli import reporting
from stickslip.cli.commands import app
from stickslip.cli.guard import Command, guarded

__all__ = ["app", "reporting"]

for _found in entry_points(group="stickslip.commands"):
    app.command(_found.name, cls=Command)(guarded(_found.load()))

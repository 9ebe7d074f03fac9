"""The command line."""

from stickslip.cli import reporting
from stickslip.cli.commands import app

__all__ = ["app", "reporting"]

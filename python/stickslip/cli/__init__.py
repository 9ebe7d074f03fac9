"""The command line."""

from stickslip.cli.commands import app

__all__ = ["app"]

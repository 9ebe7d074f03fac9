"""The command line."""

from stickslip.cli.commands import app
from stickslip.cli.reproduction import reproduce

__all__ = ["app", "reproduce"]

"""The command line."""

from stickslip.cli import reporting
from stickslip.cli.commands import app
from stickslip.cli.reproduction import reproduce

__all__ = ["app", "reporting", "reproduce"]

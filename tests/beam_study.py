"""The example study with few points and the ways to call the command, for the tests of both."""

import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from stickslip.cli import app

EXAMPLE = Path(__file__).parents[1] / "examples" / "snecma-beam"
COMMAND = [sys.executable, "-c", "from stickslip.cli import app; app()"]

FEW_POINTS = (
    "omega = { from = 150, to = 250, points = 12 }\nharmonics = 5\nlevels = [6.563, 20.313]"
)


def study_text(analysis=FEW_POINTS):
    text = (EXAMPLE / "study.toml").read_text()
    head, tail = text.split("[analysis]")
    return f"{head}[analysis]\n{analysis}\n[output]{tail.split('[output]')[1]}"


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def script(*arguments, **options):
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)

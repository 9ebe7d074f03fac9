"""The command ``stickslip`` where it is not on the path: ``python -m stickslip``."""

from stickslip.cli import app

if __name__ == "__main__":
    app(prog_name="stickslip")

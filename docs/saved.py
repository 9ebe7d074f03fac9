"""Where the figures of the documentation are kept, and how."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

ASSETS = Path(__file__).parent / "assets"


def save(figure: Figure, file: Path) -> Path:
    """Write a figure."""
    file.parent.mkdir(exist_ok=True)
    # Without the date and version in the file, an unchanged figure is an unchanged file.
    figure.savefig(file, dpi=110, metadata={"Software": None})
    return file

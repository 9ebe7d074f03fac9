"""What each reproduction takes, as last measured by ``python docs/make_gallery.py``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

__all__ = ["FILE", "costs"]

FILE = Path(__file__).with_name("costs.json")


def costs() -> Mapping[str, float]:
    """Return seconds of processor time, by name of the item."""
    measured: dict[str, float] = json.loads(FILE.read_text(encoding="utf-8"))
    return measured

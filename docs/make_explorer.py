"""Makes the picture of the explorer: ``python docs/make_explorer.py``, with Chromium."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

SETTLED = (
    "document.querySelectorAll('.plot').length > 2 && "
    "[...document.querySelectorAll('section')].every(one => one.ariaBusy === 'false')"
)


def picture(file: Path) -> None:
    """Take a picture of the page of the SNECMA beam."""
    sys.path.insert(0, str(ROOT / "tests"))
    from browser import Browser
    from explorer import Explorer

    study = ROOT / "examples" / "snecma-beam" / "study.toml"
    with Explorer(study) as explorer, Browser() as browser:
        browser.open(explorer.address)
        browser.shape(width=1280, height=1300)
        browser.until(SETTLED)
        # what was computed fades in
        browser.run("new Promise(done => setTimeout(done, 1000))")
        browser.screenshot(file)


if __name__ == "__main__":
    picture(ROOT / "docs" / "assets" / "explorer.png")

"""The folder of reproductions: of every item a picture, its numbers and a record; an index."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from stickslip import ModelError
from stickslip.files import make_folder
from stickslip.files import write as write_file
from stickslip_reproduce.index import CLAIMS, page
from stickslip_reproduce.item import Item
from stickslip_reproduce.numbers import Cell, Numbers, Plot, Table
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.subjects import SUBJECTS

__all__ = ["INDEX", "records", "write", "write_index", "write_picture", "write_record"]

INDEX = "index.html"
_KEYS = {"subject", "see", "corrected", "inferred", "facts", "table", "seconds"}
DPI = 120


def write(
    item: Item, numbers: Numbers, seconds: float, resolution: Resolution, folder: Path
) -> None:
    """Write all files of an item, each whole or not at all, and the index anew.

    Parameters
    ----------
    item : Item
        What was reproduced.
    numbers : Numbers
        What its function returned.
    seconds : float
        Time it took [s].
    resolution : Resolution
        At which resolution.
    folder : Path
        Made if it does not exist.
    """
    make_folder(folder)
    write_picture(numbers.plot, folder / f"{item.name}.png")
    rows = _table_rows(numbers.table) if numbers.table else _curve_rows(numbers.plot)
    _write_text(folder / f"{item.name}.csv", _csv(rows))
    write_record(item, numbers, seconds, resolution, folder)
    write_index(folder)


def write_picture(plot: Plot, file: Path, *, colours: int | None = None) -> None:
    """Draw a plot into a PNG file.

    Parameters
    ----------
    plot : Plot
        What to draw.
    file : Path
        The file.
    colours : int, optional
        Reduce the picture to so many colours, which makes a small file.
    """
    from PIL import Image

    from stickslip_reproduce.drawing import draw

    picture = io.BytesIO()
    # Without the version of the program in the file, an unchanged picture is an unchanged file.
    draw(plot).savefig(picture, format="png", dpi=DPI, metadata={"Software": None})
    if colours is not None:
        with Image.open(picture) as drawn:
            small = drawn.convert("RGB").quantize(colours)
        picture = io.BytesIO()
        small.save(picture, format="png", optimize=True)
    write_file(file, picture.getbuffer())


def write_record(
    item: Item, numbers: Numbers, seconds: float, resolution: Resolution, folder: Path
) -> None:
    """Write what an index says of an item, as JSON."""
    from stickslip import __version__

    table = numbers.table
    record = {
        "name": item.name,
        "subject": SUBJECTS[item.name],
        "see": item.see,
        "corrected": item.corrected,
        "inferred": item.inferred,
        "facts": [
            {
                "what": fact.what,
                "value": _finite(fact.value),
                "unit": fact.unit,
                "printed": _finite(fact.printed),
            }
            for fact in numbers.facts
        ],
        "table": table
        and {
            "columns": table.columns,
            "rows": [[_finite(cell) for cell in row] for row in table.rows],
        },
        "seconds": round(seconds, 2),
        "resolution": resolution.name,
        "version": __version__,
    }
    text = json.dumps(record, indent=1, ensure_ascii=False, allow_nan=False)
    _write_text(folder / f"{item.name}.json", text + "\n")


def records(folder: Path) -> dict[str, dict[str, Any]]:
    """Return the records in a folder, by name, in the order of the dissertation.

    Raises
    ------
    ModelError
        If a file with the name of a record is none.
    """
    files = {name: folder / f"{name}.json" for name in SUBJECTS}
    return {name: _record(file) for name, file in files.items() if file.is_file()}


def _record(file: Path) -> dict[str, Any]:
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ModelError(f"{file}: cannot be read ({error.strerror})") from None
    except ValueError:
        record = None
    if not isinstance(record, dict) or not record.keys() >= _KEYS:
        raise ModelError(f"{file}: not a record of a reproduction; delete it and run again")
    return record


def write_index(folder: Path) -> None:
    """Write the index of what a folder holds."""
    claims = CLAIMS if (folder / CLAIMS).is_file() else ""
    _write_text(folder / INDEX, page(records(folder), claims=claims))


def _write_text(file: Path, text: str) -> None:
    write_file(file, text.encode())


def _csv(rows: Iterator[tuple[Cell, ...]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in rows:
        writer.writerow([f"{cell:.10g}" if isinstance(cell, float) else cell for cell in row])
    return text.getvalue()


def _curve_rows(plot: Plot) -> Iterator[tuple[Cell, ...]]:
    """One row per point, in SI units."""
    # Panels with ordinates of their own have all in one column, each in its SI unit.
    headings = dict.fromkeys((panel.y or plot.y).heading for panel in plot.panels)
    yield "panel", "curve", plot.x.heading, " or ".join(headings)
    for panel in plot.panels:
        for series in panel.series:
            for x, y in zip(series.x, series.y, strict=True):
                yield panel.title, series.label, float(x), float(y)


def _table_rows(table: Table) -> Iterator[tuple[Cell, ...]]:
    yield table.columns
    yield from table.rows


def _finite(value: Cell) -> Cell:
    """Return what JSON knows: not-a-number is nothing."""
    return None if isinstance(value, float) and not math.isfinite(value) else value

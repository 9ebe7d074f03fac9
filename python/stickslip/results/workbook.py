"""Tables as sheets of a workbook of Excel."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable, Sequence
from itertools import compress
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from xlsxwriter import Workbook
from xlsxwriter.utility import xl_col_to_name
from xlsxwriter.worksheet import Worksheet

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.results.table import Frame, Tables, headed

_ROWS, _CHARACTERS = 2**20, 2**15 - 1
"""Of a sheet, and of one of its cells."""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")
"""What XML has no characters for."""
_ESCAPED = re.compile("_x[0-9A-Fa-f]{4}_")
"""What Excel takes for a character."""
_FALSE = ' t="b"><v>0</v></c>'
_TITLE = 31
"""Characters of the name of a sheet."""
_ABOUT = "about"
"""The sheet that says what the columns are."""
_HEADINGS = ["sheet", "table", "column", "unit", "meaning"]
_AT_ONCE = 4096
"""Rows that are written to the sheet together."""


class _Sheet(Worksheet):  # type: ignore[misc]
    """A sheet that writes columns of one kind by itself.

    xlsxwriter makes an object of every cell and asks it for its kind: 5 microseconds, for the
    millions of cells that curves of many degrees of freedom have five times as long as this.
    """

    def fill(self, columns: Iterable[Sequence[str]]) -> None:
        """Take columns of equal length, of what `_text` and `_number` return."""
        self._columns = list(columns)
        self.dim_rowmin = self.dim_colmin = 0
        self.dim_rowmax, self.dim_colmax = len(self._columns[0]) - 1, len(self._columns) - 1

    def _write_rows(self) -> None:
        letters = [xl_col_to_name(column) for column in range(len(self._columns))]
        rows = zip(*self._columns, strict=True)
        lines: list[str] = []
        for row, cells in enumerate(rows, 1):
            written = [
                f'<c r="{letter}{row}"{cell}'
                for letter, cell in compress(zip(letters, cells, strict=True), cells)
            ]
            lines.append(f'<row r="{row}">{"".join(written)}</row>')
            if len(lines) == _AT_ONCE:
                self.fh.write("".join(lines))
                lines.clear()
        self.fh.write("".join(lines))


def workbook(file: Path, tables: Tables, names: list[str]) -> memoryview:
    """Return a workbook with a sheet per table, and one that says what their columns are.

    Raises
    ------
    ModelError
        If a table has more rows than a sheet, or a text is longer than a cell holds or has
        characters that XML does not have.
    """
    for name in names:
        if tables.rows(name) >= _ROWS:
            raise ModelError(
                f"{file}: the table {name} has {tables.rows(name)} rows, a sheet {_ROWS - 1}; "
                "export it as .csv or .parquet, or give table= another one"
            )
    content = io.BytesIO()
    # Without temporary files: their disk may be full.
    book = Workbook(content, {"in_memory": True})
    about = book.add_worksheet(_ABOUT, _Sheet)
    meant = [_HEADINGS]
    for title, name in zip(_titles(names), names, strict=True):
        frame: Frame = tables[name]
        units, meanings = frame.attrs["units"], frame.attrs["meanings"]
        meant += [[title, name, column, units[column], meanings[column]] for column in units]
        sheet = book.add_worksheet(title, _Sheet)
        headings = headed(frame.head(0))
        sheet.fill(
            _column(file, str(heading), frame[column])
            for heading, column in zip(headings, frame, strict=True)
        )
    about.fill([_text(file, one) for one in column] for column in zip(*meant, strict=True))
    book.close()
    return content.getbuffer()


def _column(file: Path, heading: str, values: Any) -> list[str]:
    """Return the cells of a column below its heading."""
    told: list[Any] = values.tolist()
    head = _text(file, heading)
    if values.dtype.kind == "f":
        return [head, *map(_number, told)]
    if values.dtype.kind == "b":
        return [head, *(' t="b"><v>1</v></c>' if value else _FALSE for value in told)]
    if values.dtype.kind in "iu":
        return [head, *(f"><v>{value}</v></c>" for value in told)]
    # names and states come again and again
    known = {value: _text(file, value) for value in set(told)}
    return [head, *(known[value] for value in told)]


def _number(value: float) -> str:
    """Return the cell of a number, empty for not-a-number."""
    if math.isfinite(value):
        return f"><v>{value!r}</v></c>"
    return "" if math.isnan(value) else f' t="str"><v>{value}</v></c>'


def _text(file: Path, text: str) -> str:
    """Return the cell of a text; refuse one that no cell can hold as it is."""
    if len(text) > _CHARACTERS or _CONTROL.search(text):
        raise ModelError(f"{file}: a cell cannot hold {brief(text)}; export it as .csv or .parquet")
    shown = escape(_ESCAPED.sub(r"_x005F\g<0>", text), {"\r": "&#13;"})
    return f' t="inlineStr"><is><t xml:space="preserve">{shown}</t></is></c>'


def _titles(names: list[str]) -> list[str]:
    """Return names of sheets, which are short, different, and not that of the first one."""
    titles: list[str] = []
    for name in names:
        title = name[:_TITLE]
        if title in (*titles, _ABOUT):
            mark = f"~{len(titles) + 1}"
            title = title[: _TITLE - len(mark)] + mark
        titles.append(title)
    return titles

"""What a notebook shows of a result: its facts and tables, as `stickslip show` prints them."""

from __future__ import annotations

from html import escape
from itertools import islice

from stickslip.errors import ModelError
from stickslip.model.notable import notable_dofs
from stickslip.results.result import Result
from stickslip.views.kinds import cautions, failures, view_of
from stickslip.views.tables import Table

_ROWS = 20
"""Most rows of a table."""


def html_of(result: Result) -> str | None:
    """Return a page of a result; nothing where no table can be made, and its `repr` says all."""
    try:
        shown = notable_dofs(result.model, result.dofs)
        tables = view_of([result]).tables([("", result)], "", shown, "auto")
        doubts = [*failures(result), *cautions(result)]
    except ModelError:
        return None
    title = f"<p><code>{escape(repr(result))}</code></p>"
    return "".join([title, *map(_table, tables), *(f"<p>⚠ {escape(one)}</p>" for one in doubts)])


def _table(table: Table) -> str:
    count = table.row_count
    heads = [_cell("th", column.header, column.justify) for column in table.columns]
    cells = [
        [_cell("td", one, column.justify) for one in islice(column.cells, _ROWS)]
        for column in table.columns
    ]
    rows = "".join(f"<tr>{''.join(row)}</tr>" for row in (heads, *zip(*cells, strict=True)))
    more = f"... {count} rows in all" if count > _ROWS else None
    title, *notes = (
        f"<p>{escape(str(one))}</p>" if one else "" for one in (table.title, more, table.caption)
    )
    return f"{title}<table>{rows}</table>{''.join(notes)}"


def _cell(tag: str, content: object, justify: str) -> str:
    return f'<{tag} style="text-align:{justify}">{escape(str(content))}</{tag}>'

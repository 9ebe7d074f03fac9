"""The page that shows a folder of reproductions, and how numbers are written on pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from stickslip_reproduce.item import heading
from stickslip_reproduce.subjects import SUBJECTS

__all__ = ["CLAIMS", "STYLE", "fact_rows", "number", "page"]

CLAIMS = "claims.html"
"""The page of claims beside it."""

STYLE = """
body { font: 16px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem;
       color: #222; background: #fff; }
h2 { margin: 2.6rem 0 0.4rem; border-top: 1px solid #ccc; padding-top: 1rem; }
img { max-width: 100%; }
table { border-collapse: collapse; font-size: 0.9rem; margin: 0.6rem 0; }
th, td { padding: 0.15rem 0.8rem 0.15rem 0; border-bottom: 1px solid #ddd; text-align: left; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
.corrected { border-left: 4px solid #c8571b; padding-left: 0.8rem; }
.note { color: #555; }
"""


def number(value: object) -> str:
    """Return a cell with the digits that matter; nothing for nothing."""
    if value is None:
        return ""
    if isinstance(value, float):
        # What rounding leaves of zero is zero.
        return "0" if abs(value) < 1e-11 else f"{value:.4g}"
    return str(value)


def fact_rows(record: Mapping[str, Any]) -> list[tuple[str, str, str, str]]:
    """Return the facts of a record as rows: what, value, unit, printed."""
    return [
        (fact["what"], number(fact["value"]), fact["unit"], number(fact["printed"]))
        for fact in record["facts"]
    ]


def page(records: Mapping[str, Mapping[str, Any]], *, claims: str = "") -> str:
    """Return an HTML page that shows records, with their pictures beside it.

    Parameters
    ----------
    records : mapping of str to mapping
        What `folder.write_record` wrote, by name.
    claims : str, optional
        The page of claims beside it.
    """
    missing = [name for name in SUBJECTS if name not in records]
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width">',
        f"<title>Reproduction of Guillen (1999)</title><style>{STYLE}</style></head><body>",
        "<h1>Reproduction of Guillen (1999)</h1>",
        "<p>J. Guillen, <i>Studies of the dynamics of dry-friction-damped blade assemblies</i>, "
        f"University of Michigan, 1999: {len(records)} of {len(SUBJECTS)} tables and figures.</p>",
        *([f'<p><a href="{claims}">What the text claims</a>, with verdicts</p>'] if claims else []),
        *(part for name, record in records.items() for part in _section(name, record)),
    ]
    if missing:
        names = ", ".join(heading(name) for name in missing)
        parts.append(f"<h2>Not in this folder</h2><p>{names}</p>")
    return "\n".join([*parts, "</body></html>"]) + "\n"


def _section(name: str, record: Mapping[str, Any]) -> list[str]:
    title = f"{heading(name)}: {record['subject']}"
    lines = [
        f'<h2 id="{name}">{escape(title)}</h2>',
        f'<p><img src="{name}.png" alt="{escape(title)}"></p>',
        f"<p>{escape(record['see'])}</p>",
        *(f'<p class="corrected">{escape(line)}</p>' for line in record["corrected"]),
        *(f'<p class="note">{escape(line)}</p>' for line in record["inferred"]),
    ]
    facts = [list(row) for row in fact_rows(record)]
    lines += _table(["", "value", "unit", "printed"], facts)
    if record["table"]:
        rows = [[number(cell) for cell in row] for row in record["table"]["rows"]]
        lines += _table(record["table"]["columns"], rows)
    lines.append(
        f'<p class="note"><a href="{name}.csv">{name}.csv</a>, {record["seconds"]:g} s, '
        f"{record['resolution']} resolution, stickslip {record['version']}</p>"
    )
    return lines


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    head = "".join(f"<th>{escape(column)}</th>" for column in columns)
    lines = [f"<table><tr>{head}</tr>"]
    lines += [
        "<tr>" + "".join(f"<td{_class(cell)}>{escape(cell)}</td>" for cell in row) + "</tr>"
        for row in rows
    ]
    return [*lines, "</table>"]


def _class(cell: str) -> str:
    try:
        float(cell)
    except ValueError:
        return ""
    return ' class="number"'

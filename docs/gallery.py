"""Markdown extension: writes the gallery and the coverage page from the catalogue of reproductions.

A line ``{{ gallery }}``, ``{{ coverage }}``, ``{{ claims }}`` or ``{{ table NAME }}`` is
replaced. Texts, code and status come from the package that the pages are built with, pictures and
numbers from ``docs/assets/reproduction``, which ``docs/make_gallery.py`` fills.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from markdown import Markdown
from markdown.extensions import Extension
from markdown.preprocessors import Preprocessor

from stickslip_reproduce import SUBJECTS, costs, heading, items
from stickslip_reproduce.claims_page import chapters, counts, entries, values
from stickslip_reproduce.folder import records
from stickslip_reproduce.index import fact_rows, number
from stickslip_reproduce.numbered import NUMBERED

FOLDER = Path(__file__).parent / "assets" / "reproduction"
_MARK = re.compile(
    r"^\{\{ (?P<what>gallery|coverage|claims|table) ?(?P<name>[\w.-]*) \}\}$", re.MULTILINE
)


def written(page: str) -> str:
    """Return a page with every mark replaced."""
    return _MARK.sub(lambda mark: _WRITERS[mark["what"]](mark["name"]), page)


class Marks(Preprocessor):
    """Replaces the marks of a page."""

    def run(self, lines: list[str]) -> list[str]:
        """Return the lines of the page without marks."""
        return written("\n".join(lines)).split("\n")


class Gallery(Extension):
    """The extension, before all that reads Markdown."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Add what replaces the marks."""
        md.preprocessors.register(Marks(md), "gallery", 100)


def makeExtension(**options: Any) -> Gallery:
    """Return the extension, as Python-Markdown asks for it."""
    return Gallery(**options)


def _gallery(_: str) -> str:
    known = records(FOLDER)
    return "\n\n".join(_entry(name, known[name]) for name in items() if name in known)


def _entry(name: str, record: dict[str, Any]) -> str:
    item = items()[name]
    title = f"{item.heading}: {SUBJECTS[name]}"
    facts = [row for row in fact_rows(record) if row[1]]
    parts = [
        f"### {title} {{#{name}}}",
        f"![{title}](assets/reproduction/{name}.png)",
        item.see,
        *(f"*Corrected:* {line}" for line in item.corrected),
        *(f"*Chosen here:* {line}" for line in item.inferred),
    ]
    if record["table"]:
        parts.append(_folded("The table", _table(name)))
    rows = [f"| {' | '.join(row)} |" for row in facts]
    head = ["| | value | unit | printed |", "|---|---|---|---|"]
    parts.append(_folded("Numbers", "\n".join([*head, *rows])))
    # No fence of its own class: the block is not run with the page, tests run the function itself.
    parts.append(_folded("The code that made it", f"```{{.python .norun}}\n{item.code}\n```"))
    parts.append(f"`stickslip reproduce {name}`, {_cost(costs(), name)} s on one core")
    return "\n\n".join(parts)


def _folded(title: str, text: str) -> str:
    return f'<details markdown="1"><summary>{title}</summary>\n\n{text}\n\n</details>'


def _table(name: str) -> str:
    table = records(FOLDER)[name]["table"]
    rows = [[number(cell) for cell in row] for row in table["rows"]]
    return "\n".join(
        [_row(table["columns"]), _row(["---"] * len(table["columns"])), *map(_row, rows)]
    )


def _cost(taken: Mapping[str, float], name: str) -> str:
    return f"{taken[name]:.2g}" if name in taken else "?"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _coverage(_: str) -> str:
    done, taken = items(), costs()
    lines = [
        f"{len(done)} of {len(SUBJECTS)} are reproduced, together in {sum(taken.values()):.0f} s.",
        "",
        "| | subject | status | cost [s] |",
        "|---|---|---|---|",
    ]
    for name, subject in SUBJECTS.items():
        if name in done:
            cells = f"[{heading(name)}](gallery.md#{name})", subject, "done", _cost(taken, name)
        else:
            cells = heading(name), subject, "not yet", ""
        lines.append(_row(cells))
    lines += [
        "",
        "Sketches, parameters and algorithms:",
        "",
        "| | subject | where |",
        "|---|---|---|",
    ]
    lines += [_row([name, subject, _place(place)]) for name, (subject, place) in NUMBERED.items()]
    return "\n".join(lines)


def _place(place: str) -> str:
    """Return a claim as a link, and a name as code."""
    kind, _, name = place.partition(" ")
    return f"[{name}](claims.md#{name})" if kind == "claim" else f"`{place}`"


def _claims(_: str) -> str:
    kept = entries(FOLDER)
    parts = [counts(kept)]
    for title, own in chapters(kept):
        lines = [
            f"## {title}",
            "",
            "| section | the text, and what was computed | verdict | numbers |",
        ]
        lines.append("|---|---|---|---|")
        for one in own:
            known = [name for name in one["see"] if name in items()]
            links = ", ".join(f"[{heading(name)}](gallery.md#{name})" for name in known)
            text = f'<span id="{one["name"]}"></span>“{one["quote"]}”<br><br>{one["done"]} {links}'
            cells = one["section"], text, f"**{one['verdict']}**", "<br>".join(values(one))
            # A bar ends a cell.
            lines.append(_row([cell.replace("|", "&#124;") for cell in cells]))
        parts.append("\n".join(lines))
        parts += [
            f"![{one['done']}](assets/reproduction/{one['picture']})\n\n"
            f"*[{one['section']}](#{one['name']}): {one['verdict']}*"
            for one in own
            if one["picture"]
        ]
    return "\n\n".join(parts)


_WRITERS: dict[str, Callable[[str], str]] = {
    "gallery": _gallery,
    "coverage": _coverage,
    "claims": _claims,
    "table": _table,
}

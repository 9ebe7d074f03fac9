"""The claims in a folder: their numbers and verdicts as JSON, their pictures, and a page."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, TypeAlias

from stickslip import ModelError
from stickslip.files import make_folder
from stickslip.files import write as write_file
from stickslip_reproduce.claims import VERDICTS, Finding
from stickslip_reproduce.folder import write_picture
from stickslip_reproduce.index import CLAIMS, STYLE, number
from stickslip_reproduce.item import heading

__all__ = ["Entry", "chapters", "counts", "entries", "picture", "write_claims"]

RECORD = "claims.json"

Entry: TypeAlias = Mapping[str, Any]
"""What the record says of one claim."""

NUMERALS = {"2": "II", "3": "III", "4": "IV", "5": "V", "6": "VI", "7": "VII"}


def picture(name: str) -> str:
    """Return the name of the picture of a claim."""
    return f"claim-{name}.png"


def write_claims(
    findings: Sequence[Finding], folder: Path, *, colours: int | None = None
) -> list[Entry]:
    """Write the record, the pictures and the page of claims.

    Parameters
    ----------
    findings : sequence of Finding
        Every claim with its numbers.
    folder : Path
        Made if it does not exist.
    colours : int, optional
        Reduce pictures to so many colours.

    Returns
    -------
    list of mapping
        What the record says of each.
    """
    make_folder(folder)
    for one in findings:
        if one.found.plot is not None:
            write_picture(one.found.plot, folder / picture(one.claim.name), colours=colours)
    kept: list[Entry] = [_entry(one) for one in findings]
    text = json.dumps(kept, indent=1, ensure_ascii=False, allow_nan=False)
    write_file(folder / RECORD, (text + "\n").encode())
    write_file(folder / CLAIMS, _page(kept).encode())
    return kept


def _entry(one: Finding) -> Entry:
    return {
        "name": one.claim.name,
        "section": one.claim.section,
        "quote": one.claim.quote,
        "done": one.claim.done,
        "verdict": one.verdict,
        "facts": [
            {
                "what": fact.what,
                "value": float(fact.value) if fact.value == fact.value else None,
                "unit": fact.unit,
                "printed": fact.printed,
            }
            for fact in one.found.facts
        ],
        "see": list(one.claim.see),
        "picture": picture(one.claim.name) if one.found.plot is not None else None,
    }


def entries(folder: Path) -> list[Entry]:
    """Return the record of a folder; nothing if it has none.

    Raises
    ------
    ModelError
        If the file is no record of claims.
    """
    file = folder / RECORD
    if not file.is_file():
        return []
    try:
        kept = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ModelError(f"{file}: cannot be read ({error.strerror})") from None
    except ValueError:
        kept = None
    if not isinstance(kept, list):
        raise ModelError(f"{file}: not a record of claims; delete it and run again")
    return kept


def chapters(kept: Sequence[Entry]) -> Iterator[tuple[str, list[Entry]]]:
    """Return the claims by chapter, each with its heading."""
    for digit, numeral in NUMERALS.items():
        own = [one for one in kept if one["section"].startswith(f"{digit}.")]
        if own:
            yield f"Chapter {numeral}", own


def counts(kept: Sequence[Entry]) -> str:
    """Return how many claims have which verdict, as a sentence."""
    found = Counter(one["verdict"] for one in kept)
    listed = ", ".join(f"{found[verdict]} {verdict}" for verdict in VERDICTS if found[verdict])
    return f"{len(kept)} claims: {listed}."


def values(one: Entry) -> list[str]:
    """Return the numbers of a claim, one text each."""
    return [
        f"{fact['what']}: {number(fact['value'])} {fact['unit']}".rstrip()
        + ("" if fact["printed"] is None else f" (printed {number(fact['printed'])})")
        for fact in one["facts"]
    ]


def _page(kept: Sequence[Entry]) -> str:
    title = "Claims of Guillen (1999)"
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width">',
        f"<title>{title}</title><style>{STYLE}</style></head><body>",
        f"<h1>{title}</h1>",
        f'<p>{counts(kept)} <a href="index.html">Tables and figures</a></p>',
    ]
    for name, own in chapters(kept):
        parts.append(f"<h2>{name}</h2>")
        parts += [part for one in own for part in _section(one)]
    return "\n".join([*parts, "</body></html>"]) + "\n"


def _section(one: Entry) -> list[str]:
    links = ", ".join(f'<a href="{name}.png">{heading(name)}</a>' for name in one["see"])
    lines = [
        f'<h3 id="{one["name"]}">{one["section"]}: {escape(one["verdict"])}</h3>',
        f"<blockquote>{escape(one['quote'])}</blockquote>",
        f"<p>{escape(one['done'])} {links}</p>",
        "<ul>" + "".join(f"<li>{escape(value)}</li>" for value in values(one)) + "</ul>",
    ]
    if one["picture"]:
        lines.append(f'<p><img src="{one["picture"]}" alt="{escape(one["done"])}"></p>')
    return lines

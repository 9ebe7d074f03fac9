"""Documentation in the form of numpydoc, taken apart and put together."""

from __future__ import annotations

import re
from collections.abc import Mapping
from inspect import cleandoc


def sections(text: str | None) -> dict[str, str]:
    """Return the sections of a documentation by their names, what precedes them under ""."""
    head, *rest = re.split(r"\n\n(\w+)\n-+\n", cleandoc(text or ""))
    return {"": head, **dict(zip(rest[::2], rest[1::2], strict=True))}


def entries(section: str) -> dict[str, str]:
    """Return the entries of a section by their names; one of several names stands under each."""
    blocks = re.split(r"\n(?=\S)", section) if section else []
    names = [(re.split(r" : |\n", block)[0].replace("*", ""), block) for block in blocks]
    return {name: block for listed, block in names for name in listed.split(", ")}


def written(parts: Mapping[str, str]) -> str:
    """Return the documentation that has these sections, as far as there is something in them."""
    named = [(name, body) for name, body in parts.items() if name and body]
    return "\n\n".join([parts[""], *(f"{name}\n{'-' * len(name)}\n{body}" for name, body in named)])

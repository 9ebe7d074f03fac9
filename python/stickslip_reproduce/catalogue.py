"""Which tables and figures are reproduced, and which are not yet."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from functools import cache
from importlib import import_module

from stickslip import ModelError
from stickslip_reproduce.item import Item, heading
from stickslip_reproduce.subjects import SUBJECTS

__all__ = ["CHAPTERS", "SUBJECTS", "chosen", "items"]

CHAPTERS = (
    "chapter_2",
    "chapter_4_beam",
    "chapter_4_blade",
    "chapter_4_cost",
    "chapter_4_rings",
    "chapter_5_mass",
    "chapter_5_modes",
    "chapter_5_stability",
    "chapter_6",
    "chapter_7_contact",
    "chapter_7_body",
)
"""Modules that reproduce something; every `Item` in them counts."""


@cache
def items() -> dict[str, Item]:
    """Return what can be reproduced, by name, in the order of the dissertation.

    Returns
    -------
    dict of str to Item
        Names are among `SUBJECTS`; what is missing is not reproduced yet.
    """
    modules = [import_module(f"stickslip_reproduce.{chapter}") for chapter in CHAPTERS]
    found = {
        value.name: value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, Item)
    }
    return {name: found[name] for name in SUBJECTS if name in found}


def chosen(names: Iterable[str]) -> list[Item]:
    """Return the items of some names, each once.

    Parameters
    ----------
    names : iterable of str
        "table-2.3", "fig-4.22"; "all" is everything there is.

    Raises
    ------
    ModelError
        If the dissertation has no such table or figure, or it is not reproduced yet.
    """
    known = items()
    wanted: dict[str, Item] = {}
    for name in names:
        if name == "all":
            wanted |= known
        elif name in known:
            wanted[name] = known[name]
        elif name in SUBJECTS:
            raise ModelError(f"{name}: {heading(name)} is not reproduced yet; see the list")
        else:
            near = get_close_matches(name, [*known, "all", "claims"], 1)
            hint = f"did you mean {near[0]!r}?" if near else "stickslip reproduce lists them"
            raise ModelError(f"unknown table or figure {name!r}; {hint}")
    return list(wanted.values())

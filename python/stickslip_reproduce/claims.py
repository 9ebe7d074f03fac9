"""Claims of the dissertation's text: what was computed on each, and what that makes of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Literal, TypeAlias

from stickslip_reproduce.catalogue import items
from stickslip_reproduce.item import Item
from stickslip_reproduce.numbers import Fact, Numbers, Plot
from stickslip_reproduce.resolution import Resolution

__all__ = ["VERDICTS", "Claim", "Finding", "Found", "claim", "claims", "computed", "numbers_of"]

Verdict: TypeAlias = Literal["holds", "holds with limits", "false", "open"]

VERDICTS: tuple[Verdict, ...] = ("holds", "holds with limits", "false", "open")
"""What can come out: as said; only under conditions that the text does not name; not so; nothing
that decides."""

CHAPTERS = (
    "claims_2_mass",
    "claims_2_beam",
    "claims_3_force",
    "claims_3_solvers",
    "claims_3_operations",
    "claims_4_beam",
    "claims_4_stiffness",
    "claims_4_blade",
    "claims_4_rings",
    "claims_4_localization",
    "claims_5_mass",
    "claims_5_stiffness",
    "claims_5_modes",
    "claims_5_stability",
    "claims_5_aperiodic",
    "claims_5_single_mode",
    "claims_6_force",
    "claims_6_histories",
    "claims_6_response",
    "claims_7",
    "claims_equations",
)
"""Modules with claims, in the order of the text."""

Values: TypeAlias = Mapping[str, float]
Rule: TypeAlias = Callable[[Values], Verdict]


@dataclass(frozen=True, eq=False)
class Found:
    """What was computed on a claim: numbers, and a picture where no figure shows it."""

    facts: tuple[Fact, ...]
    plot: Plot | None = None


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One finding of the text, and how it is judged.

    Parameters
    ----------
    name : str
        "near-optimal-damping".
    section : str
        Where it stands, "2.3.4".
    quote : str
        The sentence, or the part of it that claims something.
    done : str
        What is computed, and what the numbers say of the claim.
    compute : callable
        Computes the numbers at a resolution.
    rule : callable
        The verdict by the values of the numbers.
    see : tuple of str
        Tables and figures that show it.
    """

    name: str
    section: str
    quote: str
    done: str
    compute: Callable[[Resolution], Found]
    rule: Rule
    see: tuple[str, ...] = ()

    def finding(self, resolution: Resolution) -> Finding:
        """Compute the numbers and judge by them."""
        found = self.compute(resolution)
        return Finding(self, found, self.judge({fact.what: fact.value for fact in found.facts}))

    def judge(self, values: Values) -> Verdict:
        """Return the verdict by values; it is open where one of them is not a number."""
        if any(math.isnan(value) for value in values.values()):
            return "open"
        return self.rule(values)


@dataclass(frozen=True, eq=False)
class Finding:
    """A claim with its numbers and verdict."""

    claim: Claim
    found: Found
    verdict: Verdict


def verdict(holds: bool, limited: bool = False) -> Verdict:
    """Return "holds", or "holds with limits" where only the second is true, or "false"."""
    if holds:
        return "holds"
    return "holds with limits" if limited else "false"


def claim(
    name: str, section: str, quote: str, done: str, *, rule: Rule, see: str = ""
) -> Callable[[Callable[[Resolution], Found]], Claim]:
    """Make a claim of the function that computes its numbers; see `Claim`."""

    def make(compute: Callable[[Resolution], Found]) -> Claim:
        return Claim(
            name=name,
            section=section,
            quote=" ".join(quote.split()),
            done=" ".join(done.split()),
            compute=compute,
            rule=rule,
            see=tuple(see.split()),
        )

    return make


@cache
def claims() -> dict[str, Claim]:
    """Return the claims by name, in the order of the text."""
    modules = [import_module(f"stickslip_reproduce.{chapter}") for chapter in CHAPTERS]
    values = [value for module in modules for value in vars(module).values()]
    # Several claims of one kind stand together in a tuple.
    listed = [one for value in values if isinstance(value, tuple) for one in value]
    every = [value for value in (*values, *listed) if isinstance(value, Claim)]
    every = list({id(one): one for one in every}.values())
    found = {one.name: one for one in sorted(every, key=_place)}
    if len(found) < len(every):
        raise ValueError("two claims have the same name")
    return found


def _place(one: Claim) -> tuple[int, ...]:
    return tuple(int(part) for part in one.section.split("."))


@cache
def computed(item: Item, resolution: Resolution) -> Numbers:
    """Return the numbers of an item, kept, as claims share them with tables and figures."""
    return item.compute(resolution)


def numbers_of(name: str, resolution: Resolution) -> Numbers:
    """Return the numbers of a table or figure by its name, kept."""
    return computed(items()[name], resolution)

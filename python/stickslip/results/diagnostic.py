"""What an analysis has to say of its result, apart from numbers."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.results.status import Status

__all__ = ["SEVERITIES", "Diagnostic", "Severity", "diagnostic", "missed_tolerances", "present"]


class Severity(StrEnum):
    """What a diagnostic means for the use of a result."""

    NOTE = "note"
    """Something was assumed or chosen; the numbers hold under it."""
    CAUTION = "caution"
    """The numbers are in doubt."""
    FAILURE = "failure"
    """Something that was asked for is missing."""


_NOTE, _CAUTION, _FAILURE = Severity
SEVERITIES: Mapping[str, Severity] = MappingProxyType(
    {
        # the method
        "harmonics": _NOTE,
        "samples": _NOTE,
        "method": _NOTE,
        "no-error-estimate": _NOTE,
        "half-period": _NOTE,
        "half-wave": _NOTE,
        "modal-base": _NOTE,
        "direct-solution": _NOTE,
        "exact-orbits": _NOTE,
        "frequencies": _NOTE,
        "observed-dofs": _NOTE,
        "tolerances-missed": _NOTE,
        "truncation": _CAUTION,
        "harmonics-limit": _CAUTION,
        # the model
        "static-traction": _NOTE,
        "start-of-march": _NOTE,
        "law-not-monotone": _CAUTION,
        "undamped-motion": _CAUTION,
        "negative-damping": _CAUTION,
        # transients and free motions
        "start": _NOTE,
        "time-steps": _NOTE,
        "kept-periods": _NOTE,
        "coarse-steps": _CAUTION,
        "no-tolerance": _CAUTION,
        "forces-left-out": _CAUTION,
        "criterion": _NOTE,
        "modes": _NOTE,
        # peaks along a parameter, and of many disks
        "peak-range": _NOTE,
        "peak-at-edge": _CAUTION,
        "varied-together": _NOTE,
        "rigid-limit": _NOTE,
        "coarse-search": _NOTE,
        "optimum-at-bound": _CAUTION,
        "patterns": _NOTE,
        "deviations": _NOTE,
        # limit cycles
        "onset": _NOTE,
        "forces-ignored": _NOTE,
        "stability-undecided": _NOTE,
        "multipliers": _NOTE,
        "unbounded-branch": _NOTE,
        "points-limit": _CAUTION,
        "no-turn": _CAUTION,
        "branch-jumps": _CAUTION,
        "branch-stalled": _FAILURE,
        "branch-turned-back": _FAILURE,
        "no-limit": _FAILURE,
        "stability-unknown": _CAUTION,
        # files of the first version hold texts alone
        "text": _NOTE,
    }
)
"""Every code, with what it means for the use of a result."""


@dataclass(frozen=True)
class Diagnostic:
    """One thing to know of a result. Programs read `code` and `data`, people read `text`.

    Attributes
    ----------
    code : str
        What it is, the same in every language and version.
    severity : Severity
        What it means for the use of the result.
    text : str
        One sentence or two.
    data : mapping
        The numbers and names in the text.
    """

    code: str
    severity: Severity
    text: str
    data: Mapping[str, float | int | str]

    def __str__(self) -> str:
        return self.text


def diagnostic(code: str, text: str, **data: float | str) -> Diagnostic:
    """Return a diagnostic of a code in `SEVERITIES`."""
    return Diagnostic(code, SEVERITIES[code], text, data)


def present(diagnostics: Iterable[Diagnostic | bool | None]) -> tuple[Diagnostic, ...]:
    """Leave out what does not apply: None, and conditions that do not hold."""
    return tuple(one for one in diagnostics if isinstance(one, Diagnostic))


def missed_tolerances(codes: NDArray[np.integer[Any]], noun: str) -> Diagnostic | None:
    """Count the points that did not converge, by the codes of their status."""
    kinds, firsts, counts = np.unique(codes, return_index=True, return_counts=True)
    met = kinds == Status.CONVERGED.code
    if met.all():
        return None
    missed = [n for n in np.argsort(firsts) if not met[n]]
    listed = ", ".join(f"{counts[n]} {Status.from_code(int(kinds[n]))}" for n in missed)
    return diagnostic(
        "tolerances-missed",
        f"Of {codes.size} {noun} not all met every tolerance: {listed}.",
        total=codes.size,
        missed=int(counts[~met].sum()),
    )


def to_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Write diagnostics as a JSON text."""
    entries = [
        {"code": one.code, "severity": one.severity, "text": one.text, "data": dict(one.data)}
        for one in diagnostics
    ]
    return json.dumps(entries, ensure_ascii=False)


def from_attributes(attributes: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """Read what `to_json` wrote as the attribute `diagnostics` of a file.

    Raises
    ------
    KeyError, ValueError
        If it is missing or damaged.
    """
    if "diagnostics" not in attributes:
        return tuple(diagnostic("text", str(one)) for one in json.loads(attributes["assumptions"]))
    return tuple(
        Diagnostic(str(one["code"]), Severity(one["severity"]), str(one["text"]), dict(one["data"]))
        for one in json.loads(attributes["diagnostics"])
    )

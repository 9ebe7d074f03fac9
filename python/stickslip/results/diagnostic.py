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


class Severity(StrEnum):
    """What a diagnostic means for the use of a result."""

    NOTE = "note"
    """Something was assumed or chosen; the numbers hold under it."""
    CAUTION = "caution"
    """The numbers are in doubt."""
    FAILURE = "failure"
    """Something that was asked for is missing."""


_CODES = {
    Severity.NOTE: """
        harmonics samples method no-error-estimate half-period half-wave modal-base direct-solution
        exact-orbits mass-scaling frequencies observed-dofs tolerances-missed static-traction
        start-of-march start time-steps kept-periods criterion modes peak-range varied-together
        rigid-limit coarse-search patterns deviations onset forces-ignored stability-undecided
        multipliers unbounded-branch branch-unknown folds unstable intervals noise-estimated
        mode-at-rest turns samples-drawn independent bounds wave-stability waves-unheld text
    """,
    Severity.CAUTION: """
        truncation harmonics-limit law-not-monotone undamped-motion negative-damping coarse-steps
        negative-stiffness overdamped wave-damping phase-unit mistuning-unit friction-unit
        angle-unit two-frequencies no-tolerance forces-left-out peak-at-edge optimum-at-bound
        points-limit no-turn branch-jumps stability-unknown jump further-branches free-flight
        internal-resonance not-determined tied at-bound other-minimum misfit-above-noise
        cycles-differ values-missed rigid-contacts other-motion few-modes unbounded-resonance
    """,
    Severity.FAILURE: """
        mode-not-reached branch-stalled branch-turned-back branch-end no-limit predictions-missing
        samples-failed waves-missing bounds-not-found
    """,
}
SEVERITIES: Mapping[str, Severity] = MappingProxyType(
    {code: severity for severity, codes in _CODES.items() for code in codes.split()}
)
"""Every code, with what it means for the use of a result; "text" is that of the first files."""


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
    """Read what `to_json` wrote as the attribute `diagnostics` of a file."""
    if "diagnostics" not in attributes:
        return tuple(diagnostic("text", str(one)) for one in json.loads(attributes["assumptions"]))
    return tuple(
        Diagnostic(str(one["code"]), Severity(one["severity"]), str(one["text"]), dict(one["data"]))
        for one in json.loads(attributes["diagnostics"])
    )

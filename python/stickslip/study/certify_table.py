"""The table [analysis] of a harmonic balance that is compared with exact orbits."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, Strict, Tag

from stickslip.analyses.certify import POINTS, certify
from stickslip.checks import MAX_COUNT
from stickslip.model import Model
from stickslip.study.analysis_tables import BalanceTable
from stickslip.study.entries import Count, number_or

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse

__all__ = ["CertifyTable"]

# Share of the progress that the balance is given.
_BALANCE = 0.5


class CertifyTable(BalanceTable):
    """Steady response by harmonic balance, compared with exact orbits at some points."""

    kind: Literal["certify"] = Field(description="The analysis.")
    points: Annotated[
        Annotated[Count, Tag("<number>")]
        | Annotated[Literal["all"], Tag("<text>")]
        | Annotated[
            tuple[Annotated[int, Field(ge=0, le=MAX_COUNT)], ...],
            Strict(False),
            Field(min_length=1),
            Tag("<list>"),
        ],
        number_or("<text>", "<list>"),
    ] = Field(
        default=POINTS,
        description="Points to compare: how many, chosen at random, 'all', or their positions "
        "from 0.",
        examples=[20, "all", [0, 10, 20]],
    )
    seed: Annotated[int, Field(ge=0, le=MAX_COUNT)] = Field(
        default=0, description="Seed of the random choice of points."
    )

    def run(self, model: Model, progress: Callable[[float], None] | None) -> ForcedResponse:
        """Compute one curve, and compare it."""
        first = second = None
        if progress is not None:
            first = lambda share: progress(_BALANCE * share)  # noqa: E731
            second = lambda share: progress(_BALANCE + (1.0 - _BALANCE) * share)  # noqa: E731
        return certify(self.balance(model, first), self.points, seed=self.seed, progress=second)

"""Samples of a quantity under uncertain parameters: percentiles, surrogates, Sobol indices."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant, unknown
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.results.dataset import Stored, labels
from stickslip.results.expansion import Expansion, SobolIndices, fit_expansion
from stickslip.results.fields import Bool, Code, Columns, Float, column
from stickslip.results.result import ColumnResult
from stickslip.results.status import Ending
from stickslip.results.weibull import empirical_percentile
from stickslip.settings.quantities import Backbone
from stickslip.settings.uncertainty import SampledSettings, distribution

MISTUNING = "mistuning"
"""The parameter that every sector of a disk has for itself."""


class SampleStatus(Ending):
    """How the computation of a sample ended; compares equal to its text."""

    COMPUTED = ("computed", "All numbers were found. Nothing needs to be done.")
    FAILED = (
        "failed",
        "Numbers are missing. The reason of the sample says why.",
    )
    NOT_COMPUTED = (
        "not computed",
        "The run was stopped before, or computes another portion. Run it again.",
    )


class SamplePercentile(NamedTuple):
    """A percentile of samples, with an interval that holds for any distribution."""

    value: float
    """Of the samples that were found."""
    low: float
    """Lower end; minus infinity: too few samples."""
    high: float
    """Upper end; infinity: too few samples."""
    failed: int
    """Samples without the number, which the interval lets lie anywhere."""


class UncertaintyArrays(Columns):
    """The numbers of a study of uncertain parameters."""

    parameter: Float = column("sample input", "1", "value of the parameter, in SI units")
    value: Float = column(
        "sample number", "1", "number of the quantity, in SI units; not-a-number: not found"
    )
    error_estimate: Float = column(
        "sample number",
        "1",
        "what the discarded harmonics could still change; not-a-number: not estimated",
        least=0.0,
    )
    status: Code = column("sample", "1", "how the computation ended", codes=SampleStatus)

    @cached_property
    def failed(self) -> Bool:
        """(n,) Whether a sample was computed and numbers are missing."""
        return constant(self.status == SampleStatus.FAILED.code)


class Uncertainty(ColumnResult):
    """A quantity of a model whose parameters are uncertain, sample by sample.

    Attributes
    ----------
    model : Model
        The model as given.
    reasons : tuple of str
        Why numbers are missing, one text per sample; empty where none is.
    """

    kind: ClassVar[str] = "uncertainty"
    title = "Quantity of a structure with dry friction whose parameters are uncertain"

    settings: SampledSettings
    arrays: UncertaintyArrays
    reasons: tuple[str, ...]

    plot = plot_distribution = Drawn("uncertainty_distribution")
    plot_sobol = Drawn("sobol_indices")
    plot_backbone = Drawn("backbone_band")

    def __repr__(self) -> str:
        count = self.arrays.status.size
        return (
            f"Uncertainty({', '.join(self.settings.parameters)}: {self.settings.quantity.kind} of "
            f"{self.computed} of {count} samples, {self.failed} failed)"
        )

    @property
    def numbers(self) -> tuple[str, ...]:
        """Names of the numbers of the quantity."""
        return tuple(self.settings.quantity.numbers)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the uncertain numbers; mistuning is one per sector."""
        return input_names(self.settings, self.arrays.parameter.shape[1])

    @property
    def computed(self) -> int:
        """How many samples have all their numbers."""
        return int((self.arrays.status == SampleStatus.COMPUTED.code).sum())

    @property
    def failed(self) -> int:
        """How many samples were computed and lack a number."""
        return int(self.arrays.failed.sum())

    @cached_property
    def status(self) -> NDArray[np.object_]:
        """How each sample ended, shape (n,); `SampleStatus`, with its advice."""
        return SampleStatus.array(self.arrays.status)

    def values(self, number: str) -> Float:
        """Return a number of all samples, shape (n,); not-a-number where it was not found.

        Raises ModelError if the quantity has no such number.

        Parameters
        ----------
        number : str
            Its name: one of `numbers`.
        """
        return self.arrays.value[:, self._number(number)]

    def parameter(self, name: str) -> Float:
        """Return an uncertain number of all samples, shape (n,).

        Raises ModelError if there is none of this name.

        Parameters
        ----------
        name : str
            Its name: one of `inputs`.
        """
        if name not in self.inputs:
            raise ModelError(unknown("parameter", name, self.inputs))
        return self.arrays.parameter[:, self.inputs.index(name)]

    def percentile(self, number: str, q: float, confidence: float = 0.95) -> SamplePercentile:
        """Return what q percent do not exceed, from the samples themselves, with its interval.

        The interval is that of order statistics, whatever the distribution: exact for samples at
        random, and wider than need be for those of a Sobol sequence. Failed samples may have any
        number; they make it wider.

        Raises ModelError if the number is unknown, q is not between 0 and 100, or nothing was
        found.

        Parameters
        ----------
        number : str
            One of `numbers`.
        q : float
            From 0 to 100, exclusive.
        confidence : float, optional
            Probability that the interval holds the percentile.
        """
        values = self.values(number)
        computed = self.arrays.status != SampleStatus.NOT_COMPUTED.code
        missing = int((computed & np.isnan(values)).sum())
        if missing == computed.sum():
            raise ModelError(f"percentile: no sample has {number!r}; see reasons")
        return SamplePercentile(*empirical_percentile(values, q, confidence, missing), missing)

    def expansion(self, number: str, degree: int | None = None) -> Expansion:
        """Return a sparse polynomial surrogate of a number, with its error by cross-validation.

        Failed samples are left out of it. It is fitted by OpenTURNS: pip install
        'stickslip[uncertainty]'.

        Raises ModelError if the number is unknown, OpenTURNS is not installed, or there are fewer
        than 16 samples.

        Parameters
        ----------
        number : str
            One of `numbers`.
        degree : int, optional
            Highest degree. Default: the one of the least error by cross-validation.
        """
        key = self._number(number), degree
        if key not in self._expansions:
            found = np.isfinite(self.values(number))
            laws = distributions(self.settings, len(self.inputs))
            self._expansions[key] = fit_expansion(
                self.inputs, laws, self.arrays.parameter[found], self.values(number)[found], degree
            )
        return self._expansions[key]

    def sobol(self, number: str, confidence: float = 0.95) -> SobolIndices:
        """Return the shares that parameters have in the variance of a number: see `expansion`.

        Raises ModelError as `expansion`; if the number does not vary.

        Parameters
        ----------
        number : str
            One of `numbers`.
        confidence : float, optional
            Probability that an interval holds the share.
        """
        return self.expansion(number).sobol(confidence)

    @cached_property
    def _expansions(self) -> dict[tuple[int, int | None], Expansion]:
        return {}

    @property
    def backbone(self) -> Backbone:
        """The backbone that was asked for.

        Raises ModelError if another quantity was.
        """
        if not isinstance(self.settings.quantity, Backbone):
            raise ModelError(
                f"result: its quantity is a {self.settings.quantity.kind}, no backbone"
            )
        return self.settings.quantity

    def _number(self, number: str) -> int:
        if number not in self.numbers:
            raise ModelError(unknown("number", number, self.numbers))
        return self.numbers.index(number)

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        return {
            "input": labels("input", self.inputs, "uncertain parameter"),
            "number": labels("number", self.numbers, "number of the quantity"),
            "reason": labels("sample", self.reasons, "why numbers are missing"),
        }

    @classmethod
    def _further_arguments(cls, dataset: Stored) -> dict[str, Any]:
        return {"reasons": tuple(map(str, dataset["reason"].values))}


def input_names(settings: SampledSettings, count: int) -> tuple[str, ...]:
    """Return the names of the uncertain numbers, of which there are `count`."""
    sectors = count - len(settings.parameters) + 1
    return tuple(
        one
        for name in settings.parameters
        for one in (
            [f"{name}[{sector}]" for sector in range(sectors)] if name == MISTUNING else [name]
        )
    )


def distributions(settings: SampledSettings, count: int) -> list[Any]:
    """Return the distributions of the uncertain numbers, of which there are `count`."""
    laws = {name: distribution(spec) for name, spec in settings.parameters.items()}
    return [
        laws[name.partition("[")[0] if name not in laws else name]
        for name in input_names(settings, count)
    ]


def reasons_in_words(reasons: tuple[str, ...]) -> Mapping[str, int]:
    """Return how often each reason stands, the most frequent first."""
    counts: dict[str, int] = {}
    for one in filter(None, reasons):
        counts[one] = counts.get(one, 0) + 1
    return MappingProxyType(dict(sorted(counts.items(), key=lambda pair: -pair[1])))

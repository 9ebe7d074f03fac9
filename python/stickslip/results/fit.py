"""Parameters fitted to measurements: values, intervals, and what the data leave open."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from stickslip.checks import constant, unknown
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.results.dataset import Stored, labels
from stickslip.results.fields import Bool, Code, Columns, Float, Int, column
from stickslip.results.result import Attributes, ColumnResult
from stickslip.settings.fit import FitSettings

KINDS = ("measurement", "measured peak", "measured loop", "measured backbone")
"""Kinds of measurements."""

QUANTITIES = ("amplitude", "force", "omega", "damping_ratio")
"""What a measured number is."""

AGAINST = ("frequency", "displacement", "amplitude", "modal amplitude")
"""What numbers are measured against."""

WIDE = 0.25
"""Width of an interval, relative to the value, from which the data do not determine it."""


def _kinds(dataset: Stored) -> Code:
    return np.asarray(dataset["test_kind"].values, np.uint8)


def _quantities(dataset: Stored) -> Code:
    """Return what the numbers of the first files are: behind the height of a peak its frequency."""
    test = dataset["test"].values
    kinds = _kinds(dataset)[test]
    behind = np.append(False, test[1:] == test[:-1]) & (kinds == KINDS.index("measured peak"))
    found = np.where(kinds == KINDS.index("measured loop"), "force", "amplitude")
    found = np.where(behind, "omega", found)
    return np.array([QUANTITIES.index(one) for one in found], np.uint8)


def _against(dataset: Stored) -> Code:
    return np.asarray(_kinds(dataset) == KINDS.index("measured loop"), np.uint8)


class FitArrays(Columns):
    """The numbers of a fit."""

    value: Float = column("parameter", "1", "value of the parameter, in SI units")
    interval: Float = column("parameter side", "1", "ends of its interval, in SI units")
    open_end: Bool = column(
        "parameter side", "1", "whether the interval goes on to the bound, or its end was not found"
    )
    correlation: Float = column(
        "parameter other_parameter",
        "1",
        "correlation of the scaled parameters",
        least=-1.0,
        most=1.0,
    )
    abscissa: Float = column("entry", "1", "frequency [rad/s], displacement [m] or amplitude")
    observed: Float = column("entry", "1", "measured number, in SI units")
    deviation: Float = column(
        "entry", "1", "standard deviation; of noise that is not known up to a factor", least=0.0
    )
    predicted: Float = column("entry", "1", "number that the fitted model predicts")
    solved: Bool = column("entry", "1", "whether it was found")
    test_kind: Code = column("test_name", "1", "what was measured", codes=KINDS)
    quantity: Code = column(
        "entry", "1", "what the number is", codes=QUANTITIES, absent=_quantities
    )
    against: Code = column("test_name", "1", "what the abscissa is", codes=AGAINST, absent=_against)
    test: Int = column("entry", "1", "position of the measurement", least=0)
    minimum: Float = column("minimum_number", "1", "misfit of each minimum that was found", least=0)
    minimum_value: Float = column("minimum_number parameter", "1", "values of the parameters there")


class Fit(ColumnResult):
    """Parameters fitted to measurements.

    Attributes
    ----------
    model : Model
        The model at the fitted values.
    names : tuple of str
        Names of the measurements.
    noise_known : bool
        Whether the noise was given; else it was estimated from the misfit.
    """

    kind: ClassVar[str] = "fit"
    title = "Parameters of a structure with dry friction, fitted to measurements"
    attributes: ClassVar[Attributes] = {"interrupted": bool, "noise_known": bool}

    settings: FitSettings
    arrays: FitArrays
    names: tuple[str, ...]
    noise_known: bool

    plot = Drawn("fit")
    plot_residuals = Drawn("fit_residuals")
    plot_intervals = Drawn("fit_intervals")
    plot_backbone = Drawn("fit_backbone")

    def __repr__(self) -> str:
        found = ", ".join(f"{name} = {value:.5g}" for name, value in self.values.items())
        return f"Fit({found}; {self.arrays.observed.size} numbers, misfit {self.misfit:.4g})"

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(self.settings.parameters)

    @cached_property
    def values(self) -> Mapping[str, float]:
        """Fitted values by the names of the parameters, in SI units."""
        return self._by_name(self.arrays.value.tolist())

    @cached_property
    def intervals(self) -> Mapping[str, tuple[float, float]]:
        """Intervals (low, high) that hold the true values with `settings.confidence`."""
        return self._by_name([tuple(ends) for ends in self.arrays.interval.tolist()])

    @cached_property
    def identifiable(self) -> Mapping[str, bool]:
        """Whether the data determine each parameter.

        Its interval has both ends, and is narrower than a quarter of the value; of parameters that
        may be zero, than a quarter of the distance of the bounds.
        """
        return self._by_name((relative_width(self.arrays, self.settings) <= WIDE).tolist())

    def _by_name(self, values: list[Any]) -> Mapping[str, Any]:
        return MappingProxyType(dict(zip(self.parameters, values, strict=True)))

    def correlation(self, one: str, other: str) -> float:
        """Return the correlation of two parameters: near 1 or -1, only a combination is known.

        Raises ModelError if a name is unknown.
        """
        rows = [self._place(name) for name in (one, other)]
        return float(self.arrays.correlation[rows[0], rows[1]])

    def _place(self, name: str) -> int:
        if name not in self.parameters:
            raise ModelError(unknown("parameter", name, self.parameters))
        return self.parameters.index(name)

    @cached_property
    def residuals(self) -> Float:
        """Prediction less measurement over the standard deviation, shape (n,)."""
        arrays = self.arrays
        return constant((arrays.predicted - arrays.observed) / arrays.deviation)

    @property
    def misfit(self) -> float:
        """Sum of the squared `residuals`."""
        return float(self.residuals @ self.residuals)

    @property
    def freedom(self) -> int:
        """Numbers measured less parameters."""
        return self.arrays.observed.size - self.arrays.value.size

    @property
    def scatter(self) -> float:
        """Standard deviation of the residuals: about 1 if the model fits within a known noise.

        Of noise that was not given, its estimate as a share of the amplitudes.
        """
        return float(np.sqrt(self.misfit / self.freedom)) if self.freedom else float("nan")

    @property
    def bic(self) -> float:
        """Bayesian information criterion; of several laws fitted to the same data the least wins.

        Schwarz (1978).
        """
        count = self.arrays.observed.size
        penalty = self.arrays.value.size * float(np.log(count))
        if self.noise_known:
            return self.misfit + penalty
        return count * float(np.log(self.misfit / count)) + penalty

    def of_test(self, test: int | str) -> Bool:
        """Return which numbers belong to a measurement, shape (n,).

        Raises ModelError if there is no such measurement.
        """
        place = self.names.index(test) if test in self.names else test
        if not isinstance(place, int) or not 0 <= place < len(self.names):
            raise ModelError(unknown("measurement", test, self.names))
        return constant(self.arrays.test == place)

    @property
    def of_curves(self) -> Bool:
        """Which numbers are those of response curves and peaks, shape (n,)."""
        return self._against("frequency")

    @property
    def of_loops(self) -> Bool:
        """Which numbers are those of hysteresis loops, shape (n,)."""
        return self._against("displacement")

    def of_backbones(self, *, damping: bool) -> Bool:
        """Return which numbers are damping ratios of backbones, or else frequencies, shape (n,)."""
        place = QUANTITIES.index("damping_ratio" if damping else "omega")
        own = self._against("amplitude") | self._against("modal amplitude")
        return constant(own & (self.arrays.quantity == place))

    def _against(self, what: str) -> Bool:
        return constant((self.arrays.against == AGAINST.index(what))[self.arrays.test])

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        return {
            "parameter": labels("parameter", self.parameters, "fitted parameter"),
            "test_name": labels("test_name", self.names, "measurement"),
        }

    @classmethod
    def _further_arguments(cls, dataset: Stored) -> dict[str, Any]:
        return {"names": tuple(map(str, dataset["test_name"].values))}


def relative_width(arrays: FitArrays, settings: FitSettings) -> Float:
    """Return the widths of the intervals relative to the values, shape (k,); infinite if open.

    Of parameters that may be zero, relative to the distance of their bounds.
    """
    low, high = arrays.interval.T
    bounds = np.array(list(settings.parameters.values()))
    scale = np.where(bounds[:, 0] > 0.0, np.abs(arrays.value), bounds[:, 1] - bounds[:, 0])
    width: Float = (high - low) / scale
    width[arrays.open_end.any(axis=1) | ~np.isfinite(width)] = np.inf
    return width


@dataclass(frozen=True)
class FitComparison:
    """Several fits to the same data, side by side.

    Attributes
    ----------
    fits : mapping of Fit
        The fits by name.
    """

    fits: Mapping[str, Fit]

    @property
    def best(self) -> str:
        """Name of the fit with the least information criterion."""
        return min(self.fits, key=lambda name: self.fits[name].bic)

    @property
    def weights(self) -> Mapping[str, float]:
        """Share of the likelihood that each fit has, if one of them is right."""
        least = self.fits[self.best].bic
        found = {name: float(np.exp(0.5 * (least - one.bic))) for name, one in self.fits.items()}
        return {name: one / sum(found.values()) for name, one in found.items()}

    def __str__(self) -> str:
        width = max(len("fit"), *map(len, self.fits))
        rows = [f"{'fit':<{width}}  parameters  scatter        BIC  weight"]
        for name, one in self.fits.items():
            rows.append(
                f"{name:<{width}}  {one.arrays.value.size:>10}  {one.scatter:>7.4g}  "
                f"{one.bic:>9.5g}  {self.weights[name]:>6.3f}"
            )
        return "\n".join(rows)


def compare_fits(fits: Mapping[str, Fit]) -> FitComparison:
    """Put fits of several laws to the same measurements side by side.

    Parameters
    ----------
    fits : mapping of str to Fit
        The fits by what tells them apart: ``{"jenkins": one, "iwan": other}``.

    Returns
    -------
    FitComparison
        With `best`, `weights`, and a table as its text.

    Raises
    ------
    ModelError
        If the fits are not of the same numbers with the same noise.
    """
    if (
        not isinstance(fits, Mapping)
        or not fits
        or not all(isinstance(one, Fit) for one in fits.values())
    ):
        raise ModelError('compare_fits: give fits by name, {"jenkins": ss.fit(...), ...}')
    first = next(iter(fits.values()))
    for name, one in fits.items():
        same = all(
            np.array_equal(getattr(one.arrays, what), getattr(first.arrays, what), equal_nan=True)
            for what in ("observed", "abscissa", "deviation")
        )
        if not same or one.noise_known != first.noise_known:
            raise ModelError(
                f"compare_fits: {name!r} was fitted to other numbers, or with other noise, than "
                f"{next(iter(fits))!r}; criteria compare fits of the same measurements"
            )
    return FitComparison(MappingProxyType(dict(fits)))

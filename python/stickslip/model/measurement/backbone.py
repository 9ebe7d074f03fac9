"""Backbones that tests have measured: frequency and damping of a mode against amplitude."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import choice, text, whole_number
from stickslip.errors import ModelError
from stickslip.model.measurement.measured import MEASURES, Measured, above_zero, real_numbers
from stickslip.model.model import Model


@dataclass(frozen=True, init=False, eq=False, repr=False)
class MeasuredBackbone(Measured):
    """Frequencies and damping ratios of a mode against its amplitude, as free decays show them.

    Amplitudes are taken to be exact: what is uncertain in them belongs to the noise of frequencies
    and damping ratios.

    Parameters
    ----------
    amplitude : array_like of float, shape (n,)
        Amplitudes of the degree of freedom [m], without one those of the mode,
        a = (X_1^H M X_1)^(1/2) [m kg^(1/2)]; above 0, in any order.
    omega : array_like of float, shape (n,), optional
        Angular frequencies of the vibration at these amplitudes [rad/s].
    damping_ratio : array_like of float, shape (n,), optional
        Damping ratios there; of a decay the logarithmic decrement over 2 pi.
    dof : str, optional
        The degree of freedom whose amplitudes they are. Default: modal amplitudes.
    measure : {"half_range", "max", "fundamental"}, optional
        What was called amplitude of the degree of freedom.
    mode : int, optional
        Mode of the structure with its contacts at rest, counted from 0.
    frequency_noise : float, optional
        Standard deviation of each frequency over itself, 0.001 for 0.1 %.
    damping_noise : float, optional
        Standard deviation of each damping ratio over itself, 0.02 for 2 %. Of frequencies alone, or
        damping ratios alone, the noise may be unknown: the fit estimates it.
    model, name
        See `Measurement`.

    Raises
    ------
    ModelError
        If the lists differ in length, both are missing, a number is not finite or not above 0, or
        the noise of one of two quantities is not known.
    """

    kind: ClassVar[str] = "measured backbone"

    amplitude: NDArray[np.float64]
    omega: NDArray[np.float64] | None
    damping_ratio: NDArray[np.float64] | None
    dof: str | None
    measure: Any
    mode: int
    frequency_noise: float | None
    damping_noise: float | None

    def __init__(
        self,
        amplitude: ArrayLike,
        omega: ArrayLike | None = None,
        damping_ratio: ArrayLike | None = None,
        *,
        dof: str | None = None,
        measure: str = "half_range",
        mode: int = 0,
        frequency_noise: float | None = None,
        damping_noise: float | None = None,
        model: Model | None = None,
        name: str | None = None,
    ) -> None:
        unit = "m kg^(1/2)" if dof is None else "m"
        place = real_numbers(amplitude, unit, "measured backbone: amplitude", above=0.0)
        columns = {
            entry: real_numbers(values, unit, f"measured backbone: {entry}", above=0.0)
            for entry, values, unit in (
                ("omega", omega, "rad/s"),
                ("damping_ratio", damping_ratio, ""),
            )
            if values is not None
        }
        noises = {
            "omega": above_zero(frequency_noise, "", "measured backbone: frequency_noise"),
            "damping_ratio": above_zero(damping_noise, "", "measured backbone: damping_noise"),
        }
        if not columns:
            raise ModelError("measured backbone: no numbers; give omega, damping_ratio or both")
        for entry, values in columns.items():
            if values.shape != place.shape:
                raise ModelError(
                    f"measured backbone: {place.size} amplitudes for {values.size} of {entry}; "
                    "give one per amplitude"
                )
        if len(columns) > 1 and None in noises.values():
            raise ModelError(
                "measured backbone: omega and damping_ratio without the noise of each; give "
                "frequency_noise and damping_noise, or one of the quantities"
            )
        count = whole_number(mode, "measured backbone: mode", smallest=0)
        self._keep(
            of=f"mode {count}" if dof is None else text(dof, "measured backbone: dof"),
            abscissa=np.tile(place, len(columns)),
            observed=np.concatenate([*columns.values()]),
            amplitude=place,
            omega=columns.get("omega"),
            damping_ratio=columns.get("damping_ratio"),
            dof=dof,
            measure=choice(measure, "measured backbone: measure", MEASURES),
            mode=count,
            frequency_noise=noises["omega"],
            damping_noise=noises["damping_ratio"],
            relative_noise=None,
            noise=None,
            model=model,
            name=name,
        )

    @property
    def against(self) -> str:  # type: ignore[override]
        """What the numbers are measured against: an amplitude of the DOF or of the mode."""
        return "modal amplitude" if self.dof is None else "amplitude"

    @property
    def columns(self) -> tuple[str, ...]:
        """What was measured, in the order of the numbers: "omega", "damping_ratio" or both."""
        known = {"omega": self.omega, "damping_ratio": self.damping_ratio}
        return tuple(entry for entry, values in known.items() if values is not None)

    @property
    def quantities(self) -> Sequence[str]:
        """The frequencies, and behind them the damping ratios, as far as they were measured."""
        return tuple(entry for entry in self.columns for _ in self.amplitude)

    @property
    def noise_known(self) -> bool:
        """Whether the standard deviations are known."""
        return None not in self._noises

    @property
    def deviation(self) -> NDArray[np.float64]:
        """Standard deviation of frequencies and damping ratios; unknown, up to a factor."""
        shares = [1.0 if noise is None else noise for noise in self._noises]
        return np.repeat(shares, self.amplitude.size) * self.observed

    @property
    def _noises(self) -> list[float | None]:
        noises = {"omega": self.frequency_noise, "damping_ratio": self.damping_noise}
        return [noises[entry] for entry in self.columns]

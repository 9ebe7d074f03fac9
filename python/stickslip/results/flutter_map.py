"""The limit cycles of all travelling waves of a tuned disk in a flow."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any, ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, choice, constant, whole_number
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.results.fields import Columns, Complex, Float, Int, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.settings.flutter import FlutterSettings

Fate: TypeAlias = Literal[
    "decays",
    "limit cycle",
    "kick",
    "limit cycle, kick",
    "decays, limit cycle",
    "decays, limit cycle, kick",
    "grows",
]

FATES: Mapping[Fate, str] = {
    "decays": "dies out from every amplitude",
    "limit cycle": "settles on a limit cycle from every amplitude",
    "kick": "dies out, or grows without bound from beyond an unstable limit cycle",
    "limit cycle, kick": "settles on a limit cycle, or grows without bound from beyond another",
    "decays, limit cycle": "dies out, or settles on a limit cycle from beyond an unstable one",
    "decays, limit cycle, kick": "dies out, settles on a limit cycle, or grows without bound, as "
    "far as it is beyond unstable ones",
    "grows": "grows without bound",
}
"""What becomes of a wave by itself, within the amplitudes that were computed."""

STATES = ("not decided", "unstable", "stable")
"""Stability of a limit cycle."""


class WaveCycle(NamedTuple):
    """A limit cycle of a travelling wave."""

    diameter: int
    """Nodal diameter, negative where the wave runs backwards."""
    modal_amplitude: float
    """[m kg^(1/2)]"""
    omega: float
    """Angular frequency [rad/s]."""
    slope: float
    """d zeta / d ln a of the whole damping there."""
    stability: str
    """"stable", "unstable" or "not decided": by the multipliers, or without by the slope."""
    multiplier: float
    """Largest modulus of the Floquet multipliers but the trivial 1; not-a-number if unknown."""
    error: float
    """Of the amplitude, relative to the solution of the whole equations; not-a-number without."""


class FlutterArrays(Columns):
    """The numbers of a flutter map; wave d is that of nodal diameter d.

    Where the nonlinear mode was not found they are not-a-number.
    """

    amplitude: Float = column(
        "modal_amplitude_point", "m kg^(1/2)", "modal amplitude of a sector", least=0.0
    )
    omega: Float = column(
        "wave modal_amplitude_point", "rad/s", "angular frequency, with the flow", least=0.0
    )
    disk_ratio: Float = column(
        "wave modal_amplitude_point", "1", "damping ratio of disk and friction, at that frequency"
    )
    aerodynamic_ratio: Float = column(
        "wave modal_amplitude_point", "1", "damping ratio of the flow, at that frequency"
    )
    participation: Float = column(
        "wave modal_amplitude_point",
        "1",
        "work of a flow at given coefficient over that at rest, at equal amplitude",
        least=0.0,
    )
    displacement: Float = column(
        "wave modal_amplitude_point dof", "m", "half peak-to-peak amplitude of a displacement"
    )
    rest_omega: Float = column("wave", "rad/s", "angular frequency at rest, with the flow")
    rest_aerodynamic_ratio: Float = column("wave", "1", "damping ratio of the flow at rest")
    rest_ratio: Float = column("wave", "1", "damping ratio at rest, without slip")
    coefficient: Complex = column(
        "wave", "1/s^2", "coefficient of the flow on the mode at rest, of unit modal mass"
    )
    cycle_wave: Int = column("cycle", "1", "its nodal diameter, 0 to n-1", least=0, most="wave")
    cycle_amplitude: Float = column("cycle", "m kg^(1/2)", "modal amplitude", least=0.0)
    cycle_omega: Float = column("cycle", "rad/s", "angular frequency", least=0.0)
    cycle_slope: Float = column("cycle", "1", "slope of the damping ratio over ln a")
    cycle_state: Int = column("cycle", "1", "stability, by multipliers or that slope", codes=STATES)
    cycle_multiplier: Float = column(
        "cycle", "1", "largest modulus of multipliers but the trivial 1", least=0.0
    )
    cycle_error: Float = column(
        "cycle",
        "1",
        "error of the amplitude, relative to the solution of the whole equations",
        least=0.0,
        absent=np.nan,
    )
    cycle_displacement: Float = column(
        "cycle dof", "m", "half peak-to-peak amplitude of a displacement"
    )


class FlutterMap(ColumnResult):
    """Amplitude and stability of every travelling wave of a tuned disk in a flow.

    Arrays have one row per nodal diameter 0 to n-1; n - d runs backwards. Limit cycles come by
    their wave, the least stable wave first, and rising amplitude.
    """

    kind: ClassVar[str] = "flutter_map"
    title = "Limit cycles of the travelling waves of a tuned disk"

    settings: FlutterSettings
    arrays: FlutterArrays

    def __repr__(self) -> str:
        stable = int((self.arrays.cycle_state == STATES.index("stable")).sum())
        return (
            f"FlutterMap({self.rest_ratio.size} waves of mode {self.settings.mode}, least stable "
            f"{self.signed(self.least_stable)} with {self.rest_ratio.min():.4g}, "
            f"{self.arrays.cycle_wave.size} limit cycles, {stable} of them stable)"
        )

    modal_amplitude = Shown[Float]("amplitude")
    omega = Shown[Float]()
    disk_ratio = Shown[Float]()
    aerodynamic_ratio = Shown[Float]()
    rest_omega = Shown[Float]()
    rest_ratio = Shown[Float]()

    plot = Drawn("flutter_map")
    plot_limits = Drawn("aerodynamic_limits")

    @property
    def diameters(self) -> Int:
        """Signed nodal diameters of the waves, shape (n,): above n/2 they are d - n."""
        return constant(np.array([self.signed(d) for d in range(self.rest_ratio.size)]))

    @property
    def ratio(self) -> Float:
        """Damping ratio of flow, disk and friction, shape (n, A); zero on limit cycles."""
        return constant(self.disk_ratio + self.aerodynamic_ratio)

    @property
    def order(self) -> Int:
        """The waves, the least stable first, shape (n,): by their damping ratio at rest."""
        return constant(np.argsort(self.rest_ratio, kind="stable"))

    @property
    def least_stable(self) -> int:
        """Nodal diameter of the wave with the least damping ratio at rest, 0 to n-1."""
        return int(self.order[0])

    def signed(self, diameter: int) -> int:
        """Return a nodal diameter from 0 to n-1 as a signed one."""
        n = self.rest_ratio.size
        return diameter - n if 2 * diameter > n else diameter

    def cycles(self, diameter: int | None = None) -> tuple[WaveCycle, ...]:
        """Return the limit cycles of one nodal diameter, also a negative one, or of all.

        By rising amplitude; the wave that is the least stable at rest comes first.
        """
        arrays = self.arrays
        chosen = range(arrays.cycle_wave.size)
        if diameter is not None:
            place = self._place(diameter)
            chosen = [i for i in chosen if arrays.cycle_wave[i] == place]  # type: ignore[assignment]
        return tuple(
            WaveCycle(
                self.signed(int(arrays.cycle_wave[i])),
                float(arrays.cycle_amplitude[i]),
                float(arrays.cycle_omega[i]),
                float(arrays.cycle_slope[i]),
                STATES[int(arrays.cycle_state[i])],
                float(arrays.cycle_multiplier[i]),
                float(arrays.cycle_error[i]),
            )
            for i in chosen
        )

    def amplitude(self, dof: str, which: Literal["bounding", "leaving"] = "bounding") -> Float:
        """Return the amplitude of a displacement on a limit cycle of every wave, shape (n,) [m].

        "bounding" are the least at which the damping rises, to which a wave by itself comes,
        "leaving" the least at which it falls: from beyond them it leaves. Not-a-number where there
        is none.
        """
        choice(which, "which", ("bounding", "leaving"))
        column, arrays = self._column(dof), self.arrays
        found = np.full(self.rest_ratio.size, np.nan)
        for index in np.flatnonzero((arrays.cycle_slope > 0.0) == (which == "bounding"))[
            ::-1
        ].tolist():
            found[arrays.cycle_wave[index]] = arrays.cycle_displacement[index, column]
        return constant(found)

    def fate(self, diameter: int) -> Fate:
        """Return what becomes of a wave by itself; `FATES` says what the words mean."""
        place = self._place(diameter)
        rises = [one.slope > 0.0 for one in self.cycles(place)]
        rest = self.rest_ratio[place] >= 0.0
        if not rises:
            return "decays" if rest else "grows"
        if not any(rises):
            return "kick"
        if rises[0]:
            return "limit cycle" if rises[-1] else "limit cycle, kick"
        return "decays, limit cycle" if rises[-1] else "decays, limit cycle, kick"

    def limit_amplitude(self, dof: str, aerodynamic_ratio: ArrayLike) -> Float:
        """Return limit-cycle amplitudes over nodal diameter and aerodynamic damping [m].

        Shape (n, Z, 2): of the stable cycle and of the unstable one beyond it, under the flow that
        has these damping ratios at rest, the same in all waves. Not-a-number where there is none.

        Parameters
        ----------
        dof : str
            The displacement.
        aerodynamic_ratio : array_like, shape (Z,)
            Damping ratios of the flow at rest, negative where it feeds the wave.
        """
        try:
            ratios = np.atleast_1d(np.asarray(aerodynamic_ratio, dtype=np.float64))
        except (TypeError, ValueError):
            ratios = np.array([np.nan])
        if ratios.ndim != 1 or not np.isfinite(ratios).all():
            raise ModelError(f"aerodynamic_ratio: {brief(aerodynamic_ratio)}; give finite numbers")
        sizes = self.arrays.displacement[:, :, self._column(dof)]
        found = np.full((sizes.shape[0], ratios.size, 2), np.nan)
        for wave, own in enumerate(self.disk_ratio):
            for place, ratio in enumerate(ratios.tolist()):
                total = own + ratio * self.arrays.participation[wave]
                found[wave, place] = _crossings(total, sizes[wave])
        return constant(found)

    @property
    def held_ratio(self) -> Float:
        """Largest negative damping ratio of the flow at rest that friction holds, shape (n,).

        Not-a-number of waves that were not found.
        """
        return constant(-np.fmax.reduce(self.disk_ratio / self.arrays.participation, axis=1))

    def _place(self, diameter: int) -> int:
        n = self.rest_ratio.size
        if isinstance(diameter, int | np.integer) and -n < diameter < 0:
            return int(diameter) % n
        place = whole_number(diameter, "diameter")
        if place >= n:
            raise ModelError(f"diameter: {place}; {n} sectors have 0 to {n - 1}, or signed ones")
        return place

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        if not derived:
            return {}
        about = {"units": "1", "long_name": "signed nodal diameter of the wave"}
        return {"nodal_diameter": ("wave", self.diameters, about)}


def _crossings(total: NDArray[np.float64], size: NDArray[np.float64]) -> Sequence[float]:
    """Return the size at the first rise of the damping through zero, and at its next fall."""
    known = np.flatnonzero(np.isfinite(total) & (size > 0.0))
    total, log = total[known], np.log(size[known])
    if not known.size:
        return np.nan, np.nan
    rises = np.flatnonzero((total[:-1] < 0.0) & (total[1:] >= 0.0))
    falls = np.flatnonzero((total[:-1] >= 0.0) & (total[1:] < 0.0))
    # What falls before it rises is unstable below the stable one.
    falls = falls[falls > rises[0]] if rises.size else falls
    ends = []
    for ways in (rises, falls):
        if not ways.size:
            ends.append(np.nan)
            continue
        at = ways[0]
        share = total[at] / (total[at] - total[at + 1])
        ends.append(float(np.exp(log[at] + share * (log[at + 1] - log[at]))))
    return ends

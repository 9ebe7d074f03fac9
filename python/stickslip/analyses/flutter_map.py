"""Limit cycles of every travelling wave of a tuned disk in a flow, from its nonlinear modes.

The flow's force ``p L p^H x`` acts as the damping ``-Im L / omega_d`` of the frequency omega_d at
rest, as it does in `stickslip.limit_cycles`: in a motion of amplitude X and frequency omega it does
the work ``pi (omega / omega_d) Im L |p^H X|^2`` per period, which disk and friction take. A limit
cycle is where the damping ratio of the nonlinear mode at the amplitude a and that of the flow add
up to nothing, ``zeta(a) + zeta_aero(d, a) = 0``.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.run import Progress, Run
from stickslip.analyses.side_by_side import has_own_laws, in_turn
from stickslip.analyses.texts import told
from stickslip.analyses.wave_stability import WaveModes, wave_cycles, wave_multiplier
from stickslip.disk.aerodynamics import Aerodynamics
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.waves import AerodynamicWaves, aerodynamic_waves
from stickslip.errors import ModelError
from stickslip.results.diagnostic import present
from stickslip.results.flutter_map import STATES, FlutterArrays, FlutterMap
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.settings.flutter import FlutterKeys, FlutterModeSettings, FlutterSettings
from stickslip.settings.settings import configured

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

_ROUNDS = 8
"""Times that the modes are computed where their damping seems to vanish."""
_CLOSE = 0.003
"""Relative distance of the amplitudes on both sides of one at which the damping vanishes."""
_BELOW, _BEYOND = 0.5, 100.0
"""Where amplitudes begin and end by default, in those at which contacts begin to slip."""
_DIFFERS = 0.01
"""Error of the amplitude of a limit cycle that is named."""
_FLAT = 1e-9
"""Slope of the damping, relative to its size, that decides nothing."""


@configured(FlutterKeys)
def flutter_map(
    disk: BladedDisk,
    aerodynamics: Aerodynamics,
    *,
    settings: FlutterKeys,
    progress: Progress = None,
) -> FlutterMap:
    """Amplitude and stability of every travelling wave of a tuned disk in a flow.

    Of each nodal diameter the nonlinear mode is computed once; its damping and that of the flow
    add up to zero on limit cycles. Where the sum rises with the amplitude the cycle is stable
    against changes of its own amplitude, where it falls unstable: a start beyond it grows. Whether
    other waves leave it be is decided by `multipliers` alone.

    Parameters
    ----------
    disk : BladedDisk
        The disk; its forces but static ones, and its engine order, play no part.
    aerodynamics : InfluenceCoefficients, AerodynamicDamping or ModalForces
        What the flow does.

    Returns
    -------
    FlutterMap
        By nodal diameter.

    Raises
    ------
    ModelError
        If `disk` is no tuned `BladedDisk`, there is no such mode, or the flow is not known at a
        nodal diameter; if no contact says at which force it slips, and no amplitude is given.
    Interrupted
        It holds the waves so far; numbers of others are not-a-number.

    References
    ----------
    Krack, Salles and Thouverez (2017), Arch. Comput. Methods Eng. 24, 589, section 4.2; Petrov
    (2012), J. Eng. Gas Turb. Power 134.
    """
    waves = aerodynamic_waves(disk, aerodynamics, settings.mode)
    amplitudes = _amplitudes(waves, settings)
    kept = FlutterSettings.of(
        **{
            **settings.part(FlutterModeSettings),
            "amplitudes": tuple(amplitudes.tolist()),
        }
    )
    n = disk.sectors
    rows: list[_Wave] = []
    cycles: list[_Cycle] = []
    modes = WaveModes(disk, settings)
    interrupted = False

    def followed(diameter: int, progress: Progress) -> tuple[_Wave, list[_Cycle]]:
        wave = _Follower(waves, diameter, modes, progress)
        row = wave.at(amplitudes)
        return row, _compared(waves, settings, wave, wave.cycles(row))

    with Run("flutter map", progress) as run:
        try:
            parts = [partial(followed, diameter) for diameter in range(n)]
            alone = has_own_laws(disk)
            for row, found in in_turn(parts, run, alone=alone, within=run.at_once):
                rows.append(row)
                cycles.extend(found)
        except KeyboardInterrupt:
            interrupted = True
        arrays = _arrays(waves, amplitudes, rows, cycles)
        off = arrays.cycle_error[arrays.cycle_error > _DIFFERS]
        lost = int((~np.isfinite(arrays.omega[: len(rows)])).sum())
        undamped = _unheld(arrays, len(rows))
        notes = present(
            (
                told("wave-stability/ring" if settings.multipliers else "wave-stability"),
                lost > 0 and told("waves-missing", points=lost, total=len(rows) * amplitudes.size),
                undamped > 0
                and told("waves-unheld", waves=undamped, largest=float(amplitudes[-1])),
                off.size > 0
                and told("cycles-differ", cycles=off.size, least=_DIFFERS, largest=off.max()),
            )
        )
        result = FlutterMap(
            model=disk,
            dofs=disk.structure.dofs,
            settings=kept,
            arrays=arrays,
            interrupted=interrupted,
            timings={},
            counters={"evaluations": modes.evaluations},
            diagnostics=notes,
        )
        return run.ended(result, f"{len(rows)} of {n} waves")


class _Wave(NamedTuple):
    """A wave at some amplitudes, in the flow."""

    amplitude: NDArray[np.float64]
    omega: NDArray[np.float64]
    disk_ratio: NDArray[np.float64]
    flow_ratio: NDArray[np.float64]
    participation: NDArray[np.float64]
    displacement: NDArray[np.float64]
    harmonics: NDArray[np.int64]

    @property
    def ratio(self) -> NDArray[np.float64]:
        return self.disk_ratio + self.flow_ratio

    def with_amplitudes(self, other: _Wave) -> _Wave:
        """Return the wave at the amplitudes of both."""
        _, order = np.unique(np.concatenate([self.amplitude, other.amplitude]), return_index=True)
        return _Wave(*(np.concatenate(pair)[order] for pair in zip(self, other, strict=True)))

    def over_amplitude(self, values: NDArray[np.float64]) -> PchipInterpolator:
        """Return values, shape (A, ...), over ln a, where the mode is known."""
        from scipy.interpolate import PchipInterpolator

        known = np.isfinite(self.ratio)
        return PchipInterpolator(np.log(self.amplitude[known]), values[known])

    def undamped(self) -> NDArray[np.float64]:
        """Return the amplitudes at which disk and flow together damp nothing, rising."""
        if np.isfinite(self.ratio).sum() < 2:
            return np.empty(0)
        found = self.over_amplitude(self.ratio).roots(extrapolate=False)
        return np.exp(np.unique(found[np.isfinite(found)]))


class _Cycle(NamedTuple):
    """A limit cycle of a wave."""

    diameter: int
    amplitude: float
    omega: float
    slope: float
    displacement: NDArray[np.float64]
    stable: bool | None
    multiplier: float = np.nan
    error: float = np.nan


class _Follower:
    """The nonlinear mode of one wave of a disk in a flow."""

    def __init__(
        self, waves: AerodynamicWaves, diameter: int, modes: WaveModes, progress: Progress
    ) -> None:
        self.disk, self.forces, self.diameter = waves.disk, waves.forces, diameter
        self.rest = float(waves.omega[diameter])
        self.modes, self.progress = modes, progress
        self.harmonics = 1
        """Highest harmonic of the mode at the amplitudes it was computed at last."""

    def at(self, amplitudes: NDArray[np.float64], harmonics: int | None = None) -> _Wave:
        """Return the wave at amplitudes; not-a-number where its mode was not reached."""
        mode = self.modes.at(self.diameter, amplitudes, harmonics, self.progress)
        self.harmonics = int(mode.harmonics.max())
        return self._in_flow(mode)

    def _in_flow(self, mode: NonlinearModes) -> _Wave:
        series, natural = mode.arrays.displacement, mode.omega
        inertia, fed = np.zeros(natural.size), np.zeros(natural.size, np.complex128)
        first = np.zeros(natural.size)
        for k in range(1, series.shape[1]):
            place = k * self.diameter % self.disk.sectors
            mass, _, _ = self.disk.matrices.wave(self.disk.angle(place))
            x = series[:, k]
            inertia += k**2 * np.einsum("ai,ij,aj->a", x.conj(), mass, x).real
            work = np.abs(x @ self.forces.directions[place].conj()) ** 2
            fed += self._fed(k, place) * work
            if k == 1:
                first = work
        with np.errstate(invalid="ignore", divide="ignore"):
            square = natural**2 - fed.real / inertia
            omega = np.sqrt(np.where(square > 0.0, square, np.nan))
            # A damping matrix, of Im L at the frequency at rest.
            first = first * omega / self.rest
            flow = -fed.imag * omega / self.rest / (2.0 * square * inertia)
            slower = natural / omega
            own = mode.viscous_ratio * slower + mode.friction_ratio * slower**2
            share = first / (square * inertia)
        sizes = [mode.displacement_amplitude(dof) for dof in self.disk.structure.dofs]
        amplitude = np.asarray(mode.amplitude)
        return _Wave(amplitude, omega, own, flow, share, np.stack(sizes, axis=1), mode.harmonics)

    def _fed(self, order: int, place: int) -> complex:
        """Return L of a harmonic, its imaginary part as a damping does the work of a period.

        The damping is that of the lowest odd harmonic which meets the nodal diameter.
        """
        force, n = self.forces.coefficients[place], self.disk.sectors
        met = [k for k in range(1, 2 * n, 2) if k * self.diameter % n == place]
        return complex(force.real, force.imag * order**2 / met[0] if met else 0.0)

    def cycles(self, row: _Wave) -> list[_Cycle]:
        """Return the limit cycles by rising amplitude, from the wave at amplitudes around them."""
        for _ in range(_ROUNDS):
            guesses = row.undamped()
            after = np.maximum(np.searchsorted(row.amplitude, guesses), 1)
            low, high = row.amplitude[after - 1], row.amplitude[after]
            wide = high > (1.0 + _CLOSE) ** 2 * low
            if not wide.any():
                break
            around = guesses[wide, np.newaxis] * (1.0 + _CLOSE) ** np.arange(-1.0, 2.0)
            # At a kink of the damping guesses creep; the middle halves the way.
            middle = np.sqrt(low[wide] * high[wide])
            kept = row.harmonics[[after[wide] - 1, after[wide]]].max()
            row = row.with_amplitudes(self.at(np.unique(np.append(around, middle)), int(kept)))
        found = row.undamped()
        if not found.size:
            return []
        logs = np.log(found)
        slopes = row.over_amplitude(row.ratio)(logs, 1)
        sizes = row.over_amplitude(row.displacement)(logs)
        omega = row.over_amplitude(row.omega)(logs)
        stable = [None if abs(x) <= _FLAT else x > 0.0 for x in slopes.tolist()]
        columns = found.tolist(), omega.tolist(), slopes.tolist(), sizes, stable
        return [_Cycle(self.diameter, *one) for one in zip(*columns, strict=True)]


def _compared(
    waves: AerodynamicWaves, settings: FlutterKeys, wave: _Follower, cycles: list[_Cycle]
) -> list[_Cycle]:
    """Return limit cycles with what the whole equations say of them, in as many harmonics."""
    if not cycles or not (settings.direct or settings.multipliers):
        return cycles
    branch = wave_cycles(waves, wave.diameter, wave.harmonics, settings.mode)
    if settings.multipliers:
        cycles = [one._replace(stable=None) for one in cycles]
    if branch is None or not branch.omega.size:
        return cycles
    found = []
    for one in cycles:
        largest = int(np.argmax(one.displacement))
        sizes = branch.amplitude(waves.disk.structure.dofs[largest])
        index = int(np.argmin(np.abs(np.log(sizes / one.displacement[largest]))))
        error = abs(float(one.displacement[largest] / sizes[index]) - 1.0)
        checked = one._replace(error=error)
        if settings.multipliers:
            multiplier, stable = wave_multiplier(waves, wave.diameter, branch, index)
            checked = checked._replace(multiplier=multiplier, stable=stable)
        found.append(checked)
    return found


def _amplitudes(waves: AerodynamicWaves, settings: FlutterKeys) -> NDArray[np.float64]:
    """Return the modal amplitudes at which all waves are looked at."""
    given = settings.amplitude
    if given is None:
        first, last = _onsets(waves)
        given = _BELOW * first, _BEYOND * last
    if isinstance(given, tuple):
        return np.geomspace(*given, settings.points)
    return np.unique(np.asarray(given, dtype=np.float64))


def _onsets(waves: AerodynamicWaves) -> tuple[float, float]:
    """Return the modal amplitudes at which the first and the last contact begins to slip."""
    disk, onsets = waves.disk, []
    for diameter in range(disk.sectors):
        shape = waves.shapes[diameter]
        ahead = np.exp(1j * disk.angle(diameter))
        for contact in disk.contacts:
            own, following = disk.contact_rows(contact)
            force = contact.stuck_stiffness @ ((own + ahead * following) @ shape)
            for point, limit in enumerate(contact.limits):
                size = float(np.linalg.norm(force[contact.place(point)]))
                if np.isfinite(limit) and limit > 0.0 and size > 0.0:
                    onsets.append(limit / size)
    if not onsets:
        reason = (
            "amplitude: no contact says at which force it slips, so that the amplitudes are not "
            "known; give amplitude"
        )
        raise ModelError(f"{reason}=(from, to)", study=f"{reason} = {{from = ..., to = ...}}")
    # A contact that hardly moves in some wave would stretch the range without end.
    return float(np.min(onsets)), float(np.median(onsets))


def _arrays(
    waves: AerodynamicWaves,
    amplitudes: NDArray[np.float64],
    rows: list[_Wave],
    cycles: list[_Cycle],
) -> FlutterArrays:
    n, size = waves.disk.sectors, len(waves.disk.structure)

    def stacked(name: str, *more: int) -> NDArray[np.float64]:
        values = np.full((n, amplitudes.size, *more), np.nan)
        for index, row in enumerate(rows):
            values[index] = getattr(row, name)
        return values

    rank = np.argsort(np.argsort(waves.ratio, kind="stable"))
    cycles = sorted(cycles, key=lambda one: (rank[one.diameter], one.amplitude))
    names = {None: "not decided", False: "unstable", True: "stable"}
    at_rest = 1.0 / waves.omega**2
    moved = np.array(
        [abs(np.vdot(waves.forces.directions[d], waves.shapes[d])) ** 2 for d in range(n)]
    )
    participation = (
        stacked("participation") / np.where(moved > 0.0, moved * at_rest, np.nan)[:, None]
    )
    return FlutterArrays(
        amplitude=amplitudes,
        omega=stacked("omega"),
        disk_ratio=stacked("disk_ratio"),
        aerodynamic_ratio=stacked("flow_ratio"),
        participation=participation,
        displacement=stacked("displacement", size),
        rest_omega=waves.omega,
        rest_aerodynamic_ratio=waves.aerodynamic_ratio,
        rest_ratio=waves.ratio,
        coefficient=waves.forces.coefficients * moved,
        cycle_wave=np.array([one.diameter for one in cycles], dtype=np.int64),
        cycle_amplitude=np.array([one.amplitude for one in cycles]),
        cycle_omega=np.array([one.omega for one in cycles]),
        cycle_slope=np.array([one.slope for one in cycles]),
        cycle_multiplier=np.array([one.multiplier for one in cycles]),
        cycle_state=np.array([STATES.index(names[one.stable]) for one in cycles], dtype=np.int64),
        cycle_error=np.array([one.error for one in cycles]),
        cycle_displacement=np.array([one.displacement for one in cycles]).reshape(-1, size),
    )


def _unheld(arrays: FlutterArrays, done: int) -> int:
    """Return how many waves still grow at the largest amplitude where they are known."""
    count = 0
    for ratio in (arrays.disk_ratio + arrays.aerodynamic_ratio)[:done]:
        known = ratio[np.isfinite(ratio)]
        count += bool(known.size and known[-1] < 0.0)
    return count

"""Limit cycles of every travelling wave of a tuned disk in a flow, from its nonlinear modes.

The flow's force ``p L p^H x`` acts as the damping ``-Im L / omega_d`` of the frequency omega_d at
rest, as it does in `stickslip.limit_cycles`: in a motion of amplitude X and frequency omega it does
the work ``pi (omega / omega_d) Im L |p^H X|^2`` per period, which disk and friction take. A limit
cycle is where the damping ratio of the nonlinear mode at the amplitude a and that of the flow add
up to nothing, ``zeta(a) + zeta_aero(d, a) = 0``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.analyses.run import Progress, Run, share
from stickslip.analyses.texts import told
from stickslip.analyses.wave_stability import wave_multiplier
from stickslip.disk.aerodynamics import Aerodynamics
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.waves import AerodynamicWaves, aerodynamic_waves
from stickslip.errors import ModelError
from stickslip.results.diagnostic import present
from stickslip.results.flutter_map import STATES, FlutterArrays, FlutterMap
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.settings.flutter import FlutterKeys, FlutterModeSettings, FlutterSettings
from stickslip.settings.settings import configured

_INSIDE = 8
"""Amplitudes put between two between which a limit cycle lies, per round."""
_ROUNDS = 2
_BELOW, _BEYOND = 0.5, 100.0
"""Where amplitudes begin and end by default, in those at which contacts begin to slip."""
_HARMONICS = 15
"""Harmonics of the limit cycles whose multipliers are computed, if they are chosen."""
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
    roots: list[tuple[int, _Wave, bool]] = []
    decided: list[tuple[float, bool | None]] = []
    interrupted = False
    with Run("flutter map", progress) as run:
        try:
            with run.at_once():
                for diameter in range(n):
                    part = share(run, diameter / n, (diameter + 1) / n)
                    wave = _Follower(waves, diameter, settings, part)
                    row = wave.at(amplitudes)
                    found = wave.roots(row)
                    known = [_multiplier(waves, settings, diameter, one) for one, _ in found]
                    rows.append(row)
                    roots.extend((diameter, *one) for one in found)
                    decided.extend(known)
        except KeyboardInterrupt:
            interrupted = True
        arrays = _arrays(waves, amplitudes, rows, roots, decided if settings.multipliers else None)
        lost = int((~np.isfinite(arrays.omega[: len(rows)])).sum())
        undamped = _unheld(arrays, len(rows))
        notes = present(
            (
                told("wave-stability/ring" if settings.multipliers else "wave-stability"),
                lost > 0 and told("waves-missing", points=lost, total=len(rows) * amplitudes.size),
                undamped > 0
                and told("waves-unheld", waves=undamped, largest=float(amplitudes[-1])),
            )
        )
        result = FlutterMap(
            model=disk,
            dofs=disk.structure.dofs,
            settings=kept,
            arrays=arrays,
            interrupted=interrupted,
            timings={},
            counters={"evaluations": sum(row.evaluations for row in rows)},
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
    evaluations: int

    @property
    def ratio(self) -> NDArray[np.float64]:
        return self.disk_ratio + self.flow_ratio


class _Follower:
    """The nonlinear mode of one wave of a disk in a flow."""

    def __init__(
        self,
        waves: AerodynamicWaves,
        diameter: int,
        settings: FlutterKeys,
        progress: Progress,
    ) -> None:
        self.disk, self.forces, self.diameter = waves.disk, waves.forces, diameter
        self.rest = float(waves.omega[diameter])
        self.settings, self.progress = settings, progress

    def at(self, amplitudes: NDArray[np.float64]) -> _Wave:
        """Return the wave at amplitudes; not-a-number where its mode was not reached."""
        keys = self.settings
        mode: NonlinearModes = nonlinear_modes(
            self.disk,
            amplitude=amplitudes.tolist(),
            nodal_diameter=self.diameter,
            mode=keys.mode,
            harmonics=keys.harmonics,
            tolerance=keys.tolerance,
            residual=keys.residual,
            max_harmonics=keys.max_harmonics,
            max_iterations=keys.max_iterations,
        )
        if self.progress is not None:
            self.progress(1.0)
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
        work = int(mode.counters.get("evaluations", 0))
        amplitude = np.asarray(mode.amplitude)
        return _Wave(amplitude, omega, own, flow, share, np.stack(sizes, axis=1), work)

    def _fed(self, order: int, place: int) -> complex:
        """Return L of a harmonic, its imaginary part as a damping does the work of a period.

        The damping is that of the lowest odd harmonic which meets the nodal diameter.
        """
        force, n = self.forces.coefficients[place], self.disk.sectors
        met = [k for k in range(1, 2 * n, 2) if k * self.diameter % n == place]
        return complex(force.real, force.imag * order**2 / met[0] if met else 0.0)

    def roots(self, row: _Wave) -> list[tuple[_Wave, bool]]:
        """Return the limit cycles, by rising amplitude, and whether the damping rises there."""
        brackets = _brackets(row)
        for _ in range(_ROUNDS):
            if not brackets:
                return []
            inside = np.unique(
                np.concatenate([np.geomspace(low, high, _INSIDE + 2) for low, high in brackets])
            )
            row = self.at(inside)
            brackets = _brackets(row)
        return [(_between(row, low, high), bool(rising)) for low, high, rising in _signed(row)]


def _signed(row: _Wave) -> list[tuple[float, float, bool]]:
    """Return the amplitudes between which the damping changes its sign, and whether it rises."""
    known = np.flatnonzero(np.isfinite(row.ratio))
    a, ratio = row.amplitude[known], row.ratio[known]
    changes = np.flatnonzero((ratio[:-1] < 0.0) != (ratio[1:] < 0.0))
    return [(a[i], a[i + 1], bool(ratio[i] < 0.0)) for i in changes.tolist()]


def _brackets(row: _Wave) -> list[tuple[float, float]]:
    return [(low, high) for low, high, _ in _signed(row)]


def _between(row: _Wave, low: float, high: float) -> _Wave:
    """Return the wave where the damping between two amplitudes is zero, on the line of both."""
    first, last = (int(np.flatnonzero(row.amplitude == one)[0]) for one in (low, high))
    ends = row.ratio[first], row.ratio[last]
    part = ends[0] / (ends[0] - ends[1])
    slope = (ends[1] - ends[0]) / np.log(high / low)

    def mixed(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray((1.0 - part) * values[first] + part * values[last])

    amplitude = np.exp((1.0 - part) * np.log(low) + part * np.log(high))
    return _Wave(
        np.asarray(amplitude),
        mixed(row.omega),
        mixed(row.disk_ratio),
        np.asarray(slope),
        mixed(row.participation),
        mixed(row.displacement),
        0,
    )


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
        raise ModelError(
            "amplitude: no contact says at which force it slips, so that the amplitudes are not "
            "known; give amplitude=(from, to)"
        )
    # A contact that hardly moves in some wave would stretch the range without end.
    return float(np.min(onsets)), float(np.median(onsets))


def _arrays(
    waves: AerodynamicWaves,
    amplitudes: NDArray[np.float64],
    rows: list[_Wave],
    roots: list[tuple[int, _Wave, bool]],
    decided: list[tuple[float, bool | None]] | None,
) -> FlutterArrays:
    n, size = waves.disk.sectors, len(waves.disk.structure)

    def stacked(name: str, *more: int) -> NDArray[np.float64]:
        values = np.full((n, amplitudes.size, *more), np.nan)
        for index, row in enumerate(rows):
            values[index] = getattr(row, name)
        return values

    rank = np.argsort(np.argsort(waves.ratio, kind="stable"))
    placed = sorted(
        range(len(roots)), key=lambda i: (rank[roots[i][0]], float(roots[i][1].amplitude))
    )
    roots = [roots[i] for i in placed]
    slopes = np.array([float(one.flow_ratio) for _, one, _ in roots])
    if decided is None:
        sizes = np.full(len(roots), np.nan)
        truths = [None if abs(x) <= _FLAT else x > 0.0 for x in slopes.tolist()]
    else:
        sizes = np.array([decided[i][0] for i in placed], dtype=np.float64)
        truths = [decided[i][1] for i in placed]
    names = {None: "not decided", False: "unstable", True: "stable"}
    states = [STATES.index(names[one]) for one in truths]
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
        cycle_wave=np.array([d for d, _, _ in roots], dtype=np.int64),
        cycle_amplitude=np.array([float(one.amplitude) for _, one, _ in roots]),
        cycle_omega=np.array([float(one.omega) for _, one, _ in roots]),
        cycle_slope=slopes,
        cycle_multiplier=sizes,
        cycle_state=np.array(states, dtype=np.int64),
        cycle_displacement=np.array([one.displacement for _, one, _ in roots]).reshape(-1, size),
    )


def _multiplier(
    waves: AerodynamicWaves, settings: FlutterKeys, diameter: int, cycle: _Wave
) -> tuple[float, bool | None]:
    if not settings.multipliers:
        return np.nan, None
    largest = int(np.argmax(cycle.displacement))
    dof, size = waves.disk.structure.dofs[largest], float(cycle.displacement[largest])
    return wave_multiplier(
        waves, diameter, size, dof, settings.fixed_harmonics or _HARMONICS, settings.mode
    )


def _unheld(arrays: FlutterArrays, done: int) -> int:
    """Return how many waves still grow at the largest amplitude where they are known."""
    count = 0
    for ratio in (arrays.disk_ratio + arrays.aerodynamic_ratio)[:done]:
        known = ratio[np.isfinite(ratio)]
        count += bool(known.size and known[-1] < 0.0)
    return count

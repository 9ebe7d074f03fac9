"""What a nonlinear mode alone gives: forced responses (Szemplinska-Stupnicka 1979), limit cycles.

Both as of Krack (2015).

Under forces whose fundamental does the work P = phi^H p in the mode, of unit modal mass, its modal
amplitude a at the frequency Omega of the forces is that of

    (omega(a)^2 - Omega^2 + 2 i zeta(a) omega(a) Omega) a = P .

Solved for Omega it is a curve in closed form, Omega^2 = omega^2 (1 - 2 zeta^2) +- (|P|^2/a^2 -
4 zeta^2 omega^4 (1 - zeta^2))^(1/2), whose two sides meet in the peak.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.checks import brief, constant, unknown
from stickslip.errors import ModelError
from stickslip.model.force import Force
from stickslip.results.fields import Bool, Complex, Float
from stickslip.results.mode_shapes import Mode, ModeMotions, ModeShapes, left_out


@dataclass(frozen=True, eq=False)
class SynthesizedResponse(ModeMotions):
    """A forced response of a single nonlinear mode.

    Attributes
    ----------
    omega : ndarray of float64, shape (n,)
        Frequencies of the forces [rad/s].
    modal_amplitude : ndarray of float64, shape (n,)
        Modal amplitude [m kg^(1/2)], the largest one where there are several; not-a-number where
        the mode was not computed that far.
    error_indicator : ndarray of float64, shape (n,)
        What the mode leaves out, relative to the motion: how far the full equations are from
        holding, in terms of displacements. Above 0.01 compute the response directly.
    """

    _turn: Complex

    def __repr__(self) -> str:
        return (
            f"SynthesizedResponse({self.omega.size} frequencies of mode "
            f"{self.mode.settings.mode}, error up to {np.fmax.reduce(self.error_indicator):.2g})"
        )

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, shape (n, H+1) [m]."""
        column = self.mode._column(dof)
        series = self._shapes.displacement(self.modal_amplitude)[:, :, column]
        orders = np.arange(series.shape[1])
        return constant(series * self._turn[:, None] ** orders)


@dataclass(frozen=True, eq=False)
class SynthesizedPeaks(SynthesizedResponse):
    """Peaks of forced responses of a single nonlinear mode, along a factor.

    Attributes
    ----------
    omega : ndarray of float64, shape (n,)
        Frequencies of the peaks of the mode [rad/s].
    modal_amplitude : ndarray of float64, shape (n,)
        Amplitude on the branch of the mode [m kg^(1/2)]; not-a-number where it was not computed
        that far.
    error_indicator : ndarray of float64, shape (n,)
        As of a `SynthesizedResponse`. Above 0.01 compute the peaks directly.
    factor : ndarray of float64, shape (n,)
        Factors on the forces, or on all slip forces.
    """

    factor: Float
    _size: Float

    def __repr__(self) -> str:
        return (
            f"SynthesizedPeaks({self.omega.size} factors of mode {self.mode.settings.mode}, error "
            f"up to {np.fmax.reduce(self.error_indicator):.2g})"
        )

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, shape (n, H+1) [m]."""
        return constant(super().coefficients(dof) * self._size[:, np.newaxis])


def synthesized(mode: Mode, force: Complex, omega: Float) -> SynthesizedResponse:
    """Return the response of a mode to the fundamental of forces on its DOFs, shape (N,) [N]."""
    shapes = ModeShapes(mode)
    grid = shapes.grid
    natural, damping = shapes.scalars(grid)
    work = shapes.displacement(grid)[:, 1].conj() @ force / grid
    found = np.full(omega.size, np.nan)
    for index, one in enumerate(omega):
        excess = grid * np.abs(natural**2 - one**2 + 2j * damping * natural * one) - np.abs(work)
        below = np.flatnonzero((excess[:-1] < 0.0) & (excess[1:] >= 0.0))
        above = np.flatnonzero((excess[:-1] >= 0.0) & (excess[1:] < 0.0))
        crossings = np.sort(np.r_[below, above])
        if excess[-1] < 0.0:
            continue
        if crossings.size:
            at = crossings[-1]
            share = excess[at] / (excess[at] - excess[at + 1])
            found[index] = grid[at] * (grid[at + 1] / grid[at]) ** share
        else:
            found[index] = grid[0] * np.abs(work[0]) / (excess[0] + np.abs(work[0]))
    turn, indicator = _turned(mode, shapes, np.tile(force, (omega.size, 1)), omega, found)
    arrays = (constant(np.array(one)) for one in (omega, found, indicator, turn))
    return SynthesizedResponse(mode, *arrays)


def synthesized_peaks(
    mode: Mode, force: Complex, factor: Float, *, damper: bool
) -> SynthesizedPeaks:
    """Return the peaks of the responses of a mode, shape (n,), to multiples of forces.

    Or, of a `damper`, to the forces with all slip forces multiplied: displacements grow with both
    alike.
    """
    shapes = ModeShapes(mode)
    level = 1.0 / factor if damper else factor
    grid = shapes.grid
    natural, damping = shapes.scalars(grid)
    work = np.abs(shapes.displacement(grid)[:, 1].conj() @ force) / grid
    # Where the two sides of the curve of a level meet.
    needed = 2.0 * damping * np.sqrt(1.0 - damping**2) * natural**2 * grid / work
    found = np.full(level.size, np.nan)
    for index, one in enumerate(level.tolist()):
        met = np.flatnonzero((needed[:-1] < one) & (needed[1:] >= one))
        if met.size and needed[-1] >= one:
            at = met[-1]
            share = (one - needed[at]) / (needed[at + 1] - needed[at])
            found[index] = grid[at] * (grid[at + 1] / grid[at]) ** share
        elif needed.min() >= one:
            found[index] = grid[0] * one / needed[0]
    natural, damping = (np.full(level.size, np.nan) for _ in range(2))
    reached = np.isfinite(found)
    natural[reached], damping[reached] = shapes.scalars(found[reached])
    omega = natural * np.sqrt(1.0 - 2.0 * damping**2)
    turn, indicator = _turned(mode, shapes, np.outer(level, force), omega, found)
    size = factor if damper else np.ones(factor.size)
    arrays = (constant(np.array(one)) for one in (omega, found, indicator, turn, factor, size))
    return SynthesizedPeaks(mode, *arrays)


def _turned(
    mode: Mode, shapes: ModeShapes, force: Complex, omega: Float, amplitude: Float
) -> tuple[Complex, Float]:
    """Return the phase against forces, shape (n, N), as a factor, and the error indicator.

    Along the mode the residual counts against the work of the forces.
    """
    reached = np.isfinite(amplitude)
    work, turn = (np.full(omega.size, np.nan, np.complex128) for _ in range(2))
    natural, damping = shapes.scalars(amplitude[reached])
    one = omega[reached]
    response = natural**2 - one**2 + 2j * damping * natural * one
    fundamental = shapes.displacement(amplitude[reached])[:, 1]
    work[reached] = (fundamental.conj() * force[reached]).sum(axis=1) / amplitude[reached]
    turn[reached] = np.exp(1j * np.angle(work[reached] / response))

    def acting(n: int, order: int, _: Complex) -> Complex:
        return -force[n] if order == 1 else np.zeros_like(force[n])

    moved, along = left_out(mode, amplitude, omega, turn, acting)
    return turn, moved + along / np.abs(work) + shapes.damping_error(amplitude)


def force_vector(mode: Mode, given: object) -> Complex:
    """Return the fundamental of forces on the DOFs of a mode [N]."""
    forces = [given] if isinstance(given, Force) else given
    vector = np.zeros(len(mode.model.structure), np.complex128)
    if not isinstance(forces, list | tuple) or not forces:
        raise ModelError("forces: give a Force or a list of them")
    dofs = mode.model.structure.dofs
    for one in forces:
        if not isinstance(one, Force):
            raise ModelError(f"forces: {brief(one)} is no Force; give ss.Force(...)")
        if one.dof not in dofs:
            raise ModelError(unknown("dof", one.dof, dofs))
        if one.harmonic == 1:
            vector[dofs.index(one.dof)] += one.coefficient
        elif one.harmonic > 1:
            raise ModelError(
                f"forces: harmonic {one.harmonic} at {one.dof!r}; a mode answers to the "
                "fundamental alone"
            )
    if not vector.any():
        raise ModelError("forces: none has harmonic 1; nothing drives the mode")
    return vector


@dataclass(frozen=True, eq=False)
class SynthesizedCycles(ModeMotions):
    """Limit cycles of a single nonlinear mode.

    Attributes
    ----------
    ratio : ndarray of float64, shape (n,)
        Factor r on the negative damping, as it was asked for, once per limit cycle.
    omega : ndarray of float64, shape (n,)
        Angular frequencies [rad/s].
    modal_amplitude : ndarray of float64, shape (n,)
        Modal amplitudes [m kg^(1/2)], rising at every ratio.
    stable : ndarray of bool, shape (n,)
        Whether small changes of the amplitude die out; other modes are not looked at.
    error_indicator : ndarray of float64, shape (n,)
        What the mode leaves out, relative to the amplitude: the displacements by which the full
        equations do not hold, and the error of the damping, over the slope of ln r(a) in ln a.
        Above 0.01 compute the limit cycles directly.
    """

    ratio: Float
    stable: Bool

    def __repr__(self) -> str:
        return (
            f"SynthesizedCycles({self.ratio.size} limit cycles of mode {self.mode.settings.mode})"
        )


def synthesized_cycles(mode: Mode, negative: Float, ratio: Float) -> SynthesizedCycles:
    """Return the limit cycles of a mode under a negative damping, shape (N, N) [kg/s].

    Under the damping C + r C_neg a motion of the mode repeats itself where what the negative
    damping feeds per period is what structure and contacts take,

        r(a) = -2 zeta(a) omega(a) sum_k k^2 X_k^H M X_k / sum_k k^2 X_k^H C_neg X_k .
    """
    shapes, mass = ModeShapes(mode), mode.model.structure.mass
    grid = shapes.grid
    natural, damping = shapes.scalars(grid)
    series = shapes.displacement(grid)
    orders = np.arange(series.shape[1]) ** 2

    def work(matrix: Float) -> Float:
        each: Complex = np.einsum(
            "k,aki,ij,akj->a", orders, series.conj(), matrix, series, optimize=True
        )
        return each.real

    fed = -work(negative)
    needed = 2.0 * damping * natural * work(mass) / fed
    rise = np.gradient(needed, np.log(grid))
    places, ratios, sizes = [], [], []
    for one in ratio.tolist():
        above = needed >= one
        for at in np.flatnonzero(above[:-1] != above[1:]).tolist():
            share = (one - needed[at]) / (needed[at + 1] - needed[at])
            places.append(at)
            ratios.append(one)
            sizes.append(grid[at] * (grid[at + 1] / grid[at]) ** share)
    amplitude, known = np.array(sizes), np.array(ratios)
    omega, own = shapes.scalars(amplitude)

    def acting(n: int, order: int, x: Complex) -> Complex:
        force: Complex = 1j * order * omega[n] * known[n] * (negative @ x)
        return force

    moved, along = left_out(
        mode,
        amplitude,
        omega,
        np.ones(amplitude.size, np.complex128),
        acting,
        lambda n: known[n] * negative,
    )
    feed = 2.0 * own * omega**2
    balance = moved + along / (feed * amplitude) + shapes.damping_error(amplitude)
    error = moved + balance * known / np.abs(rise[places])
    # Where the matrix feeds nothing but takes, a motion that needs more of it has too little.
    arrays = omega, amplitude, error, known, (fed * rise)[places] > 0.0
    return SynthesizedCycles(mode, *(constant(np.array(one)) for one in arrays))

"""Forced responses that a nonlinear mode alone gives (Krack 2015; Szemplinska-Stupnicka 1979).

Under forces whose fundamental does the work P = phi^H p in the mode, of unit modal mass, its modal
amplitude a at the frequency Omega of the forces is that of

    (omega(a)^2 - Omega^2 + 2 i zeta(a) omega(a) Omega) a = P .

Solved for Omega it is a curve in closed form, Omega^2 = omega^2 (1 - 2 zeta^2) +- (|P|^2/a^2 -
4 zeta^2 omega^4 (1 - zeta^2))^(1/2), whose two sides meet in the peak.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, get_args

import numpy as np

from stickslip.checks import choice, unknown
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.arrays import Complex, Float, Measure, amplitude_of, constant
from stickslip.results.mode_arrays import ModeArrays
from stickslip.settings.modes import ModeSettings

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

_FINE = 4000
"""Amplitudes between which solutions are bracketed."""
_STILL = 1e-9
"""Contact displacement, relative to the largest one, that says nothing about a stiffness."""


class Mode(Protocol):
    """What is asked of a nonlinear mode: a `NonlinearModes`."""

    @property
    def model(self) -> Model: ...  # noqa: D102
    @property
    def settings(self) -> ModeSettings: ...  # noqa: D102
    @property
    def arrays(self) -> ModeArrays: ...  # noqa: D102
    def _column(self, dof: str) -> int: ...


@dataclass(frozen=True, eq=False)
class SynthesizedResponse:
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

    mode: Mode
    omega: Float
    modal_amplitude: Float
    error_indicator: Float
    _turn: Complex

    def __repr__(self) -> str:
        return (
            f"SynthesizedResponse({self.omega.size} frequencies of mode "
            f"{self.mode.settings.mode}, error up to {np.nanmax(self.error_indicator):.2g})"
        )

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, shape (n, H+1) [m]."""
        column = self.mode._column(dof)
        series = self._shapes.displacement(self.modal_amplitude)[:, :, column]
        orders = np.arange(series.shape[1])
        return constant(series * self._turn[:, None] ** orders)

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement, shape (n,) [m]."""
        choice(measure, "measure", get_args(Measure))
        return constant(amplitude_of(self.coefficients(dof), measure))

    @cached_property
    def _shapes(self) -> _Shapes:
        return _Shapes(self.mode)


class _Shapes:
    """A nonlinear mode between its amplitudes, interpolated in their logarithm."""

    def __init__(self, mode: Mode) -> None:
        from scipy.interpolate import PchipInterpolator

        arrays = mode.arrays
        known = np.flatnonzero(np.isfinite(arrays.omega))
        rising = known[np.r_[True, np.diff(arrays.amplitude[known]) > 0.0]] if known.size else known
        if rising.size < known.size or known.size < 2:
            raise ModelError(
                "forced_response: the mode needs two amplitudes and more, and a branch that does "
                f"not turn; it has {known.size} with {arrays.turns.size} turns; compute it over "
                "another range"
            )
        log = np.log(arrays.amplitude[known])
        self.low, self.high = log[0], log[-1]
        factor = np.ones((known.size, arrays.displacement.shape[1], 1))
        factor[:, 1:] = arrays.amplitude[known, None, None]

        def between(values: Float) -> PchipInterpolator:
            return PchipInterpolator(log, values, axis=0)

        self._omega, self._damping = (
            between(arrays.omega[known]),
            between(arrays.damping_ratio[known]),
        )
        self._series = [
            (between(of.real), between(of.imag))
            for of in (
                arrays.displacement[known] / factor,
                arrays.contact_displacement[known] / factor,
                arrays.contact_force[known] / factor,
            )
        ]

    def scalars(self, amplitude: Float) -> tuple[Float, Float]:
        """Return frequency and damping ratio; below the least amplitude those there."""
        log = self._log(amplitude)
        return self._omega(log), self._damping(log)

    def displacement(self, amplitude: Float) -> Complex:
        """Return the harmonics of all DOFs, shape (n, H+1, N)."""
        return self._at(0, amplitude)

    def contacts(self, amplitude: Float) -> tuple[Complex, Complex]:
        """Return the harmonics of contact displacements and forces."""
        return self._at(1, amplitude), self._at(2, amplitude)

    def _log(self, amplitude: Float) -> Float:
        return np.clip(np.log(amplitude), self.low, self.high)

    def _at(self, which: int, amplitude: Float) -> Complex:
        real, imaginary = (part(self._log(amplitude)) for part in self._series[which])
        series = real + 1j * imaginary
        series[:, 1:] *= amplitude[:, None, None]
        return series


def synthesized(mode: Mode, force: Complex, omega: Float) -> SynthesizedResponse:
    """Return the response of a mode to the fundamental of forces on its DOFs, shape (N,) [N]."""
    shapes = _Shapes(mode)
    grid = np.exp(np.linspace(shapes.low, shapes.high, _FINE))
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
    reached = np.isfinite(found)
    natural, damping = (np.full(omega.size, np.nan) for _ in range(2))
    work, turn = (np.full(omega.size, np.nan, np.complex128) for _ in range(2))
    natural[reached], damping[reached] = shapes.scalars(found[reached])
    response = natural**2 - omega**2 + 2j * damping * natural * omega
    fundamental = shapes.displacement(found[reached])[:, 1]
    work[reached] = fundamental.conj() @ force / found[reached]
    turn[reached] = np.exp(1j * np.angle(work[reached] / response[reached]))
    indicator = _indicator(mode, shapes, force, omega, found, turn)
    arrays = (constant(np.array(one)) for one in (omega, found, indicator, turn))
    return SynthesizedResponse(mode, *arrays)


def _indicator(
    mode: Mode,
    shapes: _Shapes,
    force: Complex,
    omega: Float,
    amplitude: Float,
    turn: Complex,
) -> Float:
    """Return the displacements that the residual of the full equations stands for.

    Contacts answer as they do in the mode, by their complex stiffness of the fundamental, so that
    the mode itself is an exact solution; across the mode the residual moves the other modes, and
    along it the amplitude.
    """
    from scipy.linalg import block_diag

    structure = mode.model.structure
    rows = np.vstack([contact.rows(structure) for contact in mode.model.contacts])
    stuck = block_diag(*(contact.stuck_stiffness for contact in mode.model.contacts))
    mass, damping = structure.mass, structure.damping
    natural, ratio = shapes.scalars(amplitude)
    series, (relative, forces) = shapes.displacement(amplitude), shapes.contacts(amplitude)
    found = np.full(omega.size, np.nan)
    size = len(structure)
    for n in np.flatnonzero(np.isfinite(amplitude)):
        own, one, a = natural[n], omega[n], amplitude[n]
        error = 0.0
        for k in range(1, series.shape[1]):
            x = series[n, k] * turn[n] ** k
            if not np.abs(x).max() > 0.0:
                continue
            inertia = mass @ x
            rest = k**2 * (own**2 - one**2) * inertia + 1j * k * (one - own) * (damping @ x)
            rest += 2j * k * ratio[n] * own**2 * inertia
            held = stuck.astype(np.complex128)
            if k == 1:
                rest -= force
                u, f = relative[n, 1], forces[n, 1]
                moves = np.abs(u) > _STILL * np.abs(u).max()
                # Forces of one point that depend on several displacements are put on its own.
                held[moves] = 0.0
                held[moves, moves] = f[moves] / u[moves]
            dynamic = structure.stiffness + rows.T @ held @ rows
            dynamic = dynamic - (k * one) ** 2 * mass + 1j * k * one * damping
            if k > 1:
                change = np.linalg.solve(dynamic, -rest)
            else:
                border = inertia / a
                bordered = np.zeros((size + 1, size + 1), np.complex128)
                bordered[:size, :size] = dynamic
                bordered[:size, size], bordered[size, :size] = border, border.conj()
                solution = np.linalg.solve(bordered, np.r_[-rest, 0.0])
                change = solution[:size]
                driving = abs(np.vdot(series[n, 1], force)) / a
                error += abs(solution[size]) / driving
            error += float(np.sqrt(np.abs(np.vdot(change, mass @ change)))) / a
        found[n] = error
    return found


def force_vector(mode: Mode, given: object) -> Complex:
    """Return the fundamental of forces on the DOFs of a mode [N]."""
    from stickslip.model.force import Force

    forces = [given] if isinstance(given, Force) else given
    vector = np.zeros(len(mode.model.structure), np.complex128)
    if not isinstance(forces, list | tuple) or not forces:
        raise ModelError("forces: give a Force or a list of them")
    dofs = mode.model.structure.dofs
    for one in forces:
        if not isinstance(one, Force):
            raise ModelError(f"forces: {one!r} is no Force")
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

"""The columns of a nonlinear mode, the mode between them, and what the full equations say of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Protocol, get_args

import numpy as np

from stickslip.checks import choice, constant
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.arrays import Measure, PeriodicArrays, amplitude_of
from stickslip.results.dataset import Stored
from stickslip.results.fields import Complex, Float, Int, column
from stickslip.settings.modes import ModeSettings

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


def _unbounded(file: Stored) -> Float:
    return np.full((*file["omega"].values.shape, 2), np.nan)


class ModeArrays(PeriodicArrays):
    """The numbers of a nonlinear mode, in the order of its branch.

    At amplitudes that were not reached all but the amplitude is not-a-number.
    """

    along = "mode_point"
    labels: ClassVar[Mapping[str, Sequence[str]]] = {"mode_entry": ("omega", "damping_ratio")}

    omega: Float = column("*", "rad/s", "angular frequency of the mode")
    amplitude: Float = column(
        "*",
        "m kg^(1/2)",
        "modal amplitude (X_1^H M X_1)^(1/2), of the mass-normalised fundamental",
        least=0.0,
        file_name="modal_amplitude",
    )
    damping_ratio: Float = column("*", "1", "modal damping ratio, viscous damping included")
    viscous_ratio: Float = column("*", "1", "part of it that is due to viscous damping")
    force_level: Float = column(
        "*",
        "1",
        "multiple of the forces of harmonic 1 that keep the motion up in quadrature",
        absent=np.nan,
    )
    relative_error: Float = column(
        "* mode_entry",
        "1",
        "what the discarded harmonics could still change, relative to frequency and damping",
        least=0.0,
    )
    residual: Float = column(
        "*", "1", "residual of the equations, relative to the motion", least=0.0
    )
    resonance_order: Int = column(
        "*", "1", "order of a harmonic in internal resonance, 0 if there is none", least=0
    )
    resonance_omega: Float = column(
        "*", "rad/s", "natural frequency of the stuck structure that it meets"
    )
    resonance_share: Float = column("*", "1", "modal amplitude of that harmonic over the amplitude")
    omega_bounds: Float = column(
        "* bound",
        "rad/s",
        "least and largest angular frequency over residual tractions",
        absent=_unbounded,
    )
    damping_bounds: Float = column(
        "* bound",
        "1",
        "least and largest damping ratio over residual tractions",
        absent=_unbounded,
    )
    turns: Float = column("turn", "m kg^(1/2)", "amplitudes at which the branch turns")
    linear: Float = column("mode_entry", "1", "natural frequency and damping ratio at rest")


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


class ModeShapes:
    """A nonlinear mode between its amplitudes, interpolated in their logarithm."""

    def __init__(self, mode: Mode) -> None:
        from scipy.interpolate import PchipInterpolator

        arrays = mode.arrays
        known = np.flatnonzero(np.isfinite(arrays.omega))
        rising = known[np.r_[True, np.diff(arrays.amplitude[known]) > 0.0]] if known.size else known
        if rising.size < known.size or known.size < 2:
            raise ModelError(
                "a motion of one mode: it needs two amplitudes and more, and a branch that does "
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
        self._truncation = np.nan_to_num(arrays.relative_error[known, 1])
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

    def damping_error(self, amplitude: Float) -> Float:
        """Return the relative error of the damping ratio between amplitudes, and of truncation."""
        damping, log = self._damping(self._log(amplitude)), self._log(amplitude)
        straight = np.abs(damping - np.interp(log, self._damping.x, self._damping(self._damping.x)))
        truncation: Float = np.interp(log, self._damping.x, self._truncation)
        return truncation + straight / np.abs(damping)

    def displacement(self, amplitude: Float) -> Complex:
        """Return the harmonics of all DOFs, shape (n, H+1, N)."""
        return self._at(0, amplitude)

    def contacts(self, amplitude: Float) -> tuple[Complex, Complex]:
        """Return the harmonics of contact displacements and forces."""
        return self._at(1, amplitude), self._at(2, amplitude)

    @property
    def grid(self) -> Float:
        """Amplitudes that are close to each other, rising."""
        return np.exp(np.linspace(self.low, self.high, _FINE))

    def _log(self, amplitude: Float) -> Float:
        return np.clip(np.log(amplitude), self.low, self.high)

    def _at(self, which: int, amplitude: Float) -> Complex:
        real, imaginary = (part(self._log(amplitude)) for part in self._series[which])
        series = real + 1j * imaginary
        series[:, 1:] *= amplitude[:, None, None]
        return series


@dataclass(frozen=True, eq=False)
class ModeMotions:
    """Motions that a nonlinear mode alone gives."""

    mode: Mode
    omega: Float
    modal_amplitude: Float
    error_indicator: Float

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, shape (n, H+1) [m]."""
        return constant(
            self._shapes.displacement(self.modal_amplitude)[..., self.mode._column(dof)]
        )

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement, shape (n,) [m]."""
        choice(measure, "measure", get_args(Measure))
        return constant(amplitude_of(self.coefficients(dof), measure))

    @cached_property
    def _shapes(self) -> ModeShapes:
        return ModeShapes(self.mode)


def left_out(
    mode: Mode,
    amplitude: Float,
    omega: Float,
    turn: Complex,
    acting: Callable[[int, int, Complex], Complex],
    added: Callable[[int], Float] | None = None,
) -> tuple[Float, Float]:
    """Return the displacements, and the force along the mode, that the full equations leave.

    A mode is kept up by a fictitious damping; in a motion at the frequency `omega` what acts
    instead is `acting(n, k, X_k)`, on the left-hand side of harmonic k of motion n, and a damping
    matrix that is `added(n)`. Contacts answer as they do in the mode, by their complex stiffness of
    the fundamental, so that the mode itself is an exact solution; across the mode the residual
    moves the other modes. Both are relative: to the motion, and to its inertia as a mode.
    """
    from scipy.linalg import block_diag

    shapes = ModeShapes(mode)
    structure = mode.model.structure
    rows = np.vstack([contact.rows(structure) for contact in mode.model.contacts])
    stuck = block_diag(*(contact.stuck_stiffness for contact in mode.model.contacts))
    mass, damping = structure.mass, structure.damping
    natural, ratio = shapes.scalars(amplitude)
    series, (relative, forces) = shapes.displacement(amplitude), shapes.contacts(amplitude)
    moved, along = np.full(omega.size, np.nan), np.full(omega.size, np.nan)
    size = len(structure)
    for n in np.flatnonzero(np.isfinite(amplitude)).tolist():
        own, one, a = natural[n], omega[n], amplitude[n]
        viscous: Float = damping if added is None else damping + added(n)
        moved[n] = 0.0
        for k in range(1, series.shape[1]):
            x = series[n, k] * turn[n] ** k
            if not np.abs(x).max() > 0.0:
                continue
            inertia = mass @ x
            rest = k**2 * (own**2 - one**2) * inertia + 1j * k * (one - own) * (damping @ x)
            rest += 2j * k * ratio[n] * own**2 * inertia + acting(n, k, x)
            held = stuck.astype(np.complex128)
            if k == 1:
                u, f = relative[n, 1], forces[n, 1]
                moves = np.abs(u) > _STILL * np.abs(u).max()
                # Forces of one point that depend on several displacements are put on its own.
                held[moves] = 0.0
                held[moves, moves] = f[moves] / u[moves]
            dynamic = structure.stiffness + rows.T @ held @ rows
            dynamic = dynamic - (k * one) ** 2 * mass + 1j * k * one * viscous
            if k > 1:
                change = np.linalg.solve(dynamic, -rest)
            else:
                border = inertia / a
                bordered = np.zeros((size + 1, size + 1), np.complex128)
                bordered[:size, :size] = dynamic
                bordered[:size, size], bordered[size, :size] = border, border.conj()
                solution = np.linalg.solve(bordered, np.r_[-rest, 0.0])
                change = solution[:size]
                along[n] = abs(solution[size])
            moved[n] += float(np.sqrt(np.abs(np.vdot(change, mass @ change)))) / a
    return moved, along

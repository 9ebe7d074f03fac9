"""A nonlinear mode: frequency, damping and shape against amplitude."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, get_args

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import MatrixLike, choice, constant
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model.damping import DampingLaw
from stickslip.model.destabilised import negative_matrix
from stickslip.model.force import Force
from stickslip.results.arrays import Measure, amplitude_of, period_of
from stickslip.results.fields import Float, Int, Shown
from stickslip.results.mode_shapes import ModeArrays
from stickslip.results.periodic import PeriodicMotions
from stickslip.results.synthesis import (
    SynthesizedCycles,
    SynthesizedPeaks,
    SynthesizedResponse,
    force_vector,
    synthesized,
    synthesized_cycles,
    synthesized_peaks,
)
from stickslip.settings.modes import ModeSettings
from stickslip.settings.ranges import numbers, positive

_BANDWIDTHS = 4.0
"""Damping ratios on either side of phase resonance among which the maximum is looked for, ..."""
_LEAST_WIDTH = 0.01
"""... so much more, relative to the frequency, ..."""
_MOST_WIDTH = 0.6
"""... and no more than this."""


class NonlinearModes(PeriodicMotions):
    """A nonlinear mode, from amplitude to amplitude.

    Degrees of freedom are addressed by name, contacts by position or name, one node as (contact,
    point).
    """

    kind: ClassVar[str] = "nonlinear_modes"
    title = "Nonlinear mode of a structure with dry friction"
    attributes: ClassVar[Mapping[str, type]] = {"interrupted": bool, "half_wave": bool}

    settings: ModeSettings
    arrays: ModeArrays
    half_wave: bool

    def __repr__(self) -> str:
        found = self.omega[np.isfinite(self.omega)]
        span = f"{found.min():.6g} to {found.max():.6g} rad/s" if found.size else "none found"
        return f"NonlinearModes({self.omega.size} amplitudes of mode {self.settings.mode}, {span})"

    amplitude = Shown[Float]()  # type: ignore[assignment]
    omega = Shown[Float]()
    damping_ratio = Shown[Float]()
    viscous_ratio = Shown[Float]()
    harmonics = Shown[Int]()
    turns = Shown[Float]()
    force_level = Shown[Float]()
    relative_error = Shown[Float]()
    omega_bounds = Shown[Float]()
    damping_bounds = Shown[Float]()

    plot = Drawn("backbone")

    @property
    def linear_omega(self) -> float:
        """Natural frequency at rest [rad/s]."""
        return float(self.arrays.linear[0])

    @property
    def linear_damping_ratio(self) -> float:
        """Damping ratio at rest."""
        return float(self.arrays.linear[1])

    @property
    def friction_ratio(self) -> Float:
        """Part of the damping ratio that is due to contacts, shape (n,)."""
        return constant(self.damping_ratio - self.viscous_ratio)

    def displacement_amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement along the branch, shape (n,) [m]."""
        choice(measure, "measure", get_args(Measure))
        return constant(amplitude_of(self.coefficients(dof), measure))

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement from its harmonics, shape (samples,) [m]."""
        return period_of(self.coefficients(dof)[self.position(index)], samples)

    def forced_response(
        self, forces: Force | Sequence[Force], omega: ArrayLike
    ) -> SynthesizedResponse:
        """Return the response to forces that this mode alone gives, with its error indicator.

        Static loads are those of the mode. Good where the mode is well apart from others and
        lightly damped: below a damping ratio of about 0.03.

        Parameters
        ----------
        forces : Force or sequence of Force
            Forces of harmonic 1; static loads among them are left out, for the mode has its own.
        omega : array_like, shape (n,)
            Angular frequencies [rad/s].

        Raises
        ------
        ModelError
            If a force fits no DOF or drives nothing, the branch turns, or the model travels.

        References
        ----------
        Krack (2015), Comput. Struct. 154, 59, section 4; Krack, Panning-von Scheidt and Wallaschek
        (2013).
        """
        self._require_rest("forced_response")
        driven = force_vector(self, forces)
        given = numbers(omega, "give finite frequencies above 0 rad/s", positive, "rad/s")
        return synthesized(self, driven, given)

    def peaks(self, forces: Force | Sequence[Force], level: ArrayLike) -> SynthesizedPeaks:
        """Return the peaks of the responses to multiples of forces that this mode alone gives.

        Of several peaks at one level that of the largest amplitude.

        Parameters
        ----------
        forces : Force or sequence of Force
            As of `forced_response`.
        level : array_like, shape (n,)
            Factors on the forces.

        Raises
        ------
        ModelError
            As `forced_response` does.
        """
        self._require_rest("peaks")
        given = numbers(level, "give finite levels above 0", positive)
        return synthesized_peaks(self, force_vector(self, forces), given, damper=False)

    def damper_curve(self, forces: Force | Sequence[Force], factor: ArrayLike) -> SynthesizedPeaks:
        """Return peaks along a factor on all slip forces that this mode alone gives.

        Displacements grow with forces and slip forces alike, so that a factor on the slip forces is
        one on the level of the forces, and on the displacements.

        Parameters
        ----------
        forces : Force or sequence of Force
            As of `forced_response`.
        factor : array_like, shape (n,)
            Factors on all slip forces.

        Raises
        ------
        ModelError
            As `forced_response` does; under static loads, and of contacts with other forces than
            springs and constant friction, which do not grow alike.
        """
        self._require_rest("damper_curve")
        loaded = any(one.harmonic == 0 and one.amplitude for one in self.model.forces)
        scale = all(contact.slips for contact in self.model.contacts)
        if loaded or self.model.problem.laws_not_monotone or not scale:
            raise ModelError(
                "damper_curve: displacements do not grow with the slip forces alone, because of "
                "static loads, or of contacts that open or harden; use ss.damper_curve"
            )
        given = numbers(factor, "give finite factors above 0", positive)
        return synthesized_peaks(self, force_vector(self, forces), given, damper=True)

    def limit_cycles(
        self, negative_damping: MatrixLike | DampingLaw, ratio: ArrayLike
    ) -> SynthesizedCycles:
        """Return the limit cycles under the damping C + r C_neg that this mode alone gives.

        Parameters
        ----------
        negative_damping : array_like, shape (N, N), or damping law
            C_neg [kg/s], as of `stickslip.limit_cycles`.
        ratio : array_like, shape (n,)
            Factors r.

        Raises
        ------
        ModelError
            If the matrix does not fit, the branch turns, or the model travels: there
            `stickslip.flutter_map` does it for all waves.
        """
        self._require_rest("limit_cycles")
        negative = negative_matrix(negative_damping, self.model.structure)
        given = numbers(ratio, "give finite ratios above 0", positive)
        return synthesized_cycles(self, np.asarray(negative), given)

    def _require_rest(self, method: str) -> None:
        """Refuse a sector, which has no motion of its own."""
        if self.model.travels:
            raise ModelError(
                f"{method}: a sector of a travelling wave; compute it with stickslip.{method}"
            )

    def direct_peaks(self, dof: str, measure: Measure = "half_range") -> tuple[Float, Float]:
        """Return frequency and amplitude of the true maxima at the force levels of phase resonance.

        The forces of the model, as many times as the mode says, drive responses that are computed
        directly about every frequency of the branch. Where damping is light the maximum lies at
        quadrature; where it is strong, beside it.

        Returns
        -------
        omega : ndarray of float64, shape (n,)
            Frequencies of the maxima [rad/s].
        amplitude : ndarray of float64, shape (n,)
            Their amplitudes [m]. Both are not-a-number where no maximum lies about the frequency.

        Raises
        ------
        ModelError
            If the mode was not computed by phase resonance.
        """
        from stickslip.analyses.forced_response import forced_response

        if self.settings.method != "phase-resonance":
            raise ModelError(
                f"direct_peaks: the mode was computed with method = {self.settings.method!r}; "
                'compute it with method="phase-resonance"'
            )
        found = np.full((2, self.omega.size), np.nan)
        for index in np.flatnonzero(np.isfinite(self.omega)):
            level, near = float(self.force_level[index]), float(self.omega[index])
            scaled = [
                replace(force, amplitude=level * force.amplitude) if force.harmonic else force
                for force in self.model.forces
            ]
            width = min(_BANDWIDTHS * float(self.damping_ratio[index]) + _LEAST_WIDTH, _MOST_WIDTH)
            response = forced_response(
                self.model._like(forces=tuple(scaled)),
                ((1.0 - width) * near, (1.0 + width) * near),
                observe=[dof],
                tolerance=self.settings.tolerance,
            )
            peak = response.peak(dof, measure)
            if not peak.at_edge:
                found[:, index] = peak.omega, peak.amplitude
        return constant(found[0]), constant(found[1])

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        return self._amplitude_variable(self.displacement_amplitude) if derived else {}

"""How amplitudes change with the parameters of the contacts, the load and the frequency."""

from __future__ import annotations

from typing import TypeAlias, overload

import numpy as np

from stickslip import _core
from stickslip.checks import constant, listed, text, unknown
from stickslip.errors import ModelError
from stickslip.model import Model, PointRef
from stickslip.model.contact import of_one_unit
from stickslip.results.arrays import Arrays, Measure, amplitude_of
from stickslip.results.contact_motion import ContactMotion
from stickslip.results.fields import Float
from stickslip.results.peaks import Peak
from stickslip.results.periodic import key_of
from stickslip.settings.balance import BalanceSettings

COMMON = {"level": "m", "omega": "m s/rad"}
"""What belongs to no contact: a factor on the forces that vary, and the excitation frequency."""

_SAME = 0.05
"""Relative difference of two amplitudes up to which they are those of one branch."""

_STEEP = 1e-3
"""Slope in the frequency, relative to height and frequency, of a peak that is beside a corner."""

_BESIDE = np.array([1e-9, 1e-8, 1e-7, 1e-6, 1e-5])
"""Relative distances within which the place of a corner is known: the other side is behind."""

Cause: TypeAlias = "str | tuple[int, int | None, str]"

Place: TypeAlias = "str | tuple[str, int]"
"""A contact by its name, or one of its points."""


class Sensitivities(ContactMotion):
    """The part of a forced response that concerns its derivatives.

    They are exact: the balance is differentiated at its solution, with the Jacobian and the
    derivatives of the friction law that Newton's method uses, and nothing is solved anew.
    """

    @overload
    def sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: None = None,
        measure: Measure = "half_range",
    ) -> dict[tuple[Place, str], Float]: ...
    @overload
    def sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: str = ...,
        measure: Measure = "half_range",
    ) -> Float: ...
    def sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: str | None = None,
        measure: Measure = "half_range",
    ) -> Float | dict[tuple[Place, str], Float]:
        """Return the derivative of an amplitude in parameters of the contacts, or in the load.

        Where two turning points are equally high, or a contact is just about to slip, it is that
        of one side.

        Raises ModelError if there is no such parameter, or one of all contacts is a factor on some
        and a value of others.

        Parameters
        ----------
        dof : str
            A degree of freedom of the structure; it need not have been observed.
        parameter : str, optional
            A parameter of the contact's law ("slip_force", "stiffness"). Of several points, and
            without a contact of all contacts: changed together by the same amount. Also "level", a
            factor on the forces that vary, at its value 1, and "omega", the frequency. Default: all
            parameters.

        Returns
        -------
        ndarray of float64, shape (n,), or dict
            Amplitude per parameter, [m/N] for a slip force, [m] for the stiffness of a
            structure-like damper, a factor on its matrix. Without a parameter: one array for
            every (contact name, parameter), of contacts with several points
            ((contact name, point), parameter). Not-a-number at points that were not solved.
        """
        causes = _causes(self.model, contact, parameter)
        slopes = self._slopes(self.arrays, dof, list(causes.values()), measure)
        if parameter is None:
            names = causes.keys()
            return {name: constant(slopes[:, i].copy()) for i, name in enumerate(names)}
        return constant(slopes.sum(axis=1))

    @overload
    def peak_sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: None = None,
        measure: Measure = "half_range",
    ) -> dict[tuple[Place, str], float]: ...
    @overload
    def peak_sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: str = ...,
        measure: Measure = "half_range",
    ) -> float: ...
    def peak_sensitivity(
        self,
        dof: str,
        contact: PointRef | None = None,
        parameter: str | None = None,
        measure: Measure = "half_range",
    ) -> float | dict[tuple[Place, str], float]:
        """Return the derivative of the height of the peak.

        The frequency of the peak moves with the parameter, but the amplitude is stationary in it:
        the derivative of the peak is that of the amplitude at its frequency. Of a curve that folds
        it follows from the computed points around the peak, and is as exact as they are close. At a
        corner, where slip begins, the amplitude is not stationary: the peak is where the curves of
        both sides meet, and its derivative is that of their crossing.

        Raises ModelError as `sensitivity` and `ForcedResponse.peak`.

        Parameters
        ----------
        dof, contact, parameter, measure
            See `sensitivity`; "omega" is no parameter of a peak.

        Returns
        -------
        float or dict
            As `sensitivity`, one number each.
        """
        self._require_balance()
        if parameter == "omega":
            raise ModelError(
                'parameter: "omega" is no parameter of a peak, which is stationary in it; '
                'use sensitivity(..., parameter="omega") for the curve'
            )
        causes = _causes(self.model, contact, parameter)
        peak = self.peak(dof, measure)
        everything = [*causes.values(), "omega"]
        arrays = self._solved_at(np.array([peak.omega]), dof, measure)
        slopes = self._slopes(arrays, dof, everything, measure)[0]
        if not self.model.problem.laws_not_monotone:
            slopes = self._of_corner(peak, slopes, dof, everything, measure)
        elif not np.isinf(peak.amplitude):
            height = amplitude_of(arrays.displacement[:, :, 0], measure)[0]
            other = not np.isclose(height, peak.amplitude, rtol=_SAME, atol=0.0)
            if other or self.arrays.fold.any():
                slopes = np.append(self._along(dof, list(causes.values()), measure), 0.0)
        slopes = slopes[:-1]
        if parameter is None:
            return {name: float(slope) for name, slope in zip(causes, slopes, strict=True)}
        return float(slopes.sum())

    def _solved_at(self, omega: Float, dof: str, measure: Measure) -> Arrays:
        """Return the responses at frequencies that are solved for."""
        there = _core.forced_response(
            self.model.problem,
            omega,
            np.array([self.model.structure.index(key_of(dof, measure)[0])]),
            np.array([], dtype=np.int64),
            BalanceSettings.of(**self.settings.part(BalanceSettings)),
            None,
        )
        return Arrays.of(there.solution(None))

    def _of_corner(
        self, peak: Peak, slopes: Float, dof: str, causes: list[Cause], measure: Measure
    ) -> Float:
        """Return the derivatives of the height of a peak, whose own end with that in frequency."""
        rise, steep = slopes[-1], _STEEP * peak.amplitude / peak.omega
        if peak.at_edge or not abs(rise) > steep:
            return slopes
        beside = peak.omega * (1.0 + np.sign(rise) * _BESIDE)
        for others in self._slopes(self._solved_at(beside, dof, measure), dof, causes, measure):
            fall = others[-1]
            if rise * fall < 0.0 and abs(fall) > steep:
                crossing: Float = (rise * others - fall * slopes) / (rise - fall)
                return crossing
        return slopes

    def _along(self, dof: str, causes: list[Cause], measure: Measure) -> Float:
        """Return the derivatives of the height of the peak of a branch, from its highest points.

        What moves the top of a curve by v, across and upward, changes the amplitude at a frequency
        by v_up - a v_across, a being its slope: also beside a fold, where both have no bound.
        """
        amplitude = self.amplitude(dof, measure)
        best = int(np.nanargmax(amplitude))
        apart = self.arrays.jump | self.arrays.further
        near = [best]
        if best and not apart[best]:
            near.insert(0, best - 1)
        if best + 1 < amplitude.size and not apart[best + 1]:
            near.append(best + 1)
        near = [at for at in near if np.isfinite(amplitude[at])]
        found = self._slopes(self.arrays, dof, ["omega", *causes], measure)[near]
        if not 0 < best < amplitude.size - 1 or len(near) == 1:
            return found[near.index(best), 1:]
        steep = found[:, 0] * self.omega[best] / amplitude[best]
        weight = 1.0 / np.hypot(1.0, steep)[:, np.newaxis]
        rows = weight * np.column_stack([np.ones(len(near)), -steep])
        moved: Float = np.linalg.lstsq(rows, weight * found[:, 1:], rcond=None)[0][0]
        return moved

    def _require_balance(self) -> None:
        if self.kind != "forced_response":
            raise ModelError(
                f"sensitivity: none of an {self.kind}; differentiate the balance that "
                "forced_response solves"
            )

    def _slopes(self, arrays: Arrays, dof: str, causes: list[Cause], measure: Measure) -> Float:
        """Return the derivatives of an amplitude, shape (n, causes)."""
        self._require_balance()
        position = self.model.structure.index(key_of(dof, measure)[0])
        solved = arrays.solved
        slopes = np.full((arrays.omega.size, len(causes)), np.nan)
        if solved.any():
            try:
                slopes[solved] = _core.sensitivity(
                    self.model.problem,
                    arrays.omega[solved],
                    arrays.harmonics[solved],
                    np.ascontiguousarray(arrays.contact_displacement[solved]),
                    self.half_wave,
                    self.settings.residual,
                    position,
                    measure,
                    causes,
                    arrays.samples[solved],
                    self.settings.march is not None,
                )
            except ValueError as error:
                raise ModelError(f"sensitivity of {dof!r}: {error}") from error
        return slopes


def _causes(
    model: Model, contact: PointRef | None, parameter: str | None
) -> dict[tuple[Place, str], Cause]:
    """Return what is differentiated by, by (contact or point, parameter)."""
    if parameter is not None:
        text(parameter, "parameter")
    if parameter in COMMON:
        if contact is not None:
            raise ModelError(f"parameter: {parameter!r} belongs to no contact; leave contact out")
        return {("", parameter): parameter}
    known = _known(model, contact)
    if parameter is None:
        return known
    causes = {key: cause for key, cause in known.items() if key[1] == parameter}
    if not causes:
        names = [*dict.fromkeys(name for _, name in known), *(COMMON if contact is None else ())]
        raise ModelError(unknown("parameter", parameter, names))
    named = {key: key[0] if isinstance(key[0], str) else key[0][0] for key in causes}
    all_having = [one for one in model.contacts if one.name in named.values()]
    having = of_one_unit(all_having, str(parameter))
    owners = {str(one.name) for one in having}
    causes = {key: cause for key, cause in causes.items() if named[key] in owners}
    factors = {str(one.name) for one in having if parameter in one.factors}
    if factors and factors != owners:
        raise ModelError(
            f"parameter: {parameter!r} is a factor on a matrix in {listed(sorted(factors))} and a "
            f"value in {listed(sorted(owners - factors))}; name one contact"
        )
    return causes


def _known(model: Model, contact: PointRef | None) -> dict[tuple[Place, str], Cause]:
    """Return all that a contact, one of its points, or the model can be differentiated by."""
    only: int | None = None
    if isinstance(contact, tuple | list):
        position, only = model.slider(contact)
        positions = [position]
    elif contact is None:
        positions = list(range(len(model.contacts)))
    else:
        positions = [model.contact_index(contact)]
    known: dict[tuple[Place, str], Cause] = {}
    for position in positions:
        owner, name = model.contacts[position], model.contact_names[position]
        for parameter, values in owner.adjustable().items():
            if owner.by_point:
                for point in range(owner.points) if only is None else [only]:
                    key = name if owner.points == 1 else (name, point)
                    known[key, parameter] = (model.law_index(position, point), None, parameter)
            elif len(owner.slider_limits) == 1 or (len(values) == 1 and only is None):
                known[name, parameter] = (model.law_index(position), None, parameter)
            elif len(values) > 1:
                for point in range(len(values)) if only is None else [only]:
                    cause = (model.law_index(position), point, parameter)
                    known[(name, point), parameter] = cause
    return known

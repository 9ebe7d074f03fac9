"""What happens at the contacts: forces, displacements, slip and dissipation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from stickslip import _core
from stickslip.checks import constant, whole_number
from stickslip.errors import ModelError
from stickslip.model import ContactRef, Coulomb, PointRef
from stickslip.results.arrays import amplitude_of, mean_forces
from stickslip.results.events import ContactStates, states_at
from stickslip.results.fields import Complex, Float
from stickslip.results.peaks import Peaks

_Evaluation: TypeAlias = tuple[_core.Problem, int, Complex, str | float | None, tuple[int, bool]]
_INSTANTS = 4096
"""Instants per period by which states are told from forces, as the core does."""


class ContactMotion(Peaks):
    """The part of a result that concerns the contacts."""

    def contact_force(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the contact forces, shape (samples, points) or (samples,) [N].

        Positive against the relative displacement, and as the friction law gives them: its answer
        to the harmonics of the displacement, with its corners, not the truncated series of the
        force. Of a contact whose points have components, as `Coulomb`, they are in its frame, t1,
        t2, N, shape (samples, points, components): N is the normal force, a preload included.
        """
        position = self.position(index)
        count = whole_number(samples, "samples", smallest=1)
        number, point = self.locate(contact)
        own = self.model.contacts[number]
        if not self.arrays.solved[position]:
            forces = np.full((count, own.displacements), np.nan)[:, own.place(point)]
        else:
            try:
                forces = np.concatenate(
                    [_core.contact_force(*law, count) for law in self._laws(contact, position)],
                    axis=1,
                )
            except ValueError as error:
                raise ModelError(str(error)) from error
            self.model.forget_own()
            self.model.raise_own()
            if not own.by_point:
                forces = forces[:, own.place(point)]
            forces = forces + own.balanced[own.place(point)]
        return constant(np.ascontiguousarray(self._shaped(forces, number, point)))

    def _laws(self, contact: PointRef, position: int) -> Iterator[_Evaluation]:
        """Give what the core evaluates the laws of a contact, or a point, by at a solved point."""
        arrays, (number, point) = self.arrays, self.locate(contact)
        kept = int(arrays.harmonics[position]) + 1
        march = int(arrays.samples[position]), self.settings.march is not None
        own = self.model.contacts[number]
        every = range(own.points) if point is None else [point]
        for part in every if own.by_point else [None]:
            columns = self._columns(number, part)
            series = np.ascontiguousarray(arrays.contact_displacement[position, :kept, columns].T)
            law = self.model.law_index(number, part or 0)
            yield self.model.problem, law, series, self.settings.residual, march

    def resultant(self, contact: ContactRef, index: int, samples: int = 512) -> Float:
        """Return one period of the sum of the forces of a contact, shape (samples,) [N].

        It vanishes for a damper of several points that nothing else holds. Of a `Coulomb` contact
        it is the force on the first body, in the axes of its degrees of freedom (samples, d).
        """
        number = self.model.contact_index(contact)
        forces, own = self.contact_force(number, index, samples), self.model.contacts[number]
        if isinstance(own, Coulomb):
            return constant(own.on_first(forces.reshape(len(forces), own.points, -1)))
        return constant(forces.reshape(len(forces), -1).sum(axis=1))

    def contact_states(self, contact: ContactRef, index: int) -> ContactStates:
        """Return when the points of a contact stick, slip and are open over one period.

        The phases, and the sets of points that slip at once.

        Raises ModelError if the point was not solved.
        """
        position = self.position(index)
        number = self.model.contact_index(contact)
        if not self.arrays.solved[position]:
            raise ModelError(
                f"index: {position} was not solved, so that its contacts have no states; choose a "
                "solved point"
            )
        own = self.model.contacts[number]
        if not own.core_phases:
            force = self.contact_force(number, position, _INSTANTS)
            return states_at(own.states(force.reshape(_INSTANTS, own.points, -1)))
        start, direction = _core.contact_phases(*next(self._laws(number, position)))
        return ContactStates(constant(start / (2.0 * np.pi)), direction.astype(np.int8))

    def contact_waveform(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the relative displacement at the contacts.

        With `contact_force` at the same instants it draws the hysteresis loop. Of a contact or one
        of its points, shape (samples, points) or (samples,) [m]; with components as of
        `contact_force`, where that of N closes the contact.
        """
        number, point = self.locate(contact)
        series = self.arrays.contact_displacement[..., self._columns(number, point)]
        return constant(self._shaped(self._period(series, index, samples), number, point))

    def damper_displacement(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the deflection of the contact springs, z = f / k_d.

        The law's own answer to the harmonics of the displacement, with its corners: it follows the
        motion while the contact sticks and rests at F_d / k_d while it slips. For a single harmonic
        this is Guillen's improvement of Griffin's method.

        Of a contact or one of its points, shape (samples, points) or (samples,) [m].

        Raises ModelError if its law has no single stiffness above 0.

        References
        ----------
        Guillen (1999), section 2.2.4, Table 2.1.
        """
        stiffness, _ = self._spring(contact)
        return constant(self.contact_force(contact, index, samples) / stiffness)

    def damper_amplitude(self, contact: PointRef) -> Float:
        """Return half the range of the deflection of the contact springs over a period.

        That of the relative displacement where the contact never slips, else F_d / k_d. Of a
        contact or one of its points, shape (n, points) or (n,) [m].

        Raises ModelError if its law has no single stiffness above 0.

        References
        ----------
        Guillen (1999), section 2.2.5.
        """
        stiffness, slip_force = self._spring(contact)
        return self._by_point(
            contact, lambda u: np.minimum(amplitude_of(u, "half_range"), slip_force / stiffness)
        )

    def residual_bounds(self, contact: PointRef) -> Float:
        """Return the mean forces that a contact could hold without changing the vibration.

        A contact that never slips keeps a mean force from its history. With half range R of its
        displacement any force up to F_d - k_d R at mid-range goes with the same vibration; the
        bounds are those of the mean force. A contact that slips holds the mean force that the
        motion gives it, and the two bounds are 0.

        Lower and upper bound, shape (n, points, 2) or (n, 2) [N].

        Raises ModelError if its law has no single stiffness and slip force.
        """
        number, _ = self.locate(contact)
        owner = self.model.contacts[number]
        parameters = owner.parameters()
        if not (owner.one_spring and {"stiffness", "slip_force"} <= set(parameters)):
            raise ModelError(
                f"contact {self.model.contact_names[number]!r}: residual bounds need one stiffness "
                f"and one slip force, which the law {owner.law!r} has not"
            )
        stiffness, slip_force = parameters["stiffness"], parameters["slip_force"]
        return self._by_point(contact, lambda u: mean_forces(u, stiffness, slip_force))

    def _by_point(self, contact: PointRef, of: Callable[[Complex], Float]) -> Float:
        """Return what follows from the harmonics of each point of a contact, side by side."""
        series = self._select(self.arrays.contact_displacement, contact)
        points = series.reshape(*series.shape[:2], -1)
        found = [of(np.ascontiguousarray(points[:, :, n])) for n in range(points.shape[2])]
        values = np.stack(found, axis=1)
        values[~self.arrays.solved] = np.nan
        return constant(values if series.ndim == 3 else np.ascontiguousarray(values[:, 0]))

    def _spring(self, contact: PointRef) -> tuple[float, float]:
        """Return stiffness and slip force of a contact whose law has one of each."""
        number, _ = self.locate(contact)
        owner = self.model.contacts[number]
        parameters = owner.parameters() if owner.one_spring else {}
        if not {"stiffness", "slip_force"} <= set(parameters) or not parameters["stiffness"]:
            raise ModelError(
                f"contact {self.model.contact_names[number]!r}: the deflection of its spring needs "
                "one stiffness above 0 and one slip force; see contact_force instead"
            )
        return parameters["stiffness"], parameters["slip_force"]

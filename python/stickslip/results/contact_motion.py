"""What happens at the contacts: forces, displacements, slip and dissipation."""

from __future__ import annotations

import numpy as np

from stickslip.checks import whole_number
from stickslip.errors import ModelError
from stickslip.model import ContactRef, PointRef
from stickslip.results.arrays import Complex, Float, amplitude_of, constant, mean_forces
from stickslip.results.contact_states import ContactStates
from stickslip.results.sweep import Sweep

__all__ = ["ContactMotion"]


class ContactMotion(Sweep):
    """The part of a result that concerns the contacts."""

    def contact_force(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the contact forces, as the friction law gives them.

        This is the law's answer to the harmonics of the displacement, with its corners, not the
        truncated series of the force.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.
        index : int
            Position of the point of the sweep; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples, points) or (samples,)
            [N], positive against the relative displacement.

        Raises
        ------
        ModelError
            If there is no such contact or point.
        """
        from stickslip import _core

        position = self.position(index)
        count = whole_number(samples, "samples", smallest=1)
        number, point = self.locate(contact)
        columns = self._columns(number, None)
        if not self.arrays.solved[position]:
            forces = np.full((count, columns.stop - columns.start), np.nan)
        else:
            kept = int(self.arrays.harmonics[position]) + 1
            series = self.arrays.contact_displacement[position, :kept, columns].T
            try:
                forces = _core.contact_force(
                    self.model.problem,
                    number,
                    np.ascontiguousarray(series),
                    self.settings.residual,
                    int(self.arrays.samples[position]) or None,
                    count,
                )
            except ValueError as error:
                raise ModelError(str(error)) from error
        return constant(forces if point is None else np.ascontiguousarray(forces[:, point]))

    def resultant(self, contact: ContactRef, index: int, samples: int = 512) -> Float:
        """Return one period of the sum of the forces of a contact.

        It vanishes for a damper of several points that nothing else holds.

        Parameters
        ----------
        contact : int or str
            The contact.
        index : int
            Position of the point of the sweep; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples,)
            [N].

        Raises
        ------
        ModelError
            If there is no such contact or point of the sweep.
        """
        number = self.model.contact_index(contact)
        forces = self.contact_force(number, index, samples)
        return constant(forces.reshape(len(forces), -1).sum(axis=1))

    def contact_states(self, contact: ContactRef, index: int) -> ContactStates:
        """Return when the points of a contact stick and slip over one period.

        Parameters
        ----------
        contact : int or str
            The contact.
        index : int
            Position of a solved point of the sweep; negative ones count from the end.

        Returns
        -------
        ContactStates
            The phases, and the sets of points that slip at once.

        Raises
        ------
        ModelError
            If there is no such contact or point, or the point was not solved.
        """
        from stickslip import _core

        position = self.position(index)
        number = self.model.contact_index(contact)
        if not self.arrays.solved[position]:
            raise ModelError(
                f"index: {position} was not solved, so that its contacts have no states; choose a "
                "solved point"
            )
        kept = int(self.arrays.harmonics[position]) + 1
        series = self.arrays.contact_displacement[position, :kept, self._columns(number, None)].T
        start, direction = _core.contact_phases(
            self.model.problem,
            number,
            np.ascontiguousarray(series),
            self.settings.residual,
            int(self.arrays.samples[position]) or None,
        )
        return ContactStates(constant(start / (2.0 * np.pi)), direction.astype(np.int8))

    def contact_waveform(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the relative displacement at the contacts.

        With `contact_force` at the same instants it draws the hysteresis loop.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.
        index : int
            Position of the point of the sweep; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples, points) or (samples,)
            [m].

        Raises
        ------
        ModelError
            If there is no such contact or point.
        """
        return self._period(self._select(self.arrays.contact_displacement, contact), index, samples)

    def damper_displacement(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the deflection of the contact springs, z = f / k_d.

        The law's own answer to the harmonics of the displacement, with its corners: it follows the
        motion while the contact sticks and rests at F_d / k_d while it slips. For a single harmonic
        this is Guillen's improvement of Griffin's method.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.
        index : int
            Position of the point of the sweep; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples, points) or (samples,)
            [m].

        Raises
        ------
        ModelError
            If there is no such contact or point, or its law has no single stiffness above 0.

        References
        ----------
        Guillen (1999), section 2.2.4, Table 2.1.
        """
        stiffness, _ = self._spring(contact)
        return constant(self.contact_force(contact, index, samples) / stiffness)

    def damper_amplitude(self, contact: PointRef) -> Float:
        """Return half the range of the deflection of the contact springs over a period.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.

        Returns
        -------
        ndarray of float64, shape (n, points) or (n,)
            [m]: that of the relative displacement where the contact never slips, else F_d / k_d.

        Raises
        ------
        ModelError
            If there is no such contact or point, or its law has no single stiffness above 0.

        References
        ----------
        Guillen (1999), section 2.2.5.
        """
        stiffness, slip_force = self._spring(contact)
        series = self._select(self.arrays.contact_displacement, contact)
        points = series.reshape(*series.shape[:2], -1)
        half = [
            amplitude_of(np.ascontiguousarray(points[:, :, point]), "half_range")
            for point in range(points.shape[2])
        ]
        values = np.minimum(np.stack(half, axis=1), slip_force / stiffness)
        values[~self.arrays.solved] = np.nan
        return constant(values if series.ndim == 3 else np.ascontiguousarray(values[:, 0]))

    def residual_bounds(self, contact: PointRef) -> Float:
        """Return the mean forces that a contact could hold without changing the vibration.

        A contact that never slips keeps a mean force from its history. With half range R of its
        displacement any force up to F_d - k_d R at mid-range goes with the same vibration; the
        bounds are those of the mean force. A contact that slips holds the mean force that the
        motion gives it, and the two bounds are 0.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.

        Returns
        -------
        ndarray of float64, shape (n, points, 2) or (n, 2)
            Lower and upper bound [N].

        Raises
        ------
        ModelError
            If there is no such contact or point, or its law has no single stiffness and slip force.
        """
        number, _ = self.locate(contact)
        parameters = self.model.contacts[number].parameters()
        if not {"stiffness", "slip_force"} <= set(parameters):
            raise ModelError(
                f"contact {self.model.contact_names[number]!r}: residual bounds need one stiffness "
                f"and one slip force, which the law {self.model.contacts[number].law!r} has not"
            )
        stiffness, slip_force = parameters["stiffness"], parameters["slip_force"]
        series = self._select(self.arrays.contact_displacement, contact)
        points = series.reshape(*series.shape[:2], -1)
        bounds = [
            mean_forces(np.ascontiguousarray(points[:, :, point]), stiffness, slip_force)
            for point in range(points.shape[2])
        ]
        values = np.stack(bounds, axis=1)
        values[~self.arrays.solved] = np.nan
        return constant(values if series.ndim == 3 else np.ascontiguousarray(values[:, 0]))

    def _spring(self, contact: PointRef) -> tuple[float, float]:
        """Return stiffness and slip force of a contact whose law has one of each."""
        number, _ = self.locate(contact)
        parameters = self.model.contacts[number].parameters()
        if not {"stiffness", "slip_force"} <= set(parameters) or not parameters["stiffness"]:
            raise ModelError(
                f"contact {self.model.contact_names[number]!r}: the deflection of its spring needs "
                "one stiffness above 0 and one slip force; see contact_force instead"
            )
        return parameters["stiffness"], parameters["slip_force"]

    def _period(self, series: Complex, index: int, samples: int) -> Float:
        position = self.position(index)
        count = whole_number(samples, "samples", smallest=1)
        if not self.arrays.solved[position]:
            return constant(np.full((count, *series.shape[2:]), np.nan))
        # Whole turns are dropped before the angle is formed: high harmonics keep all digits.
        kept = int(self.arrays.harmonics[position]) + 1
        turns = np.outer(np.arange(count), np.arange(kept)) % count
        turn = np.exp(2j * np.pi / count * turns)
        return constant(np.ascontiguousarray((turn @ series[position, :kept]).real))

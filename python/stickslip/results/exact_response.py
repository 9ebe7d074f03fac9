"""Exact periodic orbits over frequency: a forced response with events and multipliers."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.checks import constant, whole_number
from stickslip.disk.wave_ring import Rotation, moving
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import ContactRef, PointRef
from stickslip.model.model import Model
from stickslip.model.pace import refusal
from stickslip.model.state import State
from stickslip.results.arrays import STABILITY, Arrays, ExactColumns, Measure, amplitude_in
from stickslip.results.dataset import Stored
from stickslip.results.energy import Energy, apparent_work
from stickslip.results.events import KINDS, ContactStates, Events, states_of
from stickslip.results.fields import Code, Computed, Float, Int, column
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.peaks import RIVAL, Peak, highest, of_orbits
from stickslip.results.periodic import key_of
from stickslip.results.stability import FloquetStability, stability_of
from stickslip.results.status import Status
from stickslip.settings.orbits import ExactSettings


class OrbitArrays(Arrays, ExactColumns):
    """The numbers of exact orbits: those of a forced response, and what only orbits have.

    At points without an orbit
    everything but `omega`, `status`, `residual` and `iterations` is not-a-number, and there are no
    events.
    """

    labels: ClassVar[Mapping[str, Sequence[str]]] = {"side": ("lowest", "highest")}

    residual: Float = column(
        "*", "1", "gap of the orbit after a period, relative to the motion", least=0.0
    )
    error_estimate: Float = column(
        "* dof", "m", "what the gap of the orbit could still change", least=0.0
    )
    work: Float = column("*", "J", "work of the external forces per period")
    viscous: Float = column("*", "J", "energy lost to damping per period")
    event_offset: Int = column("boundary", "1", "first event of each point", least=0)
    event_time: Float = column("event", "s", "time of the event in the period", least=0.0)
    event_point: Int = column(
        "event", "1", "contact point, over all contacts", least=0, most="point"
    )
    event_kind: Code = column("event", "1", "what happens", codes=KINDS)

    @classmethod
    def of(cls, solution: Computed, **more: NDArray[Any]) -> Self:
        """Take over what the core returns, blanking the numbers that mean nothing."""
        values = {**solution.columns, **more}
        status, counts = values["status"], values.pop("event_count")
        status[status == Status.STALLED.code] = Status.ORBIT_STALLED.code
        solved = status == Status.CONVERGED.code
        chosen = np.repeat(solved, counts)
        for name in ("event_time", "event_point", "event_kind"):
            values[name] = values[name][chosen]
        values["event_offset"] = np.append(0, np.cumsum(np.where(solved, counts, 0)))
        # Orbits are not marched.
        values["sampling_error"] = np.zeros_like(values["error_estimate"])
        told = ("omega", "residual")
        for name, entry in cls.table().items():
            kind = values[name].dtype.kind
            if entry.dims[0] == cls.along and kind in "fc" and name not in told:
                values[name][~solved] = complex(np.nan, np.nan) if kind == "c" else np.nan
        values["neutral"][~solved] = 0
        made = cls(**{name: values[name] for name in cls.table()})
        states = stability_of(made.multipliers, made.neutral, made.known)
        codes = [STABILITY.index(state) for state in states.tolist()]
        return replace(made, stability=np.array(codes, np.uint8))

    @classmethod
    def read(cls, dataset: Stored, **more: Any) -> Self:
        """Return the columns that a dataset holds; see `Columns.read`."""
        arrays = super().read(dataset, **more)
        ends, events = arrays.event_offset, arrays.event_time.size
        divided = ends.size == arrays.omega.size + 1 and ends[0] == 0 and ends[-1] == events
        if not divided or (np.diff(ends) < 0).any():
            raise ValueError(f"event_offset does not divide the {events} events")
        return arrays

    def of_sector(self, points: int, sectors: int) -> Self:
        """Return what belongs to sector 0 of some equal ones, with the state of all of them.

        `points` counts the contact points of a sector; work and losses are those of one.
        """
        own = self.event_point < points
        return replace(
            self,
            contact_displacement=self.contact_displacement[..., :points],
            contact_force=self.contact_force[..., :points],
            slip_fraction=self.slip_fraction[:, :points],
            dissipation=self.dissipation[:, :points],
            work=self.work / sectors,
            viscous=self.viscous / sectors,
            event_offset=np.concatenate(([0], np.cumsum(own)))[self.event_offset],
            event_time=self.event_time[own],
            event_point=self.event_point[own],
            event_kind=self.event_kind[own],
        )

    def turned(self, rotation: Rotation, number: int, share: float, dofs: int) -> Self:
        """Return the orbits seen from another sector, with series that are turned already.

        The sector is ahead by a share of the period, and has so many degrees of freedom.
        """
        places = np.arange(rotation.sectors) + number
        factors = rotation.wrap ** (places // rotation.sectors)
        moved = rotation.sectors * dofs
        parts = np.split(self.state, [moved, 2 * moved], axis=1)
        blocks = [part.reshape(len(part), rotation.sectors, -1) for part in parts]
        ahead = [block[:, places % rotation.sectors] * factors[:, None] for block in blocks]
        period = 2.0 * np.pi / self.omega
        point = np.repeat(np.arange(self.omega.size), np.diff(self.event_offset))
        time = (self.event_time - share * period[point]) % period[point]
        order = np.lexsort((time, point))
        return replace(
            self,
            state=np.concatenate([block.reshape(len(block), -1) for block in ahead], axis=1),
            event_time=time[order],
            event_point=self.event_point[order],
            event_kind=self.event_kind[order],
        )


class ExactResponse(FloquetStability, ForcedResponse):
    """Exact periodic orbits over the excitation frequency.

    A `ForcedResponse` without truncation: amplitudes are the exact extrema of the orbits, waveforms
    and contact forces follow them from event to event, and peaks are refined on orbits. Only
    `coefficients`, `phase` and the fundamental amplitude are those of a series. Beside that the
    orbits have events and Floquet multipliers.
    """

    kind: ClassVar[str] = "exact_response"
    title = "Forced response of a structure with dry friction, by exact periodic orbits"

    settings: ExactSettings
    arrays: OrbitArrays

    plot_multipliers = Drawn("multipliers")
    plot_events = Drawn("events")

    @cached_property
    def energy(self) -> Energy:
        """Work of the forces and energy lost, per period, integrated along the orbits."""
        arrays = self.arrays
        friction = np.where(arrays.solved, arrays.dissipation.sum(axis=1), np.nan)
        return Energy(arrays.work, arrays.viscous, constant(friction), apparent_work(self))

    @cached_property
    def _moving(self) -> tuple[_core.Problem, Rotation | None]:
        return moving(self.model, half_wave=self.half_wave)

    def sector(self, number: int) -> Self:
        """Return the motion of another sector of a tuned disk; see `ForcedResponse.sector`."""
        seen = super().sector(number)
        disk, rotation = self._tuned_disk(), self._moving[1]
        if seen is self or rotation is None:
            return seen
        share = (disk.engine_order * number % disk.sectors) / disk.sectors
        turned = seen.arrays.turned(rotation, number, share, len(disk.structure))
        return replace(seen, arrays=turned)

    def events(self, index: int) -> Events:
        """Return when contact points begin to stick and to slip, over one period.

        In the order of time, from 0 to the period; empty where nothing slips, and at points that
        are not solved.
        """
        position = self.position(index)
        arrays = self.arrays
        of = slice(*(int(place) for place in arrays.event_offset[position : position + 2]))
        return Events.of(
            self.model, arrays.event_time[of], arrays.event_point[of], arrays.event_kind[of]
        )

    def state(self, index: int) -> State:
        """Return the state at t = 0, from which `stickslip.transient` continues the orbit.

        Displacements, velocities and contact forces.

        Raises ModelError if the point is not solved, or the orbit is one of several sectors.
        """
        position = self.position(index)
        status = self.status[position]
        if not status.solved:
            raise ModelError(f"index: {index} has no state ({status}). {status.advice}")
        if self._moving[1] is not None:
            raise ModelError(
                "state: the orbit of a tuned disk is one of several sectors; take it of "
                "exact_response(disk.mistuned(0))"
            )
        return State.of_vector(self.model, self.arrays.state[position])

    def _amplitude(self, dof: str, measure: Measure) -> Float:
        if measure == "fundamental":
            return np.abs(self.coefficients(dof)[:, 1])
        return amplitude_in(self.arrays.range[:, self._column(dof)], measure)

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement, along the orbit."""
        return self._orbit(0, self._column(dof), index, samples)

    def waveforms(self, index: int, samples: int = 256) -> Float:
        """Return one period of all observed displacements at once, shape (samples, n_o).

        The columns are in the order of `dofs`.
        """
        return self._orbit(0, slice(None), index, samples)

    def velocity_waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a velocity, along the orbit, shape (samples,) [m/s]."""
        return self._orbit(1, self._column(dof), index, samples)

    def contact_waveform(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the relative displacement at the contacts, along the orbit."""
        return self._at_contact(2, contact, index, samples)

    def contact_force(self, contact: PointRef, index: int, samples: int = 512) -> Float:
        """Return one period of the contact forces, along the orbit."""
        return self._with_balanced(self._at_contact(3, contact, index, samples), contact)

    def contact_states(self, contact: ContactRef, index: int) -> ContactStates:
        """Return when the points of a contact stick and slip, by the events of the orbit."""
        number = self.model.contact_index(contact)
        columns, own = self._columns(number, None), self.model.contacts[number]
        return states_of(self.events(index), columns, 2.0 * np.pi / self.omega[index], own)

    def peak(self, dof: str, measure: Measure = "half_range") -> Peak:
        """Return the highest point of the response curve, refined on exact orbits.

        Its amplitude is infinite, with a warning, where neither damping nor friction bounds it.
        """
        key = key_of(dof, measure)
        if key not in self._peaks:
            self._peaks[key] = highest(self, dof, measure, of_orbits)
        return self._peaks[key]

    def _peaks_of(self, dofs: Sequence[str], measure: Measure) -> list[Peak]:
        return [self.peak(dof, measure) for dof in dofs]

    def _highest_of(self, dofs: Sequence[str], measure: Measure) -> tuple[int, Peak]:
        tops = np.nanmax([self.amplitude(dof, measure) for dof in dofs], axis=1)
        grows = [self._unbounded[self.model.structure.index(dof)] is not None for dof in dofs]
        rivals = np.flatnonzero((tops >= RIVAL * tops.max()) | grows)
        peaks = {at: self.peak(dofs[at], measure) for at in rivals.tolist()}
        return max(peaks.items(), key=lambda one: one[1].amplitude)

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        made = super()._further_variables(derived=derived) | self._stable("omega")
        if derived:
            counts = np.diff(self.arrays.event_offset)
            about = {"units": "rad/s", "long_name": "angular frequency of the orbit of the event"}
            made["event_omega"] = ("event", np.repeat(self.omega, counts), about)
        return made

    @classmethod
    def _states(cls, model: Model, *, half_wave: bool) -> list[str]:
        """Return a name for every entry of a state; of a wave, with the sectors in front."""
        own, rotation = super()._states(model, half_wave=half_wave), None
        if model.travels:
            _, rotation = moving(model, half_wave=half_wave)
        if rotation is None:
            return own
        moved = len(model.structure)
        parts = own[:moved], own[moved : 2 * moved], own[2 * moved :]
        return [
            f"{name[0]} {sector}.{name[2:]}"
            for part in parts
            for sector in range(rotation.sectors)
            for name in part
        ]

    def _at_contact(self, part: int, contact: PointRef, index: int, samples: int) -> Float:
        number, point = self.locate(contact)
        motion = self._orbit(part, self._columns(number, point), index, samples)
        return constant(np.ascontiguousarray(self._shaped(motion, number, point)))

    def _orbit(self, part: int, places: slice | int, index: int, samples: int) -> Float:
        """Return displacement, velocity, contact displacement or force (0 to 3) of an orbit."""
        position = self.position(index)
        count = whole_number(samples, "samples", smallest=1)
        model, arrays = self.model, self.arrays
        columns = len(self.dofs) if part < 2 else arrays.contact_force.shape[2]
        if not arrays.solved[position]:
            motion = np.full((count, columns), np.nan)
        else:
            observed = [model.structure.index(dof) for dof in self.dofs]
            try:
                motion = _core.orbit_history(
                    self._moving[0],
                    float(arrays.omega[position]),
                    arrays.state[position],
                    np.array(observed, dtype=np.int64),
                    count,
                )[part]
            except ValueError as error:
                raise refusal(error, model) from error
        return constant(np.ascontiguousarray(motion[:, :columns][:, places]))

"""A state of a model: where a motion starts, and where it has come to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, constant, set_fields, unknown
from stickslip.errors import ModelError
from stickslip.model.model import Model, PointRef, require_model
from stickslip.units import physical_number, without_units

Float: TypeAlias = NDArray[np.float64]

# A force on the slip limit may lie above it by what rounding leaves.
_ROUNDING = 1e-9


@dataclass(frozen=True, init=False, eq=False, repr=False)
class State:
    """Displacements, velocities and contact forces of a model at one instant.

    Parameters
    ----------
    model : Model
        Whose state it is.
    displacement, velocity : array_like, shape (N,), or mapping of str to float, optional
        Of all degrees of freedom in order, or by name, the others zero [m, m/s]. Default: zero.
    contact_force : array_like, shape (n_p,), or mapping, optional
        Of all contact points in order, or by contact or (contact, point), the others zero [N].
        Of contacts without sliders (`Iwan`, `Masing`) the origin and the reversals [m], see their
        `remembered`. Default: zero.

    Raises
    ------
    ModelError
        If a name is unknown, a number is not finite, an array has another length, or a force
        exceeds the slip force of its contact.
    """

    dofs: tuple[str, ...]
    displacement: Float
    velocity: Float
    contact_force: Float
    """(n_p,) Contact forces [N], positive against the relative displacement."""

    def __init__(
        self,
        model: Model,
        displacement: ArrayLike | Mapping[str, float] | None = None,
        velocity: ArrayLike | Mapping[str, float] | None = None,
        contact_force: ArrayLike | Mapping[PointRef, float] | None = None,
    ) -> None:
        require_model(model)
        forces = _forces(model, contact_force)
        set_fields(
            self,
            dofs=model.structure.dofs,
            displacement=_motion(model, displacement, "displacement", "m"),
            velocity=_motion(model, velocity, "velocity", "m/s"),
            contact_force=forces,
        )

    def __repr__(self) -> str:
        largest = float(np.abs(self.displacement).max(initial=0.0))
        return f"State({len(self.dofs)} dofs, largest displacement {largest:.3g} m)"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, State):
            return NotImplemented
        return self.dofs == other.dofs and np.array_equal(self.vector, other.vector)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[object, ...]:
        # Unpickled arrays would be writeable.
        return _rebuilt, (dict(vars(self)),)

    @classmethod
    def rest(cls, model: Model) -> Self:
        """Return the state of a model without displacement, velocity or contact force."""
        return cls(model)

    @classmethod
    def of_vector(cls, model: Model, vector: Float) -> Self:
        """Return the state of a model in a vector (x, v, f), shape (2 N + n_p,)."""
        dofs = len(model.structure)
        return cls(model, vector[:dofs], vector[dofs : 2 * dofs], vector[2 * dofs :])

    @property
    def vector(self) -> Float:
        """The state as one vector (x, v, f), shape (2 N + n_p,), read-only."""
        return constant(np.concatenate([self.displacement, self.velocity, self.contact_force]))

    def require_fit(self, model: Model, entry: str) -> None:
        """Refuse a model with other degrees of freedom or another number of contact points."""
        points = sum(len(contact.remembered) for contact in model.contacts)
        if self.dofs != model.structure.dofs or self.contact_force.size != points:
            raise ModelError(
                f"{entry}: a state of {len(self.dofs)} dofs and {self.contact_force.size} contact "
                f"points of another model; this one has {len(model.structure)} and {points}, give "
                "ss.State(model, ...)"
            )
        _require_held(model, self.contact_force, entry)


def _motion(model: Model, values: object, entry: str, unit: str) -> Float:
    known = model.structure.dofs
    motion = np.zeros(len(known))
    if values is None:
        return motion
    if not isinstance(values, Mapping):
        return _row(values, entry, len(known), "dofs", unit)
    for name, value in values.items():
        if name not in known:
            raise ModelError(f"{entry}: {unknown('dof', name, known)}")
        motion[known.index(name)] = physical_number(value, unit, f"{entry} of {name!r}")
    return motion


def _forces(model: Model, values: object) -> Float:
    sizes = [len(contact.remembered) for contact in model.contacts]
    forces = np.zeros(sum(sizes))
    if isinstance(values, Mapping):
        for reference, value in values.items():
            contact, point = model.slider(reference)
            own = model.contacts[contact]
            if sizes[contact] != own.sliders:
                raise ModelError(
                    f"contact_force of {reference!r}: "
                    f"{'two tractions per node' if own.tangential > 1 else 'reversals'}; give all "
                    "forces of the model in one list"
                )
            place = sum(sizes[:contact]) + point
            forces[place] = physical_number(value, "N", f"contact_force of {reference!r}")
    elif values is not None:
        forces = _row(values, "contact_force", forces.size, "contact points", "N")
    _require_held(model, forces, "contact_force")
    return forces


def _row(values: object, entry: str, size: int, of: str, unit: str) -> Float:
    values = without_units(values, unit, entry)
    try:
        row = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ModelError(
            f"{entry}: {brief(values)} is neither a list of numbers nor a mapping; give "
            "{name: value}"
        ) from None
    if row.shape != (size,):
        raise ModelError(f"{entry}: shape {row.shape} for {size} {of}; give ({size},)")
    if not np.isfinite(row).all():
        place = int(np.flatnonzero(~np.isfinite(row))[0])
        raise ModelError(f"{entry}[{place}]: {row[place]} is not a finite number; give SI units")
    return row


def _require_held(model: Model, forces: Float, entry: str) -> None:
    """Refuse forces beyond what their contact can hold."""
    place = 0
    for name, contact in zip(model.contact_names, model.contacts, strict=True):
        limits = contact.remembered
        for force, limit in zip(forces[place:], limits, strict=False):
            if abs(force) > limit * (1.0 + _ROUNDING):
                raise ModelError(
                    f"{entry}: {force:g} N at contact {name!r} exceeds its slip force of "
                    f"{limit:g} N; give a force within it"
                )
        place += len(limits)


def _rebuilt(fields: dict[str, object]) -> State:
    state = object.__new__(State)
    set_fields(state, **fields)
    return state

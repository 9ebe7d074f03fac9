"""Friction contacts: where they act and their parameters; the mathematics of a law is compiled.

A new law is one class in a module of this folder, with its line in `LAWS` (`laws.py`), and one file
in the core.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, members, real_number, require_keys, text
from stickslip.errors import ModelError
from stickslip.model.dofs import Dofs
from stickslip.units import from_zero

OPEN = 2
"""State of a point whose bodies do not touch, beside 0, stuck, and 1 and -1, slipping."""


@dataclass(frozen=True)
class Contact(ABC):
    """A friction law at one or more contact points.

    Parameters
    ----------
    name : str, optional
        By which results and settings refer to the contact. A `Model` names the unnamed by their
        law: "jenkins", "jenkins-2", ...
    """

    law: ClassVar[str]
    """Name of the law, as the compiled core knows it."""

    keys: ClassVar[tuple[str, ...]] = ()
    """Names of the law's parameters, as its class and files have them."""

    factors: ClassVar[frozenset[str]] = frozenset()
    """Adjustable parameters that are factors on what the contact was given: they take no value."""

    other_units: ClassVar[Mapping[str, str]] = {}
    """Units of adjustable parameters that are in another one than those of this name elsewhere."""

    slips: ClassVar[bool] = True
    """Whether its points stick and slip; a spring without friction remembers no force."""

    one_spring: ClassVar[bool] = True
    """Whether what has a stiffness and a slip force is one spring in series with one slider."""

    core_phases: ClassVar[bool] = True
    """Whether the core tells when its points stick and slip; else `states` does, if it can."""

    by_point: ClassVar[bool] = False
    """Whether each point is a law of its own in the core; else one law has all points."""

    name: str | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if self.name is not None:
            text(self.name, f"{self.law} contact: name")

    @property
    @abstractmethod
    def dofs(self) -> tuple[str | None, ...]:
        """Names of the degrees of freedom it acts on; None is the ground."""

    @property
    @abstractmethod
    def points(self) -> int:
        """Number of contact points, each of which sticks or slips."""

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the displacements, and forces, of a point that has several; else none."""
        return ()

    @property
    def tangential(self) -> int:
        """Number of the displacements of a point, the first ones, along which it slips."""
        return 1

    @property
    def single(self) -> bool:
        """Whether it is one point with components, without a list of points around it."""
        return False

    @property
    def displacements(self) -> int:
        """Number n_u of its relative displacements."""
        return self.points * max(len(self.components), 1)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of its displacements, and forces, at an instant.

        (points,), with components (points, components), or (components,) of a `single` point.
        """
        parts = (len(self.components),) if self.components else ()
        return parts if self.single else (self.points, *parts)

    def place(self, point: int | None) -> slice:
        """Return where the displacements of a point stand among those of the contact."""
        size = self.displacements // self.points
        return slice(None) if point is None else slice(size * point, size * (point + 1))

    @abstractmethod
    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x for a structure of N degrees of freedom, shape (n_u, N).

        One row per displacement: +1 at its degree of freedom, -1 at that of its other end.
        """

    @property
    def balanced(self) -> Matrix:
        """Force of each displacement that is in equilibrium without motion, shape (n_u,) [N].

        The structure does not feel it, so that the laws leave it out.
        """
        return np.zeros(self.displacements)

    @property
    def limits(self) -> tuple[float, ...]:
        """Largest force of each contact point [N]."""
        return (self.parameters().get("slip_force", np.inf),) * self.points

    def friction_limit(self, force: Matrix) -> Matrix:
        """Return the largest traction of each point, shape (..., points) [N].

        `force` has shape (..., points, components), normal forces whole.
        """
        return np.broadcast_to(np.array(self.limits), force.shape[:-1])

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Slip limit of each part that sticks or slips by itself [N]: as a rule, of each point."""
        return self.limits

    @property
    def remembered(self) -> tuple[float, ...]:
        """Bound of each number that a state has of it: the forces of its sliders [N]."""
        return self.slider_limits

    @property
    def sliders(self) -> int:
        """Number of parts that have slip limits, and other parameters, of their own."""
        return self.points if self.by_point else len(self.slider_limits)

    @property
    def slider_shares(self) -> tuple[float, ...]:
        """Share of the force of its stuck point that each of these parts carries."""
        return (1.0,) * len(self.slider_limits)

    def parameters(self) -> dict[str, float]:
        """Return the parameters that are single numbers, by name, in SI units."""
        return {key: value for key in self.keys if isinstance(value := getattr(self, key), float)}

    def _values(self) -> dict[str, Any]:
        """Return all parameters by name, as the class takes them."""
        return self.parameters() | {key: getattr(self, key) for key in self.keys}

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return the parameters that an analysis can vary, by name, in SI units.

        Each has the value of every contact point, or one of the whole contact. See `factors`.
        """
        return {name: (value,) for name, value in self.parameters().items()}

    def variable(self) -> dict[str, tuple[float, ...]]:
        """Return what a sweep can vary: what is `adjustable`, and that of which it was made."""
        return self.adjustable()

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the contact with other values, as many as `variable` has, of a parameter."""
        (value,) = values
        return self._with(parameter, value)

    def _with(self, key: str, value: object) -> Self:
        return self.from_parameters(self.dofs, self._values() | {key: value}, self.name)

    def scaled(self, slip_force: float) -> Self:
        """Return the contact with every slip force multiplied; what never slips stays so."""
        own = self.adjustable().get("slip_force", ())
        limits = [force if np.isinf(force) else force * slip_force for force in own]
        return self.adjusted("slip_force", limits) if limits else self

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while every point sticks [N/m], shape (n_u, n_u)."""
        raise self._without_limits()

    def states(self, force: Matrix) -> NDArray[np.int8]:
        """Return what points with components do by their forces; see `ContactStates`."""
        raise ModelError(
            f"contact {self.name!r}: the law {self.law!r} tells no states from forces; see "
            "contact_force instead"
        )

    def linear_limit(self, *, stuck: bool) -> Contact | None:
        """Return what is left of the contact in a linear limit, as one that never slips.

        At small amplitude (`stuck`) everything sticks that has friction, at large amplitude only
        what never slips. None if nothing is left.

        A law without linear limits is refused.
        """
        raise self._without_limits()

    def _without_limits(self) -> ModelError:
        return ModelError(
            f"contact {self.name!r}: the law {self.law!r} has no single stiffness for the linear "
            "limits; draw with stuck=False, free=False"
        )

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return the parameters of each law as the compiled core takes them, in SI units.

        One law has all points, or each its own: see `by_point`.
        """
        return [dict(self.parameters())]

    def core_laws(self, *rows: Matrix) -> list[tuple[Any, ...]]:
        """Return the laws as the compiled core takes them: name, rows of B, parameters.

        `rows` are B of the contact, or its parts, shape (n_u, N) each.
        """
        laws = self.law_parameters()
        parts = zip(*(np.split(one, len(laws)) for one in rows), strict=True)
        return [(self.law, *own, values) for own, values in zip(parts, laws, strict=True)]

    def summary(self) -> str:
        """Return the parameters in words, in SI units."""
        return ", ".join(f"{name} {value:g}" for name, value in self.parameters().items())

    def named(self, name: str) -> Self:
        """Return the contact with another name."""
        return self.moved(self.dofs, name)

    def moved(self, dofs: Sequence[str | None], name: str | None) -> Self:
        """Return the contact at other degrees of freedom."""
        return self.from_parameters(tuple(dofs), self._values(), name)

    @classmethod
    def from_parameters(
        cls, dofs: tuple[str | None, ...], parameters: Mapping[str, object], name: str | None
    ) -> Self:
        """Build the contact from what `dofs`, the parameters of `to_spec` and `name` hold."""
        keys = cls._keys_of(parameters)
        require_keys(parameters, f"{cls.law} contact", keys, keys, "parameter")
        given = {key: _unlimited(value) for key, value in parameters.items()}
        return cls(*cls._placed(dofs), **given, name=name)

    @classmethod
    def _keys_of(cls, parameters: Mapping[str, object]) -> tuple[str, ...]:
        """Return the names that the parameters must have."""
        return cls.keys

    @classmethod
    def _placed(cls, dofs: tuple[str | None, ...]) -> tuple[Any, ...]:
        """Return degrees of freedom as the class takes them."""
        return (dofs,)

    def to_spec(self) -> dict[str, object]:
        """Return the contact in plain values that any text format can hold.

        They are `law`, `dofs`, `parameters` and `name`; infinity is the text "inf", which JSON has
        no number for. See `laws.contact_from_spec`.
        """
        return {
            "law": self.law,
            "dofs": list(self.dofs),
            "parameters": {key: _plain(value) for key, value in self._values().items()},
            "name": self.name,
        }


def of_one_unit(contacts: Sequence[Contact], parameter: str) -> Sequence[Contact]:
    """Return the contacts whose parameter has the unit that it has elsewhere; all if none has."""
    return [one for one in contacts if parameter not in one.other_units] or contacts


class Sliders(Contact):
    """A law of several sliders, each with its slip limit; its stiffness takes factors alone."""

    keys: ClassVar[tuple[str, ...]] = ("stiffness", "slip_forces")
    factors: ClassVar[frozenset[str]] = frozenset({"stiffness"})

    slip_forces: tuple[float, ...]

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return a factor on the stiffness, and the slip force of each slider [N]."""
        return {"stiffness": (1.0,), "slip_force": self.slip_forces}

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the contact with other slip forces, or its stiffness times a factor."""
        if parameter == "slip_force":
            return self._with("slip_forces", tuple(values))
        entry = f"{self.law} contact: factor"
        factor = real_number(values[0], f"{entry} on the stiffness")
        if factor < 0.0:
            raise ModelError(f"{entry} {factor:g} on the stiffness is negative; give >= 0")
        return self._with("stiffness", factor * np.asarray(self._values()["stiffness"]))


def real_numbers(
    values: Iterable[object], unit: str, entry: str, key: str, *, finite: bool
) -> tuple[float, ...]:
    """Return the numbers of a parameter, which must not be negative."""
    given = members(values, f"{entry}: {key}", f"{key}=[...]")
    return tuple(
        from_zero(value, unit, f"{entry}: {key}[{place}]", "numbers from zero", finite=finite)
        for place, value in enumerate(given)
    )


def _plain(value: object) -> object:
    """Return numbers as JSON has them, infinity as text."""
    if isinstance(value, tuple | list | np.ndarray):
        return [_plain(one) for one in np.asarray(value).tolist()]
    return value if value != np.inf else str(value)


def _unlimited(value: object) -> object:
    """Return what `_plain` was made of."""
    if isinstance(value, tuple | list):
        return [_unlimited(one) for one in value]
    return np.inf if isinstance(value, str) and value == "inf" else value


@dataclass(frozen=True, eq=False)
class Bonded(Contact):
    """Another contact with all that it holds without motion stuck for ever: a linear spring.

    Parameters
    ----------
    of : Contact
        The contact, whose displacements it has.
    held : ndarray of float64, shape (n_u, n_u)
        Its stiffness [N/m].
    """

    law: ClassVar[str] = "structural"

    of: Contact
    held: Matrix

    @property
    def dofs(self) -> tuple[str | None, ...]:
        """Names of the degrees of freedom it acts on."""
        return self.of.dofs

    @property
    def points(self) -> int:
        """Number of relative displacements."""
        return self.of.displacements

    @property
    def stuck_stiffness(self) -> Matrix:
        """Its stiffness [N/m], shape (n_u, n_u)."""
        return self.held

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of the contact; see `Contact.rows`."""
        return self.of.rows(dofs)

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return the stiffness, row by row [N/m], and that nothing slips."""
        limits = [np.inf] * self.points
        return [{"stiffness": self.held.ravel().tolist(), "slip_forces": limits}]

    def named(self, name: str) -> Self:
        """Return the contact with another name."""
        return replace(self, name=name)

"""Friction contacts: where they act and their parameters; the mathematics of a law is compiled.

A new law is one class here or in a module of its own, with its line in `LAWS` (`laws.py`), and one
file in the core.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from stickslip.checks import Matrix, brief, real_number, text, unknown
from stickslip.errors import ModelError
from stickslip.model.structure import Structure

__all__ = ["Contact", "Jenkins", "end_rows", "two_ends"]


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

    factors: ClassVar[frozenset[str]] = frozenset()
    """Adjustable parameters that are factors on what the contact was given: they take no value."""

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

    @abstractmethod
    def rows(self, structure: Structure) -> Matrix:
        """Return B of u = B x.

        Parameters
        ----------
        structure : Structure
            The structure that the contact acts on, of N degrees of freedom.

        Returns
        -------
        ndarray of float64, shape (points, N)
            One row per contact point.

        Raises
        ------
        ModelError
            If the structure lacks a degree of freedom.
        """

    @property
    def limits(self) -> tuple[float, ...]:
        """Largest force of each contact point [N]."""
        return (self.parameters().get("slip_force", np.inf),) * self.points

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Slip limit of each part that sticks or slips by itself [N]: as a rule, of each point."""
        return self.limits

    @property
    def slider_shares(self) -> tuple[float, ...]:
        """Share of the force of its stuck point that each of these parts carries."""
        return (1.0,) * len(self.slider_limits)

    @abstractmethod
    def parameters(self) -> dict[str, float]:
        """Return the parameters that are single numbers, by name, in SI units."""

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return the parameters that an analysis can vary, by name, in SI units.

        Returns
        -------
        dict of str to tuple of float
            The value of each contact point, or one of the whole contact. See `factors`.
        """
        return {name: (value,) for name, value in self.parameters().items()}

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the contact with other values of one of its adjustable parameters.

        Parameters
        ----------
        parameter : str
            Its name.
        values : sequence of float
            As many as `adjustable` has.

        Raises
        ------
        ModelError
            If the law refuses a value.
        """
        (value,) = values
        return self.from_parameters(self.dofs, {**self.parameters(), parameter: value}, self.name)

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while every point sticks [N/m], shape (points, points)."""
        raise self._without_limits()

    def held(self, *, stuck: bool) -> Contact | None:
        """Return what is left of the contact in a linear limit, as one that never slips.

        Parameters
        ----------
        stuck : bool
            At small amplitude everything sticks that has friction; else, at large amplitude, only
            what never slips.

        Returns
        -------
        Contact or None
            Without slip; None if nothing is left.

        Raises
        ------
        ModelError
            If the law has no linear limits.
        """
        raise self._without_limits()

    def _without_limits(self) -> ModelError:
        return ModelError(
            f"contact {self.name!r}: the law {self.law!r} has no single stiffness for the linear "
            "limits; draw with stuck=False, free=False"
        )

    def law_parameters(self) -> dict[str, float | list[float]]:
        """Return all parameters of the law as the compiled core takes them, in SI units."""
        return dict(self.parameters())

    def described(self) -> str:
        """Return the parameters in words, in SI units."""
        return ", ".join(f"{name} {value:g}" for name, value in self.parameters().items())

    def named(self, name: str) -> Self:
        """Return the contact with another name."""
        return replace(self, name=name)

    def moved(self, dofs: Sequence[str | None], name: str | None) -> Self:
        """Return the contact at other degrees of freedom."""
        return self.from_parameters(tuple(dofs), self.parameters(), name)

    @abstractmethod
    def scaled(self, slip_force: float) -> Self:
        """Return a contact with every slip force multiplied by `slip_force`."""

    @classmethod
    @abstractmethod
    def from_parameters(
        cls, dofs: tuple[str | None, ...], parameters: Mapping[str, object], name: str | None
    ) -> Self:
        """Build the contact from what `dofs`, `parameters` and `name` hold."""

    def to_spec(self) -> dict[str, object]:
        """Return the contact in plain values that any text format can hold.

        Returns
        -------
        dict
            `law`, `dofs` (list), `parameters` (dict; infinity is the text "inf", which JSON has no
            number for) and `name`. See `laws.contact_from_spec`.
        """
        parameters = {
            key: value if np.isfinite(value) else str(value)
            for key, value in self.parameters().items()
        }
        return {
            "law": self.law,
            "dofs": list(self.dofs),
            "parameters": parameters,
            "name": self.name,
        }


@dataclass(frozen=True)
class Jenkins(Contact):
    """A spring in series with a Coulomb slider: the elastic dry-friction element.

    The force follows f = clip(f + k_d du, -F_d, F_d) along the motion.

    Parameters
    ----------
    dof : str
        Degree of freedom it is attached to.
    other : str, optional
        Degree of freedom at its other end; the displacement is x_dof - x_other. Default: the
        ground.
    stiffness : float
        Stiffness k_d while it sticks [N/m].
    slip_force : float
        Force F_d at which it slips [N]. Zero is no friction, infinity never slips.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If the stiffness is negative or infinite, the slip force negative, either not a number, or
        both ends are the same degree of freedom.

    References
    ----------
    Guillen (1999), eqs. (2.1)-(2.2), with the return map of Table 3.1 corrected.
    """

    law: ClassVar[str] = "jenkins"

    dof: str
    other: str | None = None
    stiffness: float = field(kw_only=True)
    slip_force: float = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        two_ends(self.law, self.dof, self.other)
        entry = f"jenkins contact at {brief(self.dof)}"
        stiffness = real_number(self.stiffness, f"{entry}: stiffness", finite=False)
        slip_force = real_number(self.slip_force, f"{entry}: slip_force", finite=False)
        if stiffness < 0.0:
            raise ModelError(f"{entry}: stiffness {stiffness:g} is negative; give N/m above zero")
        if np.isinf(stiffness):
            raise ModelError(
                f"{entry}: stiffness inf; take about 1000 times the local structure stiffness as "
                "the rigid limit"
            )
        if slip_force < 0.0:
            raise ModelError(
                f"{entry}: slip_force {slip_force:g} is negative; give N, 0 for no friction"
            )
        object.__setattr__(self, "stiffness", stiffness)
        object.__setattr__(self, "slip_force", slip_force)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom it acts on, one (to ground) or two."""
        return (self.dof,) if self.other is None else (self.dof, self.other)

    @property
    def points(self) -> int:
        """Number of contact points: one."""
        return 1

    @property
    def limits(self) -> tuple[float, ...]:
        """Slip force [N]."""
        return (self.slip_force,)

    def rows(self, structure: Structure) -> Matrix:
        """Return B of u = B x.

        Parameters
        ----------
        structure : Structure
            The structure that the contact acts on, of N degrees of freedom.

        Returns
        -------
        ndarray of float64, shape (1, N)
            +1 at `dof`, -1 at `other`.

        Raises
        ------
        ModelError
            If the structure lacks a degree of freedom.
        """
        return end_rows(structure, self.dof, self.other)

    @property
    def stuck_stiffness(self) -> Matrix:
        """k_d [N/m], shape (1, 1)."""
        return np.array([[self.stiffness]])

    def held(self, *, stuck: bool) -> Jenkins | None:
        """Return the element without slip if it sticks in a linear limit; see `Contact.held`."""
        sticks = self.slip_force > 0.0 if stuck else np.isinf(self.slip_force)
        return replace(self, slip_force=np.inf) if sticks else None

    def parameters(self) -> dict[str, float]:
        """Return `stiffness` [N/m] and `slip_force` [N]."""
        return {"stiffness": self.stiffness, "slip_force": self.slip_force}

    def scaled(self, slip_force: float) -> Self:
        """Return a contact with its slip force multiplied; one that never slips stays so."""
        if np.isinf(self.slip_force):
            return self
        return replace(self, slip_force=self.slip_force * slip_force)

    @classmethod
    def from_parameters(
        cls, dofs: tuple[str | None, ...], parameters: Mapping[str, object], name: str | None
    ) -> Self:
        """Build the contact from what `dofs`, `parameters` and `name` hold.

        Raises
        ------
        ModelError
            If there are not one or two `dofs`, or other parameters than the law's two.
        """
        if not 1 <= len(dofs) <= 2:
            raise ModelError(f"jenkins contact: {len(dofs)} dofs; give one (to ground) or two")
        for key in parameters:
            if key not in ("stiffness", "slip_force"):
                raise ModelError(
                    f"jenkins contact: {unknown('parameter', key, ['stiffness', 'slip_force'])}"
                )
        return cls(
            *(text(dof, "jenkins contact: dof") for dof in dofs),
            stiffness=_parameter(parameters, "stiffness", "jenkins contact"),
            slip_force=_parameter(parameters, "slip_force", "jenkins contact"),
            name=name,
        )


def two_ends(law: str, dof: object, other: object) -> None:
    """Refuse two ends of a contact that are no two degrees of freedom."""
    text(dof, f"{law} contact: dof")
    if other is not None:
        text(other, f"{law} contact: other")
    if dof == other:
        raise ModelError(
            f"{law} contact: both ends at dof {brief(dof)}; name another dof, or leave "
            "`other` out for the ground"
        )


def end_rows(structure: Structure, dof: str, other: str | None) -> Matrix:
    """Return B of u = x_dof - x_other, shape (1, N)."""
    rows = np.zeros((1, len(structure)))
    rows[0, structure.index(dof)] = 1.0
    if other is not None:
        rows[0, structure.index(other)] = -1.0
    return rows


def _parameter(parameters: Mapping[str, object], key: str, entry: str) -> float:
    """Return a parameter as `Contact.to_spec` writes it, infinity as text."""
    if key not in parameters:
        raise ModelError(f"{entry}: {key} is missing; give {key}")
    value = parameters[key]
    return real_number(np.inf if value == "inf" else value, f"{entry}: {key}", finite=False)

"""Jenkins elements in parallel on one displacement: the discrete Iwan model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from stickslip.checks import Matrix, brief, members, real_number, unknown
from stickslip.errors import ModelError
from stickslip.model.contact import Contact, Jenkins, end_rows, two_ends
from stickslip.model.structure import Structure

__all__ = ["ParallelJenkins"]


@dataclass(frozen=True)
class ParallelJenkins(Contact):
    """Jenkins elements in parallel: a contact that begins to slip little by little.

    All elements share one displacement, so that the contact has one unknown per harmonic, however
    many elements it has. Its force is their sum.

    Parameters
    ----------
    dof : str
        Degree of freedom it is attached to.
    other : str, optional
        Degree of freedom at its other end; the displacement is x_dof - x_other. Default: the
        ground.
    stiffness : sequence of float
        Stiffness of each element while it sticks [N/m].
    slip_forces : sequence of float
        Force at which each element slips [N]. Zero is no friction, infinity never slips.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If a stiffness is negative or infinite, a slip force negative, one is not a number, there
        are not as many of both, or both ends are the same degree of freedom.

    References
    ----------
    Iwan (1966): the parallel-series model.
    """

    law: ClassVar[str] = "parallel-jenkins"
    factors: ClassVar[frozenset[str]] = frozenset({"stiffness"})

    dof: str
    other: str | None = None
    stiffness: tuple[float, ...] = field(kw_only=True)
    slip_forces: tuple[float, ...] = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        two_ends(self.law, self.dof, self.other)
        entry = f"{self.law} contact at {brief(self.dof)}"
        stiffness = _numbers(self.stiffness, f"{entry}: stiffness", finite=True)
        limits = _numbers(self.slip_forces, f"{entry}: slip_forces", finite=False)
        if len(stiffness) != len(limits):
            raise ModelError(
                f"{entry}: {len(limits)} slip_forces for {len(stiffness)} stiffnesses; give one "
                "of each per element"
            )
        object.__setattr__(self, "stiffness", stiffness)
        object.__setattr__(self, "slip_forces", limits)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom it acts on, one (to ground) or two."""
        return (self.dof,) if self.other is None else (self.dof, self.other)

    @property
    def points(self) -> int:
        """Number of contact points: one, for all elements have the same displacement."""
        return 1

    @property
    def limits(self) -> tuple[float, ...]:
        """Force at which all elements slip [N]."""
        return (sum(self.slider_limits),)

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Slip force of each element [N]; elements without stiffness carry none."""
        pairs = zip(self.stiffness, self.slip_forces, strict=True)
        return tuple(force if stiffness else 0.0 for stiffness, force in pairs)

    @property
    def slider_shares(self) -> tuple[float, ...]:
        """Share of the stiffness that each element has."""
        total = sum(self.stiffness) or 1.0
        return tuple(stiffness / total for stiffness in self.stiffness)

    def rows(self, structure: Structure) -> Matrix:
        """Return B of u = B x, shape (1, N): +1 at `dof`, -1 at `other`; see `Contact.rows`."""
        return end_rows(structure, self.dof, self.other)

    @property
    def stuck_stiffness(self) -> Matrix:
        """Sum of the stiffnesses [N/m], shape (1, 1)."""
        return np.array([[sum(self.stiffness)]])

    def held(self, *, stuck: bool) -> Jenkins | None:
        """Return the elements that stick in a linear limit as one; see `Contact.held`."""
        pairs = zip(self.stiffness, self.slip_forces, strict=True)
        left = sum(k for k, limit in pairs if (limit > 0.0 if stuck else np.isinf(limit)))
        if not left:
            return None
        return Jenkins(self.dof, self.other, stiffness=left, slip_force=np.inf, name=self.name)

    def parameters(self) -> dict[str, float]:
        """Return no parameters: none is a single number."""
        return {}

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return a factor on the stiffness, and the slip force of each element [N]."""
        return {"stiffness": (1.0,), "slip_force": self.slip_forces}

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the contact with other slip forces, or its stiffness times a factor."""
        if parameter == "slip_force":
            return replace(self, slip_forces=tuple(values))
        (factor,) = values
        return replace(self, stiffness=tuple(factor * k for k in self.stiffness))

    def law_parameters(self) -> dict[str, float | list[float]]:
        """Return `stiffness` [N/m] and `slip_force` [N] of the elements."""
        return {"stiffness": [*self.stiffness], "slip_force": [*self.slip_forces]}

    def described(self) -> str:
        """Return the parameters in words, in SI units."""
        return f"{len(self.stiffness)} elements, stiffness {sum(self.stiffness):g} in all"

    def moved(self, dofs: Sequence[str | None], name: str | None) -> Self:
        """Return the contact at other degrees of freedom."""
        return type(self)(
            *dofs,  # type: ignore[arg-type]
            stiffness=self.stiffness,
            slip_forces=self.slip_forces,
            name=name,
        )

    def scaled(self, slip_force: float) -> Self:
        """Return a contact with its slip forces multiplied; those that never slip stay so."""
        limits = [force if np.isinf(force) else force * slip_force for force in self.slip_forces]
        return replace(self, slip_forces=tuple(limits))

    def to_spec(self) -> dict[str, object]:
        """Return the contact in plain values that any text format can hold; see `Contact`."""
        limits = [force if np.isfinite(force) else str(force) for force in self.slip_forces]
        parameters = {"stiffness": [*self.stiffness], "slip_forces": limits}
        return super().to_spec() | {"parameters": parameters}

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
        entry = f"{cls.law} contact"
        if not 1 <= len(dofs) <= 2:
            raise ModelError(f"{entry}: {len(dofs)} dofs; give one (to ground) or two")
        known = ("stiffness", "slip_forces")
        for key in parameters:
            if key not in known:
                raise ModelError(f"{entry}: {unknown('parameter', key, known)}")
        given = {}
        for key in known:
            values = parameters.get(key)
            if not isinstance(values, list | tuple):
                raise ModelError(f"{entry}: {key} {brief(values)} is no list; give one per element")
            given[key] = tuple(np.inf if value == "inf" else value for value in values)
        return cls(*dofs, **given, name=name)  # type: ignore[arg-type]


def _numbers(values: Iterable[object], entry: str, *, finite: bool) -> tuple[float, ...]:
    """Return numbers that are not negative, at least one."""
    given = members(values, entry, f"{entry.rsplit(' ', 1)[1]}=[...]")
    numbers = tuple(
        real_number(value, f"{entry}[{place}]", finite=finite) for place, value in enumerate(given)
    )
    if not numbers:
        raise ModelError(f"{entry}: empty; give at least one element")
    for place, value in enumerate(numbers):
        if value < 0.0:
            raise ModelError(f"{entry}[{place}] {value:g} is negative; give numbers from zero")
    return numbers

"""Springs in series with Coulomb sliders, one or several on one displacement between two ends."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import InitVar, dataclass, field
from typing import Any, ClassVar, Self, cast

import numpy as np

from stickslip.checks import Matrix, brief, set_fields
from stickslip.errors import ModelError
from stickslip.model.contact import Sliders, real_numbers
from stickslip.model.ends import TwoEnds
from stickslip.units import from_zero

_FACTORS = ("friction", "normal_load")
"""What the slip force of a Jenkins element is the product of."""


@dataclass(frozen=True)
class _Elements(TwoEnds):
    """Elements of a spring and a slider each, on one displacement."""

    @property
    @abstractmethod
    def _elements(self) -> Iterable[tuple[float, float]]:
        """Stiffness [N/m] and slip force [N] of each element."""

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while it sticks [N/m], shape (1, 1)."""
        return np.array([[sum(stiffness for stiffness, _ in self._elements)]])

    def linear_limit(self, *, stuck: bool) -> Jenkins | None:
        """Return the elements that stick in a linear limit as one; see `Contact.linear_limit`."""
        left = [k for k, limit in self._elements if (limit > 0.0 if stuck else np.isinf(limit))]
        if not left:
            return None
        return Jenkins(self.dof, self.other, stiffness=sum(left), slip_force=np.inf, name=self.name)


@dataclass(frozen=True)
class Jenkins(_Elements):
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
    friction, normal_load : float, optional
        Instead: coefficient of friction and normal load [N], whose product the slip force is. A
        sweep can then vary either.
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
    keys: ClassVar[tuple[str, ...]] = ("stiffness", "slip_force")

    stiffness: float = field(kw_only=True)
    slip_force: float = field(kw_only=True, default=cast("float", None))
    friction: InitVar[float | None] = field(kw_only=True, default=None)
    normal_load: InitVar[float | None] = field(kw_only=True, default=None)
    factors_of_slip: tuple[float, float] | None = field(
        init=False, repr=False, compare=False, default=None
    )
    """Coefficient of friction and normal load [N], of a slip force that was given as both."""

    def __post_init__(self, friction: float | None, normal_load: float | None) -> None:
        super().__post_init__()
        entry = f"jenkins contact at {brief(self.dof)}"
        if friction is not None or normal_load is not None or self.slip_force is None:
            made = self._factors(entry, friction, normal_load)
            set_fields(self, factors_of_slip=made, slip_force=made[0] * made[1])
        stiffness = from_zero(
            self.stiffness, "N/m", f"{entry}: stiffness", "N/m above zero", finite=False
        )
        if np.isinf(stiffness):
            raise ModelError(
                f"{entry}: stiffness inf; take about 1000 times the local structure stiffness as "
                "the rigid limit"
            )
        slip_force = from_zero(
            self.slip_force, "N", f"{entry}: slip_force", "N, 0 for no friction", finite=False
        )
        set_fields(self, stiffness=stiffness, slip_force=slip_force)

    def _factors(
        self, entry: str, friction: float | None, normal_load: float | None
    ) -> tuple[float, float]:
        """Return friction and normal load, which make the slip force."""
        both = friction is not None and normal_load is not None
        if self.slip_force is not None or not both:
            given = "is missing" if self.slip_force is None else "is given beside them"
            raise ModelError(
                f"{entry}: slip_force {given}; give slip_force=..., or friction=... and "
                "normal_load=...",
                study=f"slip_force {given}; give 'slip_force', or 'friction' and 'normal_load'",
            )
        return (
            from_zero(friction, "", f"{entry}: friction", "it from zero"),
            from_zero(normal_load, "N", f"{entry}: normal_load", "it from zero"),
        )

    @property
    def _elements(self) -> Iterable[tuple[float, float]]:
        return [(self.stiffness, self.slip_force)]

    def variable(self) -> dict[str, tuple[float, ...]]:
        """Return stiffness, slip force, and friction and normal load if these were given."""
        made = self.factors_of_slip or ()
        return self.adjustable() | {
            name: (value,) for name, value in zip(_FACTORS, made, strict=False)
        }

    def _values(self) -> dict[str, Any]:
        made = self.factors_of_slip
        if made is None:
            return super()._values()
        return {"stiffness": self.stiffness} | dict(zip(_FACTORS, made, strict=True))

    def _with(self, key: str, value: object) -> Self:
        own = super()._values() if key == "slip_force" else self._values()
        return self.from_parameters(self.dofs, own | {key: value}, self.name)

    @classmethod
    def _keys_of(cls, parameters: Mapping[str, object]) -> tuple[str, ...]:
        made = any(name in parameters for name in _FACTORS)
        return ("stiffness", *_FACTORS) if made else cls.keys


@dataclass(frozen=True)
class ParallelJenkins(_Elements, Sliders):
    """Jenkins elements in parallel: a contact that begins to slip little by little.

    All elements share one displacement, so that the contact has one unknown per harmonic, however
    many elements it has. Its force is their sum.

    Parameters
    ----------
    dof, other : str
        Its ends, as of `Jenkins`.
    stiffness : sequence of float
        Stiffness of each element while it sticks [N/m].
    slip_forces : sequence of float
        Force at which each element slips [N]. Zero is no friction, infinity never slips.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        As of `Jenkins`, or if there are not as many stiffnesses as slip forces.

    References
    ----------
    Iwan (1966): the parallel-series model.
    """

    law: ClassVar[str] = "parallel-jenkins"

    stiffness: tuple[float, ...] = field(kw_only=True)
    slip_forces: tuple[float, ...] = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        entry = f"{self.law} contact at {brief(self.dof)}"
        stiffness = real_numbers(self.stiffness, "N/m", entry, "stiffness", finite=True)
        limits = real_numbers(self.slip_forces, "N", entry, "slip_forces", finite=False)
        if not stiffness:
            raise ModelError(f"{entry}: stiffness: empty; give at least one element")
        if len(stiffness) != len(limits):
            raise ModelError(
                f"{entry}: {len(limits)} slip_forces for {len(stiffness)} stiffnesses; give one "
                "of each per element"
            )
        set_fields(self, stiffness=stiffness, slip_forces=limits)

    @property
    def _elements(self) -> Iterable[tuple[float, float]]:
        return zip(self.stiffness, self.slip_forces, strict=True)

    @property
    def limits(self) -> tuple[float, ...]:
        """Force at which all elements slip [N]."""
        return (sum(self.slider_limits),)

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Slip force of each element [N]; elements without stiffness carry none."""
        return tuple(limit if stiffness else 0.0 for stiffness, limit in self._elements)

    @property
    def slider_shares(self) -> tuple[float, ...]:
        """Share of the stiffness that each element has."""
        total = sum(self.stiffness) or 1.0
        return tuple(stiffness / total for stiffness in self.stiffness)

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return `stiffness` [N/m] and `slip_force` [N] of the elements."""
        return [{"stiffness": [*self.stiffness], "slip_force": [*self.slip_forces]}]

    def summary(self) -> str:
        """Return the parameters in words, in SI units."""
        return f"{len(self.stiffness)} elements, stiffness {sum(self.stiffness):g} in all"

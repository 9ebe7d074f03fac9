"""Contacts that slip little by little: Masing laws by their backbone, and the Bouc-Wen law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import Matrix, brief, members, set_fields
from stickslip.errors import ModelError
from stickslip.model.ends import TwoEnds
from stickslip.model.jenkins import Jenkins
from stickslip.units import from_zero, physical_number

Table: TypeAlias = tuple[tuple[float, ...], tuple[float, ...]]
"""Displacements [m] and forces [N] of a backbone."""

_CONCAVE = 1e-9
"""Rise of a table's slope, relative to it, that is rounding."""
_REVERSALS = 12
"""Reversals that a state tells."""
_SHAPES = ("exponential", "shear-layer")
_SHARPEST = 1e3
"""Largest exponent of a knee, within a thousandth of which a Jenkins element is."""


@dataclass(frozen=True)
class _Microslip(TwoEnds):
    """A contact on one displacement with a stiffness at rest and a force that it never exceeds."""

    one_spring: ClassVar[bool] = False

    stiffness: float = field(kw_only=True)
    slip_force: float = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        entry, remedy = f"{self._entry}: slip_force", "N, 0 for no friction"
        set_fields(
            self,
            stiffness=from_zero(
                self.stiffness, "N/m", f"{self._entry}: stiffness", "N/m above zero"
            ),
            slip_force=from_zero(self.slip_force, "N", entry, remedy, finite=False),
        )

    @property
    def _entry(self) -> str:
        return f"{self.law} contact at {brief(self.dof)}"

    def _keep_numbers(self, *keys: str) -> None:
        """Keep numbers without a unit."""
        for key in keys:
            number = physical_number(getattr(self, key), "", f"{self._entry}: {key}")
            set_fields(self, **{key: number})

    def _refusal(self, key: str, text: str) -> ModelError:
        return ModelError(f"{self._entry}: {key} {getattr(self, key):g} {text}")

    @property
    def remembered(self) -> tuple[float, ...]:
        """Bound of each number that a state has of it, none: its origin and reversals [m].

        The origin is the displacement without force before the first loading. Behind it stand the
        ways from it to the first reversal that is remembered, and from each to the next; zeros
        are unused places.
        """
        return (np.inf,) * (1 + _REVERSALS)

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness at rest [N/m], shape (1, 1)."""
        return np.array([[self.stiffness]])

    def linear_limit(self, *, stuck: bool) -> Jenkins | None:
        """Return the spring that it is at rest; see `Contact.linear_limit`."""
        if self.slip_force < np.inf and not (stuck and self.slip_force > 0.0):
            return None
        return Jenkins(
            self.dof, self.other, stiffness=self.stiffness, slip_force=np.inf, name=self.name
        )


@dataclass(frozen=True)
class Iwan(_Microslip):
    """Segalman's four-parameter Iwan model: a joint with microslip up to gross slip.

    It stands for elastic, perfectly plastic elements in parallel without number. Their slip limits
    have a power-law distribution with the exponent chi; beta weighs those that slip together at
    last. The dissipation per cycle grows with the amplitude to the power chi + 3 until all of the
    contact slips at phi_max = F_S (1 + beta) / (K_T (beta + (chi + 1) / (chi + 2))).

    Parameters
    ----------
    dof : str
        Degree of freedom it is attached to.
    other : str, optional
        Degree of freedom at its other end; the displacement is x_dof - x_other. Default: the
        ground.
    stiffness : float
        Stiffness K_T at rest [N/m].
    slip_force : float
        Force F_S of gross slip [N]. Zero is no friction, infinity never slips.
    chi : float
        Exponent of the distribution, above -1 and at most 0. Measured joints have -0.9 to -0.2.
    beta : float
        Weight of the elements that slip last, from 0: the stiffness falls by K_T / (1 + beta) up to
        gross slip, and by the rest of it there at once. Default: 0.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If a parameter is outside its range or no number, or both ends are the same degree of
        freedom.

    Notes
    -----
    A contact that never ceases to slip a little has no share of the period in slip: `slip_fraction`
    is the mean over its elements, weighted by their stiffness, as of `ParallelJenkins`.

    References
    ----------
    Segalman (2005), "A four-parameter Iwan model for lap-type joints".
    """

    law: ClassVar[str] = "iwan"
    keys: ClassVar[tuple[str, ...]] = ("stiffness", "slip_force", "chi", "beta")

    chi: float = field(kw_only=True)
    beta: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._keep_numbers("chi", "beta")
        if not -1.0 < self.chi <= 0.0:
            raise self._refusal(
                "chi",
                "is outside -1 < chi <= 0; the dissipation per cycle grows with the amplitude to "
                "the power chi + 3",
            )
        if self.beta < 0.0:
            raise self._refusal("beta", "is negative; give 0 for a smooth onset of gross slip")

    @property
    def gross_slip_displacement(self) -> float:
        """Displacement phi_max at which all of the contact slips [m]."""
        if not self.stiffness:
            return np.inf
        share = self.beta + (self.chi + 1.0) / (self.chi + 2.0)
        return self.slip_force * (1.0 + self.beta) / (self.stiffness * share)


@dataclass(frozen=True)
class Masing(_Microslip):
    """A contact by its backbone, the force F(u) of its first loading.

    The force follows the backbone, after each reversal the same curve at twice its size, and
    returns to where it left an earlier branch. Any concave backbone is that of elastic, perfectly
    plastic elements in parallel; the contact has one unknown per harmonic all the same.

    Parameters
    ----------
    dof, other : str
        Its ends, as of `Iwan`.
    stiffness : float
        Stiffness k at rest [N/m].
    slip_force : float
        Force S that is never exceeded [N].
    backbone : str or (array_like, array_like)
        The shape, F = S phi(k u / S):

        * "exponential": F = S (1 - exp(-k u / S));
        * "shear-layer": a bar on a layer of distributed friction, pulled at one end and free at
          the other, with `shear_lag`;
        * displacements [m] and forces [N], joined by straight lines: rising from zero, ever less
          steeply. Beyond the last row the force stays. Stiffness and slip force are then those of
          the first and the last row; if they are given, the table is stretched to have them.
    shear_lag : float, optional
        sqrt(k' / EA) L of the shear layer with a stiffness k' and a limit q per length. The bar has
        the stiffness EA sqrt(k' / EA) tanh(shear_lag) and slips as a whole at q L.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If a parameter is outside its range or no number, a row of the table is not concave, or both
        ends are the same degree of freedom.

    Notes
    -----
    `slip_fraction` has the meaning that it has for `Iwan`.

    References
    ----------
    Masing (1926). Menq, Bielak and Griffin (1986) for the shear layer.
    """

    law: ClassVar[str] = "masing"
    keys: ClassVar[tuple[str, ...]] = ("stiffness", "slip_force", "backbone", "shear_lag")

    stiffness: float = field(default=None, kw_only=True)  # type: ignore[assignment]
    slip_force: float = field(default=None, kw_only=True)  # type: ignore[assignment]
    backbone: str | Table | Sequence[ArrayLike] = field(kw_only=True)
    shear_lag: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if isinstance(self.backbone, str):
            if self.backbone not in _SHAPES:
                raise ModelError(
                    f"{self._entry}: backbone {brief(self.backbone)} is unknown; give "
                    f"{' or '.join(map(repr, _SHAPES))}, or (displacements, forces)"
                )
            for key in ("stiffness", "slip_force"):
                if getattr(self, key) is None:
                    raise ModelError(f"{self._entry}: {key} is missing; give a number")
        else:
            table = _table(self.backbone, f"{self._entry}: backbone")
            stiffness = table[1][0] / table[0][0] if self.stiffness is None else self.stiffness
            slip_force = table[1][-1] if self.slip_force is None else self.slip_force
            set_fields(self, backbone=table, stiffness=stiffness, slip_force=slip_force)
        super().__post_init__()
        if (self.backbone == "shear-layer") != (self.shear_lag is not None):
            raise ModelError(
                f"{self._entry}: shear_lag {brief(self.shear_lag)} with backbone "
                f"{brief(self.backbone)}; a shear layer needs it, sqrt(k / EA) L, and nothing else "
                "takes it"
            )
        if self.shear_lag is not None:
            self._keep_numbers("shear_lag")
            if not self.shear_lag > 0.0:
                raise self._refusal(
                    "shear_lag", "is not positive; a rigid bar is a Jenkins element"
                )

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return stiffness, slip force, and the numbers of the shape."""
        own: dict[str, Any] = dict(self.parameters())
        if not isinstance(self.backbone, str):
            displacement, force = self.backbone
            own |= {"displacement": [*displacement], "force": [*force]}  # type: ignore[misc]
        return [own]

    def summary(self) -> str:
        """Return the parameters in words, in SI units."""
        shape = self.backbone if isinstance(self.backbone, str) else "tabulated"
        return f"{shape}, {super().summary()}"


_COLUMNS = (("displacement", "m"), ("force", "N"))


def _table(given: Sequence[ArrayLike], entry: str) -> Table:
    """Return the rows of a backbone without the one at zero; refuse what is not concave."""
    columns = members(given, entry, "backbone=(displacements, forces)")
    if len(columns) != 2:
        raise ModelError(f"{entry}: {len(columns)} columns; give displacements and forces")
    rows = [
        [
            physical_number(value, unit, f"{entry}: {name}[{place}]")
            for place, value in enumerate(members(column, f"{entry}: {name}", "a list"))  # type: ignore[arg-type]
        ]
        for (name, unit), column in zip(_COLUMNS, columns, strict=True)
    ]
    if len(rows[0]) != len(rows[1]):
        raise ModelError(f"{entry}: {len(rows[0])} displacements and {len(rows[1])} forces")
    first = 1 if rows[0][:1] == rows[1][:1] == [0.0] else 0
    before, steepest = (0.0, 0.0), np.inf
    for place, (u, f) in enumerate(zip(*rows, strict=True)):
        if place < first:
            continue
        here = f"{entry}: row {place}, {u:g} m and {f:g} N"
        if u <= before[0]:
            raise ModelError(f"{here}: the displacement is not above {before[0]:g} m; let it rise")
        if f < before[1] or f <= 0.0:
            raise ModelError(
                f"{here}: the force falls, from {before[1]:g} N; let it rise from zero"
            )
        slope = (f - before[1]) / (u - before[0])
        if slope > steepest * (1.0 + _CONCAVE):
            raise ModelError(
                f"{here}: the slope of {slope:g} N/m is above {steepest:g} N/m before; a backbone "
                "is concave, smooth the measured points first"
            )
        before, steepest = (u, f), min(slope, steepest)
    if len(rows[0]) == first:
        raise ModelError(f"{entry}: no row beyond zero; give at least one")
    return tuple(rows[0][first:]), tuple(rows[1][first:])


@dataclass(frozen=True)
class BoucWen(_Microslip):
    """The Bouc-Wen law: hysteresis by one differential equation.

    The force follows f' = k u' (1 - abs(f / S)^n (gamma + beta sgn(f u'))) with gamma = 1 - beta.

    Parameters
    ----------
    dof, other : str
        Its ends, as of `Iwan`.
    stiffness : float
        Stiffness k at rest [N/m].
    slip_force : float
        Force S that it comes near [N].
    exponent : float
        n, at least 1: the sharpness of the knee. Default: 1.
    beta : float
        Share of the term that changes with the direction, 0.5 to 1. At 0.5 it unloads with the
        stiffness k; above, more steeply. Default: 0.5.
    name : str, optional
        By which results and settings refer to it.

    Raises
    ------
    ModelError
        If a parameter is outside its range or no number, or both ends are the same degree of
        freedom.

    Notes
    -----
    It is not a Masing law. It forgets where it reversed: a small loop inside a large one does not
    close but drifts towards zero force, cycle by cycle. Prefer `Masing` or `Iwan` where several
    harmonics make nested loops, or a mean force is held. Its harmonics are those of samples, and
    exact orbits and the single-harmonic method refuse it.

    References
    ----------
    Bouc (1967); Wen (1976). Charalampakis and Koumousis (2009) on the drift.
    """

    law: ClassVar[str] = "bouc-wen"
    keys: ClassVar[tuple[str, ...]] = ("stiffness", "slip_force", "exponent", "beta")

    exponent: float = field(default=1.0, kw_only=True)
    beta: float = field(default=0.5, kw_only=True)

    @property
    def remembered(self) -> tuple[float, ...]:
        """Bound of each number that a state has of it: its force [N]."""
        return self.slider_limits

    def __post_init__(self) -> None:
        super().__post_init__()
        self._keep_numbers("exponent", "beta")
        if self.exponent < 1.0:
            raise self._refusal("exponent", "is below 1; give 1 for the softest knee")
        if self.exponent > _SHARPEST:
            raise self._refusal("exponent", "is above 1000; such a knee is that of ss.Jenkins")
        if not 0.5 <= self.beta <= 1.0:
            raise self._refusal(
                "beta", "is outside 0.5 to 1; below, small loops would give work back"
            )

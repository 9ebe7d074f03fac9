"""The elastic Coulomb contact: friction under a normal load that may vary and vanish."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import Matrix, brief, members, require_keys, set_fields, whole_number
from stickslip.errors import ModelError
from stickslip.model.contact import OPEN, Bonded, Contact
from stickslip.model.dofs import Dofs
from stickslip.model.node_values import (
    Each,
    Vectors,
    frame_of,
    number_of_each,
    times_areas,
    unit_normals,
)
from stickslip.model.nodes import Displacement, Nodes

_ENTRY = "coulomb contact"
_OPTIONAL = ("normal_stiffness", "preload", "gap")
_UNITS = {
    "friction": "",
    "tangential_stiffness": "N/m",
    "normal_stiffness": "N/m",
    "preload": "N",
    "gap": "m",
}
_PER_AREA = {"tangential_stiffness": "N/m^3", "normal_stiffness": "N/m^3", "preload": "Pa"}
_ON_CONE = 1e-9
"""Distance from the cone, relative to it, that is none."""
_SPACE = 3
"""Dimensions of space."""


@dataclass(frozen=True, init=False)
class Coulomb(Contact):
    """Dry friction at a node, or at many, whose normal load may vary and vanish.

    A node A touches the ground or a node B of another body. The unit vector n points out of A into
    B; v = n . (x_A - x_B) closes the contact, u are the displacements x_A - x_B across n:

    * normal force N = max(N0 + k_n v, 0) under a preload N0, which is in equilibrium without
      motion; N = max(k_n (v - g), 0) behind a gap g, of which the structure feels all;
    * traction t = k_t (u - w) with abs(t) <= mu N, where the slider w moves along t as long as
      abs(t) = mu N. An open contact has t = 0, and its slider follows.

    Forces and displacements are given in the frame of the contact: t1, t2, N, or t, N of a planar
    one, or without the normal under a constant load. It is right-handed, t1 x t2 = n. In space t1
    is the direction of the first degree of freedom laid into the plane; where that direction is the
    normal to within 26 degrees, abs(n_1) > 0.9, the second one. In a plane t = (n_2, -n_1), so that
    n = (0, 1) has t = (1, 0). See `frame`.

    Parameters
    ----------
    dofs : sequence of str, or of sequences of str
        Degrees of freedom of the node: 3 in space, 2 in a plane, those of the tangential directions
        alone (2 or 1) where `normal` is None. One such list per node makes many nodes one contact.
        Instead of a name a mapping of names to factors is a sum of degrees of freedom, as lever
        arms and turned axes make it: ``{"x": 1.0, "rotation": -0.02}``.
    other : sequence of str, or of sequences of str, optional
        As many of the other body, names or sums. Default: the ground.
    normal : sequence of float or None
        Normal n, of any length above 0, out of the first body into the other; of many nodes also
        one per node. None: the normal load is constant, the preload.
    friction : float or sequence of float
        Coefficient of friction mu. Of many nodes all numbers may be one per node.
    tangential_stiffness : float or sequence of float
        Stiffness k_t while it sticks [N/m], the same in both directions.
    normal_stiffness : float or sequence of float, optional
        Stiffness k_n while it is closed [N/m]; needed with a normal.
    preload : float or sequence of float, optional
        Normal force N0 without motion [N]; needed without a normal.
    gap : float or sequence of float, optional
        Instead: distance g between the bodies [m], negative for an interference. Default: 0.
    areas : sequence of float, optional
        Areas of the nodes [m2]. Stiffnesses are then those of an area [N/m3], and the preload is a
        pressure [Pa].
    name : str, optional
        By which results and settings refer to it. Default: "coulomb".

    Raises
    ------
    ModelError
        If the degrees of freedom, the normal and the numbers do not fit each other, the normal is
        zero, a number is negative that must not be, or both a preload and a gap are given.

    References
    ----------
    Yang, Chu and Menq (1998): the cases of stick, slip and separation. Petrov and Ewins (2003).
    """

    law: ClassVar[str] = "coulomb"
    keys: ClassVar[tuple[str, ...]] = (
        "friction",
        "tangential_stiffness",
        "normal_stiffness",
        "preload",
        "gap",
        "normal",
    )
    by_point: ClassVar[bool] = True
    core_phases: ClassVar[bool] = False

    friction: Each
    tangential_stiffness: Each
    normal_stiffness: Each | None
    preload: Each | None
    gap: Each | None
    normal: Vectors | None
    nodes: Nodes
    """Where it acts."""

    def __init__(
        self,
        dofs: Sequence[Displacement] | Sequence[Sequence[Displacement]],
        other: Sequence[Displacement] | Sequence[Sequence[Displacement]] | None = None,
        *,
        normal: ArrayLike | None,
        friction: float | Sequence[float],
        tangential_stiffness: float | Sequence[float],
        normal_stiffness: float | Sequence[float] | None = None,
        preload: float | Sequence[float] | None = None,
        gap: float | Sequence[float] | None = None,
        areas: Sequence[float] | None = None,
        name: str | None = None,
    ) -> None:
        object.__setattr__(self, "name", name)
        Contact.__post_init__(self)
        nodes = Nodes.of(dofs, other, _ENTRY)
        if nodes.size > _SPACE:
            raise ModelError(
                f"{_ENTRY}: dofs: {nodes.size} names per node; give 3 in space, 2 in a plane, or "
                "the tangential ones without a normal"
            )
        shape = nodes.shape
        vectors = unit_normals(normal, shape, _ENTRY)
        preload, gap = _closure(preload, gap, constant=normal is None)
        if (normal_stiffness is None) != (normal is None):
            one = f"normal: {brief(normal)} without normal_stiffness"
            if normal is None:
                one = f"normal_stiffness: {brief(normal_stiffness)} without normal"
            raise ModelError(
                f"{_ENTRY}: {one}; give both, or neither where the normal load is constant"
            )
        given = {
            "friction": friction,
            "tangential_stiffness": tangential_stiffness,
            "normal_stiffness": normal_stiffness,
            "preload": preload,
            "gap": gap,
        }
        units = _UNITS if areas is None else _UNITS | _PER_AREA
        each = {
            key: None
            if one is None and key in _OPTIONAL
            else number_of_each(one, units[key], shape, f"{_ENTRY}: {key}", negative=key == "gap")
            for key, one in given.items()
        }
        if areas is not None:
            each |= times_areas({key: each[key] for key in _PER_AREA}, areas, shape, _ENTRY)
        set_fields(self, **each, normal=vectors, nodes=nodes)

    def __repr__(self) -> str:
        first, *_ = self.nodes.names
        ends = f"{first if self.single else first[0]}" + (" ..." if self.points > 1 else "")
        return f"Coulomb({ends}, {self.summary()}, name={self.name!r})"

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom, those of the first body before those of the other."""
        return self.nodes.first + self.nodes.other

    @property
    def points(self) -> int:
        """Number of nodes."""
        return self.nodes.count

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the displacements and forces of a node, in its frame."""
        tangential = ("t1", "t2") if self.tangential == 2 else ("t",)
        return tangential if self.normal is None else (*tangential, "N")

    @property
    def tangential(self) -> int:
        """Number of tangential directions."""
        return self.nodes.size - (self.normal is not None)

    @property
    def single(self) -> bool:
        """Whether it was given as one node, without a list of nodes around it."""
        return self.nodes.single

    @property
    def frame(self) -> Matrix:
        """Directions of the components in those of the degrees of freedom.

        Shape (d, d), or (points, d, d) of many nodes: rows t1, t2, n, or t, n.
        """
        frames = np.array([frame_of(one) for one in self._normals])
        return frames[0] if self.single else frames

    def on_first(self, force: Matrix) -> Matrix:
        """Return the force that nodes exert on the first body together, in the axes of its dofs.

        `force` are those of the nodes in their frames, (..., points, d); they act against u and v.
        """
        frames = self.frame.reshape(self.points, *self.frame.shape[-2:])
        total: Matrix = -np.einsum("...nc,ncd->...d", force, frames)
        return total

    @property
    def _normals(self) -> Iterator[Matrix | int]:
        """The normal of each node, or the number of directions where there is none."""
        if self.normal is None:
            return iter([self.nodes.size] * self.points)
        return iter(np.broadcast_to(np.array(self.normal), (self.points, self.nodes.size)))

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x, in the frame of each node, shape (points * d, N)."""
        frames = np.array([frame_of(one) for one in self._normals])
        return np.ascontiguousarray((frames @ self.nodes.rows(dofs)).reshape(-1, len(dofs)))

    @property
    def limits(self) -> tuple[float, ...]:
        """Friction force of each node at which it slips under its load without motion [N]."""
        friction = self._per_node("friction")
        return tuple((friction * np.maximum(self._pressing, 0.0)).tolist())

    @property
    def slider_limits(self) -> tuple[float, ...]:
        """Largest traction in each direction of each node [N]; inf where the load varies."""
        limits = self.limits if self.normal is None else (np.inf,) * self.points
        return tuple(limit for limit in limits for _ in range(self.tangential))

    @property
    def _pressing(self) -> Matrix:
        """Normal force of each node without motion, negative behind an open gap [N]."""
        if self.gap is None:
            return self._per_node("preload")
        # A negative zero would be written as such.
        return 0.0 - self._per_node("normal_stiffness") * self._per_node("gap")

    @property
    def balanced(self) -> Matrix:
        """Force of each displacement in equilibrium without motion; see `Contact.balanced`."""
        forces = np.zeros((self.points, len(self.components)))
        if self.normal is not None and self.preload is not None:
            forces[:, -1] = self.preload
        return forces.ravel()

    def _per_node(self, key: str) -> Matrix:
        return np.broadcast_to(np.asarray(getattr(self, key), dtype=np.float64), self.points)

    def node_friction(self, node: int) -> tuple[float, float]:
        """Return the coefficient of friction of a node, and its constant normal load [N] or 0."""
        load = float(self._per_node("preload")[node]) if self.normal is None else 0.0
        return float(self._per_node("friction")[node]), load

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while every node sticks and is closed [N/m], shape (n_u, n_u)."""
        stiffness = np.zeros((self.points, len(self.components)))
        stiffness[:, : self.tangential] = self._per_node("tangential_stiffness")[:, None]
        if self.normal is not None:
            stiffness[:, -1] = self._per_node("normal_stiffness")
        return np.diag(stiffness.ravel())

    def linear_limit(self, *, stuck: bool) -> Bonded | None:
        """Return what sticks in a linear limit; see `Contact.linear_limit`.

        At small amplitude every node that has friction and is not behind an open gap, at large
        amplitude none: its normal force is no linear spring there.
        """
        closed = self._pressing >= 0.0
        sticks = np.repeat(closed[:, None], len(self.components), axis=1)
        sticks[:, : self.tangential] &= (self._per_node("friction") > 0.0)[:, None]
        held = np.diag(sticks.ravel().astype(np.float64)) * self.stuck_stiffness
        return Bonded(self, held, name=self.name) if stuck and held.any() else None

    def states(self, force: Matrix) -> NDArray[np.int8]:
        """Return what nodes do by their forces, (..., components); see `ContactStates`."""
        traction = np.linalg.norm(force[..., : self.tangential], axis=-1)
        slips = (traction >= self.friction_limit(force) * (1.0 - _ON_CONE)) & (traction > 0.0)
        sense = np.sign(force[..., 0]) if self.tangential == 1 else 1.0
        opens = force[..., -1] == 0.0 if self.normal is not None else np.zeros(slips.shape, bool)
        return np.where(opens, OPEN, slips * sense).astype(np.int8)

    def friction_limit(self, force: Matrix) -> Matrix:
        """Return mu N of nodes by their forces; see `Contact.friction_limit`."""
        normal = force[..., -1] if self.normal is not None else self._pressing
        return np.broadcast_to(self._per_node("friction") * normal, force.shape[:-1])

    @property
    def _given(self) -> dict[str, Any]:
        return {key: one for key in self.keys if (one := getattr(self, key)) is not None}

    def _values(self) -> dict[str, Any]:
        nodes = self.nodes
        sums = {"terms": nodes.terms, "factors": tuple(chain.from_iterable(nodes.factors))}
        return self._given | {"shape": nodes.shape} | (sums if nodes.factors else {})

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return friction, stiffnesses, and preload or gap, by name, in SI units."""
        given = {key: one for key, one in self._given.items() if key != "normal"}
        return {key: one if isinstance(one, tuple) else (one,) for key, one in given.items()}

    def adjusted(self, parameter: str, values: Sequence[float]) -> Self:
        """Return the contact with other values of a parameter, one, or one per node."""
        one = len(self.adjustable()[parameter]) == 1
        return self._with(parameter, values[0] if one else tuple(values))

    def scaled(self, slip_force: float) -> Self:
        """Return the contact at another level of preload, by which its slip force is multiplied."""
        if slip_force == 1.0:
            return self
        if self.preload is None:
            raise ModelError(
                f"contact {self.name!r}: a gap has no slip force to multiply; give it another gap, "
                "or scale the forces"
            )
        return self.adjusted("preload", [slip_force * one for one in self.adjustable()["preload"]])

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return the parameters of the law of each node, in SI units."""
        keys = [key for key in self._given if key != "normal"]
        columns = [self._per_node(key).tolist() for key in keys]
        return [
            dict(zip(keys, node, strict=True)) | {"directions": float(self.tangential)}
            for node in zip(*columns, strict=True)
        ]

    def summary(self) -> str:
        """Return the parameters in words, in SI units."""
        many = "" if self.single else f"{self.points} nodes, "
        values = self.adjustable().items()
        return many + ", ".join(f"{key} {_range(one)}" for key, one in values)

    @classmethod
    def from_parameters(
        cls, dofs: tuple[str | None, ...], parameters: Mapping[str, object], name: str | None
    ) -> Self:
        """Build the contact from what `dofs`, the parameters of `to_spec` and `name` hold."""
        known = (*cls.keys, "shape", "terms", "factors")
        require_keys(parameters, _ENTRY, known, ("shape",), "parameter")
        given: dict[str, Any] = dict(parameters)
        sizes: Iterable[object] = given.pop("shape")
        listed = members(sizes, f"{_ENTRY}: shape", "shape=[...]")
        shape = tuple(whole_number(one, f"{_ENTRY}: shape", smallest=1) for one in listed)
        sums = None
        if "terms" in given or "factors" in given:
            sums = given.pop("terms", ()), given.pop("factors", ())
        nodes = Nodes.of_list(dofs, shape, _ENTRY, sums)
        values: dict[str, Any] = {"normal": None} | given
        return cls(*nodes.names, **values, name=name)


def _closure(preload: Any, gap: Any, *, constant: bool) -> tuple[Any, Any]:
    """Return preload and gap, of which one is None."""
    if preload is not None and gap is not None:
        raise ModelError(
            f"{_ENTRY}: preload {brief(preload)} and gap {brief(gap)}; give one of the two, the "
            "other follows from it"
        )
    if constant and preload is None:
        raise ModelError(
            f"{_ENTRY}: preload is missing; give the constant normal load in N, or a normal"
        )
    return preload, 0.0 if preload is None and gap is None else gap


def _range(values: Iterable[float]) -> str:
    low, high = min(values), max(values)
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"

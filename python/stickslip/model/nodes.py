"""Where contacts of several displacements act: nodes, and their degrees of freedom."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Self

import numpy as np

from stickslip.checks import Matrix, brief, members, text
from stickslip.errors import ModelError
from stickslip.model.dofs import Dofs


@dataclass(frozen=True)
class Nodes:
    """One node, or many, between two bodies or a body and the ground."""

    first: tuple[str, ...]
    """Degrees of freedom of the first body, node by node."""
    other: tuple[str, ...]
    """Those of the other one; none of them at the ground."""
    shape: tuple[int, ...]
    """(d,) of one node, (n, d) of a list of nodes."""

    @classmethod
    def of(cls, dofs: object, other: object, entry: str) -> Self:
        """Return the nodes of names; `entry` says in messages whose they are."""
        first, shape = _names(dofs, f"{entry}: dofs")
        if other is None:
            second: tuple[str, ...] = ()
        else:
            second, found = _names(other, f"{entry}: other")
            if found != shape:
                raise ModelError(
                    f"{entry}: other: names of shape {times(found)} for dofs of {times(shape)}; "
                    "give as many, or leave it out for the ground"
                )
        for node in range(0, len(first), shape[-1]):
            names = first[node : node + shape[-1]] + second[node : node + shape[-1]]
            twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
            if twice is not None:
                raise ModelError(
                    f"{entry}: dof {brief(twice)} twice at one node; name every direction of both "
                    "bodies once"
                )
        return cls(first, second, shape)

    @classmethod
    def of_list(cls, dofs: Sequence[str | None], shape: tuple[int, ...], entry: str) -> Self:
        """Return the nodes of all names in one list, as `Contact.dofs` has them."""
        half = prod(shape)
        if not shape or len(dofs) not in (half, 2 * half):
            raise ModelError(
                f"{entry}: {len(dofs)} dofs for names of shape {times(shape)}; give as many, or "
                "twice as many"
            )
        names = tuple(text(dof, f"{entry}: dofs") for dof in dofs)
        return cls(names[:half], names[half:], shape)

    @property
    def names(self) -> list[list[str] | list[list[str]]]:
        """Names as a contact takes them, of the first body and, if there is one, the other."""
        ends = (end for end in (self.first, self.other) if end)
        return [np.array(end, dtype=object).reshape(self.shape).tolist() for end in ends]

    @property
    def size(self) -> int:
        """Number d of degrees of freedom of a node of one body."""
        return self.shape[-1]

    @property
    def count(self) -> int:
        """Number n of nodes."""
        return len(self.first) // self.size

    @property
    def single(self) -> bool:
        """Whether it is one node, without a list of nodes around it."""
        return len(self.shape) == 1

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of x_first - x_other, shape (n, d, N)."""
        rows = np.zeros((self.count, self.size, len(dofs)))
        for names, sign in ((self.first, 1.0), (self.other, -1.0)):
            for place, name in enumerate(names):
                node, axis = divmod(place, self.size)
                rows[node, axis, dofs.index(name)] = sign
        return rows

    def moved(self, dofs: Sequence[str | None]) -> Self:
        """Return as many nodes at other degrees of freedom."""
        names, half = tuple(map(str, dofs)), len(self.first)
        return replace(self, first=names[:half], other=names[half:])


def times(shape: tuple[int, ...]) -> str:
    """Return a shape in words."""
    return " x ".join(map(str, shape))


def _names(value: object, entry: str) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return names of degrees of freedom, node by node, and the shape of their list."""
    listed = _members(value, entry)
    nested = bool(listed) and not isinstance(listed[0], str)
    nodes = [_members(one, f"{entry}[{n}]") for n, one in enumerate(listed)] if nested else [listed]
    sizes = {len(node) for node in nodes}
    if len(sizes) != 1 or not min(sizes):
        got = ", ".join(map(str, sorted(sizes)))
        raise ModelError(f"{entry}: {got} names per node; give as many for every node")
    names = tuple(text(one, entry) for node in nodes for one in node)
    (size,) = sizes
    return names, (len(nodes), size) if nested else (size,)


def _members(value: object, entry: str) -> tuple[object, ...]:
    remedy = 'a list of names, as ["pad.x", "pad.y", "pad.z"]'
    if value is None or isinstance(value, Mapping | float | int):
        raise ModelError(f"{entry}: {brief(value)} is not a list; write {remedy}")
    return members(value, entry, remedy)  # type: ignore[arg-type]

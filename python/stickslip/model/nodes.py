"""Where contacts of several displacements act: nodes, and their degrees of freedom."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, chain, pairwise
from math import prod
from typing import Self, TypeAlias

import numpy as np

from stickslip.checks import Matrix, brief, members, real_number, text, whole_number
from stickslip.errors import ModelError
from stickslip.model.dofs import Dofs

Displacement: TypeAlias = str | Mapping[str, float]
"""A displacement of a node: a degree of freedom, or the sum of several times a factor each.

Sums are what lever arms and turned axes make: the point at (-0.02, 0.01) of a body that moves and
turns in a plane has ``{"x": 1.0, "rotation": -0.01}`` and ``{"y": 1.0, "rotation": -0.02}``.
"""


@dataclass(frozen=True)
class Nodes:
    """One node, or many, between two bodies or a body and the ground."""

    first: tuple[str, ...]
    """Degrees of freedom of the first body, node by node."""
    other: tuple[str, ...]
    """Those of the other one; none of them at the ground."""
    shape: tuple[int, ...]
    """(d,) of one node, (n, d) of a list of nodes."""
    factors: tuple[tuple[float, ...], ...] = ()
    """Factors of the degrees of freedom whose sum is a displacement, displacement by displacement,
    those of the first body first; none where every displacement is a degree of freedom."""

    @classmethod
    def of(cls, dofs: object, other: object, entry: str) -> Self:
        """Return the nodes of names; `entry` says in messages whose they are."""
        first, shape = _ends(dofs, f"{entry}: dofs")
        second: tuple[_End, ...] = ()
        if other is not None:
            second, found = _ends(other, f"{entry}: other")
            if found != shape:
                raise ModelError(
                    f"{entry}: other: names of shape {times(found)} for dofs of {times(shape)}; "
                    "give as many, or leave it out for the ground"
                )
        for node in range(0, len(first), shape[-1]):
            ends = first[node : node + shape[-1]] + second[node : node + shape[-1]]
            names = [end for end in ends if isinstance(end, str)]
            twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
            if twice is not None:
                raise ModelError(
                    f"{entry}: dof {brief(twice)} twice at one node; name every direction of both "
                    "bodies once"
                )
        sums = any(not isinstance(end, str) for end in first + second)
        factors = tuple(tuple(_terms(end).values()) for end in first + second) if sums else ()
        return cls(_flat(first), _flat(second), shape, factors)

    @classmethod
    def of_list(
        cls,
        dofs: Sequence[str | None],
        shape: tuple[int, ...],
        entry: str,
        sums: tuple[Iterable[object], Iterable[object]] | None = None,
    ) -> Self:
        """Return the nodes of all names in one list, as `Contact.dofs` has them.

        `sums` are, of displacements that are sums, their `terms`, and all their factors.
        """
        half = prod(shape)
        names = tuple(text(dof, f"{entry}: dofs") for dof in dofs)
        if sums is None:
            terms, factors = [1] * len(names), [1.0] * len(names)
        else:
            terms = [whole_number(one, f"{entry}: terms", smallest=1) for one in sums[0]]
            factors = [real_number(one, f"{entry}: factors") for one in sums[1]]
        if not shape or len(terms) not in (half, 2 * half):
            raise ModelError(
                f"{entry}: {len(terms)} dofs for names of shape {times(shape)}; give as many, or "
                "twice as many"
            )
        if not sum(terms) == len(names) == len(factors):
            raise ModelError(
                f"{entry}: {len(factors)} factors and {len(names)} dofs for sums of {sum(terms)} "
                "terms; give as many of each"
            )
        starts = pairwise(accumulate(terms, initial=0))
        each = tuple(tuple(factors[start:stop]) for start, stop in starts)
        ahead = sum(terms[:half])
        return cls(names[:ahead], names[ahead:], shape, () if sums is None else each)

    @property
    def terms(self) -> tuple[int, ...]:
        """Number of degrees of freedom that make each displacement, as in `factors`."""
        return tuple(map(len, self.factors)) or (1,) * (len(self.first) + len(self.other))

    @property
    def names(self) -> list[list[Displacement] | list[list[Displacement]]]:
        """Displacements as a contact takes them, of the first body and, if there is one, the other.

        Degrees of freedom are names, sums mappings of them to factors.
        """
        listed = self.first + self.other
        ends = np.empty(len(self.terms), dtype=object)
        for place, (start, stop) in enumerate(pairwise(accumulate(self.terms, initial=0))):
            factors = self.factors[place] if self.factors else (1.0,)
            plain = factors == (1.0,)
            ends[place] = (
                listed[start] if plain else dict(zip(listed[start:stop], factors, strict=True))
            )
        return ends.reshape(-1, *self.shape).tolist()  # type: ignore[no-any-return]

    @property
    def size(self) -> int:
        """Number d of degrees of freedom of a node of one body."""
        return self.shape[-1]

    @property
    def count(self) -> int:
        """Number n of nodes."""
        return 1 if self.single else self.shape[0]

    @property
    def single(self) -> bool:
        """Whether it is one node, without a list of nodes around it."""
        return len(self.shape) == 1

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of x_first - x_other, shape (n, d, N)."""
        rows = np.zeros((self.count * self.size, len(dofs)))
        names = iter(self.first + self.other)
        for place, terms in enumerate(self.terms):
            other, row = divmod(place, len(rows))
            for factor in self.factors[place] if self.factors else (1.0,) * terms:
                rows[row, dofs.index(next(names))] += -factor if other else factor
        return rows.reshape(self.count, self.size, -1)

    def moved(self, dofs: Sequence[str | None]) -> Self:
        """Return as many nodes at other degrees of freedom."""
        names, half = tuple(map(str, dofs)), len(self.first)
        return replace(self, first=names[:half], other=names[half:])


def times(shape: tuple[int, ...]) -> str:
    """Return a shape in words."""
    return " x ".join(map(str, shape))


_End: TypeAlias = str | dict[str, float]


def _ends(value: object, entry: str) -> tuple[tuple[_End, ...], tuple[int, ...]]:
    """Return displacements, node by node, and the shape of their list."""
    listed = _members(value, entry)
    nested = bool(listed) and not isinstance(listed[0], str | Mapping)
    nodes = [_members(one, f"{entry}[{n}]") for n, one in enumerate(listed)] if nested else [listed]
    sizes = {len(node) for node in nodes}
    if len(sizes) != 1 or not min(sizes):
        got = ", ".join(map(str, sorted(sizes)))
        raise ModelError(f"{entry}: {got} names per node; give as many for every node")
    ends = tuple(_end(one, entry) for node in nodes for one in node)
    (size,) = sizes
    return ends, (len(nodes), size) if nested else (size,)


def _end(value: object, entry: str) -> _End:
    """Return a degree of freedom, or the factors of several."""
    if not isinstance(value, Mapping):
        return text(value, entry)
    if not value:
        raise ModelError(f"{entry}: a sum without dofs; write {{'x': 1.0, 'rotation': -0.02}}")
    return {text(dof, entry): real_number(one, f"{entry}: {dof}") for dof, one in value.items()}


def _terms(end: _End) -> dict[str, float]:
    return {end: 1.0} if isinstance(end, str) else end


def _flat(ends: Iterable[_End]) -> tuple[str, ...]:
    return tuple(chain.from_iterable(map(_terms, ends)))


def _members(value: object, entry: str) -> tuple[object, ...]:
    remedy = 'a list of names, as ["pad.x", "pad.y", "pad.z"]'
    if value is None or isinstance(value, Mapping | float | int):
        raise ModelError(f"{entry}: {brief(value)} is not a list; write {remedy}")
    return members(value, entry, remedy)  # type: ignore[arg-type]

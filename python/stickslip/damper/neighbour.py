"""What a damper touches: displacements of a structure along the axes of the damper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import TypeAlias

from stickslip.checks import members, unknown
from stickslip.damper.body import Sum
from stickslip.errors import ModelError
from stickslip.model import Structure
from stickslip.model.nodes import Displacement

Touched: TypeAlias = Sequence[Displacement] | Sequence[Sequence[Displacement]]
"""Degrees of freedom of a neighbour, one per axis: of all points of a face, or point by point."""


@dataclass(frozen=True)
class Neighbour:
    """Where a structure is touched: displacements along the axes of the damper."""

    entry: str
    nodes: list[list[Sum]]

    @classmethod
    def of(
        cls,
        axes: int,
        side: str,
        dofs: Touched | None,
        structure: Structure | None,
        prefix: str,
        turn: float = 0.0,
    ) -> Neighbour | None:
        """Return the displacements of a side, whose axes are turned against those of the damper.

        They are turned by `turn` from x to y [rad].
        """
        entry = f"{side}_dofs"
        if structure is None:
            if dofs is not None:
                raise ModelError(f"{entry}: given without a structure; leave them out")
            return None
        if dofs is None:
            raise ModelError(f"{entry}: missing; name the dofs that the damper touches there")
        listed = members(dofs, entry, '["x", "y"]')
        nested = bool(listed) and not isinstance(listed[0], str | Mapping)
        nodes = [
            members(one, entry, '["x", "y"]') if nested else listed
            for one in (listed if nested else [listed])
        ]
        made = []
        for node in nodes:
            if len(node) != axes:
                raise ModelError(
                    f"{entry}: {len(node)} displacements for a damper of {axes} axes; give as many"
                )
            sums: list[Sum] = [
                dict(one) if isinstance(one, Mapping) else {str(one): 1.0} for one in node
            ]
            for one in sums:
                for dof in one:
                    if dof not in structure.dofs:
                        raise ModelError(f"{entry}: {unknown('dof', dof, structure.dofs)}")
            made.append(_turned([{prefix + k: v for k, v in one.items()} for one in sums], turn))
        return cls(entry, made)

    def at(self, points: int) -> list[list[Sum]]:
        """Return the displacements at each of so many points."""
        if len(self.nodes) == 1:
            return self.nodes * points
        if len(self.nodes) != points:
            raise ModelError(
                f"{self.entry}: {len(self.nodes)} nodes for a face of {points} points; give one "
                "for all, or one each"
            )
        return self.nodes


def _turned(sums: list[Sum], turn: float) -> list[Sum]:
    """Return displacements along axes against which theirs are turned from x to y."""
    if not turn:
        return sums
    x, y, *rest = sums
    return [
        _added((cos(turn), x), (-sin(turn), y)),
        _added((sin(turn), x), (cos(turn), y)),
        *rest,
    ]


def _added(*parts: tuple[float, Sum]) -> Sum:
    total: Sum = {}
    for factor, one in parts:
        for dof, own in one.items():
            total[dof] = total.get(dof, 0.0) + factor * own
    return total

"""Which normal forces of a contact Coulomb statics allow.

With closed nodes as springs the structure is linear in what the sliders move, and so are tractions
and normal forces. Those that every friction cone allows form a convex set, at whose edge normal
forces are least and greatest: a linear programme, with planes against the cones of nodes in space
that are added where a solution leaves one (Kelley 1960).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stickslip.errors import ModelError
from stickslip.model import Coulomb, Model
from stickslip.results.fields import Float

_FACETS = 8
"""Planes around a cone at the beginning."""
_OUTSIDE = 1e-9
"""Distance from a cone, relative to the largest force, that is none."""
_MOST_CUTS = 100


class _Node(NamedTuple):
    """A closed node with friction."""

    tangential: slice
    normal: int | None
    """Where its tractions and its normal force stand among those of all contacts."""
    friction: float
    load: float
    """Constant normal load, of a node without a normal force of its own [N]."""


def normal_force_range(
    model: Model, force: Float, place: int, *, alone: bool
) -> tuple[float, float]:
    """Return the least and greatest normal force at a place among the contact displacements [N].

    `force` are all contact forces at rest, shape (n_u,), normal forces whole. Contacts of other
    laws stay as they are. Unless the node is taken `alone`, its forces are those where all normal
    forces together are least and greatest.
    """
    if any(len(model.contact_rows(contact)) > 1 for contact in model.contacts):
        raise ModelError(
            "normal_force_range: a travelling wave has no statics of its own here; ask the whole "
            "disk, disk.mistuned(np.zeros(sectors))"
        )
    from scipy.linalg import block_diag

    held = block_diag(*(contact.stuck_stiffness for contact in model.contacts))
    nodes, slides = [], np.zeros(len(force), np.bool_)
    for node in _nodes(model):
        closed = node.normal is None or force[node.normal] > 0.0
        own = np.r_[node.tangential, [] if node.normal is None else node.normal].astype(int)
        if closed:
            nodes.append(node)
            slides[node.tangential] = True
        else:
            held[own, own] = 0.0
    rows = np.vstack([contact.rows(model.structure) for contact in model.contacts])
    stiffness = model.structure.stiffness + rows.T @ held @ rows
    change = held @ rows @ np.linalg.solve(stiffness, rows.T) - np.eye(len(held))
    change = change[:, slides]
    weights = np.zeros(len(force))
    weights[[node.normal for node in nodes if node.normal is not None]] = 0.0 if alone else 1.0
    # Where the sum leaves it open the node decides.
    weights[place] += 1e-6
    low, high = (_extreme(nodes, force, change, sign * weights) for sign in (1.0, -1.0))
    least = 0.0 if low is None else max(float(low[place]), 0.0)
    if high is None:
        return least, np.inf if alone else normal_force_range(model, force, place, alone=True)[1]
    # Of all nodes together this one may be pressed more where their sum is least.
    ends = sorted((least, max(float(high[place]), 0.0)))
    return ends[0], ends[1]


def _nodes(model: Model) -> Iterator[_Node]:
    """Give the nodes of all Coulomb contacts."""
    ends = np.cumsum([0, *(contact.displacements for contact in model.contacts)]).tolist()
    for contact, (first, last) in zip(model.contacts, pairwise(ends), strict=True):
        if not isinstance(contact, Coulomb):
            continue
        size = len(contact.components)
        for node, start in enumerate(range(first, last, size)):
            behind = start + contact.tangential
            normal = None if contact.normal is None else behind
            friction, load = contact.node_friction(node)
            yield _Node(slice(start, behind), normal, friction, load)


def _extreme(nodes: list[_Node], force: Float, change: Float, weights: Float) -> Float | None:
    """Return the forces of which a weighted sum is least; None if it has no bound."""
    from scipy.optimize import linprog

    scale = float(np.abs(force).max())
    cuts = [cut for node in nodes for cut in _first_cuts(node)]
    # A closed node does not pull. Cones say so too, but not those without friction.
    normals = [node.normal for node in nodes if node.normal is not None]
    for _ in range(_MOST_CUTS):
        # Forces are force + scale * change @ x; x = 0 is the state at rest, which is allowed.
        matrix = np.array([*(_along(change, *cut) for cut in cuts), *-change[normals]])
        room = [node.friction * node.load - _along(force, node, d) for node, d in cuts]
        found = linprog(
            weights @ change,
            A_ub=matrix,
            b_ub=np.r_[room, force[normals]] / scale,
            bounds=(None, None),
            method="highs-ds",
            options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
        )
        if found.x is None:
            return None
        forces = force + scale * change @ found.x
        more = [(node, forces[node.tangential]) for node in nodes if _outside(node, forces) > scale]
        if not more:
            return np.asarray(forces)
        cuts += [(node, traction / np.linalg.norm(traction)) for node, traction in more]
    raise ModelError(f"normal_force_range: no solution within {_MOST_CUTS} linear programmes")


def _first_cuts(node: _Node) -> list[tuple[_Node, Float]]:
    """Return planes around the cone of a node: both of them in one direction."""
    if node.tangential.stop - node.tangential.start == 1:
        return [(node, np.array([one])) for one in (1.0, -1.0)]
    angles = 2.0 * np.pi * np.arange(_FACETS) / _FACETS
    return [(node, np.array([np.cos(angle), np.sin(angle)])) for angle in angles]


def _along(values: Float, node: _Node, direction: Float) -> Float:
    """Return traction along a direction less what the normal force allows."""
    allowed = 0.0 if node.normal is None else node.friction * values[node.normal]
    along: Float = direction @ values[node.tangential] - allowed
    return along


def _outside(node: _Node, forces: Float) -> float:
    """Return the distance of a traction from its cone, over what counts as none."""
    normal = node.load if node.normal is None else forces[node.normal]
    excess = np.linalg.norm(forces[node.tangential]) - node.friction * normal
    return float(excess) / _OUTSIDE

"""Sectors as finite elements cut them: with the same boundary at their left and their right."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stickslip.checks import brief, unknown
from stickslip.disk.coupling import Interface
from stickslip.errors import ModelError
from stickslip.model.structure import Rayleigh, Structure

__all__ = ["cyclic_sector"]


def cyclic_sector(structure: Structure, boundary: Mapping[str, str]) -> tuple[Structure, Interface]:
    """Join the right boundary of a sector to the left one of the next.

    Parameters
    ----------
    structure : Structure
        A sector with the degrees of freedom of both of its cuts, as finite elements give it, in
        cylindrical or sector-fixed coordinates.
    boundary : mapping of str to str
        Degrees of freedom at the right cut, each with the one at the left cut that it is in the
        next sector.

    Returns
    -------
    structure : Structure
        The sector without its right boundary, whose parts stand at the left one: K0 = K of the own
        degrees of freedom with K of the right boundary added at the left.
    interface : Interface
        The blocks to the next sector: K1 couples the own degrees of freedom with the left boundary
        of the next sector. Both are for ``BladedDisk(structure, ..., interface=interface)``.

    Raises
    ------
    ModelError
        If the boundary is no mapping or empty, a degree of freedom is unknown, stands at both cuts,
        or is named twice.
    """
    left = _checked(structure, boundary)
    kept = [dof for dof in structure.dofs if dof not in left]
    own = np.array([[float(dof == name) for name in kept] for dof in structure.dofs])
    ahead = [left.get(dof) for dof in structure.dofs]
    following = np.array([[float(dof == name) for name in kept] for dof in ahead])
    blocks = {}
    for name in ("mass", "stiffness", "damping"):
        matrix = getattr(structure, name)
        blocks[name] = own.T @ matrix @ own + following.T @ matrix @ following
    # The blocks of a skew part change sign across the cut, which one block per cut cannot say.
    if np.abs(structure.damping - structure.damping.T).max() > 0.0:
        reason = "structure: its damping is not symmetric; give the blocks yourself,"
        raise ModelError(f"{reason} ss.Interface(...)", study=f"{reason} interface of [disk]")
    interface = Interface(
        *(own.T @ getattr(structure, name) @ following for name in ("stiffness", "mass", "damping"))
    )
    law = structure.damping_law if isinstance(structure.damping_law, Rayleigh) else None
    sector = Structure.of_law(blocks["mass"], blocks["stiffness"], blocks["damping"], kept, law)
    return sector, interface


def _checked(structure: Structure, boundary: object) -> dict[str, str]:
    if not isinstance(structure, Structure):
        raise ModelError(f"structure: {brief(structure)} is no Structure; give ss.Structure(...)")
    if not isinstance(boundary, Mapping) or not boundary:
        raise ModelError(
            f'boundary: {brief(boundary)} names no pairs; write {{"right dof": "left dof"}}'
        )
    for right, left in boundary.items():
        for dof in (right, left):
            if dof not in structure.dofs:
                raise ModelError(f"boundary: {unknown('dof', dof, structure.dofs)}")
        if left in boundary:
            raise ModelError(f"boundary: {brief(left)} stands at both cuts; name it at one")
    lefts = list(boundary.values())
    twice = next((dof for dof in lefts if lefts.count(dof) > 1), None)
    if twice is not None:
        raise ModelError(f"boundary: {brief(twice)} is given twice at the left; name it once")
    return dict(boundary)

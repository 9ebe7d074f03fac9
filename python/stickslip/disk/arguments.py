"""Doors that the arguments of a disk pass."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from stickslip.checks import brief, unknown, whole_number
from stickslip.disk.coupling import Coupling, Interface
from stickslip.errors import ModelError
from stickslip.model.structure import Structure

__all__ = [
    "ALL_SECTORS",
    "NEXT",
    "PREVIOUS",
    "orders_of",
    "require_couplings",
    "require_interface",
    "stranger",
]

ALL_SECTORS = "mistuning = {deviation = 0.0} in [disk]"
"""How study files ask for all sectors of a tuned disk."""

NEXT = "next."
"""Prefix of the degrees of freedom of the next sector, in contacts between two sectors."""

PREVIOUS = "prev."
"""What may be written by mistake for those of the sector before, which no name reaches."""


def orders_of(orders: Mapping[int, int] | None) -> dict[int, int]:
    """Return engine orders by harmonic, checked."""
    if orders is None:
        return {}
    if not isinstance(orders, Mapping):
        raise ModelError(
            f"engine_orders: {brief(orders)} is no mapping; write {{harmonic: engine order}}"
        )
    return {
        whole_number(harmonic, "engine_orders: harmonic", smallest=1): whole_number(
            order, f"engine_orders[{brief(harmonic)}]"
        )
        for harmonic, order in orders.items()
    }


def require_couplings(couplings: tuple[Coupling, ...], structure: Structure) -> None:
    """Refuse couplings at degrees of freedom that the sector lacks."""
    for number, coupling in enumerate(couplings, 1):
        for dof in coupling.ends:
            if dof in structure.dofs:
                continue
            bare = dof.removeprefix(NEXT).removeprefix(PREVIOUS)
            if bare in structure.dofs:
                raise ModelError(
                    f"coupling {number}: {brief(dof)}: its second end is in the next sector anyway;"
                    f" write {brief(bare)}"
                )
            raise ModelError(f"coupling {number}: {unknown('dof', dof, structure.dofs)}")


def stranger(dof: str, dofs: Iterable[str | None], own: Sequence[str]) -> str:
    """Word a degree of freedom of a contact that neither the sector nor the next one has.

    `dofs` are all of the contact, `own` those of the sector. For the sector before: the contact as
    that sector sees it.
    """
    bare = dof.removeprefix(PREVIOUS)
    if bare == dof or bare not in own:
        return unknown("dof", dof, [*own, *(NEXT + one for one in own)])
    seen = [
        one.removeprefix(PREVIOUS) if one.startswith(PREVIOUS) else NEXT + one
        for one in dofs
        if one is not None
    ]
    return (
        f"unknown dof {brief(dof)}: contacts lead from a sector to the next one; write this one as "
        f"it stands in the sector before, with the dofs {', '.join(map(brief, seen))}"
    )


def require_interface(interface: Interface | None, structure: Structure) -> None:
    """Refuse an interface that does not fit the sector."""
    if interface is None:
        return
    if not isinstance(interface, Interface):
        raise ModelError(
            f"interface: {brief(interface)} is no Interface; write ss.Interface(stiffness=K1)"
        )
    if len(interface) != len(structure):
        raise ModelError(
            f"interface: {len(interface)} x {len(interface)} for a sector of {len(structure)} "
            "dofs; give blocks of the size of its matrices"
        )

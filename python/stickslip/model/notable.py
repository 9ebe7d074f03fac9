"""The degrees of freedom of a model that matter when none are named."""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.model.model import Model

_MODAL = re.compile(r"(.*\.)?mode-\d+")
_SHOWN_DOFS = 4


def physical_dofs(model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom that are no modal coordinates; all if there are no others.

    Modal coordinates are known by the names that `craig_bampton` gives them, "mode-1", ..., also
    behind the name of a part or a sector.
    """
    dofs = model.structure.dofs
    return tuple(dof for dof in dofs if not _MODAL.fullmatch(dof)) or dofs


def loaded_dofs(model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom with a force or a contact, each once."""
    loaded = [force.dof for force in model.forces]
    touching = [dof for contact in model.contacts for dof in contact.dofs if dof]
    return tuple(dict.fromkeys((*loaded, *touching)))


def massless_dofs(model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom without mass."""
    structure = model.structure
    return tuple(
        dof for dof, row in zip(structure.dofs, structure.mass, strict=True) if not row.any()
    )


def notable_dofs(model: Model, observed: Sequence[str]) -> tuple[str, ...]:
    """Choose the DOFs to show when none are named, of those whose motion is known.

    Up to four that carry a force or a contact, in this order, or else the first ones.
    """
    notable = [dof for dof in loaded_dofs(model) if dof in observed]
    return tuple(notable or observed)[:_SHOWN_DOFS]

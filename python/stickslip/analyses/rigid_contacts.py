"""Contacts so stiff that a motion with them may not be found."""

from __future__ import annotations

import numpy as np

from stickslip.analyses.texts import told
from stickslip.checks import listed
from stickslip.model import Jenkins, Model
from stickslip.results.arrays import Arrays
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.status import Status

RIGID = 1e6
"""Stiffness of a contact, over that of the structure at its DOFs, up to which motions are found."""


def rigid_contacts(model: Model, arrays: Arrays) -> Diagnostic | None:
    """Name the contacts that are nearly rigid, where points stalled."""
    stalled = int((arrays.status == Status.STALLED.code).sum())
    if not stalled:
        return None
    structure = model.structure
    held = dict(zip(structure.dofs, np.abs(structure.stiffness.diagonal()), strict=True))
    ratios: dict[str, float] = {}
    for contact in model.contacts:
        if not isinstance(contact, Jenkins):
            continue
        beside = [held[dof] for dof in (contact.dof, contact.other) if dof in held]
        if beside and min(beside) > 0.0:
            ratios[str(contact.name)] = float(np.max(contact.stiffness) / min(beside))
    rigid = [name for name, ratio in ratios.items() if ratio > RIGID]
    if not rigid:
        return None
    most = max(rigid, key=lambda name: ratios[name])
    return told(
        "rigid-contacts",
        _names=listed(rigid),
        contact=most,
        ratio=ratios[most],
        _limit=RIGID,
        points=stalled,
        _are="point" if stalled == 1 else "points",
    )

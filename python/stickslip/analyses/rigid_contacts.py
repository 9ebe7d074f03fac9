"""Contacts so stiff that a motion with them may not be found."""

from __future__ import annotations

import numpy as np

from stickslip.analyses.texts import told
from stickslip.checks import listed
from stickslip.model import Contact, Model
from stickslip.results.arrays import Arrays
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.status import Status

RIGID = 1e5
"""Stiffness of a contact, over that of the structure at its DOFs, up to which motions are found."""


UNSOLVED = (
    Status.STALLED,
    Status.SAMPLES_LIMIT,
    Status.HARMONICS_LIMIT,
    Status.EFFORT_LIMIT,
    Status.WORK_LIMIT,
)
"""How points end that nearly rigid contacts keep from their solution."""


def rigid_contacts(model: Model, arrays: Arrays) -> Diagnostic | None:
    """Name the contacts that are nearly rigid, where points are not solved to the tolerance."""
    unsolved = int(np.isin(arrays.status, [status.code for status in UNSOLVED]).sum())
    if not unsolved:
        return None
    ratios = {str(contact.name): _ratio(model, contact) for contact in model.contacts}
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
        points=unsolved,
        _are="point is" if unsolved == 1 else "points are",
    )


def _ratio(model: Model, contact: Contact) -> float:
    """Return the largest stiffness of a contact over that of the softest DOF that it acts on."""
    held = np.abs(model.structure.stiffness.diagonal())
    places = [np.flatnonzero(row) for row in np.hstack(model.contact_rows(contact))]
    beside = [held[place % held.size].min() if place.size else 0.0 for place in places]
    own = contact.stuck_stiffness.diagonal()
    return max((k / b for k, b in zip(own, beside, strict=True) if b > 0.0), default=0.0)

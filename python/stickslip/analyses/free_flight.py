"""Bodies that only contacts hold, and when all of them are open: free flight."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np

from stickslip.analyses.texts import told
from stickslip.disk.sector import NEXT, Sector
from stickslip.model import Model
from stickslip.results.exact_response import ExactResponse
from stickslip.results.forced_response import ForcedResponse

_Response = TypeVar("_Response", ForcedResponse, ExactResponse)
_SAMPLES = 256
"""Instants of a period at which contacts are looked at; a shorter flight passes unnoticed."""
_SINGULAR = 1e-9
"""Lowest stiffness of a body, over its highest, that is none."""


def with_free_flight(result: _Response) -> _Response:
    """Add a caution where a body that contacts alone hold is let go by all of them at once."""
    normal = [n for n, one in enumerate(result.model.contacts) if "N" in one.components]
    # A contact of which a node never opens lets nothing go.
    opens = {one: np.nan_to_num(result.open_fraction(one).min(axis=1)) > 0.0 for one in normal}
    if not any(own.any() for own in opens.values()):
        return result
    for body, contacts in _bodies(result.model):
        for index in np.flatnonzero(np.all([opens[one] for one in contacts], axis=0)):
            shut = [
                (result.contact_force(one, int(index), _SAMPLES)[..., -1] > 0.0)
                .reshape(_SAMPLES, -1)
                .any(axis=1)
                for one in contacts
            ]
            free = float((~np.any(shut, axis=0)).mean())
            if free > 0.0:
                omega = float(result.omega[index])
                flight = told("free-flight", body=body, share=free, omega=omega)
                return replace(result, diagnostics=(*result.diagnostics, flight))
    return result


def _bodies(model: Model) -> Iterator[tuple[str, list[int]]]:
    """Give the bodies that only Coulomb contacts hold, by a dof, with these contacts."""
    if not any("N" in contact.components for contact in model.contacts):
        return
    from scipy.sparse.csgraph import connected_components

    structure = model.structure
    linked = (structure.stiffness != 0.0) | (structure.damping != 0.0) | (structure.mass != 0.0)
    count, labels = connected_components(linked, directed=False)
    touched = [
        {structure.index(dof.removeprefix(NEXT)) for dof in contact.dofs if dof is not None}
        for contact in model.contacts
    ]
    tied = np.zeros(len(structure), np.bool_)
    if isinstance(model, Sector):
        ahead = model.matrices.stiffness.next != 0.0
        tied = ahead.any(axis=0) | ahead.any(axis=1)
    for label in range(count):
        own = np.flatnonzero(labels == label)
        contacts = [number for number, dofs in enumerate(touched) if dofs & set(own.tolist())]
        normal = all("N" in model.contacts[number].components for number in contacts)
        if not contacts or not normal or tied[own].any():
            continue
        stiffness = np.linalg.eigvalsh(structure.stiffness[np.ix_(own, own)])
        if stiffness[0] <= _SINGULAR * stiffness[-1]:
            yield structure.dofs[own[0]].rpartition(".")[0] or structure.dofs[own[0]], contacts

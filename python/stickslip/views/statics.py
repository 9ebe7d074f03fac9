"""What is said and drawn of equilibria under static loads."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from stickslip.drawn import plots
from stickslip.results.static_response import StaticResponse
from stickslip.results.status import RestStatus
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row


class StaticView(View[StaticResponse]):
    """Displacements, and the forces of every contact."""

    texts = ("what",)
    numbers = ("displacement [{}]", "traction [N]", "normal force [N]")
    frequencies = False

    def rows(self, result: StaticResponse, dofs: Dofs, length: float) -> Rows:
        """Return a row per DOF and one per contact point."""
        for dof in dofs:
            yield dof, f"{result.displacement(dof) / length:#.7g}", "", ""
        for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
            for point in range(contact.points):
                force = np.atleast_1d(result.contact_force((name, point)))
                has_normal = "N" in contact.components
                traction = np.linalg.norm(force[:-1] if has_normal else force)
                where = name if contact.points == 1 else f"{name} {point}"
                yield where, "", f"{traction:.6g}", f"{force[-1]:.6g}" if has_normal else ""

    def about(self, result: StaticResponse) -> list[Row]:
        """Say how the loading ended."""
        return [("loading", f"{result.status}, {result.share:.4%} of the loads carried")]

    def failures(self, result: StaticResponse) -> list[str]:
        """Say why loads are not carried, in one line; empty if they are."""
        converged = result.status == RestStatus.CONVERGED
        return [] if converged else [f"{result.status}. {result.status.advice}"]

    def panels(self, results: Sequence[StaticResponse], dofs: Dofs, output: Output) -> Panels:
        """Return the forces of the contacts."""
        return [partial(plots.static_forces, one) for one in results]

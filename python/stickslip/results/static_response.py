"""A structure at rest under its static loads."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from stickslip.checks import constant
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import ContactRef, PointRef
from stickslip.results.fields import Code, Columns, Float, column
from stickslip.results.result import ColumnResult
from stickslip.results.status import RestStatus
from stickslip.settings.motion import StaticSettings


class StaticArrays(Columns):
    """The numbers of a structure at rest."""

    displacement: Float = column("dof", "m", "displacement")
    contact_displacement: Float = column("point", "m", "relative displacement at the contacts")
    contact_force: Float = column(
        "point", "N", "contact force against the relative displacement, without what is in balance"
    )
    share: Float = column("load", "1", "share of the loads that is carried", least=0.0, most=1.0)
    status: Code = column("load", "1", "how the loading ended", codes=tuple(RestStatus))


class StaticResponse(ColumnResult):
    """A structure at rest under its static loads, raised slowly from nothing.

    Friction remembers how the loads came: of all states in equilibrium this is the one that follows
    from raising all of them together. Degrees of freedom are addressed by name, contacts by
    position or name, one node as (contact, point). Displacements are in m, forces in N.
    """

    kind: ClassVar[str] = "static_response"
    title = "Structure with dry friction under static loads"

    settings: StaticSettings
    arrays: StaticArrays

    plot = Drawn("static_forces")

    def __repr__(self) -> str:
        return f"StaticResponse({self.status}, {self.share:.4g} of the loads)"

    @property
    def status(self) -> RestStatus:
        """How the loading ended; ``status.advice`` says what to do about it."""
        return RestStatus.from_code(int(self.arrays.status[0]))

    @property
    def share(self) -> float:
        """Share of the loads in equilibrium: 1 unless a body came free or contacts jammed."""
        return float(self.arrays.share[0])

    def displacement(self, dof: str) -> float:
        """Return a displacement [m]."""
        return float(self.arrays.displacement[self._column(dof)])

    def contact_displacement(self, contact: PointRef) -> Float:
        """Return the relative displacements of a contact, shape (components,) or (points,) [m]."""
        return constant(self._select(self.arrays.contact_displacement, contact))

    def contact_force(self, contact: PointRef) -> Float:
        """Return the forces of a contact, shape (components,) or (points,) [N].

        Of a `Coulomb` contact t1, t2 and the normal force N itself, a preload included; of many
        nodes shape (points, components).
        """
        return constant(
            self._with_balanced(self._select(self.arrays.contact_force, contact), contact)
        )

    def normal_force_range(
        self, contact: ContactRef, point: int = 0, *, alone: bool = False
    ) -> tuple[float, float]:
        """Return the least and the greatest normal force of a node that Coulomb statics allow [N].

        Tractions within the friction cones that keep the same loads in equilibrium are all
        possible: which are there depends on how the loads came. Nodes that are open here stay open.
        The range lies between the states in which all nodes together are pressed least and most,
        as a wedge is that is just about to move out and that was driven in. The greatest is
        infinite where the contacts lock.

        Parameters
        ----------
        contact : int or str
            Position or name of the contact.
        point : int, optional
            The node, counted from 0.
        alone : bool, optional
            Take the extremes of this node by itself instead, whatever the others bear for it: those
            of a wedge that was pushed askew are wider.

        Raises
        ------
        ModelError
            If the contact has no normal force, the node is open, or the loading did not converge.
        """
        from stickslip.results.normal_force import normal_force_range

        if self.status != RestStatus.CONVERGED:
            raise ModelError(f"normal_force_range: the loading ended as {self.status}")
        number, node = self.locate((contact, point))
        own = self.model.contacts[number]
        if "N" not in own.components:
            raise ModelError(
                f"normal_force_range: contact {self.model.contact_names[number]!r} has no normal "
                "force of its own; name a coulomb contact with a normal"
            )
        forces = self.arrays.contact_force + np.concatenate(
            [one.balanced for one in self.model.contacts]
        )
        place = self._columns(number, node).stop - 1
        if not forces[place] > 0.0:
            raise ModelError(
                f"normal_force_range: node {node} of contact {self.model.contact_names[number]!r} "
                "is open; its normal force is 0"
            )
        return normal_force_range(self.model, forces, place, alone=alone)

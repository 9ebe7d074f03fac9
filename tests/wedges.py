"""Wedges between two blades whose tips move in x and y."""

from __future__ import annotations

import stickslip as ss

ENDS = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
WEDGE = ss.WedgeDamper(
    angle=40.0,
    mass=0.1,
    friction=0.6,
    tangential_stiffness=3e5,
    normal_stiffness=3e5,
    load=240.0,
)

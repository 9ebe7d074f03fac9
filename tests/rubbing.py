"""A mass that rubs, and the response of the beam, shared by the tests of forced responses."""

from __future__ import annotations

import numpy as np

import stickslip as ss

GRID = np.linspace(150.0, 250.0, 60)


def one_dof(*forces, damping=0.4, stiffness=8.0, slip_force=1.0):
    """Return a mass of 2 kg on a spring with a pad of 10 N/m."""
    structure = ss.Structure([[2.0]], [[stiffness]], damping=[[damping]], dofs=["x"])
    contact = ss.Jenkins("x", stiffness=10.0, slip_force=slip_force)
    return ss.Model(structure, [contact], forces or [ss.Force("x", 0.5)])


def beam_response():
    """Return nine harmonics of the SNECMA beam."""
    return ss.forced_response(ss.reference.snecma_beam(), GRID, harmonics=9)

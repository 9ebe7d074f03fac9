"""A study file and a curve that the tests of sweeps share."""

import numpy as np

import stickslip as ss

GRID = np.linspace(150.0, 250.0, 12)

STUDY = """
[structure]
mass = [[2.0, 0.0], [0.0, 1.0]]
stiffness = [[3.0e6, -1.0e6], [-1.0e6, 1.0e6]]
damping = { modal = "0.2 %" }
dofs = ["root", "tip"]

[[contact]]
law = "jenkins"
dof = "tip"
stiffness = "500 N/mm"
slip_force = "3 N"

[[force]]
dof = "tip"
amplitude = "1 N"

[analysis]
omega = [700, 800, 900]
harmonics = 5
"""


def curve(model):
    return ss.forced_response(model, GRID, 5)

"""A small study file in its parts, for the tests of study files."""

STRUCTURE = """
[structure]
mass = [[2, 0.5], [0.5, 1]]
stiffness = [[800, -200], [-200, 200]]
dofs = ["root", "tip"]
"""
ONE_CONTACT = """
[[contact]]
law = "jenkins"
dof = "root"
stiffness = 1e3
slip_force = 2
"""
ONE_FORCE = """
[[force]]
dof = "tip"
amplitude = 1
"""
ANALYSIS = """
[analysis]
omega = {from = 1, to = 30, points = 5}
harmonics = 3
"""
SMALL = STRUCTURE + ONE_CONTACT + ONE_FORCE + ANALYSIS

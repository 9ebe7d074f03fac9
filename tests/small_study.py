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

# A mass with a pad that rubs.
PAD = """
[structure]
mass = [[1.0]]
stiffness = [[1e4]]
damping = {modal = 0.005}
dofs = ["tip"]

[[contact]]
law = "jenkins"
name = "pad"
dof = "tip"
stiffness = 2000
slip_force = 2

[[force]]
dof = "tip"
amplitude = "1 N"
"""

# Two masses.
TWO_MASSES = """
[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[2.0, -1.0], [-1.0, 2.0]]
damping = { modal = "1 %" }
dofs = ["tip", "root"]
"""

# A disk of one mass per sector.
MISTUNED = """
name = "ring"
[structure]
mass = [[1]]
stiffness = [[1000]]
damping = [[0.3]]
dofs = ["tip"]
[[contact]]
law = "jenkins"
dof = "tip"
stiffness = 100
slip_force = 1
[[force]]
dof = "tip"
amplitude = 1
[[coupling]]
dof = "tip"
stiffness = 50
[disk]
sectors = 6
engine_order = 1
[analysis]
kind = "mistuning-study"
omega = {from = 25, to = 45}
deviation = 0.02
patterns = 60
harmonics = 1
"""

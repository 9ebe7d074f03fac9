"""A plate of bricks: a damper at coordinates, a reduction that is kept, a file for ParaView."""

import numpy as np
from skfem import MeshHex

import stickslip as ss

size = (np.linspace(0, 0.12, 13), np.linspace(0, 0.03, 4), np.linspace(0, 0.004, 2))
plate = ss.Solid(MeshHex.init_tensor(*size), young=210e9, poisson=0.3, density=7850.0)
plate.write_vtu("plate.vtu", {})  # or a deck of CalculiX, Abaqus, Nastran, a mesh of Gmsh
mesh = ss.read_mesh("plate.vtu")
free = np.flatnonzero(np.repeat(mesh.nodes[:, 0] > 1e-9, 3))  # clamped at x = 0
reduced = ss.craig_bampton(
    plate.mass[free][:, free],
    plate.stiffness[free][:, free],
    {"damper": mesh.dof_at([0.03, 0.015, 0], 3), "tip": mesh.dof_at([0.12, 0, 0.004], 3)},
    modes=10,
    dofs=[plate.dofs[dof] for dof in free],
)
reduced.save("plate-reduction.nc")
structure = ss.Reduction.load("plate-reduction.nc").structure(ss.ModalDamping(0.001))
damper = ss.Jenkins("damper", stiffness="1 kN/mm", slip_force="1 N")
model = ss.Model(structure, [damper], [ss.Force("tip", "0.1 N")])
curve = ss.forced_response(model, np.linspace(1450, 1850, 81))
peak = curve.peak("tip")
print(peak)
point = ss.forced_response(model, [peak.omega], 25, observe=structure.dofs)  # for the picture
mesh.write_vtu("peak.vtu", mesh.motion(point, 0, reduced))
curve.export("plate.uff")

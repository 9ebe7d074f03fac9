"""One driven mode of the SNECMA beam: the three readings of eq. (5.30) of Guillen (1999)."""

import numpy as np
from scipy.linalg import eigh

import stickslip as ss

model = ss.reference.snecma_beam()
own = model.structure
bare = ss.Model(ss.Structure(own.mass, own.stiffness, None, own.dofs), model.contacts)

# c = diag(T^T C T) with eigenvectors T of unit length; printed in reverse order
squares, shapes = eigh(own.stiffness, own.mass)
shapes /= np.linalg.norm(shapes, axis=0)
c = np.diag(shapes.T @ own.damping @ shapes)
to_ratio = 1.0 / (2.0 * np.diag(shapes.T @ own.mass @ shapes) * np.sqrt(squares))
print("c =", *c.round(4))

READINGS = {
    "as printed: -12.095 r on mode 2": lambda r: [c[2], c[1], -c[0] * r],
    "the mode of 12.095: mode 0 driven": lambda r: [-c[0] * r, c[1], c[2]],
    "the third mode: -5.789 r on mode 2": lambda r: [c[0], c[1], -c[2] * r],
}
for name, coefficients in READINGS.items():
    for r in (1.0, 3.0, 8.0):
        aero = ss.modal_damping(list(to_ratio * coefficients(r)))
        driven = ss.destabilised(bare, aero)
        motion = ss.classify(driven, {"tip": 1e-4})
        print(f"{name}, r = {r:g}: {motion.motion}, mode {motion.mode}, {motion.omega:.2f} rad/s")

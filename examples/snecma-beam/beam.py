"""The SNECMA beam with a friction damper, at eight loads: Guillen (1999), eq. (2.32)."""

import numpy as np

import stickslip as ss

M = [[6.67959, 1.02115, 0.6343], [1.02115, 1.22168, 0.232108], [0.6343, 0.232108, 0.121809]]
K = [[4.43203e6, -3.77514e5, 0.0], [-3.77514e5, 6.9626e4, 0.0], [0.0, 0.0, 1.85323e5]]
beam = ss.Structure(M, K, ss.Rayleigh(mass=7.49, stiffness=2.6e-5), ["damper", "tip", "mode"])
damper = ss.Jenkins("damper", stiffness=2.4e7, slip_force=246.048)
for load in (0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438):
    model = ss.Model(beam, contacts=[damper], forces=[ss.Force("tip", amplitude=load)])
    response = ss.forced_response(model, omega=np.linspace(20, 350, 400), harmonics=35)
    print(f"{load:6} N: {response.peak('tip').amplitude:.4e} m at {response.peak('tip').omega:.2f}")
    response.save(f"snecma-beam-{load:g}.nc")

"""A ring of 36 beams, tuned and mistuned by 7 %: Guillen (1999), section 4.5."""

import numpy as np

import stickslip as ss

omega = np.linspace(150, 260, 111)
ring = ss.reference.beam_ring(sectors=36, coupling=7e3, engine_order=3)
tuned = ss.forced_response(ring, omega, harmonics=3)
pattern = ss.mistuning_pattern(36, 0.07, "uniform", seed=0)
observe = [f"{blade}.damper" for blade in range(36)]
mistuned = ss.forced_response(ring.mistuned(pattern), omega, harmonics=3, observe=observe)
found = mistuned.amplification(tuned, "damper")
print(f"amplification {found.factor:.3f} at blade {found.blade}, {found.peak.omega:.1f} rad/s")
mistuned.plot_blades("damper", tuned=tuned, length_unit="um").figure.savefig("beam-ring.png")

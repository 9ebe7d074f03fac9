"""A cubic spring, two laws of friction, their backbones, and the true error of a curve."""

import stickslip as ss

beam = ss.reference.snecma_beam().structure
force, spring = ss.Force("tip", "20.3 N"), ss.Cubic("tip", stiffness="2e9 N/m^3")
jenkins = ss.Jenkins("damper", stiffness="24 kN/mm", slip_force="246 N")
iwan = ss.Iwan("damper", stiffness="24 kN/mm", slip_force="246 N", chi=-0.5)

models = [ss.Model(beam, [law, spring], [force]) for law in (jenkins, iwan)]
backbones = [ss.nonlinear_modes(one, mode=0, amplitude=(1e-4, 1e-1)) for one in models]
ss.plot.backbone(backbones, labels=["Jenkins", "Iwan"]).figure.savefig("backbones.png")
for one in backbones:
    print(f"damping up to {one.damping_ratio.max():.1%}")

curve = ss.forced_response(ss.Model(beam, [jenkins], [force]), omega=("25 Hz", "35 Hz"))
print(curve.peak("tip"))
exact = ss.certify(curve, points=5).certificate
print(f"true error: {(exact.error / exact.amplitude).max():.1e}")

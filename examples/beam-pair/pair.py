"""Forces and slip of a damper of four contacts: Guillen (1999), Figs 6.4-6.7."""

import stickslip as ss
from stickslip import plot

for omega, force in [(250.0, 15.0), (550.0, 35.0), (550.0, 140.0), (550.0, 550.0)]:
    model = ss.reference.damped_pair(force)
    orbit = ss.exact_response(model, [omega])
    states = orbit.contact_states("structural", 0)
    print(f"{omega:g} rad/s, {force:3g} N: slip sets {[*filter(None, states.sets)]}")
    axes = plot.contact_forces(orbit, "structural", 0)
    axes[0].figure.savefig(f"beam-pair-{force:g}.png")

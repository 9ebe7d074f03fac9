"""The structure-like damper: the dissertation's explicit update, the implicit one, and their cost.

Usage::

    python benchmarks/structural_damper.py

First, forces along one given motion, that of the beam pair at 550 rad/s and 550 N with 9 harmonics:
Guillen's Procedure 2 (1999, section 6.3.3, with its correction 6.21), and the implicit increment,
both against the exact passage from transition to transition. Then the time of one evaluation with
its tangent, as a ratio to a Jenkins element between two degrees of freedom, from one run.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip import _core

Float = NDArray[np.float64]

HARMONICS = 9
SAMPLES = (64, 128, 256, 512, 1024, 2048, 4096, 8192)
PERIODS = 12


def procedure_2(u: Float, stiffness: Float, limits: Float, *, corrected: bool) -> Float:
    """Return the forces of the last of several periods, shape (samples, points), by Procedure 2.

    All contacts stick without force at the start. The states of a step follow from the step
    before; `corrected` sets the force of slipping contacts to their limits, eq. (6.21).
    """
    samples, points = u.shape
    force, slips = np.zeros(points), np.zeros(points, dtype=bool)
    before = np.zeros(points)
    period = np.zeros((samples, points))
    for step in range(1, PERIODS * samples + 1):
        moved = u[step % samples] - u[(step - 1) % samples]
        z = moved.copy()
        if slips.any():
            sticks = ~slips
            wanted = (
                np.where(slips, np.sign(force) * limits - force, 0.0) if corrected else 0 * u[0]
            )
            right = wanted[slips] - stiffness[np.ix_(slips, sticks)] @ moved[sticks]
            z[slips] = np.linalg.lstsq(stiffness[np.ix_(slips, slips)], right, rcond=None)[0]
        force = force + stiffness @ z
        relative = z - moved
        released = slips & (relative * before < 0.0)
        slips = (slips | (np.abs(force) >= limits)) & ~released
        before = relative
        period[step % samples] = force
    return period


def accuracy() -> None:
    """Print errors and overshoot over the number of samples."""
    model = ss.reference.damped_pair(550.0)
    (damper,) = model.contacts
    limits = np.array(damper.slip_forces)
    frf = ss.forced_response(model, [550.0], HARMONICS)
    series = np.ascontiguousarray(frf.arrays.contact_displacement[0].T)
    print("largest error of a force, relative to the largest force; largest force of contact 0 [N]")
    print(
        f"{'samples':>8} {'procedure 2':>12} {'implicit':>10}   {'procedure 2':>11} {'implicit':>9}"
    )
    errors: dict[str, list[float]] = {"procedure 2": [], "implicit": []}
    for count in SAMPLES:
        exact = frf.contact_force("structural", 0, count)
        motion = frf.contact_waveform("structural", 0, count)
        found = {
            "procedure 2": procedure_2(motion, damper.stiffness, limits, corrected=True),
            "implicit": _core.contact_force(model.problem, 0, series, "centred", count, count),
        }
        size = np.abs(exact).max()
        for name, force in found.items():
            errors[name].append(float(np.sqrt(np.mean((force - exact) ** 2)) / size))
        tops = [float(np.abs(force[:, 0]).max()) for force in found.values()]
        last = [values[-1] for values in errors.values()]
        print(f"{count:>8} {last[0]:>12.2e} {last[1]:>10.2e}   {tops[0]:>11.1f} {tops[1]:>9.1f}")
    for name, values in errors.items():
        order = -np.polyfit(np.log(SAMPLES), np.log(values), 1)[0]
        print(f"order of {name}: {order:.2f}")
    plain = procedure_2(
        frf.contact_waveform("structural", 0, 64), damper.stiffness, limits, corrected=False
    )
    print(f"without the correction, 64 samples: largest force {np.abs(plain).max():.0f} N")


def cost() -> None:
    """Print the time of one evaluation with its tangent, relative to a Jenkins element."""
    pair = ss.reference.damped_pair(120.0)
    spring = np.array([[2.4e7, -2.4e7], [-2.4e7, 2.4e7]])
    ends = ["1.damper", "2.damper"]
    contacts = {
        "Jenkins between two DOFs": ss.Jenkins(*ends, stiffness=2.4e7, slip_force=24.6),
        "two contacts, one slips": ss.StructuralDamper(
            ends, stiffness=spring, slip_forces=[24.6, np.inf]
        ),
        "four contacts": pair.contacts[0],
    }
    omega = np.linspace(500.0, 700.0, 101)
    print("\ntime of an evaluation of the law, relative to the Jenkins element, by harmonics")
    print(f"{'':28}" + "".join(f"{harmonics:>8}" for harmonics in (5, 15, 25)))
    first: dict[int, float] = {}
    for name, contact in contacts.items():
        model = pair.replaced(contacts=[contact])
        row = ""
        for harmonics in (5, 15, 25):
            runs = [ss.forced_response(model, omega, harmonics) for _ in range(3)]
            each = min(run.timings["law"] / run.counters["evaluations"] for run in runs)
            row += f"{each / first.setdefault(harmonics, each):>8.1f}"
        print(f"{name:28}{row}")
    print(f"a Jenkins evaluation took {1e6 * first[15]:.1f} us with 15 harmonics")


if __name__ == "__main__":
    accuracy()
    cost()

"""A beam with a friction contact on a test rig, by Newmark's method: nothing of stickslip is used.

Two masses, the second of which rubs on the ground: a spring of 2e5 N/m that slips at 12 N. A force
on the first is stepped through 24 frequencies at three levels; each is held until the motion has
settled. Amplitudes have 2 % noise. Writes level-2.csv, level-8.csv and level-20.csv.
"""

import numpy as np

MASS = np.array([1.0, 0.5])
STIFFNESS = np.array([[3e5, -1e5], [-1e5, 2e5]])
DAMPING = 1e-4 * STIFFNESS
SPRING, LIMIT = 2e5, 12.0
LEVELS = (2.0, 8.0, 20.0)
OMEGA = np.linspace(380.0, 680.0, 24)
PERIODS, STEPS = 60, 300


def settled(omega: float, level: float) -> float:
    """Return the amplitude of the first mass after many periods [m]."""
    step = 2.0 * np.pi / omega / STEPS
    base = STIFFNESS + 2.0 / step * DAMPING + 4.0 / step**2 * np.diag(MASS)
    stuck, slipping = base + np.diag([0.0, SPRING]), base
    inverse = {True: np.linalg.inv(stuck), False: np.linalg.inv(slipping)}
    x, v, a = np.zeros((3, 2))
    slider, trace = 0.0, []
    for count in range(1, PERIODS * STEPS + 1):
        load = np.array([level * np.cos(omega * count * step), 0.0])
        load = load + MASS * (4.0 / step**2 * x + 4.0 / step * v + a)
        load = load + DAMPING @ (2.0 / step * x + v)
        # It sticks unless the spring would bear more than its limit.
        new = inverse[True] @ (load + np.array([0.0, SPRING * slider]))
        force = SPRING * (new[1] - slider)
        if abs(force) > LIMIT:
            force = np.copysign(LIMIT, force)
            new = inverse[False] @ (load - np.array([0.0, force]))
            slider = new[1] - force / SPRING
        speed = 2.0 / step * (new - x) - v
        a = 4.0 / step**2 * (new - x) - 4.0 / step * v - a
        x, v = new, speed
        trace.append(x[0])
    last = np.array(trace[-4 * STEPS :])
    return 0.5 * float(last.max() - last.min())


def main() -> None:
    """Write a file of frequency [Hz] and amplitude [um] per level."""
    draw = np.random.default_rng(7)
    for level in LEVELS:
        seen = np.array([settled(omega, level) for omega in OMEGA])
        seen *= 1.0 + 0.02 * draw.standard_normal(seen.size)
        rows = np.column_stack([OMEGA / (2.0 * np.pi), 1e6 * seen])
        np.savetxt(f"level-{level:g}.csv", rows, delimiter=",", fmt="%.6g")


if __name__ == "__main__":
    main()

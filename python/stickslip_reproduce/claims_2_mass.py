"""Claims of chapter II on one mass: the improved single-harmonic approximation."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.curves import maxima
from stickslip_reproduce.numbers import Fact, Series
from stickslip_reproduce.resolution import Resolution

SPAN = (20.0, 350.0)


@cache
def mass(ratio: float) -> tuple[ss.ExactResponse, ss.ForcedResponse]:
    """Return exact orbits and one harmonic of the single DOF over the whole range."""
    model = ss.reference.single_dof(force_ratio=ratio)
    true = ss.exact_response(model, SPAN)
    return true, ss.single_harmonic(model, true.omega)


@claim(
    "griffins-damper",
    "2.2.4",
    "The standard single-harmonic solution gives a rather poor approximation of the damper "
    "displacement z",
    """Its first harmonic alone against Runge-Kutta, over the slip limit, at P = 0.5 F_d and 225
    rad/s; poor is more than a tenth.""",
    rule=lambda n: verdict(n["largest difference"] > 10.0),
    see="fig-2.3",
)
def griffin(resolution: Resolution) -> Found:
    """Difference of the first harmonic of z."""
    shown = numbers_of("fig-2.3", resolution)
    return Found(
        (Fact("largest difference", shown.fact("largest difference of Griffin's z"), "%"),)
    )


@claim(
    "improved-damper",
    "2.2.4",
    "the agreement between the numerical time integration and the improved single-harmonic "
    "approximation is excellent",
    """The friction law followed through one period of the harmonic motion, in the same case;
    excellent is less than 2 %.""",
    rule=lambda n: verdict(n["largest difference"] < 2.0, n["largest difference"] < 5.0),
    see="fig-2.3",
)
def improved(resolution: Resolution) -> Found:
    """Difference of the improved z."""
    shown = numbers_of("fig-2.3", resolution)
    return Found((Fact("largest difference", shown.fact("largest difference of improved z"), "%"),))


@claim(
    "single-dof-agreement",
    "2.2.5",
    "The agreement between the numerical time integration procedure and the improved "
    "single-harmonic approximation is of high quality.",
    """Peaks of the single DOF to exact orbits at both loads, and the largest difference anywhere on
    the curve, over the amplitude there: the peaks agree, the curve below 70 rad/s does not, where
    the subresonances are.""",
    rule=lambda n: verdict(
        n["largest difference on the curves"] < 5.0, n["largest error of a peak"] < 1.0
    ),
    see="fig-2.4 fig-2.5",
)
def single_dof(resolution: Resolution) -> Found:
    """Errors of peaks and curves of the single DOF."""
    peaks, curves = [], []
    for ratio in (0.5, 2.0):
        true, rough = mass(ratio)
        peaks.append(rough.peak("mass").amplitude / true.peak("mass").amplitude - 1.0)
        curves.append(np.abs(rough.amplitude("mass") / true.amplitude("mass") - 1.0).max())
    return Found(
        (
            Fact("largest error of a peak", 100.0 * float(np.abs(peaks).max()), "%"),
            Fact("largest difference on the curves", 100.0 * float(max(curves)), "%"),
        )
    )


@claim(
    "no-subresonances",
    "2.2.5",
    "the single-harmonic approximation is not able to reproduce the subresonances",
    """Maxima of the curve of the mass below 80 rad/s at P = 2 F_d.""",
    rule=lambda n: verdict(n["of exact orbits"] > 0 and n["of one harmonic"] == 0),
    see="fig-2.5",
)
def subresonances(resolution: Resolution) -> Found:
    """Return the number of subresonances with and without higher harmonics."""
    true, rough = mass(2.0)
    tops = [
        sum(top < 80.0 for top, _ in maxima(Series("", one.omega, one.amplitude("mass"))))
        for one in (true, rough)
    ]
    return Found((Fact("of exact orbits", tops[0]), Fact("of one harmonic", tops[1])))


@claim(
    "plateau",
    "2.2.5",
    "over the frequency ranges where the friction damper slips, the amplitude of the damper "
    "displacement is equal to its maximum value",
    """Largest relative distance of the damper's amplitude from F_d / k_d on exact orbits that slip,
    at P = 0.5 and 2 F_d.""",
    rule=lambda n: verdict(n["frequencies with slip"] > 0 and n["largest distance"] < 1e-6),
    see="fig-2.4 fig-2.5",
)
def plateau(resolution: Resolution) -> Found:
    """Distance of the damper from its limit where it slips."""
    distance, count = 0.0, 0
    for ratio in (0.5, 2.0):
        true, _ = mass(ratio)
        slips = true.slip_fraction((0, 0)) > 0.0
        reached = true.damper_amplitude((0, 0))[slips]
        limit = ss.reference.DAMPER_SLIP_FORCE / ss.reference.DAMPER_STIFFNESS
        distance = max(distance, float(np.abs(reached / limit - 1.0).max()))
        count += int(slips.sum())
    return Found((Fact("largest distance", distance), Fact("frequencies with slip", count)))


@claim(
    "single-dof-optimum",
    "2.2.5",
    "the optimum is reached for values of the ratio of external force to maximum friction force, "
    "P/F_d, ranging from 0.5 to 1",
    """The best ratio over all, with converged peaks.""",
    rule=lambda n: verdict(0.5 <= n["best P / F_d"] <= 1.0),
    see="fig-2.6",
)
def single_dof_optimum(resolution: Resolution) -> Found:
    """Optimal level of the single DOF."""
    shown = numbers_of("fig-2.6", resolution)
    return Found((Fact("best P / F_d", shown.fact("optimal P / F_d, converged")),))


@claim(
    "hundreds-of-cycles",
    "2.2.5",
    "numerical time integration procedures have to be carried out over several hundred cycles in "
    "order to reach steady-state",
    """Periods from rest until a period changes the state of the single DOF by less than 1e-6 and by
    less than 1e-3, the slowest of twelve frequencies around the resonance at P = 2 F_d. Viscous
    damping alone takes e-fold every 6 periods.""",
    rule=lambda n: verdict(n["periods to 1e-3"] >= 200.0, n["periods to 1e-6"] >= 100.0),
)
def cycles(resolution: Resolution) -> Found:
    """Periods from rest to the steady state."""
    model = ss.reference.single_dof(force_ratio=2.0)
    facts = []
    for tolerance in (1e-3, 1e-6):
        periods = [
            ss.transient(model, float(omega), periods=5000, tolerance=tolerance, keep=1).periods
            for omega in np.linspace(100.0, 300.0, 12)
        ]
        facts.append(Fact(f"periods to {tolerance:.0e}".replace("e-0", "e-"), float(max(periods))))
    return Found(tuple(facts))


@claim(
    "orders-of-magnitude",
    "2.2.5",
    "The single-harmonic approximation is therefore orders of magnitude faster than the numerical "
    "time integration.",
    """Processor time of Runge-Kutta from rest over that of one harmonic, for twelve frequencies of
    the single DOF at P = 2 F_d; two orders of magnitude count.""",
    rule=lambda n: verdict(n["Runge-Kutta takes"] > 100.0, n["Runge-Kutta takes"] > 10.0),
)
def faster(resolution: Resolution) -> Found:
    """Time of Runge-Kutta over that of one harmonic."""
    model = ss.reference.single_dof(force_ratio=2.0)
    omega = np.linspace(100.0, 300.0, 12)
    begin = time.process_time()
    for frequency in omega:
        ss.transient(model, float(frequency), periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    middle = time.process_time()
    repeats = 20
    for _ in range(repeats):
        ss.forced_response(model, omega, 1)
    end = time.process_time()
    return Found((Fact("Runge-Kutta takes", repeats * (middle - begin) / (end - middle), "times"),))


@claim(
    "virtually-perfect",
    "2.5",
    "The agreement between the results given by this single-harmonic method and a fourth-order "
    "Runge-Kutta numerical time integration procedure is virtually perfect.",
    """Largest distance of the curves of the mass over the peak, at P = 0.5 and 2 F_d: small in the
    picture, as the subresonances are small against the peak.""",
    rule=lambda n: verdict(
        n["largest distance over the peak"] < 1.0, n["largest distance over the peak"] < 5.0
    ),
    see="fig-2.4 fig-2.5",
)
def virtually_perfect(resolution: Resolution) -> Found:
    """Distance of one harmonic from exact orbits, over the peak."""
    worst = 0.0
    for ratio in (0.5, 2.0):
        true, rough = mass(ratio)
        apart = np.abs(rough.amplitude("mass") - true.amplitude("mass")).max()
        worst = max(worst, float(apart) / true.peak("mass").amplitude)
    return Found((Fact("largest distance over the peak", 100.0 * worst, "%"),))


@claim(
    "sticking-to-slipping",
    "2.2.5",
    "ranging from a low level (P = 0.5F_d) for which the damper is mostly sticking during one "
    "period of the motion, to a high level (P = 2F_d) for which the damper is mostly slipping "
    "during one period of the motion",
    """Share of the period that the damper slips at the exact peak, at both levels.""",
    rule=lambda n: verdict(n["P = 0.5 F_d"] < 0.5 < n["P = 2 F_d"]),
    see="fig-2.4 fig-2.5",
)
def sticking_to_slipping(resolution: Resolution) -> Found:
    """Slip fractions at the peaks."""
    facts = []
    for ratio in (0.5, 2.0):
        true, _ = mass(ratio)
        top = int(true.amplitude("mass").argmax())
        facts.append(Fact(f"P = {ratio:g} F_d", float(true.slip_fraction((0, 0))[top])))
    return Found(tuple(facts))


@claim(
    "much-more-accurately",
    "2.5",
    "the force transmitted by the friction dampers is much more accurately represented than in "
    "standard single-harmonic methods",
    """Error of the first harmonic of z over that of the friction law followed through the harmonic
    motion, in the case of Fig. 2.3; much is more than five times.""",
    rule=lambda n: verdict(n["error over error"] > 5.0, n["error over error"] > 1.0),
    see="fig-2.3",
)
def much_more_accurately(resolution: Resolution) -> Found:
    """Ratio of the errors of z."""
    shown = numbers_of("fig-2.3", resolution)
    rough, better = (
        shown.fact(f"largest difference of {name} z") for name in ("Griffin's", "improved")
    )
    return Found((Fact("error over error", rough / better, "times"),))

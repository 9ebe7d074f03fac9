"""Every table with numbers and every figure of results of the dissertation, in its order.

Behind them the directions for future work of section 7.2, for which it has no figures.
"""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["SUBJECTS"]

_BEAM = "SNECMA beam"
_FLUTTER = "over the negative damping ratio"
_PAIR = "two beams with a structure-like damper"

SUBJECTS: Mapping[str, str] = {
    "fig-2.3": "Single DOF: damper displacement over a period, three ways",
    "fig-2.4": "Single DOF, P = 0.5 F_d: mass and damper over frequency",
    "fig-2.5": "Single DOF, P = 2 F_d: mass and damper over frequency",
    "fig-2.6": "Single DOF: response per unit force, levels of force",
    "fig-2.8": f"{_BEAM}, 16.563 N: beam and damper displacement at the damper",
    "fig-2.9": f"{_BEAM}, 16.563 N: tip",
    "table-2.3": f"{_BEAM}: peaks at eight loads, time integration and single harmonic",
    "fig-2.10": f"{_BEAM}: response per unit force at the damper, eight loads, single harmonic",
    "fig-2.11": f"{_BEAM}: response per unit force at the tip, eight loads, single harmonic",
    "fig-4.1": f"{_BEAM}, 20.313 N, 170 rad/s: time histories",
    "fig-4.2": f"{_BEAM}, 25 N, 200 rad/s: time histories",
    "fig-4.3": f"{_BEAM}: response per unit force at the damper, eight loads, 15 harmonics",
    "fig-4.4": f"{_BEAM}: response per unit force at the tip, eight loads, 15 harmonics",
    "fig-4.5": f"{_BEAM}: damper stiffness, at the damper",
    "fig-4.6": f"{_BEAM}: damper stiffness, at the tip",
    "fig-4.7": f"{_BEAM}: stiff dampers, at the damper",
    "fig-4.8": f"{_BEAM}: stiff dampers, at the tip",
    "fig-4.10": "Turbine blade: levels of slip force, at the damper",
    "fig-4.11": "Turbine blade: levels of slip force, at the tip",
    "fig-4.12": "Turbine blade at optimal damping: harmonic balance and time integration, damper",
    "fig-4.13": "Turbine blade at optimal damping: harmonic balance and time integration, tip",
    "table-4.1": "Computing time of harmonic balance and of time integration",
    "fig-4.16": "Tuned ring of 36 beams: beams 13 to 24 at the dampers",
    "fig-4.17": "Tuned ring of 36 beams: beams 13 to 24 at the tips",
    "fig-4.18": "Tuned ring of 36 beams, 220 rad/s: time histories of beams 1 to 6",
    "fig-4.19": "Mistuned ring, 200 rad/s: time histories with 1 and 9 harmonics",
    "fig-4.20": "Mistuned ring: beams 1 to 12 at weak coupling",
    "fig-4.21": "Mistuned ring: beams 1 to 12 at stronger coupling",
    "fig-4.22": "Mistuned ring: magnification factor over the coupling stiffness",
    "fig-5.1": f"Single DOF: limit-cycle amplitude {_FLUTTER}, single harmonic",
    "fig-5.2": f"Single DOF: limit-cycle frequency {_FLUTTER}, single harmonic",
    "fig-5.3": f"Single DOF: limit-cycle amplitude {_FLUTTER}, 1 and 31 harmonics",
    "fig-5.4": f"Single DOF: amplitude {_FLUTTER}, 5 harmonics and time integration",
    "fig-5.5": f"Single DOF: amplitude {_FLUTTER}, sticking branch",
    "fig-5.6": f"Single DOF: frequency {_FLUTTER}, 5 harmonics and time integration",
    "fig-5.7": f"Single DOF: frequency {_FLUTTER}, sticking branch",
    "fig-5.8": "Single DOF: limit-cycle amplitude over the damper stiffness",
    "fig-5.9": "Single DOF: limit-cycle frequency over the damper stiffness",
    "table-5.2": f"{_BEAM}: initial conditions and the modes they lead to",
    "fig-5.10": f"{_BEAM}: limit cycle in mode 1, time histories",
    "fig-5.11": f"{_BEAM}: limit cycle in mode 2, time histories",
    "fig-5.12": f"{_BEAM}: limit cycle in mode 3, time histories",
    "fig-5.13": f"{_BEAM}: amplitude of DOF 1 {_FLUTTER}, three modes",
    "fig-5.14": f"{_BEAM}: amplitude of DOF 2 {_FLUTTER}, three modes",
    "fig-5.15": f"{_BEAM}: amplitude of DOF 3 {_FLUTTER}, three modes",
    "fig-5.16": f"{_BEAM}: frequency {_FLUTTER}, three modes",
    "table-5.3": f"{_BEAM}: slipping and sticking natural frequencies",
    "fig-5.17": f"{_BEAM}: DOF 1, sticking branches and time integration near mode 3",
    "fig-5.18": f"{_BEAM}: DOF 2, sticking branches and time integration near mode 3",
    "fig-5.19": f"{_BEAM}: DOF 3, sticking branches and time integration near mode 3",
    "fig-5.20": f"{_BEAM}: frequency, sticking branches and time integration near mode 3",
    "fig-5.21": f"{_BEAM}, r = 0.361: DOF 1, aperiodic motion beside mode 1",
    "fig-5.22": f"{_BEAM}, r = 0.361: DOF 2, aperiodic motion beside mode 1",
    "fig-5.23": f"{_BEAM}, r = 0.361: DOF 3, aperiodic motion beside mode 1",
    "fig-5.24": f"{_BEAM}, r = 0.361: power spectral density of DOF 3",
    "fig-5.25": f"{_BEAM}, only mode 3 negative: amplitude of DOF 1",
    "fig-5.26": f"{_BEAM}, only mode 3 negative: amplitude of DOF 2",
    "fig-5.27": f"{_BEAM}, only mode 3 negative: amplitude of DOF 3",
    "fig-5.28": f"{_BEAM}, only mode 3 negative: frequency",
    "fig-6.4": f"{_PAIR}, 250 rad/s, 15 N: contact forces",
    "fig-6.5": f"{_PAIR}, 550 rad/s, 35 N: contact forces",
    "fig-6.6": f"{_PAIR}, 550 rad/s, 140 N: contact forces",
    "fig-6.7": f"{_PAIR}, 550 rad/s, 550 N: contact forces",
    "fig-6.8": f"{_PAIR}: contacts 1 and 2 over frequency, 20 to 60 N",
    "fig-6.9": f"{_PAIR}: contacts 1 and 2 over frequency, 70 to 120 N",
    "table-6.4": f"{_PAIR}: natural frequencies by slipping contacts",
    "fig-6.10": f"{_PAIR}: contacts 3 and 4 over frequency, 20 to 60 N",
    "fig-6.11": f"{_PAIR}: contacts 3 and 4 over frequency, 70 to 120 N",
    "7.2-microslip": f"{_BEAM}: microslip, exponential and Iwan, against macroslip",
    "7.2-normal-load": f"{_BEAM}: variable normal load with separation",
    "7.2-two-directions": f"{_BEAM} in two planes: two-dimensional friction",
    "7.2-wedge": "Two beams with a wedge between them",
    "7.2-damper-mass": f"{_BEAM}: mass of the damper up to a tenth of the beam's",
}
"""Subject by name."""

"""Claims of chapter IV: verdicts and numbers."""

NUMBERS: dict[str, tuple[str, dict[str, tuple[float, float]]]] = {
    "few-slipping-blades": ("false", {"slip more than half": (88.889, 1e-2)}),
    "match-almost-perfectly": ("holds", {"difference": (0.086267, 1e-2)}),
    "phase-shift": ("holds", {"phase": (7.3714, 1e-2)}),
    "several-slips": ("holds", {"slips per period": (6, 0)}),
    "slipping-group": (
        "holds",
        {
            "slip fraction": (0.71037, 1e-2),
            "at 31.475 N": (1.0576, 1e-2),
            "at 38.438 N": (1.0192, 1e-2),
            "at 384.38 N": (0.99951, 1e-2),
        },
    ),
    "sticking-group": (
        "holds",
        {
            "slip fraction": (0.30168, 1e-2),
            "at 0.938 N": (0.99972, 1e-2),
            "at 2.188 N": (0.99916, 1e-2),
            "at 6.563 N": (0.98219, 1e-2),
        },
    ),
    "optimal-group": (
        "holds",
        {"best load, damper": (10.128, 1e-2), "best load, tip": (13.803, 1e-2)},
    ),
    "two-optima": (
        "holds with limits",
        {
            "best of eight, tip": (20.313, 1e-2),
            "best load, tip": (13.803, 1e-2),
            "best of eight, damper": (6.563, 1e-2),
            "best load, damper": (10.128, 1e-2),
        },
    ),
    "almost-the-same-amplitude": (
        "holds",
        {"amplitudes": (0.9054, 1e-2), "slip fraction": (0.12972, 1e-2)},
    ),
    "near-optimal-case": ("holds with limits", {"tip": (8.2985, 1e-2), "damper": (73.044, 1e-2)}),
    "almost-identical": ("holds", {"difference": (0.0055522, 1e-2)}),
    "slip-and-stick": ("holds", {"least": (0.30168, 1e-2), "most": (0.36788, 1e-2)}),
    "three-groups-at-the-tip": (
        "holds",
        {"sticking": (3, 0), "between": (3, 0), "slipping": (2, 0)},
    ),
    "soft-damper": (
        "holds",
        {"slip fraction": (0, 1e-9), "largest force over F_d": (0.90161, 1e-2)},
    ),
    "frequency-of-the-beam": (
        "holds with limits",
        {"peak at 2.4e4 N/m": (159.93, 1e-2), "natural frequency": (159.59, 1e-2)},
    ),
    "stiffer-is-lower": (
        "holds",
        {"largest ratio, damper": (0.99618, 1e-2), "largest ratio, tip": (0.99723, 1e-2)},
    ),
    "rigid-damper": ("holds", {"to 2.4e9 N/m": (3.3962, 1e-2), "to 2.4e10 N/m": (0.38234, 1e-2)}),
    "like-the-bare-beam": (
        "holds with limits",
        {
            "curves, 2.4e4": (4.2915, 1e-2),
            "peaks, 2.4e4": (0.1821, 1e-2),
            "curves, 2.4e5": (36.444, 1e-2),
            "peaks, 2.4e5": (1.6969, 1e-2),
        },
    ),
    "more-slip-more-energy": (
        "false",
        {"slip fraction": (0.93609, 1e-2), "energy": (0.56065, 1e-2), "share": (1.228, 1e-2)},
    ),
    "three-groups-of-the-blade": (
        "holds",
        {"slipping": (4, 0), "sticking": (1, 0), "between": (4, 0), "best between": (1, 0)},
    ),
    "like-the-beam": (
        "holds with limits",
        {
            "humps of the blade": (4, 0),
            "humps of the beam": (2, 0),
            "3 ω₁ / ω₂": (1.02, 1e-2),
            "error of one harmonic": (53.276, 1e-2),
        },
    ),
    "fifth-mode": (
        "open",
        {
            "mode 5 over mode 1, stuck": (0.00016479, 1e-2),
            "best over stuck, mode 5": (0.02496, 1e-2),
            "F_d0 of mode 5": (0.0002398, 1e-2),
        },
    ),
    "ten-thousand-cycles": ("holds with limits", {"periods": (3915, 0)}),
    "virtually-identical": (
        "holds",
        {"9 harmonics": (0.42333, 1e-2), "Runge-Kutta": (0.0032039, 1e-2)},
    ),
    "hundreds-of-times": ("holds with limits", {}),
    "slowest-near-optimum": (
        "false",
        {"slowest load": (38.438, 1e-2), "20.313 N over the slowest": (0.72512, 1e-2)},
    ),
    "even-with-21-harmonics": ("holds", {}),
    "identical-beams": (
        "holds",
        {
            "between beams, damper": (0, 1e-9),
            "to one blade, damper": (0, 1e-9),
            "between beams, tip": (0, 1e-9),
            "to one blade, tip": (0, 1e-9),
        },
    ),
    "twenty-degrees": ("holds", {"beams": (0, 1e-9), "dampers": (0.0024896, 1e-2)}),
    "seven-percent": (
        "false",
        {"of the frequencies": (3.3646, 1e-2), "of the stiffness": (7.3368, 1e-2)},
    ),
    "fair-approximation": (
        "holds with limits",
        {"largest error": (45.215, 1e-2), "median error": (9.0864, 1e-2)},
    ),
    "nine-harmonics": (
        "holds with limits",
        {"largest error": (8.9427, 1e-2), "median error": (1.6779, 1e-2)},
    ),
    "one-harmonic-is-section-2-4": ("holds", {"largest difference": (0, 1e-9)}),
    "unknowns": ("holds", {"equations": (2052, 0), "non-linear": (684, 0)}),
    "no-convergence-problems": ("holds", {"unsolved": (0, 1e-9), "points": (5319, 0)}),
    "orders-faster": ("holds with limits", {}),
    "several-phases-per-cycle": (
        "holds",
        {"most slips per period": (6, 0), "dampers with more than two": (24, 0)},
    ),
    "similar-at-the-ends": (
        "holds",
        {
            "1000 N/m": (1.482, 1e-2),
            "100000 N/m": (1.2419, 1e-2),
            "largest between": (3.4615, 1e-2),
        },
    ),
    "two-kinds-of-resonance": (
        "holds with limits",
        {
            "highest over lowest frequency": (1.2783, 1e-2),
            "largest slip fraction": (0.62035, 1e-2),
            "smallest slip fraction": (0.45806, 1e-2),
        },
    ),
    "factor-five": ("holds with limits", {"least": (3.1659, 1e-2), "most": (4.0238, 1e-2)}),
    "beams-13-to-36": ("holds", {"distance from 1": (0.046451, 1e-2)}),
    "ring-subresonances": ("holds with limits", {"3 harmonics": (2, 0), "1 harmonic": (3, 0)}),
    "stronger-at-the-dampers": ("holds", {"patterns": (8, 0), "couplings and patterns": (100, 0)}),
    "intermediate-coupling": (
        "holds",
        {"least": (5000, 0), "median": (5000, 0), "most": (6000, 0)},
    ),
    "harmonics-and-localization": ("holds", {"H = 1": (6.6081, 1e-2), "H = 3": (7.9907, 1e-2)}),
}

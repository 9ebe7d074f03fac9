"""Claims of chapter V: verdicts and numbers."""

NUMBERS: dict[str, tuple[str, dict[str, tuple[float, float]]]] = {
    "some-slipping": ("holds", {"smallest slip fraction": (0.015178, 1e-2)}),
    "no-motion-beyond": (
        "holds",
        {"r_max, exact": (5.148, 1e-2), "beyond, unbounded": (7, 0), "before, unbounded": (3, 0)},
    ),
    "two-amplitudes": ("holds", {"least": (2, 0), "most": (2, 0)}),
    "cannot-predict-stability": ("false", {"right": (100, 0)}),
    "high-branch-decides": (
        "holds with limits",
        {"f(0) = 0": (78.571, 1e-2), "f(0) = F_d": (100, 0)},
    ),
    "between-the-frequencies": (
        "holds",
        {"least over ω_min": (1, 1e-2), "largest over ω_max": (0.99999, 1e-2)},
    ),
    "limits-of-frequency": ("holds", {"slipping": (1, 1e-2), "sticking": (0.99999, 1e-2)}),
    "chosen-alike": (
        "holds with limits",
        {"sticking": (0.10642, 1e-2), "slipping": (0.12226, 1e-2)},
    ),
    "lower-sticks-higher-slips": (
        "holds",
        {
            "lower, all ratios": (0.49504, 1e-2),
            "higher, all ratios": (0.6047, 1e-2),
            "lower, r ≤ 1": (0.15899, 1e-2),
            "higher, r ≤ 1": (0.86989, 1e-2),
        },
    ),
    "stable-and-unstable": (
        "holds",
        {
            "sticking": (0.70629, 1e-2),
            "slipping": (1.0161, 1e-2),
            "sticking over slipping frequency": (1.0778, 1e-2),
        },
    ),
    "slip-and-stiction": ("holds", {"least": (0.015179, 1e-2), "most": (0.98724, 1e-2)}),
    "number-of-harmonics": ("holds", {"difference of r_max": (0.10757, 1e-2)}),
    "mono-harmonic": ("holds", {"third over first": (0.92357, 1e-2)}),
    "good-agreement": (
        "holds",
        {"amplitude": (0.011183, 1e-2), "frequency": (0.0031977, 1e-2), "sticking": (7, 0)},
    ),
    "too-soft": ("holds", {"smallest ν": (0.16711, 1e-2)}),
    "unique-solution": ("holds with limits", {"they meet at ν": (0.16711, 1e-2)}),
    "soft-frequency": ("false", {"place between ω_min and ω_max": (0.49243, 1e-2)}),
    "two-rigid-solutions": (
        "holds",
        {"sticking, ratio": (0.0098776, 1e-2), "slipping, change": (0.43296, 1e-2)},
    ),
    "rigid-values": (
        "false",
        {"A of (5.20)": (0.00025528, 1e-2), "A, exact": (0.00025533, 1e-2), "ω_min": (159.4, 1e-2)},
    ),
    "softer-slips-less": (
        "holds with limits",
        {"steps on the sticking side": (0, 1e-9), "steps on the slipping side": (4, 0)},
    ),
    "narrower-range": ("holds", {"ν = 0.2": (0.11815, 1e-2), "ν = 0.5": (0.50631, 1e-2)}),
    "trivial-solution": (
        "false",
        {"A = 0": (1, 0), "A of (5.20)": (2, 0), "A with a minus": (0, 1e-9)},
    ),
    "cannot-be-reduced": ("false", {"largest difference": (0, 1e-9)}),
    "all-its-modes": ("holds", {"f(0) zero": (3, 0), "f(0) pulled": (3, 0)}),
    "starts-of-table-5-2": (
        "holds with limits",
        {"all settle in their modes": (1, 0), "all are about their modes": (6, 0)},
    ),
    "limit-of-every-mode": (
        "holds",
        {"mode 1": (5.169, 1e-2), "mode 2": (14.469, 1e-2), "mode 3": (6.3604, 1e-2)},
    ),
    "two-branches-per-mode": (
        "holds",
        {
            "cycles per mode": (2, 0),
            "higher branch": (0.85359, 1e-2),
            "lower branch": (0.32203, 1e-2),
        },
    ),
    "frequencies-of-table-5-3": (
        "holds with limits",
        {"to the natural ones": (0.0015097, 1e-2), "to the printed ones": (0.1212, 1e-2)},
    ),
    "frequencies-in-order": (
        "holds",
        {"sticking over slipping": (1.3952, 1e-2), "over the mode below": (1.5674, 1e-2)},
    ),
    "almost-linear": (
        "holds",
        {
            "sticking": (0.049267, 1e-2),
            "slipping": (0.98541, 1e-2),
            "difference from a harmonic": (0.321, 1e-2),
        },
    ),
    "higher-modes-higher-damping": (
        "holds",
        {
            "rate, 2": (6.6677, 1e-2),
            "rate, 3": (32.465, 1e-2),
            "ratio, 2": (1.0714, 1e-2),
            "ratio, 3": (2.2378, 1e-2),
        },
    ),
    "mode-3-stable-between": (
        "false",
        {"stable from": (0.01, 1e-2), "stable up to": (4.6863, 1e-2)},
    ),
    "one-unstable-mode": ("holds", {"unbounded": (12, 0), "starts": (12, 0)}),
    "mode-1-ends-at-4-9": (
        "false",
        {
            "fold, H = 3": (5.2878, 1e-2),
            "fold, H = 5": (4.555, 1e-2),
            "fold, H = 9": (5.0072, 1e-2),
            "fold, H = 15": (4.9104, 1e-2),
            "fold, H = 63": (4.8779, 1e-2),
            "fold, exact": (4.878, 1e-2),
            "last fold, H = 3": (5.2878, 1e-2),
            "r_max, exact": (5.169, 1e-2),
        },
    ),
    "highest-mode": (
        "holds with limits",
        {
            "all ratios": (56.061, 1e-2),
            "ratios up to 1": (33.333, 1e-2),
            "ratios of 2.5 and more": (100, 0),
        },
    ),
    # A motion that rounding leads elsewhere: of three periods alone 12 to 20 % (x₁).
    "almost-mode-1": ("holds", {"x₁": (15.8, 3e-2), "x₂": (1.63, 3e-2), "x₃": (15.5, 3e-2)}),
    "around-35-hz": ("holds", {"share of the power": (97.47, 1e-2)}),
    "three-small-lines": (
        "holds",
        {"5th harmonic": (179.45, 1e-2), "mode 2": (221.66, 1e-2), "7th harmonic": (251.23, 1e-2)},
    ),
    "no-such-components": (
        "false",
        {"5th harmonic": (4.1368, 1e-2), "7th harmonic": (8.4493, 1e-2)},
    ),
    "friction-forces-of-starts": ("holds with limits", {"changed": (2, 0), "starts": (33, 0)}),
    "higher-modes-less-stable": ("false", {"r_max, 2": (2.7991, 1e-2), "r_max, 3": (1.2305, 1e-2)}),
    "most-times-mode-3": ("holds", {"unsigned starts": (100, 0), "signed starts": (100, 0)}),
    "fails-at-low-damping": (
        "holds with limits",
        {"unsigned starts": (100, 0), "signed starts": (0, 1e-9)},
    ),
    "no-stable-motion": (
        "holds with limits",
        {"unbounded": (48, 0), "starts": (48, 0), "mode 3 stable up to r": (4.6863, 1e-2)},
    ),
    "no-improvement": (
        "holds",
        {
            "after 300 periods": (1.2007, 5e-2),
            "after 4000 periods": (1.1974, 5e-2),
            "multiplier": (1.1686, 1e-2),
        },
    ),
    "nodes-at-the-damper": (
        "holds",
        {"change of the frequency": (0, 1e-9), "growth": (2.9745, 1e-2)},
    ),
    "orthogonal-modes": ("false", {"largest entry": (0.75841, 1e-2)}),
    "modal-coefficients": (
        "holds with limits",
        {"c_1": (12.095, 1e-2), "c_2": (27.627, 1e-2), "c_3": (5.7892, 1e-2)},
    ),
    "only-the-third-mode": ("holds", {"elsewhere": (0, 1e-9), "starts": (12, 0)}),
    "upper-branch-decides": (
        "false",
        {
            "0.98, f(0) = F_d": (66.667, 1e-2),
            "1.02, f(0) = F_d": (50, 0),
            "0.98, f(0) = 0": (100, 0),
            "1.02, f(0) = 0": (16.667, 1e-2),
        },
    ),
    "unique": ("false", {"cycles per ratio": (2, 0)}),
    "stability-as-one-mass": (
        "holds",
        {
            "sticking, stable": (100, 0),
            "slipping, stable": (0, 1e-9),
            "stable up to r_max": (100, 1e-2),
        },
    ),
    "like-one-mass": (
        "holds",
        {
            "upper over lower": (1.4072, 1e-2),
            "upper slips": (0.5609, 1e-2),
            "lower slips": (0.44455, 1e-2),
        },
    ),
    "both-branches-found": ("holds", {"amplitudes": (0.022929, 1e-2), "r_max": (0.00086919, 1e-2)}),
    "transition-matrix": (
        "false",
        {"as printed": (0.98136, 1e-2), "inverse transposes": (0, 1e-9)},
    ),
    "several-modes": ("holds", {"aperiodic": (30.303, 1e-2)}),
    "not-unique": ("holds", {"all modes": (6, 0), "mode 3 alone": (2, 0)}),
}

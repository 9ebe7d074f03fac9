"""Claims of chapter VI: verdicts and numbers."""

NUMBERS: dict[str, tuple[str, dict[str, tuple[float, float]]]] = {
    "property-1": (
        "holds with limits",
        {"with slip": (0.9996, 1e-2), "without slip": (0.58932, 1e-2)},
    ),
    "failure-by-overshooting": (
        "holds with limits",
        {"without (6.21)": (27, 0), "with (6.21)": (29, 4e-2), "return map": (31, 0)},
    ),
    "elementary-is-structure-like": ("holds", {"F₂ = ∞": (0, 1e-9), "F₂ = 1.5 F₁": (0, 1e-9)}),
    "printed-increment": ("false", {"(6.10) over (6.9)": (24000000.0, 1e-2)}),
    "property-2": ("holds", {"largest sum": (0, 1e-9)}),
    "not-all-at-once": ("holds", {"as printed": (3, 0), "F₄ = 300 N": (3, 0)}),
    "overshooting": (
        "false",
        {
            "64 samples": (187.52, 1e-2),
            "64 samples, first period": (1257.7, 1e-2),
            "64 samples, without (6.21)": (1257.7, 1e-2),
            "1024 samples": (6.1005, 1e-2),
            "1024 samples, first period": (72.485, 1e-2),
            "1024 samples, without (6.21)": (72.485, 1e-2),
        },
    ),
    "sum-of-overshooting": ("false", {"largest sum": (0, 1e-9)}),
    "offset-by-overshooting": (
        "holds",
        {"without (6.21)": (48.504, 1e-2), "with (6.21)": (0, 1e-9)},
    ),
    "singular-stiffness": ("holds", {"D": (0, 1e-9), "submatrices": (0.015819, 1e-2)}),
    "true-solution-is-reached": ("false", {"by Procedure 2": (46.17, 1e-2), "exact": (0, 1e-9)}),
    "no-exact-start": ("false", {"distance from the opposite": (0, 1e-9)}),
    "mere-stiffness": ("holds", {"largest difference": (0, 1e-9)}),
    "non-smooth": (
        "holds",
        {"jump": (0.48287, 1e-2), "jump if stuck": (0.049085, 1e-2), "contact 2 slips": (0, 1e-9)},
    ),
    "offset-forces": ("false", {"f₃": (0, 1e-9), "f₄": (0, 1e-9)}),
    "two-at-once": ("false", {"slip at once": (1, 0), "share of the limit": (0.74934, 1e-2)}),
    "greater-than-stuck": (
        "holds with limits",
        {"of one that slips": (0.77471, 1e-2), "of any": (1.8554, 1e-2)},
    ),
    "never-with-elementary": ("holds", {"largest ratio": (0.99948, 1e-2)}),
    "three-at-once": ("holds", {"slip at once": (3, 0), "largest change": (0, 1e-9)}),
    "force-4-non-smooth": (
        "holds with limits",
        {"jump": (0.12265, 1e-2), "jump if stuck": (0.049071, 1e-2)},
    ),
    "like-an-elementary-damper": (
        "holds with limits",
        {
            "share at the limit": (0.43359, 1e-2),
            "largest over the limit": (1, 0),
            "turns": (10, 0),
            "turns of the elementary damper": (2, 0),
        },
    ),
    "linear-at-20-n": (
        "holds with limits",
        {
            "slip fraction": (0, 1e-9),
            "peaks at 1 and 2": (0.33512, 1e-2),
            "peaks at 3 and 4": (23.453, 1e-2),
        },
    ),
    "increasingly-different": (
        "holds",
        {
            "1 and 2, 20 N": (2.9519, 1e-2),
            "1 and 2, 40 N": (10.469, 1e-2),
            "1 and 2, 60 N": (20.477, 1e-2),
            "3 and 4, 20 N": (42.51, 1e-2),
            "3 and 4, 40 N": (49.389, 1e-2),
            "3 and 4, 60 N": (56.168, 1e-2),
        },
    ),
    "more-dampers-slip": ("false", {"contacts that slip": (1, 0)}),
    "continuum": (
        "false",
        {
            "of all configurations": (7, 0),
            "of those that occur": (2, 0),
            "variation": (21.277, 1e-2),
        },
    ),
    "interesting-range": (
        "false",
        {
            "frequency of the maximum": (717, 0),
            "maximum": (0.00016196, 1e-2),
            "maximum from 500 to 700 rad/s": (0.0001083, 1e-2),
            "natural frequency, contact 1 slipping": (715.14, 1e-2),
            "contacts that slip beyond 700 rad/s": (3, 0),
            "contacts that slip from 500 to 700 rad/s": (1, 0),
        },
    ),
    "independent-beams": ("false", {"frequency": (547.54, 1e-2), "distance": (354.22, 1e-2)}),
    "antisymmetric-steepness": (
        "holds with limits",
        {
            "60 N, in opposition": (76.776, 1e-2),
            "1 N, in opposition": (39.511, 1e-2),
            "60 N, in phase": (12.364, 1e-2),
            "1 N, in phase": (38.622, 1e-2),
        },
    ),
    "two-linked-beams": (
        "holds",
        {
            "in opposition over in phase": (1.277, 1e-2),
            "slope, in opposition": (88.771, 1e-2),
            "slope, in phase": (69.515, 1e-2),
        },
    ),
    "drastic-at-3-and-4": (
        "holds with limits",
        {"slip at 30 N": (0.42465, 1e-2), "30 N": (17.734, 1e-2), "60 N": (45.693, 1e-2)},
    ),
}

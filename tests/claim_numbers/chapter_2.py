"""Claims of chapter II: verdicts and numbers."""

NUMBERS: dict[str, tuple[str, dict[str, tuple[float, float]]]] = {
    "two-lines-of-the-law": ("holds with limits", {"moving on": (0, 1e-9), "moving back": (2, 0)}),
    "coefficient-a": (
        "false",
        {"a as printed": (0.31634, 1e-2), "a with a minus": (0, 1e-9), "b as printed": (0, 1e-9)},
    ),
    "griffins-damper": ("holds", {"largest difference": (18.756, 1e-2)}),
    "improved-damper": ("holds", {"largest difference": (1.1724, 1e-2)}),
    "single-dof-agreement": (
        "holds with limits",
        {
            "largest error of a peak": (0.12548, 1e-2),
            "largest difference on the curves": (33.991, 1e-2),
        },
    ),
    "no-subresonances": ("holds", {"of exact orbits": (4, 0), "of one harmonic": (0, 1e-9)}),
    "plateau": ("holds", {"largest distance": (0, 1e-9), "frequencies with slip": (308, 0)}),
    "single-dof-optimum": ("holds", {"best P / F_d": (0.75101, 1e-2)}),
    "hundreds-of-cycles": ("false", {"periods to 1e-3": (19, 0), "periods to 1e-6": (40, 0)}),
    "orders-of-magnitude": ("holds with limits", {}),
    "sticking-to-slipping": (
        "holds",
        {"P = 0.5 F_d": (0.38822, 1e-2), "P = 2 F_d": (0.83923, 1e-2)},
    ),
    "one-equation": ("holds", {"largest difference": (0, 1e-9)}),
    "phase-of-the-beam": (
        "holds with limits",
        {"(2.30)": (0, 1e-9), "(2.31)": (1.997, 1e-2), "(2.31) with a minus": (0, 1e-9)},
    ),
    "tip-less-exact": (
        "holds",
        {"loads where the tip is worse": (7, 0), "loads that differ": (7, 0)},
    ),
    "amplified-along-the-beam": (
        "holds with limits",
        {
            "smallest share at the tip over that at the damper": (0.029289, 1e-2),
            "largest share at the tip over that at the damper": (0.2565, 1e-2),
            "smallest size at the tip over that at the damper": (1.886, 1e-2),
        },
    ),
    "error-of-the-tip": ("false", {"largest error": (20.869, 1e-2)}),
    "near-optimal-damping": (
        "false",
        {
            "tip, named loads": (6.1902, 1e-2),
            "tip, best load": (16.358, 1e-2),
            "damper, named loads": (6.4384, 1e-2),
            "damper, best load": (12.129, 1e-2),
        },
    ),
    "optimum-at-the-damper": (
        "holds with limits",
        {"at 6.563 N": (6.7678, 1e-2), "at 16.563 N": (25.681, 1e-2), "best load": (10.128, 1e-2)},
    ),
    "optimum-at-the-tip": (
        "holds with limits",
        {
            "at 16.563 N": (9.4461, 1e-2),
            "at 20.313 N": (6.6342, 1e-2),
            "at 25 N": (8.2985, 1e-2),
            "best load": (13.803, 1e-2),
        },
    ),
    "different-optima": ("holds", {"tip": (13.803, 1e-2), "damper": (10.128, 1e-2)}),
    "no-subresonances-of-the-beam": (
        "holds with limits",
        {
            "exact orbits, 16.563 N": (0, 1e-9),
            "one harmonic, 16.563 N": (0, 1e-9),
            "exact orbits, 38.438 N": (1, 0),
            "one harmonic, 38.438 N": (0, 1e-9),
        },
    ),
    "real-amplitudes": ("false", {"largest ratio of amplitudes": (8.7532, 1e-2)}),
    "fast-results": ("holds", {"unknowns": (72, 0)}),
    "virtually-perfect": ("holds with limits", {"largest distance over the peak": (3.7319, 1e-2)}),
    "much-more-accurately": ("holds", {"error over error": (15.998, 1e-2)}),
    "less-than-7-percent": (
        "holds with limits",
        {
            "beam, named loads": (6.4384, 1e-2),
            "beam, tip, best load": (16.358, 1e-2),
            "beam, damper, best load": (12.129, 1e-2),
            "blade, tip": (53.276, 1e-2),
        },
    ),
    "initial-guess": ("holds with limits", {"converged": (31, 0), "runs": (32, 0)}),
    "acceptable-at-the-damper": (
        "holds with limits",
        {"eight loads": (6.4384, 1e-2), "best load": (12.129, 1e-2)},
    ),
}

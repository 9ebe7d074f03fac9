"""Claims of chapter VII: verdicts and numbers."""

NUMBERS: dict[str, tuple[str, dict[str, tuple[float, float]]]] = {
    "third-approach": ("holds", {"largest difference": (0.047671, 1e-2)}),
}

"""Labels of Matplotlib figures as plotly reads them: escaped, with indices and Greek letters."""

from __future__ import annotations

import re
from html import escape

__all__ = ["label", "plain"]

_MATH = re.compile(r"(?<!\\)\$([^$]+)\$")
_SHIFT = re.compile(r"([_^])(?:\{([^{}]*)\}|(\w))")
_COMMAND = re.compile(r"\\([A-Za-z]+) ?")
_TAGS = {"_": "sub", "^": "sup"}
_LETTERS = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "zeta": "ζ",
    "eta": "η",
    "theta": "θ",
    "lambda": "λ",
    "mu": "µ",
    "pi": "π",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "phi": "φ",
    "psi": "ψ",
    "omega": "ω",
    "Delta": "Δ",
    "Omega": "Ω",
    "Phi": "Φ",
    "cdot": "·",
    "times": "×",
    "pm": "±",
    "leq": "≤",
    "geq": "≥",
    "infty": "∞",
}


def label(text: str) -> str:
    """Return a text that plotly shows as Matplotlib would have.

    Parameters
    ----------
    text : str
        Plain text, with formulas such as ``$F_d$``; names of anything may stand in it.

    Returns
    -------
    str
        With everything that plotly would take for a tag escaped.
    """
    return _MATH.sub(lambda found: _formula(found[1]), escape(text, quote=False))


def plain(text: str) -> str:
    """Return a text without formulas, for attributes that are read aloud."""
    return _MATH.sub(lambda found: re.sub(r"[\\{}_]", "", found[1]), text)


def _formula(text: str) -> str:
    def shifted(found: re.Match[str]) -> str:
        tag = _TAGS[found[1]]
        return f"<{tag}>{found[2] or found[3]}</{tag}>"

    letters = _COMMAND.sub(lambda found: _LETTERS.get(found[1], found[1]), text)
    return _SHIFT.sub(shifted, letters)

"""Build hook: writes formulas as MathML, so that the pages need no script and no network."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert

# What pymdownx.arithmatex makes of $...$ and $$...$$.
_FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">\\[(\[](?P<latex>.*?)\\[)\]]</(?P=tag)>', re.DOTALL
)


def on_page_content(content: str, **_: object) -> str:
    """Replace every formula of a page."""
    return _FORMULA.sub(_mathml, content)


def _mathml(formula: re.Match[str]) -> str:
    block = formula["tag"] == "div"
    mathml = convert(html.unescape(formula["latex"]), display="block" if block else "inline")
    return f'<div class="formula">{mathml}</div>' if block else mathml

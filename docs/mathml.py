"""Markdown extension: formulas as MathML, so that the pages need no script and no network."""

from __future__ import annotations

import html
import re
from typing import Any

from latex2mathml.converter import convert
from markdown import Markdown
from markdown.extensions import Extension
from markdown.postprocessors import Postprocessor

# What pymdownx.arithmatex makes of $...$ and $$...$$.
_FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">\\[(\[](?P<latex>.*?)\\[)\]]</(?P=tag)>', re.DOTALL
)


class Formulas(Postprocessor):
    """Replaces every formula of a page."""

    def run(self, text: str) -> str:
        """Return the page with MathML."""
        return _FORMULA.sub(_mathml, text)


class MathMl(Extension):
    """The extension, after all that restores HTML."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Add what replaces the formulas."""
        md.postprocessors.register(Formulas(md), "mathml", 0)


def makeExtension(**options: Any) -> MathMl:
    """Return the extension, as Python-Markdown asks for it."""
    return MathMl(**options)


def _mathml(formula: re.Match[str]) -> str:
    block = formula["tag"] == "div"
    mathml = convert(html.unescape(formula["latex"]), display="block" if block else "inline")
    return f'<div class="formula">{mathml}</div>' if block else mathml

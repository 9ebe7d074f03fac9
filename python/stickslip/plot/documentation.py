"""What the documentation of all figures has in common, written once."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import TypeVar

__all__ = ["figure"]

_Figure = TypeVar("_Figure", bound=Callable[..., object])
_SECTION = re.compile(r"^(Parameters|Returns|Raises)\n-+\n", re.M)

_MEANINGS = {
    "result": "What is drawn.",
    "results": "One or several of the same parameter, a line each.",
    "dof": "An observed degree of freedom.",
    "contact": "The contact.",
    "index": "Position of a solved point of the sweep; see `ForcedResponse.index`.",
    "ax": "Where to draw. Default: a new figure.",
    "measure": "Measure of the amplitude.",
    "normalise": "Divide amplitudes by the largest force amplitude.",
    "omega_unit": "Unit of frequencies.",
    "length_unit": "Unit of displacements.",
    "log": "Logarithmic amplitude axis.",
    "labels": "One per result. Default: what distinguishes them.",
    "samples": "Instants per period.",
    "last": "How many of the last periods to draw. Default: all that are kept.",
    "table": "What `BladedDisk.nodal_diameters` returned, or the disk.",
    "slipping": "Draw the frequencies with slipping contacts too.",
    "percentile": "Percentile that is marked.",
    "confidence": "Probability with which the interval is to hold the true percentile.",
}
_KINDS = {
    "Axes": "matplotlib.axes.Axes",
    "ContactRef": "int or str",
    "LengthUnit": '{"m", "mm", "um"}',
    "Measure": '{"half_range", "max", "fundamental"}',
    "OmegaUnit": '{"rad/s", "Hz"}',
    "PointRef": "int, str or (int or str, int)",
    "Literal['force']": '{"force"}',
}
_RETURNED = "matplotlib.axes.Axes\n    The axes."
_RAISED = """ModelError
    If an argument is of the wrong type, unknown, or has nothing to draw."""


def figure(function: _Figure) -> _Figure:
    """Complete what is said of a function by what is said of parameters that many have.

    A section "Parameters" of its own is for the others, and for those that mean more here.
    """
    if function.__doc__ is None:  # python -OO
        return function
    head, *parts = _SECTION.split(inspect.cleandoc(function.__doc__))
    sections = dict(zip(parts[::2], map(str.strip, parts[1::2]), strict=True))
    own = {
        name: block
        for block in re.split(r"\n(?=\S)", sections.get("Parameters", ""))
        if block
        for name in block.splitlines()[0].partition(" : ")[0].split(", ")
    }
    parameters = inspect.signature(function).parameters
    blocks = (own[name] if name in own else _common(one) for name, one in parameters.items())
    sections["Parameters"] = "\n".join(dict.fromkeys(blocks))
    sections = {"Parameters": "", "Returns": _RETURNED, "Raises": _RAISED} | sections
    written = (f"{name}\n{'-' * len(name)}\n{text}" for name, text in sections.items())
    function.__doc__ = "\n\n".join((head.strip(), *written))
    return function


def _common(one: inspect.Parameter) -> str:
    """Return what is said of a parameter that many have, its type as numpydoc writes it."""
    kinds = [kind for kind in one.annotation.split(" | ") if kind != "None"]
    words = (re.sub(r"^Sequence\[(.*)\]$", r"sequence of \1", kind) for kind in kinds)
    kind = " or ".join(_KINDS.get(word, word) for word in words)
    optional = "" if one.default is one.empty else ", optional"
    return f"{one.name} : {kind}{optional}\n    {_MEANINGS[one.name]}"

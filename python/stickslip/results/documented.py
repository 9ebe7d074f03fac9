"""What results say of themselves: what their methods have in common is written once.

`help` and the pages show it in full: a method has its own sentences, those of the method that it
overrides, and for each parameter in the table below what it means and how it is refused. A last
sentence "Raises ModelError if ..." becomes a section, as does the shape of a returned array.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import Field, dataclass
from functools import cached_property
from inspect import CO_VARARGS, CO_VARKEYWORDS
from types import FunctionType
from typing import TYPE_CHECKING, Any, ClassVar, dataclass_transform

from stickslip.numpydoc import entries, sections, written

_VALUE = (
    "deviation, coupling : float, optional\n"
    "    One of the values of the study. Default: the only one."
)
_PARAMETERS: Mapping[str, tuple[str, str]] = {
    "dof": ("dof : str\n    An observed degree of freedom.", "observed degree of freedom"),
    "dof: SectorDof": (
        'dof : str\n    Degree of freedom of a sector, without the number of the sector: "tip".',
        "degree of freedom of a sector",
    ),
    "measure": (
        'measure : {"half_range", "max", "fundamental"}, optional\n'
        "    Half the peak-to-peak range over a period, the largest |x|, or |X_1|.",
        "measure",
    ),
    "contact": (
        "contact : int, str or (int or str, int)\n    The contact, or one of its points.",
        "contact",
    ),
    "contact: PointRef | None": (
        "contact : int, str or (int or str, int), optional\n"
        "    The contact, or one of its points. Default: all.",
        "contact",
    ),
    "contact: ContactRef": ("contact : int or str\n    The contact.", "contact"),
    "index": (
        "index : int\n    Position of the motion; negative ones count from the end.",
        "motion",
    ),
    "samples": ("samples : int, optional\n    Instants t = j T / samples, j = 0, 1, ...", ""),
    "deviation": (_VALUE, "value, or there are several and none is given"),
    "coupling": (_VALUE, ""),
    "confidence": (
        "confidence : float, optional\n"
        "    Probability with which an interval is to hold the true value.",
        "",
    ),
    "ax": ("ax : matplotlib.axes.Axes, optional\n    Where to draw. Default: a new figure.", ""),
    "options": ("**options\n    Those of the function of `stickslip.plot`.", ""),
}
"""What parameters mean, and what a refused value is none of."""

_ARRAYS = {"Float": "float64", "Complex": "complex128", "Int": "int64"}
_ORDER = ("", "Parameters", "Attributes", "Returns", "Raises", "Warns", "References")


@dataclass_transform(eq_default=False, frozen_default=True, kw_only_default=True)
class Frozen:
    """Base of immutable classes, whose documentation is completed."""

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __init_subclass__(cls) -> None:
        dataclass(frozen=True, eq=False, repr=False, kw_only=True)(cls)
        for name, value in vars(cls).items():
            if isinstance(value, FunctionType) and value.__doc__ and not name.startswith("_"):
                value.__doc__ = _of_method(value, getattr(super(cls, cls), name, None))
            elif isinstance(value, property | cached_property) and value.__doc__:
                value.__doc__ = _written(_sections(value.__doc__))
        if cls.__doc__:
            cls.__doc__ = _of_class(cls)


def _of_method(function: FunctionType, overridden: object) -> str:
    parts = _sections(overridden.__doc__) if overridden is not None else {}
    inherited = entries(parts.pop("Parameters", ""))
    parts |= _sections(function.__doc__)
    own = entries(parts.get("Parameters", ""))
    common = {name: _common(name, function) for name in _arguments(function)}
    known = {name: said for name, (said, _) in common.items()} | inherited | own
    # Entries of several names count once.
    blocks = dict.fromkeys(known[name] for name in common if known[name])
    parts["Parameters"] = "\n".join(blocks)
    refused = [
        kind if known[name] == said else kind.removeprefix("observed ")
        for name, (said, kind) in common.items()
        if kind
    ]
    if refused:
        listed = " or ".join(filter(None, [", ".join(refused[:-1]), refused[-1]]))
        sentence = f"    If there is no such {listed}."
        others = parts.get("Raises", "").splitlines()[1:]
        parts["Raises"] = "\n".join(dict.fromkeys(["ModelError", sentence, *others]))
    array = _ARRAYS.get(function.__annotations__.get("return", ""))
    shape = re.search(r", shape (.+)\.(\n|$)", parts[""])
    if array and shape:
        parts["Returns"] = f"ndarray of {array}, shape {shape[1]}"
    return _written(parts)


def _of_class(cls: type) -> str:
    """Add the attributes of the bases, with the types that they have here."""
    parts = _sections(cls.__doc__)
    known: dict[str, str] = {}
    for base in reversed(cls.__mro__[1:]):
        known |= entries(_sections(base.__doc__).get("Attributes", ""))
    for name, kind in cls.__annotations__.items():
        if name in known:
            known[name] = re.sub(r" : .*", f" : {kind}", known[name], count=1)
    known |= entries(parts.get("Attributes", ""))
    return _written(parts | {"Attributes": "\n".join(dict.fromkeys(known.values()))})


def _common(name: str, function: FunctionType) -> tuple[str, str]:
    kind = function.__annotations__.get(name)
    return _PARAMETERS.get(f"{name}: {kind}") or _PARAMETERS.get(name, ("", ""))


def _arguments(function: FunctionType) -> tuple[str, ...]:
    code = function.__code__
    count = code.co_argcount + code.co_kwonlyargcount
    count += bool(code.co_flags & CO_VARARGS) + bool(code.co_flags & CO_VARKEYWORDS)
    return code.co_varnames[1:count]


def _sections(text: str | None) -> dict[str, str]:
    """Return the sections of a documentation, with the one that a last sentence stands for."""
    parts = sections(text)
    parts[""], _, refused = parts[""].partition("\n\nRaises ModelError ")
    if refused:
        told = f"{refused[0].upper()}{refused[1:]}".replace("\n", "\n    ")
        parts["Raises"] = f"ModelError\n    {told}"
    return parts


def _written(parts: Mapping[str, str]) -> str:
    return written({name: parts.get(name, "") for name in _ORDER})

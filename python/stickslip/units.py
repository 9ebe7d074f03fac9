"""Units at the door: the one place where a text such as ``"20.3 N"`` becomes a number in SI."""

from __future__ import annotations

import math
import re
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.checks import brief, real_number, vanished
from stickslip.errors import EntryError, ModelError

if TYPE_CHECKING:
    from pint import UnitRegistry

# Angles carry a dimension of their own. In pint's stock registry the radian is a pure number: there
# "25 Hz" silently becomes 25 rad/s and "5 %" a phase of 0.05 rad. Here a hertz is a turn per second
# and what is not an angle is refused. The short list also loads 15 times faster than the stock one.
_DEFINITIONS = f"""
nano- = 1e-9 = n-
micro- = 1e-6 = µ- = μ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
deci- = 1e-1 = d-
deca- = 10 = da-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
metre = [length] = m = meter
second = [time] = s = sec
kilogram = [mass] = kg
radian = [angle] = rad
gram = 1e-3 * kilogram = g
tonne = 1e3 * kilogram = t
inch = 0.0254 * metre = in
foot = 0.3048 * metre = ft
pound = 0.45359237 * kilogram = lb
minute = 60 * second = min
percent = 0.01 = %
degree = {math.pi / 180!r} * radian = deg = °
revolution = {2 * math.pi!r} * radian = rev = turn
hertz = revolution / second = Hz
revolution_per_minute = revolution / minute = rpm
newton = kilogram * metre / second ** 2 = N
kilogram_force = 9.80665 * newton = kgf
pound_force = 4.4482216152605 * newton = lbf
joule = newton * metre = J
pascal = newton / metre ** 2 = Pa
bar = 1e5 * pascal
"""

_KINDS = {
    "N": ("a force", "20.3 N"),
    "N/m": ("a stiffness", "24 kN/mm"),
    "rad/s": ("a frequency", "25 Hz"),
    "rad": ("an angle", "90 deg"),
    "": ("a ratio", "0.5 %"),
    "m": ("a length", "10 um"),
    "s": ("a time", "2.6e-5 s"),
    "1/s": ("a rate", "7.49 1/s"),
    "deg": ("an angle", "30 deg"),
    "kg": ("a mass", "12 g"),
    "kg/s": ("a damping", "7.5 N s/m"),
    "kg*m^2": ("a moment of inertia", "3 kg mm^2"),
    "kg/m^3": ("a density", "7.85 g/cm^3"),
    "m/s": ("a velocity", "1 mm/s"),
    "m^2": ("an area", "4 mm^2"),
    "Pa": ("a pressure", "210 GPa"),
}

_TEXT = re.compile(
    r"\s*(?P<number>[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(?P<unit>.*?)\s*"
)
_LONGEST = 80
"""Characters of a unit. Thousands of factors would exhaust the stack."""
# pint would compute 9**9**9 to the last digit.
_POWER_OF_NUMBER = re.compile(r"[0-9)]\s*(?:\*\*|[\^²³])")
_UNIT = re.compile(r"[A-Za-zµμ°%²³·*/^()\s0-9.+-]*")
# pint passes over signs and points that part no factors: "--N", "N..".
_LOOSE = re.compile(
    r"""(?<![*^(\s]) \s* [+-]             # a sign that is not of an exponent
    | [+-] (?! \s* [0-9.])
    | \. (?! \s* [A-Za-zµμ°%(] | [0-9])  # a point with nothing behind
    | (?<! [A-Za-zµμ°%²³)0-9\s]) \. (?! [0-9])""",
    re.X,
)


def quantity(value: float | str, unit: str, entry: str, *, finite: bool = True) -> float:
    """Read a number, or a text with a unit, as a number in SI units.

    A number is taken as it is, in `unit`: ``"N"``, ``"N/m"``, ``"rad/s"``, ``"rad"``, ``""`` for a
    ratio. A text is a number followed by a unit: ``"20.3 N"``, ``"24 kN/mm"``, ``"1500 rpm"``,
    ``"90 deg"``, ``"0.5 %"``; 1 Hz counts as 2 pi rad/s. Messages begin with the name of the
    `entry`.

    A number that is infinite is refused if it must be `finite`, not-a-number always.
    """
    if isinstance(value, str):
        return _parse(value, unit, entry)
    if isinstance(value, list | tuple):
        told = f" = {brief(value)} is not {_kind(unit)}, but a list; give a single one"
        raise EntryError(entry, told)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _refusal(value, unit, entry, f"is not {_kind(unit)}")
    try:
        number = float(value)
    except OverflowError:
        raise _refusal(value, unit, entry, "is too large") from None
    if number == 0.0 and value != 0:
        raise _refusal(value, unit, entry, "is too small")
    if math.isnan(number) or (finite and math.isinf(number)):
        raise _refusal(number, unit, entry, "is not finite" if finite else "is not a number")
    return number


def physical_number(value: object, unit: str, entry: str, *, finite: bool = True) -> float:
    """Return a number that a call gives, in SI units as it is, or as a text with its unit.

    The arguments are those of `quantity`.
    """
    if _has_unit(value):
        return quantity(value, unit, entry, finite=finite)  # type: ignore[arg-type]
    return real_number(value, entry, finite=finite)


def from_zero(
    value: object,
    unit: str,
    entry: str,
    remedy: str = "a number from zero, in SI units",
    *,
    finite: bool = True,
) -> float:
    """Return a number that is not negative; see `physical_number`."""
    number = physical_number(value, unit, entry, finite=finite)
    if number < 0.0:
        raise ModelError(f"{entry} {number:g} is negative; give {remedy}")
    return number


def without_units(values: Any, unit: str, entry: str) -> Any:
    """Return values with every text among them read as a number in SI units; see `quantity`."""
    if _has_unit(values):
        return quantity(values, unit, entry)
    if isinstance(values, np.ndarray):
        return without_units(values.tolist(), unit, entry) if values.dtype.kind in "UO" else values
    if not isinstance(values, list | tuple) or not any(map(_has_unit, values)):
        return values
    return [
        quantity(one, unit, f"{entry}[{place}]") if _has_unit(one) else one
        for place, one in enumerate(values)
    ]


def _has_unit(value: object) -> bool:
    """Return whether it is a text of a number and something behind it."""
    match = _TEXT.fullmatch(value) if isinstance(value, str) else None
    return match is not None and bool(match["unit"])


def _parse(text: str, unit: str, entry: str) -> float:
    match = _TEXT.fullmatch(text)
    if match is None:
        raise _refusal(text, unit, entry, f"is not {_kind(unit)}")
    number, given = float(match["number"]), match["unit"]
    if given.startswith(","):
        # pint would drop the comma and read 205 for "20,5"
        raise _refusal(text, unit, entry, "has a decimal comma, write a decimal point")
    if len(given) > _LONGEST:
        raise _refusal(text, unit, entry, f"has a unit of {len(given)} characters")
    if not given and unit:
        raise _refusal(text, unit, entry, "has no unit")
    result = number * _factor(given, unit, text, entry)
    if not math.isfinite(result):
        raise _refusal(text, unit, entry, "is not finite")
    if vanished(text, result):
        raise _refusal(text, unit, entry, "is too small")
    return result


def _factor(given: str, unit: str, text: str, entry: str) -> float:
    from tokenize import TokenError

    from pint.errors import DimensionalityError, PintError

    registry = _registry()
    if not _UNIT.fullmatch(given) or _POWER_OF_NUMBER.search(given) or _LOOSE.search(given):
        raise _refusal(text, unit, entry, f"has an unknown unit {brief(given)}")
    try:
        one = registry.Quantity(1.0, registry.parse_units(given))
        return float(one.to(unit).magnitude)
    except DimensionalityError:
        raise _refusal(text, unit, entry, f"is not {_kind(unit)}") from None
    except (
        PintError,
        ValueError,
        TypeError,
        ArithmeticError,
        SyntaxError,
        TokenError,
        AssertionError,
    ):
        # what pint's expression reader raises on a malformed unit depends on the malformation
        raise _refusal(text, unit, entry, f"has an unknown unit {brief(given)}") from None


@cache
def _registry() -> UnitRegistry[float]:
    from pint import UnitRegistry

    registry: UnitRegistry[float] = UnitRegistry(None)
    registry.load_definitions(_DEFINITIONS.strip().splitlines())
    return registry


def _kind(unit: str) -> str:
    name, _ = _KINDS.get(unit, ("a quantity", ""))
    return f"{name} [{unit}]" if unit else name


def _refusal(value: object, unit: str, entry: str, problem: str) -> EntryError:
    example = _KINDS.get(unit, ("", f"1 {unit}"))[1]
    plain = f"a number in {unit}" if unit else "a plain number"
    return EntryError(
        entry, f" = {brief(value)} {problem}; write for instance '{example}' or {plain}"
    )


def parted(text: str) -> tuple[float, str]:
    """Part a text such as ``"24 kN/mm"``, which `quantity` reads, into its number and its unit."""
    match = _TEXT.fullmatch(text)
    if match is None:
        raise EntryError("", f" = {brief(text)} is not a number with a unit")
    return float(match["number"]), match["unit"]

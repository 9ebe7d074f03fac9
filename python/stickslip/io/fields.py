"""Numbers in the fields of text files.

Fortran writes some that Python does not read, and Python reads some that no program writes: 1_0,
and the digits of all scripts.
"""

from __future__ import annotations

import re

from stickslip.checks import vanished

__all__ = ["real_field", "require_representable", "whole_field"]

_WHOLE = re.compile(r"[+-]?[0-9]+")
# Fortran drops the letter of an exponent of three digits: 1.5-101.
_BARE_EXPONENT = re.compile(r"(?<=[0-9.])([+-][0-9]+)$")
# Smaller exponents are those of numbers that do not vanish.
_SMALL = re.compile(r"[-+.0-9]+[ED]-0*[1-9][0-9]{2,}", re.I)


def whole_field(field: str, *, signed: bool = False) -> int:
    """Read a whole number, negative only if `signed`.

    Raises
    ------
    ValueError
        If it is none.
    """
    if not _WHOLE.fullmatch(field) or (field[0] == "-" and not signed):
        raise ValueError(f"{field[:40]!r} stands where a whole number must be")
    return int(field)


def real_field(field: str) -> float:
    """Read a real number as C or Fortran write it, exponents with a D or without a letter.

    Raises
    ------
    ValueError
        If it is none, or too small to be told from zero.
    """
    if "_" in field or not field.isascii():
        raise ValueError(f"{field[:40]!r} is no real number")
    try:
        number = float(field)
    except ValueError:
        written = field.upper().replace("D", "E")
        number = float(written if "E" in written else _BARE_EXPONENT.sub(r"E\1", written))
    if vanished(field, number):
        raise _too_small(field)
    return number


def require_representable(text: str) -> None:
    """Refuse a text with a number too small to be told from zero.

    Parameters
    ----------
    text : str
        Numbers, exponents with an E or a D.

    Raises
    ------
    ValueError
        If there is one.
    """
    for found in _SMALL.finditer(text):
        word = found[0]
        if vanished(word, float(word.upper().replace("D", "E"))):
            raise _too_small(word)


def _too_small(word: str) -> ValueError:
    return ValueError(f"{word.strip()[:40]} is too small for a number; write 0")

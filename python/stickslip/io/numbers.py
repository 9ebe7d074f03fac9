"""Numbers in text files, in fields and in tables.

Fortran writes some that Python does not read, and Python reads some that no program writes: 1_0,
and the digits of all scripts.
"""

from __future__ import annotations

import io
import re

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import vanished

_WHOLE = re.compile(r"[+-]?[0-9]+")
# Fortran drops the letter of an exponent of three digits: 1.5-101.
_BARE_EXPONENT = re.compile(r"(?<=[0-9.])([+-][0-9]+)$")
_EXPONENT = re.compile(r"(?:[ED][+-]?|(?<=[\d.])[+-])(\d+)[ \t\r]*$", re.I)
# Smaller exponents are those of numbers that do not vanish.
_SMALL = re.compile(r"[-+.0-9]+[ED]-0*[1-9][0-9]{2,}", re.I)


def whole_field(field: str, *, signed: bool = False) -> int:
    """Read a whole number, negative only if `signed`."""
    if not _WHOLE.fullmatch(field) or (field[0] == "-" and not signed):
        raise ValueError(f"{field[:40]!r} stands where a whole number must be")
    return int(field)


def real_field(field: str) -> float:
    """Read a real number as C or Fortran write it, exponents with a D or without a letter.

    A number that is too small to be told from zero is refused.
    """
    if "_" in field or not field.isascii():
        raise ValueError(f"{field[:40]!r} is no real number")
    try:
        number = float(field)
    except ValueError:
        written = field.upper().replace("D", "E")
        number = float(written if "E" in written else _BARE_EXPONENT.sub(r"E\1", written))
    _require_not_vanished(field, number)
    return number


def require_representable(text: str) -> None:
    """Refuse a text with a number too small to be told from zero; exponents have an E or a D."""
    for found in _SMALL.finditer(text):
        _require_not_vanished(found[0], float(found[0].upper().replace("D", "E")))


def _require_not_vanished(word: str, number: float) -> None:
    if vanished(word, number):
        raise ValueError(f"{word.strip()[:40]} is too small for a number; write 0")


def require_whole_numbers(text: str) -> None:
    """Refuse a text that ends inside a number, as far as that can be seen.

    Many programs do not end the last line. Where it does not, its last number must have an exponent
    as long as those of the lines before.
    """
    if text.endswith("\n") or not text:
        return
    *lines, last = text[-4000:].split("\n")
    digits = [len(found[1]) if (found := _EXPONENT.search(line)) else 0 for line in lines[-5:]]
    # Two digits are the rule, three the exception.
    least = min(2, *digits) if len(digits) > 2 else 0
    own = _EXPONENT.search(last)
    stops = re.search(r"[ED+.-]\s*$", last, re.I) is not None
    if stops or (len(own[1]) if own else 0) < least:
        raise ValueError(f"the last number, {last[-12:]!r}, is not whole; the file was cut short")


def entry_table(text: str, words: int) -> NDArray[np.float64]:
    """Read lines of `words` numbers each, parted by blanks or commas, shape (lines, words)."""
    if re.search(r",[ \t]*,", text):
        raise ValueError("nothing stands between two commas")
    if not text.split():
        raise ValueError("the file holds no entries")
    text = text.upper().replace("D", "E").replace(",", " ")
    if not set(text) <= set("0123456789+-.E \t\r\n"):
        raise ValueError("characters that are no part of a number")
    table = np.loadtxt(io.StringIO(text), dtype=np.float64, ndmin=2)
    if table.shape[1] != words:
        raise ValueError(f"{table.shape[1]} numbers in a line, {words} expected")
    require_representable(text)
    return table


def counted(numbers: NDArray[np.float64], kind: str) -> NDArray[np.int64]:
    """Return whole numbers that count from 1."""
    wrong = (numbers != np.rint(numbers)) | (numbers < 1) | (numbers > 2**53)
    if wrong.any():
        raise ValueError(f"{kind} {numbers[wrong][0]:g} is not one of 1, 2, ...")
    return numbers.astype(np.int64)

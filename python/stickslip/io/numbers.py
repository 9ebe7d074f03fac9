"""Numbers in text files, in fields and in tables.

Fortran writes some that Python does not read, and Python reads some that no program writes: 1_0,
and the digits of all scripts.
"""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import vanished

_WHOLE = re.compile(r"[+-]?[0-9]{1,40}")
_LARGEST = 2**63
# Fortran drops the letter of an exponent of three digits: 1.5-101.
_BARE_EXPONENT = re.compile(r"(?<=[0-9.])([+-][0-9]+)$")
_EXPONENT = re.compile(r"(?:[ED][+-]?|(?<=[\d.])[+-])(\d+)[ \t\r]*$", re.I)
# Exponents of two digits and less than 200 zeros are those of numbers that do not vanish.
_SMALL = re.compile(
    r"(?<![-+.0-9])(?:[-+.0-9]+[ED]-0*[1-9][0-9]{2,}|[-+]?0*\.0{200,}[0-9]+(?:[ED][-+]?[0-9]+)?)",
    re.I,
)


def whole_field(field: str, *, signed: bool = False) -> int:
    """Read a whole number, negative only if `signed`."""
    if not _WHOLE.fullmatch(field) or (field[0] == "-" and not signed):
        raise ValueError(f"{field[:40]!r} stands where a whole number must be")
    number = int(field)
    if abs(number) >= _LARGEST:
        raise ValueError(f"{field[:40]} is too large for a whole number")
    return number


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
        try:
            number = float(written if "E" in written else _BARE_EXPONENT.sub(r"E\1", written))
        except ValueError:
            raise ValueError(f"{field[:40]!r} is no real number") from None
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
    return table_of(text, np.dtype((np.float64, (words,))))


def table_of(text: str, dtype: np.dtype[Any], first: int = 1) -> NDArray[Any]:
    """Read a text of which every line is an entry, of so many numbers as the type says.

    Lines without numbers are passed over, and what stands behind a %. `first` is the number in its
    file that the first line has.
    """
    # Fortran writes exponents with a D.
    lines = (line.upper().replace("D", "E") for line in text.split("\n"))
    flat = np.dtype([("entry", dtype)]) if dtype.names is None else dtype
    try:
        table = np.loadtxt(lines, flat, comments="%", ndmin=1)
    except (ValueError, OverflowError) as error:
        raise ValueError(_misfit(text.split("\n"), flat, first) or str(error)) from None
    require_representable(text)
    return table if dtype.names else np.ascontiguousarray(table["entry"])


def _misfit(lines: list[str], dtype: np.dtype[Any], first: int) -> str | None:
    """Say in which line a word is no number of its kind, or which has too few or too many."""
    parts = [dtype[name] for name in dtype.names or ()]
    whole = [part.base.kind == "i" for part in parts for _ in range(math.prod(part.shape))]
    for number, line in enumerate(lines, first):
        words = line.partition("%")[0].split()
        if words and len(words) != len(whole):
            return f"line {number}: {len(words)} numbers in {line.strip()[:30]!r}, not {len(whole)}"
        for word, counts in zip(words, whole, strict=False):
            try:
                whole_field(word, signed=True) if counts else float(word.upper().replace("D", "E"))
            except ValueError:
                kind = "whole" if counts else "real"
                return f"line {number}: {word[:40]!r} is no {kind} number that can be read"
    return None


def counted(numbers: NDArray[np.float64], kind: str) -> NDArray[np.int64]:
    """Return whole numbers that count from 1."""
    wrong = (numbers != np.rint(numbers)) | (numbers < 1) | (numbers > 2**53)
    if wrong.any():
        raise ValueError(f"{kind} {numbers[wrong][0]:g} is not one of 1, 2, ...")
    return numbers.astype(np.int64)

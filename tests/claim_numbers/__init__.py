"""What the claims of the dissertation must come to, by chapter; see `test_claims`.

Of each the verdict, and numbers with their relative tolerance: 1e-2, or 0 where something is
counted. Those of exact orbits, of natural frequencies and of harmonic balance up to 51 harmonics
were computed independently of this package; the others are kept, so that a change is seen.
"""

from __future__ import annotations

from claim_numbers import chapter_2, chapter_3, chapter_4, chapter_5, chapter_6, chapter_7

__all__ = ["CLAIM_NUMBERS", "TIMED"]

# Times depend on the machine: of these the rules are tested, with the numbers that come out.
TIMED = {
    "even-with-21-harmonics",
    "fast-results",
    "faster-iteration",
    "faster-than-newton",
    "hundreds-of-times",
    "orders-faster",
    "orders-of-magnitude",
}

CLAIM_NUMBERS = {
    name: wanted
    for chapter in (chapter_2, chapter_3, chapter_4, chapter_5, chapter_6, chapter_7)
    for name, wanted in chapter.NUMBERS.items()
}

"""Makes pictures and numbers of gallery and claims: ``python docs/make_gallery.py [NAME ...]``.

The same code as ``stickslip reproduce all``, at full resolution. Pictures and numbers are kept with
the pages, so that building the pages computes nothing; what each item takes, in processor time, is
kept in the package, for the list of ``stickslip reproduce``.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

from stickslip.files import write
from stickslip_reproduce import FULL, chosen, costs, items
from stickslip_reproduce.claims import claims, computed
from stickslip_reproduce.claims_page import counts, write_claims
from stickslip_reproduce.costs import FILE
from stickslip_reproduce.folder import write_picture, write_record
from stickslip_reproduce.index import CLAIMS

FOLDER = Path(__file__).parent / "assets" / "reproduction"
COLOURS = 48


def main(names: list[str]) -> None:
    """Reproduce some or all items into the assets of the documentation."""
    FOLDER.mkdir(exist_ok=True)
    for item in chosen([name for name in names if name != "claims"] or ["all"] * (not names)):
        begin = time.process_time()
        numbers = computed(item, FULL)
        seconds = time.process_time() - begin
        write_picture(numbers.plot, FOLDER / f"{item.name}.png", colours=COLOURS)
        write_record(item, numbers, seconds, FULL, FOLDER)
        _remember(item.name, seconds)
        print(f"{item.name:<18} {seconds:6.2f} s")
    if not names or "claims" in names:
        findings = []
        for one in claims().values():
            begin = time.process_time()
            findings.append(one.finding(FULL))
            seconds = time.process_time() - begin
            print(
                f"{one.section:<6} {findings[-1].verdict:<17} {seconds:6.2f} s  {one.name}",
                flush=True,
            )
        print(counts(write_claims(findings, FOLDER, colours=COLOURS)))
        (FOLDER / CLAIMS).unlink()


def _remember(name: str, seconds: float) -> None:
    known = {**costs(), name: round(seconds, 2)}
    kept = {name: known[name] for name in items() if name in known}
    write(FILE, (json.dumps(kept, indent=1) + "\n").encode())


if __name__ == "__main__":
    main(sys.argv[1:])

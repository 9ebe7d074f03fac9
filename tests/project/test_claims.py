"""Every claim of the text: its verdict, the numbers that it follows from, and the pages.

The whole takes about a minute of processor time; claims share their computations.
"""

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import invoke
from claim_numbers import CLAIM_NUMBERS, TIMED
from stickslip_reproduce import COARSE, SUBJECTS, Axis, Fact, Panel, Plot, Series, heading, items
from stickslip_reproduce.claims import VERDICTS, Claim, Finding, Found, claims, verdict
from stickslip_reproduce.claims_page import chapters, counts, entries, write_claims
from stickslip_reproduce.drawing import draw
from stickslip_reproduce.numbered import NUMBERED

DOCS = Path(__file__).parents[2] / "docs"
PROPOSED = [name for name in claims() if name.startswith("proposed-")]


@pytest.fixture(scope="module")
def found():
    """Every finding, computed once and when it is asked for."""
    known = {}

    def of(name):
        if name not in known:
            known[name] = claims()[name].finding(COARSE)
        return known[name]

    return of


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(CLAIM_NUMBERS))
def test_verdict_and_numbers(name, found):
    one = found(name)
    wanted, numbers = CLAIM_NUMBERS[name]
    values = {fact.what: fact.value for fact in one.found.facts}
    if name not in TIMED:
        assert set(values) == set(numbers)
        assert one.verdict == wanted, values
    for what, (value, tolerance) in numbers.items():
        if value == 0:
            assert abs(values[what]) <= tolerance, what
        else:
            assert values[what] == pytest.approx(value, rel=tolerance), what
    if one.found.plot is not None:
        draw(one.found.plot)


@pytest.mark.slow
def test_a_verdict_follows_from_its_numbers(found):
    for name, claim in claims().items():
        values = {fact.what: fact.value for fact in found(name).found.facts}
        others = [
            dict.fromkeys(values, other) for other in (-1.0, 1e-12, 0.6, 1.0, 3.0, 100.0, 1e9)
        ]
        others += [
            {**values, what: other}
            for what in values
            for other in (1e-12, 0.3, 1.0, 1.02, 4.9, 684.0, 1e3, 1e9)
        ]
        others += [dict(zip(values, reversed(values.values()), strict=True))]
        printed = {fact.what: fact.printed for fact in found(name).found.facts if fact.printed}
        others.append(values | printed)
        verdicts = {claim.judge(other) for other in (values, *others)}
        assert verdicts <= set(VERDICTS)
        assert len(verdicts) > 1, f"{name}: its verdict does not depend on its numbers"
        assert claim.judge({**values, next(iter(values)): np.nan}) == "open"


def test_verdicts():
    assert [verdict(True), verdict(False, True), verdict(False)] == list(VERDICTS[:3])


def test_every_claim_has_its_numbers():
    assert set(claims()) == {*CLAIM_NUMBERS, *PROPOSED}
    for name in PROPOSED:
        done = claims()[name].see[0] in items()
        assert claims()[name].finding(COARSE).verdict == ("holds" if done else "open")
    for one in claims().values():
        assert one.done.endswith("."), one.name
        assert set(one.see) <= {*SUBJECTS, *(claims()[name].see[0] for name in PROPOSED)}
        assert re.fullmatch(r"[2-7](\.\d)+", one.section)


def test_claims_are_in_the_order_of_the_text():
    sections = [one.section.split(".") for one in claims().values()]
    assert sections == sorted(sections)


def small(value):
    claim = Claim(
        name="small",
        section="2.1",
        quote="A < 1 & more",
        done="What is done.",
        compute=lambda _: Found((Fact("a", value, "m", 1.0),)),
        rule=lambda n: verdict(n["a"] > 1.0, n["a"] > 0.5),
        see=("fig-2.3",),
    )
    return claim.finding(COARSE)


def test_page_of_claims(tmp_path):
    plot = Plot(Axis("x"), Axis("y"), (Panel((Series("a", [0, 1], [1, 2]),)),))
    one = small(2.0)
    drawn = Finding(one.claim, Found(one.found.facts, plot), one.verdict)
    write_claims([drawn, small(0.7), small(0.1), small(np.nan)], tmp_path)
    kept = entries(tmp_path)
    assert [entry["verdict"] for entry in kept] == list(VERDICTS)
    assert counts(kept) == "4 claims: 1 holds, 1 holds with limits, 1 false, 1 open."
    page = (tmp_path / "claims.html").read_text(encoding="utf-8")
    assert "A &lt; 1 &amp; more" in page
    assert "a: 2 m (printed 1)" in page
    assert 'src="claim-small.png"' in page
    assert (tmp_path / "claim-small.png").is_file()
    assert [name for name, _ in chapters(kept)] == ["Chapter II"]


def test_command_computes_claims(tmp_path, monkeypatch):
    from stickslip_reproduce import claims as module

    monkeypatch.setattr(module, "claims", lambda: {"small": small(2.0).claim})
    outcome = invoke("reproduce", "claims", "--coarse", "--out", tmp_path)
    assert outcome.exit_code == 0, outcome.output
    assert "2.1    holds" in outcome.output
    assert "1 claims: 1 holds." in outcome.output
    assert 'href="claims.html"' in (tmp_path / "index.html").read_text(encoding="utf-8")
    (tmp_path / "claims.json").write_text("{}")
    with pytest.raises(ValueError, match="not a record of claims"):
        entries(tmp_path)


def test_docs_hold_what_the_claims_come_to():
    kept = {one["name"]: one for one in entries(DOCS / "assets" / "reproduction")}
    assert set(kept) == set(claims()), "run docs/make_gallery.py claims"
    for name, (wanted, _) in CLAIM_NUMBERS.items():
        facts = {fact["what"]: fact["value"] for fact in kept[name]["facts"]}
        assert kept[name]["verdict"] == claims()[name].judge(facts), name
        assert name in TIMED or kept[name]["verdict"] == wanted, name
        assert kept[name]["quote"] == claims()[name].quote
        assert kept[name]["done"] == claims()[name].done
        picture = kept[name]["picture"]
        assert picture is None or (DOCS / "assets" / "reproduction" / picture).is_file()


def test_page_of_the_docs_is_written_from_the_record():
    hook = runpy.run_path(str(DOCS / "gallery.py"))["written"]
    page = hook("{{ claims }}")
    for one in claims().values():
        assert f'id="{one.name}"' in page
        assert one.quote.replace("|", "&#124;") in page
    assert "## Chapter VI" in page


def test_everything_numbered_is_listed():
    figures = {2: 11, 3: 1, 4: 22, 5: 28, 6: 11}
    tables = {2: 3, 3: 1, 4: 1, 5: 3, 6: 4}
    wanted = {
        f"Fig. {chapter}.{n}" for chapter, last in figures.items() for n in range(1, last + 1)
    }
    wanted |= {
        f"Table {chapter}.{n}" for chapter, last in tables.items() for n in range(1, last + 1)
    }
    wanted |= {f"{kind} {n}" for kind in ("Procedure", "Property") for n in (1, 2)}
    listed = {heading(name) for name in SUBJECTS if not name.startswith("7.")}
    assert listed | set(NUMBERED) == wanted
    assert not listed & set(NUMBERED)
    for _, place in NUMBERED.values():
        kind, _, name = place.partition(" ")
        if kind == "claim":
            assert name in claims()
        elif kind != "none":
            ss_name = kind.removeprefix("stickslip.").split(".")
            assert hasattr(ss.reference if len(ss_name) > 1 else ss, ss_name[-1])
    page = runpy.run_path(str(DOCS / "gallery.py"))["written"]("{{ coverage }}")
    assert all(f"| {name} |" in page for name in NUMBERED)


def test_quotes_are_plain():
    for one in claims().values():
        assert one.quote == " ".join(one.quote.split())
        assert json.loads(json.dumps(one.quote)) == one.quote

"""Reports: what stands beside the default pictures of results that have much to show."""

import json

import pytest

import stickslip as ss
from report_page import Page


@pytest.mark.slow
def test_every_deviation_has_its_distribution(tmp_path):
    disk = ss.reference.beam_ring(sectors=4)
    given = {"patterns": 4, "omega": (180.0, 260.0), "dofs": ["tip"], "harmonics": 1}
    study = ss.mistuning_study(disk, [0.02, 0.05], coupling_stiffness=[1e4, 1e5], **given)
    ss.report(study, tmp_path / "a.html")
    page = Page(tmp_path / "a.html")
    assert "No figure" not in page.text
    titles = [one["layout"]["title"]["text"] for one in page.figures]
    for deviation in ("0.02", "0.05"):
        for coupling in ("10000", "100000"):
            told = f"deviation {deviation}, coupling {coupling} N/m: 4 disks"
            assert sum(title.startswith(told) for title in titles) == 1


@pytest.mark.slow
def test_a_long_transient_is_no_huge_page(tmp_path):
    moved = ss.transient(ss.reference.snecma_beam(), 170.0, 1000, keep=1000, samples=64)
    ss.report(moved, tmp_path / "a.html")
    page = Page(tmp_path / "a.html")
    assert max(len(json.dumps(figure)) for figure in page.figures) < 1_000_000
    assert page.figures[-1]["layout"]["title"]["text"] == "the last 100 periods"

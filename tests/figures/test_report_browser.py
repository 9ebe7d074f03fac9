"""Reports in a browser: figures are drawn, curves and scales switch, nothing is fetched."""

from itertools import count

import numpy as np
import pytest

import stickslip as ss
from browser import MISSING, PROGRAM, Browser

pytestmark = pytest.mark.skipif(PROGRAM is None, reason=MISSING)

BEAM = ss.reference.snecma_beam(20.313)
# a name that would run if it were ever taken for markup
BAD = '<b>bold</b><img src=x onerror="window.hacked=1"><script>window.hacked=1</script>'
LEGEND = "document.querySelector('.plot').querySelectorAll('.legendtoggle')[{}]"
BUTTON = "document.querySelector('.plot').querySelectorAll('.updatemenu-button')[{}]"


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    grid = np.linspace(150.0, 250.0, 24)
    disk = ss.reference.beam_ring()
    mistuned = disk.mistuned(0.05 * ss.mistuning_pattern(disk.sectors, 1.0, seed=1))
    beam = BEAM.structure
    named = ss.Structure(beam.mass, beam.stiffness, beam.damping, [BAD, "tip", "mode"])
    contact = ss.Jenkins(BAD, stiffness=2.4e7, slip_force=246.0, name=f"{BAD}!")
    hostile = ss.Model(named, [contact], [ss.Force("tip", 20.0)])
    file = tmp_path_factory.mktemp("report") / "all.html"
    given = {
        "low": ss.forced_response(ss.reference.snecma_beam(6.563), grid, 5),
        "high": ss.certify(ss.forced_response(BEAM, grid, 5), 3),
        "exact": ss.exact_response(BEAM, grid),
        "transient": ss.transient(BEAM, 170.0, 12, keep=3, samples=32),
        "curve": ss.damper_curve(BEAM, slip_force=np.geomspace(10.0, 1e3, 8), dof="tip"),
        "optimum": ss.optimal_damper(BEAM, dof="tip", bounds=(50.0, 1e3)),
        "mistuned": ss.forced_response(mistuned, grid[::4], 3),
        BAD: ss.forced_response(hostile, grid, 3),
    }
    ss.report(given, file)
    return file


@pytest.fixture(scope="module")
def window(report):
    with Browser() as browser:
        browser.open(report)
        yield browser


@pytest.fixture
def page(window, report):
    yield window
    assert window.complaints == []
    assert window.requests == [report.as_uri()]


def test_every_figure_is_drawn(page):
    plots = page.run("document.querySelectorAll('.plot').length")
    assert plots > 15
    drawn = page.run(
        "[...document.querySelectorAll('.plot')].map(one => "
        "one.querySelectorAll('.trace path, .heatmaplayer image').length)"
    )
    assert len(drawn) == plots
    assert min(drawn) > 0
    # every curve that is to be seen has its path
    wanted = page.run("document.querySelector('.plot').data.length")
    assert page.run("document.querySelector('.plot').querySelectorAll('.trace').length") == wanted
    bars = page.run("[...document.querySelectorAll('.modebar-btn')].map(one => one.dataset.title)")
    assert not any("share" in title.lower() or "cloud" in title.lower() for title in bars)


def test_curves_come_and_go(page):
    shown = "document.querySelector('.plot').data.map(one => one.visible !== 'legendonly')"
    names = page.run(
        "document.querySelector('.plot').data.filter(one => one.showlegend).map(one => one.name)"
    )
    own = page.run("document.querySelector('.plot').data.map(one => one.name)")
    assert all(page.run(shown))
    number = next(place for place, name in zip(count(), names) if "P = 6.563" in name)
    page.click(LEGEND.format(number))
    page.until(f"!({shown}).every(Boolean)")
    assert page.run(shown) == [name != names[number] for name in own]
    assert own.count(names[number]) == 2  # its peak goes with it
    page.run("new Promise(done => setTimeout(done, 400))")  # no double click
    page.click(LEGEND.format(number))
    page.until(f"({shown}).every(Boolean)")


def test_the_scale_switches(page):
    axis = "document.querySelector('.plot').layout.yaxis"
    assert page.run(f"{axis}.type") == "log"
    before = page.run(f"{axis}.range")
    page.click(BUTTON.format(1))
    page.until(f"{axis}.type === 'linear'")
    low, high = page.run(f"{axis}.range")
    assert low == 0.0
    assert high > 1e-3
    page.click(BUTTON.format(0))
    page.until(f"{axis}.type === 'log'")
    assert page.run(f"{axis}.range") == pytest.approx(before)


def test_names_stay_texts(page):
    assert page.run("window.hacked === undefined")
    assert page.run("document.querySelectorAll('main img').length") == 0
    labels = page.run("[...document.querySelectorAll('.plot text')].map(one => one.textContent)")
    assert any(BAD in label for label in labels)
    assert page.run(
        "[...document.querySelectorAll('h3')].some(one => one.textContent == " + "`" + BAD + "`)"
    )


def test_nothing_can_be_sent(page):
    assert (
        page.run("fetch('https://example.org/').then(() => 'sent', () => 'refused')") == "refused"
    )
    # not for lack of a network: the page forbids it
    assert any("Content Security Policy" in line for line in page.complaints)
    page.complaints.clear()
    page.requests[:] = [one for one in page.requests if "example.org" not in one]


def test_dark_windows_and_paper(page):
    look = "getComputedStyle({}).backgroundColor"
    page.shape(dark=True)
    assert page.run(look.format("document.body")) == "rgb(21, 25, 30)"
    assert page.run(look.format("document.querySelector('figure')")) == "rgb(255, 255, 255)"
    page.shape()
    assert page.run(look.format("document.body")) == "rgb(255, 255, 255)"
    width = "document.querySelector('.plot .main-svg').getBoundingClientRect().width"
    wide = page.run(width)
    page.run("window.dispatchEvent(new Event('beforeprint'))")
    page.until(f"{width} === 660")
    page.run("window.dispatchEvent(new Event('afterprint'))")
    page.until(f"{width} === {wide}")


def test_a_narrow_window_needs_no_sideways_scrolling(page):
    page.shape(width=420)
    page.until("document.documentElement.scrollWidth <= 420")
    page.shape()

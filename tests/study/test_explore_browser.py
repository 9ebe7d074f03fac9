"""The explorer in a browser: sliders are moved by mouse and keys, curves follow, files come out."""

import shutil
import signal
import time
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import EXAMPLE, script, study_text
from browser import MISSING, PROGRAM, Browser

pytest.importorskip("tomlkit")
pytest.importorskip("tornado")

from explorer import Explorer

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason=MISSING),
    pytest.mark.slow,
]

# a name that would run if it were ever taken for markup
BAD = "<img src=x onerror=window.hacked=1>"
POINTS = "omega = { from = 150, to = 250, points = 40 }\nharmonics = 5\nlevels = [6.563, 20.313]"
READY = (
    "[...document.querySelectorAll('section')]"
    ".every(one => one.getAttribute('aria-busy') === 'false')"
)
DRAWN = f"document.querySelectorAll('.plot').length > 2 && {READY}"
ARROW_RIGHT, TAB = ("ArrowRight", 39), ("Tab", 9)
CURVE = (
    "(() => {{ const one = document.querySelector('#{0} .plot')._fullData.find(one => "
    "one.name.startsWith('{1}')); return {{x: [...one.x], y: [...one.y], name: one.name}}; }})()"
)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, folder)
    text = study_text(POINTS).replace('law = "jenkins"', f'law = "jenkins"\nname = "{BAD}"')
    (folder / "beam.toml").write_text(text)
    return folder / "beam.toml"


@pytest.fixture(scope="module")
def explorer(study):
    with Explorer(study) as running:
        yield running


@pytest.fixture(scope="module")
def window():
    with Browser() as browser:
        yield browser


@pytest.fixture
def page(window, explorer):
    window.open(explorer.address)
    window.shape(width=1280)
    window.until(DRAWN)
    yield window
    window.call("Page.navigate", url="about:blank")
    assert window.complaints == []
    own = f"ws://{explorer.name}/socket"
    assert all(one.startswith(explorer.address) or one == own for one in window.requests)


def element(name):
    return f"document.getElementById('{name}')"


def value(page, name):
    return float(page.run(f"{element(name)}.value"))


def settled(page, change):
    """Make a change, and wait until everything has followed it."""
    page.run("delete document.body.dataset.milliseconds")
    change()
    page.until(f"document.body.dataset.milliseconds && {READY}")


def typed(page, name, text):
    page.click(element(name))
    page.run(f"{element(name)}.select()")
    page.call("Input.insertText", text=text)
    page.press(*TAB)


def peak_of(slip_force=246.048, level=20.313):
    beam = ss.reference.snecma_beam(level)
    contact = ss.Jenkins("damper", stiffness=2.4e7, slip_force=slip_force)
    model = ss.Model(beam.structure, [contact], beam.forces)
    return ss.forced_response(model, np.linspace(150, 250, 40), 5)


def test_a_key_moves_a_slider_and_the_curve_is_that_of_the_solver(page):
    page.click(element("range-2"))
    before = value(page, "box-2")
    for _ in range(3):
        settled(page, lambda: page.press(*ARROW_RIGHT))
    now = value(page, "box-2")
    assert now > before
    shown = page.run(CURVE.format("curve", "P = "))
    curve = peak_of(now)
    assert shown["x"] == pytest.approx(curve.omega)
    assert shown["y"] == pytest.approx(1e3 * curve.amplitude("tip"), rel=1e-9)  # mm
    names = page.run("document.querySelector('#damper .plot')._fullData.map(one => one.name)")
    assert f"now: {now:.4g} N" in names
    limits = page.run("document.querySelector('#curve .plot')._fullData.map(one => one.name)")
    assert {"stuck (linear)", "free (linear)", "estimated truncation error"} <= set(limits)


def test_the_mouse_drags_a_slider(page):
    box = page.run(f"{element('range-0')}.getBoundingClientRect().toJSON()")
    y, left, width = box["y"] + box["height"] / 2, box["x"], box["width"]

    def drag():
        places = np.linspace(0.5, 0.7, 9)
        for kind, place in [
            ("mousePressed", places[0]),
            *(("mouseMoved", one) for one in places),
            ("mouseReleased", places[-1]),
        ]:
            at = {"x": left + place * width, "y": y}
            page.call(
                "Input.dispatchMouseEvent", type=kind, button="left", buttons=1, clickCount=1, **at
            )

    settled(page, drag)
    level = value(page, "box-0")
    assert 2.0 * 20.313 < level < 30.0 * 20.313
    shown = page.run(CURVE.format("curve", "P = "))
    assert shown["y"] == pytest.approx(1e3 * peak_of(level=level).amplitude("tip"), rel=1e-9)


def test_a_number_is_typed_and_all_goes_back(page):
    settled(page, lambda: typed(page, "box-2", "400"))
    assert value(page, "box-2") == 400.0
    amplitude = peak_of(400.0).amplitude("tip")
    shown = page.run(CURVE.format("curve", "P = "))["y"]
    assert shown == pytest.approx(1e3 * amplitude, rel=1e-9)
    settled(page, lambda: page.click(element("reset")))
    assert value(page, "box-2") == 246.048


def test_what_is_refused_stands_on_the_page_as_a_line(page):
    settled(page, lambda: typed(page, "box-2", "-5"))
    lines = page.run("[...document.querySelectorAll('section .failure')].map(one => one.innerText)")
    assert len(lines) == 1
    assert "contact 1: slip_force" in lines[0]
    assert page.run("document.querySelectorAll('.plot').length") == 0
    page.click(element("reset"))
    page.until(DRAWN)
    assert page.run("document.querySelectorAll('section .failure').length") == 0


def test_a_text_is_no_number(page):
    typed(page, "box-2", "e")
    page.until(f"{element('said')}.textContent.includes('give a number')")
    assert page.run(f"{element('box-2')}.getAttribute('aria-invalid')") == "true"


def test_dof_and_parameter_are_chosen_by_keys(page):
    page.run(f"{element('dof')}.focus()")
    settled(page, lambda: page.press("d", 68))
    assert "of damper" in page.run("document.querySelector('#curve figcaption').innerText")
    page.run(f"{element('over')}.focus()")
    settled(page, lambda: page.press("l", 76))
    assert "force P" in page.run("document.querySelector('#damper figcaption').innerText")


def test_the_chosen_scale_stays(page):
    page.click("document.querySelector('#curve .plot').querySelectorAll('.updatemenu-button')[1]")
    axis = "document.querySelector('#curve .plot').layout.yaxis"
    page.until(f"{axis}.type === 'linear'")
    settled(page, lambda: typed(page, "box-2", "300"))
    assert page.run(f"{axis}.type") == "linear"
    assert page.run(f"{axis}.range[0]") == 0


def test_every_control_is_reached_by_tab(page):
    wanted = page.run(
        "[...document.querySelectorAll('#controls :is(input, select, button)')].map(one => one.id)"
    )
    page.run("document.activeElement.blur()")
    reached = []
    for _ in wanted:
        page.press(*TAB)
        reached.append(page.run("document.activeElement.id"))
    assert reached == wanted
    assert all(
        page.run(
            "[...document.querySelectorAll('#controls :is(input, select)')].map(one => "
            "one.labels.length > 0 || one.ariaLabel !== null)"
        )
    )


def test_names_stay_texts(page):
    assert page.run("window.hacked === undefined")
    assert page.run("document.querySelectorAll('img[src=x]').length") == 0
    legends = page.run("[...document.querySelectorAll('legend')].map(one => one.innerText)")
    assert any(BAD in one for one in legends)


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [1280, 400])
def test_it_fits_every_window(page, width, dark):
    page.shape(width=width, dark=dark)
    page.run("new Promise(done => setTimeout(done, 400))")
    assert page.run("document.documentElement.scrollWidth") <= width
    sizes = page.run(
        "[...document.querySelectorAll('.plot .main-svg')].map(one => one.clientWidth)"
    )
    assert max(sizes) < width
    ink, paper = page.run(
        "(() => { const one = getComputedStyle(document.body); "
        "return [one.color, one.backgroundColor]; })()"
    )
    bright = [sum(map(int, one.removeprefix("rgb(")[:-1].split(","))) for one in (ink, paper)]
    assert (bright[0] > bright[1]) == dark


def downloaded(page, folder, button):
    page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    page.click(element(button))
    page.until(f"{element('said')}.textContent.startsWith('saved')")
    for _ in range(100):
        files = [one for one in folder.iterdir() if one.suffix in (".toml", ".png")]
        if files and files[0].stat().st_size:
            return files[0]
        time.sleep(0.1)
    raise AssertionError("nothing was saved")


def test_an_exported_study_runs_and_gives_the_curve_of_the_page(page, tmp_path):
    settled(page, lambda: typed(page, "box-2", "333"))
    settled(page, lambda: typed(page, "box-0", "12.5"))
    shown = page.run(CURVE.format("curve", "P = "))
    file = downloaded(page, tmp_path, "study")
    assert file.name == "beam-explored.toml"
    result = script("run", file, "--no-plot", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    curve = ss.load(tmp_path / "results" / "beam-explored-12.5.nc")
    assert shown["x"] == pytest.approx(curve.omega)
    assert shown["y"] == pytest.approx(1e3 * curve.amplitude("tip"), rel=1e-12)
    # what was not touched stands as it was written
    assert "# one DOF: to ground" in file.read_text()


def test_a_picture_is_exported(page, tmp_path):
    file = downloaded(page, tmp_path, "picture")
    assert file.name == "beam-explored.png"
    assert file.read_bytes().startswith(b"\x89PNG\r\n")


def test_the_page_says_when_the_server_has_gone(window, study):
    with Explorer(study) as explorer:
        window.open(explorer.address)
        window.until(DRAWN)
        explorer.end(signal.SIGKILL)
        window.until("!document.getElementById('lost').hidden")
        assert "stickslip explore" in window.run("document.getElementById('lost').innerText")
        assert window.complaints == []


def test_the_study_itself_is_never_written(study):
    assert sorted(one.name for one in Path(study).parent.iterdir()) == [
        "beam.toml",
        "mass.mtx",
        "stiffness.mtx",
    ]

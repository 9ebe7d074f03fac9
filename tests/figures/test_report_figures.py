"""Figures of reports: what Matplotlib draws, as plotly draws it."""

import json

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from packed import numbers
from stickslip.html.figures import drawn
from stickslip.html.notation import label
from stickslip.plot.style import finish, number_bar


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("slip force $F_d$ [N]", "slip force F<sub>d</sub> [N]"),
        ("$P/F_d$", "P/F<sub>d</sub>"),
        (r"$\omega_{max}^2$ & <b>", "ω<sub>max</sub><sup>2</sup> &amp; &lt;b&gt;"),
        ("5 $ only", "5 $ only"),
        (r"cost\$1\$ $F_d$", "cost&#36;1&#36; F<sub>d</sub>"),
        ("$<x>_<$", "&lt;x&gt;_&lt;"),
    ],
)
def test_labels(text, expected):
    assert label(text).replace("<sub>&</sub>", "_&") == expected


def figure_of(draw):
    found = drawn(lambda *, ax: draw(ax))
    return json.loads(found.data) if found.data else found


@pytest.mark.slow
def test_maps_bars_and_histograms_are_drawn():
    def draw(ax: Axes) -> None:
        mesh = ax.pcolormesh([0, 1, 3], [0, 2, 3], [[1.0, 2.0], [3.0, np.nan]])
        ax.figure.colorbar(mesh, ax=ax, label="basin")

    (heat,) = figure_of(draw)["data"]
    assert heat["type"] == "heatmap"
    assert numbers(heat["x"]).tolist() == [0, 1, 3]
    assert heat["colorbar"]["title"]["text"] == "basin"
    (heat,) = figure_of(lambda ax: ax.imshow([[0, 1], [2, 3]], extent=(0, 4, 0, 2)))["data"]
    assert numbers(heat["y"]).tolist() == [2, 1, 0]
    (bars,) = figure_of(lambda ax: ax.hist([1.0, 1.1, 2.0], bins=2, label="share"))["data"]
    assert (bars["type"], bars["name"]) == ("bar", "share")
    assert numbers(bars["y"]).tolist() == [2, 1]


def test_cases_have_their_own_colours_and_names():
    def draw(ax: Axes) -> None:
        cases = ListedColormap(["red", "green", "blue"])
        norm = BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3)
        mesh = ax.pcolormesh([0, 1, 2, 3], [0, 1], [[0.0, 1.0, 2.0]], cmap=cases, norm=norm)
        bar = ax.figure.colorbar(mesh, ax=ax, ticks=[0, 1, 2])
        bar.ax.set_yticklabels(["<stuck>", "slips", "lost"])

    (heat,) = figure_of(draw)["data"]
    assert numbers(heat["z"]).ravel() == pytest.approx([1 / 6, 3 / 6, 5 / 6])
    assert heat["colorscale"][2:4] == [[1 / 3, "rgba(0,128,0,1)"], [2 / 3, "rgba(0,128,0,1)"]]
    assert heat["colorbar"]["ticktext"] == ["&lt;stuck&gt;", "slips", "lost"]


def test_a_logarithmic_map_tells_its_values():
    def draw(ax: Axes) -> None:
        ax.scatter([0, 1, 2], [0, 1, 2], c=[1.0, 10.0, 100.0], norm=LogNorm())

    (cloud,) = figure_of(draw)["data"]
    assert numbers(cloud["marker"]["color"]) == pytest.approx([0.0, 0.5, 1.0])
    assert numbers(cloud["customdata"]).tolist() == [1.0, 10.0, 100.0]


def test_a_legend_of_its_own_switches_what_looks_like_it():
    def draw(ax: Axes) -> None:
        (solid,) = ax.plot([1, 2], [1, 2], "-", color="k")
        ax.plot([2, 1], [2, 3], "--", color="k")
        dashed = Line2D([], [], color="k", ls="--")
        ax.legend([solid, dashed, Patch(color="red")], ["stable", "unstable", "area"])

    stable, unstable, *entries = figure_of(draw)["data"]
    assert [entry["name"] for entry in entries] == ["stable", "unstable", "area"]
    assert stable["legendgroup"] == entries[0]["legendgroup"]
    assert unstable["legendgroup"] == entries[1]["legendgroup"]
    assert stable["legendgroup"] != unstable["legendgroup"]


def test_stable_and_unstable_branches_keep_their_lines():
    def draw(ax: Axes) -> None:
        ax.plot([1, 2], [1, 2], "-", label="stable")
        ax.plot([2, 1], [2, 3], "--", label="unstable")
        ax.set_yscale("log")

    stable, unstable = figure_of(draw)["data"]
    assert stable["line"]["dash"] == "solid"
    assert "px" in unstable["line"]["dash"]


def test_a_second_axis_and_levels():
    def draw(ax: Axes) -> None:
        ax.plot([0, 10], [1, 2])
        ax.axvline(5.0)
        beside = ax.twinx()
        beside.plot([0, 10], [100, 200])
        beside.set_ylabel("Hz")

    figure = figure_of(draw)
    assert [trace["yaxis"] for trace in figure["data"]] == ["y", "y3", "y2"]
    assert figure["layout"]["yaxis2"]["title"]["text"] == "Hz"
    assert figure["layout"]["yaxis2"]["side"] == "right"


def test_long_histories_keep_their_extremes():
    time = np.linspace(0.0, 1.0, 100_001)
    wave = np.sin(2 * np.pi * 5 * time)
    wave[33_333] = 7.0
    (line,) = figure_of(lambda ax: ax.plot(time, wave))["data"]
    assert numbers(line["y"]).size <= 20_002
    assert numbers(line["y"]).max() == 7.0
    assert numbers(line["x"])[[0, -1]].tolist() == [0.0, 1.0]


def test_bars_beside_a_value_have_its_name():
    def draw(ax: Axes) -> None:
        ax.plot([0, 3], [0, 3], label="line")
        ax.errorbar([1.0, 2.0], [1.0, 2.0], xerr=[0.5, 0.2], fmt="D", capsize=3, label="interval")
        ax.errorbar([1.0], [0.5], yerr=[0.1], ls="", color="red", label="bars alone")
        ax.legend()

    data = figure_of(draw)["data"]
    assert {one["name"] for one in data if one["showlegend"]} == {"line", "interval", "bars alone"}
    (marks,) = [one for one in data if one.get("name") == "interval" and one["showlegend"]]
    assert marks["mode"] == "markers"
    assert numbers(marks["x"]).tolist() == [1.0, 2.0]
    # The bars come and go with their values.
    assert sum(one.get("legendgroup") == marks["legendgroup"] for one in data) == 4


@pytest.mark.parametrize("names", [["pad"], ["pad", "root", "tip"]])
def test_names_along_an_axis_stay_names(names):
    def draw(ax: Axes) -> None:
        ax.broken_barh([(0.0, 1.0)], (-0.35, 0.7))
        ax.set_yticks(range(len(names)), names)

    axis = figure_of(draw)["layout"]["yaxis"]
    assert axis["ticktext"] == names
    assert axis["tickvals"] == list(range(len(names)))


@pytest.mark.slow
def test_what_plotly_cannot_draw_is_a_still_picture():
    def draw(ax: Axes) -> None:
        ax.contourf([[1, 2], [3, 4]])
        ax.set_ylabel("height")

    found = figure_of(draw)
    assert found.data == ""
    assert found.still.startswith("data:image/png;base64,")
    assert found.caption == "height"


def test_bars_stand_where_they_are_drawn_in_any_unit():
    def draw(ax: Axes) -> None:
        ax.bar([0.001, 0.003], [2.0, 3.0], 0.002, color="0.8", label="limit")
        ax.bar([0.001, 0.003], [1.0, 2.0], 0.001, label="traction")
        ax.set(xlabel="amplitude [m]")
        finish(ax, made=True)

    figure = figure_of(draw)
    assert figure["layout"]["barmode"] == "overlay"
    assert figure["layout"]["xaxis"]["title"]["text"] == "amplitude [mm]"
    wide, narrow = figure["data"]
    for bars, width in ((wide, 2.0), (narrow, 1.0)):
        assert numbers(bars["x"]) == pytest.approx([1.0, 3.0])
        assert numbers(bars["width"]) == pytest.approx([width, width])


@pytest.mark.parametrize(
    ("ends", "whole"), [((12.0, 40.0), True), ((0.1, 9.0), True), ((1e-7, 1.0), False)]
)
def test_a_logarithmic_axis_writes_whole_numbers_where_decades_are_few(ends, whole):
    def draw(ax: Axes) -> None:
        ax.plot([1, 2], [1, 2])
        ax.set(xscale="log", xlim=ends)

    axis = figure_of(draw)["layout"]["xaxis"]
    # Without a format plotly writes the 2 of 20 and of 0.2 alike.
    assert axis["tickformat"] == (".6~g" if whole else "")
    # A fixed step would leave what is enlarged without numbers.
    assert "dtick" not in axis
    assert 2 <= axis["nticks"] <= 8


def test_whole_numbers_have_a_tick_each():
    def draw(ax: Axes) -> None:
        ax.plot([2, 4], [1.0, 2.0], "o")
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))

    axis = figure_of(draw)["layout"]["xaxis"]
    assert (axis["tick0"], axis["dtick"]) == (0, 1)


def test_a_logarithmic_bar_of_colours_has_numbers_between_its_decades():
    def draw(ax: Axes) -> None:
        mesh = ax.pcolormesh([0, 1, 2], [0, 1], [[0.3, 2.5]], norm=LogNorm())
        number_bar(ax.figure.colorbar(mesh, ax=ax).ax)

    (heat,) = figure_of(draw)["data"]
    assert {"0.5", "1", "2"} <= set(heat["colorbar"]["ticktext"])


def test_long_titles_fit_beside_the_frame_and_lines_stay_lines():
    def draw(ax: Axes) -> None:
        ax.bar([0, 1], [1, 2])
        ax.set_xticks([0, 1], ["slip_\nforce", "gap"])
        ax.set_ylabel("prediction less measurement [standard deviations]")

    layout = figure_of(draw)["layout"]
    assert layout["yaxis"]["title"]["font"]["size"] < 12
    assert layout["xaxis"]["ticktext"] == ["slip_<br>force", "gap"]


def test_captions_say_what_colours_are():
    def draw(ax: Axes) -> None:
        mesh = ax.pcolormesh([0, 1, 2], [0, 1], [[1.0, 2.0]])
        ax.figure.colorbar(mesh, ax=ax, label="amplitude of tip [mm]")
        ax.set(xlabel="nodal diameter", ylabel="damping ratio")

    found = drawn(lambda *, ax: draw(ax))
    assert found.caption == "damping ratio over nodal diameter; colours: amplitude of tip [mm]"
    assert found.description == found.caption

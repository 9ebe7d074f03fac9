"""How reproductions are drawn: ticks, legends and insets where a reader can use them."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from stickslip_reproduce import COARSE, Axis, Panel, Plot, Series
from stickslip_reproduce.chapter_4_rings import SUBRESONANCES
from stickslip_reproduce.claims import numbers_of
from stickslip_reproduce.drawing import draw

OMEGA = np.linspace(0.0, 10.0, 101)


def drawn(plot):
    figure = draw(plot)
    FigureCanvasAgg(figure).draw()
    return figure


def test_a_legend_lies_on_no_curve():
    series = tuple(Series(f"P = {n} N", OMEGA, n + np.sin(OMEGA)) for n in range(8))
    for count in (1, 2, 6):
        figure = drawn(Plot(Axis("x"), Axis("y"), tuple(Panel(series) for _ in range(count))))
        (legend,) = figure.legends
        box = legend.get_window_extent()
        assert all(not box.overlaps(ax.get_window_extent()) for ax in figure.axes)
        assert len(legend.get_texts()) == len(series)


def test_whole_numbers_are_the_ticks():
    plot = Plot(Axis("harmonics"), Axis("y"), (Panel((Series("a", [1, 3, 21], [2, 3, 9]),)),))
    (ax,) = drawn(plot).axes
    assert ax.get_xticks().tolist() == [1, 3, 21]
    named = Plot(Axis("start", names=("good", "poor")), Axis("y"), plot.panels)
    labels = [text.get_text() for text in drawn(named).axes[0].get_xticklabels()]
    assert labels == ["good", "poor"]


def test_logarithmic_ticks_are_plain_numbers():
    series = Series("a", [1000, 100000], [2, 200])
    (ax,) = drawn(Plot(Axis("k", log=True), Axis("y", log=True), (Panel((series,)),))).axes
    written = [text.get_text() for text in ax.get_xticklabels()]
    assert {"1000", "10000", "100000"} <= set(written)


def test_an_inset_enlarges_a_range():
    hump = 5.0 * np.exp(-((OMEGA - 8.0) ** 2)) + 0.1 * np.exp(-20.0 * (OMEGA - 4.0) ** 2)
    axis = Axis("ω", "rad/s")
    panel = Panel((Series("a", OMEGA, hump), Series("b", OMEGA, 2.0 * hump)), enlarged=(3.0, 5.0))
    figure = drawn(Plot(axis, Axis("x", "m", "mm", 1e3), (panel,)))
    (inset,) = figure.axes[0].child_axes
    assert inset.get_xlim() == (3.0, 5.0)
    low, high = inset.get_ylim()
    assert high - low < 0.1 * np.ptp(figure.axes[0].get_ylim())
    assert high > 200.0
    assert len(inset.lines) == 2
    (handles,) = figure.legends
    assert len(handles.get_texts()) == 2


@pytest.mark.slow
def test_subresonances_of_the_ring_are_enlarged():
    panels = numbers_of("fig-4.21", COARSE).plot.panels
    assert [panel.enlarged for panel in panels] == [None, None, SUBRESONANCES]
    low, high = SUBRESONANCES
    assert low < 213.0 < 219.0 < high
    (first, *_) = panels[-1].series
    inside = first.y[(first.x > low) & (first.x < high)]
    # What the inset shows is too small to be seen on the axes of the panel.
    assert inside.max() < 0.3 * first.y.max()

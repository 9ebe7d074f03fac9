"""What figures write: names of the user, and the numbers of axes."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

import stickslip as ss
from stickslip.reference import snecma_beam


@pytest.mark.parametrize("name", ["cost$x^{$", "$b$", "_tip", r"a\frac{$", "5 $"])
def test_names_are_no_formulas_and_hide_nothing(name):
    beam = snecma_beam().structure
    structure = ss.Structure(beam.mass, beam.stiffness, beam.damping, ["damper", name, "mode"])
    contacts = [
        ss.Jenkins("damper", stiffness=2.4e7, slip_force=246.0, name=name),
        ss.Jenkins("mode", stiffness=2.4e5, slip_force=2.0),
    ]
    model = ss.Model(structure, contacts, [ss.Force(name, 20.0)])
    frf = ss.forced_response(model, np.linspace(150.0, 250.0, 9), 3)
    moved = ss.transient(model, 170.0, 3)
    drawn = [
        frf.plot(name),
        ss.plot.slip(frf),
        ss.plot.waveform(frf, [name, "damper"], 4),
        ss.plot.hysteresis(frf, 0, 4),
        ss.plot.history(moved, name),
        ss.plot.contact_history(moved, name),
    ]
    try:
        for ax in drawn:
            ax.figure.draw_without_rendering()
            texts = [ax.get_ylabel(), ax.get_title()]
            if ax.get_legend() is not None:
                texts += [text.get_text() for text in ax.get_legend().get_texts()]
            shown = [text.replace(r"\$", "$") for text in texts]
            assert any(name in text for text in shown)
    finally:
        plt.close("all")


@pytest.mark.parametrize("unit", ["m", "um", "auto"])
def test_an_axis_within_a_decade_has_several_numbers(unit):
    frf = ss.forced_response(snecma_beam(), [187.0, 188.0], 3)
    try:
        axis = frf.plot("damper", length_unit=unit, stuck=False, free=False).yaxis
        axis.figure.draw_without_rendering()
        low, high = axis.get_view_interval()
        shown = [
            label.get_text()
            for minor in (False, True)
            for place, label in zip(
                axis.get_ticklocs(minor=minor), axis.get_ticklabels(minor=minor), strict=True
            )
            if low <= place <= high and label.get_text()
        ]
        assert high < 10.0 * low
        assert len(shown) >= 3
    finally:
        plt.close("all")

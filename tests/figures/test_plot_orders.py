"""Linear limits of curves under several engine orders."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import plot
from stickslip.plot import style
from stickslip.plot.limits import limit_curve
from stickslip.reference import snecma_beam


@pytest.fixture(scope="module")
def sweep():
    beam = snecma_beam()
    disk = ss.BladedDisk(
        beam.structure,
        12,
        [ss.Coupling("tip", stiffness=1e5)],
        contacts=beam.contacts,
        forces=beam.forces,
        engine_order=1,
    )
    return ss.sweep(
        disk, lambda m: ss.forced_response(m, [160.0, 250.0], harmonics=1), engine_order=[1, 2, 4]
    )


def lines(ax, gid):
    return [one for one in ax.lines if one.get_gid() == gid]


def test_every_engine_order_has_limits_in_the_colour_of_its_curve(sweep, ax):
    sweep.plot("tip", ax=ax)
    limits, curves = lines(ax, style.LIMIT), lines(ax, style.RESPONSE)
    assert len(limits) == 6
    for order, result, curve in zip(range(3), sweep.results, curves, strict=True):
        for line, stuck in zip(limits[order::3], (True, False), strict=True):
            omega, amplitude = limit_curve(
                result.model, "tip", (160.0, 250.0), "half_range", stuck=stuck
            )
            np.testing.assert_array_equal(line.get_xdata(), omega)
            np.testing.assert_array_equal(line.get_ydata(), amplitude)
            assert line.get_color() == curve.get_color()
    named = [one.get_label() for one in limits if not one.get_label().startswith("_")]
    assert named == ["stuck (linear, each engine order)", "free (linear, each engine order)"]
    peaks = [max(one.get_ydata()) for one in limits[3:]]
    assert len({round(float(one), 9) for one in peaks}) == 3


def test_levels_of_one_engine_order_share_grey_limits(sweep, ax):
    disk = sweep.results[0].model
    levels = [
        ss.forced_response(disk.scaled(force=level), [160.0, 250.0], 1) for level in (1.0, 2.0)
    ]
    plot.curves(levels, "tip", ax=ax)
    assert [one.get_color() for one in lines(ax, style.LIMIT)] == [style.GREY] * 2


def test_several_engine_orders_where_one_is_asked_are_named(sweep):
    with pytest.raises(
        ss.ModelError, match=r"engine_order: \[2, 3\] is not a number; give a single one"
    ):
        ss.speed_response(snecma_beam(), [10.0], dof="tip", engine_order=[2, 3])


def test_every_stiffness_has_a_stuck_limit_and_all_one_free(ax):
    sweep = ss.sweep(
        snecma_beam(),
        lambda m: ss.forced_response(m, [160.0, 250.0], harmonics=1),
        stiffness=[1e6, 2.4e7],
    )
    sweep.plot("tip", ax=ax)
    curves = lines(ax, style.RESPONSE)
    *stuck, free = lines(ax, style.LIMIT)
    for line, curve, result in zip(stuck, curves, sweep.results, strict=True):
        omega, amplitude = limit_curve(
            result.model, "tip", (160.0, 250.0), "half_range", stuck=True
        )
        np.testing.assert_array_equal(line.get_xdata(), omega)
        np.testing.assert_array_equal(line.get_ydata(), amplitude)
        assert line.get_color() == curve.get_color()
    labels = [one.get_label() for one in (*stuck, free)]
    assert labels[0] == "stuck (linear, each stiffness)"
    assert labels[1].startswith("_")
    assert (labels[2], free.get_color()) == ("free (linear)", style.GREY)


def test_limits_of_the_first_result_that_has_some_are_named():
    beam = snecma_beam()
    stiffer = ss.Model(beam.structure, [replace(beam.contacts[0], stiffness=1e7)], beam.forces)
    bare = ss.Model(beam.structure, [], beam.scaled(force=2.0).forces)
    grid = [160.0, 250.0]
    point = ss.forced_response(stiffer, [200.0], 1)
    without, curve = (ss.forced_response(one, grid, 1) for one in (bare, beam))
    for first, named in (
        (point, "stuck (linear, each stiffness)"),
        (without, "stuck (linear)"),
    ):
        other = Figure().add_subplot()
        plot.curves([first, curve], "tip", ax=other)
        limits = lines(other, style.LIMIT)
        assert [one.get_label() for one in limits] == [named, "free (linear)"]

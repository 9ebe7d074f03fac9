"""Sweeps over engine orders, drawn and tabled over the speed of the rotor."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.study import Study
from stickslip.views.kinds import view_of
from swept_study import GRID, STUDY, curve

ORDERED = """
[disk]
sectors = 12
engine_order = 2

[[coupling]]
dof = "root"
stiffness = 1e5

[sweep]
engine_order = [2, 3]

[output]
omega_unit = "rpm"
"""


def test_engine_orders_are_swept_and_drawn_over_the_speed_of_the_rotor(tmp_path):
    (swept,) = Study.parse(STUDY + ORDERED).run()
    assert swept.labels == ("engine order = 2", "engine order = 3")
    tuned = Study.parse(STUDY + ORDERED).model
    alone = ss.BladedDisk(
        tuned.structure,
        12,
        couplings=tuned.couplings,
        contacts=tuned.contacts,
        forces=tuned.forces,
        engine_order=3,
    )
    own = ss.forced_response(alone, [700.0, 800.0, 900.0], 5)
    np.testing.assert_array_equal(swept.results[1].amplitude("tip"), own.amplitude("tip"))
    assert swept.to_dataset()["amplitude"].sel(engine_order=3).sizes["omega"] == 3
    swept.save(tmp_path / "a.nc")
    assert ss.load(tmp_path / "a.nc").results[1].model.engine_order == 3

    ax = swept.plot("tip", omega_unit="rpm")
    curves = {line.get_label(): line for line in ax.lines if line.get_gid() == "response"}
    for order, label in enumerate(swept.labels, 2):
        np.testing.assert_allclose(
            curves[label].get_xdata(), own.omega * 30.0 / np.pi / order, rtol=1e-12
        )
    assert ax.get_xlabel() == "rotor speed [rpm]"
    assert not ax.child_axes  # frequencies differ by order at one speed
    limits = [line.get_label() for line in ax.lines if "linear" in str(line.get_label())]
    assert len(limits) == len(set(limits)) == 2
    by_themselves = ss.plot.curves(list(swept.results), "tip", omega_unit="rpm")
    named = [text.get_text() for text in by_themselves.get_legend().get_texts()]
    assert {"EO 2", "EO 3"} < set(named)
    one = swept.results[0].plot("tip", omega_unit="rpm")
    assert one.get_xlabel() == "rotor speed at engine order 2 [rpm]"
    (table,) = view_of([swept]).tables([("", swept)], "", ["tip"], "auto")
    cells = {str(column.header): list(column.cells) for column in table.columns}
    for hertz, rpm, order in zip(cells["Hz"], cells["rotor rpm"], (2, 3), strict=True):
        assert float(rpm) == pytest.approx(float(hertz) * 60.0 / order, rel=1e-5)


def test_tables_have_rpm_where_they_are_asked_for():
    (found,) = Study.parse(STUDY).run()
    damped = ss.damper_curve(found.model, dof="tip", slip_force=[5.0, 20.0], omega=(700, 900))
    for result in (found, damped):
        for unit, headed in (("rad/s", False), ("Hz", False), ("rpm", True)):
            (table,) = view_of([result], unit).tables([("", result)], "", ["tip"], "auto")
            cells = {str(column.header): list(column.cells) for column in table.columns}
            assert ("rpm" in cells) == headed
            for omega, rpm in zip(cells["rad/s"], cells.get("rpm", ()), strict=headed):
                assert float(rpm) == pytest.approx(float(omega) * 30.0 / np.pi, rel=1e-5)


def test_a_mistuned_disk_under_another_engine_order_keeps_its_level():
    disk = ss.reference.beam_ring(sectors=4, engine_order=1)
    ring = disk.mistuned([0.01, 0.0, -0.01, 0.02]).scaled(force=0.5)
    found = ss.sweep(
        ring, lambda one: ss.forced_response(one, GRID, 3, observe=["2.damper"]), engine_order=[2]
    )
    own = ss.reference.beam_ring(sectors=4, engine_order=2).mistuned([0.01, 0.0, -0.01, 0.02])
    alone = ss.forced_response(own.scaled(force=0.5), GRID, 3, observe=["2.damper"])
    np.testing.assert_allclose(
        found.results[0].amplitude("2.damper"), alone.amplitude("2.damper"), rtol=1e-10
    )


@pytest.mark.parametrize(
    ("model", "keys", "message"),
    [
        (snecma_beam(), {"engine_order": [2]}, "is no bladed disk, so that it has no engine order"),
        (
            ss.reference.beam_ring(sectors=4),
            {"engine_order": [2], "contacts": 0},
            "an engine order is no parameter of contacts",
        ),
        (ss.reference.beam_ring(sectors=4), {"engine_order": [2.5]}, "engine_order"),
        (
            ss.BladedDisk(snecma_beam().structure, 4, engine_order=1, engine_orders={3: 4}),
            {"engine_order": [2]},
            "forces of harmonics '3' have orders of their own",
        ),
    ],
)
def test_engine_orders_that_cannot_be_swept(model, keys, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.sweep(model, curve, **keys)


def test_a_study_without_a_disk_has_no_engine_order():
    with pytest.raises(ss.ModelError, match="engine_order: that of a bladed disk; add the table"):
        next(Study.parse(STUDY + "[sweep]\nengine_order = [2]\n").run())

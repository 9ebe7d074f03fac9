"""Campbell and SAFE diagrams, slip forces by friction, engine orders on all sectors."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import plot
from stickslip.study import Study
from stickslip.views.kinds import view_of

RPM = np.pi / 30

DISK = """
[structure]
mass = [[1.2, 0, 0], [0, 0.35, 0], [0, 0, 0.25]]
stiffness = [[2.6e6, -1e6, 0], [-1e6, 3e6, -2e6], [0, -2e6, 2e6]]
damping = { modal = 0.001 }
dofs = ["disk", "blade", "tip"]
stiffening = [[0, 0, 0], [0, 0.35, 0], [0, 0, 0.5]]

[disk]
sectors = 24
engine_order = 4

[[coupling]]
dof = "disk"
stiffness = "5 kN/mm"

[[contact]]
law = "jenkins"
dofs = ["tip", "next.tip"]
stiffness = "100 N/mm"
slip_force = "10 N"

[[force]]
dof = "tip"
amplitude = "1 N"

[analysis]
"""


def blade(speed):
    """One mass whose stiffness grows with the speed: omega^2 = 4e4 + 2 W^2."""
    structure = ss.Structure([[1.0]], [[4e4 + 2.0 * speed**2]], ss.ModalDamping(0.01), ["tip"])
    return ss.Model(structure, forces=[ss.Force("tip", 1.0)])


@pytest.mark.slow
def test_crossings_are_where_the_order_meets_the_frequency():
    found = ss.campbell(blade, speed=np.linspace(50.0, 250.0, 4001), orders=[2, 4])
    # E^2 W^2 = 4e4 + 2 W^2
    exact = {order: np.sqrt(4e4 / (order**2 - 2)) for order in (2, 4)}
    assert [one.order for one in found.crossings()] == [4, 2]
    for one in found.crossings():
        assert one.speed == pytest.approx(exact[one.order], rel=1e-6)
        assert one.omega == pytest.approx(one.order * one.speed)
        assert (one.mode, one.diameter) == (0, 0)


def test_a_study_of_a_disk_agrees_with_its_nodal_diameters(tmp_path):
    text = 'kind = "campbell"\nspeed = ["1000 rpm", "6000 rpm"]\norders = [4, 22]'
    study = Study.parse(DISK + text)
    (found,) = study.run()
    assert isinstance(found, ss.Campbell)
    for place, speed in enumerate(found.speed):
        stiffness = study.model.structure.stiffness + speed**2 * np.diag([0.0, 0.35, 0.5])
        structure = ss.Structure(
            study.model.structure.mass, stiffness, dofs=["disk", "blade", "tip"]
        )
        disk = ss.BladedDisk(
            structure, 24, study.model.couplings, study.model.contacts, engine_order=4
        )
        table = disk.nodal_diameters()
        np.testing.assert_allclose(found.stuck[place], table.stuck, rtol=1e-10)
        np.testing.assert_allclose(found.slipping[place], table.slipping, rtol=1e-10)
    assert [found.place(order) for order in (4, 22, 24)] == [4, 2, 0]  # folded at half the sectors
    found.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc")
    np.testing.assert_array_equal(again.stuck, found.stuck)
    assert again.crossings() == found.crossings()
    (table,) = view_of([found]).tables([("", found)], "", (), "auto")
    assert table.row_count == len(found.crossings()) + len(found.crossings(slipping=True))


def test_the_diagram_has_the_modes_near_the_excitation():
    (found,) = Study.parse(DISK + 'kind = "campbell"\nspeed = ["1000 rpm", "3500 rpm"]').run()
    axes = found.plot()
    top = axes.get_ylim()[1]
    assert top == pytest.approx(1.15 * 4 * 3500 / 60)
    assert axes.get_xlabel() == "rotor speed [rpm]"
    drawn = [line for line in axes.lines if line.get_label().endswith("4, stuck")]
    assert len(drawn) == 1  # the first mode of nodal diameter 4 alone
    np.testing.assert_allclose(drawn[0].get_ydata(), found.stuck[:, 4, 0] / (2 * np.pi))


@pytest.mark.parametrize("kind", ["campbell", "safe"])
@pytest.mark.parametrize(("unit", "turns"), [("rad/s", 2 * np.pi), ("Hz", 1.0), ("rpm", 60.0)])
def test_diagrams_are_in_the_unit_of_frequency_that_is_asked_for(kind, unit, turns):
    written = f'{DISK}kind = "{kind}"\nspeed = ["1500 rpm", "3000 rpm"]\n'
    (found,) = Study.parse(written).run()
    tops = []
    for output in ("", f'[output]\nomega_unit = "{unit}"'):
        drawn = Study.parse(written + output).tables.output
        panel = view_of([found]).panels([found], (), drawn)[-1]
        axes = Figure().add_subplot()
        panel(ax=axes)
        tops.append(axes.get_ylim()[1])
    assert tops[1] == pytest.approx(turns * tops[0])
    assert axes.get_ylabel().endswith(f"[{unit}]")


def test_safe_shows_the_next_family_and_no_more():
    study = Study.parse(DISK + 'kind = "safe"\nspeed = ["3000 rpm"]')
    (found,) = study.run()
    drawing = view_of([found]).panels([found], (), study.tables.output)
    axes = Figure().add_subplot()
    drawing[0](ax=axes)
    assert axes.get_ylim()[1] < found.stuck[0, :, 1].max() / (2 * np.pi)
    assert "excitation at 3000 rpm" in axes.get_legend_handles_labels()[1]
    every = Figure().add_subplot()
    plot.safe(found.at(0), 3000 * RPM, modes=3, ax=every)
    with pytest.raises(ss.ModelError, match="index: 9 is too large; give at most"):
        found.at(9)
    assert every.get_ylim()[1] > found.stuck[0].max() / (2 * np.pi)


def test_a_diagram_begins_at_rest_and_one_speed_needs_no_list():
    text = DISK + 'kind = "campbell"\nspeed = { from = "0 rpm", to = "6000 rpm", points = 3 }'
    (found,) = Study.parse(text).run()
    np.testing.assert_allclose(found.speed, np.array([0.0, 3000.0, 6000.0]) * RPM)
    assert all(one.speed > 0.0 for one in found.crossings())
    one, listed = (
        Study.parse(DISK + f'kind = "safe"\nspeed = {text}').run()
        for text in ('"3000 rpm"', '["3000 rpm"]')
    )
    np.testing.assert_array_equal(next(one).stuck, next(listed).stuck)
    with pytest.raises(ss.ModelError, match="'log' has no 0"):
        Study.parse(text.replace("points = 3", 'points = 3, spacing = "log"'))


def test_nodal_diameters_need_no_speed():
    (found,) = Study.parse(DISK + 'kind = "nodal-diameters"').run()
    (table,) = view_of([found]).tables([("", found)], "", (), "auto")
    assert table.row_count == 2 * 13
    assert found.stuck.shape == (1, 13, 3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.campbell(blade), "speed: a campbell diagram needs it"),
        (lambda: ss.campbell(blade, speed=[100.0]), "speed: one alone makes no line"),
        (lambda: ss.campbell(blade, speed=["3 m", "5 m"]), "'3 m' is not a frequency"),
        (
            lambda: ss.campbell(blade, speed=[-1.0, 5.0]),
            r"speed\[0\] is -1; give finite values from 0",
        ),
        (
            lambda: ss.campbell(blade, speed=[0.0, 5.0], diagram="safe"),
            "nothing is excited at rest",
        ),
        (lambda: ss.campbell(lambda w: w, speed=[1.0, 5.0]), "models: it returned 1.0, no Model"),
        (lambda: ss.campbell(3, speed=[1.0, 5.0]), "models: 3 is neither"),
        (lambda: ss.campbell(blade, speed=[1.0], diagram="safe"), "that of a tuned disk"),
        (lambda: ss.campbell(blade, speed=[1.0, 2.0], orders=[0]), "orders"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call()


def test_friction_times_normal_load_is_the_slip_force():
    made = ss.Jenkins("tip", stiffness=1e6, friction="30 %", normal_load="0.8 kN")
    assert made == ss.Jenkins("tip", stiffness=1e6, slip_force=240.0)
    study = Study.parse(
        DISK.replace('slip_force = "10 N"', 'friction = 0.5\nnormal_load = "20 N"')
        + "omega = [100]"
    )
    assert study.model.contacts[0].slip_force == 10.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "slip_force is missing; give slip_force=..., or friction=... and normal_load"),
        ({"friction": 0.3}, "slip_force is missing"),
        ({"friction": 0.3, "normal_load": 3, "slip_force": 1}, "slip_force is given beside them"),
        ({"friction": 0.3, "slip_force": 1}, "slip_force is given beside them"),
        ({"friction": -0.3, "normal_load": 3}, "friction -0.3 is negative"),
        ({"friction": 0.3, "normal_load": "3 m"}, "normal_load = '3 m' is not a force"),
    ],
)
def test_slip_forces_that_are_no_product(values, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.Jenkins("tip", stiffness=1e6, **values)


WHOLE = """
[structure]
mass = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
stiffness = [[3e4, -1e4, 0, -1e4], [-1e4, 3e4, -1e4, 0], [0, -1e4, 3e4, -1e4], [-1e4, 0, -1e4, 3e4]]
damping = { modal = 0.01 }
dofs = ["1.tip", "2.tip", "3.tip", "4.tip"]

[[force]]
dof = "*.tip"
amplitude = "2 N"
engine_order = 1

[analysis]
omega = [100, 140]
harmonics = 1
"""


def test_one_table_forces_all_sectors():
    model = Study.parse(WHOLE).model
    (found,) = Study.parse(WHOLE).run()
    sector = ss.Structure([[1.0]], [[1e4]], dofs=["tip"])
    disk = ss.BladedDisk(
        sector,
        4,
        [ss.Coupling("tip", stiffness=1e4)],
        forces=[ss.Force("tip", 2.0)],
        engine_order=1,
    )
    assert [force.phase for force in model.forces] == pytest.approx(
        [force.phase for force in disk.mistuned(0).forces]
    )
    shape = found.coefficients("1.tip")[:, 1] / found.coefficients("2.tip")[:, 1]
    np.testing.assert_allclose(shape, np.exp(-0.5j * np.pi), rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("engine_order = 1", ""), "'dof' with a star.*belong together"),
        (('"*.tip"', '"1.tip"'), "'dof' with a star.*belong together"),
        (('"*.tip"', '"*.root"'), "force 1: .*no sectors among"),
        (('"3.tip"', '"7.tip"'), "sectors 1, 2, 4, 7 among"),
        (('"*.tip"', '"*.*"'), "write one star"),
    ],
)
def test_sectors_that_are_not_there(change, message):
    with pytest.raises(ss.ModelError, match=message):
        Study.parse(WHOLE.replace(*change))


def test_the_optimal_damper_is_a_study():
    text = DISK + 'kind = "optimal-damper"\ndof = "tip"\nbounds = ["1 N", 100]\nharmonics = 3\n'
    (found,) = Study.parse(text + 'omega = { from = "190 Hz", to = "204 Hz" }').run()
    assert isinstance(found, ss.OptimalDamper)
    assert found.bounds == (1.0, 100.0)
    direct = ss.optimal_damper(
        found.curve.model, dof="tip", bounds=(1, 100), harmonics=3, omega=("190 Hz", "204 Hz")
    )
    assert found.value == direct.value
    with pytest.raises(ss.ModelError, match="bounds = '1 m' is not a force"):
        Study.parse(text.replace('["1 N"', '["1 m"'))


@pytest.mark.slow
def test_reports_draw_them(tmp_path):
    from report_page import Page

    studies = (
        'kind = "campbell"\nspeed = ["1000 rpm", "6000 rpm"]',
        'kind = "safe"\nspeed = [314]',
    )
    (one,), (two,) = (Study.parse(DISK + text).run() for text in studies)
    ss.report({"campbell": one, "safe": two}, tmp_path / "a.html")
    figures = Page(tmp_path / "a.html").figures
    titles = [figure["layout"]["xaxis"]["title"]["text"] for figure in figures]
    assert titles == ["rotor speed [rpm]", "nodal diameter"]


@pytest.mark.slow
def test_aerodynamic_damping_takes_percent_and_waves_that_decay_leave_no_empty_axes():
    kind = 'kind = "flutter-map"\ndamping_ratio = '
    written = f"{kind}{['0.2 %'] * 24}".replace("'", '"')
    (found,) = Study.parse(DISK + written).run()
    (plain,) = Study.parse(DISK + kind + f"{[0.002] * 24}").run()
    np.testing.assert_allclose(found.arrays.rest_aerodynamic_ratio, 0.002, rtol=1e-12)
    np.testing.assert_array_equal(plain.rest_ratio, found.rest_ratio)
    axes = found.plot("tip")
    assert [text.get_text() for text in axes.texts] == ["all waves decay"]


def test_speeds_in_any_order_and_a_mistuned_disk():
    speeds = np.linspace(50.0, 250.0, 9)
    mixed = ss.campbell(blade, speed=speeds[[4, 0, 7, 2, 8, 1, 3, 6, 5]], orders=[2, 4])
    ascending = ss.campbell(blade, speed=speeds, orders=[2, 4])
    assert len(mixed.crossings()) == 2
    assert mixed.crossings() == ascending.crossings()
    drawn = mixed.plot().lines[2]
    np.testing.assert_allclose(drawn.get_xdata(), speeds / RPM)

    disk = ss.BladedDisk(
        blade(0.0).structure, 8, forces=[ss.Force("tip", 1.0)], engine_order=3, couplings=[]
    )
    tuned = ss.campbell(disk, speed=[50.0, 100.0])
    mistuned = ss.campbell(disk.mistuned(np.zeros(8)), speed=[50.0, 100.0])
    assert mistuned.orders == tuned.orders == (3,)
    assert mistuned.crossings()[0].speed == pytest.approx(200.0 / 3)


def test_a_speed_that_changes_nothing_is_refused(tmp_path):
    text = DISK.replace("stiffening = [[0, 0, 0], [0, 0.35, 0], [0, 0, 0.5]]", 'speed = "3000 rpm"')
    (tmp_path / "study.toml").write_text(text + "omega = [100.0]\n", encoding="utf-8")
    with pytest.raises(ss.ModelError, match="'speed' without 'stiffening' changes nothing"):
        Study.load(tmp_path / "study.toml")


def test_engine_order_0_has_no_line():
    disk = ss.BladedDisk(
        blade(0.0).structure, 8, forces=[ss.Force("tip", 1.0)], engine_order=0, couplings=[]
    )
    for diagram in ("campbell", "safe"):
        with pytest.raises(ss.ModelError, match="forces of engine order 0 have no frequency"):
            ss.campbell(disk, speed=[50.0, 100.0], diagram=diagram)
        assert ss.campbell(disk, speed=[50.0, 100.0], diagram=diagram, orders=[2]).orders == (2,)
    assert ss.campbell(disk, diagram="nodal-diameters").stuck.shape == (1, 5, 1)

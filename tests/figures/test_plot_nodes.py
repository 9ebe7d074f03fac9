"""Figures, tables and reports of contacts with components."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import stickslip as ss
from stickslip import plot
from stickslip.study import Study
from stickslip.views.curves import CurveView

DOFS = ["x", "y", "z"]
VALUES = {"friction": 0.4, "tangential_stiffness": 5e4, "normal_stiffness": 8e4}


def response(dofs=DOFS, normal=(0, 0, 1), **changes):
    structure = ss.Structure(
        np.eye(3), np.diag([4e4, 9e4, 1.6e5]), np.diag([8.0, 10.0, 16.0]), DOFS
    )
    pad = ss.Coulomb(dofs, normal=normal, **VALUES | {"preload": 15.0} | changes, name="pad")
    forces = [ss.Force("x", 30.0), ss.Force("y", 25.0, phase=-1.5), ss.Force("z", 40.0)]
    return ss.forced_response(ss.Model(structure, [pad], forces), [180.0, 260.0, 370.0], 5)


@pytest.fixture(scope="module")
def space():
    return response()


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_hysteresis_has_a_loop_per_direction(space):
    ax = space.plot_hysteresis("pad", 0)
    force, motion = space.contact_force("pad", 0), space.contact_waveform("pad", 0)
    for part, line in enumerate(ax.lines[:2]):
        np.testing.assert_array_equal(line.get_xdata()[:-1], motion[:, part])
        np.testing.assert_array_equal(line.get_ydata()[:-1], force[:, part])
        assert line.get_label().startswith(f"t{part + 1}, ")
    assert len(ax.lines) == 2


def test_traction_lies_in_the_cone(space):
    ax = space.plot_hysteresis("pad", 0, plane=True)
    loop, *circles = (line.get_xydata() for line in ax.lines)
    np.testing.assert_array_equal(loop[:-1], space.contact_force("pad", 0)[:, :2])
    radii = [np.linalg.norm(circle, axis=1).max() for circle in circles]
    assert np.linalg.norm(loop, axis=1).max() <= max(radii) * (1.0 + 1e-12)
    assert len(space.plot_hysteresis(("pad", 0), [0, 1], plane=True).lines) == 2


def test_plane_needs_two_directions():
    planar = response(["x", "z"], (0, 1))
    with pytest.raises(ss.ModelError, match="'pad': it has no two tangential directions"):
        planar.plot_hysteresis("pad", 0, plane=True)
    assert planar.plot_hysteresis("pad", 0).lines[0].get_label().startswith("t, ")


def test_forces_over_time(space):
    (ax,) = plot.contact_forces(space, "pad", 0)
    force = space.contact_force("pad", 0, 1024)
    for part, name in enumerate(("t1", "t2", "N")):
        assert ax.lines[part].get_label() == name
        np.testing.assert_array_equal(ax.lines[part].get_ydata()[:-1], force[:, part])
    np.testing.assert_allclose(ax.lines[3].get_ydata()[:-1], 0.4 * force[:, 2])


def test_states_are_bars(space):
    states = space.contact_states("pad", 2)
    assert set(states.direction.ravel().tolist()) == {1, 2}
    held = response(preload=100.0)
    stuck = held.contact_states("pad", 1)
    share = stuck.length[stuck.direction[:, 0] == 0].sum()
    assert 0.01 < share == pytest.approx(1.0 - held.slip_fraction("pad")[1, 0], abs=3e-3)
    for code, share in ((1, space.slip_fraction("pad")), (2, space.open_fraction("pad"))):
        found = states.length[states.direction[:, 0] == code].sum()
        assert found == pytest.approx(share[2, 0], abs=3e-3)
    ax = plot.events(space, 2)
    assert {one.get_label() for one in ax.collections} >= {"slips", "open"}
    assert [one.get_text() for one in ax.get_yticklabels()] == ["pad"]


def test_shares_over_frequency(space):
    ax = space.plot_slip()
    assert [line.get_label() for line in ax.lines] == ["pad", "pad open"]


def test_curves_with_linear_limits(space):
    ax = space.plot("x")
    labels = [line.get_label() for line in ax.lines]
    assert any("stuck" in label for label in labels)
    assert any("free" in label for label in labels)


def test_results_are_told_apart():
    ax = plot.curves([response(), response(friction=0.2)], "x", stuck=False, free=False)
    assert any(r"$\mu$ = 0.4" in line.get_label() for line in ax.lines)


def test_facts_say_the_states(space):
    told = dict(CurveView().about(space))
    slips, opens = space.slip_fraction("pad"), space.open_fraction("pad")
    assert f"slips {slips.min():.0%} to {slips.max():.0%}" in told["states"]
    assert f"open {opens.min():.0%} to {opens.max():.0%}" in told["states"]


STUDY = """
[structure]
mass = [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]
stiffness = [[4e4, 0, 0], [0, 9e4, 0], [0, 0, 1.6e5]]
damping = { modal = 0.02 }
dofs = ["x", "y", "z"]

[[contact]]
law = "coulomb"
dofs = ["x", "y", "z"]
normal = [0, 0, 1]
friction = "40 %"
tangential_stiffness = "50 N/mm"
normal_stiffness = "80 kN/m"
preload = "15 N"

[[force]]
dof = "x"
amplitude = 30

[[force]]
dof = "z"
amplitude = 40

[analysis]
kind = "forced-response"
omega = [180, 370]
harmonics = 3
"""


@pytest.mark.slow
def test_a_study_file_makes_the_same_contact(tmp_path):
    (tmp_path / "pad.toml").write_text(STUDY)
    study = Study.load(tmp_path / "pad.toml")
    (contact,) = study.model.contacts
    assert contact == ss.Coulomb(DOFS, normal=[0, 0, 1], preload=15.0, **VALUES, name="coulomb")
    (result,) = study.run()
    ss.report(result, path=tmp_path / "pad.html")
    page = (tmp_path / "pad.html").read_text()
    assert "coulomb: open" in page


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"40 %"', "-1", "contact 1: friction = -1 must not be negative"),
        ('"15 N"', '"15 kg"', "contact 1: preload = '15 kg' is not a force"),
        ("normal = [0, 0, 1]", "normal = [0, 1]", "normal: (0.0, 1.0); give 3 numbers"),
        ("normal = [0, 0, 1]", 'normal = ["z"]', "contact 1: normal"),
        ("preload", "preloads", "did you mean 'preload'"),
        ("normal = [0, 0, 1]\n", "", "no normal, a constant load, with 3 dofs"),
        ('dofs = ["x", "y", "z"]\nnormal', 'dofs = ["x", "y", "w"]\nnormal', "unknown dof 'w'"),
        ('preload = "15 N"', 'preload = 1\ngap = "1 um"', "give one of the two"),
    ],
)
def test_study_files_are_refused_kindly(tmp_path, old, new, message):
    (tmp_path / "pad.toml").write_text(STUDY.replace(old, new, 1))
    with pytest.raises(ss.ModelError) as refusal:
        _ = Study.load(tmp_path / "pad.toml").model
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert "None" not in str(refusal.value)


def test_many_nodes_in_a_study_file(tmp_path):
    many = STUDY.replace(
        'law = "coulomb"\ndofs = ["x", "y", "z"]\nnormal = [0, 0, 1]',
        'law = "coulomb"\ndofs = [["x", "y"], ["y", "z"]]\nnormal = [[0, 1], [1, 1]]',
    ).replace('"15 N"', '["15 N", 20]')
    (tmp_path / "many.toml").write_text(many)
    (contact,) = Study.load(tmp_path / "many.toml").model.contacts
    assert contact.shape == (2, 2)
    assert contact.preload == (15.0, 20.0)

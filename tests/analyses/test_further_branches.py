"""Branches of a forced curve that the one from the end of its range does not come by."""

from types import SimpleNamespace

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core


def absorber(force: float) -> ss.Model:
    """A Duffing oscillator with a nonlinear tuned vibration absorber (Detroux et al. 2015)."""
    structure = ss.Structure(
        mass=np.diag([1.0, 0.05]),
        stiffness=[[1.0454, -0.0454], [-0.0454, 0.0454]],
        damping=[[0.0148, -0.0128], [-0.0128, 0.0128]],
        dofs=["x", "d"],
    )
    springs = [ss.Cubic("x", stiffness=1.0), ss.Cubic("x", "d", stiffness=0.0042)]
    return ss.Model(structure, springs, [ss.Force("x", force)])


def state_of(frf: ss.ForcedResponse, index: int) -> ss.State:
    series = np.array([frf.coefficients(dof)[index] for dof in frf.dofs])
    rate = 1j * frf.omega[index] * np.arange(series.shape[1])
    return ss.State(frf.model, series.real.sum(1), (rate * series).real.sum(1))


def settles(frf: ss.ForcedResponse, index: int, push: float) -> float:
    """How far a motion that begins near a point ends from it, relative to its amplitude."""
    start = state_of(frf, index)
    begin = ss.State(frf.model, (1.0 + push) * start.displacement, start.velocity)
    omega = float(frf.omega[index])
    run = ss.transient(frf.model, omega, 600, "rk4", start=begin, steps=200, samples=64, keep=1)
    amplitude = frf.amplitude("x")[index]
    return float(abs(run.amplitude("x") / amplitude - 1.0))


@pytest.mark.parametrize("force", [0.15, 0.17])
def test_the_isola_of_an_absorber_is_found_and_followed_until_it_closes(force: float) -> None:
    frf = ss.forced_response(absorber(force), (0.5, 3.5), 5)
    isola = np.flatnonzero(frf.branch == 1)
    assert frf.branch.max() == 1
    assert frf.arrays.solved.all()
    # It closes, with a fold at either end, and is far above the curve.
    assert frf.omega[isola[0]] == pytest.approx(frf.omega[isola[-1]], rel=1e-9)
    assert np.isin(frf.folds, isola).sum() == 2
    assert frf.amplitude("x")[isola].max() > 2.0 * frf.amplitude("x")[frf.branch == 0].max()
    (told,) = [one for one in frf.diagnostics if one.code == "further-branches"]
    assert told.data["count"] == 1
    assert told.data["low"] == frf.omega[isola].min()
    # Its stable motions are found by time integration, the unstable ones are left.
    stable, unstable = (isola[frf.stability[isola] == state] for state in ("stable", "unstable"))
    assert settles(frf, int(stable[stable.size // 2]), 1e-3) < 1e-2
    assert settles(frf, int(unstable[frf.amplitude("x")[unstable].argmin()]), 1e-3) > 0.1
    assert frf.peak("x").amplitude >= frf.amplitude("x")[isola].max()


def test_where_the_isola_has_merged_with_the_curve_there_is_one_branch() -> None:
    frf = ss.forced_response(absorber(0.19), (0.5, 3.5), 5, stability=False)
    assert frf.branch.max() == 0
    assert "further-branches" not in {one.code for one in frf.diagnostics}
    assert frf.amplitude("x").max() > 2.9


def test_a_branch_whose_fold_lies_outside_of_the_range_is_found() -> None:
    """The curve stays large to the end of the range; small motions exist there, too."""
    structure = ss.Structure([[1.0]], [[1.0]], [[0.1]], ["x"])
    model = ss.Model(structure, [ss.Cubic("x", stiffness=1.0)], [ss.Force("x", 1.0)])
    whole = ss.forced_response(model, (0.3, 4.0), 9, stability=False)
    part = ss.forced_response(model, (0.3, 2.5), 9, stability=False)
    assert (whole.branch.max(), part.branch.max()) == (0, 1)
    assert part.peak("x").at_edge
    small = np.flatnonzero(part.branch == 1)
    assert part.omega[small[[0, -1]]] == pytest.approx([2.5, 2.5])
    # Both ends of it and the curve are the three motions at the end of the range.
    amplitude, omega = whole.amplitude("x"), whole.omega
    ahead = np.flatnonzero((omega[:-1] - 2.5) * (omega[1:] - 2.5) < 0.0)
    share = (2.5 - omega[ahead]) / (omega[ahead + 1] - omega[ahead])
    expected = amplitude[ahead] + share * (amplitude[ahead + 1] - amplitude[ahead])
    ends = [*np.flatnonzero(part.branch == 0)[-1:], small[0], small[-1]]
    found = np.sort(part.amplitude("x")[ends])
    assert found == pytest.approx(np.sort(expected), rel=5e-3)


def test_branches_are_kept_in_files_and_drawn_apart(tmp_path) -> None:
    frf = ss.forced_response(absorber(0.15), (0.5, 3.5), 5)
    frf.save(tmp_path / "curve.nc")
    assert (ss.load(tmp_path / "curve.nc").branch == frf.branch).all()
    axes = frf.plot("x")
    begins = frf.omega[np.flatnonzero(frf.branch == 1)[0]]
    lines = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) > 2]
    for x in lines:
        inside = np.isclose(np.asarray(x)[1:], begins, rtol=1e-9)
        assert not (inside & (np.asarray(x)[:-1] == frf.omega[frf.branch == 0][-1])).any()


def test_a_further_branch_that_ends_inside_the_range_is_told(monkeypatch) -> None:
    core = _core.forced_response

    def cut(*given, **named):
        solution = core(*given, **named).solution(None)
        solution.cut = 1
        return SimpleNamespace(interrupted=False, computed=1, solution=lambda _: solution)

    monkeypatch.setattr(_core, "forced_response", cut)
    frf = ss.forced_response(absorber(0.15), (0.5, 3.5), 5, stability=False)
    (told,) = [one for one in frf.diagnostics if one.code == "further-branches"]
    assert told.data["cut"] == 1
    assert "1 of them could not be followed" in told.text

"""Peaks: refined to the true maximum, and honest about what they may have missed."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core
from stickslip.reference import snecma_beam

GRID = np.linspace(150.0, 250.0, 60)

# computed independently: converged peaks of the tip [m] and their frequencies.
CONVERGED = [(2.188, 0.6778e-3, 224.19), (20.313, 1.4548e-3, 192.93), (38.438, 6.0031e-3, 162.43)]


@pytest.fixture(scope="module")
def frf():
    return ss.forced_response(snecma_beam(), GRID, harmonics=9)


@pytest.fixture
def stalled():
    """Without iterations only the stuck points, which are linear, are solved."""
    return ss.forced_response(snecma_beam(), GRID, harmonics=9, max_iterations=1)


@pytest.mark.parametrize(("force", "amplitude", "omega"), CONVERGED)
def test_peak_against_exact_orbits(force, amplitude, omega):
    frf = ss.forced_response(snecma_beam(force), np.linspace(140, 250, 45), observe=["tip"])
    peak = frf.peak("tip")
    assert peak.amplitude == pytest.approx(amplitude, rel=2e-3)
    assert peak.omega == pytest.approx(omega, abs=0.5)
    assert not peak.at_edge
    assert peak.amplitude >= np.nanmax(frf.amplitude("tip"))
    assert frf.peak("tip") is peak


def test_peak_does_not_depend_on_the_grid():
    peaks = [
        ss.forced_response(snecma_beam(38.438), np.linspace(120, 240, n), 5).peak("tip")
        for n in (20, 77)
    ]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)


def test_peak_of_rivals():
    """The grid favours the lower of two peaks: its point sits on top, the other's beside."""
    structure = ss.Structure(np.eye(2), np.diag([1.0, 4.0]), np.diag([0.02, 0.04]), ["a", "b"])
    total = ss.Structure(
        [[1.0, 0.0], [0.0, 1.0]], [[2.5, -1.5], [-1.5, 2.5]], structure.damping, ["a", "b"]
    )
    frf = ss.forced_response(ss.Model(total, forces=[ss.Force("a", 1.0)]), [0.5, 0.97, 1.5, 2, 3])
    fine = ss.forced_response(frf.model, np.linspace(0.9, 2.1, 20001), 1)
    assert frf.peak("a").amplitude == pytest.approx(fine.amplitude("a").max(), rel=1e-6)


def test_peak_at_an_edge(frf):
    falling = ss.forced_response(snecma_beam(), np.linspace(200, 240, 9), 9)
    peak = falling.peak("tip")
    assert peak.at_edge
    assert not peak.beside_gap
    assert peak[:2] == (200.0, falling.amplitude("tip")[0])
    single = ss.forced_response(snecma_beam(), [200.0], 9).peak("tip")
    assert single == (200.0, pytest.approx(peak.amplitude, rel=1e-9), True, False)
    assert not frf.peak("tip").at_edge


def test_peak_passes_over_failed_points(stalled):
    known = stalled.converged
    assert 0 < known.sum() < 60
    with pytest.warns(UserWarning, match=r"peak of 'tip': \d+ of 60 points are not solved"):
        peak = stalled.peak("tip")
    assert peak.beside_gap
    assert peak.amplitude >= stalled.amplitude("tip")[known].max()
    nothing = replace(stalled, arrays=replace(stalled.arrays, status=np.full(60, 1, np.uint8)))
    with pytest.raises(ss.ModelError, match="peak of 'tip': none of the 60 points is solved"):
        nothing.peak("tip")
    assert nothing.summary() == []


def test_peak_of_a_dof_at_rest():
    structure = ss.Structure(np.eye(2), 9 * np.eye(2), 0.1 * np.eye(2), ["a", "b"])
    frf = ss.forced_response(ss.Model(structure, forces=[ss.Force("a", 1.0)]), [1.0, 2.0, 3.5], 1)
    assert frf.peak("b").amplitude == 0.0


def test_summary(frf):
    rows = frf.summary()
    assert [row.dof for row in rows] == list(frf.dofs)
    tip = rows[1]
    assert (tip.omega, tip.amplitude, tip.at_edge, tip.beside_gap) == frf.peak("tip")
    assert tip.error_estimate == frf.error_estimate("tip")[frf.index(tip.omega)]
    assert tip.harmonics == 9


def test_summary_refines_only_the_peaks_asked_for(monkeypatch):
    frf = ss.forced_response(snecma_beam(), GRID, harmonics=5)
    sought = []
    whole = _core.summits
    monkeypatch.setattr(_core, "summits", lambda *args: sought.append(args[1]) or whole(*args))
    (row,) = frf.summary(["tip"])
    assert frf.summary("tip") == [row]
    assert row.dof == "tip"
    assert sought == [[[frf.model.structure.index("tip")]]]
    frf.summary()
    assert len(sought) == 2
    assert len(sought[1]) == 2


@pytest.mark.parametrize(
    ("dofs", "message"),
    [
        (["tpi"], r"unknown dof 'tpi'; did you mean 'tip'\?"),
        ([["tip"]], r"dof: \['tip'\] is not text"),
        (3, "dofs: 3 is not a list of names; leave it out for all"),
    ],
)
def test_wrong_summary(frf, dofs, message):
    with pytest.raises(ss.ModelError, match=message):
        frf.summary(dofs)


# ---------------------------------------------------------------------------------- gaps


def two_masses(points, **options):
    structure = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 1e4]], ss.ModalDamping(0.002), ["root", "tip"]
    )
    contacts = [ss.Jenkins("root", stiffness=2e4, slip_force=5.0)]
    model = ss.Model(structure, contacts, [ss.Force("tip", 1.0)])
    return ss.forced_response(model, np.linspace(30.0, 190.0, points), 9, **options)


@pytest.mark.parametrize("points", [40, 200])
def test_a_peak_beside_unsolved_points_says_so(points):
    lost = two_masses(points, max_iterations=1)
    with pytest.warns(UserWarning, match=r"beside the maximum.*see status") as caught:
        peak = lost.peak("tip")
    assert len(caught) == 1
    assert "\n" not in str(caught[0].message)
    assert caught[0].filename == __file__
    assert peak.beside_gap
    assert lost.peak("tip") is peak
    assert lost.summary(["tip"])[0].beside_gap
    whole = two_masses(points).peak("tip")
    assert not whole.beside_gap
    assert peak.amplitude < 0.8 * whole.amplitude


def without(frf, failed):
    status = np.array(frf.arrays.status)
    status[failed] = ss.Status.STALLED.code
    return replace(frf, arrays=replace(frf.arrays, status=status))


@pytest.mark.parametrize(("offset", "beside"), [(-1, True), (1, True), (-9, False), (9, False)])
def test_only_gaps_beside_the_maximum_count(frf, offset, beside):
    best = int(frf.amplitude("tip").argmax())
    gappy = without(frf, [best + offset])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if beside else "error")
        assert gappy.peak("tip").beside_gap is beside


def test_a_maximum_next_to_unsolved_ends_is_beside_a_gap(frf):
    best = int(frf.amplitude("tip").argmax())
    with pytest.warns(UserWarning, match="beside the maximum"):
        assert without(frf, np.arange(best + 1, 60)).peak("tip").beside_gap


def test_the_order_of_the_sweep_hides_no_gap(frf):
    best = int(frf.amplitude("tip").argmax())
    shuffled = np.random.default_rng(4).permutation(60)
    arrays = frf.arrays
    turned = ss.forced_response(frf.model, arrays.omega[shuffled], 9)
    gap = int(np.flatnonzero(shuffled == best + 1)[0])
    with pytest.warns(UserWarning, match="1 of 60 points are not solved"):
        assert without(turned, [gap]).peak("tip").beside_gap


def test_a_search_without_any_solution_leaves_the_computed_maximum(frf, monkeypatch):
    stalled = (np.nan, np.nan, 0, ss.Status.STALLED.code, 0, np.nan, False)
    monkeypatch.setattr(_core, "summits", lambda *_: [stalled])
    fresh = replace(frf)
    amplitude = frf.amplitude("tip")
    with pytest.warns(UserWarning, match="could not be solved everywhere"):
        peak = fresh.peak("tip")
    assert peak[:2] == (frf.omega[amplitude.argmax()], amplitude.max())
    assert peak.beside_gap

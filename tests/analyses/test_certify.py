"""Certificates: the true error of a harmonic balance, at chosen and at random points."""

import pickle
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core
from stickslip.reference import snecma_beam
from stickslip.results.certificate import Certificate

# the module, which the function of the same name hides in the package


@pytest.fixture(scope="module")
def coarse():
    """15 harmonics, which err by 5 % near 168 rad/s."""
    return ss.forced_response(snecma_beam(31.475), np.linspace(150.0, 200.0, 51), 15)


@pytest.fixture(scope="module")
def certified(coarse):
    return ss.certify(coarse, "all")


def test_the_error_is_that_against_exact_orbits(coarse, certified):
    certificate = certified.certificate
    assert certificate.dofs == coarse.dofs
    assert certificate.indices.tolist() == list(range(51))
    exact = ss.exact_response(coarse.model, coarse.omega)
    for column, dof in enumerate(coarse.dofs):
        error = coarse.amplitude(dof) - exact.amplitude(dof)
        np.testing.assert_allclose(certificate.error[:, column], error, rtol=1e-6, atol=1e-15)
        np.testing.assert_array_equal(certificate.amplitude[:, column], exact.amplitude(dof))
        np.testing.assert_array_equal(certificate.estimate[:, column], coarse.error_estimate(dof))
    tip = certificate.relative[:, certificate.column("tip")]
    # 15 harmonics: 4.97 % too high at the peak
    assert tip[coarse.index(168.0)] == pytest.approx(0.055, abs=0.01)
    assert (certificate.waveform_error >= np.abs(certificate.error) * (1 - 1e-3)).all()
    assert set(certificate.status) == {ss.Status.CONVERGED}
    assert certificate.tolerance is None
    assert certificate.within_tolerance is None


def test_the_worst_point_is_named(certified):
    certificate = certified.certificate
    worst = certificate.worst
    assert abs(worst.relative) == np.abs(certificate.relative).max()
    assert certified.omega[worst.position] == worst.omega
    place = certificate.indices.tolist().index(worst.position)
    column = certificate.column(worst.dof)
    assert worst.error == certificate.error[place, column]
    assert worst.estimate == certified.error_estimate(worst.dof)[worst.position]
    assert repr(certificate).startswith("Certificate(51 points, largest error +")
    held = np.abs(certificate.error) <= certificate.estimate
    np.testing.assert_array_equal(certificate.within_estimate, held)


@pytest.mark.slow
@pytest.mark.parametrize("load", [2.188, 20.313, 31.475])
def test_automatic_harmonics_keep_their_tolerance(load):
    frf = ss.forced_response(snecma_beam(load), (150.0, 230.0), observe=["tip", "damper"])
    certificate = ss.certify(frf, 40).certificate
    assert certificate.tolerance == 1e-3
    assert certificate.within_tolerance.all()


def test_random_points_are_those_of_their_seed(coarse):
    first, same, other = (ss.certify(coarse, 7, seed=seed).certificate for seed in (3, 3, 4))
    assert first.indices.tolist() == same.indices.tolist() != other.indices.tolist()
    assert len(set(first.indices.tolist())) == 7
    assert (np.diff(first.indices) > 0).all()
    np.testing.assert_array_equal(first.error, same.error)
    assert ss.certify(coarse, 1000).certificate.indices.size == 51
    assert ss.certify(coarse).certificate.indices.size == 20


def test_chosen_points_and_dofs(coarse):
    certificate = ss.certify(coarse, [5, -1, 5], dofs="tip").certificate
    assert certificate.indices.tolist() == [5, 50]
    assert certificate.dofs == ("tip",)
    np.testing.assert_array_equal(certificate.omega, coarse.omega[[5, 50]])
    with pytest.raises(ss.ModelError, match=r"unknown dof 'mode'.*; name it in certify"):
        certificate.column("mode")


def test_the_given_curve_is_left_alone(coarse, certified):
    assert coarse.certificate is None
    assert certified.arrays is coarse.arrays
    assert certified.assumptions == coarse.assumptions
    assert not certified.certificate.error.flags.writeable
    with pytest.raises(AttributeError):
        certified.certificate = None


@pytest.mark.slow
def test_it_is_kept_in_files_and_copies(certified, tmp_path):
    certified.save(tmp_path / "curve.nc")
    for again in (ss.load(tmp_path / "curve.nc"), pickle.loads(pickle.dumps(certified))):
        mine, theirs = certified.certificate, again.certificate
        assert theirs.dofs == mine.dofs
        assert theirs.tolerance == mine.tolerance
        for name in ("indices", "omega", "code", "amplitude", "error", "waveform_error"):
            one, other = getattr(mine, name), getattr(theirs, name)
            assert one.dtype == other.dtype
            assert one.tobytes() == other.tobytes()
            assert not other.flags.writeable
    dataset = certified.to_dataset()
    assert dataset["certified_error"].dims == ("certified", "certified_dof")
    assert dataset["certified_error"].attrs["units"] == "m"
    uncertified = ss.forced_response(snecma_beam(), [170.0], 3).to_dataset()
    assert "certified_error" not in uncertified


def test_points_without_solution_are_passed_over():
    frf = ss.forced_response(snecma_beam(), np.linspace(150, 250, 60), 9, max_iterations=1)
    solved = np.flatnonzero(frf.arrays.solved)
    assert solved.size < 60
    certificate = ss.certify(frf, "all").certificate
    np.testing.assert_array_equal(certificate.indices, solved)
    failed = int(np.flatnonzero(~frf.arrays.solved)[0])
    with pytest.raises(ss.ModelError, match=rf"points: point {failed} is not solved \(stalled\)"):
        ss.certify(frf, [failed])


def test_a_certificate_without_orbits():
    missing = np.full((1, 1), np.nan)
    certificate = Certificate(
        dofs=("tip",),
        tolerance=1e-3,
        indices=np.array([3]),
        omega=np.array([170.0]),
        code=np.array([5], dtype=np.uint8),
        amplitude=missing,
        error=missing,
        waveform_error=missing,
        estimate=np.ones((1, 1)),
    )
    assert certificate.worst is None
    assert repr(certificate) == "Certificate(1 points, none with an orbit)"
    assert certificate.status == ("orbit stalled",)
    assert not certificate.within_tolerance.any()
    assert not certificate.within_estimate.any()


@pytest.mark.slow
def test_an_interrupted_certification_keeps_what_was_compared():
    frf = ss.forced_response(snecma_beam(), np.linspace(150.0, 250.0, 4000), 9, observe="tip")

    def stop(_):
        raise KeyboardInterrupt

    message = r"certification interrupted after \d+ of 4000 points"
    with pytest.raises(ss.Interrupted, match=message) as it:
        ss.certify(frf, "all", progress=stop)
    certificate = it.value.result.certificate
    assert 0 < certificate.indices.size < 4000
    # Parts are followed at a time: the points that were found, in order, perhaps with a gap.
    assert (np.diff(certificate.indices) > 0).all()
    np.testing.assert_array_equal(certificate.omega, frf.omega[certificate.indices])
    last = certificate.indices[-2:]
    own = ss.certify(frf, last.tolist()).certificate
    np.testing.assert_allclose(certificate.amplitude[-2:], own.amplitude, rtol=1e-9)


def test_an_interruption_while_orbits_are_followed_keeps_them_all(coarse, monkeypatch):
    whole = ss.ExactResponse.waveforms

    def stop(self, index, samples):
        if index == 20:
            raise KeyboardInterrupt
        return whole(self, index, samples)

    monkeypatch.setattr(ss.ExactResponse, "waveforms", stop)
    message = "interrupted after 51 of 51 points, 20 of them over the whole period"
    with pytest.raises(ss.Interrupted, match=message) as it:
        ss.certify(coarse, "all")
    certificate = it.value.result.certificate
    assert np.isfinite(certificate.error).all()
    assert np.isfinite(certificate.waveform_error[:20]).all()
    assert np.isnan(certificate.waveform_error[20:]).all()


def test_waveforms_are_compared_at_once_for_all_dofs(coarse, certified):
    exact = ss.exact_response(coarse.model, coarse.omega[[30]], harmonics=1)
    for column, dof in enumerate(coarse.dofs):
        apart = np.abs(coarse.waveform(dof, 30, 1024) - exact.waveform(dof, 0, 1024)).max()
        assert certified.certificate.waveform_error[30, column] == pytest.approx(apart, rel=1e-6)


def test_orbits_are_run_once_per_point(coarse, monkeypatch):
    runs = []
    whole = _core.orbit_history
    monkeypatch.setattr(_core, "orbit_history", lambda *all_: runs.append(1) or whole(*all_))
    ss.certify(coarse, 7)
    assert len(runs) == 7


def test_progress_covers_the_comparison(coarse, monkeypatch):
    monkeypatch.setattr("stickslip.analyses.run.REPORT_EVERY", 0.0)
    shares = []
    ss.certify(coarse, "all", progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert sum(0.5 < share < 1.0 for share in shares) >= 40


def test_rounding_beside_a_static_load_is_no_error():
    structure = ss.Structure([[2.0, 0.1], [0.1, 1.0]], [[9, -3], [-3, 5]], [[0.4, 0], [0, 0.3]])
    model = ss.Model(
        structure,
        [ss.Jenkins(structure.dofs[0], stiffness=10.0, slip_force=100.0)],
        [ss.Force(structure.dofs[1], 0.7, harmonic=0)],
    )
    frf = ss.forced_response(model, np.linspace(0.5, 3.0, 20), 5)
    certificate = ss.certify(frf, "all").certificate
    assert certificate.worst.relative == 0.0
    assert not certificate.error.any()


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        ("some", {}, """points: 'some'; give "all", a number, or positions"""),
        (0, {}, "points: 0 lies below 1"),
        (1.5, {}, "points: 1.5 is not an integer"),
        (True, {}, "points: True is not an integer"),
        ([], {}, "points: empty; give at least one position"),
        ([51], {}, "index: 51; there are 51 points, 0 to 50"),
        ([1.0], {}, "points: 1.0 is not an integer"),
        (3, {"seed": -1}, "seed: -1 lies below 0"),
        (3, {"dofs": "tpi"}, r"unknown dof 'tpi'; did you mean 'tip'\?"),
        (3, {"dofs": []}, "dofs: empty"),
        (3, {"dofs": 3}, "dofs: 3 is not a list"),
        (3, {"progress": 1}, "progress: 1 cannot be called"),
    ],
)
def test_bad_input_is_refused_in_one_line(coarse, points, options, message):
    with pytest.raises(ss.ModelError, match=message) as refused:
        ss.certify(coarse, points, **options)
    assert "\n" not in str(refused.value)


def test_only_a_balance_is_certified(coarse):
    with pytest.raises(ss.ModelError, match="result: 'x' is not a ForcedResponse"):
        ss.certify("x")
    with pytest.raises(ss.ModelError, match="result: is exact already"):
        ss.certify(ss.exact_response(coarse.model, [170.0]))


# ------------------------------------------------------------------------------- tuned disks


def tuned(sectors, order, contacts, forces):
    """A ring whose blades have two DOFs, tied by springs and by blocks of a cyclic matrix."""
    blade = ss.Structure(
        [[1.0, 0.1], [0.1, 0.8]],
        [[4e4, -1e4], [-1e4, 3e4]],
        ss.Rayleigh(mass=0.2, stiffness=2e-6),
        ["root", "tip"],
    )
    return ss.BladedDisk(
        blade,
        sectors,
        [ss.Coupling("tip", "root", stiffness=3e3, damping=0.02)],
        contacts,
        forces,
        engine_order=order,
        interface=ss.Interface([[500.0, 200.0], [-300.0, 100.0]], mass=[[0.01, 0.0], [0.02, 0.0]]),
    )


GROUND = ss.Jenkins("tip", stiffness=1e4, slip_force=2.0)
SHROUD = ss.Jenkins("tip", "next.root", stiffness=2e4, slip_force=5.0)
RUBBER = ss.StructuralDamper(
    ["tip", "next.tip"], stiffness=[[2e4, -1e4], [-1e4, 1.5e4]], slip_forces=[4.0, 8.0]
)
PUSH = ss.Force("root", 30.0, phase=0.3)


@pytest.mark.parametrize(
    ("sectors", "order", "contacts", "forces"),
    [
        (8, 3, [GROUND, SHROUD], [PUSH]),  # opposite sectors move oppositely
        (7, 2, [SHROUD], [PUSH, ss.Force("tip", 10.0, harmonic=3)]),  # an odd number of sectors
        (9, 6, [RUBBER], [PUSH]),  # sectors that move alike
        (6, 3, [SHROUD], [PUSH]),  # one sector, against itself mirrored
        (5, 0, [GROUND], [PUSH]),  # all alike
        (6, 1, [GROUND, SHROUD], [PUSH, ss.Force("tip", 15.0, harmonic=2)]),  # even harmonics
        (5, 2, [GROUND, SHROUD], [PUSH, ss.Force("tip", 4.0, harmonic=0)]),  # a static load
    ],
)
def test_the_wave_of_a_disk_is_the_orbit_of_all_sectors(sectors, order, contacts, forces):
    disk = tuned(sectors, order, contacts, forces)
    omega = np.array([0.85, 1.0]) * ss.natural_frequencies(disk)[0]
    wave = ss.certify(ss.forced_response(disk, omega, 9), "all").certificate
    whole = ss.exact_response(disk.mistuned(0), omega)
    assert set(wave.code) == {0}
    assert whole.slip_fraction("0." + disk.contacts[-1].name).max() > 0.01
    for column, dof in enumerate(wave.dofs):
        np.testing.assert_allclose(
            wave.amplitude[:, column], whole.amplitude(f"0.{dof}"), rtol=1e-9
        )
    assert np.abs(wave.relative).max() > 1e-5


def test_waveforms_of_a_wave_are_compared():
    disk = tuned(6, 1, [GROUND, SHROUD], [PUSH])
    omega = ss.natural_frequencies(disk)[:1]
    coarse = ss.forced_response(disk, omega, 5)
    whole = ss.exact_response(disk.mistuned(0), omega)
    apart = np.abs(coarse.waveform("tip", 0, 1024) - whole.waveform("0.tip", 0, 1024)).max()
    certificate = ss.certify(coarse, "all", dofs="tip").certificate
    assert certificate.waveform_error[0, 0] == pytest.approx(apart, rel=1e-6)


def test_sectors_that_nothing_ties_cost_one():
    blade = snecma_beam(31.475)
    disk = ss.BladedDisk(
        blade.structure, 36, contacts=blade.contacts, forces=blade.forces, engine_order=5
    )
    wave = ss.certify(ss.forced_response(disk, [168.0], 15), "all").certificate
    alone = ss.certify(ss.forced_response(blade, [168.0], 15), "all").certificate
    np.testing.assert_allclose(wave.error, alone.error, rtol=1e-6)


def test_a_disk_is_certified_in_part_after_an_interruption():
    disk = tuned(6, 1, [GROUND], [PUSH])
    curve = ss.forced_response(disk, np.linspace(150.0, 200.0, 3000), 5)

    def stop(_):
        raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match=r"interrupted after \d+ of 3000 points") as it:
        ss.certify(curve, "all", progress=stop)
    assert 0 < it.value.result.certificate.indices.size < 3000


def test_points_are_named_where_an_interruption_left_gaps(coarse, certified, monkeypatch):
    found = [0, 1, 2, 30]

    def orbits_at(model, omega, *_):
        partial = ss.exact_response(model, omega[found], observe=coarse.dofs)
        return replace(partial, interrupted=True)

    monkeypatch.setattr(import_module("stickslip.analyses.certify"), "orbits_at", orbits_at)
    with pytest.raises(ss.Interrupted, match="after 4 of 51 points") as it:
        ss.certify(coarse, "all")
    certificate = it.value.result.certificate
    assert certificate.indices.tolist() == found
    np.testing.assert_allclose(certificate.error, certified.certificate.error[found], rtol=1e-6)

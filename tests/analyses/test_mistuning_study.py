"""Mistuning studies: factors of the table, peaks that nothing misses, the same bits every time."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip import _core
from stickslip.disk import BladedDisk, mistuning_pattern
from stickslip.disk.mistuned import tuned_disk
from stickslip.disk.pattern import drawn_patterns
from stickslip.results.status import Status
from stickslip.settings.balance import BalanceSettings

SPAN = (150.0, 260.0)
UNIFORM = np.random.default_rng(0).uniform(-np.sqrt(3.0), np.sqrt(3.0), 36)

# computed independently: uniform pattern of seed 0, 7 %, engine order 3, at the damper; H = 1 and 3
TABLE = {
    1e3: (1.198, 1.244),
    3e3: (1.429, 1.465),
    5e3: (1.579, 1.637),
    7e3: (1.684, 1.575),
    1.2e4: (1.450, 1.370),
    1e5: (1.111, 1.095),
}


def ring(sectors=6, coupling=7e3, damping=None, shroud=False, slip_force=246.048, **options):
    disk = ss.reference.beam_ring(sectors, coupling, 1)
    beam = disk.structure
    if damping is not None:
        beam = ss.Structure(beam.mass, beam.stiffness, damping, beam.dofs)
    contacts = [ss.Jenkins("damper", stiffness=2.4e7, slip_force=slip_force)]
    if shroud:
        contacts.append(ss.Jenkins("tip", "next.tip", stiffness=5e4, slip_force=5.0))
    return BladedDisk(
        beam, sectors, disk.couplings, contacts, disk.forces, engine_order=1, **options
    )


def study(disk=None, deviation=0.05, **options):
    settings = {"omega": SPAN, "patterns": 4, "seed": 1, "harmonics": 3, "threads": 1} | options
    return ss.mistuning_study(disk or ring(), deviation, **settings)


@pytest.fixture(scope="module")
def small():
    return study(deviation=[0.02, 0.05], coupling_stiffness=[3e3, 7e3], patterns=40)


def bits(result):
    arrays = result.arrays
    names = ("omega", "amplitude", "blade", "status", "harmonics", "error_estimate", "at_edge")
    return [getattr(arrays, name).tobytes() for name in names]


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "column"), [(1, 0), (3, 1)])
def test_amplification_factors_are_those_of_the_table(harmonics, column):
    disk = ss.reference.beam_ring(engine_order=3)
    result = study(
        disk, 0.07, patterns=UNIFORM, coupling_stiffness=list(TABLE), harmonics=harmonics
    )
    expected = [factors[column] for factors in TABLE.values()]
    assert result.amplification("damper").ravel() == pytest.approx(expected, rel=6e-4)
    assert result.blade("damper")[0, 3, 0] == 13


@pytest.mark.slow
def test_a_converged_factor_is_that_of_the_table():
    disk = ss.reference.beam_ring(coupling=1e5, engine_order=3)
    result = study(disk, 0.07, patterns=UNIFORM, harmonics=19, dofs="damper", omega=(215, 250))
    assert result.amplification("damper").item() == pytest.approx(1.191, rel=5e-3)
    assert result.error("damper").item() < 0.02


@pytest.mark.slow
@pytest.mark.parametrize(
    ("disk", "deviation"),
    [
        (ring(12, 1e3), 0.05),
        (ring(12, 1e5), 0.05),
        (ring(12, shroud=True), 0.05),
        (ring(8, damping=ss.Rayleigh(mass=0.4)), 0.12),
        (ring(8, damping=ss.ModalDamping(0.001), slip_force=2000.0), 0.12),
    ],
    ids=["weak", "strong", "shroud", "light", "stuck"],
)
def test_no_peak_is_missed(disk, deviation):
    # A fine sweep of every blade: none of its points may lie above the peaks found.
    span = (130.0, 290.0)
    result = study(disk, deviation, patterns=2, omega=span, dofs=["damper", "tip"])
    grid = np.arange(*span, 0.1)
    for number, pattern in enumerate(result.patterns):
        frf = ss.forced_response(disk.mistuned(deviation * pattern), grid, 3)
        for dof in result.dofs:
            amplitudes = frf.blade_amplitudes(dof)
            highest = np.unravel_index(amplitudes.argmax(), amplitudes.shape)
            found = result.amplitude(dof)[0, 0, number]
            assert 0.999 * found < amplitudes[highest] <= found * (1.0 + 1e-7)
            assert result.blade(dof)[0, 0, number] == highest[1]
            assert result.omega(dof)[0, 0, number] == pytest.approx(grid[highest[0]], abs=0.11)


def test_blades_without_couplings_are_each_for_themselves():
    disk, pattern = ring(4), np.array([1.0, -1.0, 0.3, 0.0])
    result = study(disk, 0.05, patterns=pattern, coupling_stiffness=[0.0], dofs="damper")
    beam, peaks = disk.structure, []
    for factor in 1.0 + 0.05 * pattern:
        blade = ss.Structure(beam.mass, factor * beam.stiffness, beam.damping_law, beam.dofs)
        model = ss.Model(blade, disk.contacts, disk.forces)
        peaks.append(ss.forced_response(model, np.linspace(*SPAN, 56), 3).peak("damper").amplitude)
    assert result.blade("damper").item() == np.argmax(peaks)
    assert result.amplitude("damper").item() == pytest.approx(max(peaks), rel=1e-7)
    assert result.tuned("damper").item() == pytest.approx(peaks[3], rel=1e-7)


def test_the_tuned_peak_and_no_deviation():
    disk = ring()
    result = study(disk, 0.0, patterns=1)
    frf = ss.forced_response(disk, np.linspace(*SPAN, 111), 3)
    assert result.tuned("tip").item() == pytest.approx(frf.peak("tip").amplitude, rel=1e-7)
    assert result.amplification("tip").item() == pytest.approx(1.0, abs=1e-9)
    assert result.error("tip").item() > 0.0
    # Engine orders that make no single wave: all sectors of the tuned disk are computed.
    forces = [*disk.forces, ss.Force("tip", 4.0, harmonic=3)]
    several = ring(engine_orders={3: 2}).replaced(forces=forces)
    assert study(several, 0.0, patterns=1).amplification("tip").item() == pytest.approx(1.0)


@pytest.mark.parametrize(
    "damping", [ss.Rayleigh(mass=2.0, stiffness=1e-5), ss.ModalDamping(0.01), 0.02 * np.eye(3)]
)
def test_the_disks_are_those_of_mistuned(damping):
    K1 = np.zeros((3, 3))
    K1[0, 1] = -50.0
    disk = ring(4, damping=damping, shroud=True, interface=ss.Interface(K1))
    pattern = mistuning_pattern(4, 0.1, seed=5)
    made = tuned_disk(disk).mistuned(pattern)
    grid, observe, driving = np.array([180.0, 220.0]), np.arange(12), np.arange(0)
    given = grid, observe, driving, BalanceSettings.of(harmonics=3, max_iterations=50), None
    mine, theirs = (
        _core.forced_response(one, *given).solution(None).columns["displacement"]
        for one in (made, disk.mistuned(pattern).problem)
    )
    gap = np.abs(mine - theirs).max()
    assert gap < 1e-11 * np.abs(mine).max()


@pytest.mark.slow
def test_the_same_bits_with_any_threads_in_any_company(small):
    options = {"deviation": [0.02, 0.05], "coupling_stiffness": [3e3, 7e3], "patterns": 40}
    assert bits(study(**options, threads=3)) == bits(small)
    alone = study(patterns=3)
    assert np.array_equal(alone.patterns, small.patterns[:3])
    assert np.array_equal(alone.amplitude("tip")[0, 0], small.amplitude("tip")[1, 1, :3])


@pytest.mark.slow
def test_patterns_drawn_and_given(small):
    many = drawn_patterns(6, 4000, "normal", seed=2)
    assert many.mean() == pytest.approx(0.0, abs=0.02)
    assert many.std() == pytest.approx(1.0, rel=0.02)
    uniform = drawn_patterns(6, 500, "uniform")
    assert np.sqrt(3.0) * 0.99 < np.abs(uniform).max() <= np.sqrt(3.0)
    assert np.array_equal(drawn_patterns(6, 7, seed=2), many[:7])
    assert not np.array_equal(drawn_patterns(6, 7, seed=3), many[:7])
    given = study(patterns=small.patterns[:2])
    assert np.array_equal(given.amplitude("tip")[0, 0], small.amplitude("tip")[1, 1, :2])
    assert "were given" in given.assumptions[0]
    assert "seed 1" in small.assumptions[0]


@pytest.mark.slow
def test_shapes_choice_and_statistics(small):
    factors = small.amplification("tip")
    assert factors.shape == (2, 2, 40)
    assert small.status.shape == (2, 2, 40, 2)
    assert (small.status == Status.CONVERGED).all()
    assert small.dofs == ("tip", "damper")
    chosen = small.factors("tip", deviation=0.05, coupling=3e3)
    assert np.array_equal(chosen, factors[1, 0])
    fit = small.weibull("tip", deviation=0.05, coupling=3e3)
    assert fit.location.value > chosen.max()
    assert 0.0 < fit.distance < 0.2
    high = small.percentile("tip", 99.0, deviation=0.05, coupling=3e3)
    assert high.low < high.value < high.high
    own = small.percentile("tip", 50.0, method="empirical", deviation=0.05, coupling=3e3)
    assert own.low < np.median(chosen) == own.value < own.high
    assert small.counters["disks"] == 160
    assert "160 of 160 disks found" in repr(small)


@pytest.mark.slow
def test_disks_that_were_not_found_may_have_any_factor(small):
    """Those with the highest factors are the hardest ones."""
    where = {"deviation": 0.05, "coupling": 3e3}
    whole = small.percentile("tip", 80.0, method="empirical", **where)
    highest = np.argsort(small.amplification("tip")[1, 0])[-3:]
    for status in (Status.STALLED, Status.NOT_COMPUTED):
        amplitude, code = small.arrays.amplitude.copy(), small.arrays.status.copy()
        amplitude[1, 0, highest], code[1, 0, highest] = np.nan, status.code
        arrays = replace(small.arrays, amplitude=amplitude, status=code)
        found = replace(small, arrays=arrays).percentile("tip", 80.0, method="empirical", **where)
        assert found.value < whole.value
        if status == Status.STALLED:
            assert found.low < whole.low
            assert found.high >= whole.high
        else:
            assert found.high < whole.high


@pytest.mark.slow
def test_files_and_pickles(small, tmp_path):
    small.save(tmp_path / "study.nc")
    for again in (ss.load(tmp_path / "study.nc"), pickle.loads(pickle.dumps(small))):
        assert isinstance(again, ss.MistuningStudy)
        assert bits(again) == bits(small)
        assert again.settings == small.settings
        assert np.array_equal(again.tuned("tip"), small.tuned("tip"))
        assert not again.arrays.amplitude.flags.writeable
    dataset = small.to_dataset()
    assert dataset["amplification"].dims == ("deviation", "coupling_stiffness", "pattern", "dof")
    assert np.array_equal(dataset["amplification"][..., 0], small.amplification("tip"))


@pytest.mark.slow
def test_figures(small):
    figure = Figure()
    above, below, aside = figure.subplots(3, 1)
    small.plot_distribution("tip", deviation=0.05, coupling=3e3, ax=above)
    disks, fit = above.lines[:2]
    assert disks.get_xdata() == pytest.approx(
        np.sort(small.factors("tip", deviation=0.05, coupling=3e3))
    )
    found = small.weibull("tip", deviation=0.05, coupling=3e3)
    x, y = fit.get_data()
    assert np.exp(-np.exp(-y)) == pytest.approx(found.cdf(x), abs=1e-9)
    labels = above.get_legend_handles_labels()[1]
    high = small.percentile("tip", 99.9, deviation=0.05, coupling=3e3)
    assert f"99.9 %: {high.value:.4g} ({high.low:.4g} to {high.high:.4g}, 95%)" in labels
    small.plot_deviation("tip", ax=below)
    mean = small.amplification("tip").mean(axis=-1)
    assert below.lines[0].get_ydata() == pytest.approx(mean[:, 0])
    small.plot_coupling("tip", ax=aside)
    assert aside.lines[0].get_ydata() == pytest.approx(mean[0])
    assert aside.get_xscale() == "log"
    few = study(patterns=3)
    few.plot_distribution("tip", ax=figure.add_subplot())
    assert "3 disks: no fit, 3 factors for" in figure.axes[-1].get_title()


def test_a_peak_that_cannot_be_found_says_why():
    # One iteration is enough for a tuned disk that just sticks, not for a louder blade that slips.
    disk = ring(slip_force=3000.0)
    pattern = np.array([[1.0, -1.0, 0.5, -0.5, 0.2, 0.0], [0.0] * 6])
    result = study(disk, 0.05, patterns=pattern, max_iterations=1, omega=(205.0, 250.0))
    broken, good = result.status[0, 0, :, 0]
    assert good == Status.CONVERGED
    assert broken == Status.STALLED
    assert np.isnan(result.amplification("tip")[0, 0, 0])
    assert result.blade("tip")[0, 0, 0] == -1
    assert any("1 stalled" in text or "2 stalled" in text for text in result.assumptions)


def test_ctrl_c_keeps_what_was_computed():
    def stop(share):
        raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match="interrupted after") as caught:
        study(ring(12), patterns=2000, threads=2, progress=stop)
    partial = caught.value.result
    done = partial.counters["disks"]
    assert 0 < done < 2000
    assert partial.interrupted
    found = np.isfinite(partial.amplification("tip"))
    assert found.sum() == done
    assert (partial.status[~partial.arrays.solved] == Status.NOT_COMPUTED).all()


@pytest.mark.slow
def test_progress_and_what_a_callback_raises():
    shares = []
    study(patterns=60, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0

    def fail(_):
        raise RuntimeError("bar broke")

    with pytest.raises(RuntimeError, match="bar broke"):
        study(ring(12), patterns=2000, progress=fail)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"disk": ss.reference.snecma_beam()}, "disk: .* is no BladedDisk; give the tuned disk"),
        ({"omega": [150, 260]}, "omega: give a range"),
        ({"omega": (150, 150)}, "omega: the range .150, 150. must have two different ends"),
        ({"deviation": -0.1}, r"deviation\[0\] is -0.1; give 0.05 for 5 %, not negative"),
        ({"deviation": [0.1, 0.1]}, "holds a value twice"),
        ({"deviation": "7 m"}, "deviation = '7 m' is not a ratio"),
        ({"deviation": 0.9}, "deviation: 0.9 leaves blade . of pattern . the stiffness -"),
        ({"patterns": 0}, "patterns: 0 lies below 1"),
        ({"patterns": True}, "patterns: True is not an integer"),
        ({"patterns": np.zeros((2, 5))}, r"patterns: shape \(2, 5\) for 6 sectors; give \(p, 6\)"),
        ({"patterns": [[np.nan] * 6]}, r"patterns\[0, 0\] is nan; give finite numbers"),
        ({"patterns": "many"}, "patterns: 'many'; give their number"),
        ({"dofs": ["tpi"]}, "unknown dof of a sector 'tpi'; did you mean 'tip'"),
        ({"dofs": ["tip", "tip"]}, "'tip' is given more than once"),
        ({"dofs": []}, "dofs: no dof"),
        ({"distribution": "gauss"}, "distribution: unknown choice 'gauss'"),
        ({"measure": "rms"}, "measure: unknown choice 'rms'"),
        ({"threads": 0}, "threads: 0 lies below 1"),
        ({"seed": -1}, "seed: -1 lies below 0"),
        ({"coupling_stiffness": [-1.0]}, r"coupling_stiffness\[0\] is -1"),
        ({"progress": 1}, "progress: 1 cannot be called"),
        ({"store": "no/such/folder.db"}, "there is no folder no/such; create it first"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, message):
    with pytest.raises(ss.ModelError, match=message) as refused:
        study(**options)
    assert "\n" not in str(refused.value)


def test_what_has_no_factor_is_refused():
    lone = BladedDisk(ring().structure, 6, forces=ring().forces, engine_order=1)
    with pytest.raises(ss.ModelError, match="the disk has no couplings that could take it"):
        study(lone, coupling_stiffness=1e3)
    with pytest.raises(ss.ModelError, match="dof 'damper': it does not move; give the disk forces"):
        study(ring().replaced(forces=[]), dofs="damper")
    result = study(patterns=3)
    with pytest.raises(ss.ModelError, match="3 factors for three parameters; compute at least 30"):
        result.weibull("tip")
    with pytest.raises(ss.ModelError, match="unknown dof of the study 'mode'"):
        result.amplification("mode")
    with pytest.raises(ss.ModelError, match=r"deviation: 0.1 was not studied; give one of 0.05"):
        result.factors("tip", deviation=0.1)
    many = study(deviation=[0.01, 0.02], patterns=1)
    with pytest.raises(ss.ModelError, match=r"deviation: there are 2; give one of 0.01, 0.02"):
        many.factors("tip")


def test_damping_of_modes_with_stuck_contacts_is_refused():
    """It does not go with the root of the stiffness, as the core takes it."""
    glued = ss.Jenkins("damper", stiffness=2.4e7, slip_force=np.inf)
    disk = ring(damping=ss.ModalDamping(0.01, stuck=[glued]))
    with pytest.raises(ss.ModelError, match=r"stuck=...\) of sectors that deviate .* one by one"):
        ss.mistuning_study(disk, 0.1, omega=SPAN, patterns=2)

import os
import runpy
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.study import Study

EXAMPLES = Path(__file__).parents[2] / "examples"

# computed independently: exact orbits; tip [m] and frequency [rad/s] of the peaks by load [N]
TIP_PEAKS = {
    0.938: (0.3709e-3, 225.58),
    2.188: (0.6778e-3, 224.19),
    6.563: (0.7216e-3, 216.49),
    16.563: (1.2175e-3, 194.01),
    20.313: (1.4548e-3, 192.93),
    25.0: (1.8185e-3, 177.98),
    31.475: (2.9847e-3, 169.05),
    38.438: (6.0031e-3, 162.43),
}


@pytest.fixture(scope="module")
def curves():
    study = Study.load(EXAMPLES / "snecma-beam" / "study.toml")
    return dict(zip([case.level for case in study.cases], study.run(), strict=True))


@pytest.mark.slow
@pytest.mark.parametrize(("load", "expected"), TIP_PEAKS.items())
def test_the_beam_peaks_where_the_exact_orbits_do(curves, load, expected):
    peak = curves[load].peak("tip")
    assert peak.amplitude == pytest.approx(expected[0], rel=2e-3)
    assert peak.omega == pytest.approx(expected[1], rel=2e-3)
    assert curves[load].converged.all()


@pytest.mark.slow
def test_the_script_gives_what_the_study_gives(curves, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    script = EXAMPLES / "snecma-beam" / "beam.py"
    runpy.run_path(os.fspath(script), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) == len(TIP_PEAKS)
    saved = ss.load("snecma-beam-20.313.nc")
    curve = curves[20.313]
    assert saved.amplitude("tip") == pytest.approx(curve.amplitude("tip"), rel=1e-12)
    assert saved.amplitude("damper") == pytest.approx(curve.amplitude("damper"), rel=1e-12)


def test_the_script_is_short():
    lines = (EXAMPLES / "snecma-beam" / "beam.py").read_text().splitlines()
    assert len(lines) <= 15
    assert max(map(len, lines)) <= 100


def test_the_tuned_ring_peaks_where_the_table_says():
    (tuned,) = Study.load(EXAMPLES / "beam-ring" / "tuned.toml").run()
    assert tuned.converged.all()
    # computed independently: tuned ring of 36, converged
    assert tuned.peak("damper").amplitude == pytest.approx(8.4116e-5, rel=1e-4)
    assert tuned.sector(9).peak("damper").amplitude == pytest.approx(8.4116e-5, rel=1e-4)


@pytest.mark.slow
def test_the_mistuned_ring_is_amplified_as_the_table_says(tmp_path, monkeypatch, capsys):
    study = Study.load(EXAMPLES / "beam-ring" / "mistuned.toml")
    (mistuned,) = study.run()
    tuned = ss.forced_response(study.model.disk, mistuned.omega, 3)
    # computed independently: 7 %, seed 0, couplings of 7000 N/m, 3 harmonics
    assert mistuned.amplification(tuned, "damper").factor == pytest.approx(1.575, rel=1e-3)
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.fspath(EXAMPLES / "beam-ring" / "ring.py"), run_name="__main__")
    assert capsys.readouterr().out == "amplification 1.575 at blade 13, 193.1 rad/s\n"
    assert (tmp_path / "beam-ring.png").stat().st_size > 0


def test_the_blisk_goes_from_stuck_to_slipping_tips():
    study = Study.load(EXAMPLES / "laxalde-blisk" / "study.toml")
    low, *_, high = study.run()
    stuck, slipping = (
        ss.natural_frequencies(study.model, points, nodal_diameter=2)[0]
        for points in ([], ["shroud"])
    )
    assert low.peak("tip").omega == pytest.approx(stuck, rel=1e-4)
    assert high.peak("tip").omega == pytest.approx(slipping, rel=1e-4)
    assert slipping / (2.0 * 3.141592653589793) == pytest.approx(189.3018526, rel=1e-8)


@pytest.mark.slow
def test_the_starts_of_the_driven_beam_lead_to_its_modes():
    (chart,) = Study.load(EXAMPLES / "flutter-starts" / "study.toml").run()
    assert chart.shape == (9, 9)
    settled = {outcome.mode for outcome in chart.outcomes if outcome.motion == "settled"}
    assert settled == {0, 1, 2}
    assert chart.motion[0] == "decaying"
    # large starts in mode 0 alone stay in it
    assert (chart.mode[0, 4:] == 0).all()


@pytest.mark.slow
def test_the_readings_of_one_driven_mode(capsys):
    runpy.run_path(os.fspath(EXAMPLES / "flutter-starts" / "readings.py"), run_name="__main__")
    first, *lines = capsys.readouterr().out.splitlines()
    assert first == "c = 12.0954 27.6267 5.7892"
    for begin, mode in ((0, 2), (3, 0), (6, 2)):
        for line in lines[begin : begin + 2]:
            assert f"settled, mode {mode}" in line
        assert "unbounded, mode None" in lines[begin + 2]


@pytest.mark.slow
def test_the_flutter_beam_has_the_limit_of_exact_orbits():
    (branch,) = Study.load(EXAMPLES / "flutter-beam" / "study.toml").run()
    # computed independently: third mode of the beam, all modes negatively damped
    assert branch.limit.ratio == pytest.approx(6.3604, rel=1e-4)
    assert branch.changes[0].value == pytest.approx(4.686, rel=1e-3)
    assert branch.changes[0].kind == "complex pair"


@pytest.mark.slow
def test_the_pair_peaks_and_slips_as_the_dissertation_corrected(tmp_path, monkeypatch, capsys):
    study = Study.load(EXAMPLES / "beam-pair" / "study.toml")
    curves = dict(zip([case.level for case in study.cases], study.run(), strict=True))
    # computed independently
    for level, peaks in {
        20.0: {"1.damper": 1.9184e-5, "1.tip": 3.0592e-5, "2.tip": 2.4787e-5},
        60.0: {"1.damper": 3.1929e-5, "2.damper": 3.2890e-5, "1.tip": 6.9382e-5},
        120.0: {"2.damper": 4.6078e-5, "1.tip": 1.1256e-4},
    }.items():
        assert curves[level].converged.all()
        for dof, peak in peaks.items():
            assert curves[level].peak(dof).amplitude == pytest.approx(peak, rel=2e-3)
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.fspath(EXAMPLES / "beam-pair" / "pair.py"), run_name="__main__")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("slip sets []")
    assert lines[1].endswith("slip sets [(0,)]")
    assert sorted(path.name for path in tmp_path.glob("*.png"))[-1] == "beam-pair-550.png"


def test_the_pad_slides_as_computed_independently():
    """Largest displacements [m] of one mass on a plane, by two other codes to 3e-5."""
    study = Study.load(EXAMPLES / "friction-pad" / "study.toml")
    (pad,) = study.run()
    assert pad.converged.all()
    for omega, expected in {
        180.0: (1.79793e-3, 3.20807e-4, 9.63298e-5),
        260.0: (1.39417e-3, 8.77593e-4, 1.159755e-4),
        340.0: (4.46050e-4, 1.13998e-3, 1.606182e-4),
    }.items():
        at = pad.index(omega)
        found = [pad.amplitude(f"pad.{axis}", "max")[at] for axis in "xyz"]
        assert found == pytest.approx(expected, rel=1e-4)


def test_wedge_between_two_blades_as_followed_in_time():
    study = Study.load(EXAMPLES / "wedge-damper" / "study.toml")
    (curve,) = study.run()
    assert curve.converged.all()
    at = curve.index(108.0)
    run = ss.transient(curve.model, omega=108.0, periods=200, scheme="exact")
    assert curve.amplitude("left.x")[at] == pytest.approx(run.amplitude("left.x"), rel=1e-2)


@pytest.mark.slow
def test_a_contact_is_found_from_what_another_integrator_made():
    study = Study.load(EXAMPLES / "friction-test" / "study.toml")
    (found,) = study.run()
    true = {"pad.stiffness": 2e5, "pad.slip_force": 12.0, "damping.stiffness": 1e-4}
    for name, value in true.items():
        low, high = found.intervals[name]
        assert low < value < high
        assert found.values[name] == pytest.approx(value, rel=0.01)
        assert found.identifiable[name]
    assert 0.8 < found.scatter < 1.2
    rig = runpy.run_path(os.fspath(EXAMPLES / "friction-test" / "rig.py"))
    # The file is what the script computes, but for its noise.
    settled = rig["settled"]
    hertz, seen = np.loadtxt(EXAMPLES / "friction-test" / "level-8.csv", delimiter=",")[9]
    assert 1e6 * settled(2.0 * np.pi * hertz, 8.0) == pytest.approx(seen, rel=0.08)


# ------------------------------------------------------------------------- four tasks of four users


def ran(script, folder, monkeypatch, capsys):
    """Run a script in an empty folder; return the lines that it prints."""
    monkeypatch.chdir(folder)
    runpy.run_path(os.fspath(EXAMPLES / "four-tasks" / script), run_name="__main__")
    return capsys.readouterr().out.splitlines()


def test_each_task_is_short():
    for script in (EXAMPLES / "four-tasks").glob("*.py"):
        assert len(script.read_text().splitlines()) <= 30


@pytest.mark.slow
def test_the_designer_finds_a_slip_force_with_a_low_peak():
    study = Study.load(EXAMPLES / "four-tasks" / "designer.toml")
    assert study.model.contacts[0].slip_force == 0.5 * 10.0
    (swept,) = study.run()
    peaks = [one.peak("tip").amplitude for one in swept.results]
    assert np.argmin(peaks) in (1, 2)


def test_the_designer_sees_every_order_meet_the_first_mode():
    (found,) = Study.load(EXAMPLES / "four-tasks" / "campbell.toml").run()
    assert found.speed[0] == 0.0
    first = {one.order for one in found.crossings() if one.mode == 0}
    assert first >= {2, 3, 4}


@pytest.mark.slow
def test_the_flow_feeds_two_waves_that_friction_holds():
    (found,) = Study.load(EXAMPLES / "four-tasks" / "flutter.toml").run()
    assert {d for d in found.diameters.tolist() if "limit cycle" in found.fate(d)} == {2, 3}


@pytest.mark.slow
def test_the_researcher_has_backbones_and_a_true_error(tmp_path, monkeypatch, capsys):
    jenkins, iwan, _, error = ran("researcher.py", tmp_path, monkeypatch, capsys)
    # both laws dissipate; of one slider the share of the cycle that slips is larger
    assert float(jenkins.split()[-1].rstrip("%")) > float(iwan.split()[-1].rstrip("%")) > 1.0
    assert float(error.split()[-1]) < 1e-3
    assert (tmp_path / "backbones.png").stat().st_size > 0


@pytest.mark.slow
def test_the_plate_leaves_what_other_programs_read(tmp_path, monkeypatch, capsys):
    ran("elements.py", tmp_path, monkeypatch, capsys)
    mesh = ss.read_mesh("peak.vtu")
    assert mesh.dof_at([0.03, 0.015, 0], 3) == "141.3"
    receptances = ss.read_frf("plate.uff")
    for one in receptances:
        # the format keeps six digits of the first frequency and of the step
        assert one.omega[[0, -1]] == pytest.approx([1450.0, 1850.0], rel=1e-5)
    assert len(receptances) > 0

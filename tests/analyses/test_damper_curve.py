"""Damper curves, optimal dampers and sensitivities from Python."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip import reference
from stickslip.results.arrays import Measure

F_D = 246.048


@pytest.fixture(scope="module")
def beam() -> ss.Model:
    return reference.snecma_beam()


@pytest.fixture(scope="module")
def curve(beam: ss.Model) -> ss.DamperCurve:
    return ss.damper_curve(beam, slip_force=np.geomspace(1, 1e4, 30), dof="tip", harmonics=7)


def test_every_peak_is_that_of_a_full_sweep(beam: ss.Model, curve: ss.DamperCurve) -> None:
    for index in range(0, 30, 4):
        model = curve.model_at(float(curve.values[index]))
        frf = ss.forced_response(model, np.linspace(150, 240, 400), 7, observe=["tip"])
        peak = frf.peak("tip")
        assert curve.amplitude[index] == pytest.approx(peak.amplitude, rel=1e-8)
        assert curve.omega[index] == pytest.approx(peak.omega, rel=1e-5)
    assert all(status == "converged" for status in curve.status)
    assert not curve.at_edge.any()


def test_sixty_values_cost_less_than_ten_sweeps(beam: ss.Model) -> None:
    values = np.geomspace(1, 1e4, 60)
    for harmonics in (3, 15):
        curve = ss.damper_curve(beam, slip_force=values, dof="tip", harmonics=harmonics)
        sweep = ss.forced_response(beam, np.linspace(20, 350, 400), harmonics)
        assert curve.counters["points"] < 10 * 400
        assert curve.counters["evaluations"] < 10 * sweep.counters["evaluations"]
        # A sweep shares factorisations among steps; the slope of each point takes one of its own.
        assert curve.counters["factorisations"] < 4 * curve.counters["points"]


def test_ends_of_the_curve_are_the_linear_limits(curve: ss.DamperCurve) -> None:
    assert curve.omega[0] == pytest.approx(159.59, abs=0.2)
    assert curve.omega[-1] == pytest.approx(225.66, abs=0.2)
    assert curve.sensitivity[-1] == 0.0
    assert curve.sensitivity[0] < 0.0


def test_sensitivity_of_the_peak_matches_differences(beam: ss.Model) -> None:
    frf = ss.forced_response(beam, np.linspace(150, 240, 200), 9)
    for parameter, value in (("slip_force", F_D), ("stiffness", 2.4e7)):
        step = 2e-5 * value
        ends = ss.damper_curve(
            beam,
            **{parameter: [value - step, value, value + step]},
            dof="tip",
            harmonics=9,
        )
        difference = (ends.amplitude[2] - ends.amplitude[0]) / (2 * step)
        assert ends.sensitivity[1] == pytest.approx(difference, rel=1e-5)
        exact = frf.peak_sensitivity("tip", "jenkins", parameter)
        assert exact == pytest.approx(difference, rel=1e-5)
    by_level = frf.peak_sensitivity("tip", parameter="level")
    by_force = frf.peak_sensitivity("tip", parameter="slip_force")
    peak = frf.peak("tip").amplitude
    assert by_level + F_D * by_force == pytest.approx(peak, rel=1e-8)


@pytest.mark.parametrize("measure", ["half_range", "max", "fundamental"])
def test_sensitivities_match_responses_solved_anew(measure: Measure) -> None:
    model = reference.beam_pair()
    omega = [150.0, 175.0, 200.0, 215.0]
    frf = ss.forced_response(model, omega, 7)
    dof = model.structure.dofs[1]
    slopes = frf.sensitivity(dof, measure=measure)
    assert set(slopes) == {
        (name, parameter)
        for name in model.contact_names
        for parameter in ("stiffness", "slip_force")
    }
    for (name, parameter), exact in slopes.items():
        value = model.contacts[model.contact_index(name)].parameters()[parameter]
        ends = []
        for factor in (1 - 1e-5, 1 + 1e-5):
            contacts = [
                type(contact).from_parameters(
                    contact.dofs,
                    contact.parameters()
                    | ({parameter: factor * value} if contact.name == name else {}),
                    contact.name,
                )
                for contact in model.contacts
            ]
            changed = ss.Model(model.structure, contacts, model.forces)
            ends.append(ss.forced_response(changed, omega, 7).amplitude(dof, measure))
        difference = (ends[1] - ends[0]) / (2e-5 * value)
        scale = frf.amplitude(dof, measure) / value
        np.testing.assert_allclose(exact / scale, difference / scale, rtol=1e-5, atol=1e-7)
        one = frf.sensitivity(dof, name, parameter, measure)
        np.testing.assert_array_equal(one, exact)
    together = frf.sensitivity(dof, parameter="slip_force", measure=measure)
    single = [slope for (_, parameter), slope in slopes.items() if parameter == "slip_force"]
    np.testing.assert_allclose(together, np.sum(single, axis=0), rtol=1e-12)


def test_sensitivity_in_frequency_and_of_unsolved_points(beam: ss.Model) -> None:
    frf = ss.forced_response(beam, [169.99, 170.0, 170.01], 9)
    size = frf.amplitude("tip")
    slope = frf.sensitivity("tip", parameter="omega")[1]
    assert slope == pytest.approx((size[2] - size[0]) / 0.02, rel=1e-5)
    stalled = ss.forced_response(beam, [170.0], 15, max_iterations=1)
    if not stalled.arrays.solved.any():
        assert np.isnan(stalled.sensitivity("tip", parameter="level")).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"dof": "tpi"}, "did you mean 'tip'"),
        ({"dof": "tip", "parameter": "slip_forces"}, "did you mean 'slip_force'"),
        ({"dof": "tip", "contact": 0, "parameter": "level"}, "belongs to no contact"),
        ({"dof": "tip", "contact": 3, "parameter": "slip_force"}, "no contact at position 3"),
        ({"dof": "tip", "measure": "peak"}, "measure"),
    ],
)
def test_bad_sensitivities_are_refused(
    beam: ss.Model, arguments: dict[str, object], message: str
) -> None:
    frf = ss.forced_response(beam, [170.0], 3)
    with pytest.raises(ss.ModelError, match=message):
        frf.sensitivity(**arguments)


# Guillen (1999), Figs 4.5 to 4.8, converged by independent computation.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("stiffness", "amplitude"),
    [
        (2.4e4, 98.09e-5),
        (2.4e5, 92.44e-5),
        (2.4e6, 24.020e-5),
        (2.4e7, 8.7471e-5),
        (2.4e8, 6.9825e-5),
    ],
)
def test_stiffness_of_the_damper(beam: ss.Model, stiffness: float, amplitude: float) -> None:
    curve = ss.damper_curve(beam, stiffness=[stiffness], dof="damper", tolerance=1e-4)
    assert curve.amplitude[0] == pytest.approx(amplitude, rel=2e-4)


@pytest.mark.slow
def test_rigid_damper_is_a_limit(beam: ss.Model) -> None:
    curve = ss.damper_curve(beam, stiffness=[2.4e7, np.inf, 2.4e6], dof="damper")
    assert list(curve.values) == [2.4e7, np.inf, 2.4e6]
    # Linear in 1/k_d through the converged 6.7453e-5 and 6.7195e-5 m at 2.4e9 and 2.4e10 N/m.
    limit = 6.7195e-5 - (6.7453e-5 - 6.7195e-5) / 9.0
    assert curve.amplitude[1] == pytest.approx(limit, rel=2e-3)
    assert abs(curve.amplitude[1] - limit) < curve.error_estimate[1]
    assert curve.sensitivity[1] == 0.0
    assert curve.amplitude[2] == pytest.approx(24.020e-5, rel=1e-3)
    assert any("infinite stiffness is the limit" in text for text in curve.assumptions)


# Over continuous loads: errata of Figs 4.3 and 4.4.
@pytest.mark.slow
def test_optima_of_the_beam() -> None:
    model = reference.snecma_beam(1.0)
    tip = ss.optimal_damper(model, dof="tip", parameter="level")
    assert len(tip.minima) == 2
    assert [m.value for m in tip.minima] == pytest.approx([14.0, 22.0], rel=0.02)
    ratios = [m.amplitude / m.value for m in tip.minima]
    assert ratios == pytest.approx([6.72e-5, 6.985e-5], rel=1e-3)
    damper = ss.optimal_damper(model, dof="damper")
    assert F_D / damper.slip_force == pytest.approx(10.0, rel=0.02)
    assert damper.amplitude == pytest.approx(3.02e-6, rel=1e-3)
    assert not damper.at_bound
    # The best damper is the best whatever the level: only the ratio counts.
    again = ss.optimal_damper(model.scaled(force=7.0), dof="damper")
    assert again.slip_force == pytest.approx(7.0 * damper.slip_force, rel=1e-3)
    frf = ss.forced_response(damper.model, np.linspace(150, 240, 300))
    assert frf.peak("damper").amplitude == pytest.approx(damper.amplitude, rel=2e-3)


def test_one_factor_or_one_value_for_several_contacts() -> None:
    model = reference.beam_pair()
    names = model.contact_names[:2]
    dof = model.structure.dofs[1]
    value = ss.damper_curve(model, slip_force=[100.0, 200.0], dof=dof, contacts=names, harmonics=5)
    own = model.contacts[0].parameters()["slip_force"]
    factor = ss.damper_curve(
        model,
        slip_force=np.array([100.0, 200.0]) / own,
        dof=dof,
        contacts=names,
        common="factor",
        harmonics=5,
    )
    np.testing.assert_allclose(value.amplitude, factor.amplitude, rtol=1e-8)
    np.testing.assert_allclose(value.sensitivity * own, factor.sensitivity, rtol=1e-6)
    forces = [c.parameters()["slip_force"] for c in value.model_at(100.0).contacts]
    assert forces[:2] == [100.0, 100.0]


def test_level_and_slip_force_know_their_ratio_alone(beam: ss.Model) -> None:
    by_level = ss.damper_curve(beam, level=[0.5, 1.0, 2.0], dof="tip", harmonics=7)
    by_force = ss.damper_curve(beam, slip_force=[2 * F_D, F_D, 0.5 * F_D], dof="tip", harmonics=7)
    np.testing.assert_allclose(by_level.amplitude, by_force.amplitude * [0.5, 1.0, 2.0], rtol=1e-8)
    direct = ss.forced_response(beam.scaled(force=2.0), np.linspace(150, 240, 300), 7)
    assert by_level.amplitude[2] == pytest.approx(direct.peak("tip").amplitude, rel=1e-8)


@pytest.mark.slow
def test_results_are_constant_saved_and_loaded(curve: ss.DamperCurve, tmp_path: Path) -> None:
    file = tmp_path / "curve.nc"
    curve.save(file)
    for copy in (ss.load(file), pickle.loads(pickle.dumps(curve))):
        assert isinstance(copy, ss.DamperCurve)
        assert copy.settings == curve.settings
        assert copy.assumptions == curve.assumptions
        for name in ("values", "omega", "amplitude", "sensitivity", "error_estimate", "at_edge"):
            np.testing.assert_array_equal(getattr(copy, name), getattr(curve, name))
        assert copy.optimum == curve.optimum
        assert not copy.amplitude.flags.writeable
    dataset = curve.to_dataset()
    assert dataset["amplitude"].dims == ("value",)
    assert dataset["value"].attrs["units"] == "N"
    assert curve.optimum.amplitude == curve.amplitude.min()


@pytest.mark.slow
def test_a_stopped_curve_keeps_its_values(beam: ss.Model) -> None:
    def stop(share: float) -> None:
        if share > 0.3:
            raise KeyboardInterrupt

    values = np.geomspace(1, 1e4, 3000)
    with pytest.raises(ss.Interrupted) as stopped:
        ss.damper_curve(beam, slip_force=values, dof="tip", harmonics=9, progress=stop)
    result = stopped.value.result
    assert isinstance(result, ss.DamperCurve)
    assert result.interrupted
    done = result.arrays.solved
    assert 0 < done.sum() < values.size
    assert {str(status) for status in result.status} == {"converged", "not computed"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "none is given; give exactly one"),
        ({"slip_force": [1.0], "level": [1.0]}, "slip_force and level are given"),
        ({"slip_force": [1.0, -2.0]}, r"slip_force\[1\] is -2"),
        ({"level": [0.0]}, r"level\[0\] is 0"),
        ({"level": [np.inf]}, r"level\[0\] is inf"),
        ({"slip_force": []}, "slip_force: empty"),
        ({"slip_force": [1.0], "contacts": ["jenkin"]}, "did you mean 'jenkins'"),
        ({"slip_force": [1.0], "contacts": []}, "contacts: empty"),
        ({"level": [1.0], "contacts": [0]}, "a level is no parameter of contacts"),
        ({"slip_force": [1.0], "mode": 3}, "mode: 3; the structure has 3"),
        ({"slip_force": [1.0], "omega": [150.0, 240.0]}, r"give a range \(from, to\)"),
        ({"slip_force": [1.0], "common": "both"}, "common"),
        ({"slip_force": [1.0], "harmonics": 0}, "harmonics"),
        ({"stiffness": [np.inf], "common": "factor"}, "an infinite factor has no meaning"),
    ],
)
def test_bad_input_is_refused(beam: ss.Model, arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ss.ModelError, match=message):
        ss.damper_curve(beam, **{"dof": "tip", **arguments})


def test_bad_bounds_are_refused(beam: ss.Model) -> None:
    with pytest.raises(ss.ModelError, match="give 0 < lowest < highest"):
        ss.optimal_damper(beam, dof="tip", bounds=(3.0, 2.0))
    free = ss.Model(beam.structure, forces=beam.forces)
    with pytest.raises(ss.ModelError, match="none of the model has a slip_force"):
        ss.optimal_damper(free, dof="tip")


def test_curves_are_drawn_with_limits_and_optimum(beam: ss.Model, curve: ss.DamperCurve) -> None:
    ax = curve.plot()
    labels = ax.get_legend_handles_labels()[1]
    assert labels[0] == "tip"
    assert any(label.startswith("lowest") for label in labels)
    assert {"stuck (linear)", "free (linear)"} <= set(labels)
    assert ax.get_xscale() == ax.get_yscale() == "log"
    level = ss.damper_curve(beam, level=[0.5, 1.0, 2.0], dof="tip", harmonics=3)
    per_force = level.plot(normalise="force")
    assert "P/F_d" in per_force.get_xlabel()
    line = per_force.lines[0]
    np.testing.assert_allclose(line.get_ydata(), level.amplitude / level.values / 20.313)
    stiff = ss.damper_curve(beam, stiffness=[1e6, 1e7], dof="tip", harmonics=3)
    with pytest.raises(ss.ModelError, match="one parameter at a time"):
        ss.plot.damper([stiff, level])


STUDY = """
[structure]
mass = [[944.6]]
stiffness = [[2.4e7]]
damping = [[7700.0]]
dofs = ["blade"]
[[contact]]
law = "jenkins"
dof = "blade"
stiffness = "24 kN/mm"
slip_force = "246 N"
[[force]]
dof = "blade"
amplitude = "246 N"
[analysis]
kind = "damper-curve"
dof = "blade"
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("entry", "values"),
    [
        ('slip_force = {from = "1 N", to = "10 kN", points = 5}', np.geomspace(1, 1e4, 5)),
        ('slip_force = ["1 N", 20]', [1.0, 20.0]),
        ('stiffness = ["24 kN/mm", inf]', [2.4e7, np.inf]),
        ("level = [0.5, 2]", [0.5, 2.0]),
    ],
)
def test_study_files_ask_for_curves(entry: str, values: list[float], tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from stickslip.cli import app

    (result,) = ss.study.Study.parse(STUDY + entry).run()
    np.testing.assert_allclose(result.values, values)
    file = tmp_path / "curve.toml"
    file.write_text(STUDY + entry, encoding="utf-8")
    out = str(tmp_path / "out")
    runner = CliRunner()
    ran = runner.invoke(app, ["run", str(file), "--out", out])
    assert ran.exit_code == 0, ran.output
    assert "lowest" in ran.output
    shown = runner.invoke(app, ["show", f"{out}/curve.nc"])
    assert shown.exit_code == 0, shown.output
    assert "peak of" in shown.output
    drawn = runner.invoke(app, ["plot", f"{out}/curve.nc"])
    assert drawn.exit_code == 0, drawn.output
    assert (tmp_path / "out" / "curve-damper-curve.png").stat().st_size > 1000


def test_a_study_file_names_one_parameter() -> None:
    with pytest.raises(ss.ModelError, match="none is given; give exactly one of them"):
        ss.study.Study.parse(STUDY)
    with pytest.raises(ss.ModelError, match="did you mean 'blade'"):
        ss.study.Study.parse(
            STUDY.replace('dof = "blade"\n"""', "").replace(
                'kind = "damper-curve"\ndof = "blade"', 'kind = "damper-curve"\ndof = "blad"'
            )
            + "level = [1]"
        )

"""Which numbers of a model a fitted or uncertain parameter sets."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import stickslip as ss
from stickslip.analyses.fit_parameters import FitParameter, require_unit
from stickslip.plot.curves import traits_of
from stickslip.views.kinds import view_of

OMEGA = np.linspace(80.0, 160.0, 9)
PEAK = ss.HighestPeak("tip", omega=(80.0, 160.0))


def pad(name: str, slip_force: float) -> ss.Jenkins:
    return ss.Jenkins("tip", stiffness=3000.0, slip_force=slip_force, name=name)


def model(*contacts: ss.Contact) -> ss.Model:
    structure = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.01), ["tip"])
    return ss.Model(structure, contacts, [ss.Force("tip", 2.0)])


MATRIX = ss.ParallelJenkins("tip", stiffness=[1e3, 2e3], slip_forces=[1.0, np.inf], name="q")
PADS = model(pad("p1", 3.0), pad("p2", 4.0), pad("glue", np.inf))
MIXED = model(pad("p1", 3.0), MATRIX)


def at(one: ss.Model, name: str, value: float) -> ss.Model:
    return FitParameter(name, value, np.inf).apply(one, value)


def measured(one: ss.Model) -> ss.Measurement:
    seen = ss.forced_response(one, OMEGA, 3).amplitude("tip")
    return ss.Measurement(OMEGA, "tip", seen, relative_noise=0.01)


def fit(one: ss.Model, parameters: dict[str, object]) -> ss.Fit:
    keys = {"harmonics": 3, "starts": 2, "intervals": "covariance"}
    return ss.fit(one, [measured(one)], parameters=parameters, **keys)


def uncertain(one: ss.Model, parameters: dict[str, object]) -> ss.Uncertainty:
    return ss.uncertainty(one, parameters, PEAK, samples=2, harmonics=1)


def test_what_never_slips_goes_on_to_stick():
    assert [one.slip_force for one in at(PADS, "slip_force", 2.0).contacts] == [2.0, 2.0, np.inf]
    assert at(PADS, "glue.slip_force", 2.0).contacts[2].slip_force == 2.0
    for name in ("slip_force", "q.slip_force"):
        assert at(MIXED, name, 2.0).contacts[1].slip_forces == (2.0, np.inf)
    glued = model(pad("p1", np.inf))
    assert at(glued, "slip_force", 2.0).contacts[0].slip_force == 2.0


def test_a_fit_leaves_glued_contacts_alone():
    found = fit(
        PADS.replaced(contacts=[pad("p1", 3.0), pad("glue", np.inf)]), {"slip_force": (1, 9)}
    )
    assert found.values["slip_force"] == pytest.approx(3.0, rel=1e-4)
    assert found.model.contacts[1].slip_force == np.inf


@pytest.mark.parametrize("compute", [fit, uncertain])
def test_a_factor_here_and_a_value_there_is_no_parameter(compute):
    given = (100.0, 9000.0) if compute is fit else stats.uniform(100.0, 8900.0)
    with pytest.raises(ss.ModelError, match="a factor on a matrix in 'q' and a value in 'p1'"):
        compute(MIXED, {"stiffness": given})


@pytest.mark.parametrize(
    "names", [("p1.slip_force", "slip_force"), ("slip_force", "p1.slip_force")]
)
@pytest.mark.parametrize("compute", [fit, uncertain])
def test_two_parameters_that_set_one_number_are_refused(compute, names):
    given = (1.0, 9.0) if compute is fit else stats.uniform(1.0, 8.0)
    message = f"'{names[0]}' and '{names[1]}' both set 'p1.slip_force'; leave out one"
    with pytest.raises(ss.ModelError, match=message):
        compute(PADS, dict.fromkeys(names, given))


def test_a_parameter_of_a_glued_contact_stands_beside_that_of_all_others():
    found = uncertain(PADS, dict.fromkeys(("slip_force", "glue.slip_force"), stats.uniform(1, 8)))
    for given, amplitude in zip(found.arrays.parameter, found.values("amplitude"), strict=True):
        slips, glue = given
        own = model(pad("p1", slips), pad("p2", slips), pad("glue", glue))
        peak = ss.forced_response(own, (80.0, 160.0), 1).peak("tip")
        assert amplitude == pytest.approx(peak.amplitude, rel=1e-6)


@pytest.mark.parametrize(
    ("compute", "given"),
    [
        (fit, ("0.5 N/m", 2.0)),
        (uncertain, {"distribution": "uniform", "loc": "0.5 N/m", "scale": 1.5}),
    ],
)
def test_factors_have_no_unit(compute, given):
    message = "'0.5 N/m' is not a ratio; .* for it is a factor on a matrix"
    with pytest.raises(ss.ModelError, match=message):
        compute(MIXED, {"q.stiffness": given})


def test_distributions_have_units():
    def spec(loc: object, scale: object) -> dict[str, object]:
        return {"distribution": "uniform", "loc": loc, "scale": scale}

    said = uncertain(
        PADS, {"slip_force": spec("1 N", "0.002 kN"), "damping.ratio": spec("1 %", 0.01)}
    )
    plain = uncertain(PADS, {"slip_force": spec(1, 2), "damping.ratio": spec(0.01, 0.01)})
    np.testing.assert_array_equal(said.arrays.parameter, plain.arrays.parameter)
    assert said.settings.parameters == plain.settings.parameters
    residual = spec("1 N", "2 N")
    assert uncertain(PADS, {"residual": residual}).settings.parameters["residual"]["loc"] == 1.0
    with pytest.raises(
        ss.ModelError, match=r"parameters\['slip_force'\]\.loc = '1 m' is not a force"
    ):
        uncertain(PADS, {"slip_force": spec("1 m", 2)})


def test_stiffnesses_in_another_unit_are_no_stiffnesses_of_all_contacts():
    cubic = ss.Cubic("tip", stiffness=2e7)
    both = model(pad("p1", 3.0), cubic)
    assert at(both, "stiffness", 2e3).contacts[1].stiffness == 2e7
    assert at(both, "cubic.stiffness", 1e7).contacts[1].stiffness == 1e7
    assert at(model(cubic), "stiffness", 1e7).contacts[0].stiffness == 1e7
    curve = ss.damper_curve(both, dof="tip", stiffness=[1e3, 2e3], harmonics=1)
    assert curve.settings.variation.contacts == ("p1",)
    found = ss.forced_response(both, OMEGA, 3)
    every, one = (found.sensitivity("tip", name, "stiffness") for name in (None, "p1"))
    np.testing.assert_array_equal(every, one)


def test_the_unit_of_a_cubic_spring_is_its_own_in_results_figures_and_tables():
    stiff = model(pad("p1", 3.0), ss.Cubic("tip", stiffness=2e7, name="hard"))
    keys = {"contacts": ["hard"], "stiffness": [1e7, 2e7]}
    curve = ss.damper_curve(stiff, dof="tip", harmonics=1, **keys)
    assert curve.plot().get_xlabel().endswith("[N/m^3]")
    assert curve.to_dataset()["value"].attrs["units"] == "N/m^3"
    (table,) = view_of([curve]).tables([("", curve)], "", ["tip"], "m")
    assert "stiffness [N/m^3]" in list(table.columns[2].cells)
    swept = ss.sweep(stiff, lambda one: ss.forced_response(one, [100.0], 1), **keys)
    assert swept.labels[0] == "stiffness = 1e+07 N/m^3"
    names = traits_of([swept.results[0], swept.results[1]])
    assert names[0].endswith("= 1e+07 N/m^3 (hard)")
    factors = ss.damper_curve(
        stiff, dof="tip", harmonics=1, common="factor", **keys | {"stiffness": [1.0]}
    )
    assert factors.settings.variation.unit == "1"


def test_contacts_of_several_units_take_no_common_value():
    both = model(pad("p1", 3.0), ss.Cubic("tip", stiffness=2e7, name="hard"))
    with pytest.raises(ss.ModelError, match="the stiffness of 'p1', 'hard' has several units"):
        ss.damper_curve(both, dof="tip", stiffness=[1e3], contacts=["p1", "hard"], harmonics=1)


def test_a_cubic_spring_is_fitted_by_no_stiffness_in_another_unit():
    both = model(pad("p1", 3.0), ss.Cubic("tip", stiffness=2e7, name="hard"))
    with pytest.raises(ss.ModelError, match=r"for it is in N/m\^3"):
        require_unit(both, "hard.stiffness", ["1e7 N/m", 2e7])
    require_unit(both, "p1.stiffness", ["1e7 N/m", 2e7])

"""Jenkins elements in parallel against as many contacts, in every analysis."""

import json

import numpy as np
import pytest

import stickslip as ss
from stickslip.model.laws import contact_from_spec
from stickslip.study import Study

COUNT = 20


def elements(seed=3, count=COUNT):
    random = np.random.default_rng(seed)
    stiffness = random.uniform(20.0, 300.0, count)
    return stiffness, random.uniform(0.02, 1.0, count)


def structure():
    stiffness = np.array([[1.2e4, -2e3, 0], [-2e3, 1.1e4, -2e3], [0, -2e3, 1.3e4]])
    return ss.Structure(np.eye(3), stiffness, ss.ModalDamping(0.003), ["a", "b", "c"])


def contacts(*, parallel, ends=("a",), infinite=False):
    stiffness, limits = elements()
    if infinite:
        limits[-1] = np.inf
    if parallel:
        return [ss.ParallelJenkins(*ends, stiffness=stiffness, slip_forces=limits)]
    pairs = zip(stiffness, limits, strict=True)
    return [ss.Jenkins(*ends, stiffness=k, slip_force=limit) for k, limit in pairs]


def models(force=3.0, **options):
    forces = [ss.Force("b", force)] if force else []
    return [
        ss.Model(structure(), contacts(parallel=parallel, **options), forces)
        for parallel in (True, False)
    ]


def same(found, expected, tolerance=1e-9):
    found, expected = np.asarray(found), np.asarray(expected)
    assert np.abs(found - expected).max() <= tolerance * np.abs(expected).max()


OMEGA = np.linspace(90.0, 130.0, 41)


@pytest.mark.parametrize("ends", [("a",), ("a", "c")])
def test_forced_responses_are_equal(ends):
    one, many = (ss.forced_response(model, OMEGA, 7) for model in models(ends=ends))
    assert one.converged.all()
    same(one.coefficients("c"), many.coefficients("c"))
    same(one.dissipation(0), sum(many.dissipation(i) for i in range(COUNT)))
    same(
        one.contact_force(0, 20)[:, 0],
        sum(many.contact_force(i, 20)[:, 0] for i in range(COUNT)),
    )
    stiffness, _ = elements()
    share = sum(k * many.slip_fraction(i) for i, k in enumerate(stiffness)) / stiffness.sum()
    same(one.slip_fraction(0), share)
    assert 0.05 < one.slip_fraction(0).max() < 1.0


def test_a_static_load_and_residuals():
    for residual in ("from_rest", 0.01):
        curves = []
        for model in models(force=0.0):
            loaded = model.replaced(forces=[ss.Force("b", 3.0), ss.Force("a", 1.0, harmonic=0)])
            curves.append(ss.forced_response(loaded, OMEGA[::4], 5, residual=residual))
        same(curves[0].coefficients("a"), curves[1].coefficients("a"))


def test_one_unknown_for_all_elements_costs_no_more_work():
    one, many = (ss.forced_response(model, OMEGA, 7) for model in models())
    single = ss.forced_response(
        ss.Model(structure(), [ss.Jenkins("a", stiffness=3e3, slip_force=8.0)], models()[0].forces),
        OMEGA,
        7,
    )
    for counter in ("evaluations", "factorisations"):
        assert one.counters[counter] <= 1.5 * max(single.counters[counter], many.counters[counter])


def test_the_other_balances_are_equal():
    pairs = [
        [ss.single_harmonic(model, OMEGA) for model in models()],
        [ss.forced_response(model, OMEGA, 5, method="broyden") for model in models()],
        [
            ss.forced_response(model, OMEGA[::4], 5, evaluation="marched", samples=256)
            for model in models()
        ],
    ]
    for one, many in pairs:
        assert one.converged.all()
        same(one.coefficients("c"), many.coefficients("c"), 1e-8)


def test_exact_orbits_are_equal():
    one, many = (ss.exact_response(model, OMEGA[::8]) for model in models(infinite=True))
    assert one.converged.all()
    same(one.amplitude("a"), many.amplitude("a"))
    same(one.dissipation(0), sum(many.dissipation(i) for i in range(COUNT)))
    same(np.sort(np.abs(one.multipliers)), np.sort(np.abs(many.multipliers)))
    balance = ss.forced_response(models(infinite=True)[0], OMEGA[::8], 31)
    same(one.amplitude("a"), balance.amplitude("a"), 2e-3)


@pytest.mark.parametrize("scheme", ["exact", "rk4"])
def test_transients_are_equal(scheme):
    one, many = (ss.transient(model, 105.0, 10, scheme=scheme, samples=64) for model in models())
    same(one.displacement("c"), many.displacement("c"))
    same(one.contact_force(0), sum(many.contact_force(i) for i in range(COUNT)))
    again = [
        ss.transient(model, 105.0, 2, scheme=scheme, samples=64, start=run.final)
        for model, run in zip(models(), (one, many), strict=True)
    ]
    same(again[0].displacement("c"), again[1].displacement("c"))
    longer = ss.transient(models()[0], 105.0, 12, scheme=scheme, samples=64)
    same(again[0].displacement("c")[-65:], longer.displacement("c")[-65:])


@pytest.mark.slow
def test_damper_curves_and_optima_are_equal():
    factors = np.geomspace(0.2, 5.0, 5)
    options = {"dof": "c", "common": "factor", "harmonics": 5, "omega": (80.0, 140.0)}
    one, many = (ss.damper_curve(model, slip_force=factors, **options) for model in models())
    same(one.amplitude, many.amplitude)
    same(one.sensitivity, many.sensitivity, 1e-6)
    best = [ss.optimal_damper(model, **options) for model in models()]
    same(best[0].amplitude, best[1].amplitude, 1e-6)


@pytest.mark.slow
def test_limit_cycles_are_equal():
    negative = -0.2 * np.eye(3)
    for method in ("newton", "exact"):
        one, many = (
            ss.limit_cycles(model, negative, mode=0, harmonics=7, ratio=[4.0, 5.0], method=method)
            for model in models(force=0.0)
        )
        same(one.omega, many.omega)
        same(one.amplitude("c"), many.amplitude("c"), 1e-8)


def test_disks_are_equal():
    couplings = [ss.Coupling("c", stiffness=300.0)]
    curves = []
    for parallel in (True, False):
        disk = ss.BladedDisk(
            structure(),
            sectors=5,
            couplings=couplings,
            contacts=contacts(parallel=parallel),
            forces=[ss.Force("b", 3.0)],
            engine_order=1,
        )
        mistuned = disk.mistuned(0.01 * np.array([1, -1, 2, 0, -2]))
        curves.append(
            [
                ss.forced_response(disk, OMEGA[::4], 3),
                ss.forced_response(mistuned, OMEGA[::4], 3),
            ]
        )
    same(curves[0][0].coefficients("c"), curves[1][0].coefficients("c"))
    same(curves[0][1].coefficients("3.c"), curves[1][1].coefficients("3.c"))


@pytest.mark.slow
def test_files_and_plain_values(tmp_path):
    model = models(infinite=True)[0]
    (contact,) = model.contacts
    assert contact_from_spec(json.loads(json.dumps(contact.to_spec()))) == contact
    curve = ss.forced_response(model, OMEGA[:4], 3)
    curve.save(tmp_path / "curve.nc")
    assert ss.load(tmp_path / "curve.nc").model.contacts == model.contacts
    start = ss.State(model, contact_force={("parallel-jenkins", 4): 0.01})
    run = ss.transient(model, 100.0, 2, start=start, samples=16)
    run.save(tmp_path / "run.nc")
    assert (ss.load(tmp_path / "run.nc").displacement("a") == run.displacement("a")).all()


def test_studies_take_lists(tmp_path):
    (tmp_path / "mass.mtx").write_text("%%MatrixMarket matrix array real general\n1 1\n1\n")
    (tmp_path / "stiffness.mtx").write_text(
        "%%MatrixMarket matrix array real general\n1 1\n10000\n"
    )
    (tmp_path / "study.toml").write_text(
        """
[structure]
mass = "mass.mtx"
stiffness = "stiffness.mtx"
dofs = ["x"]
damping = { modal = 0.01 }
[[contact]]
law = "parallel-jenkins"
dof = "x"
stiffness = ["1 kN/m", 500]
slip_forces = ["2 N", 5]
[[force]]
dof = "x"
amplitude = 1
[analysis]
omega = [95.0, 100.0]
harmonics = 3
""",
        encoding="utf-8",
    )
    (case,) = Study.load(tmp_path / "study.toml").cases
    assert case.model.contacts[0].slip_forces == (2.0, 5.0)


@pytest.mark.parametrize(
    ("stiffness", "limits", "message"),
    [
        ([1.0, -2.0], [1.0, 1.0], r"stiffness\[1\] -2 is negative"),
        ([1.0], [1.0, 1.0], "2 slip_forces for 1 stiffnesses"),
        ([], [], "stiffness: empty"),
        ([np.inf], [1.0], "stiffness"),
    ],
)
def test_bad_elements_are_refused(stiffness, limits, message):
    with pytest.raises(ss.ModelError, match=message):
        ss.ParallelJenkins("a", stiffness=stiffness, slip_forces=limits)


def test_an_element_has_no_results_of_its_own():
    curve = ss.forced_response(models()[0], OMEGA[:2], 3)
    element = ("parallel-jenkins", 3)
    for refused in (
        lambda: curve.slip_fraction(element),
        lambda: ss.natural_frequencies(curve.model, [element]),
        lambda: ss.slip_configurations(curve.model, points=[element]),
    ):
        with pytest.raises(ss.ModelError, match=r"contact 'parallel-jenkins' has 1, at"):
            refused()
    with pytest.raises(ss.ModelError, match="it has 20 points; write"):
        ss.State(curve.model, contact_force={"parallel-jenkins": 0.01})

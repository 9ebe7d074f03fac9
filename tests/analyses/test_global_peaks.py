"""No peak that the forced response of the same model refutes, and none where nothing bounds it."""

import json
import re
import warnings
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row


def three_masses(damping=0.005, slip_force=1.0, force=1.0):
    stiffness = [[1.1e4, -1e3, 0.0], [-1e3, 1.2e4, -1e3], [0.0, -1e3, 1.1e4]]
    structure = ss.Structure(
        np.eye(3), stiffness, ss.ModalDamping(damping) if damping else None, ["a", "b", "c"]
    )
    contact = ss.Jenkins("a", stiffness=1e3, slip_force=slip_force)
    return ss.Model(structure, [contact], [ss.Force("a", force)])


def states(model):
    """Natural frequencies with every set of points slipping."""
    points = [(i, j) for i, one in enumerate(model.contacts) for j in range(one.points)]
    sets = [chosen for count in range(len(points) + 1) for chosen in combinations(points, count)]
    return np.unique(np.concatenate([ss.natural_frequencies(model, list(one)) for one in sets]))


def highest(model, dof, span, harmonics):
    """The highest point of a grid that is fine around all natural frequencies, and its maxima."""
    near = np.r_[0.0, np.geomspace(1e-5, 0.05, 25)]
    natural = np.concatenate([states(model) / order for order in range(1, harmonics + 1, 2)])
    grid = np.concatenate(
        [np.linspace(*span, 200), *(f * (1.0 + s * near) for f in natural for s in (-1.0, 1.0))]
    )
    grid = np.unique(grid[(grid >= span[0]) & (grid <= span[1])])
    height = ss.forced_response(model, grid, harmonics, observe=[dof]).amplitude(dof)
    tops = 1 + np.flatnonzero((height[1:-1] >= height[:-2]) & (height[1:-1] >= height[2:]))
    finer = [np.linspace(grid[i - 1], grid[i + 1], 25) for i in tops[np.argsort(-height[tops])][:3]]
    if finer:
        closer = ss.forced_response(model, np.unique(finer), harmonics, observe=[dof])
        height = np.r_[height, closer.amplitude(dof)]
    return np.nanmax(height)


def test_a_resonance_in_a_gap_of_even_points_is_found():
    curve = ss.damper_curve(
        three_masses(), slip_force=[0.0, 0.1], dof="a", omega=(85.0, 130.0), harmonics=3
    )
    assert curve.amplitude == pytest.approx([4.5965e-3, 4.0405e-3], rel=1e-4)
    assert curve.omega == pytest.approx([104.905, 104.927], abs=1e-3)


def random_model(generator):
    size = int(generator.integers(2, 8))
    if generator.random() < 0.5:
        couplings = generator.uniform(300.0, 3e3, size - 1)
        ends = np.r_[couplings, 0.0] + np.r_[0.0, couplings]
        stiffness = np.diag(generator.uniform(1e4, 1.3e4, size) + ends)
        stiffness -= np.diag(couplings, 1) + np.diag(couplings, -1)
    else:  # close modes
        part = generator.normal(size=(size, size))
        stiffness = 1e4 * (np.eye(size) + 10 ** generator.uniform(-4, -2) * (part + part.T))
    names = [f"d{i}" for i in range(size)]
    damping = ss.ModalDamping(10 ** generator.uniform(-5, -1.7))
    contacts = [
        ss.Jenkins(dof, stiffness=1e4 * 10 ** generator.uniform(-2, 1), slip_force=1.0)
        for dof in generator.choice(names, min(size, int(generator.integers(1, 4))), replace=False)
    ]
    structure = ss.Structure(np.eye(size), stiffness, damping, names)
    forces = [ss.Force(str(generator.choice(names)), 1.0)]
    return ss.Model(structure, contacts, forces), str(generator.choice(names))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_no_forced_response_refutes_a_damper_curve(seed):
    generator = np.random.default_rng(seed)
    model, dof = random_model(generator)
    natural = ss.natural_frequencies(model)
    default = {"mode": int(generator.integers(natural.size))}
    given = {"omega": (0.5 * natural[0], 1.1 * natural[-1])}
    values = np.r_[0.0, 10 ** generator.uniform(-2, 1, 2)]
    curve = ss.damper_curve(
        model, slip_force=values, dof=dof, harmonics=3, **(given if seed % 2 else default)
    )
    for value, amplitude, status in zip(values, curve.amplitude, curve.status, strict=True):
        assert status == "converged"
        assert amplitude >= (1 - 1e-3) * highest(
            curve.model_at(value), dof, curve.settings.span, 3
        ), value


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 6, 7])
def test_an_optimum_is_no_lower_than_its_own_damper(seed):
    generator = np.random.default_rng(seed)
    model, dof = random_model(generator)
    best = ss.optimal_damper(model, dof=dof, harmonics=3)
    assert best.amplitude >= (1 - 1e-3) * highest(best.model, dof, best.curve.settings.span, 3)


def test_a_peak_between_coarse_points_is_found():
    model = three_masses(damping=1e-4, slip_force=0.1)
    coarse = ss.forced_response(model, np.linspace(85.0, 130.0, 8), 3)
    fine = highest(model, "b", (85.0, 130.0), 3)
    assert coarse.peak("b").amplitude >= (1 - 1e-3) * fine > coarse.amplitude("b").max()


def test_a_range_stops_at_resonances_of_mixed_states():
    structure = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 2e4]], ss.ModalDamping(1e-5), ["a", "b"]
    )
    # Of the two contacts one slips at once, the other never.
    contacts = [
        ss.Jenkins("a", stiffness=1e4, slip_force=1e-6),
        ss.Jenkins("b", stiffness=1e4, slip_force=1e6),
    ]
    model = ss.Model(structure, contacts, [ss.Force("a", 1.0)])
    resonances = ss.natural_frequencies(model, slipping=[(0, 0)])
    response = ss.forced_response(model, (50.0, 250.0), 3)
    for natural in resonances:
        exact = ss.forced_response(model, natural * (1.0 + np.linspace(-2e-5, 2e-5, 41)), 3)
        near = np.abs(response.omega - natural) < 1e-3 * natural
        reached = response.amplitude("a")[near].max()
        assert reached == pytest.approx(exact.amplitude("a").max(), rel=2e-2)


# ---------------------------------------------------------------------------- without bounds


def undamped_chain(force, slip_force):
    stiffness = 1e4 * (2.0 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    structure = ss.Structure(np.eye(3), stiffness, None, ["a", "b", "c"])
    contact = ss.Jenkins("a", stiffness=5e3, slip_force=slip_force)
    return ss.Model(structure, [contact], [ss.Force("b", force)])


# Energy: at the mode (1, sqrt(2), 1) friction of slip force F dissipates up to 4 F per amplitude
# and period, and the force P brings pi sqrt(2) P.
BOUND = 30.0 * np.pi * np.sqrt(2.0) / 4.0


@pytest.mark.parametrize("omega", [(20.0, 100.0), np.linspace(20.0, 100.0, 40)])
def test_a_resonance_that_nothing_bounds_is_no_peak(omega):
    natural = np.sqrt(1e4 * (2.0 - np.sqrt(2.0)))
    for slip_force in (5.0, 0.98 * BOUND):
        frf = ss.forced_response(undamped_chain(30.0, slip_force), omega, 3)
        with pytest.warns(UserWarning, match="neither damping nor friction bounds") as caught:
            peak = frf.peak("a")
        assert caught[0].filename == __file__
        assert peak.amplitude == np.inf
        assert peak.omega == pytest.approx(natural, rel=1e-9)
    bounded = ss.forced_response(undamped_chain(30.0, 1.5 * BOUND), omega, 3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert bounded.peak("a").amplitude < 0.1


def test_a_damper_curve_says_where_nothing_bounds():
    values = BOUND * np.array([0.0, 0.2, 0.98, 1.5, 3.0])
    curve = ss.damper_curve(
        undamped_chain(30.0, 5.0), slip_force=values, dof="a", omega=(20.0, 100.0), harmonics=3
    )
    assert list(curve.status) == ["singular"] * 3 + ["converged"] * 2
    assert np.isnan(curve.amplitude[:3]).all()
    assert any("3 singular" in text for text in curve.assumptions)
    # Outside its resonance the response is bounded.
    below = ss.damper_curve(
        undamped_chain(30.0, 5.0), slip_force=values, dof="a", omega=(20.0, 70.0), harmonics=3
    )
    assert all(status == "converged" for status in below.status)


def test_where_modes_are_too_many_a_resonance_without_bound_is_seen_by_its_height():
    stiffness = 1e4 * (2.0 * np.eye(1100) - np.eye(1100, k=1) - np.eye(1100, k=-1))
    structure = ss.Structure(np.eye(1100), stiffness)
    contact = ss.Jenkins(structure.dofs[3], stiffness=1e3, slip_force=1e-3)
    model = ss.Model(structure, [contact], [ss.Force(structure.dofs[0], 1.0)])
    omega = (0.14, 0.42)  # the first mode, 0.285 rad/s
    curve = ss.damper_curve(model, slip_force=[1e-3], dof="5", omega=omega, harmonics=1)
    assert list(curve.status) == ["singular"]


NARROW = {  # masses, springs from ground to ground, contacts, loaded DOF, observed DOF
    "two contacts": (
        [0.84899, 0.91583, 0.51884, 2.8553, 0.58772, 2.7943],
        [6232.4, 31875.0, 3628.0, 10771.0, 58679.0, 55130.0, 24951.0],
        [(["q4"], 150660.0), (["q0"], 666110.0)],
        ("q3", "q2"),
    ),
    "loaded contact": (
        [2.9768, 1.1116, 1.5857, 1.2552, 1.936],
        [24626.0, 59620.0, 21711.0, 23265.0, 5216.3, 24902.0],
        [(["q4"], 361570.0)],
        ("q4", "q2"),
    ),
    "between masses": (
        [1.5811, 1.7411, 1.4917, 1.8297, 0.8554, 0.96058],
        [29126.0, 61883.0, 15002.0, 4049.7, 31356.0, 24624.0, 0.0],
        [(["q0", "q1"], 85375.0)],
        ("q5", "q4"),
    ),
    "first mass": (
        [1.7873, 1.2001, 0.92399, 0.85167, 1.9389],
        [6009.4, 33074.0, 4083.9, 34585.0, 44658.0, 33282.0],
        [(["q0"], 7335.8)],
        ("q0", "q4"),
    ),
}
"""Undamped chains, some modes of which hardly move the contacts."""


def narrow_chain(name, slip_force):
    masses, springs, contacts, (loaded, _) = NARROW[name]
    dofs = [f"q{i}" for i in range(len(masses))]
    structure = ss.Structure(np.diag(masses), in_a_row(springs), None, dofs)
    jenkins = [
        ss.Jenkins(*ends, stiffness=own, slip_force=slip_force, name=f"c{i}")
        for i, (ends, own) in enumerate(contacts)
    ]
    return ss.Model(structure, jenkins, [ss.Force(loaded, 10.0)])


def work_bound(model):
    """Slip force from which friction bounds every mode: its work and the load's."""
    structure, (load,) = model.structure, model.forces
    root = np.sqrt(np.diag(structure.mass))
    _, shapes = np.linalg.eigh(structure.stiffness / np.outer(root, root))
    at = {dof: shapes[i] / root[i] for i, dof in enumerate(structure.dofs)}
    ends = [np.array([at[dof] for dof in contact.dofs]) for contact in model.contacts]
    seen = sum(np.abs(shape[0] - shape[1:].sum(axis=0)) for shape in ends)
    return (np.pi * load.amplitude * np.abs(at[load.dof]) / (4.0 * seen)).max()


@pytest.mark.parametrize("share", [1.02, 1.5, 100.0, 1e3])
@pytest.mark.parametrize(
    ("name", "harmonics"),
    [("two contacts", 3), ("loaded contact", 3), ("between masses", 3), ("first mass", 1)],
)
def test_narrow_resonances_that_friction_bounds_are_found(name, harmonics, share):
    model = narrow_chain(name, 1.0)
    value = share * work_bound(model)
    natural = ss.natural_frequencies(model, [(i, 0) for i in range(len(model.contacts))])
    span, dof = (0.3 * natural[0], 1.2 * natural[-1]), NARROW[name][-1][1]
    curve = ss.damper_curve(model, slip_force=[value], dof=dof, harmonics=harmonics, omega=span)
    assert list(curve.status) == ["converged"]


@pytest.mark.parametrize("harmonics", [1, 3])
def test_where_the_phase_turns_at_once_the_response_is_solved(harmonics):
    model = narrow_chain("two contacts", 13.4)
    stuck = ss.natural_frequencies(model, [])[-1]
    near = stuck * (1.0 + np.array([-1e-6, -2e-8, -1e-8, 1e-8, 2e-8, 1e-6]))
    beside = ss.forced_response(model, near, harmonics)
    assert beside.converged.all(), beside.status
    slips = beside.slip_fraction("c1")[:, 0] > 0.0
    assert list(slips) == [False, True, True, True, True, False]
    # The load can do no more than move it just beyond its limit.
    moved = beside.amplitude("q0")[slips] / (13.4 / 666110.0)
    np.testing.assert_allclose(moved, 1.0, rtol=1e-5)


def test_what_friction_bounds_within_a_few_billionths_is_found():
    own = np.array(
        [23342.80906095, 23345.703835614706, 11334.145046171, 22734.032818261, 20419.649265]
    )
    between = np.array([19635.229732781878, 1371.0854832066, 1226.7960473647, 11779.22939677])
    stiffness = np.diag(own) - np.diag(between, 1) - np.diag(between, -1)
    structure = ss.Structure(np.eye(5), stiffness, dofs=list("abcde"))
    contact = ss.Jenkins("a", stiffness=1e4, slip_force=22.99424743)
    model = ss.Model(structure, [contact], [ss.Force("b", 3.9179042849)])
    frf = ss.forced_response(model, (182.8, 183.0), harmonics=1)
    omega = frf.peak("d").omega * (1.0 + np.linspace(-3e-9, 3e-9, 100))
    around = ss.forced_response(model, omega, harmonics=1)
    # b hardly moves in it.
    for dof in "acde":
        highest, peak = around.amplitude(dof).max(), frf.peak(dof).amplitude
        assert (1.0 - 1e-6) * highest <= peak <= 1.01 * highest, dof


@pytest.mark.slow
def test_tables_show_what_nothing_bounds(tmp_path):
    from typer.testing import CliRunner

    from stickslip.cli import app

    frf = ss.forced_response(undamped_chain(30.0, 5.0), (20.0, 100.0), 3)
    frf.save(tmp_path / "chain.nc")
    shown = CliRunner().invoke(app, ["show", str(tmp_path / "chain.nc")])
    assert "inf: neither damping nor friction bounds" in shown.output
    # An error of a peak without bounds means nothing.
    assert re.search(r"^a .* inf +- +3 ", shown.output, re.MULTILINE)


# ------------------------------------------------------------------- systems that were missed

MISSED = json.loads((Path(__file__).parents[1] / "data" / "missed-peaks.json").read_text())


def built(case):
    damping = case["damping"]
    if "ratio" in damping:
        law = ss.ModalDamping(damping["ratio"])
    else:
        law = ss.Rayleigh(**damping["rayleigh"]) if "rayleigh" in damping else damping["matrix"]
    names = [f"q{i}" for i in range(len(case["mass"]))]
    structure = ss.Structure(case["mass"], case["stiffness"], law, names)
    contacts = [
        ss.Jenkins(*dofs, stiffness=stiffness, slip_force=slip_force, name=f"c{i}")
        for i, (dofs, stiffness, slip_force) in enumerate(case["contacts"])
    ]
    forces = [ss.Force(dof, amplitude, phase=phase) for dof, amplitude, phase in case["forces"]]
    keywords = {key: case[key] for key in ("dof", "harmonics")} | {"omega": tuple(case["omega"])}
    return ss.Model(structure, contacts, forces), keywords


def assert_no_grid_is_higher(amplitude, model, dof, harmonics, omega):
    assert amplitude >= (1 - 1e-3) * highest(model, dof, omega, harmonics)


@pytest.mark.slow
@pytest.mark.parametrize("case", MISSED["curves"], ids=lambda case: case["about"])
def test_a_missed_peak_of_a_curve_is_found(case):
    model, keywords = built(case)
    curve = ss.damper_curve(model, **{case["parameter"]: case["values"]}, **keywords)
    for value, amplitude in zip(case["values"], curve.amplitude, strict=True):
        assert_no_grid_is_higher(amplitude, curve.model_at(value), **keywords)


@pytest.mark.slow
@pytest.mark.parametrize("case", MISSED["undamped"], ids=lambda case: case["about"])
def test_a_missed_peak_that_friction_alone_bounds_is_found(case):
    model, keywords = built(case)
    curve = ss.damper_curve(model, **{case["parameter"]: case["values"]}, **keywords)
    last = curve.model_at(case["values"][-1])
    (height,) = ss.forced_response(last, [case["top"]], 3).amplitude(case["dof"])
    assert curve.amplitude[-1] >= (1 - 1e-5) * height


@pytest.mark.slow
@pytest.mark.parametrize("case", MISSED["optima"], ids=lambda case: case["about"])
def test_a_missed_optimum_is_found(case):
    model, keywords = built(case)
    best = ss.optimal_damper(model, parameter=case["parameter"], **keywords)
    assert_no_grid_is_higher(best.amplitude, best.model, **keywords)
    assert best.amplitude <= np.nanmin(best.curve.amplitude) * (1 + 1e-8)
    # Another look along the parameter finds none better.
    values = np.geomspace(*best.bounds, 90)
    curve = ss.damper_curve(model, **{case["parameter"]: values}, **keywords)
    lowest = curve.model_at(values[np.nanargmin(curve.amplitude)])
    peak = highest(lowest, keywords["dof"], keywords["omega"], keywords["harmonics"])
    assert best.amplitude <= (1 + 1e-3) * peak


@pytest.mark.slow
def test_a_peak_of_a_disk_between_two_flanks_is_found():
    stiffness = [[278011.83, -18295.446, 0.0], [-18295.446, 290793.19, -272497.74]]
    stiffness.append([0.0, -272497.74, 272497.74])
    mass = np.diag([0.54829293, 1.3859777, 0.75477227])
    blade = ss.Structure(mass, stiffness, ss.ModalDamping(5.9744389e-4), ["root", "mid", "tip"])
    values = [0.463494, 0.466331]
    disk = ss.BladedDisk(
        blade,
        sectors=6,
        couplings=[ss.Coupling("root", stiffness=14483.861)],
        contacts=[
            ss.Jenkins("root", stiffness=1728.4755, slip_force=1.0),
            ss.Jenkins("root", "next.root", stiffness=499368.76, slip_force=1.0, name="next"),
        ],
        forces=[ss.Force("root", 1.0)],
        engine_order=3,
    )
    span = (73.44, 2225.14)
    curve = ss.damper_curve(disk, dof="mid", harmonics=3, omega=span, slip_force=values)
    for value, amplitude in zip(values, curve.amplitude, strict=True):
        fine = ss.forced_response(curve.model_at(value), np.linspace(90.0, 93.0, 3000), 3)
        assert amplitude >= (1 - 1e-3) * fine.amplitude("mid").max()


@pytest.mark.slow
@pytest.mark.parametrize("seed", [125, 170, 196])
def test_no_value_of_its_curve_lies_below_an_optimum(seed):
    generator = np.random.default_rng(seed)
    model, dof = random_model(generator)
    best = ss.optimal_damper(model, dof=dof, harmonics=1)
    assert best.amplitude <= np.nanmin(best.curve.amplitude) * (1 + 1e-8)

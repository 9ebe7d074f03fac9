"""Every argument of what is public, given what it cannot be: one line names it, whatever it is."""

import inspect
import signal

import numpy as np
import pytest
import scipy.sparse

import stickslip as ss
from stickslip.reference import beam_ring, flutter_mass, single_dof, snecma_beam

LIMIT = 20
"""Seconds of a call on a slow machine; what is computed takes none."""


class Mute:
    """Cannot even be shown."""

    def __repr__(self):
        raise RuntimeError("no text")


class Liar:
    """Has a length and no members."""

    def __len__(self):
        return 3

    def __getitem__(self, place):
        raise KeyError(place)


STRANGE = [
    *(None, True, -1, 0, 2.5, 1e300, float("nan"), float("inf"), 10**30, 1 + 2j),
    *("", "x", "a\nb", "\0", "1 N", b"tip", "a" * 10_000),
    *([], [[]], [None], ["x"], [1.0, float("nan")], [[1, 2], [3]], (2, 1), (0, 0), [[[[1]]]]),
    *({}, {"x": 1}, {1: 2}, {"tip": None}, {1, 2}, range(3)),
    *(object(), Mute(), Liar(), [object()], [Mute()], Ellipsis, lambda *_: None),
    *(np.array(3.0), np.array([]), np.array(["a", "b"]), np.array([None, 1])),
    *(np.zeros((2, 2, 2)), np.array([1 + 1j, 2]), np.array([1, 2], "datetime64[s]")),
    *(scipy.sparse.eye(3), np.ma.masked, np.ma.masked_array([1.0, 2.0], mask=[True, False])),
]

BEAM = snecma_beam()
DISK = beam_ring()
OMEGA = [170.0, 180.0]
FRF = ss.forced_response(BEAM, OMEGA, 1)
FLUTTER, NEGATIVE = flutter_mass()
LOST = ss.destabilised(single_dof(), ss.Rayleigh(mass=-20.0))
FLOW = ss.AerodynamicDamping([-0.001] * DISK.sectors)
SPAN = {"omega": (150.0, 220.0), "harmonics": 1}
MEASURED = ss.Measurement(OMEGA, "tip", FRF.amplitude("tip"), relative_noise=0.02)
POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
LINE = 2.0 * np.eye(6) - np.eye(6, k=1) - np.eye(6, k=-1)
SEAT = ss.Structure(np.eye(2), 1e6 * np.eye(2), None, ["x", "y"])
FACES = {"friction": 0.5, "tangential_stiffness": 3e5, "normal_stiffness": 3e5}
WEDGE = ss.WedgeDamper(**FACES, mass=0.1, load=120.0, angle=30.0)
LOOP = np.sin(np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
LAW = {"dof": "a", "stiffness": 1.0}


MADE = {
    ss.Structure: {"mass": np.eye(3), "stiffness": 1e4 * np.eye(3), "damping": np.eye(3)},
    ss.Rayleigh: {"mass": 1.0},
    ss.ModalDamping: {"ratio": 0.01},
    ss.Force: {"dof": "tip", "amplitude": 1.0},
    ss.Model: {"structure": BEAM.structure, "contacts": BEAM.contacts, "forces": BEAM.forces},
    ss.Jenkins: LAW | {"slip_force": 1.0},
    ss.ParallelJenkins: {"dof": "a", "stiffness": (1.0, 2.0), "slip_forces": (1.0, 2.0)},
    ss.StructuralDamper: {"dofs": "ab", "stiffness": np.eye(2), "slip_forces": [1.0, 2.0]},
    ss.Coulomb: {"dofs": ["a", "b"], "normal": [0, 1], **FACES},
    ss.Stop: LAW | {"gap": 1.0},
    ss.Cubic: LAW,
    ss.Iwan: LAW | {"slip_force": 1.0, "chi": -0.5},
    ss.BoucWen: LAW | {"slip_force": 1.0},
    ss.Masing: LAW | {"slip_force": 1.0, "backbone": "exponential"},
    ss.Coupling: LAW,
    ss.BladedDisk: {"structure": BEAM.structure, "sectors": 6, "engine_order": 1},
    ss.State: {"model": BEAM},
    ss.Measurement: {"omega": OMEGA, "dof": "tip", "amplitude": [1e-3, 2e-3]},
    ss.MeasuredPeak: {"dof": "tip", "amplitude": 1e-3, "span": (150.0, 200.0)},
    ss.MeasuredLoop: {"contact": 0, "displacement": LOOP, "force": LOOP},
    ss.MeasuredBackbone: {"amplitude": [1e-3, 2e-3], "omega": OMEGA},
    ss.Frf: {"omega": OMEGA, "values": [1.0, 1j], "dof": "a", "reference": "b"},
    ss.Mesh: {"nodes": POINTS, "cells": [("quad", [[0, 1, 2, 3]])]},
    ss.RigidBody: {"mass": 1.0},
    ss.FlexibleBody: {"structure": ss.Structure(np.eye(2), np.eye(2), None, ["1.x", "1.y"])},
    ss.ContactPoint: {"normal": [0.0, 1.0]},
    ss.Centrifugal: {"radius": 1.0, "speed": 100.0},
    ss.WedgeDamper: FACES | {"mass": 0.1, "load": 120.0, "angle": 30.0},
    ss.StripDamper: FACES | {"mass": 0.1, "load": 120.0},
    ss.AerodynamicDamping: {"ratio": [0.01]},
    ss.InfluenceCoefficients: {"coefficients": {0: 1j, 1: 0.1}, "dof": "tip"},
    ss.ModalForces: {"values": [1j, 1.0]},
    ss.Interface: {"stiffness": np.zeros((4, 4))},
    ss.HighestPeak: {"dof": "tip", "omega": (150.0, 200.0)},
    ss.Optimum: {"dof": "tip"},
    ss.Backbone: {"amplitude": [1e-3]},
}

CALLED = {
    ss.forced_response: {"model": BEAM, "omega": OMEGA, "harmonics": 1},
    ss.exact_response: {"model": BEAM, "omega": OMEGA[:1]},
    ss.single_harmonic: {"model": BEAM, "omega": OMEGA},
    ss.transient: {"model": BEAM, "omega": 170.0, "periods": 2},
    ss.static_response: {"model": BEAM},
    ss.damper_curve: {"model": BEAM, "slip_force": [100.0], "dof": "tip", **SPAN},
    ss.optimal_damper: {"model": BEAM, "dof": "tip", "bounds": (100.0, 300.0), **SPAN},
    ss.limit_cycles: {"model": FLUTTER, "negative_damping": NEGATIVE, "ratio": [1.0]},
    ss.stability_map: {"model": FLUTTER, "negative_damping": NEGATIVE, "stiffness": [1e7]},
    ss.nonlinear_modes: {"model": BEAM, "amplitude": [1e-4], "harmonics": 1},
    ss.fit: {"model": BEAM, "measured": [MEASURED], "parameters": {"slip_force": (50.0, 1e3)}},
    ss.sweep: {"models": BEAM, "analysis": lambda _: FRF, "slip_force": [100.0]},
    ss.classify: {"model": LOST, "start": {"mass": 5e-5}, "periods": 20},
    ss.basin_map: {"model": LOST, "axes": {"mass": [1e-5], 0: [2e-5]}, "periods": 20},
    ss.certify: {"result": FRF, "points": 1},
    ss.campbell: {"models": DISK, "diagram": "nodal-diameters"},
    ss.speed_response: {"build": lambda _: BEAM, "speed": [100.0], "dof": "tip", "harmonics": 1},
    ss.mistuning_study: {"disk": DISK, "deviation": 0.02, "patterns": 1, "dofs": "tip", **SPAN},
    ss.aerodynamic_waves: {"disk": DISK, "influence": FLOW},
    ss.natural_frequencies: {"model": BEAM},
    ss.slip_configurations: {"model": BEAM},
    ss.destabilised: {"model": BEAM, "negative_damping": NEGATIVE},
    ss.join: {"structures": {"1": SEAT}},
    ss.engine_order_forces: {"dof": "*.x", "amplitude": 1.0, "engine_order": 1, "dofs": ["0.x"]},
    ss.mistuning_pattern: {"sectors": 5, "deviation": 0.1},
    ss.frequency_pattern: {"deviations": [0.01, -0.02]},
    ss.modal_damping: {"ratio": 0.01},
    ss.craig_bampton: {"mass": np.eye(6), "stiffness": LINE, "boundary": [0], "modes": 2},
    ss.cyclic_sector: {"structure": SEAT, "boundary": {"x": "y"}},
    ss.spinning: {"structure": SEAT, "stiffening": np.eye(2)},
    ss.rigid_limit_cycle: {"mass": 1.0, "damping": -0.1, "stiffness": 1.0, "slip_force": 1.0},
    ss.single_harmonic_cycles: {
        **{"mass": 1.0, "damping": -0.1, "stiffness": 1.0},
        **{"contact_stiffness": 1.0, "slip_force": 1.0},
    },
    ss.report: {"results": FRF, "path": "a.html"},
    ss.load: {"path": "a.nc"},
    ss.read_matrix: {"path": "a.npy"},
    ss.read_dofs: {"path": "a.pch"},
    ss.read_frf: {"path": "a.uff"},
    ss.read_curve: {"path": "a.csv", "columns": 3},
    ss.read_mesh: {"path": "a.inp"},
    ss.write_frf: {"path": "a.uff", "functions": ss.Frf([1.0, 2.0], [1.0, 1j], "a", "b")},
    ss.merge_stores: {"target": "a.db", "sources": ["b.db"]},
    ss.compare_fits: {"fits": {}},
    WEDGE.between: {"left": SEAT, "right": SEAT, "left_dofs": "xy", "right_dofs": "xy"},
    FRF.amplitude: {"dof": "tip"},
    FRF.waveform: {"dof": "tip", "index": 0},
    FRF.contact_force: {"contact": 0, "index": 0},
    FRF.peak: {"dof": "tip"},
    FRF.plot: {"dof": "tip"},
    FRF.save: {"path": "a.nc"},
    FRF.export: {"path": "a.csv"},
    BEAM.scaled: {"force": 2.0},
    DISK.mistuned: {"pattern": np.zeros(DISK.sectors)},
}

ELSEWHERE = {ss.design_map, ss.flutter_map, ss.uncertainty, ss.slip_area}
"""Tested with their analyses: the smallest valid call takes seconds, or a mesh."""


class Slow(BaseException):
    """Not an Exception: nothing may catch it."""


def stop(*_):
    raise Slow


@pytest.fixture
def quick():
    before = signal.signal(signal.SIGALRM, stop)
    yield lambda: signal.alarm(LIMIT)
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def refusal(call):
    """Return what is said if a call is refused; anything else that it raises is a defect."""
    try:
        call()
    except ss.ModelError as error:
        return str(error)
    return ""


def names(call):
    own = inspect.signature(call).parameters.values()
    return [one.name for one in own if one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("call", [*MADE, *CALLED], ids=lambda call: call.__qualname__)
def test_what_an_argument_cannot_be_is_told_in_one_line(call, tmp_path, monkeypatch, quick):
    monkeypatch.chdir(tmp_path)
    given = (MADE | CALLED)[call]
    for name in names(call):
        for value in STRANGE:
            quick()
            line = refusal(lambda name=name, value=value: call(**given | {name: value}))
            assert len(line.splitlines()) <= 1, (name, line)
            assert len(line) < 1000, (name, line)


def test_every_function_is_among_them():
    public = {getattr(ss, name) for name in ss.__all__}
    functions = {one for one in public if inspect.isfunction(one)}
    assert functions <= {*CALLED, *ELSEWHERE}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.spinning(3, np.eye(2)), "structure: 3 cannot be used; give ss.Structure(...)"),
        (lambda: ss.write_frf("a.uff", 3), "frf: 3 is not a list; write [frf, ...]"),
        (lambda: single_dof(force_ratio="1 N"), "force_ratio: '1 N' cannot be used; give a number"),
        (lambda: ss.Mesh([[0, 0, 0]], 3), "mesh: cells: 3 is not a list; write [(kind, nodes), "),
        (lambda: ss.Mesh([[0, 0, 0]], [3]), "mesh: cells: 3 is no pair; give (kind, nodes)"),
        (lambda: ss.Mesh("x"), "mesh: nodes: 'x' holds no real numbers; give three coordinates"),
        (lambda: ss.Mesh([[0, 0, 0]], (), [0.5]), "mesh: numbers: [0.5] holds no whole numbers; "),
        (lambda: ss.Frf([1, 2j], [1, 2], "a", "b"), "frf: omega: [1, 2j] holds no real numbers; "),
        (lambda: FRF.to_dataset(derived="no"), "derived: 'no'; give True or False"),
        (lambda: FRF.plot("tip", log=np.array([1.0, 2.0])), "log: array([1., 2.]); give True or F"),
        (lambda: FRF.plot("tip", labels=np.array(3.0)), "labels: array(3.) is not a list; give "),
        (
            lambda: ss.damper_curve(BEAM, dof="tip", contacts=np.array(3.0), slip_force=[1.0]),
            "contacts: array(3.) is not a list of contacts",
        ),
        (lambda: ss.Optimum("tip", bounds=[1.0]), "optimum: bounds: [1.0]; give (lowest, highest)"),
        (lambda: ss.load("a\nb.nc"), "path: 'a\\nb.nc' has a control character; give a name witho"),
        (lambda: ss.load("a" * 5000), "path: 'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"),
    ],
)
def test_the_argument_its_value_and_the_remedy_are_named(call, message):
    with pytest.raises(ss.ModelError) as refused:
        call()
    assert str(refused.value).startswith(message)


def test_what_a_function_of_the_user_raises_stays_what_it_is():
    def analysis(_):
        raise ValueError("mine")

    with pytest.raises(ValueError, match=r"^mine$") as raised:
        ss.sweep(BEAM, analysis, slip_force=[100.0])
    assert not isinstance(raised.value, ss.ModelError)

    def broken():
        yield BEAM.contacts[0]
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        ss.Model(BEAM.structure, broken())


def test_what_comes_from_the_caller_is_never_put_down_to_an_argument() -> None:
    def build(**_: float) -> ss.Model:
        raise KeyError("my own")

    with pytest.raises(KeyError, match="my own"):
        ss.design_map(
            build, {"mass": [1.0], "angle": [1.0]}, dof="tip", omega=(20.0, 350.0), tolerance="1 %"
        )
    with pytest.raises(KeyError, match="mine"):
        ss.forced_response(snecma_beam(), [170.0, 180.0], 3, observe=map({}.__getitem__, ["mine"]))


def test_whole_numbers_may_be_those_of_a_table() -> None:
    nodes = np.eye(3)
    mesh = ss.Mesh(nodes, node_sets={"A": np.array([0.0, 1.0])})
    assert mesh.node_sets["A"].tolist() == [0, 1]
    with pytest.raises(ss.ModelError, match="holds no whole numbers"):
        ss.Mesh(nodes, node_sets={"A": np.array([0.5, 1.0])})


@pytest.mark.parametrize("given", ["0.02", ["wide"], [0.01, None]])
def test_deviations_of_frequencies_are_numbers(given) -> None:
    with pytest.raises(ss.ModelError, match=r"holds no real numbers; give \(f - f0\) / f0"):
        ss.frequency_pattern(given)

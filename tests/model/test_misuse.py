"""What users write by mistake: one line names the entry and the remedy, where they wrote it."""

import copy
import inspect
import pickle
from inspect import isabstract
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

import stickslip as ss
from stickslip import plot
from stickslip.calls import checked
from stickslip.errors import CallError
from stickslip.reference import snecma_beam
from stickslip.study import Study
from stickslip.study.analysis import AnyAnalysis

BEAM = snecma_beam()
FRF = ss.forced_response(BEAM, [170.0, 180.0], 3)
EXACT = ss.exact_response(BEAM, [170.0])
PAIR = ss.join({"1": BEAM.structure, "2": BEAM.structure})
PLATFORM = ss.Structure(np.eye(3), np.eye(3) * 1e4, dofs=["ps.z", "ss.z", "tip.x"])


def disk(*dofs, force="tip.x"):
    contact = ss.Jenkins(*dofs, stiffness=1.0, slip_force=1.0)
    return ss.BladedDisk(
        PLATFORM, 6, contacts=[contact], forces=[ss.Force(force, 1.0)], engine_order=1
    )


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ss.forced_response(BEAM, (1, 2), harmonic=5),
            "forced_response: unknown keyword 'harmonic'; did you mean 'harmonics'?",
        ),
        (lambda: ss.forced_response(BEAM), "forced_response: omega is missing; give omega=..."),
        (
            lambda: ss.Jenkins("tip", stifness=1.0, slip_force=1.0),
            "Jenkins: unknown keyword 'stifness'; did you mean 'stiffness'?",
        ),
        (lambda: ss.Stop("tip", stiffness=1.0), "Stop: gap is missing; give gap=..."),
        (
            lambda: ss.Jenkins("tip", None, 1.0, 2.0),
            "Jenkins: 4 arguments without a name, and it takes 2; give the others by name: "
            "'name', 'stiffness', 'slip_force'",
        ),
        (
            lambda: ss.Rayleigh(alpha=1.0),
            "Rayleigh: unknown keyword 'alpha'; known: 'mass', 'stiffness'",
        ),
        (
            lambda: ss.Rayleigh(0.1, 1e-5),
            "Rayleigh: 2 arguments without a name, and it takes 0; give the others by name: ",
        ),
        (
            lambda: ss.Model(BEAM.structure, [], contacts=[]),
            "Model: contacts is given twice, by position and by name; give it once",
        ),
        (
            lambda: ss.BladedDisk(PLATFORM, 6, engine_ordr=2),
            "BladedDisk: unknown keyword 'engine_ordr'; did you mean 'engine_order'?",
        ),
        (
            lambda: ss.StructuralDamper(["tip"], stiffness=[[1.0]], slip_force=[1.0]),
            "StructuralDamper: unknown keyword 'slip_force'; did you mean 'slip_forces'?",
        ),
        (
            lambda: FRF.amplitude("tip", measur="max"),
            "ForcedResponse.amplitude: unknown keyword 'measur'; did you mean 'measure'?",
        ),
        (lambda: FRF.amplitude(), "ForcedResponse.amplitude: dof is missing; give dof=..."),
        (
            lambda: EXACT.waveform("tip", 0, sample=3),
            "ExactResponse.waveform: unknown keyword 'sample'; did you mean 'samples'?",
        ),
        (
            lambda: EXACT.energy.friction.shape and EXACT.events(idx=0),
            "ExactResponse.events: unknown keyword 'idx'; did you mean 'index'?",
        ),
        (
            lambda: FRF.plot("tip", lenght_unit="mm"),
            "curves: unknown keyword 'lenght_unit'; did you mean 'length_unit'?",
        ),
        (
            lambda: plot.curves(FRF, "tip", colour="red"),
            "curves: unknown keyword 'colour'; known: 'results', 'dof', 'ax', ",
        ),
        (
            lambda: ss.transient(BEAM, 170.0, period=2),
            "transient: unknown keyword 'period'; did you mean 'periods'?",
        ),
        (
            lambda: ss.damper_curve(BEAM, slip_forces=[1.0], dof="tip"),
            "damper_curve: unknown keyword 'slip_forces'; did you mean 'slip_force'?",
        ),
        (
            lambda: ss.reference.snecma_beam(forc=3.0),
            "snecma_beam: unknown keyword 'forc'; did you mean 'force'?",
        ),
        (lambda: Study.load("x", y=2), "Study.load: unknown keyword 'y'; known: 'path'"),
        (
            lambda: BEAM.scaled(forces=2.0),
            "Model.scaled: unknown keyword 'forces'; did you mean 'force'?",
        ),
        (
            lambda: ss.read_matrix("m.mtx", sparce=True),
            "read_matrix: unknown keyword 'sparce'; did you mean 'sparse'?",
        ),
    ],
)
def test_calls_that_do_not_fit(call, message):
    with pytest.raises(CallError) as refusal:
        call()
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)
    # Who expects the error of Python is served as well.
    assert isinstance(refusal.value, ss.ModelError)
    assert isinstance(refusal.value, TypeError)


def public():
    for name in ss.__all__:
        value = getattr(ss, name)
        if inspect.isfunction(value) or (isinstance(value, type) and value.__init__ is not object):
            yield name, value
    for module in (ss.plot, ss.reference, ss.fe, ss.study):
        yield from ((name, getattr(module, name)) for name in module.__all__)


def test_every_public_function_words_a_misspelt_keyword():
    refused = 0
    for name, value in public():
        if not inspect.isfunction(value):
            continue
        with pytest.raises(ss.ModelError, match=rf"^{name}: unknown keyword 'misspelt'; "):
            value(misspelt=1)
        refused += 1
    assert refused > 50


def test_every_public_class_words_a_misspelt_keyword():
    ours = [value for _, value in public() if isinstance(value, type) and not isabstract(value)]
    plain = [one for one in ours if "__init__" in vars(one) and not issubclass(one, BaseException)]
    assert len(plain) > 20
    for kind in plain:
        with pytest.raises(ss.ModelError, match=rf"^{kind.__name__}: unknown keyword 'misspelt'"):
            kind(misspelt=1)


def test_signatures_stay_and_functions_travel():
    assert list(inspect.signature(ss.forced_response).parameters)[:3] == [
        "model",
        "omega",
        "harmonics",
    ]
    assert "omega : array_like" in ss.forced_response.__doc__
    assert next(iter(inspect.signature(ss.Jenkins).parameters)) == "dof"
    for value in (ss.forced_response, ss.natural_frequencies, ss.Jenkins):
        assert pickle.loads(pickle.dumps(value)) is value
        assert checked(value) is value
    assert copy.copy(BEAM.contacts[0]) == BEAM.contacts[0]


def test_errors_from_inside_are_left_alone():
    def fails(share):
        raise TypeError("mine")

    with pytest.raises(TypeError, match="mine") as error:
        ss.forced_response(BEAM, np.linspace(100.0, 200.0, 2000), 9, progress=fails)
    assert not isinstance(error.value, ss.ModelError)


# ---------------------------------------------------------------------------------- names


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (
            lambda: disk("ss.z", "prev.ps.z"),
            "unknown dof 'prev.ps.z': contacts lead from a sector to the next one; write this one "
            "as it stands in the sector before, with the dofs 'next.ss.z', 'ps.z'",
        ),
        (lambda: disk("ss.z", "nxt.ps.z"), "unknown dof 'nxt.ps.z'; did you mean 'next.ps.z'?"),
        (lambda: disk("ss.z", "next.sp.z"), "unknown dof 'next.sp.z'; known: "),
        (lambda: disk("ss.z", "next.tip.y"), "unknown dof 'next.tip.y'; did you mean 'next.tip.x'"),
        (lambda: disk("tip.z"), "unknown dof 'tip.z'; did you mean 'tip.x'?"),
        (lambda: disk("ps.z", force="next.tip.x"), "forces are those on sector 0, .* 'tip.x'"),
        (lambda: PAIR.index("1.tpi"), "unknown dof '1.tpi'; did you mean '1.tip'?"),
        (lambda: PAIR.index("3.tip"), "unknown dof '3.tip'; known: '1.damper', "),
        (lambda: PAIR.index("tip"), "unknown dof 'tip'; did you mean '1.tip' or '2.tip'?"),
        (
            lambda: ss.forced_response(disk("ps.z").mistuned(0), [1.0], observe=["9.tip.x"]),
            "observe: unknown dof '9.tip.x'; known: ",
        ),
    ],
)
def test_a_misspelt_name_is_never_that_of_another_body(build, message):
    with pytest.raises(ss.ModelError, match=message):
        build()


def test_the_contact_that_is_advised_is_the_same():
    """As the sector before sees it: with a contact from the sector to the next one."""
    with pytest.raises(ss.ModelError):
        disk("ss.z", "prev.ps.z")
    assert disk("next.ss.z", "ps.z").contacts[0].dofs == ("next.ss.z", "ps.z")


# ----------------------------------------------------------------------------- study files

STUDY = """
[structure]
mass = [[1.0, 0.0], [0.0, 1.0]]
stiffness = [[2e4, -1e4], [-1e4, 2e4]]
dofs = ["ps.z", "ss.z"]
[[contact]]
law = "jenkins"
dof = "ps.z"
stiffness = 1e4
slip_force = 2.0
[[force]]
dof = "ss.z"
amplitude = 10.0
[analysis]
kind = "forced-response"
omega = [110.0]
harmonics = 3
"""
DISK = "[disk]\nsectors = 6\nengine_order = 2\n"
CONTACT, PLAIN = (
    'dof = "ps.z"\nstiffness',
    'kind = "forced-response"\nomega = [110.0]\nharmonics = 3',
)


def run(*changes, tail=""):
    text = STUDY
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return list(Study.parse(text + tail, folder=Path()).run())


@pytest.mark.parametrize(
    ("changes", "tail", "message"),
    [
        (
            [('"jenkins"', '"dahl"')],
            "",
            "contact 1: unknown law 'dahl'; known: 'jenkins', 'parallel-jenkins', 'iwan', "
            "'masing', 'bouc-wen', 'structural', 'coulomb', 'stop', 'cubic' (slip limits are "
            "slip_force of 'jenkins', 'iwan', 'masing', 'bouc-wen' and slip_forces of "
            "'parallel-jenkins', 'structural')",
        ),
        (
            [('"forced-response"', '"exact-response"')],
            "",
            "'exact-response'; did you mean 'exact'?",
        ),
        (
            [(CONTACT, 'dofs = ["ss.z", "prev.ps.z"]\nstiffness')],
            DISK,
            "contact 1: unknown dof 'prev.ps.z': contacts lead from a sector to the next one",
        ),
        (
            [(CONTACT, 'dofs = ["ss.z", "nxt.ps.z"]\nstiffness')],
            DISK,
            "contact 1: unknown dof 'nxt.ps.z'; did you mean 'next.ps.z'?",
        ),
        (
            [(CONTACT, 'dofs = ["ss.z", "next.pz.z"]\nstiffness')],
            DISK,
            "contact 1: unknown dof 'next.pz.z'; known: ",
        ),
        (
            [(CONTACT, 'dofs = ["ss.z", "next.ps.z"]\nstiffness')],
            "",
            "unknown dof 'next.ps.z'; known: 'ps.z', 'ss.z' (the next sector is that of a [disk])",
        ),
        (
            [(CONTACT, 'dofs = ["ps.z", "ground"]\nstiffness')],
            "",
            '(a contact to the ground has dof = "..." alone)',
        ),
        (
            [('dof = "ss.z"', 'dof = "next.ss.z"')],
            DISK,
            "force 1: 'next.ss.z': forces are those on sector 0, from which those on the others "
            "follow; write 'ss.z'",
        ),
        (
            [(PLAIN, 'kind = "transient"\nomega = 110.0\nperiods = 2')],
            DISK,
            "compute all sectors, mistuning = {deviation = 0.0} in [disk]",
        ),
        (
            [("amplitude = 10.0", "amplitude = 10.0\nharmonic = 3")],
            DISK + "engine_orders = {3 = 5}\n",
            "compute all sectors, mistuning = {deviation = 0.0} in [disk]",
        ),
        (
            [
                (PLAIN, 'kind = "single-harmonic"\nomega = [110.0]'),
                ("amplitude = 10.0", "amplitude = 10.0\nharmonic = 3"),
            ],
            "",
            'takes forces of harmonic 1 alone, use kind = "forced-response"',
        ),
        (
            [(PLAIN, 'kind = "limit-cycles"\nnegative_damping = [[-1.0]]')],
            "",
            "give 2 x 2, or {modal = [...]}",
        ),
        ([(PLAIN, f"{PLAIN}\npoints = [7]".replace("forced-response", "certify"))], "", "points: "),
    ],
)
def test_study_files_are_advised_in_their_own_words(changes, tail, message):
    with pytest.raises(ss.ModelError) as refusal:
        run(*changes, tail=tail)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert not any(
        word in str(refusal.value) for word in (" ss.", "mistuned(", "_response", "lambda")
    )


def test_the_advice_for_all_sectors_works():
    (exact,) = run(
        (PLAIN, 'kind = "exact"\nomega = [110.0]'), tail=DISK + "mistuning = {deviation = 0.0}\n"
    )
    assert len(exact.model.structure) == 12


def test_all_kinds_are_listed():
    with pytest.raises(ss.ModelError, match="unknown kind 'swing'; known: ") as refusal:
        run(('"forced-response"', '"swing"'))
    kinds = get_args(AnyAnalysis)[1].tables
    assert len(kinds) >= 9
    for kind in kinds:
        assert repr(kind) in str(refusal.value)


def test_remedies_for_python_stay():
    with pytest.raises(ss.ModelError, match=r"give all sectors, disk.mistuned\(0\)") as refusal:
        ss.transient(disk("ps.z"), omega=100.0, periods=2)
    again = pickle.loads(pickle.dumps(refusal.value))
    assert (str(again), again.study) == (str(refusal.value), refusal.value.study)


MASKED = np.ma.masked_array([160.0, 170.0, 180.0], mask=[False, True, False])
HALF = np.ma.masked_array(np.eye(3) * 1e4, mask=np.eye(3) > 0.0)


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("omega", lambda given: ss.forced_response(BEAM, given, 3)),
        ("omega", lambda given: ss.forced_response(BEAM, omega=list(given), harmonics=3)),
        ("omega", lambda given: ss.exact_response(BEAM, given)),
        ("mass", lambda given: ss.Structure(HALF, np.eye(3))),
        ("stiffness", lambda given: ss.Structure(np.eye(3), stiffness=HALF)),
        ("slip_force", lambda given: ss.damper_curve(BEAM, slip_force=given, dof="tip")),
        ("slip_forces", lambda given: ss.ParallelJenkins("a", stiffness=(1, 2), slip_forces=given)),
        ("amplitude", lambda given: ss.Measurement([1.0, 2.0, 3.0], "tip", given)),
        ("axes", lambda given: ss.basin_map(BEAM, {"tip": given, "damper": given})),
        ("values", lambda given: ss.Frf([1.0, 2.0, 3.0], given, "a", "b")),
        ("pattern", lambda given: disk("ps.z").mistuned(list(MASKED) * 2)),
        ("nodes", lambda given: ss.Mesh(HALF)),
    ],
)
def test_masked_entries_have_no_value(name, call):
    with pytest.raises(ss.ModelError, match=f"^{name}: masked entries, which have no value"):
        call(MASKED)


def test_an_array_of_which_nothing_is_masked_is_one():
    omega = np.ma.masked_array([170.0, 180.0], mask=False)
    np.testing.assert_array_equal(
        ss.forced_response(BEAM, omega, 3).amplitude("tip"), FRF.amplitude("tip")
    )


def test_a_position_that_is_an_array_is_told_in_one_line():
    with pytest.raises(ss.ModelError, match="is not an integer; see omega") as refused:
        FRF.contact_force(0, np.zeros((2, 2, 2)))
    assert len(str(refused.value).splitlines()) == 1

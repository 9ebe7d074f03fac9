"""Contacts, forces and models: what they hold, how they are addressed, what they refuse."""

import json
import math
import pickle
import subprocess
import sys
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.errors import ModelError
from stickslip.model import Model, natural_frequencies
from stickslip.model.contact import LAWS, Contact, Jenkins, contact_from_spec
from stickslip.model.force import Force, force_from_spec
from stickslip.reference import beam_pair, snecma_beam, snecma_structure

few = settings(max_examples=40, deadline=None)


@dataclass(frozen=True)
class Twin(Contact):
    """A law with two points, as a law outside the package would be written."""

    law = "twin"
    dofs = ("damper", "tip")
    points = 2

    def rows(self, structure):
        return np.eye(2, len(structure))

    def parameters(self):
        return {"stiffness": 1.0}

    def scaled(self, slip_force):
        return self

    @classmethod
    def from_parameters(cls, dofs, parameters, name):
        return cls(name=name)


def damper(**changes):
    return Jenkins(**{"dof": "damper", "stiffness": 2.4e7, "slip_force": 246.048, **changes})


def model(*contacts, forces=()):
    return Model(snecma_structure(), contacts, forces)


# contacts


def test_jenkins_to_ground():
    contact = damper()
    assert (contact.law, contact.points, contact.dofs) == ("jenkins", 1, ("damper",))
    np.testing.assert_array_equal(contact.rows(snecma_structure()), [[1.0, 0.0, 0.0]])
    assert contact.parameters() == {"stiffness": 2.4e7, "slip_force": 246.048}


def test_jenkins_between_two_dofs():
    contact = Jenkins("tip", "damper", stiffness=1, slip_force=0)
    assert contact.dofs == ("tip", "damper")
    np.testing.assert_array_equal(contact.rows(snecma_structure()), [[-1.0, 1.0, 0.0]])
    assert contact.parameters() == {"stiffness": 1.0, "slip_force": 0.0}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"stiffness": -1.0}, "^jenkins contact at 'damper': stiffness -1 is negative"),
        ({"stiffness": math.nan}, "at 'damper': stiffness: nan is not a number"),
        ({"stiffness": math.inf}, "stiffness inf; take about 1000 times the local structure"),
        ({"stiffness": "2.4e7 N/m"}, "stiffness: '2.4e7 N/m' is not a number; .*SI units"),
        ({"stiffness": 10**400}, "stiffness: 1000.* is too large; give a number below 1e308"),
        ({"slip_force": -(10**5000)}, "slip_force: <int> is too large"),
        ({"stiffness": None}, "stiffness: None is not a number"),
        ({"stiffness": 1j}, "stiffness: 1j is complex"),
        ({"slip_force": -5}, "at 'damper': slip_force -5 is negative"),
        ({"slip_force": math.nan}, "slip_force: nan is not a number"),
        ({"slip_force": [1.0]}, r"slip_force: \[1.0\] is not a number"),
        ({"slip_force": True}, "slip_force: True is not a number"),
        ({"other": "damper"}, "both ends at dof 'damper'; name another dof"),
        ({"dof": ""}, "jenkins contact: dof: '' is empty"),
        ({"dof": 0}, "jenkins contact: dof: 0 is not text"),
        ({"other": 1}, "jenkins contact: other: 1 is not text"),
        ({"name": " "}, "jenkins contact: name: ' ' is empty"),
        ({"name": 1}, "jenkins contact: name: 1 is not text"),
    ],
)
def test_jenkins_refuses(changes, message):
    with pytest.raises(ModelError, match=message):
        damper(**changes)


@pytest.mark.parametrize("number", [2, np.float32(2), np.int64(2), np.array(2.0)])
def test_numbers_of_all_kinds_become_floats(number):
    contact = damper(stiffness=number)
    assert type(contact.stiffness) is float
    assert contact.stiffness == 2.0


@few
@given(
    st.sampled_from([("a",), ("a", "b")]),
    st.floats(0.0, 1e12),
    st.floats(0.0, allow_nan=False),
    st.sampled_from([None, "root"]),
)
def test_contact_survives_json(dofs, stiffness, slip_force, name):
    contact = Jenkins(*dofs, stiffness=stiffness, slip_force=slip_force, name=name)
    stored = json.dumps(contact.to_spec(), allow_nan=False)
    assert contact_from_spec(json.loads(stored)) == contact


SPEC = damper().to_spec()
PARAMETERS = damper().parameters()


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ({**SPEC, "law": "jenkin"}, "contact: unknown law 'jenkin'; did you mean 'jenkins'"),
        ({"dofs": ["tip"]}, "contact: unknown law None; known: 'jenkins'"),
        ({**SPEC, "law": ["jenkins"]}, "unknown law"),
        ({**SPEC, "dof": "tip"}, "contact: unknown key 'dof'; did you mean 'dofs'"),
        ({**SPEC, "dofs": "tip"}, "jenkins contact: dofs 'tip' is not a list"),
        ({**SPEC, "dofs": []}, "jenkins contact: 0 dofs; give one"),
        ({**SPEC, "dofs": ["a", "b", "c"]}, "jenkins contact: 3 dofs"),
        ({**SPEC, "dofs": [1]}, "dof: 1 is not text"),
        ({**SPEC, "parameters": None}, "parameters None is not a table"),
        ({**SPEC, "parameters": {"stiffness": 1.0}}, "slip_force is missing"),
        ({**SPEC, "parameters": {**PARAMETERS, "slipforce": 1}}, "did you mean 'slip_force'"),
        ({**SPEC, "parameters": {**PARAMETERS, "stiffness": "inf"}}, "stiffness inf; take about"),
        ({**SPEC, "parameters": {**PARAMETERS, "stiffness": "1"}}, "'1' is not a number"),
        ({**SPEC, "name": 3}, "name: 3 is not text"),
    ],
)
def test_contact_from_spec_refuses(spec, message):
    with pytest.raises(ModelError, match=message):
        contact_from_spec(spec)


def test_laws_are_registered_by_their_name():
    assert all(law.law == name for name, law in LAWS.items())


# forces


@pytest.mark.parametrize(
    ("force", "coefficient"),
    [
        (Force("tip", 2.0), 2.0),
        (Force("tip", amplitude=2.0, phase=math.pi / 2), 2j),
        (Force("tip", -3, harmonic=0), -3.0),
        (Force("tip", 1.0, -math.pi / 2, 3), -1j),
    ],
)
def test_force_coefficient_is_that_of_its_cosine(force, coefficient):
    assert force.coefficient == pytest.approx(coefficient, abs=1e-15)


def test_static_load_is_exactly_real():
    assert Force("tip", -3.0, harmonic=0).coefficient.imag == 0.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"amplitude": math.nan}, "^force at 'tip': amplitude: nan is not a finite number"),
        ({"amplitude": math.inf}, "amplitude: inf is not a finite number"),
        ({"amplitude": 1 + 1j}, "amplitude: .* is complex"),
        ({"amplitude": "20 N"}, "amplitude: '20 N' is not a number"),
        ({"phase": math.nan}, "phase: nan"),
        ({"phase": "90 deg"}, "phase: '90 deg' is not a number"),
        ({"harmonic": -1}, "harmonic: -1 lies below 0; give at least 0"),
        ({"harmonic": 10**400}, "harmonic: 1000.* is too large; give at most 2147483647"),
        ({"harmonic": 1.5}, "harmonic: 1.5 is not an integer"),
        ({"harmonic": 2.0}, "harmonic: 2.0 is not an integer"),
        ({"harmonic": True}, "harmonic: True is not an integer"),
        ({"harmonic": 0, "phase": 0.5}, r"phase 0.5 on a static load \(harmonic 0\)"),
        ({"dof": ""}, "force: dof: '' is empty"),
        ({"dof": None}, "force: dof: None is not text"),
    ],
)
def test_force_refuses(arguments, message):
    with pytest.raises(ModelError, match=message):
        Force(**{"dof": "tip", "amplitude": 1.0, **arguments})


@few
@given(
    st.floats(-1e9, 1e9),
    st.one_of(
        st.tuples(st.floats(-10, 10), st.integers(1, 50)), st.tuples(st.just(0.0), st.just(0))
    ),
)
def test_force_survives_json(amplitude, rest):
    force = Force("tip", amplitude, *rest)
    assert force_from_spec(json.loads(json.dumps(force.to_spec()))) == force


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ({"dof": "tip"}, "force: amplitude is missing"),
        ({"amplitude": 1.0}, "force: dof is missing"),
        ({"dof": "tip", "amplitud": 1.0}, "unknown key 'amplitud'; did you mean 'amplitude'"),
        ({"dof": "tip", "amplitude": None}, "amplitude: None is not a number"),
        ({"dof": "tip", "amplitude": 1, "harmonic": 1.5}, "harmonic: 1.5 is not an integer"),
    ],
)
def test_force_from_spec_refuses(spec, message):
    with pytest.raises(ModelError, match=message):
        force_from_spec(spec)


# models


def test_model_of_nothing_but_a_structure():
    linear = Model(snecma_structure())
    assert linear.contacts == linear.forces == ()


def test_default_names_step_past_those_taken():
    free = Jenkins("tip", stiffness=1.0, slip_force=1.0)
    names = model(free, replace(free, name="jenkins-2"), free, Twin(), free).contact_names
    assert names == ("jenkins", "jenkins-2", "jenkins-3", "twin", "jenkins-4")
    assert free.name is None


def test_contacts_carry_their_names():
    assert [contact.name for contact in model(damper(), damper()).contacts] == [
        "jenkins",
        "jenkins-2",
    ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"contacts": [damper(), damper(other="tpi")]},
            r"^contact 2 \('jenkins-2'\): unknown dof 'tpi'; did you mean 'tip'\?$",
        ),
        ({"contacts": [damper(name="root", dof="dampr")]}, r"contact 1 \('root'\): unknown dof"),
        ({"contacts": [damper(name="a"), damper(name="a")]}, "contact 2 .*contact 1 has this name"),
        ({"contacts": damper()}, r"contacts: Jenkins.* is not a list; write contacts=\[...\]"),
        ({"contacts": [Force("tip", 1.0)]}, "contact 1: Force.* is no contact; give a Contact"),
        ({"contacts": [Jenkins]}, "contact 1: .*is no contact"),
        ({"forces": [Force("tpi", 1.0)]}, r"^force 1: unknown dof 'tpi'; did you mean 'tip'\?$"),
        ({"forces": Force("tip", 1.0)}, r"forces: Force.* is not a list; write forces=\[...\]"),
        ({"forces": [("tip", 1.0)]}, r"force 1: \('tip', 1.0\) is no force; give a Force"),
        ({"contacts": np.array(None)}, "contacts: array.* is not a list"),
        ({"forces": np.array(1)}, "forces: array.* is not a list"),
        ({"structure": np.eye(3)}, "structure: array.* is not a Structure"),
    ],
)
def test_model_refuses(arguments, message):
    with pytest.raises(ModelError, match=message) as refusal:
        Model(**{"structure": snecma_structure(), **arguments})
    assert "\n" not in str(refusal.value)


def test_contacts_and_points_by_position_or_name():
    several = model(damper(), Twin(name="root"))
    assert [several.contact_index(ref) for ref in (0, "jenkins", np.int64(1), "root")] == [
        0,
        0,
        1,
        1,
    ]
    assert [several.point(ref) for ref in (0, "jenkins", ("root", 1), (1, 0), [0, 0])] == [
        (0, 0),
        (0, 0),
        (1, 1),
        (1, 0),
        (0, 0),
    ]


@pytest.mark.parametrize(
    ("ref", "message"),
    [
        ("rot", "unknown contact 'rot'; did you mean 'root'"),
        (2, "there is no contact at position 2; the model has 2, at 0 to 1$"),
        (-1, "contact: -1 lies below 0; give at least 0"),
        (0.0, "contact: 0.0 is not an integer"),
        (None, "contact: None is not an integer"),
        ("root", r"contact 'root': it has 2 points; write \('root', 0\)"),
        ((1, 2), "no point at position 2; contact 'root' has 2"),
        (("root", 2), "no point at position 2; contact 'root' has 2, at 0 to 1$"),
        (("root", "x"), "contact 'root': point: 'x' is not an integer"),
        (("root", 0, 0), "write \\(contact, point\\)"),
    ],
)
def test_point_refuses(ref, message):
    with pytest.raises(ModelError, match=message):
        model(damper(), Twin(name="root")).point(ref)


def test_a_model_without_contacts_has_none():
    with pytest.raises(ModelError, match="there is no contact at position 0; the model has none"):
        model().contact_index(0)
    with pytest.raises(ModelError, match="unknown contact 'jenkins'; there is none"):
        model().contact_index("jenkins")


def test_scaled_changes_levels_only():
    original = model(
        damper(name="root"), damper(slip_force=math.inf), forces=[Force("tip", 2.0, 0.3, 3)]
    )
    scaled = original.scaled(force=2.0, slip_force=0.5)
    assert scaled.structure is original.structure
    assert scaled.forces == (Force("tip", 4.0, 0.3, 3),)
    assert scaled.contacts[0] == damper(name="root", slip_force=123.024)
    assert scaled.contacts[1].slip_force == math.inf
    assert original.scaled().contacts == original.contacts
    assert original.scaled(slip_force=0.0).contacts[1].slip_force == math.inf


@pytest.mark.parametrize(
    ("factors", "message"),
    [
        ({"force": math.nan}, "factor on the forces: nan"),
        ({"slip_force": math.inf}, "factor on the slip forces: inf"),
        ({"slip_force": -1.0}, "factor on the slip forces: -1 is negative"),
    ],
)
def test_scaled_refuses(factors, message):
    with pytest.raises(ModelError, match=message):
        snecma_beam().scaled(**factors)


def test_model_is_immutable_short_and_picklable():
    pair = beam_pair()
    with pytest.raises(AttributeError):
        pair.forces = ()
    assert repr(pair).count("\n") == 0
    assert len(repr(pair)) < 160
    copy = pickle.loads(pickle.dumps(pair))
    assert (copy.contacts, copy.forces) == (pair.contacts, pair.forces)


# with the compiled core


def test_natural_frequencies_stuck_and_slipping():
    beam = snecma_beam()
    np.testing.assert_allclose(
        natural_frequencies(beam), [225.6623, 1404.3759, 3273.7922], rtol=3e-7
    )
    for slipping in ([0], ["jenkins"], [("jenkins", 0)], [0, (0, 0)]):
        np.testing.assert_allclose(
            natural_frequencies(beam, slipping), [159.5927, 901.7589, 2167.5410], rtol=3e-7
        )
    assert ss.natural_frequencies is natural_frequencies


def test_problem_is_built_once_and_not_pickled():
    beam = snecma_beam()
    assert beam.problem is beam.problem
    np.testing.assert_array_equal(
        natural_frequencies(pickle.loads(pickle.dumps(beam))), natural_frequencies(beam)
    )


@pytest.mark.parametrize("slip_force", [0.0, math.inf])
def test_limits_of_the_slip_force_are_legal(slip_force):
    assert model(damper(slip_force=slip_force)).problem


def test_zero_stiffness_is_no_contact():
    without = natural_frequencies(model(damper(stiffness=0.0)))
    np.testing.assert_allclose(without, natural_frequencies(model()), rtol=1e-12)


@pytest.mark.parametrize(
    ("slipping", "message"),
    [
        ("jenkins", r"slipping: 'jenkins' is not a list; write slipping=\[...\]"),
        (0, "slipping: 0 is not a list"),
        (np.array(0), r"slipping: array\(0\) is not a list"),
        (["jenkin"], "unknown contact 'jenkin'; did you mean 'jenkins'"),
        ([("jenkins", 1)], "no point at position 1; contact 'jenkins' has 1, at position 0$"),
    ],
)
def test_natural_frequencies_refuses(slipping, message):
    with pytest.raises(ModelError, match=message):
        natural_frequencies(snecma_beam(), slipping)


@pytest.mark.parametrize("other", ["x", None, snecma_structure()])
def test_natural_frequencies_of_no_model(other):
    with pytest.raises(ModelError, match=r"^model: .* is not a Model; give ss\.Model"):
        natural_frequencies(other)


def test_forces_add_up_by_harmonic():
    forces = [
        Force("tip", 1.0, harmonic=3),
        Force("tip", 1.0),
        Force("tip", 1.0, math.pi / 2),
        Force("damper", -2.0, harmonic=0),
    ]
    loads = model(forces=forces)._loads()
    assert [harmonic for harmonic, _ in loads] == [0, 1, 3]
    np.testing.assert_allclose(
        [load for _, load in loads], [[-2, 0, 0], [0, 1 + 1j, 0], [0, 1, 0]], atol=1e-15
    )


def test_what_the_core_refuses_is_a_model_error():
    with pytest.raises(ModelError):
        _ = model(Twin()).problem


# the package


def test_everything_exported_is_there():
    for name in ss.__all__:
        assert getattr(ss, name) is not None
        assert name in dir(ss)
    assert set(ss._HOMES) | set(ss._MODULES) == set(ss.__all__)
    assert ss.plot.curves is not None
    assert ss.study.Study is not None
    assert ss.reference.snecma_beam is snecma_beam


def test_unknown_export_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'stickslip' has no attribute 'Jenkin'"):
        _ = ss.Jenkin


def test_heavy_libraries_wait_for_their_use():
    heavy = ("scipy", "xarray", "matplotlib", "pint", "pydantic", "typer", "rich", "h5netcdf")
    code = (
        "import sys, stickslip as ss; "
        "ss.Model(ss.Structure([[1.0]], [[1.0]]), [], [ss.Force('0', 1.0)]); "
        f"print([name for name in {heavy} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"

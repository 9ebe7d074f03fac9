"""Contacts and forces: what they hold, how they are written to files, what they refuse."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stickslip.errors import ModelError
from stickslip.model.force import Force, force_from_spec
from stickslip.model.jenkins import Jenkins
from stickslip.model.laws import LAWS, contact_from_spec
from stickslip.reference import snecma_structure

few = settings(max_examples=40)


def damper(**changes):
    return Jenkins(**{"dof": "damper", "stiffness": 2.4e7, "slip_force": 246.048, **changes})


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
        ({"stiffness": "2.4e7 kg"}, "stiffness = '2.4e7 kg' is not a stiffness .*N/m"),
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
        ({"amplitude": "20 m"}, "amplitude = '20 m' is not a force"),
        ({"phase": math.nan}, "phase: nan"),
        ({"phase": "90 Hz"}, "phase = '90 Hz' is not an angle"),
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

"""Models: what they hold, how contacts are addressed, what they refuse."""

import math
import pickle
from dataclasses import dataclass, replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.errors import ModelError
from stickslip.model import Model, natural_frequencies
from stickslip.model.contact import Contact
from stickslip.model.force import Force
from stickslip.model.jenkins import Jenkins
from stickslip.reference import beam_pair, snecma_beam, snecma_structure


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


def test_levels_leave_static_loads():
    loaded = model(forces=[Force("tip", 2.0), Force("tip", 5.0, harmonic=0)])
    assert [one.amplitude for one in loaded.scaled(force=3.0).forces] == [6.0, 5.0]
    assert [one.amplitude for one in loaded.scaled(load=3.0).forces] == [2.0, 15.0]
    static = model(forces=[Force("tip", 5.0, harmonic=0)])
    assert static.scaled(force=2.0, load=3.0).forces[0].amplitude == 30.0


@pytest.mark.parametrize(
    ("factors", "message"),
    [
        ({"load": math.nan}, "factor on the static loads: nan"),
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

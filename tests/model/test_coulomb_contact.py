"""Coulomb contacts as they are written: frames, nodes, numbers, and what is refused."""

import json
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import stickslip as ss
from stickslip.model.dofs import Dofs
from stickslip.model.laws import contact_from_spec

NODES = [["1.x", "1.z"], ["2.x", "2.z"], ["3.x", "3.z"]]
VALUES = {"friction": 0.3, "tangential_stiffness": 2e7, "normal_stiffness": 3e7}
PAD = ["pad.x", "pad.y", "pad.z"]
DISK = ["disk.x", "disk.y", "disk.z"]


def pad(dofs=PAD, other=None, **changes):
    return ss.Coulomb(dofs, other, **({"normal": [0.0, 0.0, 1.0]} | VALUES | changes))


def constant(dofs, **changes):
    values = {"friction": 0.3, "tangential_stiffness": 2e7, "preload": 120.0}
    return ss.Coulomb(dofs, normal=None, **values | changes)


class TestFrame:
    @pytest.mark.parametrize(
        ("normal", "first"),
        [
            ([0, 0, 1], [1, 0, 0]),
            ([0, 2, 0], [1, 0, 0]),
            ([3, 0, 0], [0, 1, 0]),
            ([0, 0, -1], [1, 0, 0]),
            ([0, 1, 1], [1, 0, 0]),
        ],
    )
    def test_tangent_is_the_first_direction_in_the_plane(self, normal, first):
        np.testing.assert_allclose(pad(normal=normal).frame[0], first, atol=1e-15)

    @given(arrays(np.float64, 3, elements=st.floats(-1e150, 1e150, allow_subnormal=False)))
    def test_any_normal_has_a_right_handed_orthonormal_frame(self, normal):
        if not np.abs(normal).max() > 1e-150:
            return
        frame = pad(normal=normal.tolist()).frame
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(frame) == pytest.approx(1.0, abs=1e-14)
        size = np.linalg.norm(normal / np.abs(normal).max())
        np.testing.assert_allclose(frame[2], normal / np.abs(normal).max() / size, atol=1e-15)

    def test_planar(self):
        planar = pad(["pad.x", "pad.z"], normal=[0, 1])
        np.testing.assert_array_equal(planar.frame, np.eye(2))
        turned = pad(["pad.x", "pad.z"], normal=[3, 4]).frame
        np.testing.assert_allclose(turned, [[0.8, -0.6], [0.6, 0.8]], atol=1e-15)

    def test_constant_load_has_the_axes(self):
        np.testing.assert_array_equal(constant(PAD[:2]).frame, np.eye(2))
        np.testing.assert_array_equal(constant(PAD[:1]).frame, np.eye(1))

    def test_rows_are_differences_in_the_frame(self):
        dofs = Dofs([*PAD, *DISK])
        own = pad(other=DISK, normal=[1, 2, 2])
        np.testing.assert_allclose(own.rows(dofs), np.hstack([own.frame, -own.frame]))


class TestSums:
    """Displacements that are sums of degrees of freedom."""

    ARM = ss.Coulomb(
        [{"x": 1.0, "turn": -0.01}, {"y": 1.0, "turn": -0.02}],
        ["left.x", {"left.y": 0.5}],
        normal=[0.6, 0.8],
        **VALUES,
    )

    def test_rows_are_sums_in_the_frame(self):
        rows = self.ARM.rows(Dofs(["x", "y", "turn", "left.x", "left.y"]))
        sums = np.array([[1.0, 0.0, -0.01, -1.0, 0.0], [0.0, 1.0, -0.02, 0.0, -0.5]])
        np.testing.assert_allclose(rows, self.ARM.frame @ sums, atol=1e-15)

    def test_files_and_other_places_keep_factors(self):
        named = self.ARM.named("arm")
        again = contact_from_spec(json.loads(json.dumps(named.to_spec())))
        assert again == named == pickle.loads(pickle.dumps(named))
        moved = named.moved([f"3.{dof}" for dof in named.dofs], "3.arm")
        assert moved.nodes.names == [
            [{"3.x": 1.0, "3.turn": -0.01}, {"3.y": 1.0, "3.turn": -0.02}],
            ["3.left.x", {"3.left.y": 0.5}],
        ]
        spec = named.to_spec()
        spec["parameters"] = {**spec["parameters"], "terms": [2, 1, 1, 1]}
        with pytest.raises(ss.ModelError, match="6 factors and 6 dofs for sums of 5 terms"):
            contact_from_spec(spec)

    def test_a_face_of_several_nodes(self):
        face = pad([[{"x": 1.0}, {"y": 2.0}], ["z", "w"]], normal=[0, 1])
        assert (face.points, face.dofs) == (2, ("x", "y", "z", "w"))
        assert face.nodes.names == [[["x", {"y": 2.0}], ["z", "w"]]]

    @pytest.mark.parametrize(
        ("dofs", "message"),
        [
            ([{}, "y"], "dofs: a sum without dofs"),
            ([{"x": np.inf}, "y"], "dofs: x: inf is not a finite number"),
            ([{"": 1.0}, "y"], "is empty"),
        ],
    )
    def test_refused(self, dofs, message):
        with pytest.raises(ss.ModelError, match=message):
            pad(dofs, normal=[0, 1])


class TestNodes:
    def test_one_node_has_components_alone(self):
        one = pad()
        assert (one.points, one.components, one.shape) == (1, ("t1", "t2", "N"), (3,))
        assert pad([PAD]).shape == (1, 3)
        assert pad(["a", "b"], normal=[0, 1]).components == ("t", "N")
        assert constant(["a", "b"]).components == ("t1", "t2")
        assert constant(["a"]).components == ("t",)

    def test_numbers_for_all_or_for_each(self):
        many = pad(NODES, normal=[0, 1], preload=[1.0, 2.0, 3.0])
        assert (many.points, many.shape, many.friction) == (3, (3, 2), 0.3)
        assert many.preload == (1.0, 2.0, 3.0)
        assert many.adjustable()["preload"] == (1.0, 2.0, 3.0)
        assert many.adjustable()["friction"] == (0.3,)
        np.testing.assert_array_equal(many.balanced, [0, 1, 0, 2, 0, 3])
        assert many.limits == pytest.approx((0.3, 0.6, 0.9))

    def test_arrays_of_numpy(self):
        names, normals = np.array(NODES), np.array([[0, 1], [1, 0], [1, 1]])
        many = ss.Coulomb(names, normal=normals, **VALUES, gap=np.zeros(3))
        assert many.frame.shape == (3, 2, 2)
        np.testing.assert_allclose(many.frame[2, 1], np.sqrt([0.5, 0.5]))
        assert pad(NODES, normal=np.array([0, 1])).normal == (0.0, 1.0)

    def test_areas_spread_stiffness_and_pressure(self):
        many = pad(NODES, normal=[0, 1], preload=1e6, areas=[1e-6, 2e-6, 4e-6])
        assert many.preload == pytest.approx((1.0, 2.0, 4.0))
        assert many.tangential_stiffness == pytest.approx((20.0, 40.0, 80.0))
        assert many.normal_stiffness == pytest.approx((30.0, 60.0, 120.0))
        assert many.friction == 0.3

    def test_closure(self):
        assert pad().gap == 0.0
        assert pad(preload=5.0).gap is None
        assert pad(gap=-1e-5).limits == pytest.approx((90.0,))
        assert pad(gap=1e-5).limits == (0.0,)


@pytest.mark.parametrize(
    "contact",
    [
        pad(),
        pad(other=DISK, normal=[1, 2, 2], gap=-1e-5, name="disk"),
        pad(NODES, normal=[[0, 1], [1, 0], [1, 1]], preload=[1, 2, 3]),
        constant(["a"], preload=5),
        constant([["a", "b"], ["c", "d"]], friction=[0.1, 0.2]),
    ],
)
def test_contacts_survive_storage(contact):
    for copy in (
        contact_from_spec(json.loads(json.dumps(contact.to_spec()))),
        pickle.loads(pickle.dumps(contact)),
    ):
        assert copy == contact
        assert hash(copy) == hash(contact)
        np.testing.assert_array_equal(copy.frame, contact.frame)
        assert copy.shape == contact.shape


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: pad("pad.x"), "dofs: 'pad.x' is not a list"),
        (lambda: pad(None), "dofs: None is not a list"),
        (lambda: pad([]), "dofs: 0 names"),
        (
            lambda: pad([["a", "b"], ["c"]], normal=[0, 1]),
            "dofs: 1, 2 names per node",
        ),
        (lambda: pad(["a", "b", "c", "d"]), "dofs: 4 names per node"),
        (lambda: pad(["a", "b", 3]), "dofs: 3 is not text"),
        (lambda: pad(other=["a", "b"]), "other: names of shape 2 for dofs of 3; give as many"),
        (lambda: pad(other=[DISK]), "other: names of shape 1 x 3 for dofs of 3"),
        (lambda: pad(other=["a", "b", "pad.x"]), "dof 'pad.x' twice at one node"),
        (lambda: pad(["a", "b", "a"]), "dof 'a' twice at one node"),
        (lambda: pad(normal=[0, 1]), "give 3 numbers, as many as a node has dofs"),
        (lambda: pad(normal=[0, 0, 0]), "has no direction; give a finite vector that is not zero"),
        (lambda: pad(normal=[0, np.nan, 1]), "has no direction"),
        (lambda: pad(normal=[0, np.inf, 1]), "has no direction"),
        (lambda: pad(normal="z"), "normal: 'z'; give 3 numbers"),
        (lambda: pad(normal=[[0, 1], [1]]), "give 3 numbers"),
        (lambda: pad(normal=[[0, 0, 1]]), "give 3 numbers, as many as a node has dofs, or leave"),
        (lambda: pad([PAD], normal=[[0, 0, 1]] * 2), "or one such list per node"),
        (lambda: pad(["a"], normal=[1]), "normal: [1]; give 2 numbers"),
        (lambda: pad(normal=None, normal_stiffness=None, preload=1.0), "a constant load, with 3"),
        (lambda: pad(preload=1.0, gap=0.0), "preload 1.0 and gap 0.0; give one of the two"),
        (lambda: constant(["a"], preload=None), "preload is missing; give the constant normal"),
        (lambda: constant(["a"], gap=0.0, preload=None), "preload is missing"),
        (lambda: constant(["a"], normal_stiffness=1.0), "give both, or neither"),
        (lambda: pad(normal_stiffness=None), "normal: [0.0, 0.0, 1.0] without normal_stiffness"),
        (lambda: pad(friction=-0.1), "friction -0.1 is negative"),
        (lambda: pad(friction=np.inf), "friction: inf is not a finite number"),
        (lambda: pad(friction="0.3"), "friction: '0.3' is not a number"),
        (lambda: pad(friction=[0.1, 0.2]), "2 numbers for one node; give one number"),
        (lambda: pad([PAD], preload=[1, 2]), "preload: 2 numbers for 1 nodes; give one number, or"),
        (lambda: pad([PAD], preload=[-1]), "preload[0] -1 is negative"),
        (lambda: pad(areas=[1.0]), "areas [1.0] of one node"),
        (lambda: pad([PAD], areas=[1.0, 2.0]), "areas: 2 numbers for 1 nodes"),
        (lambda: pad(tangential_stiffness=None), "tangential_stiffness: None is not a number"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(ss.ModelError) as refusal:
        make()
    assert message in str(refusal.value)
    assert str(refusal.value).startswith("coulomb contact")


anything = st.recursive(
    st.none() | st.floats() | st.integers(-3, 3) | st.text(max_size=3) | st.booleans(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=2), inner),
    max_leaves=8,
)


@given(
    key=st.sampled_from(["dofs", "other", "normal", "preload", "gap", "areas", *VALUES]),
    value=anything,
)
@pytest.mark.slow
def test_anything_is_taken_or_refused(key, value):
    try:
        contact = pad(**{key: value})
    except ss.ModelError:
        return
    assert contact_from_spec(contact.to_spec()) == contact


def test_unknown_dofs_are_named():
    structure = ss.Structure(np.eye(3), np.eye(3), dofs=PAD)
    with pytest.raises(ss.ModelError, match=r"contact 1 \('coulomb'\): unknown dof 'pad.w'"):
        ss.Model(structure, [pad(["pad.x", "pad.y", "pad.w"])])


def test_natural_frequencies_slip_in_all_tangential_directions():
    structure = ss.Structure(np.eye(3), np.diag([1.0, 2.0, 3.0]), dofs=PAD)
    values = {"tangential_stiffness": 10.0, "normal_stiffness": 5.0}
    many = pad([PAD], preload=1.0, **values)
    model = ss.Model(structure, [pad(name="other", **values), many])
    stuck = ss.natural_frequencies(model)
    np.testing.assert_allclose(stuck**2, [13.0, 21.0, 22.0])
    both = ss.natural_frequencies(model, ["other", ("coulomb", 0)])
    np.testing.assert_allclose(both**2, [1.0, 2.0, 13.0])

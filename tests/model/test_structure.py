"""Structures: what they keep, what they refuse, and how they damp and join."""

import pickle

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.errors import ModelError
from stickslip.model.coupling import Coupling
from stickslip.model.damping import ModalDamping, Rayleigh
from stickslip.model.structure import Structure, join

M = np.diag([2.0, 1.0, 4.0])
K = np.array([[3.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 5.0]])
SQUARE = np.ones((3, 3))
SKEW = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 0]])


def spd(seed: int, size: int) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(size, size))
    return root @ root.T + size * np.eye(size)


few = settings(max_examples=40)
structures = st.builds(
    lambda seed, size: Structure(spd(seed, size), spd(seed + 1, size), spd(seed + 2, size)),
    st.integers(0, 2**31),
    st.integers(1, 6),
)


def test_keeps_matrices_and_names():
    structure = Structure(M.tolist(), K, Rayleigh(mass=0.5, stiffness=0.25), ["a", "b", "c"])
    assert structure.mass.dtype == structure.stiffness.dtype == np.float64
    np.testing.assert_array_equal(structure.mass, M)
    np.testing.assert_array_equal(structure.stiffness, K)
    np.testing.assert_array_equal(structure.damping, 0.5 * M + 0.25 * K)
    assert structure.dofs == ("a", "b", "c")
    assert [structure.index(name) for name in "abc"] == [0, 1, 2]
    assert len(structure) == 3


def test_defaults_to_numbered_undamped_dofs():
    structure = Structure(M, K)
    assert structure.dofs == ("0", "1", "2")
    assert not structure.damping.any()


def test_accepts_integers():
    assert Structure([[2]], [[8]]).stiffness.dtype == np.float64


@pytest.mark.parametrize("sparse", [scipy.sparse.csr_array, scipy.sparse.coo_matrix])
def test_accepts_sparse(sparse):
    structure = Structure(sparse(M), sparse(K), sparse(0.1 * K))
    np.testing.assert_array_equal(structure.damping, 0.1 * K)


def test_is_immutable_and_independent_of_its_input():
    mass = M.copy()
    structure = Structure(mass, K, K)
    mass[0, 0] = 99.0
    assert structure.mass[0, 0] == 2.0
    for matrix in (structure.mass, structure.damping, structure.stiffness):
        with pytest.raises(ValueError, match="read-only"):
            matrix[0, 0] = 1.0
    with pytest.raises(AttributeError):
        structure.mass = mass


def test_pickled_structure_is_the_same_and_immutable():
    copy = pickle.loads(pickle.dumps(Structure(M, K, K, ["x", "y", "z"])))
    np.testing.assert_array_equal(copy.damping, K)
    assert copy.dofs == ("x", "y", "z")
    assert not copy.mass.flags.writeable


def test_repr_is_short():
    assert repr(Structure([[1.0]], [[1.0]], dofs=["tip"])) == "Structure(1 dof: tip)"
    many = Structure(np.eye(300), np.eye(300))
    assert repr(many) == "Structure(300 dofs: 0, 1, 2, 3, 4, 5, ...)"


def test_averages_printed_digits():
    stiffness = K * 1e7
    stiffness[0, 1] += 0.1
    kept = Structure(M, stiffness).stiffness
    np.testing.assert_array_equal(kept, kept.T)
    assert kept[0, 1] == pytest.approx(-1e7 + 0.05, rel=1e-15)


def test_damping_may_be_unsymmetric():
    gyroscopic = np.array([[1.0, 5.0, 0.0], [-5.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_array_equal(Structure(M, K, gyroscopic).damping, gyroscopic)


def test_singular_stiffness_is_a_free_structure():
    free = Structure(np.eye(2), [[1.0, -1.0], [-1.0, 1.0]], ModalDamping(0.1))
    np.testing.assert_allclose(free.damping @ [1.0, 1.0], 0.0, atol=1e-15)


def test_mass_of_mixed_units_is_positive():
    Structure(np.diag([1.0, 1e-22]), np.diag([1.0, 1e-20]))


def test_a_dof_without_mass():
    """It follows statically; ratios are those of the modes of the others."""
    mass = np.diag([1.0, 0.0, 2.0])
    stiffness = np.array([[5.0, -2.0, 0.0], [-2.0, 4.0, -2.0], [0.0, -2.0, 7.0]])
    whole = Structure(mass, stiffness, ModalDamping(0.1), ["a", "b", "c"])
    assert whole.mass[1, 1] == 0.0
    kept = np.ix_([0, 2], [0, 2])
    condensed = stiffness[kept] - np.outer([-2.0, -2.0], [-2.0, -2.0]) / 4.0
    own = Structure(mass[kept], condensed, ModalDamping(0.1))
    np.testing.assert_allclose(whole.damping[kept], own.damping, rtol=1e-12)
    assert not whole.damping[1].any()
    with pytest.raises(ModelError, match="damping: it acts on dof 'b', which has no mass"):
        Structure(mass, stiffness, Rayleigh(stiffness=1e-3), ["a", "b", "c"])
    frequencies = [
        ss.natural_frequencies(ss.Model(one, [], [ss.Force(one.dofs[0], 1.0)]))
        for one in (whole, own)
    ]
    # A small mass stands in where none is.
    np.testing.assert_allclose(frequencies[0][:2], frequencies[1], rtol=1e-6)


def test_a_model_without_any_mass():
    nothing = Structure(np.zeros((2, 2)), np.eye(2))
    with pytest.raises(ModelError, match="mass: not positive definite"):
        ss.forced_response(ss.Model(nothing, [], [ss.Force("0", 1.0)]), [1.0], 1)


BAD_MASS = [
    ([[1, 1, 0], [1, 0, 0], [0, 0, 1]], r"mostly dof 'b'\).*condense massless"),
    (np.diag([1.0, 1.0, -2.0]), r"smallest eigenvalue -2 \(mostly dof 'c'\)"),
    ([[1, 2, 0], [2, 1, 0], [0, 0, 1]], "smallest eigenvalue -1 "),
    (SQUARE, "must be positive definite"),
    ([[1, 1, 0], [1, 1 + 1e-15, 0], [0, 0, 1]], "must be positive definite"),
    (np.diag([1.0, np.nan, 1.0]), r"mass: nan at \('b', 'b'\); every entry must be finite"),
    (np.diag([1.0, 1.0, np.inf]), r"mass: inf at \('c', 'c'\)"),
    (M + 0j, "mass: complex entries; give real matrices"),
    (np.tril(SQUARE) + 2 * M, r"mass: 0 at \('a', 'b'\) but 1 at .*one triangle is filled: mirror"),
    (M + SKEW, "skew terms belong to damping"),
    (M[:2], "mass: 2 x 3 is not square; give N x N"),
    ([2.0, 1.0, 4.0], r"mass: 1 dimension\(s\), shape \(3,\).*np.diag"),
    (944.6, r"mass: 0 dimension\(s\)"),
    ([[1.0, 0.0], [1.0]], "mass: rows of unequal length"),
    ([["1", "0", "0"]] * 3, "mass: entries of type <U1 are not real numbers"),
    ([["1 kg", "0", "0"]] * 3, "numbers alone, in SI units, or in those that units= names: units="),
    ([[None] * 3] * 3, "mass: entries of type object are not real numbers"),
    (np.eye(3, dtype=bool), "mass: entries of type bool"),
    (np.zeros((0, 0)), "mass: 0 x 0; a structure needs at least one dof"),
    (scipy.sparse.eye_array(5001).tocsr(), "mass: 5001 rows are too many.*reduce the model first"),
]


@pytest.mark.parametrize(("mass", "message"), BAD_MASS)
def test_refuses_mass(mass, message):
    with pytest.raises(ModelError, match=message) as refusal:
        Structure(mass, K, dofs=["a", "b", "c"])
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("stiffness", "message"),
    [
        (K[:2, :2], "stiffness: 2 x 2, but the mass matrix is 3 x 3"),
        (K[:2], "stiffness: 2 x 3 is not square"),
        (K * np.nan, r"stiffness: nan at \('0', '0'\)"),
        (K * 1j, "stiffness: complex entries.*structural damping"),
        (K + 1e-6 * np.triu(K, 1), r"stiffness: -1.000001 at \('0', '1'\) but -1 at \('1', '0'\)"),
        (None, "stiffness: entries of type object"),
    ],
)
def test_refuses_stiffness(stiffness, message):
    with pytest.raises(ModelError, match=message):
        Structure(M, stiffness)


@pytest.mark.parametrize(
    ("damping", "message"),
    [
        (np.eye(2), "damping: 2 x 2, but the mass matrix is 3 x 3"),
        (np.full((3, 3), np.nan), "damping: nan at"),
        (1j * M, "damping: complex entries"),
        (0.001, r"damping: 0.001 is not a matrix; write ModalDamping\(0.001\)"),
        ("1%", r"damping: '1%' is not a matrix; write ModalDamping\('1%'\)"),
        (Rayleigh, "damping: entries of type object"),
        (ModalDamping([0.1, 0.1]), "damping: 2 ratios for 3 modes; give one per mode"),
        (ModalDamping([0.1] * 4), "damping: 4 ratios for 3 modes"),
        (ModalDamping([]), "damping: 0 ratios for 3 modes"),
    ],
)
def test_refuses_damping(damping, message):
    with pytest.raises(ModelError, match=message):
        Structure(M, K, damping)


@pytest.mark.parametrize(
    "law", [Rayleigh(mass=1e308), Rayleigh(stiffness=-1e308), ModalDamping(1e308)]
)
def test_refuses_laws_whose_matrix_is_not_finite(law):
    with pytest.raises(ModelError, match=r"damping: (Rayleigh|Modal).* makes entries beyond 1e308"):
        Structure(M, K, law)


def test_the_largest_entries_are_kept_without_a_warning():
    assert Structure([[1.0]], [[1.7e308]]).stiffness[0, 0] == 1.7e308
    with pytest.raises(ModelError, match=r"stiffness: 1e\+308 at"):
        Structure(np.eye(2), [[0, 1e308], [-1e308, 0]])


@pytest.mark.parametrize(
    ("law", "arguments", "message"),
    [
        (Rayleigh, {"mass": np.nan}, "Rayleigh mass factor: nan is not a finite number"),
        (Rayleigh, {"stiffness": "2.6e-5"}, "Rayleigh stiffness factor: '2.6e-5' is not a number"),
        (Rayleigh, {"mass": 10**400}, "1000.* is too large; give a number below 1e308"),
        (Rayleigh, {"mass": True}, "True is not a number"),
        (ModalDamping, {"ratio": np.inf}, "damping ratio: inf is not a finite number"),
        (ModalDamping, {"ratio": 0.1j}, "is complex; give a real number"),
        (ModalDamping, {"ratio": "0.1"}, "'0.1' is not a number"),
        (ModalDamping, {"ratio": [0.1, np.nan]}, "damping ratio at position 1: nan"),
        (ModalDamping, {"ratio": None}, "None is not a number"),
    ],
)
def test_damping_laws_refuse(law, arguments, message):
    with pytest.raises(ModelError, match=message):
        law(**arguments)


def test_modal_damping_means_nothing_for_negative_stiffness():
    with pytest.raises(ModelError, match=r"the lowest mode has omega\^2 = -1 < 0"):
        Structure(np.eye(2), np.diag([4.0, -1.0]), ModalDamping(0.01))


@pytest.mark.parametrize(
    ("dofs", "message"),
    [
        (["a", "b", "a"], "dofs: 'a' is given more than once"),
        (["a", "b"], "dofs: 2 names for 3 dofs; give one name per matrix row"),
        (["a", "", "c"], "dofs: name 2: '' is empty"),
        (["a", "b", "  "], "dofs: name 3: '  ' is empty"),
        (["a", "b\0", "c"], r"dofs: name 2: 'b.x00' has a control character"),
        (["a", "b", "c\nd"], r"dofs: name 3: 'c.nd' has a control character"),
        (["\ud800", "b", "c"], r"dofs: name 1: '.ud800' has a control character"),
        ([0, 1, 2], "dofs: name 1: 0 is not text; give a name in quotes"),
        ("abc", "dofs: 'abc' is not a list; write dofs="),
        (np.array("a"), r"dofs: array\('a'.* is not a list"),
        (3, "dofs: 3 is not a list; write dofs="),
    ],
)
def test_refuses_names(dofs, message):
    with pytest.raises(ModelError, match=message):
        Structure(M, K, dofs=dofs)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("tpi", r"^unknown dof 'tpi'; did you mean 'tip'\?$"),
        ("zzz", "unknown dof 'zzz'; known: 'damper', 'tip', 'mode'"),
        (0, "unknown dof 0; known: 'damper', 'tip', 'mode'"),
    ],
)
def test_unknown_dof_gives_the_nearest(name, message):
    structure = Structure(M, K, dofs=["damper", "tip", "mode"])
    with pytest.raises(ModelError, match=message):
        structure.index(name)


def test_long_lists_of_names_are_cut():
    with pytest.raises(ModelError, match=r"'22', '23', ... \(50 in all\)$"):
        Structure(np.eye(50), np.eye(50)).index("nowhere")


@few
@given(st.integers(0, 2**31), st.integers(1, 6), st.floats(0.0, 0.5))
def test_modal_damping_gives_every_mode_its_ratio(seed, size, ratio):
    ratios = [ratio * (mode + 1) for mode in range(size)]
    structure = Structure(spd(seed, size), spd(seed + 1, size), ModalDamping(ratios))
    squares, modes = scipy.linalg.eigh(structure.stiffness, structure.mass)
    expected = np.diag(2.0 * np.array(ratios) * np.sqrt(squares))
    np.testing.assert_allclose(modes.T @ structure.damping @ modes, expected, atol=1e-12)


def test_modal_damping_takes_one_ratio_or_an_array():
    one, many = ModalDamping(0.01), ModalDamping(np.full(3, 0.01))
    assert many.ratio == (0.01, 0.01, 0.01)
    np.testing.assert_array_equal(Structure(M, K, one).damping, Structure(M, K, many).damping)


@few
@given(structures, structures)
def test_join_is_block_diagonal(left, right):
    pair = join({"left": left, "right": right})
    blocks = scipy.linalg.block_diag
    np.testing.assert_array_equal(pair.mass, blocks(left.mass, right.mass))
    np.testing.assert_array_equal(pair.damping, blocks(left.damping, right.damping))
    np.testing.assert_array_equal(pair.stiffness, blocks(left.stiffness, right.stiffness))
    assert pair.index("right.0") == len(left)


@few
@given(structures)
def test_structure_of_a_structure_is_the_same(structure):
    again = Structure(structure.mass, structure.stiffness, structure.damping, structure.dofs)
    np.testing.assert_array_equal(again.mass, structure.mass)
    np.testing.assert_array_equal(again.stiffness, structure.stiffness)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({}, "join: no parts"),
        ([Structure(M, K)], r'names no parts; write join\(\{"1": a, "2": b\}\)'),
        ({"1": M}, "join: part '1' is .*give a Structure"),
        ({1: Structure(M, K)}, "join: name of a part: 1 is not text"),
        ({"": Structure(M, K)}, "join: name of a part: '' is empty"),
    ],
)
def test_join_refuses(parts, message):
    with pytest.raises(ModelError, match=message):
        join(parts)


def test_joined_parts_with_a_spring_are_those_of_edited_matrices():
    parts = {"a": Structure(spd(1, 3), spd(2, 3), spd(3, 3)), "b": Structure(spd(4, 2), spd(5, 2))}
    springs = [
        Coupling("a.1", "b.0", stiffness=7.0, damping=0.5),
        Coupling("b.1", "b.0", stiffness=2),
    ]
    pair, bare = join(parts, springs), join(parts)
    stiffness, damping = bare.stiffness.copy(), bare.damping.copy()
    for matrix, one, two, factor in (
        (stiffness, 1, 3, 7.0),
        (stiffness, 4, 3, 2.0),
        (damping, 1, 3, 0.5),
    ):
        matrix[np.ix_([one, two], [one, two])] += factor * np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_array_equal(pair.mass, bare.mass)
    np.testing.assert_array_equal(pair.stiffness, stiffness)
    np.testing.assert_array_equal(pair.damping, damping)
    assert pair.dofs == bare.dofs


def test_equal_parts_on_a_spring_move_alike_or_in_opposition():
    part = Structure(M, K, Rayleigh(mass=0.3, stiffness=0.1), ["x", "y", "z"])
    pair = join({"1": part, "2": part}, [Coupling("1.y", "2.y", stiffness=0.7)])
    held = K + 2.0 * np.diag([0.0, 0.7, 0.0])
    expected = np.sort(np.concatenate([scipy.linalg.eigvalsh(one, M) for one in (K, held)]))
    np.testing.assert_allclose(scipy.linalg.eigvalsh(pair.stiffness, pair.mass), expected)
    # The spring has no part in the damping law, so that the modes in opposition are coupled.
    assert join({"1": part, "2": part}).proportional
    assert not pair.proportional


@pytest.mark.parametrize(
    ("couplings", "message"),
    [
        ([Coupling("a.0", stiffness=1.0)], "coupling 1: both ends at dof 'a.0'; name the other"),
        ([Coupling("a.0", "a.0", stiffness=1.0)], "coupling 1: both ends at dof 'a.0'"),
        (
            [Coupling("a.0", "a.1", stiffness=1.0), Coupling("a.0", "b.1", stiffness=1.0)],
            "coupling 2: unknown dof 'b.1'",
        ),
        ([(0, 1)], r"coupling 1: \(0, 1\) is no coupling; give a Coupling"),
        (3, "couplings"),
    ],
)
def test_join_refuses_couplings(couplings, message):
    with pytest.raises(ModelError, match=message):
        join({"a": Structure(M, K)}, couplings)


def test_join_refuses_names_that_collide():
    inner = Structure([[1.0]], [[1.0]], dofs=["b.c"])
    outer = Structure([[1.0]], [[1.0]], dofs=["c"])
    with pytest.raises(ModelError, match=r"'a\.b\.c' is given more than once"):
        join({"a": inner, "a.b": outer})

"""Calls of a user's own law: what it has answered is not asked again, and never kept too long."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.model import contact_answer


class Dahl(ss.ContactLaw):
    """Dahl's law, which nears its limit exponentially."""

    odd = True

    def __init__(self, *ends, k, limit):
        super().__init__(*ends)
        self.k, self.limit = k, limit
        self.asked = []

    def stiffness(self):
        return [[self.k]]

    def step(self, before, after, state):
        self.asked.append(np.concatenate((before, after, state)).tobytes())
        change = after - before
        ahead = np.where(change < 0.0, -self.limit, self.limit)
        fade = np.exp(-self.k * np.abs(change) / self.limit)
        force = ahead - (ahead - state) * fade
        slope = (self.k * (1.0 - force / ahead))[..., None]
        return force, force, ss.Tangents(fade[..., None], -slope, slope, [[1.0]], [[0.0]])


def made(limit=1.0):
    structure = ss.Structure(
        np.diag([1.0, 0.5]), [[3e4, -1e4], [-1e4, 2.5e4]], ss.ModalDamping(0.01), ["x", "y"]
    )
    law = Dahl(["x"], k=4e3, limit=limit)
    return law, ss.Model(structure, [law], [ss.Force("y", 2.0)])


def balance(model):
    return ss.forced_response(model, [150.0], 1, evaluation="marched", samples=256, stability=False)


def test_a_step_that_was_answered_is_not_taken_again():
    law, model = made()
    balance(model)
    # Differences of the first tangents ask for some steps twice.
    assert len(law.asked) < 1.02 * len(set(law.asked)) + 100


@pytest.mark.slow
def test_numbers_set_anew_between_analyses_are_heeded():
    model = made()[1]
    (law,) = model.contacts
    first = balance(model)
    forces = first.contact_force(0, 0)
    law.limit = 0.5
    again = balance(model)
    other = balance(made(limit=0.5)[1])
    np.testing.assert_array_equal(again.amplitude("x"), other.amplitude("x"))
    assert again.amplitude("x") != first.amplitude("x")
    law.limit = 1.0
    np.testing.assert_array_equal(first.contact_force(0, 0), forces)


@pytest.mark.slow
def test_answers_do_not_fill_the_memory(monkeypatch):
    monkeypatch.setattr(contact_answer, "_KEPT", 700)
    kept = []

    class Watched(Dahl):
        def step(self, before, after, state):
            if self._answers is not None:
                both = self._answers._young, self._answers._old
                kept.append(sum(one.size for part in both for a in part.values() for one in a))
            return super().step(before, after, state)

    watched = Watched(["x"], k=4e3, limit=1.0)
    model = made()[1].replaced(contacts=[watched])
    balance(model)
    assert 700 < max(kept) <= 1400
    assert model.contacts[0]._answers is None


@pytest.mark.parametrize(
    ("force", "shape"),
    [(np.zeros((2, 1)), "of shape"), ([[[0.0]]], "give shape"), ("a", "give shape")],
)
def test_forces_of_another_shape_are_refused(force, shape):
    law, model = made()
    answer = type(law).step

    class Wrong(Dahl):
        def step(self, before, after, state):
            return force, *answer(self, before, after, state)[1:]

    wrong = Wrong(["x"], k=4e3, limit=1.0)
    with pytest.raises(ss.ModelError, match=rf"force .*{shape}"):
        balance(model.replaced(contacts=[wrong]))


@pytest.mark.slow
def test_limit_cycles_refuse_a_law_whose_onset_is_unknown_with_a_remedy_that_works():
    model, negative = made()[1], ss.Rayleigh(mass=-8.0)
    with pytest.raises(ss.ModelError, match=r"nonlinear_modes\(model, \.\.\.\)\.limit_cycles\("):
        ss.limit_cycles(model, negative, ratio=[0.6])
    mode = ss.nonlinear_modes(model, amplitude=[1e-5, 1e-2, 3e-2], method="quasi-static")
    assert np.isfinite(mode.limit_cycles(negative, ratio=[0.6]).amplitude("x")).all()


def test_laws_without_events_are_sent_to_steps_in_time():
    with pytest.raises(ss.ModelError, match=r'has no events .* scheme = "rk4"'):
        ss.transient(made()[1], omega=150.0, periods=1)
    assert ss.transient(made()[1], omega=150.0, periods=1, scheme="rk4").periods == 1


@pytest.mark.slow
def test_an_analysis_that_ends_beside_another_takes_nothing_from_it():
    law = Dahl(["x"], k=4e3, limit=1.0)

    class Forgetful(Dahl):
        def step(self, before, after, state):
            self.forget()
            return super().step(before, after, state)

    model = made()[1]
    other = balance(model.replaced(contacts=[Forgetful(["x"], k=4e3, limit=1.0)]))
    expected = balance(model.replaced(contacts=[law]))
    np.testing.assert_array_equal(other.amplitude("x"), expected.amplitude("x"))


@pytest.mark.parametrize("wrong", [1.0, 1.01])
def test_rounding_within_a_step_whose_state_passes_zero_is_no_wrong_tangent(wrong):
    class Passing(Dahl):
        def step(self, before, after, state):
            force, new, tangents = super().step(before, after, state)
            return force, new, ss.Tangents(wrong * tangents.state_by_state, *tangents[1:])

    law = Passing(["x"], k=4e3, limit=1.0)
    # The limit, in the step, is ten decades above the state.
    at = {"before": [[1e-6]], "after": [[1e-6 + 1e-11]], "state": [[1e-10]]}
    at = {name: np.array(value) for name, value in at.items()}
    answer = law._answer(**at)
    if wrong == 1.0:
        contact_answer.compare(law._answer, at, answer, np.array([[4e3]]), "law")
    else:
        with pytest.raises(ss.ModelError, match=r"force\[0\] by state\[0\]"):
            contact_answer.compare(law._answer, at, answer, np.array([[4e3]]), "law")

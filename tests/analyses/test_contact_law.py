"""A user's own law in Python, against the compiled ones that say the same."""

import signal
import subprocess
import sys
import time
import traceback

import numpy as np
import pytest

import stickslip as ss


class Slider(ss.ContactLaw):
    """The Jenkins element of n nodes."""

    odd = monotone = True

    def __init__(self, *ends, k, limit, **options):
        super().__init__(*ends, **options)
        self.k, self.limit = k, limit

    def stiffness(self):
        return [[self.k]]

    def step(self, before, after, state):
        trial = state + self.k * (after - before)
        force = np.clip(trial, -self.limit, self.limit)
        sticks = (np.abs(trial) <= self.limit)[..., None].astype(float)
        slope = self.k * sticks
        return force, force, ss.Tangents(sticks, -slope, slope, [[1.0]], [[0.0]])


class Plane(Slider):
    """Constant load in two directions, by radial return: the slip is that of one straight step."""

    directions = state_size = 2
    factor = 1.0

    def stiffness(self):
        return self.k * np.eye(2)

    def step(self, before, after, state):
        trial = state + self.k * (after - before)
        size = np.linalg.norm(trial, axis=1)[:, None]
        slips = (size > self.limit)[..., None]
        unit = trial / np.where(size > 0.0, size, 1.0)
        force = np.where(size > self.limit, self.limit * unit, trial)
        across = np.eye(2) - unit[:, :, None] * unit[:, None, :]
        turned = self.limit / np.where(size > 0.0, size, 1.0)[..., None] * across
        slope = np.where(slips, self.factor * turned, np.eye(2))
        tangents = slope, -self.k * slope, self.k * slope, np.eye(2), np.zeros((2, 2))
        return force, force, ss.Tangents(*tangents)


def structure():
    stiffness = [[2e4, -1e4, 0], [-1e4, 3e4, -1e4], [0, -1e4, 2e4]]
    return ss.Structure(np.eye(3), stiffness, ss.Rayleigh(mass=3.0), ["a", "b", "c"])


def model(*contacts):
    return ss.Model(structure(), contacts, [ss.Force("a", 30.0), ss.Force("c", 10.0, phase=1.0)])


OMEGA = [110.0, 160.0, 200.0]
STEPS = 64, 128, 256
MARCHED = {"evaluation": "marched", "samples": 256}


def respond(*contacts, omega=OMEGA, harmonics=5, **options):
    return ss.forced_response(model(*contacts), omega, harmonics, **{**MARCHED, **options})


@pytest.mark.slow
def test_a_jenkins_element_written_in_python():
    own = respond(Slider(["a"], ["b"], k=8e3, limit=10.0))
    element = respond(ss.Jenkins("a", "b", stiffness=8e3, slip_force=10.0))
    assert own.converged.all()
    assert own.half_wave
    assert {one.code for one in own.diagnostics} == {one.code for one in element.diagnostics}
    np.testing.assert_allclose(own.coefficients("a"), element.coefficients("a"), atol=1e-12)
    np.testing.assert_allclose(own.dissipation(0), element.dissipation(0), rtol=1e-9)
    np.testing.assert_allclose(
        own.contact_force("slider", 1, 64), element.contact_force(0, 1, 64), atol=1e-8
    )
    assert own.slip_fraction("slider") == pytest.approx(element.slip_fraction(0), abs=0.02)


@pytest.mark.slow
def test_nodes_are_stepped_at_once():
    own = respond(Slider([["a"], ["c"]], k=8e3, limit=10.0, name="two"))
    pair = respond(*(ss.Jenkins(dof, stiffness=8e3, slip_force=10.0) for dof in "ac"))
    np.testing.assert_allclose(own.coefficients("b"), pair.coefficients("b"), atol=1e-12)
    assert own.contact_force("two", 0).shape == (512, 2)
    np.testing.assert_allclose(
        own.contact_force(("two", 1), 0), pair.contact_force(1, 0)[:, 0], atol=1e-8
    )


@pytest.mark.slow
def test_two_directions_are_those_of_the_compiled_contact():
    """Radial return turns by another angle in a step, less so in short ones."""
    own, exact = (
        [
            respond(contact, omega=[160.0], harmonics=3, samples=samples)
            for samples in (64, 128, 256)
        ]
        for contact in (
            Plane(["a", "b"], k=8e3, limit=10.0),
            ss.Coulomb(
                ["a", "b"], normal=None, friction=0.5, tangential_stiffness=8e3, preload=20.0
            ),
        )
    )
    errors = [
        np.abs(one.coefficients("c") - other.coefficients("c")).max()
        for one, other in zip(own, exact, strict=True)
    ]
    assert own[0].contact_force("plane", 0).shape == (512, 2)
    assert own[0].slip_fraction("plane").max() > 0.3
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.4 * errors[0]
    assert errors[2] < 1e-2 * np.abs(exact[2].coefficients("c")).max()


@pytest.mark.slow
def test_a_sector_of_a_disk():
    def disk(*contacts):
        forces = [ss.Force("a", 30.0)]
        ring = [ss.Coupling("b", stiffness=2e3)]
        return ss.BladedDisk(structure(), 6, ring, contacts, forces, engine_order=2)

    own = disk(Slider(["a"], ["next.a"], k=8e3, limit=5.0))
    element = disk(ss.Jenkins("a", "next.a", stiffness=8e3, slip_force=5.0))
    waves = [ss.forced_response(one, OMEGA, 5, **MARCHED) for one in (own, element)]
    assert waves[0].slip_fraction(0).max() > 0.1
    np.testing.assert_allclose(*(one.coefficients("a") for one in waves), atol=1e-12)
    sectors = [
        ss.forced_response(one.mistuned(0.02 * np.arange(6)), [110.0], 3, **MARCHED)
        for one in (own, element)
    ]
    np.testing.assert_allclose(*(one.coefficients("3.a") for one in sectors), atol=1e-12)


class Dahl(Slider):
    """Friction that yields gradually: f' = k u' (1 - sgn(u') f / F)."""

    monotone = False

    def step(self, before, after, state):
        du = after - before
        ahead = np.where(du < 0.0, -self.limit, self.limit)
        fade = np.exp(-self.k * np.abs(du) / self.limit)
        force = ahead - (ahead - state) * fade
        slope = (self.k * (1.0 - force / ahead))[..., None]
        return force, force, ss.Tangents(fade[..., None], -slope, slope, [[1.0]], [[0.0]])


@pytest.mark.slow
def test_dahls_law_against_time_integration():
    """x'' + 2 zeta omega_s x' + K x + f = P cos(omega t), f by its own differential equation."""
    from scipy.integrate import solve_ivp

    k, limit, stiffness, load, omega, damping = 1e4, 5.0, 4e4, 10.0, 205.0, 6.0
    oscillator = ss.Structure([[1.0]], [[stiffness]], [[damping]], ["tip"])
    model = ss.Model(oscillator, [Dahl(["tip"], k=k, limit=limit)], [ss.Force("tip", load)])
    result = ss.forced_response(model, [omega], 9, evaluation="marched", samples=512)

    def rate(time, y):
        x, v, f = y
        slope = k * (1.0 - np.sign(v) * f / limit)
        return [v, load * np.cos(omega * time) - damping * v - stiffness * x - f, slope * v]

    period = 2.0 * np.pi / omega
    start = [0.0, 0.0, 0.0]
    for _ in range(4):
        span = (0.0, 40.0 * period)
        start = solve_ivp(rate, span, start, rtol=1e-8, atol=1e-12).y[:, -1]
    times = np.linspace(0.0, period, 401)
    motion = solve_ivp(rate, (0.0, period), start, rtol=1e-9, atol=1e-13, t_eval=times).y
    half_range = 0.5 * np.ptp(motion[0])
    assert result.amplitude("tip")[0] == pytest.approx(half_range, rel=1e-4)
    lost = np.trapezoid(motion[2] * motion[1], times)
    assert result.dissipation(0)[0, 0] == pytest.approx(lost, rel=1e-3)


@pytest.mark.slow
def test_ctrl_c_ends_a_law_in_python(tmp_path):
    """Minutes before its end, and what was solved is kept."""
    script = tmp_path / "slow.py"
    script.write_text(SLOW)
    run = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True)
    assert run.stdout.readline() == "started\n"
    time.sleep(1.0)
    run.send_signal(signal.SIGINT)
    said, _ = run.communicate(timeout=50)
    assert said.startswith(("Interrupted", "KeyboardInterrupt"))


SLOW = """
import numpy as np
import stickslip as ss

class Slow(ss.ContactLaw):
    def stiffness(self):
        return [[1e4]]

    def step(self, before, after, state):
        sum(range(20000))
        force = np.clip(state + 1e4 * (after - before), -1.0, 1.0)
        slope = 1.0 * (np.abs(force) < 1.0)[..., None]
        return force, force, ss.Tangents(slope, -1e4 * slope, 1e4 * slope, [[1.0]], [[0.0]])

structure = ss.Structure([[1.0]], [[4e4]], ss.ModalDamping(0.01), ["tip"])
model = ss.Model(structure, [Slow(["tip"])], [ss.Force("tip", 10.0)])
_ = model.problem
print("started", flush=True)
try:
    ss.forced_response(model, np.linspace(150.0, 250.0, 200), 5)
except (ss.Interrupted, KeyboardInterrupt) as error:
    print(type(error).__name__)
"""


class TestTangents:
    def test_a_wrong_one_is_named(self):
        wrong = Plane(["a", "b"], k=8e3, limit=10.0)
        wrong.factor = 0.5
        with pytest.raises(ss.ModelError) as refusal:
            respond(wrong, harmonics=3)
        said = str(refusal.value)
        assert said.startswith("contact 'plane', law 'plane': tangents of step: ")
        assert "of node 0 is" in said
        assert "differences give" in said

    def test_of_the_force(self):
        class Wrong(Slider):
            def step(self, before, after, state):
                force, state, tangents = super().step(before, after, state)
                return 1.1 * force, state, tangents

        with pytest.raises(ss.ModelError, match=r"force\[0\] by state\[0\] of node 0 is 1, differ"):
            respond(Wrong(["a"], k=8e3, limit=1e3))

    @pytest.mark.parametrize("limit", [1.0, 0.03, 1e-2, 3e-3, 1e-3])
    def test_right_ones_of_a_law_that_saturates(self, limit):
        """Differences of a force next to its limit are mostly rounding."""

        class Dahl(Slider):
            def step(self, before, after, state):
                du = after - before
                ahead = np.where(du < 0.0, -self.limit, self.limit)
                fade = np.exp(-self.k * np.abs(du) / self.limit)
                force = ahead - (ahead - state) * fade
                slope = (self.k * (1.0 - force / ahead))[..., None]
                tangents = ss.Tangents(fade[..., None], -slope, slope, [[1.0]], [[0.0]])
                return force, force, tangents

        assert respond(Dahl(["a"], k=8e3, limit=limit)).converged.all()


class TestErrors:
    def test_of_the_users_code_come_with_their_line(self):
        raised = []

        class Broken(Slider):
            def step(self, before, after, state):
                if np.abs(after).max() > 1e-9:
                    raised.append(after)
                    return 1.0 / state.missing
                return super().step(before, after, state)

        broken = model(Broken(["a"], k=8e3, limit=1.0))
        for _ in range(2):
            with pytest.raises(ss.ModelError) as refusal:
                ss.forced_response(broken, np.linspace(90.0, 200.0, 2000), 5)
            said = str(refusal.value)
            assert "law 'broken': step raised AttributeError" in said
            shown = "".join(traceback.format_exception(refusal.value))
            assert "return 1.0 / state.missing" in shown
        # Not at each of the 2000 frequencies.
        assert len(raised) < 200

    @pytest.mark.parametrize(
        ("answer", "message"),
        [
            (None, r"step returns no \(force, state, Tangents"),
            ((0.0, 0.0, None), r"step returns no \(force, state, Tangents"),
            (([[np.nan]], [[0.0]], ([[0.0]],) * 5), r"force\[0, 0\] is nan; give numbers"),
            (([[0.0]], [[0.0, 1.0]], ([[0.0]],) * 5), r"state .*; give shape \(1, 1\)"),
            (
                ([[0.0]], [[0.0]], ([[0.0]],) * 4 + (np.eye(2),)),
                "force_by_after of shape",
            ),
        ],
    )
    def test_answers_that_are_none(self, answer, message):
        class Broken(Slider):
            def step(self, before, after, state):
                return answer

        with pytest.raises(ss.ModelError, match=message):
            respond(Broken(["a"], k=8e3, limit=1.0))

    def test_stiffness_is_checked(self):
        class Skew(Plane):
            def stiffness(self):
                return [[1.0, 2.0], [0.0, 1.0]]

        with pytest.raises(ss.ModelError, match="not symmetric and positive semidefinite"):
            respond(Skew(["a", "b"], k=1.0, limit=1.0))

    def test_state_stiffness_is_needed_of_other_states(self):
        class Long(Slider):
            state_size = 2

        with pytest.raises(ss.ModelError, match="is no force; define state_stiffness"):
            respond(Long(["a"], k=1.0, limit=1.0))

    def test_names_fit_the_directions(self):
        with pytest.raises(ss.ModelError, match="1 names per node for 2 displacements"):
            Plane(["a"], k=1.0, limit=1.0)

    def test_a_class_without_a_step_is_none(self):
        class Half(ss.ContactLaw):
            def stiffness(self):
                return [[1.0]]

        with pytest.raises(TypeError, match="step"):
            Half(["a"])


@pytest.mark.parametrize(
    "analyse",
    [
        lambda one: ss.exact_response(one, OMEGA),
        lambda one: ss.transient(one, 110.0, 2),
        lambda one: ss.single_harmonic(one, OMEGA),
        lambda one: ss.damper_curve(one, slip_force=[1.0, 2.0], dof="a"),
        lambda one: ss.forced_response(one, OMEGA, 3, **MARCHED).contact_states(0, 0),
    ],
)
@pytest.mark.slow
def test_what_needs_more_refuses_the_law_by_its_name(analyse):
    with pytest.raises(ss.ModelError, match=r"slider|slip_force"):
        analyse(model(Slider(["a"], k=8e3, limit=10.0)))


def test_files_refuse_it_and_pickles_hold_it(tmp_path):
    import pickle

    result = respond(Slider(["a"], k=8e3, limit=10.0), omega=[110.0], harmonics=1)
    with pytest.raises(ss.ModelError, match="'slider' is written in Python, which no file holds"):
        result.save(tmp_path / "own.nc")
    again = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(again.contact_force(0, 0), result.contact_force(0, 0))
    result.to_dataset()

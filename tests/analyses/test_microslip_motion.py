"""Laws without sliders in every analysis, against sums of sliders and independent integration."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from microslip import LAW, exponential, iwan, structure

OMEGA = np.linspace(95.0, 125.0, 13)


def model(*contacts, force=3.0, more=(), **options):
    return ss.Model(structure(**options), [*contacts], [ss.Force("b", force), *more])


def sliders(law, count=400):
    """Give elements in parallel that stand for a law: chords of its backbone."""
    if law.law == "iwan":
        end = law.gross_slip_displacement
        u = end * (np.arange(1, count + 1) / count) ** (2.0 / (law.chi + 1.0))
        lost = law.stiffness * u * (u / end) ** (law.chi + 1) / ((1 + law.beta) * (law.chi + 2))
        force = law.stiffness * u - lost
    else:
        u = law.slip_force / law.stiffness * 30.0 * (np.arange(1, count + 1) / count) ** 2
        force = -law.slip_force * np.expm1(-law.stiffness * u / law.slip_force)
    slopes = np.append(np.diff(force, prepend=0.0) / np.diff(u, prepend=0.0), 0.0)
    springs = -np.diff(slopes)
    return ss.ParallelJenkins(*law.dofs, stiffness=springs, slip_forces=springs * u)


@pytest.mark.parametrize("law", [iwan(), iwan("a", "b", chi=-0.8, beta=0.5), exponential()])
def test_forced_responses_are_those_of_many_sliders(law):
    one, many = (ss.forced_response(model(own), OMEGA, 7) for own in (law, sliders(law)))
    assert one.converged.all()
    size = np.abs(many.coefficients("a")).max()
    assert np.abs(one.coefficients("a") - many.coefficients("a")).max() < 2e-4 * size
    np.testing.assert_allclose(one.dissipation(0), many.dissipation(0), rtol=3e-3)
    np.testing.assert_allclose(one.slip_fraction(0), many.slip_fraction(0), rtol=0.02)
    forces = [own.contact_force(0, 6) for own in (one, many)]
    np.testing.assert_allclose(*forces, atol=2e-3 * np.abs(forces[1]).max())
    with pytest.raises(ss.ModelError, match="residual bounds need one stiffness"):
        one.residual_bounds(0)


def chain(omega=108.0):
    own = [iwan("a", "b"), iwan("b", "c", chi=-0.3, beta=0.4, slip_force=2.5), iwan("d", chi=0.0)]
    return model(*own, force=4.0, size=4, damping=0.02), omega


@pytest.mark.slow
def test_a_chain_of_joints_vibrates_as_its_integration_in_time_does():
    own, omega = chain()
    balance = ss.forced_response(own, [omega], 21)
    later = ss.transient(own, omega, 400, scheme="rk4", steps=1024, samples=1024)
    for dof in "abcd":
        last = later.displacement(dof)[-1024:]
        amplitude = 0.5 * (last.max() - last.min())
        assert balance.amplitude(dof)[0] == pytest.approx(amplitude, rel=2e-5)


@pytest.mark.parametrize("law", [iwan("a", slip_force=0.5), exponential("a")])
@pytest.mark.parametrize("preload", [0.0, 0.1])
def test_joints_beside_contacts_that_close_move_as_their_balance_does(law, preload):
    pad = ss.Coulomb(
        ["a", "b", "c"],
        normal=[0, 0, 1],
        friction=0.3,
        tangential_stiffness=8e3,
        normal_stiffness=8e3,
        preload=preload,
    )
    forces = [ss.Force("b", 0.5, phase=1.0), ss.Force("c", 2.0, phase=2.0)]
    own = ss.Model(structure(size=3), [law, pad], [ss.Force("a", 1.0), *forces])
    exact = ss.exact_response(own, [100.0])
    balance = ss.forced_response(own, [100.0], 63)
    assert exact.converged.all()
    for dof in "abc":
        assert exact.amplitude(dof) == pytest.approx(balance.amplitude(dof), rel=1e-5)


@settings(max_examples=15, derandomize=True)
@given(
    chi=st.floats(-0.95, 0.0),
    beta=st.floats(0.0, 5.0),
    slip_force=st.floats(0.05, 100.0),
    omega=st.floats(60.0, 160.0),
)
def test_random_joints_converge_and_balance_their_energy(chi, beta, slip_force, omega):
    own = model(iwan("a", "b", chi=chi, beta=beta, slip_force=slip_force), more=[])
    frf = ss.forced_response(own, [omega], 9)
    assert frf.converged.all()
    fed = np.pi * 3.0 * -frf.coefficients("b")[0, 1].imag
    damping = own.structure.damping
    waves = np.array([frf.coefficients(dof)[0] for dof in "ab"])
    orders = np.arange(waves.shape[1])
    lost = np.einsum("ik,ij,jk,k->", waves.conj(), damping, waves, np.pi * omega * orders**2).real
    assert frf.dissipation(0)[0, 0] + lost == pytest.approx(fed, rel=1e-6)


def test_the_single_harmonic_method_is_the_balance_of_one():
    own = model(iwan(), exponential("b"))
    one, balance = ss.single_harmonic(own, OMEGA), ss.forced_response(own, OMEGA, 1)
    np.testing.assert_allclose(one.coefficients("a"), balance.coefficients("a"), rtol=1e-8)
    np.testing.assert_allclose(one.dissipation(0), balance.dissipation(0), rtol=1e-8)


def test_samples_come_near_the_integrals():
    own = model(iwan())
    exact = ss.forced_response(own, OMEGA[::4], 5)
    sampled = ss.forced_response(own, OMEGA[::4], 5, evaluation="marched", samples=1024)
    np.testing.assert_allclose(sampled.amplitude("a"), exact.amplitude("a"), rtol=1e-3)


@pytest.mark.parametrize("residual", ["centred", "from_rest", 0.3])
def test_a_mean_displacement_and_residuals(residual):
    more = [ss.Force("a", 2.0, harmonic=0)]
    law = iwan()
    one, many = (
        ss.forced_response(model(own, force=1.0, more=more), OMEGA[::4], 5, residual=residual)
        for own in (law, sliders(law))
    )
    # A given force is shared by the elements of one law, and held by each of many sliders.
    if residual != 0.3:
        found, expected = (own.coefficients("a") for own in (one, many))
        assert np.abs(found - expected).max() < 3e-4 * np.abs(expected).max()
    assert one.converged.all()


def test_sensitivities_are_differences():
    frf = ss.forced_response(model(iwan(chi=-0.4, beta=0.3)), [104.0, 112.0], 7)
    slopes = frf.sensitivity("a")
    for parameter, value in {"chi": -0.4, "beta": 0.3, **LAW}.items():
        h = 1e-4 * abs(value)
        sides = []
        for side in (-h, h):
            options = {"chi": -0.4, "beta": 0.3} | {parameter: value + side}
            sides.append(ss.forced_response(model(iwan(**options)), [104.0, 112.0], 7))
        low, high = (own.amplitude("a") for own in sides)
        found = frf.sensitivity("a", "iwan", parameter)
        np.testing.assert_allclose(found, (high - low) / (2 * h), rtol=1e-5)
    assert slopes


def test_dampers_and_their_optimum():
    own = model(exponential())
    curve = ss.damper_curve(own, slip_force=np.geomspace(0.3, 100.0, 9), dof="b", harmonics=3)
    best = ss.optimal_damper(own, dof="b", harmonics=3)
    assert np.isfinite(curve.amplitude).all()
    assert best.amplitude <= curve.amplitude.min() * (1 + 1e-6)
    around = ss.damper_curve(
        own, slip_force=best.value * np.array([0.9, 1.1]), dof="b", harmonics=3
    )
    assert (around.amplitude >= best.amplitude).all()


def test_disks_tuned_and_mistuned():
    disk = ss.BladedDisk(
        structure(),
        sectors=6,
        couplings=[ss.Coupling("b", stiffness=500.0)],
        contacts=[iwan()],
        forces=[ss.Force("b", 2.0)],
        engine_order=2,
    )
    tuned = ss.forced_response(disk, OMEGA[::4], 3)
    ring = ss.forced_response(disk.mistuned(np.zeros(6)), OMEGA[::4], 3)
    np.testing.assert_allclose(ring.amplitude("4.b"), tuned.amplitude("b"), rtol=1e-6)
    assert np.isfinite(
        ss.forced_response(disk.mistuned(0.05 * np.arange(6)), OMEGA[::4], 3).omega
    ).all()


def test_exact_orbits_of_a_chain_are_those_of_the_balance():
    own, omega = chain()
    balance = ss.forced_response(own, [omega], 41)
    exact = ss.exact_response(own, [omega])
    assert exact.converged.all()
    assert (exact.stability == "stable").all()
    for dof in "abcd":
        np.testing.assert_allclose(balance.amplitude(dof), exact.amplitude(dof), rtol=1e-7)
    for contact in range(3):
        found, expected = (result.dissipation(contact) for result in (balance, exact))
        np.testing.assert_allclose(found, expected, rtol=1e-6)
        found, expected = (result.slip_fraction(contact) for result in (balance, exact))
        np.testing.assert_allclose(found, expected, rtol=1e-5)
    assert np.abs(exact.energy.imbalance).max() < 1e-9
    certified = ss.certify(ss.forced_response(own, [omega], 7), points=1)
    assert certified.certificate is not None


@pytest.mark.parametrize("residual", ["centred", "from_rest"])
@pytest.mark.parametrize(
    "law",
    [
        iwan(chi=-0.93, beta=0.3),
        exponential(),
        ss.Masing("a", **LAW, backbone="shear-layer", shear_lag=1.5),
        ss.Masing("a", backbone=([1e-3, 2e-3, 5e-3], [3.0, 4.0, 4.5])),
    ],
)
def test_exact_orbits_of_a_motion_without_symmetry(law, residual):
    more = [ss.Force("a", 2.0, harmonic=0), ss.Force("b", 1.0, harmonic=2)]
    own = model(law, more=more, damping=0.01)
    balance = ss.forced_response(own, [104.0], 41, residual=residual)
    exact = ss.exact_response(own, [104.0], residual=residual)
    size = np.abs(balance.coefficients("a")).max()
    apart = np.abs(balance.coefficients("a")[:, :5] - exact.coefficients("a")[:, :5]).max()
    assert apart < 1e-6 * size
    later = ss.transient(own, 104.0, 2, start=exact.state(0))
    assert later.change.max() < 1e-9


def test_exact_transients_are_those_of_fine_steps():
    own, omega = chain()
    exact = ss.transient(own, omega, 6, samples=64)
    apart = []
    for steps in (512, 2048):
        fine = ss.transient(own, omega, 6, scheme="rk4", steps=steps, samples=64)
        apart.append(np.abs(exact.displacement("b") - fine.displacement("b")).max())
    assert apart[1] < 1e-6 * np.abs(exact.displacement("b")).max()
    assert apart[1] < apart[0] / 4
    # Either scheme goes on where the other has come to.
    half = ss.transient(own, omega, 3, scheme="rk4", steps=2048, samples=64)
    on = ss.transient(own, omega, 3, start=half.final, samples=64)
    np.testing.assert_allclose(
        on.displacement("b"), exact.displacement("b")[3 * 64 :], atol=1e-6 * 1e-2
    )


def test_a_free_motion_dies_away():
    own = ss.Model(structure(), [iwan()], [])
    fate = ss.classify(own, {"a": 1e-3}, periods=200)
    assert fate.motion == "decaying"


@pytest.mark.parametrize(("sectors", "order", "harmonic"), [(6, 1, 1), (5, 2, 1), (5, 2, 2)])
def test_exact_waves_of_a_tuned_disk_are_those_of_the_balance(sectors, order, harmonic):
    disk = ss.BladedDisk(
        structure(damping=0.01),
        sectors=sectors,
        couplings=[ss.Coupling("b", stiffness=500.0)],
        contacts=[iwan(beta=0.3), exponential("b", slip_force=1.0)],
        forces=[ss.Force("b", 3.0), ss.Force("b", 1.0, harmonic=harmonic)],
        engine_order=order,
    )
    exact, balance = ss.exact_response(disk, [105.0]), ss.forced_response(disk, [105.0], 41)
    assert exact.converged.all()
    found, expected = (own.coefficients("b")[:, :6] for own in (exact, balance))
    assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()


def spring_chain(mass, to_ground, between, damping):
    stiffness = np.diag(to_ground).astype(float)
    for i, k in enumerate(between):
        stiffness[i : i + 2, i : i + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return ss.Structure(
        np.diag(mass), stiffness, ss.ModalDamping(damping), list("abcd")[: len(mass)]
    )


def test_orbits_are_found_whose_reversals_lie_at_the_begin_of_the_period():
    # The contacts turn round 0.02 and 0.2 before the begin; what they remember jumps there. The
    # slider of the second system is pushed to its limit on the way, and has to come back.
    first = ss.Model(
        spring_chain([1.837, 0.608, 1.16], [2200, 5421, 4304], [5983, 4470], 0.02),
        [ss.Iwan("c", stiffness=1040.0, slip_force=0.257, chi=-0.0045, beta=2.36)],
        [ss.Force("a", 4.877), ss.Force("a", 1.377, harmonic=3), ss.Force("c", 0.595, harmonic=0)],
    )
    joint = ss.Masing(
        "c", "d", stiffness=895.3, slip_force=6.074, backbone="shear-layer", shear_lag=1.79
    )
    second = ss.Model(
        spring_chain(
            [1.401, 1.435, 0.604, 1.365], [2724, 5081, 7190, 2310], [5793, 7512, 4114], 0.0125
        ),
        [joint, ss.Jenkins("d", stiffness=9675.0, slip_force=0.21977)],
        [ss.Force("a", 7.262)],
    )
    for own, omega, residual in ((first, 137.4, "centred"), (second, 207.77, 0.734)):
        exact = ss.exact_response(own, [omega], residual=residual)
        balance = ss.forced_response(own, [omega], 63, residual=residual)
        assert exact.converged.all()
        found, expected = (own.coefficients("c")[:, :6] for own in (exact, balance))
        assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()
        again = ss.transient(own, omega, 2, start=exact.state(0))
        assert again.change.max() < 1e-9


@pytest.mark.parametrize("residual", [0.3, -1.0, 50.0])
@pytest.mark.parametrize("law", [iwan(chi=-0.3), exponential()])
def test_exact_orbits_hold_what_they_are_given(law, residual):
    rod = ss.Jenkins("b", stiffness=2e3, slip_force=200.0)
    own = model(law, rod, more=[ss.Force("a", 2.0, harmonic=0)], damping=0.01)
    balance = ss.forced_response(own, [104.0], 41, residual=residual)
    exact = ss.exact_response(own, [104.0], residual=residual)
    found, expected = (each.coefficients("a")[:, :5] for each in (exact, balance))
    assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()
    held = exact.contact_force(0, 0)
    assert held.max() <= law.slip_force


def test_results_go_to_files_and_back(tmp_path):
    table = ss.Masing("a", backbone=([1e-3, 2e-3, 5e-3], [3.0, 4.0, 4.5]))
    strap = ss.Masing("b", **LAW, backbone="shear-layer", shear_lag=1.5)
    frf = ss.forced_response(model(iwan(), table, strap), OMEGA[::6], 3)
    frf.save(tmp_path / "joints.nc")
    again = ss.load(tmp_path / "joints.nc")
    assert again.model.contacts == frf.model.contacts
    np.testing.assert_array_equal(again.amplitude("a"), frf.amplitude("a"))
    frf.plot_hysteresis(0, 1)
    frf.plot_slip()


def test_bouc_wen_loops_drift_and_those_of_masing_laws_close():
    # One slow harmonic that moves to and fro about a mean, in a structure that hardly yields.
    stiff = ss.Structure([[1.0]], [[1e6]], ss.ModalDamping(0.05), ["a"])
    loads = [ss.Force("a", 150.0, harmonic=0), ss.Force("a", 100.0)]
    means = []
    for law in (exponential(), ss.BoucWen("a", **LAW)):
        own = ss.Model(stiff, [law], loads)
        later = ss.transient(own, 50.0, 60, scheme="rk4", steps=512, samples=64)
        force = later.contact_force(0).reshape(-1)[1:].reshape(60, 64).mean(axis=1)
        means.append(force)
    held, drifting = means
    assert abs(held[-1] - held[20]) < 1e-3 * LAW["slip_force"]
    assert drifting[-1] < 0.5 * drifting[5]


def test_bouc_wen_balances():
    law = ss.BoucWen("a", **LAW, exponent=2.0)
    frf = ss.forced_response(model(law), [100.0, 110.0], 7)
    assert frf.converged.all()
    later = ss.transient(model(law), 110.0, 300, scheme="rk4", steps=512, samples=512)
    last = later.displacement("a")[-512:]
    assert frf.amplitude("a")[1] == pytest.approx(0.5 * (last.max() - last.min()), rel=1e-3)


@pytest.mark.slow
def test_orbits_of_many_joints_at_low_frequencies_end_within_their_steps():
    joints = [
        ss.Masing(
            "a", stiffness=0.5, slip_force=0.1 + 0.02 * i, backbone="exponential", name=f"j{i}"
        )
        for i in range(4)
    ]
    plain = ss.Structure(
        np.eye(2), [[2.0, -1.0], [-1.0, 3.0]], [[0.06, -0.02], [-0.02, 0.08]], ["a", "b"]
    )
    orbits = ss.exact_response(ss.Model(plain, joints, [ss.Force("a", 1.0)]), [8.6e-5])
    assert orbits.status[0] == "steps limit"
    # An orbit takes 110000 steps there, each as long as many of another law.
    assert orbits.counters["evaluations"] < 40000


def test_a_slip_force_of_next_to_nothing_ends_a_motion_with_its_reason():
    structure = ss.Structure([[1.0]], [[1.0]], [[0.05]], ["a"])
    law = ss.Masing("a", stiffness=1.0, slip_force=1e-6, backbone="exponential")
    driven = ss.transient(ss.Model(structure, [law], [ss.Force("a", 1.0)]), 1.1, 3)
    assert driven.status == "halted"
    assert driven.periods < 3
    free = ss.classify(ss.Model(structure, [law]), {"a": 1.0})
    assert free.reason == "crawling"
    assert free.motion == "undecided"

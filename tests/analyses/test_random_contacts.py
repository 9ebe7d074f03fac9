"""Random structures with friction contacts: four ways to their vibration agree.

Or a status says why not. The harmonic balance with exact integrals and with samples, the exact
orbit and a time integration that starts on the balance are computed for systems of 1 to 6 degrees
of freedom and 1 to 8 nodes, in a plane and in space, with preloads and gaps, static loads, bodies
that are free, and friction up to 1.2.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

import stickslip as ss

HARMONICS = 9
PERIODS = 20
NAMED = {"free-flight", "not-determined"}


def structure(random: np.random.Generator) -> ss.Structure:
    """One of 1 to 6 modes between 60 and 400 rad/s, sometimes one of them at rest."""
    size = int(random.integers(1, 7))
    root = np.sqrt(np.diag(random.uniform(0.5, 2.0, size)))
    turn, _ = np.linalg.qr(random.normal(size=(size, size)))
    rates = np.sort(random.uniform(60.0, 400.0, size))
    if size > 1 and random.random() < 0.12:
        rates[0] = 0.0
    shapes = root @ turn
    ratio = 10.0 ** random.uniform(-2.7, -1.1)
    stiffness = shapes @ np.diag(rates**2) @ shapes.T
    damping = shapes @ np.diag(2.0 * ratio * np.maximum(rates, 30.0)) @ shapes.T
    dofs = [f"q{i}" for i in range(size)]
    return ss.Structure(root**2, (stiffness + stiffness.T) / 2, (damping + damping.T) / 2, dofs)


def contact(
    random: np.random.Generator,
    dofs: tuple[str, ...],
    space: bool,
    load: float | None,
    force: float,
) -> ss.Coulomb:
    """One node; `load` relative to the force is a constant normal load, if there is one."""
    size = (3 if space else 2) - (load is not None)
    rows = []
    for _ in range(size):
        factors = random.normal(size=len(dofs)) * (random.random(len(dofs)) < 0.6)
        if not factors.any():
            factors[int(random.integers(len(dofs)))] = 0.7
        rows.append({dof: float(f) for dof, f in zip(dofs, factors, strict=True) if f})
    stiffness = 10.0 ** random.uniform(3.0, 5.0)
    friction = random.uniform(0.0, 1.2)
    if load is not None:
        return ss.Coulomb(
            rows,
            normal=None,
            friction=friction,
            tangential_stiffness=stiffness,
            preload=load * force,
        )
    normal = [0.0] * (size - 1) + [1.0] if random.random() < 0.7 else random.normal(size=size)
    closure: dict[str, float] = {}
    if random.random() < 0.5:
        closure["preload"] = force * 10.0 ** random.uniform(-1.5, 0.7)
    else:
        closure["gap"] = force / 1e4 * random.normal() * 10.0 ** random.uniform(-1.0, 0.5)
    return ss.Coulomb(
        rows,
        normal=normal,
        friction=friction,
        tangential_stiffness=stiffness,
        normal_stiffness=10.0 ** random.uniform(3.0, 5.0),
        **closure,
    )


def system(seed: int) -> tuple[ss.Model, float]:
    random = np.random.default_rng([16, seed])
    bodies = structure(random)
    dofs, space = bodies.dofs, bool(random.random() < 0.5)
    nodes = int(random.integers(1, 4 if random.random() < 0.6 else 9))
    force = 10.0 ** random.uniform(0.5, 2.5)
    load = 10.0 ** random.uniform(-1.3, 0.7) if random.random() < 0.2 else None
    contacts = [contact(random, dofs, space, load, force) for _ in range(nodes)]
    forces = [
        ss.Force(dof, force * random.normal(), phase=random.uniform(-3.0, 3.0)) for dof in dofs
    ]
    if random.random() < 0.6:
        forces += [ss.Force(dof, 2.0 * force * random.normal(), harmonic=0) for dof in dofs]
    model = ss.Model(bodies, contacts, forces)
    rates = ss.natural_frequencies(model, slipping=[])
    rates = rates[rates > 20.0]
    return model, float(rates[int(random.integers(rates.size))] * random.uniform(0.4, 1.3))


def amplitudes(motion: ss.ForcedResponse | ss.ExactResponse) -> NDArray[np.float64]:
    return np.array([motion.amplitude(dof)[0] for dof in motion.dofs])


def beginning(model: ss.Model, frf: ss.ForcedResponse) -> ss.State:
    """The state at the start of the period, its tractions within the limits."""
    orders = np.arange(frf.coefficients(model.structure.dofs[0])[0].size)
    series = np.array([frf.coefficients(dof)[0] for dof in model.structure.dofs])
    rate = 1j * frf.omega[0] * orders
    tractions = []
    for law, name in zip(model.contacts, model.contact_names, strict=True):
        forces = np.asarray(frf.contact_force(name, 0, 8))[0].ravel()
        own = forces[: law.tangential]
        limit = law.friction * (law.preload if law.normal is None else max(forces[-1], 0.0))
        size = float(np.linalg.norm(own))
        tractions += list(own * min(1.0, limit / size) * (1.0 - 1e-9) if size > 0.0 else own)
    return ss.State(model, series.real.sum(1), (rate * series).real.sum(1), tractions)


def agree(seed: int) -> str:
    """Compare the four ways, and return how the balance ended."""
    model, omega = system(seed)
    exact = ss.forced_response(model, [omega], HARMONICS)
    status = exact.status[0]
    if not status.solved:
        assert str(status) in {"free", "stalled", "singular"}
        return str(status)
    size = amplitudes(exact)
    error = max(exact.error_estimate(dof)[0] for dof in exact.dofs) / size.max()
    codes = {told.code for told in exact.diagnostics}
    if error > 0.05:
        assert codes & (NAMED | {"truncation"})
        return "truncated"
    sampled = ss.forced_response(
        model, [omega], HARMONICS, evaluation="marched", samples=256, stability=False
    )
    orbit = ss.exact_response(model, [omega])
    other = np.abs(amplitudes(sampled) - size).max() / size.max()
    # A body that nothing holds is found by the balance alone.
    assert codes & NAMED or (sampled.status[0].solved and orbit.status[0].solved)
    assert not sampled.status[0].solved or other < max(1e-2, error)
    if orbit.status[0].solved:
        assert np.abs(amplitudes(orbit) - size).max() / size.max() < max(1e-2, 3.0 * error)
        verdicts = {exact.stable[0], orbit.stable[0]} - {None}
        assert len(verdicts) < 2, f"balance {exact.stable[0]}, orbit {orbit.stable[0]}"
    # A motion that is not known to be stable is followed for one period alone.
    periods = PERIODS if exact.stable[0] else 1
    start = beginning(model, exact)
    run = ss.transient(model, omega, periods, "exact", start=start, samples=64, keep=1)
    found = np.array([run.amplitude(dof) for dof in exact.dofs])
    assert np.abs(found - size).max() / size.max() < max(1e-2, 5.0 * error)
    return "solved"


@pytest.mark.slow
@pytest.mark.parametrize("first", range(53, 105, 13))
def test_four_ways_to_the_vibration_of_random_systems_agree(first: int) -> None:
    ends = [agree(seed) for seed in range(first, first + 13)]
    assert ends.count("solved") >= 11, ends


def touching() -> ss.Model:
    """Two degrees of freedom that three nodes hold; the first comes to touch its limit."""
    shape = np.array([1.0, 0.2858575])
    bodies = ss.Structure(
        np.diag([1.729113, 1.452313]),
        37537.709 * np.outer(shape, shape),
        [[4.844334, 1.094919], [1.094919, 1.164708]],
        ["a", "b"],
    )

    def node(
        rows: list[list[float]], friction: float, stiffness: tuple[float, float], preload: float
    ) -> ss.Coulomb:
        return ss.Coulomb(
            [dict(zip("ab", row, strict=True)) for row in rows],
            normal=[0, 0, 1],
            friction=friction,
            tangential_stiffness=stiffness[0],
            normal_stiffness=stiffness[1],
            preload=preload,
        )

    first = [[0.116464, 0.935953], [1.052029, 0.0], [0.309563, -0.352125]]
    second = [[0.07357, 0.0], [-0.424501, -1.076932], [0.0, -0.478769]]
    third = [[0.360878, 0.0], [-0.895323, -0.795803], [-0.329496, 1.314279]]
    contacts = [
        node(first, 0.372784, (19542.782, 18999.161), 20.484532),
        node(second, 0.050111, (26321.34, 20788.616), 61.409738),
        node(third, 0.372784, (35205.025, 16251.682), 0.574183),
    ]
    return ss.Model(
        bodies,
        contacts,
        [ss.Force("a", 15.054634, phase=1.957734), ss.Force("b", -6.322771, phase=-0.264926)],
    )


def test_a_motion_that_touches_a_limit_is_unstable_where_a_disturbance_away_from_it_grows() -> None:
    # The march of the balance has one slip there, of the size of rounding.
    model, omega = touching(), 109.556297
    balance = ss.forced_response(model, [omega], HARMONICS)
    orbit = ss.exact_response(model, [omega])
    largest = np.abs(orbit.multipliers[0]).max()
    assert largest == pytest.approx(1.0997, abs=2e-3)
    assert [orbit.stable[0], balance.stable[0]] == [False, False]
    # Pushed a little, the motion leaves the orbit.
    state = orbit.state(0)
    pushed = ss.State(model, state.displacement * (1.0 + 1e-4), state.velocity, state.contact_force)
    run = ss.transient(model, omega, 150, "exact", start=pushed, samples=64, keep=1)
    size = float(np.abs(state.displacement).max())
    assert np.abs(run.final.displacement - state.displacement).max() > 0.02 * size


def test_contacts_that_nearly_graze_their_limit_do_not_make_a_stable_motion_unstable() -> None:
    # With 9 harmonics the largest multiplier is beyond 1, instead of 0.97.
    model, omega = system(60032)
    orbit = ss.exact_response(model, [omega])
    assert orbit.stable[0]
    verdicts = [ss.forced_response(model, [omega], count).stable[0] for count in (5, 7, 9, 10, 15)]
    assert False not in verdicts
    assert verdicts[-1]


@pytest.mark.parametrize("detune", [0.99, 0.999, 1.0, 1.001])
def test_an_orbit_is_found_whose_contact_keeps_all_the_traction_of_its_load(detune: float) -> None:
    # It sticks at its limit: the middle of its motion is beyond what Coulomb allows.
    model, omega = system(60431)
    orbit = ss.exact_response(model, [detune * omega])
    assert orbit.status[0].solved
    assert orbit.iterations[0] < 10
    balance = ss.forced_response(model, [detune * omega], 3)
    np.testing.assert_allclose(amplitudes(orbit), amplitudes(balance), rtol=1e-8)

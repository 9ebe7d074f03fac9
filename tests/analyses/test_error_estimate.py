"""Error estimates and automatic harmonics on mixes of soft and stiff contacts, by exact orbits."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row


def mixed(seed: int) -> tuple[ss.Model, np.ndarray]:
    """A random chain or full system of 2 to 8 DOFs with contacts of 6e-6 to 1.5e3 its stiffness."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    if rng.random() < 0.5:
        stiffness = in_a_row(10 ** rng.uniform(3, 5, n + 1))
        mass = np.diag(10 ** rng.uniform(-0.5, 0.5, n))
    else:
        a = rng.normal(size=(n, n))
        stiffness = 1e4 * (a @ a.T / n + 0.05 * np.eye(n))
        a = rng.normal(size=(n, n))
        mass = a @ a.T / n + 0.5 * np.eye(n)
    ratio = float(rng.choice([0.0, 1e-5, 1e-4, 1e-3, 5e-3, 2e-2]))
    names = [f"x{i}" for i in range(n)]
    damping = ss.ModalDamping(ratio) if ratio else None
    structure = ss.Structure(mass=mass, stiffness=stiffness, damping=damping, dofs=names)
    count = int(rng.integers(1, min(3, n) + 1))
    base = float(np.mean(np.diag(stiffness)))
    contacts = []
    for i in rng.choice(n, count, replace=False):
        spring = base * 10 ** rng.uniform(np.log10(6e-6), np.log10(1.5e3))
        limit = 10 ** rng.uniform(-1.5, 1.0)
        other = None
        if rng.random() < 0.3 and n > 1:
            other = names[int(rng.choice([d for d in range(n) if d != i]))]
        dofs = (names[i],) if other is None else (names[i], other)
        contacts.append(ss.Jenkins(*dofs, stiffness=spring, slip_force=limit))
    model = ss.Model(structure, contacts, [ss.Force(names[int(rng.integers(n))], 1.0)])
    free = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
    ends = np.log(0.3 * free[0]), np.log(1.2 * free[-1])
    return model, np.sort(np.exp(rng.uniform(*ends, 10)))


# In 22, 26, 40 and 59 contacts that stick in the truncated solution slip in the true one, or slip
# in other parts of the period, which one Newton step does not foresee.
@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3, 5, 22, 26, 40, 59])
def test_no_error_is_far_above_its_estimate(seed: int) -> None:
    model, omega = mixed(seed)
    exact = ss.exact_response(model, omega)
    for harmonics in (1, 3, 7, 15):
        frf = ss.forced_response(model, omega, harmonics)
        for dof in frf.dofs:
            error = np.abs(frf.amplitude(dof) - exact.amplitude(dof))
            rounding = 1e-5 * exact.amplitude(dof) + 1e-7 * max(map(exact_size(exact), frf.dofs))
            assert (error <= 5.0 * frf.error_estimate(dof) + rounding).all(), (harmonics, dof)


def test_estimates_beside_each_other_see_as_far_as_one_by_itself() -> None:
    springs = np.array([11679.0, 24522.1, 26213.9, 44131.5, 48345.3, 13085.1])
    between = np.array([8880.2, 15202.2, 10756.9, 29816.3, 12817.7])
    stiffness = np.diag(springs) - np.diag(between, 1) - np.diag(between, -1)
    mass = np.diag([1.6161, 1.2967, 1.8988, 1.3012, 0.603, 0.9061])
    names = [f"x{i}" for i in range(6)]
    structure = ss.Structure(mass, stiffness, ss.ModalDamping(2.5757e-3), names)
    # Nearly rigid: its mode is at 62 times the frequency.
    contact = ss.Jenkins("x4", stiffness=7.92e6, slip_force=1.6428)
    model = ss.Model(structure, [contact], [ss.Force("x5", 1.3364)])
    true = ss.forced_response(model, [58.3837], 121).arrays.displacement[0]
    # Beside two others the estimate may take less.
    for omega in ([58.3837], [57.7016, 58.3837], [57.0, 57.7016, 58.3837]):
        one = ss.forced_response(model, omega, 1)
        error = true.copy()
        error[:2] -= one.arrays.displacement[-1]
        assert (np.abs(error).sum(axis=0) < 5.0 * one.arrays.error_estimate[-1]).all()


def test_an_estimate_of_one_harmonic_carries_a_factor_of_safety() -> None:
    own = [21763.811, 40141.223, 49848.411, 60307.793, 37569.659, 11995.819, 10831.711, 4634.3984]
    between = [20697.282, 19130.869, 29185.914, 30884.918, 5918.9178, 5973.8153, 4157.8076]
    stiffness = np.diag(own) - np.diag(between, 1) - np.diag(between, -1)
    mass = np.diag(
        [1.2858202, 0.6865898, 1.4510495, 1.982992, 1.9708855, 0.8774275, 0.6161978, 0.814458]
    )
    names = [f"x{i}" for i in range(8)]
    structure = ss.Structure(mass, stiffness, ss.ModalDamping(4.3055364e-4), names)
    contacts = [
        ss.Jenkins("x5", stiffness=8703358.8, slip_force=4.2264422),
        ss.Jenkins("x7", stiffness=0.27778593, slip_force=0.35713266),
        ss.Jenkins("x1", stiffness=0.61710479, slip_force=0.32486587),
    ]
    model = ss.Model(structure, contacts, [ss.Force("x4", 1.7497694)])
    omega = [31.320584132769635]
    error = ss.forced_response(model, omega, 121).arrays.displacement[0].copy()
    one = ss.forced_response(model, omega, 1)
    error[:2] -= one.arrays.displacement[0]
    waves = np.exp(1j * np.outer(np.linspace(0.0, 2.0 * np.pi, 1025), np.arange(122)))
    ratio = np.abs((waves @ error).real).max(axis=0) / one.arrays.error_estimate[0]
    assert 1.0 < ratio.max() < 5.0


@pytest.mark.parametrize(("order", "harmonics"), [(41, 7), (61, 15), (81, 27), (121, 27)])
def test_estimates_see_the_mode_that_a_high_harmonic_meets(order: int, harmonics: int) -> None:
    stiffness = np.array([[2.0, -0.3], [-0.3, order**2]])
    blade = ss.Structure(np.eye(2), stiffness, ss.ModalDamping(1e-5), ["blade", "tip"])
    friction = ss.Jenkins("blade", stiffness=3.0, slip_force=0.2)
    model = ss.Model(blade, [friction], [ss.Force("blade", 1.0)])
    # Far beyond what the estimate of so few harmonics can afford to follow as a whole.
    omega = [ss.natural_frequencies(model)[-1] / order]
    tip = ss.forced_response(model, omega, 191).arrays.displacement[0, :, 1]
    few = ss.forced_response(model, omega, harmonics)
    error = tip.copy()
    error[: harmonics + 1] -= few.arrays.displacement[0, :, 1]
    sizes = np.abs(error)
    assert sizes.argmax() == order
    assert 0.8 * sizes.sum() <= few.error_estimate("tip")[0] <= 2.0 * sizes.sum()
    automatic = ss.forced_response(model, omega, observe=["blade", "tip"])
    missed = np.abs(tip[automatic.harmonics[0] + 1 :]).sum()
    assert missed <= 2e-3 * np.abs(tip).sum()


@pytest.mark.parametrize("harmonic", [2, 3])
def test_loads_of_one_higher_harmonic_are_answered_at_its_multiples(harmonic: int) -> None:
    stiffness = 1e4 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.2, -1.0], [0.0, -1.0, 1.5]])
    structure = ss.Structure(np.eye(3), stiffness, ss.ModalDamping(1e-3), ["a", "b", "c"])
    contacts = [ss.Jenkins("b", stiffness=2e4, slip_force=0.5)]
    model = ss.Model(structure, contacts, [ss.Force("a", 1.0, harmonic=harmonic)])
    omega = np.linspace(10.0, 150.0, 6) / harmonic
    exact, frf = ss.exact_response(model, omega), ss.forced_response(model, omega, harmonic)
    automatic = ss.forced_response(model, omega)
    for dof in frf.dofs:
        error = np.abs(frf.amplitude(dof) - exact.amplitude(dof))
        assert error.max() > 1e-3 * exact.amplitude(dof).max()
        assert (error <= 5.0 * frf.error_estimate(dof) + 1e-5 * exact.amplitude(dof)).all()
        assert automatic.amplitude(dof) == pytest.approx(exact.amplitude(dof), rel=3e-3)


@pytest.mark.parametrize("mistuned", [False, True])
@pytest.mark.parametrize("harmonics", [3, 7])
def test_harmonics_that_contacts_between_sectors_do_not_feel_tell_no_errors(
    mistuned: bool, harmonics: int
) -> None:
    # Harmonic 5 of engine order 2 comes to all of 5 sectors at once, so does 9 of 3 to 9 sectors.
    sectors, order = (5, 2) if harmonics == 3 else (9, 3)
    stiffness = in_a_row(np.array([2e4, 1.5e4, 0.0]))
    blade = ss.Structure(np.eye(2), stiffness, ss.ModalDamping(3e-3), ["a", "b"])
    disk = ss.BladedDisk(
        blade,
        sectors,
        [ss.Coupling("a", stiffness=2e3)],
        [ss.Jenkins("b", "next.b", stiffness=1e4, slip_force=0.5)],
        [ss.Force("b", 1.0)],
        engine_order=order,
    )
    pattern = ss.mistuning_pattern(sectors, 0.01, seed=1)
    model = disk.mistuned(pattern) if mistuned else disk
    omega = np.linspace(0.95, 1.05, 5) * ss.natural_frequencies(disk, nodal_diameter=order)[0]
    frf, fine = (ss.forced_response(model, omega, h) for h in (harmonics, 63))
    for dof in frf.dofs:
        change = fine.coefficients(dof).copy()
        change[:, : harmonics + 1] -= frf.coefficients(dof)
        error = np.abs(change).max(axis=1)
        assert error.max() > 1e-6 * fine.amplitude(dof).max()
        assert (error <= 5.0 * frf.error_estimate(dof)).all(), dof


def exact_size(exact: ss.ExactResponse):
    return lambda dof: np.nanmax(exact.amplitude(dof))


# In 252 estimates were small where more harmonics change the state of a contact.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "points"), [(seed, slice(None)) for seed in (1, 2, 22, 59)] + [(252, slice(1, 4))]
)
def test_automatic_harmonics_keep_the_tolerance(seed: int, points: slice) -> None:
    model, omega = mixed(seed)
    omega = omega[points]
    exact = ss.exact_response(model, omega)
    frf = ss.forced_response(model, omega, observe=model.structure.dofs)
    for dof in frf.dofs:
        size = np.maximum(exact.amplitude(dof), 1e-3 * np.nanmax(frf.amplitude(dof)))
        error = np.abs(frf.amplitude(dof) - exact.amplitude(dof)) / size
        assert (error[frf.converged] < 3e-3).all(), dof


def test_no_estimate_among_modes_is_believed_that_falls_too_fast() -> None:
    between = np.array([11225.34, 4079.93, 4743.12, 30602.08, 9155.39])
    own = np.array([18026.07, 20824.7, 9299.3, 43865.53, 40853.74, 9325.06])
    stiffness = np.diag(own) - np.diag(between, 1) - np.diag(between, -1)
    mass = np.diag([0.89454, 0.526405, 0.624422, 1.058192, 1.246492, 1.796595])
    structure = ss.Structure(mass, stiffness, dofs=[f"x{i}" for i in range(6)])
    springs = {"x1": (1941.58, 3.46048), "x4": (47.9625, 2.9209), "x3": (3648270.0, 0.219356)}
    contacts = [ss.Jenkins(dof, stiffness=k, slip_force=f) for dof, (k, f) in springs.items()]
    model = ss.Model(structure, contacts, [ss.Force("x5", 1.929032)])
    omega = np.array([84.48675528])
    frf, fine = (ss.forced_response(model, omega, h, observe=structure.dofs) for h in ("auto", 121))
    assert frf.converged.all()
    # With 19 harmonics estimates are a fifth of the error, and a fourteenth of those with 13.
    for dof in frf.dofs:
        change = fine.coefficients(dof).copy()
        change[:, : frf.coefficients(dof).shape[1]] -= frf.coefficients(dof)
        assert (np.abs(change).max(axis=1) < 2e-3 * fine.amplitude(dof)).all(), dof


def test_modal_coordinates_are_observed_if_they_are_named() -> None:
    blade = ss.reference.turbine_blade()
    frf = ss.forced_response(blade, (1508.0, 1747.0))
    assert frf.dofs == ("damper", "tip")
    assert frf.omega.size < 400
    assert frf.harmonics.max() < 60
    named = ss.forced_response(blade, [1600.0], 3, observe=["mode-2"])
    assert named.dofs == ("mode-2",)
    with pytest.warns(
        UserWarning, match="observe names modal coordinates, 1 of them: .* a hundred times"
    ):
        ss.forced_response(blade, [1600.0, 1601.0], observe=["tip", "mode-2"], max_harmonics=9)


def many_contacts(slipping: int) -> ss.Model:
    """A chain of 48 masses, each with a contact to ground, few of which slip."""
    springs = 1e4 * np.random.default_rng(0).uniform(0.8, 1.2, 49)
    names = [f"x{i}" for i in range(48)]
    chain = ss.Structure(np.eye(48), in_a_row(springs), ss.ModalDamping(5e-3), names)
    contacts = [
        ss.Jenkins(name, stiffness=1e4, slip_force=0.3 if i < slipping else 1e3)
        for i, name in enumerate(names)
    ]
    return ss.Model(chain, contacts, [ss.Force("x0", 1.0)])


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [1, 3])
def test_estimates_with_few_slipping_contacts_are_right_within_their_effort(harmonics: int) -> None:
    model, omega = many_contacts(2), np.linspace(120.0, 200.0, 9)
    frf = ss.forced_response(model, omega, harmonics)
    fine = ss.forced_response(model, omega, 41)
    assert frf.slip_fraction(0).min() > 0.1
    for dof in ("x0", "x1", "x5"):
        error = np.abs(frf.coefficients(dof)[:, 1] - fine.coefficients(dof)[:, 1])
        assert (error <= 5.0 * frf.error_estimate(dof) + 1e-9 * fine.amplitude(dof)).all()
    assert set(frf.timings) >= {"recovery", "estimate"}


def test_estimates_do_not_depend_on_the_way_to_the_solution() -> None:
    model, omega = many_contacts(2), [130.0, 150.0, 180.0]
    newton = ss.forced_response(model, omega, 3)
    others = (
        ss.forced_response(model, omega, 3, method="broyden"),
        ss.forced_response(model, omega[::-1], 3),
    )
    for other, order in zip(others, ([0, 1, 2], [2, 1, 0]), strict=True):
        np.testing.assert_allclose(
            other.error_estimate("x5")[order], newton.error_estimate("x5"), rtol=1e-5
        )


@pytest.mark.parametrize("harmonics", [1, 3])
def test_estimates_along_a_curve_are_those_of_its_frequencies(harmonics: int) -> None:
    # Beside a point at which it was made, the second step counts as much as there: 1 to 2 times.
    # An account that is nearly empty sees fewer harmonics, and counts those behind by their sum.
    for model, omega in (
        (ss.reference.snecma_beam(20.313), np.linspace(150.0, 250.0, 41)),
        (many_contacts(4), np.linspace(140.0, 160.0, 21)),
    ):
        curve = ss.forced_response(model, omega, harmonics)
        alone = [ss.forced_response(model, [one], harmonics) for one in omega]
        true = ss.forced_response(model, omega, 61)
        for dof in curve.dofs[:4]:
            own = np.array([one.error_estimate(dof)[0] for one in alone])
            slips = own > 0.0
            estimate = curve.error_estimate(dof)[slips]
            ratio = estimate / own[slips]
            # By itself a second step may overshoot: what is less is not below the error.
            error = true.coefficients(dof)[slips].copy()
            error[:, : harmonics + 1] -= curve.coefficients(dof)[slips]
            assert ((ratio > 0.4) | (estimate >= np.abs(error).sum(axis=1))).all()
            assert ratio.max() < 2.5
            assert np.median(ratio) == pytest.approx(1.0, abs=0.1)


def carried_on(errors: np.ndarray, in_a_row: int = 1) -> list[int]:
    """Points of an even grid whose estimates are those that two before them lead to."""
    found, own = [], [0]
    for i in range(1, errors.shape[1]):
        if len(own) > 1:
            before, last = own[-2:]
            if i - last <= min(in_a_row, last - before):
                growth = (errors[:, last] / errors[:, before]) ** ((i - last) / (last - before))
                goes_on = errors[:, last] * growth.clip(1.0, 1.5)
                if np.allclose(errors[:, i], goes_on, rtol=1e-6, atol=0.0):
                    found.append(i)
                    continue
        own.append(i)
    return found


def test_estimates_go_on_along_smooth_pieces() -> None:
    beam, omega = ss.reference.snecma_beam(20.313), np.linspace(200.0, 220.0, 21)
    for harmonics in (1, 3):
        curve = ss.forced_response(beam, omega, harmonics)
        errors = np.array([curve.error_estimate(dof) for dof in curve.dofs])
        # At most two in a row: an estimate costs less than two solutions close to their neighbours.
        found = carried_on(errors, 2)
        assert len(found) >= 7
        assert (np.array(found[2:]) - found[:-2] > 2).all()
        alone = [ss.forced_response(beam, omega[[i]], harmonics) for i in found]
        own = np.array([[one.error_estimate(dof)[0] for one in alone] for dof in curve.dofs])
        true = ss.forced_response(beam, omega[found], 61)
        missed = np.array([true.coefficients(dof) for dof in curve.dofs])
        missed[:, :, : harmonics + 1] -= [curve.coefficients(dof)[found] for dof in curve.dofs]
        # Where a second step sets in, its estimate is up to twice that of the point before; what is
        # less is not below the error.
        seen = errors[:, found] >= np.abs(missed).sum(axis=2)
        assert ((errors[:, found] / own > 0.45) | seen).all()
        assert (errors[:, found] / own).min() > 0.4
        assert (errors[:, found] / own).max() < 2.02


@pytest.mark.parametrize("harmonics", [1, 3])
def test_estimates_go_on_where_the_account_affords_none(harmonics: int) -> None:
    # Solutions of hardly nonlinear motions take one step, the least extended balance more.
    names = [f"x{i}" for i in range(6)]
    stiffness = 2e4 * np.eye(6) - 1e4 * np.eye(6, k=1) - 1e4 * np.eye(6, k=-1)
    chain = ss.Structure(np.eye(6), stiffness, ss.ModalDamping(1e-3), names)
    springs = [ss.Cubic(name, stiffness=1e6 * 4.0**i) for i, name in enumerate(names)]
    model = ss.Model(chain, springs, [ss.Force("x0", 1.0)])
    omega = ss.natural_frequencies(model)[0] * np.linspace(0.9, 1.0, 61)
    curve = ss.forced_response(model, omega, harmonics, stability=False)
    errors = np.array([curve.error_estimate(dof) for dof in curve.dofs])
    assert len(carried_on(errors, 2)) > 20


def test_automatic_harmonics_lean_on_the_points_beside() -> None:
    beam, omega = ss.reference.snecma_beam(20.313), np.linspace(200.0, 220.0, 41)
    curve = ss.forced_response(beam, omega, tolerance=1e-2)
    true = ss.forced_response(beam, omega, 121)
    errors = np.array([curve.error_estimate(dof) for dof in curve.dofs])
    same = (np.diff(curve.harmonics) == 0).mean()
    assert same > 0.8
    assert len(carried_on(errors, 2)) >= 10
    for dof in ("tip", "damper"):
        missed = true.coefficients(dof).copy()
        missed[:, : curve.harmonics.max() + 1] -= np.nan_to_num(curve.coefficients(dof))
        error, size = (np.abs(missed).sum(axis=1), np.abs(true.coefficients(dof)[:, 1]))
        assert (error <= 1e-2 * size).all()
        assert (error <= 5.0 * curve.error_estimate(dof)).all()


@pytest.mark.parametrize(("ratio", "go_on"), [(3e-2, True), (1e-4, False)])
def test_no_estimate_goes_on_where_a_discarded_harmonic_meets_a_narrow_mode(
    ratio: float, go_on: bool
) -> None:
    stiffness = 1e4 * np.array([[2.0, -1.0], [-1.0, 9.0]])
    structure = ss.Structure(np.eye(2), stiffness, ss.ModalDamping(ratio), ["a", "b"])
    model = ss.Model(
        structure, [ss.Jenkins("a", stiffness=1e3, slip_force=0.02)], [ss.Force("a", 1.0)]
    )
    # The second mode lies at the third harmonic, a step of which is 0.45 rad/s.
    middle = ss.natural_frequencies(model)[1] / 3.0
    omega = middle + 0.15 * (np.arange(16) - 11.5)
    frf = ss.forced_response(model, omega, 1)
    errors = np.array([frf.error_estimate(dof) for dof in frf.dofs])
    beside = {i for i in carried_on(errors) if i in (11, 12)}
    assert bool(beside) == go_on


@pytest.mark.parametrize("mistuned", [False, True])
def test_estimates_of_disks_go_on_where_no_nodal_diameter_resonates(mistuned: bool) -> None:
    ring = ss.reference.beam_ring(6, coupling=7e3, engine_order=1)
    disk = ring.mistuned(np.linspace(-0.02, 0.02, 6)) if mistuned else ring
    omega = np.linspace(186.0, 190.0, 81)
    curve = ss.forced_response(disk, omega, 1)
    errors = np.array([curve.error_estimate(dof) for dof in curve.dofs])
    found = carried_on(errors, 3 if mistuned else 1)
    assert len(found) >= 20
    alone = [ss.forced_response(disk, omega[[i]], 1) for i in found]
    own = np.array([[one.error_estimate(dof)[0] for one in alone] for dof in curve.dofs])
    assert (errors[:, found] / own).min() > 0.45
    # What falls is not followed down.
    assert (errors[:, found] / own).max() < 2.5


@pytest.mark.parametrize("mistuned", [False, True])
@pytest.mark.parametrize(("damping", "go_on"), [(30.0, True), (0.01, False)])
def test_no_estimate_of_a_disk_goes_on_where_another_nodal_diameter_resonates(
    damping: float, go_on: bool, mistuned: bool
) -> None:
    ring = ss.reference.beam_ring(6, coupling=7e3, engine_order=1)
    beam = ring.structure
    disk = ss.BladedDisk(
        ss.Structure(beam.mass, beam.stiffness, ss.Rayleigh(mass=damping), beam.dofs),
        sectors=6,
        couplings=ring.couplings,
        contacts=ring.contacts,
        forces=[ss.Force("tip", 300.0)],
        engine_order=1,
    )
    # The third harmonic of engine order 1 sees nodal diameter 3, a mode of which it meets here.
    middle = ss.natural_frequencies(disk, nodal_diameter=3)[0] / 3.0
    omega = middle + 0.15 * (np.arange(61) - 56.5)
    if mistuned:
        disk = disk.mistuned(np.zeros(6))
    frf = ss.forced_response(disk, omega, 1)
    errors = np.array([frf.error_estimate(dof) for dof in frf.dofs])
    assert (errors > 0.0).any(axis=0).all()
    found = carried_on(errors, 3 if mistuned else 1)
    assert len(found) >= 3
    assert bool({56, 57}.intersection(found)) == go_on


@pytest.mark.slow
def test_loaded_and_named_dofs_drive_automatic_harmonics_and_steps() -> None:
    blade = ss.reference.turbine_blade()
    structure = blade.structure
    # Modal coordinates under names that do not tell them.
    dofs = ["damper", "tip", *(f"q{i}" for i in range(1, 17))]
    renamed = ss.Structure(structure.mass, structure.stiffness, structure.damping, dofs)
    model = ss.Model(renamed, blade.contacts, [ss.Force("tip", 0.05)])
    span = (1508.0, 1747.0)
    default = ss.forced_response(model, span)
    assert default.dofs == tuple(dofs)
    named = ss.forced_response(model, span, observe=["damper", "tip"])
    # The effort of an estimate, and so its reach, depends a little on how much is observed.
    assert default.omega.size <= 1.1 * named.omega.size
    assert default.harmonics.sum() <= 1.1 * named.harmonics.sum()
    all_named = ss.forced_response(model, [1600.0, 1650.0], observe=dofs)
    outputs = ss.forced_response(model, [1600.0, 1650.0], outputs=dofs)
    assert (all_named.harmonics == outputs.harmonics).all()
    assert outputs.harmonics.max() > default.harmonics.max()
    with pytest.raises(ss.ModelError, match=r"outputs: unknown dof 'tpi'; did you mean 'tip'\?"):
        ss.forced_response(model, [1600.0], outputs="tpi")

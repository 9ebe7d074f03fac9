from types import SimpleNamespace

import numpy as np
import pytest

import stickslip as ss

# computed independently: exact orbits of the single mass; amplitude [m], frequency [rad/s]
MASS = {
    (0.1, "sticking"): (1.0310896e-5, 225.38065),
    (1.0, "sticking"): (1.0909294e-5, 224.01322),
    (3.0, "sticking"): (1.2959006e-5, 216.70029),
    (5.0, "sticking"): (1.9544597e-5, 197.41295),
    (0.1, "slipping"): (2.5423978e-3, 159.43172),
    (1.0, "slipping"): (2.4383235e-4, 160.51921),
    (3.0, "slipping"): (7.0556856e-5, 166.33920),
    (5.0, "slipping"): (2.8865970e-5, 183.15447),
}


@pytest.fixture(scope="module")
def mass():
    return ss.reference.flutter_mass()


@pytest.fixture(scope="module")
def whole(mass):
    model, negative = mass
    return ss.limit_cycles(model, negative_damping=negative)


@pytest.mark.parametrize(("method", "tolerance"), [("newton", 1e-5), ("exact", 1e-6)])
def test_ratios_are_met_on_both_sides(mass, method, tolerance):
    model, negative = mass
    ratios = [0.1, 1, 3, 5]
    lco = ss.limit_cycles(model, negative_damping=negative, ratio=ratios, method=method)
    assert lco.ratio.tolist() == [*ratios, *ratios[::-1]]
    assert lco.branch.tolist() == ["sticking"] * 4 + ["slipping"] * 4
    assert lco.stable.tolist() == [True] * 4 + [False] * 4
    for r, side, amplitude, omega in zip(
        lco.ratio, lco.branch, lco.amplitude("mass"), lco.omega, strict=True
    ):
        assert (amplitude, omega) == pytest.approx(MASS[r, side], rel=tolerance)
    assert lco.limit.ratio == pytest.approx(5.147991, rel=1e-6)
    assert lco.multipliers.shape == (8, 2)


@pytest.mark.slow
def test_a_whole_branch_turns_once(whole):
    assert whole.ratio[0] == whole.ratio[-1] == 0.01
    assert whole.limit == max(whole.folds)
    (change,) = whole.changes
    assert (change.kind, change.unstable_before, change.unstable_after) == ("fold", 0, 1)
    assert change.value == pytest.approx(5.147991, rel=1e-6)
    assert (np.diff(whole.omega) < 0).all()
    assert "1 stable" not in repr(whole)


def test_motion_starts_at_its_maximum_and_balances_energy(whole, mass):
    _, negative = mass
    for index in (5, -5):
        motion = whole.waveform("mass", index, 512)
        assert motion.argmax() in (0, 511)
        assert motion.max() == pytest.approx(whole.amplitude("mass")[index], rel=1e-4)
        series = whole.coefficients("mass")[index]
        orders = np.arange(series.size) * whole.omega[index]
        damping = whole.ratio[index] * negative[0, 0]
        power = 0.5 * damping * (np.abs(orders * series) ** 2).sum()
        work = power * 2.0 * np.pi / whole.omega[index]
        assert whole.dissipation(0)[index] == pytest.approx(-work, rel=1e-3)


def test_one_harmonic_is_the_closed_form(mass):
    model, negative = mass
    lco = ss.limit_cycles(model, negative, ratio=[1.0], harmonics=1, stability=False)
    forms = ss.single_harmonic_cycles(
        mass=944.6,
        damping=-7699.054,
        stiffness=2.4e7,
        contact_stiffness=2.4e7,
        slip_force=246.048,
    )
    for form, omega, amplitude in zip(forms, lco.omega, lco.amplitude("mass"), strict=True):
        assert form == pytest.approx((amplitude, omega), rel=1e-9)
    assert not lco.stable.any()
    none = ss.single_harmonic_cycles(
        mass=944.6,
        damping=-5.1425 * 7699.054,
        stiffness=2.4e7,
        contact_stiffness=2.4e7,
        slip_force=246.048,
    )
    assert none == ()


@pytest.mark.slow
def test_stiff_dampers_tend_to_the_rigid_limit(mass):
    model, negative = mass
    rigid = ss.rigid_limit_cycle(mass=944.6, damping=-7699.054, stiffness=2.4e7, slip_force=246.048)
    assert rigid.amplitude == pytest.approx(2.5533e-4, rel=1e-5)
    lco = ss.limit_cycles(
        model, negative, stiffness=[2.4e8, 2.4e10], method="exact", stability=False
    )
    assert lco.limit.value / 2.4e7 == pytest.approx(0.167108, rel=1e-5)
    assert lco.limit.ratio == 1.0
    amplitude = lco.amplitude("mass")
    assert amplitude == pytest.approx([1.02651e-8, 1.03923e-6, 2.54219e-4, 2.55319e-4], rel=1e-5)
    assert amplitude[-1] == pytest.approx(rigid.amplitude, rel=1e-4)
    one = ss.rigid_limit_cycle(
        mass=944.6, damping=-7699.054, stiffness=2.4e7, slip_force=246.048, single_harmonic=True
    )
    assert one.amplitude == pytest.approx(4 * 246.048 / (np.pi * 7699.054 * one.omega))


@pytest.mark.parametrize(
    "change", [{"mass": 1e-228, "stiffness": 1e281}, {"stiffness": 1e-125, "damping": -1e-283}]
)
def test_closed_forms_refuse_what_numbers_do_not_hold(change):
    values = {"mass": 1.0, "damping": -0.1, "stiffness": 1.0, "slip_force": 1.0} | change
    with pytest.raises(ss.ModelError, match="of too different size for numbers"):
        ss.rigid_limit_cycle(**values)
    with pytest.raises(ss.ModelError, match="of too different size for numbers"):
        ss.single_harmonic_cycles(**values, contact_stiffness=1e308)


def test_exact_orbits_go_on_in_time(mass):
    model, negative = mass
    lco = ss.limit_cycles(model, negative, ratio=[2.0], method="exact")
    run = ss.transient(lco.model_at(0), lco.omega[0], periods=5, start=lco.state(0))
    assert run.final.vector == pytest.approx(lco.state(0).vector, rel=1e-6, abs=1e-9)
    with pytest.raises(ss.ModelError, match="of exact orbits only"):
        ss.limit_cycles(model, negative, ratio=[2.0], harmonics=5).state(0)


def test_multipliers_are_those_of_the_motion_in_time():
    beam, negative = ss.reference.flutter_beam()
    lco = ss.limit_cycles(beam, negative, mode=1, method="exact", ratio=[1.49])
    model, start = lco.model_at(0), lco.state(0).vector
    moved = np.full(7, 1e-10)
    moved[3:6] = 1e-7

    def after(state):
        return ss.transient(model, lco.omega[0], 1, start=ss.State.of_vector(model, state)).final

    # The damper slips at t = 0, so that its force is no coordinate of the disturbance.
    assert abs(start[6]) == pytest.approx(246.048)
    matrix = np.zeros((7, 7))
    for column, step in enumerate(np.diag(moved)[:6]):
        ahead, behind = after(start + step).vector, after(start - step).vector
        matrix[:, column] = (ahead - behind) / (2.0 * moved[column])
    sizes = np.sort(np.abs(np.linalg.eigvals(matrix)))[::-1]
    assert sizes[0] == pytest.approx(1.0, abs=1e-6)
    assert sizes[1:] == pytest.approx(np.abs(lco.multipliers[0]), abs=1e-5)
    assert lco.stable[0]
    assert not lco.stable[-1]


@pytest.mark.slow
def test_one_negative_mode_has_one_pair_of_sides():
    for reading, limit in (("literal", 3.1186), ("ordered", 6.5158)):
        model, negative = ss.reference.flutter_beam(2, reading)
        lco = ss.limit_cycles(model, negative, mode=2, method="exact")
        assert lco.limit.ratio == pytest.approx(limit, rel=1e-4)
        assert len(lco.folds) == len(lco.changes) == 1
        # At the limit itself one multiplier is 1.
        away = np.abs(lco.omega - lco.limit.omega) > 1e-3
        assert lco.stable[away].tolist() == (lco.branch == "sticking")[away].tolist()


@pytest.mark.slow
def test_the_third_coefficient_on_the_first_mode():
    model, negative = ss.reference.flutter_beam(0, "first")
    lco = ss.limit_cycles(model, negative, method="exact", stability=False)
    assert lco.limit.ratio == pytest.approx(5.8357, rel=1e-4)


def test_damping_laws_serve_as_negative_damping(mass):
    model, _ = mass
    law = ss.Rayleigh(mass=-7.49, stiffness=-2.6e-5)
    lco = ss.limit_cycles(model, law, ratio=[1.0], stability=False)
    assert lco.omega[0] == pytest.approx(224.01322, rel=1e-6)


def test_the_forces_of_a_model_are_left_out(mass):
    model, negative = mass
    forced = model.replaced(forces=[ss.Force("mass", 100.0)])
    lco = ss.limit_cycles(forced, negative, ratio=[1.0], method="exact")
    assert lco.omega[0] == pytest.approx(224.01322, rel=1e-7)
    assert any("forces" in text for text in lco.assumptions)


@pytest.mark.slow
def test_a_damper_between_masses_and_damping_that_no_modes_share():
    structure = ss.Structure(
        mass=np.diag([1.0, 1.5, 0.8]),
        stiffness=[[300.0, -100.0, 0.0], [-100.0, 250.0, -80.0], [0.0, -80.0, 90.0]],
        damping=np.diag([0.05, 0.0, 0.02]),
        dofs=["a", "b", "c"],
    )
    model = ss.Model(
        structure,
        [
            ss.Jenkins("a", "b", stiffness=120.0, slip_force=0.7),
            ss.Jenkins("c", stiffness=60.0, slip_force=0.4),
        ],
    )
    negative = -np.array([[0.3, 0.1, 0.0], [0.02, 0.4, 0.05], [0.0, -0.1, 0.3]])
    balance = ss.limit_cycles(model, negative, ratio=[1.0], harmonics=63)
    exact = ss.limit_cycles(model, negative, ratio=[1.0], method="exact")
    assert balance.branch.tolist() == exact.branch.tolist() == ["sticking", "slipping"]
    for dof in "abc":
        assert balance.amplitude(dof) == pytest.approx(exact.amplitude(dof), rel=1e-4)
    assert balance.multipliers == pytest.approx(exact.multipliers, abs=1e-8)


def beams(springs, slip_forces):
    """SNECMA beams with dampers, joined by springs `(beam, beam, stiffness)` at the tips."""
    names = [str(number) for number in range(len(slip_forces))]
    free = ss.join({name: ss.reference.beams.snecma_structure() for name in names})
    stiff = np.array(free.stiffness)
    for first, second, spring in springs:
        ends = [free.index(f"{first}.tip"), free.index(f"{second}.tip")]
        stiff[np.ix_(ends, ends)] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    structure = ss.Structure(free.mass, stiff, None, free.dofs)
    dampers = [
        ss.Jenkins(f"{name}.damper", stiffness=2.4e7, slip_force=limit)
        for name, limit in zip(names, slip_forces, strict=True)
        if limit
    ]
    return ss.Model(structure, dampers), ss.reference.negative_damping(structure)


# exact: largest r by exact orbits; the balance has the error of its harmonics
@pytest.mark.slow
@pytest.mark.parametrize(
    ("springs", "slip_forces", "mode", "harmonics", "exact", "error"),
    [
        ([(0, 1, 5e3)], [246, 200], 0, 15, 4.893083, 0.08),
        ([(0, 1, 5e3)], [246, 200], 0, 31, 4.893083, 1e-3),
        ([(0, 1, 3.0862686e4)], [364.23651, 288.67139], 1, 11, 4.2014, 0.11),
        ([(0, 1, 8e4), (1, 2, 3.9e4)], [292.6, None, 92.9], 1, 15, 3.137285, 0.01),
    ],
)
def test_beams_with_different_dampers_are_followed(
    springs, slip_forces, mode, harmonics, exact, error
):
    branch = ss.limit_cycles(
        *beams(springs, slip_forces), mode=mode, harmonics=harmonics, stability=False
    )
    assert not any("Stalled" in text for text in branch.assumptions)
    assert branch.ratio[-1] == pytest.approx(0.01)
    assert branch.limit.ratio == pytest.approx(exact, rel=error)


@pytest.mark.parametrize("end", ["stalled", "returned"])
@pytest.mark.parametrize("method", ["newton", "exact"])
def test_a_branch_that_ends_early_says_what_has_not_been_tried(whole, end, method):
    from stickslip.analyses.cycle_assumptions import cycle_assumptions

    ends = SimpleNamespace(
        onset=(0.0, 225.4), phase_dof=0, jumps=0, ends=[("range", 0.01), (end, 3.08)]
    )
    settings = whole.settings.model_copy(update={"method": method})
    told = cycle_assumptions(whole.model, settings, whole.arrays, ends)
    (text,) = [one.text for one in told if one.severity == "failure"]
    assert f"method='{method}'" not in text
    assert ("more harmonics than the 31 kept" in text) == (method == "newton")
    assert "ratio = 3.08" in text


def test_a_wave_of_a_disk_satisfies_its_equations():
    beam, negative = ss.reference.flutter_beam()
    disk = ss.BladedDisk(
        beam.structure,
        sectors=6,
        couplings=[ss.Coupling("tip", stiffness=1e3)],
        contacts=[ss.Jenkins("damper", stiffness=2.4e7, slip_force=246.048)],
        forces=[],
        engine_order=2,
    )
    waves = np.array([(1.0 + 0.2 * np.cos(d) + 0.1j * np.sin(d)) * negative for d in range(6)])
    lco = ss.limit_cycles(disk, waves, ratio=[1.0], harmonics=9)
    assert lco.branch.tolist() == ["sticking", "slipping"]
    assert not lco.stable.any()
    rows = np.array([[1.0, 0.0, 0.0]])
    for index, omega in enumerate(lco.omega):
        for order in (1, 3, 5, 9):
            mass, damping, stiffness = disk.matrices_at(order)
            nu = order * omega
            total = damping + waves[2 * order % 6]
            dynamic = stiffness + 1j * nu * total - nu**2 * mass
            x = lco.arrays.displacement[index, order]
            force = rows.T @ lco.arrays.contact_force[index, order]
            scale = np.abs(lco.arrays.contact_force[index, 1]).max()
            assert np.abs(dynamic @ x + force).max() < 1e-7 * scale
    # Without coupling a wave is the beam by itself.
    alone = ss.BladedDisk(
        beam.structure, sectors=6, contacts=disk.contacts, forces=[], engine_order=2
    )
    one = ss.limit_cycles(alone, negative, ratio=[1.0], harmonics=9)
    other = ss.limit_cycles(beam, negative, ratio=[1.0], harmonics=9, stability=False)
    assert one.omega == pytest.approx(other.omega, rel=1e-9)
    with pytest.raises(ss.ModelError, match="travelling wave"):
        ss.limit_cycles(disk, waves, method="exact")


def test_a_map_over_the_stiffness(mass):
    model, negative = mass
    chart = ss.stability_map(model, negative, stiffness=[2.4e6, 2.4e7])
    assert chart.limit == pytest.approx([0.607654, 5.147991], rel=1e-5)
    assert chart.stable_limit == pytest.approx(chart.limit, rel=1e-5)
    chart.plot()
    with pytest.raises(ss.ModelError, match="exactly one"):
        ss.stability_map(model, negative)


@pytest.mark.slow
def test_results_are_saved_and_loaded(whole, mass, tmp_path):
    model, negative = mass
    chart = ss.stability_map(model, negative, slip_force=[100.0], harmonics=5, method="newton")
    by_stiffness = ss.limit_cycles(model, negative, stiffness=[1e8], ratio=0.5, harmonics=5)
    for result in (whole, chart, by_stiffness):
        result.save(tmp_path / "a.nc")
        again = ss.load(tmp_path / "a.nc")
        assert again.settings == result.settings
        assert again.assumptions == result.assumptions
        for name in result.arrays.table():
            ours, theirs = getattr(result.arrays, name), getattr(again.arrays, name)
            assert ours.dtype == theirs.dtype
            assert np.array_equal(ours, theirs, equal_nan=True)
        assert np.array_equal(again.negative_damping, result.negative_damping)
    data = whole.to_dataset()
    assert data["amplitude"].values[:, 0] == pytest.approx(whole.amplitude("mass"))


def test_pictures(whole):
    axes = whole.plot("mass", length_unit="um")
    solid, dashed = (
        [line for line in axes.lines if line.get_linestyle() == style and len(line.get_xdata()) > 2]
        for style in ("-", "--")
    )
    assert solid[0].get_xdata()[-1] == pytest.approx(whole.limit.ratio, rel=1e-6)
    assert dashed[0].get_ydata().min() > solid[0].get_ydata().min()
    assert whole.plot_multipliers().collections
    with pytest.raises(ss.ModelError, match="not a LimitCycles"):
        ss.plot.limit_cycles(3, "mass")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"negative_damping": [[1.0, 0.0]]}, "negative_damping"),
        ({"negative_damping": [[0.0]]}, "all zero"),
        ({"negative_damping": [[7699.0]]}, "mind the sign"),
        ({"negative_damping": [[np.nan]]}, "negative_damping"),
        ({"mode": 1}, "modes 0 to 0"),
        ({"mode": -1}, "mode"),
        ({"ratio": [0.0]}, r"ratio\[0\]"),
        ({"ratio": (2.0, 1.0, 3.0), "stiffness": (1e6, 1e8)}, "ratio"),
        ({"ratio": 50.0, "stiffness": (1e6, 1e8)}, "limit cycles up to"),
        ({"stiffness": (1e6, 1e8), "slip_force": (1.0, 2.0)}, "follow one of them"),
        ({"contacts": [0]}, "no parameter of contacts"),
        ({"method": "broyden"}, "method"),
        ({"harmonics": 0}, "harmonics"),
        ({"harmonics": "many"}, "harmonics"),
        ({"stability": 3}, "stability"),
        ({"max_points": 1}, "max_points"),
        ({"tolerance": 2.0}, "tolerance"),
    ],
)
def test_bad_input_is_refused(mass, change, message):
    model, negative = mass
    with pytest.raises(ss.ModelError, match=message):
        ss.limit_cycles(model, **{"negative_damping": negative, **change})


def test_a_model_without_friction_is_refused(mass):
    model, negative = mass
    with pytest.raises(ss.ModelError, match="without friction"):
        ss.limit_cycles(model.replaced(contacts=[]), negative)


def test_ctrl_c_keeps_what_is_done(mass):
    beam, negative = ss.reference.flutter_beam()

    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted) as caught:
        ss.limit_cycles(beam, negative, method="exact", progress=stop)
    assert caught.value.result.interrupted


def test_sliders_in_parallel_are_contacts_of_their_own() -> None:
    """Sliders of unequal limits: all stick below the onset of the first, and dissipate nothing."""
    body = ss.Structure([[1.0]], [[3e4]], ss.ModalDamping(0.003), ["x"])
    limits, softer = (0.3, 1.0), ss.Rayleigh(mass=-2.0)
    together = ss.ParallelJenkins("x", stiffness=[2e3, 2e3], slip_forces=limits)
    apart = [ss.Jenkins("x", stiffness=2e3, slip_force=limit) for limit in limits]
    found = [
        ss.limit_cycles(ss.Model(body, contacts), softer, ratio=[0.7, 1.0], harmonics=5)
        for contacts in ([together], apart)
    ]
    for one in found:
        assert one.branch.tolist() == 2 * ["sticking"] + 2 * ["slipping"]
        assert one.stability.tolist() == 2 * ["stable"] + 2 * ["unstable"]
    np.testing.assert_allclose(found[0].amplitude("x"), found[1].amplitude("x"), rtol=1e-9)
    start = ss.destabilised(ss.Model(body, [together]), softer, 1.0)
    settled = ss.classify(start, {"x": 1e-4})
    assert settled.motion == "settled"
    assert settled.amplitude("x") == pytest.approx(found[0].amplitude("x")[1], rel=1e-3)

"""The reference systems have the published matrices and frequencies."""

import inspect

import numpy as np
import pytest
import scipy.linalg

from stickslip import reference
from stickslip.errors import ModelError
from stickslip.model import Model, natural_frequencies


def frequencies(model: Model, *, stuck: bool) -> np.ndarray:
    """Solve the eigenproblem with SciPy, apart from the core."""
    stiffness = model.structure.stiffness.copy()
    for contact in model.contacts if stuck else ():
        rows = contact.rows(model.structure)
        stiffness += contact.stiffness * rows.T @ rows
    return np.sqrt(scipy.linalg.eigvalsh(stiffness, model.structure.mass))


# Each to its last printed digit: rad/s, computed independently; of the RubBeR beam, Hz, published.
# Its first stuck frequency is printed as 80.368; computed 80.36748.
PUBLISHED = [
    (reference.snecma_beam, False, 1.0, [159.5927, 901.7589, 2167.5410], 5.01e-5),
    (reference.snecma_beam, True, 1.0, [225.6623, 1404.3759, 3273.7922], 5.01e-5),
    (reference.single_dof, False, 1.0, [159.3976], 5.01e-5),
    (reference.single_dof, True, 1.0, [225.4222], 5.01e-5),
    (reference.beam_pair, False, 1.0, np.repeat([159.5927, 901.7589, 2167.5410], 2), 5.01e-5),
    (reference.rubber_beam, False, 2 * np.pi, [67.960, 425.903, 1192.611], 5.01e-4),
    (reference.rubber_beam, True, 2 * np.pi, [80.367, 452.785, 1204.175], 5.01e-4),
]


@pytest.mark.parametrize(("system", "stuck", "unit", "published", "digit"), PUBLISHED)
def test_frequencies_as_published(system, stuck, unit, published, digit):
    found = frequencies(system(), stuck=stuck)[: len(published)] / unit
    np.testing.assert_allclose(found, published, rtol=0.0, atol=digit)


@pytest.mark.parametrize("system", [reference.beam_pair, reference.rubber_beam])
def test_core_finds_the_same_frequencies(system):
    model = system()
    slipping = range(len(model.contacts))
    for points, stuck in (([], True), (slipping, False)):
        np.testing.assert_allclose(
            natural_frequencies(model, points), frequencies(model, stuck=stuck), rtol=1e-7
        )


def test_snecma_beam_is_eq_2_32():
    model = reference.snecma_beam()
    structure, (contact,), (force,) = model.structure, model.contacts, model.forces
    assert structure.dofs == ("damper", "tip", "mode")
    assert structure.mass[0, 0] == 6.67959
    np.testing.assert_allclose(
        structure.damping, 7.49 * structure.mass + 2.6e-5 * structure.stiffness, rtol=1e-15
    )
    assert (contact.dofs, contact.stiffness, contact.slip_force) == (("damper",), 2.4e7, 246.048)
    assert (force.dof, force.coefficient, force.harmonic) == ("tip", 20.313, 1)
    assert reference.snecma_beam(38.438).forces[0].amplitude == 38.438


def test_loads_of_table_2_3():
    assert reference.SNECMA_LOADS == (0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438)


def test_single_dof_is_table_2_2():
    model = reference.single_dof(0.5)
    assert model.structure.mass.item() == 944.6
    assert model.structure.damping.item() == 7700.0
    assert model.structure.stiffness.item() == 2.4e7
    assert model.forces[0].amplitude == 0.5 * 246.048


def test_beam_pair_rubs_at_its_tips():
    model = reference.beam_pair(10.0, phase=0.5, stiffness=2e6, slip_force=40.0)
    assert model.contact_names == ("damper-1", "damper-2", "tips")
    assert model.contacts[2].dofs == ("1.tip", "2.tip")
    assert model.contacts[2].parameters() == {"stiffness": 2e6, "slip_force": 40.0}
    assert [force.amplitude for force in model.forces] == [10.0, 10.0]
    assert [force.phase for force in model.forces] == [0.0, 0.5]
    np.testing.assert_array_equal(
        model.structure.mass[3:, 3:], reference.snecma_beam().structure.mass
    )
    assert not model.structure.stiffness[:3, 3:].any()


def test_rubber_beam_is_clamped_and_static_deflection_is_exact():
    # Cubic elements are exact at their nodes under nodal loads: P L^3 / (3 E I).
    structure = reference.rubber_beam().structure
    assert structure.dofs[:2] == ("w2", "slope2")
    assert structure.dofs[-2:] == ("w15", "slope15")
    load = np.zeros(28)
    load[structure.index("w15")] = 1.0
    deflection = np.linalg.solve(structure.stiffness, load)[structure.index("w15")]
    inertia = 0.06 * 0.05**3 / 12
    assert deflection == pytest.approx(0.71**3 / (3 * 210e9 * 0.6725 * inertia), rel=1e-8)


def test_rubber_beam_takes_its_damping():
    assert not reference.rubber_beam(damping_ratio=0.0).structure.damping.any()


def test_reference_refuses_what_its_parts_refuse():
    with pytest.raises(ModelError, match="force at 'tip': amplitude: nan"):
        reference.snecma_beam(float("nan"))
    with pytest.raises(ModelError, match="stiffness -1 is negative"):
        reference.beam_pair(stiffness=-1.0)


def test_all_systems_are_models_of_defaults():
    systems = [name for name in reference.__all__ if name.islower() and name[-9:] != "structure"]
    for name in systems:
        system = getattr(reference, name)
        assert inspect.getdoc(system)
        if name == "negative_damping":
            continue
        made = system()
        # Systems of chapter V come with their negative damping.
        model = made[0] if name.startswith("flutter") else made
        assert isinstance(model, Model)

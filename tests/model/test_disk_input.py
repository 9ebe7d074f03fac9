"""Disks that cannot be, refused in one line."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.disk import BladedDisk, Interface

BEAM = ss.reference.snecma_structure()
DAMPER = ss.Jenkins("damper", stiffness=1.0, slip_force=1.0)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: BladedDisk(BEAM, 1, engine_order=2), "sectors: 1 lies below 2"),
        (lambda: BladedDisk(BEAM, 4.0, engine_order=2), "sectors: 4.0 is not an integer"),
        (lambda: BladedDisk(BEAM, 4, engine_order=-1), "engine_order: -1 lies below 0"),
        (lambda: BladedDisk("beam", 4, engine_order=1), "structure: 'beam' is not a Structure"),
        (
            lambda: BladedDisk(BEAM, 4, [DAMPER], engine_order=1),
            r"coupling 1: Jenkins\(.* is no coupling; give a Coupling",
        ),
        (
            lambda: BladedDisk(BEAM, 4, [ss.Coupling("tpi", stiffness=1.0)], engine_order=1),
            "coupling 1: unknown dof 'tpi'; did you mean 'tip'",
        ),
        (
            lambda: BladedDisk(
                BEAM, 4, [ss.Coupling("tip", "next.tip", stiffness=1.0)], engine_order=1
            ),
            "coupling 1: 'next.tip': its second end is in the next sector anyway; write 'tip'",
        ),
        (
            lambda: BladedDisk(
                BEAM,
                4,
                contacts=[ss.Jenkins("tip", "next.tpi", stiffness=1.0, slip_force=1.0)],
                engine_order=1,
            ),
            r"contact 1 \('jenkins'\): unknown dof 'next.tpi'; did you mean 'next.tip'",
        ),
        (
            lambda: BladedDisk(
                BEAM,
                4,
                contacts=[ss.Jenkins("next.tip", stiffness=1.0, slip_force=1.0)],
                engine_order=1,
            ),
            "it touches the next sector only; write 'tip'",
        ),
        (
            lambda: BladedDisk(BEAM, 4, forces=[ss.Force("next.tip", 1.0)], engine_order=1),
            "force 1: 'next.tip': forces are those on sector 0, .* write 'tip'",
        ),
        (
            lambda: BladedDisk(
                ss.Structure([[1.0]], [[1.0]], dofs=["next.tip"]), 4, engine_order=1
            ),
            "structure: dof 'next.tip': names in 'next.' are those of the next sector",
        ),
        (
            lambda: BladedDisk(BEAM, 4, engine_order=1, engine_orders=3),
            "orders: 3 is no map",
        ),
        (
            lambda: BladedDisk(BEAM, 4, engine_order=1, engine_orders={0: 1}),
            "engine_orders: harmonic: 0 lies below 1",
        ),
        (lambda: BladedDisk(BEAM, 4, engine_order=1, interface=np.eye(3)), "is no Interface"),
        (
            lambda: BladedDisk(BEAM, 4, engine_order=1, interface=Interface(np.eye(2))),
            "interface: 2 x 2 for a sector of 3 dofs",
        ),
        (lambda: ss.Coupling("tip", stiffness=-1.0), "coupling at 'tip': stiffness -1 is negative"),
        (lambda: ss.Coupling("tip", stiffness=1.0, damping=np.nan), "damping: nan is not a finite"),
        (lambda: Interface(np.ones((2, 3))), "interface: stiffness: 2 x 3 is not square"),
        (lambda: Interface(np.eye(2), mass=np.eye(3)), "interface: mass: 3 x 3, but the stiffness"),
        (lambda: Interface(np.array([[np.inf]])), r"interface: stiffness: inf at \(0, 0\)"),
        (lambda: ss.cyclic_sector(BEAM, {}), "boundary: {} names no pairs"),
        (lambda: ss.cyclic_sector(BEAM, {"tip": "tpi"}), "boundary: unknown dof 'tpi'"),
        (lambda: ss.cyclic_sector(BEAM, {"tip": "tip"}), "boundary: 'tip' stands at both cuts"),
        (
            lambda: ss.cyclic_sector(BEAM, {"tip": "mode", "damper": "mode"}),
            "boundary: 'mode' is given twice",
        ),
        (
            lambda: ss.natural_frequencies(ss.reference.beam_ring(), nodal_diameter=36),
            "nodal_diameter: 36; 36 sectors have 0 to 18",
        ),
        (
            lambda: ss.natural_frequencies(ss.reference.snecma_beam(), nodal_diameter=1),
            "nodal_diameter: 1 of a model without sectors",
        ),
        (lambda: ss.reference.beam_ring(sectors=8).seen_from(8), "sector: 8; there are 8, 0 to 7"),
        (
            lambda: ss.forced_response(ss.reference.snecma_beam(), [200.0], 1).sector(1),
            "sector: the model has no equal sectors",
        ),
    ],
)
def test_bad_disks_are_refused_in_one_line(build, message):
    with pytest.raises(ss.ModelError, match=message) as refusal:
        build()
    assert "\n" not in str(refusal.value)


def test_deviations_of_frequencies_become_those_of_the_stiffness():
    """A blade by itself has the frequency that was measured."""
    blade = ss.Structure([[2.0]], [[800.0]], dofs=["tip"])
    disk = ss.BladedDisk(blade, sectors=3, engine_order=1, forces=[ss.Force("tip", 1.0)])
    measured = np.array([0.03, 0.0, -0.02])
    found = ss.natural_frequencies(disk.mistuned(ss.frequency_pattern(measured)))
    np.testing.assert_allclose(found, np.sort(20.0 * (1.0 + measured)), rtol=1e-12)
    assert ss.frequency_pattern([[0.01] * 3] * 4).shape == (4, 3)


@pytest.mark.parametrize(
    ("deviations", "said"),
    [
        ([0.01, 2.0], r"deviations\[1\] is 2; give \(f - f0\) / f0, 0.02 for 2 %"),
        ([[0.0, np.nan]], r"deviations\[0\]\[1\] is nan"),
        ([-1.0], r"deviations\[0\] is -1"),
        (["wide"], "holds no real numbers"),
    ],
)
def test_other_deviations_of_frequencies_are_refused(deviations, said):
    with pytest.raises(ss.ModelError, match=said):
        ss.frequency_pattern(deviations)


def test_deviations_may_be_texts_with_a_unit_as_in_study_files():
    disk = ss.reference.beam_ring(sectors=3)
    given = ["1 %", 0.02, "-3 %"]
    for keyword in ("pattern", "mass"):
        said, plain = (
            disk.mistuned(**{keyword: values}) for values in (given, [0.01, 0.02, -0.03])
        )
        assert (said.structure.stiffness == plain.structure.stiffness).all()
        assert (said.structure.mass == plain.structure.mass).all()
    assert (disk.mistuned("1 %").structure.mass == disk.mistuned(0.01).structure.mass).all()
    assert (ss.frequency_pattern(given) == ss.frequency_pattern([0.01, 0.02, -0.03])).all()
    with pytest.raises(ss.ModelError, match=r"pattern\[1\] = '2 N' is not a ratio"):
        disk.mistuned(["1 %", "2 N", 0.0])

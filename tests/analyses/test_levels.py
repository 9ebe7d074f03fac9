"""Levels multiply the forces that vary; static loads stay as they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.results.status import Status


def loaded_blade() -> dict[str, Any]:
    """Return a blade on a friction pad, which static loads press and pull at."""
    stiffness = [[2e4, -1e4], [-1e4, 2.2e4]]
    damping = ss.ModalDamping(0.005)
    pad = ss.Coulomb(
        ["pad", "up"],
        normal=[0.0, -1.0],
        friction=0.4,
        tangential_stiffness=2e4,
        normal_stiffness=2e4,
        preload=2.0,
    )
    static = [ss.Force("up", 3.0, harmonic=0), ss.Force("pad", 1.0, harmonic=0)]
    return {
        "structure": ss.Structure(np.eye(2), stiffness, damping=damping, dofs=["pad", "up"]),
        "contacts": [pad],
        "forces": [ss.Force("pad", 2.0), *static],
    }


def loaded_disk() -> ss.BladedDisk:
    """Return three such blades in a row."""
    blade = loaded_blade()
    links = [ss.Coupling("pad", stiffness=500.0)]
    return ss.BladedDisk(
        blade["structure"], 3, links, blade["contacts"], blade["forces"], engine_order=1
    )


@pytest.mark.parametrize(
    ("model", "dof"),
    [
        (ss.Model(**loaded_blade()), "pad"),
        (loaded_disk(), "pad"),
        (loaded_disk().mistuned([0.02, -0.01, 0.0]), "1.pad"),
    ],
    ids=["blade", "wave", "ring"],
)
def test_static_loads_stay_at_every_level(model: ss.Model, dof: str) -> None:
    levels, span = np.array([0.5, 1.0, 3.0]), (80.0, 180.0)
    curve = ss.damper_curve(model, level=levels, dof=dof, omega=span, harmonics=5)
    assert set(curve.status) == {Status.CONVERGED}
    for level, omega, peak, slope in zip(
        levels, curve.omega, curve.amplitude, curve.sensitivity, strict=True
    ):

        def response(factor: float) -> ss.ForcedResponse:
            return ss.forced_response(model.scaled(force=level * factor), [omega], 5)  # noqa: B023

        below, above = (response(factor).amplitude(dof)[0] for factor in (1 - 1e-5, 1 + 1e-5))
        assert response(1.0).amplitude(dof)[0] == pytest.approx(peak, rel=1e-8)
        assert slope == pytest.approx((above - below) / (2e-5 * level), rel=1e-4)
        by_level = response(1.0).sensitivity(dof, parameter="level")[0]
        assert by_level == pytest.approx((above - below) / 2e-5, rel=1e-6)

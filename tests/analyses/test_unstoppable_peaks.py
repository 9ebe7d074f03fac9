"""Searches for peaks that are stopped while a step of a law, as a factorisation, asks nobody."""

import numpy as np
import pytest

import stickslip as ss
from slow_law import Slow

VALUES = np.geomspace(0.1, 10.0, 30)
SOUGHT = {"dof": "x", "omega": (60.0, 140.0), "harmonics": 3}


class Spring(Slow):
    """One that leaves the motion unique."""

    monotone = True


def model():
    body = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.01), ["x"])
    pad = ss.Jenkins("x", stiffness=1e3, slip_force=1.0)
    return ss.Model(body, [pad, Spring(["x"])], [ss.Force("x", 1.0)])


ANALYSES = {
    "curve": lambda press: ss.damper_curve(
        model(), slip_force=VALUES, contacts="jenkins", **SOUGHT, progress=press
    ),
    "optimum": lambda press: ss.optimal_damper(
        model(), contacts="jenkins", bounds=(0.1, 10.0), **SOUGHT, progress=press
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ANALYSES)
def test_peaks_that_were_found_are_kept(name, monkeypatch):
    def press(share):
        if share > 0.1:
            monkeypatch.setattr(Slow, "pause", 5.0)
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted, match=r"interrupted after \d+ ") as caught:
        ANALYSES[name](press)
    curve = caught.value.result
    found = np.isfinite(curve.amplitude)
    assert curve.interrupted
    assert 3 <= found.sum() < 30
    kept = curve.values[found]
    monkeypatch.setattr(Slow, "pause", 0.0)
    whole = ss.damper_curve(model(), slip_force=kept, contacts="jenkins", **SOUGHT)
    np.testing.assert_allclose(curve.amplitude[found], whole.amplitude, rtol=1e-6)

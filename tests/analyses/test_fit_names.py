"""What fits say of tests with one name, of values at a bound of zero, and of other noise."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

import stickslip as ss

OMEGA = np.linspace(80.0, 140.0, 9)
KEYS = {"harmonics": 3, "starts": 1}


def pad(damping: ss.Rayleigh | None) -> ss.Model:
    structure = ss.Structure([[1.0]], [[1e4]], damping, ["tip"])
    contact = ss.Jenkins("tip", stiffness=4000.0, slip_force=1.0)
    return ss.Model(structure, [contact], [ss.Force("tip", 1.0)])


def measured(noise: float, name: str | None = "bench") -> ss.Measurement:
    """The pad without viscous damping, by amplitudes that are 2 % too high."""
    seen = 1.02 * ss.forced_response(pad(None), OMEGA, 3).amplitude("tip")
    return ss.Measurement(OMEGA, "tip", seen, relative_noise=noise, name=name)


@pytest.fixture(scope="module")
def undamped() -> ss.Fit:
    bounds = {"damping.mass": (0.0, 10.0)}
    return ss.fit(pad(ss.Rayleigh(mass=1.0)), [measured(0.02)], parameters=bounds, **KEYS)


def test_a_value_at_a_bound_of_zero_is_told(undamped):
    assert 0.0 <= undamped.values["damping.mass"] < 1e-5
    told = {one.code: one.data for one in undamped.diagnostics}
    assert told["at-bound"]["bound"] == 0.0


def test_fits_with_other_noise_are_not_compared(undamped):
    bounds = {"damping.mass": (0.0, 10.0)}
    other = ss.fit(pad(ss.Rayleigh(mass=1.0)), [measured(0.2)], parameters=bounds, **KEYS)
    with pytest.raises(ss.ModelError, match="'b' was fitted to other numbers, or with other noise"):
        ss.compare_fits({"a": undamped, "b": other})
    assert ss.compare_fits({"a": undamped, "b": undamped}).weights["b"] == 0.5


def test_tests_of_one_name_are_told_apart_by_their_numbers():
    tests = [measured(0.02), measured(0.02, "rig"), measured(0.02), measured(0.02, None)]
    bounds = {"stiffness": (1e3, 1e4)}
    found = ss.fit(pad(None), tests, parameters=bounds, intervals="covariance", **KEYS)
    assert found.names == ("1: bench", "rig", "3: bench", "4: tip")
    assert np.flatnonzero(found.of_test("3: bench")).tolist() == [*range(18, 27)]


def test_no_line_leads_to_numbers_that_were_not_found(undamped):
    arrays = undamped.arrays
    solved = np.arange(OMEGA.size) != 4
    values = {name: getattr(arrays, name) for name in arrays.table()}
    broken = type(arrays)(**values | {"solved": solved, "predicted": arrays.predicted * solved})
    keys = {one.name: getattr(undamped, one.name) for one in fields(undamped)}
    line = type(undamped)(**keys | {"arrays": broken}).plot().lines[1]
    assert np.isnan(line.get_ydata()).tolist() == (~solved).tolist()


def test_a_loop_drawn_closed_is_one_period():
    angle = 2.0 * np.pi * np.arange(16) / 16
    u, f = np.cos(angle) + 0.2 * np.sin(2.0 * angle), np.sin(angle)
    one = ss.MeasuredLoop("pad", u, f)
    closed = ss.MeasuredLoop("pad", np.append(u, u[0]), np.append(f, f[0]))
    assert closed.force.size == 16
    np.testing.assert_array_equal(closed.series, one.series)
    assert ss.MeasuredLoop("pad", np.append(u, u[0]), np.append(f, f[0] + 0.1)).force.size == 17

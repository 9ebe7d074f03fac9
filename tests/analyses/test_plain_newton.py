"""Nonlinear modes through lift-off against a march of our own, solved by Newton's method alone."""

import numpy as np
import pytest

import stickslip as ss
from joints import wedge

ORDERS, SAMPLES = 3, 512
STATIC, STIFFNESS, FRICTION = 240.0, 3e5, 0.6


def marched(displacement, rest):
    """Return tangential and normal forces of periodic paths (N, 4, ...), begun without traction."""
    slider = np.zeros((2, *displacement.shape[2:])) + rest[:, np.newaxis]
    force = np.zeros_like(displacement)
    for instant in list(range(SAMPLES)) * 2:
        tangential, normal = displacement[instant, 0::2], displacement[instant, 1::2]
        pressed = np.maximum(STIFFNESS * normal, 0.0)
        tried = STIFFNESS * (tangential - slider)
        held = np.clip(tried, -FRICTION * pressed, FRICTION * pressed)
        slider = np.where(held == tried, slider, tangential - held / STIFFNESS)
        force[instant, 0::2], force[instant, 1::2] = held, pressed
    return force


class Balance:
    """The equations of a mode at an amplitude; many points at once, in columns."""

    def __init__(self, model, mode):
        own = model.structure
        self.mass, self.damping, self.stiffness = own.mass, own.damping, own.stiffness
        self.rows = np.vstack([contact.rows(own) for contact in model.contacts])
        stuck = self.stiffness + STIFFNESS * self.rows.T @ self.rows
        load = np.zeros(6)
        load[5] = STATIC
        self.load, still = load, np.linalg.solve(stuck, load)
        self.rest = (self.rows @ still)[0::2]
        root = np.diag(np.diag(self.mass) ** -0.5)
        squares, shapes = np.linalg.eigh(root @ stuck @ root)
        self.unit, self.shape = np.sqrt(squares[mode]), root @ shapes[:, mode]
        ratio = self.shape @ self.damping @ self.shape / (2.0 * self.unit)
        self.start = np.concatenate(
            [still, self.shape, np.zeros(12 * ORDERS - 6), [self.unit, ratio]]
        )
        angles = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
        self.waves = np.exp(1j * np.outer(angles, np.arange(ORDERS + 1)))

    def __call__(self, z, amplitude):
        series = np.empty((ORDERS + 1, 6, z.shape[1]), np.complex128)
        parts = z[6:-2].reshape(ORDERS, 2, 6, -1)
        series[0], series[1:] = z[:6], amplitude * (parts[:, 0] + 1j * parts[:, 1])
        omega, ratio = z[-2:]
        paths = np.einsum("tk,knb,cn->tcb", self.waves, series, self.rows).real
        forces = np.fft.rfft(marched(paths, self.rest), axis=0)[: ORDERS + 1] / SAMPLES
        forces[1:] *= 2.0
        out = [(self.stiffness @ series[0] + self.rows.T @ forces[0] - self.load[:, None]) / STATIC]
        for k in range(1, ORDERS + 1):
            x = series[k]
            row = self.stiffness @ x - (k * omega) ** 2 * (self.mass @ x)
            row = row + 1j * k * omega * (self.damping @ x - 2.0 * ratio * omega * (self.mass @ x))
            row = (row + self.rows.T @ forces[k]) / (amplitude * self.unit)
            out += [row.real, row.imag]
        first = series[1] / amplitude
        size = np.einsum("nb,nm,mb->b", first.conj(), self.mass, first).real - 1.0
        phase = (self.shape @ self.mass @ first).imag
        return np.vstack([*out, size, phase]).real

    def solve(self, z, amplitude):
        """Return the point by Newton's method from another one, or nothing."""
        step = 1e-7 * np.maximum(np.abs(z), np.where(np.arange(z.size) < 6, 1e-6, 1e-3))
        for _ in range(30):
            residual = self(z[:, None], amplitude)
            if np.abs(residual).max() < 1e-8:
                return z
            moved = self(z[:, None] + np.diag(step), amplitude)
            z = z - np.linalg.solve((moved - residual) / step, residual[:, 0])
        return None


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.slow
def test_a_mode_goes_through_lift_off_where_plain_newton_ends(mode):
    model, amplitudes = wedge(), 10.0 ** np.linspace(-4.0, 0.0, 9)
    ours = ss.nonlinear_modes(
        model, mode=mode, amplitude=amplitudes, harmonics=ORDERS, residual="centred"
    )
    assert all(status.solved for status in ours.status)
    assert ours.arrays.residual.max() < 1e-6
    balance, reached = Balance(model, mode), []
    z = balance.start
    for index, amplitude in enumerate(amplitudes):
        found = balance.solve(z, amplitude)
        if found is None:
            break
        z = found
        reached.append((ours.omega[index] / z[-2], ours.damping_ratio[index] / z[-1]))
    assert 4 < len(reached) < amplitudes.size
    # The march is of first order where a contact opens, and knows another past where one sticks.
    np.testing.assert_allclose(reached, 1.0, rtol=0.03)
    np.testing.assert_allclose(np.median(reached, axis=0), 1.0, rtol=1e-3)

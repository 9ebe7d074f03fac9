"""Masses with stops and cubic springs, by means of their own: balance and arclength.

Nothing here calls the package but `Sprung.model`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq

import stickslip as ss


@dataclass
class Sprung:
    """A structure with springs: ("stop", row, k, gap) or ("cubic", row, k), under cos(omega t)."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    springs: list = field(default_factory=list)

    @property
    def size(self):
        return len(self.load)

    def model(self):
        names = [f"x{i}" for i in range(self.size)]
        structure = ss.Structure(self.mass, self.stiffness, damping=self.damping, dofs=names)
        contacts = []
        for kind, (one, other), *values in self.springs:
            ends = (names[one],) if other is None else (names[one], names[other])
            if kind == "stop":
                contacts.append(ss.Stop(*ends, stiffness=values[0], gap=values[1]))
            else:
                contacts.append(ss.Cubic(*ends, stiffness=values[0]))
        forces = [
            ss.Force(name, amplitude=amplitude)
            for name, amplitude in zip(names, self.load, strict=True)
            if amplitude
        ]
        return ss.Model(structure, contacts, forces)

    def row(self, ends):
        row = np.zeros(self.size)
        row[ends[0]] = 1.0
        if ends[1] is not None:
            row[ends[1]] = -1.0
        return row


class Balance:
    """Harmonic balance of all displacements, by quadrature: unknowns (N, 2H+1) and omega."""

    def __init__(self, system, harmonics):
        self.system, self.harmonics = system, harmonics
        self.k = np.arange(1, harmonics + 1)
        self.orders = np.concatenate([[0], np.repeat(self.k, 2)])
        self.even = 2.0 * np.pi * np.arange(4 * harmonics + 2) / (4 * harmonics + 2)
        self.grid = 2.0 * np.pi * np.arange(40 * harmonics) / (40 * harmonics)
        self.nodes, self.weights = np.polynomial.legendre.leggauss(80)

    def basis(self, theta):
        angles = np.outer(np.atleast_1d(theta), self.k)
        waves = np.stack([np.cos(angles), np.sin(angles)], axis=2).reshape(len(angles), -1)
        return np.concatenate([np.ones((len(angles), 1)), waves], axis=1)

    def closed(self, series, gap):
        """Return the intervals in which a stop is closed, their ends to rounding."""

        def depth(theta):
            return float((self.basis(theta) @ series)[0]) - gap

        values = self.basis(self.grid) @ series - gap
        if (values > 0.0).all():
            return [(0.0, 2.0 * np.pi)]
        start = int(np.argmax(values <= 0.0))
        angles = np.append(self.grid[start:], self.grid[: start + 1] + 2.0 * np.pi)
        values = np.append(values[start:], values[: start + 1])
        at = np.flatnonzero((values[1:] > 0.0) != (values[:-1] > 0.0))
        ends = [brentq(depth, angles[i], angles[i + 1], xtol=1e-14) for i in at]
        return list(zip(ends[::2], ends[1::2], strict=True))

    def spring(self, kind, series, values):
        """Return the series of the force of a spring and its derivative in that of its length."""
        if kind == "cubic":
            basis = self.basis(self.even)
            back = basis.T * 2.0 / self.even.size
            u = basis @ series
            force, slope = values[0] * u**3, 3.0 * values[0] * u**2
        else:
            parts = self.closed(series, values[1])
            nodes = [0.5 * (a + b) + 0.5 * (b - a) * self.nodes for a, b in parts]
            weights = [0.5 * (b - a) * self.weights for a, b in parts]
            if not nodes:
                return np.zeros(series.size), np.zeros((series.size, series.size))
            basis = self.basis(np.concatenate(nodes))
            back = basis.T * np.concatenate(weights) / np.pi
            force = values[0] * (basis @ series - values[1])
            slope = np.full(force.size, values[0])
        back[0] *= 0.5
        return back @ force, (back * slope) @ basis

    def residual(self, z, *, slope=True):
        s, slots = self.system, self.orders.size
        x, omega = z[:-1].reshape(s.size, slots), z[-1]
        rate = np.zeros((slots, slots))  # d/dtheta
        for j in range(1, slots, 2):
            rate[j, j + 1], rate[j + 1, j] = self.orders[j], -self.orders[j]
        square = rate @ rate
        r = s.mass @ x @ square.T * omega**2 + s.damping @ x @ rate.T * omega + s.stiffness @ x
        springs = [(s.row(ends), kind, values) for kind, ends, *values in s.springs]
        springs = [(row, *self.spring(kind, row @ x, values)) for row, kind, values in springs]
        for row, force, _ in springs:
            r += np.outer(row, force)
        r[:, 1] -= s.load
        if not slope:
            return r.ravel()
        linear = (
            np.kron(s.mass, square) * omega**2
            + np.kron(s.damping, rate) * omega
            + np.kron(s.stiffness, np.eye(slots))
        )
        for row, _, tangent in springs:
            linear += np.kron(np.outer(row, row), tangent)
        by_omega = 2.0 * omega * s.mass @ x @ square.T + s.damping @ x @ rate.T
        return r.ravel(), np.concatenate([linear, by_omega.reshape(-1, 1)], axis=1)

    def of_response(self, frf, index):
        """Return the unknowns at a point of a curve."""
        z = np.zeros(self.system.size * self.orders.size + 1)
        x = z[:-1].reshape(self.system.size, -1)
        for i, dof in enumerate(frf.dofs):
            series = frf.coefficients(dof)[index]
            kept = min(series.size - 1, self.harmonics)
            x[i, 0] = series[0].real
            x[i, 1 : 2 * kept : 2] = series[1 : kept + 1].real
            x[i, 2 : 2 * kept + 1 : 2] = -series[1 : kept + 1].imag
        z[-1] = frf.omega[index]
        return z

    def scaled(self, z):
        return np.concatenate([np.full(z.size - 1, np.linalg.norm(z[:-1])), [z[-1]]])

    def correct(self, z, normal, scale):
        at = z.copy()
        for _ in range(15):
            r, jacobian = self.residual(z)
            matrix = np.vstack([jacobian * scale, normal])
            right = np.concatenate([r, [normal @ ((z - at) / scale)]])
            step = np.linalg.solve(matrix, right)
            z = z - scale * step
            if np.linalg.norm(step) < 1e-10:
                return z
        return None

    def tangent(self, z, ahead, scale):
        _, jacobian = self.residual(z)
        matrix = np.vstack([jacobian * scale, ahead])
        right = np.zeros(z.size)
        right[-1] = 1.0
        t = np.linalg.solve(matrix, right)
        return t / np.linalg.norm(t)

    def folds(self, start, stop, step=0.02):
        """Follow the branch from the linear response at `start` and return its folds.

        Positions of sign changes of the tangent's frequency, halved to 1e-9.
        """
        z = np.zeros(self.system.size * self.orders.size + 1)
        z[-1] = start
        normal = np.zeros(z.size)
        normal[-1] = np.sign(stop - start)
        scale = np.ones(z.size)
        z = self.correct(z, normal, scale)
        scale = self.scaled(z)
        t = self.tangent(z, normal, scale)
        found, points = [], [z]
        while min(start, stop) <= z[-1] <= max(start, stop) and len(points) < 4000:
            length = step
            while True:
                new = self.correct(z + length * scale * t, t, scale)
                if new is not None:
                    own = self.scaled(new)
                    ahead = self.tangent(new, t * scale / own, own)
                    if ahead @ (t * scale / own) > 0.95 * np.linalg.norm(t * scale / own):
                        break
                length *= 0.5
                assert length > 1e-9
            if t[-1] * ahead[-1] < 0.0:
                found.append(self._fold(z, t, scale, length))
            z, t, scale = new, ahead, own
            points.append(z)
        return found, points

    def _fold(self, z, t, scale, length):
        low, high = 0.0, length
        side = np.sign(t[-1])
        for _ in range(50):
            middle = 0.5 * (low + high)
            new = self.correct(z + middle * scale * t, t, scale)
            ahead = self.tangent(new, t, scale)
            if np.sign(ahead[-1]) == side:
                low = middle
            else:
                high = middle
        return new

    def amplitude(self, z, dof):
        values = (
            self.basis(np.linspace(0.0, 2.0 * np.pi, 20001))
            @ z[:-1].reshape(self.system.size, -1)[dof]
        )
        return 0.5 * float(values.max() - values.min())


def duffing(stiffness, load=1.0, damping=0.1):
    """Return one mass on a linear and a cubic spring."""
    one = np.eye(1)
    springs = [("cubic", (0, None), stiffness)]
    return Sprung(one, damping * one, one, np.array([load]), springs)


def stopped(load=0.3, stiffness=20.0, gap=1.0):
    """Return one mass that hits a stop."""
    one = np.eye(1)
    springs = [("stop", (0, None), stiffness, gap)]
    return Sprung(one, 0.1 * one, one, np.array([load]), springs)


def chain(springs, load=(0.5, 0.0, 0.0)):
    """Return three masses in a row, the first held by the ground."""
    stiffness = np.array([[3.0, -1.0, 0.0], [-1.0, 2.5, -1.0], [0.0, -1.0, 1.5]])
    mass = np.diag([1.0, 0.8, 0.5])
    return Sprung(mass, 0.02 * stiffness + 0.03 * mass, stiffness, np.array(load), springs)

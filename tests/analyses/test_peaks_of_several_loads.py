"""Peaks under loads at several harmonics, whose phases make summits between all resonances."""

from typing import NamedTuple

import numpy as np
import pytest

import stickslip as ss


class Chain(NamedTuple):
    """Masses of 1 kg, each restrained and coupled to its neighbours, damped by the mass alone."""

    restraints: np.ndarray
    coupling: float
    damping: float

    def stiffness(self):
        size = len(self.restraints)
        return np.diag(self.restraints) - self.coupling * (np.eye(size, k=1) + np.eye(size, k=-1))

    def structure(self):
        size = len(self.restraints)
        names = [f"q{i}" for i in range(size)]
        return ss.Structure(
            np.eye(size), self.stiffness(), damping=ss.Rayleigh(mass=self.damping), dofs=names
        )

    def natural(self):
        return np.sqrt(np.linalg.eigvalsh(self.stiffness()))

    def heights(self, dof, forces, omega):
        """Half ranges without contacts, from (dof, amplitude, phase, harmonic) of every load."""
        frequencies, shapes = np.linalg.eigh(self.stiffness())
        theta = np.linspace(0.0, 2.0 * np.pi, 721)
        motion = np.zeros((omega.size, theta.size))
        for loaded, amplitude, phase, harmonic in forces:
            w = harmonic * omega[:, None]
            gains = shapes[dof] * shapes[loaded] / (frequencies - w**2 + 1j * w * self.damping)
            complex_amplitudes = amplitude * np.exp(1j * phase) * gains.sum(axis=1)
            motion += (complex_amplitudes[:, None] * np.exp(1j * harmonic * theta)).real
        return 0.5 * np.ptp(motion, axis=1)


CLOSE = Chain(
    np.array([10026.2258, 10026.8382, 10021.0174, 10024.548, 10033.7599, 9999.4123]),
    13.9325,
    0.7134,
)


def close_model(slip_force=1.0):
    contact = ss.Jenkins("q3", stiffness=1600.0, slip_force=slip_force)
    forces = [ss.Force("q5", 1.0), ss.Force("q0", 0.1, harmonic=3)]
    return ss.Model(CLOSE.structure(), [contact], forces)


def test_a_third_harmonic_beside_close_modes():
    curve = ss.damper_curve(
        close_model(), dof="q0", slip_force=[0.0, 1e-3], harmonics=3, omega=(95.0, 105.0)
    )
    assert curve.amplitude[0] == pytest.approx(4.34962e-6, rel=1e-5)
    assert curve.omega[0] == pytest.approx(100.1094, abs=1e-4)
    fine = ss.forced_response(curve.model_at(1e-3), np.linspace(99.9, 100.4, 1001), 3)
    assert curve.amplitude[1] >= (1.0 - 1e-6) * fine.amplitude("q0").max()


@pytest.mark.parametrize("measure", ["half_range", "max"])
def test_the_peak_of_a_grid_under_a_third_harmonic(measure):
    model = close_model(slip_force=0.0)
    coarse = ss.forced_response(model, np.linspace(95.0, 105.0, 21), 3)
    fine = ss.forced_response(model, np.linspace(99.9, 100.4, 2001), 3)
    peak = coarse.peak("q0", measure=measure)
    assert peak.amplitude == pytest.approx(fine.amplitude("q0", measure=measure).max(), rel=1e-5)


def test_an_optimum_under_a_third_harmonic_is_no_lower_than_its_own_damper():
    best = ss.optimal_damper(
        close_model(), dof="q0", bounds=(1e-6, 1e-4), harmonics=3, omega=(95.0, 105.0)
    )
    fine = ss.forced_response(best.model, np.linspace(98.0, 102.0, 2001), 3)
    assert best.amplitude >= (1.0 - 1e-4) * fine.amplitude("q0").max()


# At all but the first four the slopes of the amplitude tell of no summit as high as the highest.
@pytest.mark.parametrize("seed", [*range(4), 179, 271, 308, 411, 550, 596, 619, 621])
def test_no_linear_response_refutes_a_peak(seed):
    generator = np.random.default_rng(seed)
    size = int(generator.integers(3, 9))
    coupling = 10 ** generator.uniform(0.5, 2.0)
    # From resonances that lie apart to tens of them in a bandwidth.
    damping = 0.02 * coupling / size * 10 ** generator.uniform(-1.0, 1.5)
    chain = Chain(1e4 + coupling * generator.normal(size=size), coupling, damping)
    natural = chain.natural()
    omega = np.unique(
        np.concatenate(
            [
                np.linspace(natural[0] - 5.0, natural[-1] + 5.0, 4001),
                *(one + damping * np.linspace(-2.0, 2.0, 201) for one in natural),
            ]
        )
    )
    # Both loads alone move the first mass alike.
    first = (size - 1, 1.0, 0.0, 1)
    order = int(generator.integers(2, 4))
    phase = float(generator.uniform(0.0, 2.0 * np.pi))
    second = (0, 1.0, phase, order)
    sizes = [chain.heights(0, [one], omega).max() for one in (first, second)]
    share = sizes[0] / sizes[1] * 10 ** generator.uniform(-1.0, 0.3)
    second = (0, share, phase, order)
    forces = [
        ss.Force(f"q{loaded}", amplitude, phase=phase, harmonic=harmonic)
        for loaded, amplitude, phase, harmonic in (first, second)
    ]
    contact = ss.Jenkins(f"q{size // 2}", stiffness=1e3, slip_force=1.0)
    model = ss.Model(chain.structure(), [contact], forces)
    curve = ss.damper_curve(
        model, dof="q0", slip_force=[0.0], harmonics=3, omega=(omega[0], omega[-1])
    )
    highest = chain.heights(0, [first, second], omega).max()
    assert curve.status == ("converged",)
    # The grid in time and in frequency may pass beside the top.
    assert highest * (1.0 - 1e-3) <= curve.amplitude[0] <= highest * (1.0 + 1e-3)

"""The compiled mathematics: arrays in, arrays out."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Contact = tuple[str, Float, Mapping[str, float]]
Residual = str | float

__version__: str

class Problem:
    def __init__(
        self,
        mass: Float,
        damping: Float,
        stiffness: Float,
        contacts: Sequence[Contact],
        forces: Sequence[tuple[int, Complex]],
    ) -> None: ...
    def natural_frequencies(self, slipping: Sequence[tuple[int, int]]) -> Float: ...
    @property
    def modal_base(self) -> str: ...
    @property
    def static_singular(self) -> bool: ...

class Solution:
    @property
    def omega(self) -> Float: ...
    @property
    def displacement(self) -> Complex: ...
    @property
    def contact_displacement(self) -> Complex: ...
    @property
    def contact_force(self) -> Complex: ...
    @property
    def harmonics(self) -> NDArray[np.int64]: ...
    @property
    def half_wave(self) -> bool: ...
    @property
    def status(self) -> NDArray[np.uint8]: ...
    @property
    def residual(self) -> Float: ...
    @property
    def iterations(self) -> NDArray[np.int64]: ...
    @property
    def error_estimate(self) -> Float: ...
    @property
    def slip_fraction(self) -> Float: ...
    @property
    def dissipation(self) -> Float: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def timings(self) -> dict[str, float]: ...
    @property
    def counters(self) -> dict[str, int]: ...

def forced_response(
    problem: Problem,
    omega: Float | tuple[float, float],
    observe: NDArray[np.int64],
    harmonics: int | None,
    tolerance: float,
    residual: Residual,
    method: str,
    max_harmonics: int,
    max_iterations: int,
    progress: Callable[[float], None] | None,
) -> Solution: ...
def peak(
    problem: Problem,
    omega_lo: float,
    omega_hi: float,
    omega_guess: float,
    dof: int,
    measure: str,
    harmonics: int | None,
    tolerance: float,
    residual: Residual,
    max_harmonics: int,
    max_iterations: int,
) -> tuple[float, float]: ...
def amplitude(coefficients: Complex, measure: str) -> Float: ...
def contact_force(
    problem: Problem, contact: int, displacement: Complex, residual: Residual, samples: int
) -> Float: ...

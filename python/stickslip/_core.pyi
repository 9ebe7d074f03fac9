"""The compiled mathematics: arrays in, arrays out."""

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Parameters = Mapping[str, float | list[float]]
Contact = tuple[str, Float, Parameters]
SectorContact = tuple[str, Float, Float, Parameters]
Residual = str | float
March = int | Literal["auto"] | None

__version__: str

class TooFastError(ValueError): ...

class Problem:
    def __init__(
        self,
        mass: Float,
        damping: Float,
        stiffness: Float,
        contacts: Sequence[Contact],
        forces: Sequence[tuple[int, Complex]],
        proportional: bool,
    ) -> None: ...
    @staticmethod
    def travelling_wave(
        mass: tuple[Float, Float],
        damping: tuple[Float, Float],
        stiffness: tuple[Float, Float],
        sectors: int,
        engine_order: int,
        contacts: Sequence[SectorContact],
        forces: Sequence[tuple[int, Complex]],
        proportional: bool,
    ) -> Problem: ...
    @staticmethod
    def ring(
        mass: tuple[Float, Float],
        damping: tuple[Float, Float],
        stiffness: tuple[Float, Float],
        contacts: Sequence[Sequence[SectorContact]],
        forces: Sequence[Sequence[tuple[int, Complex]]],
        proportional: bool,
    ) -> Problem: ...
    def wave_frequencies(self, diameter: int, slipping: Sequence[tuple[int, int]]) -> Float: ...
    def natural_frequencies(self, slipping: Sequence[tuple[int, int]]) -> Float: ...
    @property
    def modal_base(self) -> str: ...
    @property
    def is_direct(self) -> bool: ...
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
    def samples(self) -> NDArray[np.int64]: ...
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
    def computed(self) -> int: ...
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
    driving: NDArray[np.int64],
    harmonics: int | None,
    tolerance: float,
    residual: Residual,
    method: str,
    jacobian: str,
    march: March,
    max_harmonics: int,
    max_samples: int,
    max_iterations: int,
    progress: Callable[[float], None] | None,
) -> Solution: ...
def amplitude(coefficients: Complex, measure: str) -> Float: ...
def contact_force(
    problem: Problem,
    contact: int,
    displacement: Complex,
    residual: Residual,
    march: int | None,
    samples: int,
) -> Float: ...
def contact_phases(
    problem: Problem,
    contact: int,
    displacement: Complex,
    residual: Residual,
    march: int | None,
) -> tuple[Float, Float]: ...
def single_harmonic(
    problem: Problem,
    omega: Float,
    observe: NDArray[np.int64],
    estimate: bool,
    max_iterations: int,
    progress: Callable[[float], None] | None,
) -> Solution: ...

Summit = tuple[float, float, int, int, int, float, bool]

class Quest(TypedDict):
    groups: list[list[int]]
    measure: str
    omega: tuple[float, float]
    harmonics: int | None
    tolerance: float
    residual: Residual
    max_harmonics: int
    max_iterations: int

class TunedDisk:
    def __init__(
        self,
        mass: Float,
        stiffness: Float,
        coupled_stiffness: Float,
        damping: tuple[Float, Float, Float],
        coupling: tuple[Float, Float, Float],
        contacts: Sequence[SectorContact],
        forces: Sequence[Sequence[tuple[int, Complex]]],
        proportional: bool,
    ) -> None: ...
    def mistuned(self, deviations: Float) -> Problem: ...

def summits(
    problem: Problem,
    quest: Quest,
    march: March = None,
    max_samples: int = ...,
) -> list[Summit]: ...
def mistuning_study(
    disks: Sequence[TunedDisk],
    which: Sequence[int],
    deviations: Float,
    quest: Quest,
    orders: Sequence[int],
    threads: int,
    deliver: Callable[[int, list[Summit], int], None],
    progress: Callable[[float], None],
) -> bool: ...

class Orbits(Solution):
    @property
    def range(self) -> Float: ...
    @property
    def state(self) -> Float: ...
    @property
    def multipliers(self) -> Complex: ...
    @property
    def neutral(self) -> NDArray[np.int64]: ...
    @property
    def work(self) -> Float: ...
    @property
    def viscous(self) -> Float: ...
    @property
    def events(
        self,
    ) -> tuple[NDArray[np.int64], Float, NDArray[np.int64], NDArray[np.uint8]]: ...

def exact_response(
    problem: Problem,
    omega: Float,
    observe: NDArray[np.int64],
    harmonics: int,
    residual: Residual,
    max_iterations: int,
    progress: Callable[[float], None] | None,
    rotation: tuple[int, int, float, float, int] | None = None,
) -> Orbits: ...
def exact_peak(
    problem: Problem,
    omega_lo: float,
    omega_hi: float,
    omega_guess: float,
    dof: int,
    measure: str,
    residual: Residual,
    max_iterations: int,
) -> tuple[float, float]: ...
def orbit_history(
    problem: Problem, omega: float, state: Float, observe: NDArray[np.int64], samples: int
) -> tuple[Float, Float, Float, Float]: ...

class Fates:
    """What becomes of n free motions; rows left out by an interruption are not-a-number."""

    reason: NDArray[np.uint8]  # (n,) codes of `Reason`
    mode: NDArray[np.int64]  # (n,) stuck mode with the most kinetic energy at the end, -1 for none
    share: Float  # (n,) its share of the kinetic energy
    omega: Float  # (n,) frequency of settled motions [rad/s]
    time: Float  # (n,) when it was decided [s]
    events: NDArray[np.int64]  # (n,) events met
    amplitude: Float  # (n, N) half the range of every DOF at the end [m]
    state: Float  # (n, 2N + n_p) state then
    interrupted: bool
    seconds: float

def fates(
    problem: Problem,
    starts: Float,
    periods: int,
    tolerance: float,
    threads: int,
    progress: Callable[[float], None] | None,
) -> Fates: ...

class History:
    @property
    def time(self) -> Float: ...
    @property
    def displacement(self) -> Float: ...
    @property
    def velocity(self) -> Float: ...
    @property
    def force(self) -> Float: ...
    @property
    def contact_displacement(self) -> Float: ...
    @property
    def poincare(self) -> Float: ...
    @property
    def range(self) -> Float: ...
    @property
    def change(self) -> Float: ...
    @property
    def settled(self) -> bool: ...
    @property
    def unbounded(self) -> bool: ...
    @property
    def events(self) -> tuple[Float, NDArray[np.int64], NDArray[np.uint8]]: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def timings(self) -> dict[str, float]: ...
    @property
    def counters(self) -> dict[str, int]: ...

def transient(
    problem: Problem,
    omega: float,
    scheme: str,
    periods: int,
    tolerance: float | None,
    steps: int,
    start: Float | None,
    observe: NDArray[np.int64],
    samples: int,
    keep: int | None,
    progress: Callable[[float], None] | None,
) -> History: ...

class Varied(TypedDict):
    parameter: str
    contacts: list[tuple[int, int | None]]
    factor: bool

class Design(TypedDict):
    variation: Varied
    dof: int
    measure: str
    omega: tuple[float, float]
    harmonics: int | None
    tolerance: float
    residual: Residual
    max_harmonics: int
    max_iterations: int

class Peaks:
    @property
    def value(self) -> Float: ...
    @property
    def omega(self) -> Float: ...
    @property
    def amplitude(self) -> Float: ...
    @property
    def sensitivity(self) -> Float: ...
    @property
    def error_estimate(self) -> Float: ...
    @property
    def harmonics(self) -> NDArray[np.int64]: ...
    @property
    def at_edge(self) -> NDArray[np.bool_]: ...
    @property
    def status(self) -> NDArray[np.uint8]: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def timings(self) -> dict[str, float]: ...
    @property
    def counters(self) -> dict[str, int]: ...

def damper_curve(
    problem: Problem,
    design: Design,
    values: Float,
    progress: Callable[[float], None] | None,
) -> Peaks: ...
def optimal_damper(
    problem: Problem,
    design: Design,
    bounds: tuple[float, float],
    progress: Callable[[float], None] | None,
) -> tuple[Peaks, Peaks]: ...
def sensitivity(
    problem: Problem,
    omega: Float,
    harmonics: NDArray[np.int64],
    contact_displacement: Complex,
    half_wave: bool,
    residual: Residual,
    dof: int,
    measure: str,
    causes: Sequence[str | tuple[int, int | None, str]],
    samples: NDArray[np.int64],
) -> Float: ...

class Followed(TypedDict):
    variation: Varied
    ratio: float
    values: list[float] | None
    range: tuple[float, float]

class LimitCycles:
    @property
    def value(self) -> Float: ...
    @property
    def ratio(self) -> Float: ...
    @property
    def omega(self) -> Float: ...
    @property
    def slipping(self) -> NDArray[np.bool_]: ...
    @property
    def status(self) -> NDArray[np.uint8]: ...
    @property
    def harmonics(self) -> NDArray[np.int64]: ...
    @property
    def displacement(self) -> Complex: ...
    @property
    def contact_displacement(self) -> Complex: ...
    @property
    def contact_force(self) -> Complex: ...
    @property
    def error_estimate(self) -> Float: ...
    @property
    def slip_fraction(self) -> Float: ...
    @property
    def dissipation(self) -> Float: ...
    @property
    def range(self) -> Float: ...
    @property
    def state(self) -> Float: ...
    @property
    def multipliers(self) -> Complex: ...
    @property
    def neutral(self) -> NDArray[np.int64]: ...
    @property
    def closed(self) -> NDArray[np.bool_]: ...
    @property
    def limit(self) -> tuple[float, float] | None: ...
    @property
    def folds(self) -> Float: ...
    @property
    def changes(self) -> list[tuple[float, float, int, str, int, int]]: ...
    @property
    def ends(self) -> list[tuple[str, float]]: ...
    @property
    def onset(self) -> tuple[float, float]: ...
    @property
    def phase_dof(self) -> int: ...
    @property
    def jumps(self) -> int: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def timings(self) -> Mapping[str, float]: ...
    @property
    def counters(self) -> Mapping[str, int]: ...

def limit_cycles(
    problem: Problem,
    negative_damping: NDArray[np.float64] | NDArray[np.complex128],
    proportional: bool,
    mode: int,
    followed: Followed,
    exact: bool,
    harmonics: int | None,
    max_harmonics: int,
    tolerance: float,
    stability: bool,
    max_points: int,
    progress: Callable[[float], None] | None,
) -> LimitCycles: ...

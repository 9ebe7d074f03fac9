"""The compiled mathematics: arrays in, arrays out."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Generic, TypedDict, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip.model.contact_law import ContactLaw
from stickslip.settings.balance import BalanceSettings, HarmonicSettings, SteadySettings
from stickslip.settings.cycles import CycleSettings
from stickslip.settings.modes import ModeSettings
from stickslip.settings.motion import ClassifySettings, TransientSettings
from stickslip.settings.orbits import ExactSettings, SingleHarmonicKeys
from stickslip.settings.peaks import DamperSettings, MistuningSettings

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Parameters = Mapping[str, float | list[float]]
Law = str | ContactLaw
Contact = tuple[Law, Float, Parameters]
SectorContact = tuple[Law, Float, Float, Parameters]
Residual = str | float | None
Progress = Callable[[float], None] | None

_Columns = TypeVar("_Columns")

__version__: str

class TooFastError(ValueError): ...

class SparseCholesky:
    def __init__(
        self, begins: NDArray[np.int64], rows: NDArray[np.int32], numbers: Float
    ) -> None: ...
    def numbers(self) -> int: ...
    def solve(self, right: Float) -> Float: ...

class Problem:
    def __init__(
        self,
        mass: Float,
        damping: Float,
        stiffness: Float,
        contacts: Iterable[Contact],
        forces: Sequence[tuple[int, Complex]],
        proportional: bool,
    ) -> None: ...
    def half_wave(self, residual: Residual) -> bool: ...
    def biased(self) -> bool: ...
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
    def natural_frequencies(
        self, slipping: Sequence[tuple[int, int]], diameter: int | None = None
    ) -> Float: ...
    def unbounded(self, span: tuple[float, float]) -> list[float | None]: ...
    @property
    def laws_not_monotone(self) -> list[str]: ...
    @property
    def laws_sampled(self) -> list[str]: ...
    @property
    def modal_base(self) -> str: ...
    @property
    def is_direct(self) -> bool: ...
    @property
    def static_singular(self) -> bool: ...

class Solution:
    columns: dict[str, NDArray[Any]]
    half_wave: bool
    computed: int
    interrupted: bool
    end: str
    cut: int
    astray: list[int]
    timings: dict[str, float]
    counters: dict[str, int]

class Found(Generic[_Columns]):
    interrupted: bool
    computed: int | None
    def solution(self, look: Progress) -> _Columns: ...

def forced_response(
    problem: Problem,
    omega: Float | tuple[float, float],
    observe: NDArray[np.int64],
    driving: NDArray[np.int64],
    settings: BalanceSettings,
    progress: Progress,
    bounds: bool | None = None,
    start: Complex | None = None,
) -> Found[Solution]: ...
def amplitude(coefficients: Complex, measure: str) -> Float: ...
def contact_force(
    problem: Problem,
    contact: int,
    displacement: Complex,
    residual: Residual,
    march: tuple[int, bool],
    samples: int,
) -> Float: ...
def contact_phases(
    problem: Problem,
    contact: int,
    displacement: Complex,
    residual: Residual,
    march: tuple[int, bool],
) -> tuple[Float, Float]: ...
def single_harmonic(
    problem: Problem,
    omega: Float,
    observe: NDArray[np.int64],
    settings: SingleHarmonicKeys,
    progress: Progress,
) -> Found[Solution]: ...

Summit = tuple[float, float, int, int, int, float, bool]

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
    groups: list[list[int]],
    measure: str,
    span: tuple[float, float],
    settings: HarmonicSettings | ExactSettings,
    evaluation: BalanceSettings | ExactSettings | None = None,
    progress: Progress = None,
) -> list[Summit]: ...
def mistuning_study(
    disks: Sequence[TunedDisk],
    which: Sequence[int],
    deviations: Float,
    groups: list[list[int]],
    peak: MistuningSettings,
    settings: HarmonicSettings,
    orders: Sequence[int],
    threads: int,
    deliver: Callable[[int, list[Summit], int], None],
    progress: Callable[[float], None],
) -> bool: ...
def exact_response(
    problem: Problem,
    omega: Float,
    observe: NDArray[np.int64],
    harmonics: int,
    settings: SteadySettings,
    progress: Progress,
    rotation: tuple[int, int, float, float, int] | None = None,
    bounds: tuple[bool, float] | None = None,
) -> Solution: ...
def exact_peak(
    problem: Problem,
    bracket: tuple[float, float, float],
    dof: int,
    measure: str,
    settings: SteadySettings,
    rotation: tuple[int, int, float, float, int] | None = None,
) -> tuple[float, float]: ...
def orbit_history(
    problem: Problem, omega: float, state: Float, observe: NDArray[np.int64], samples: int
) -> tuple[Float, Float, Float, Float]: ...

class AtRest:
    columns: dict[str, NDArray[Any]]
    steps: int

def static_response(problem: Problem, observe: list[int], progress: Progress) -> AtRest: ...

class Fates:
    """What becomes of n free motions; rows left out by an interruption are not-a-number."""

    columns: dict[str, NDArray[Any]]
    interrupted: bool
    seconds: float

def fates(
    problem: Problem,
    starts: Float,
    settings: ClassifySettings,
    threads: int,
    progress: Progress,
) -> Fates: ...

class History:
    columns: dict[str, NDArray[Any]]
    settled: bool
    unbounded: bool
    interrupted: bool
    timings: dict[str, float]
    counters: dict[str, int]

def transient(
    problem: Problem,
    settings: TransientSettings,
    start: Float | None,
    observe: NDArray[np.int64],
    progress: Progress,
) -> History: ...

class Varied(TypedDict):
    parameter: str
    contacts: list[tuple[int, int | None]]
    factor: bool

class Peaks:
    columns: dict[str, NDArray[Any]]
    interrupted: bool
    timings: dict[str, float]
    counters: dict[str, int]

def damper_curve(
    problem: Problem,
    variation: Varied,
    dof: int,
    values: Float,
    settings: DamperSettings,
    progress: Progress,
    bounds: bool | None = None,
) -> Peaks: ...
def peak_map(
    cells: Sequence[tuple[Problem, HarmonicSettings, int]],
    grid: Float,
    threads: int,
    progress: Progress,
) -> list[tuple[float, float, int, int]]: ...
def optimal_damper(
    problem: Problem,
    variation: Varied,
    dof: int,
    bounds: tuple[float, float],
    settings: DamperSettings,
    progress: Progress,
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
    all_marched: bool,
) -> Float: ...

class NonlinearMode:
    columns: dict[str, NDArray[Any]]
    end: tuple[str, float]
    met: tuple[float, int, float, float] | None
    half_wave: bool
    interrupted: bool
    timings: dict[str, float]
    counters: dict[str, int]

def nonlinear_mode(
    problem: Problem, settings: ModeSettings, corner: tuple[int, float] | None, progress: Progress
) -> Found[NonlinearMode]: ...
def period_multipliers(
    problem: Problem,
    circulatory: NDArray[np.float64],
    omega: float,
    displacement: NDArray[np.complex128],
    tolerance: float,
) -> tuple[NDArray[np.complex128], float] | None: ...

class LimitCycles:
    columns: dict[str, NDArray[Any]]
    ends: list[tuple[str, float]]
    onset: tuple[float, float]
    phase_dof: int
    jumps: int
    interrupted: bool
    timings: dict[str, float]
    counters: dict[str, int]

def limit_cycles(
    problem: Problem,
    negative_damping: NDArray[np.float64] | NDArray[np.complex128],
    proportional: bool,
    variation: Varied | None,
    settings: CycleSettings,
    progress: Progress,
) -> Found[LimitCycles]: ...

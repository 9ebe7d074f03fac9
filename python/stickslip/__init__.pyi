"""What the package exports; written by `docs/make_stub.py`."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import Literal

from numpy.typing import ArrayLike

from stickslip import fe as fe
from stickslip import plot as plot
from stickslip import reference as reference
from stickslip import study as study
from stickslip._core import __version__ as __version__
from stickslip.analyses.cluster import Client
from stickslip.analyses.design_map import design_map as design_map
from stickslip.analyses.design_map import spinning as spinning
from stickslip.analyses.flutter_formulas import rigid_limit_cycle as rigid_limit_cycle
from stickslip.analyses.flutter_formulas import single_harmonic_cycles as single_harmonic_cycles
from stickslip.analyses.run import Progress
from stickslip.analyses.stores import merge_stores as merge_stores
from stickslip.damper import BodyDamper as BodyDamper
from stickslip.damper import Centrifugal as Centrifugal
from stickslip.damper import ContactPoint as ContactPoint
from stickslip.damper import CylinderDamper as CylinderDamper
from stickslip.damper import Face as Face
from stickslip.damper import FlexibleBody as FlexibleBody
from stickslip.damper import RigidBody as RigidBody
from stickslip.damper import SplitDamper as SplitDamper
from stickslip.damper import StripDamper as StripDamper
from stickslip.damper import WedgeDamper as WedgeDamper
from stickslip.disk import AerodynamicDamping as AerodynamicDamping
from stickslip.disk import BladedDisk as BladedDisk
from stickslip.disk import Coupling as Coupling
from stickslip.disk import InfluenceCoefficients as InfluenceCoefficients
from stickslip.disk import Interface as Interface
from stickslip.disk import MistunedDisk as MistunedDisk
from stickslip.disk import ModalForces as ModalForces
from stickslip.disk import aerodynamic_waves as aerodynamic_waves
from stickslip.disk import cyclic_sector as cyclic_sector
from stickslip.disk import frequency_pattern as frequency_pattern
from stickslip.disk import mistuning_pattern as mistuning_pattern
from stickslip.disk.aerodynamics import Aerodynamics
from stickslip.errors import Interrupted as Interrupted
from stickslip.errors import ModelError as ModelError
from stickslip.fe import ContactInterface as ContactInterface
from stickslip.fe import Mesh as Mesh
from stickslip.fe import Reduction as Reduction
from stickslip.fe import Solid as Solid
from stickslip.fe import craig_bampton as craig_bampton
from stickslip.html.report import report as report
from stickslip.io import Frf as Frf
from stickslip.io import read_curve as read_curve
from stickslip.io import read_dofs as read_dofs
from stickslip.io import read_frf as read_frf
from stickslip.io import read_matrix as read_matrix
from stickslip.io import read_mesh as read_mesh
from stickslip.io import write_frf as write_frf
from stickslip.model import BoucWen as BoucWen
from stickslip.model import ContactLaw as ContactLaw
from stickslip.model import Coulomb as Coulomb
from stickslip.model import Cubic as Cubic
from stickslip.model import Force as Force
from stickslip.model import Iwan as Iwan
from stickslip.model import Jenkins as Jenkins
from stickslip.model import Masing as Masing
from stickslip.model import ModalDamping as ModalDamping
from stickslip.model import Model as Model
from stickslip.model import ParallelJenkins as ParallelJenkins
from stickslip.model import Rayleigh as Rayleigh
from stickslip.model import Stop as Stop
from stickslip.model import StructuralDamper as StructuralDamper
from stickslip.model import Structure as Structure
from stickslip.model import Tangents as Tangents
from stickslip.model import join as join
from stickslip.model import natural_frequencies as natural_frequencies
from stickslip.model import slip_configurations as slip_configurations
from stickslip.model.damping import DampingLaw
from stickslip.model.destabilised import destabilised as destabilised
from stickslip.model.destabilised import modal_damping as modal_damping
from stickslip.model.force import engine_order_forces as engine_order_forces
from stickslip.model.measurement import Measured
from stickslip.model.measurement import MeasuredBackbone as MeasuredBackbone
from stickslip.model.measurement import MeasuredLoop as MeasuredLoop
from stickslip.model.measurement import MeasuredPeak as MeasuredPeak
from stickslip.model.measurement import Measurement as Measurement
from stickslip.model.state import State as State
from stickslip.results import ForcedResponse as ForcedResponse
from stickslip.results import Status as Status
from stickslip.results.basin_map import BasinMap as BasinMap
from stickslip.results.campbell import Campbell as Campbell
from stickslip.results.contact_map import ContactMap as ContactMap
from stickslip.results.contact_map import slip_area as slip_area
from stickslip.results.damper_curve import DamperCurve as DamperCurve
from stickslip.results.diagnostic import Diagnostic as Diagnostic
from stickslip.results.diagnostic import Severity as Severity
from stickslip.results.exact_response import ExactResponse as ExactResponse
from stickslip.results.fit import Fit as Fit
from stickslip.results.fit import FitComparison as FitComparison
from stickslip.results.fit import compare_fits as compare_fits
from stickslip.results.flutter_map import FlutterMap as FlutterMap
from stickslip.results.limit_cycles import LimitCycles as LimitCycles
from stickslip.results.limit_cycles import StabilityMap as StabilityMap
from stickslip.results.mistuning import MistuningStudy as MistuningStudy
from stickslip.results.motion_class import MotionClass as MotionClass
from stickslip.results.nonlinear_modes import NonlinearModes as NonlinearModes
from stickslip.results.optimal_damper import OptimalDamper as OptimalDamper
from stickslip.results.result import Result
from stickslip.results.speed_response import SpeedResponse as SpeedResponse
from stickslip.results.static_response import StaticResponse
from stickslip.results.store import load as load
from stickslip.results.sweep import Sweep as Sweep
from stickslip.results.synthesis import SynthesizedCycles as SynthesizedCycles
from stickslip.results.synthesis import SynthesizedPeaks as SynthesizedPeaks
from stickslip.results.synthesis import SynthesizedResponse as SynthesizedResponse
from stickslip.results.transient import Transient as Transient
from stickslip.results.uncertainty import Uncertainty as Uncertainty
from stickslip.settings.quantities import Backbone as Backbone
from stickslip.settings.quantities import HighestPeak as HighestPeak
from stickslip.settings.quantities import Optimum as Optimum
from stickslip.settings.variation import Contacts

def basin_map(
    model: Model,
    axes: Mapping[str | int, ArrayLike] | None = None,
    *,
    observe: Iterable[str] | str | None = None,
    periods: int = 3000,
    tolerance: float = 1e-06,
    base: State | Mapping[str, float] | None = None,
    threads: int | None = None,
    starts: Iterable[State | Mapping[str, float]] | None = None,
    progress: Progress = None,
) -> BasinMap: ...
def campbell(
    models: Model | Callable[[float], Model],
    *,
    orders: Sequence[int] | None = None,
    diagram: Literal["campbell", "safe", "nodal-diameters"] = "campbell",
    speed: ArrayLike | None = None,
    progress: Progress = None,
) -> Campbell: ...
def certify(
    result: ForcedResponse,
    points: int | Literal["all"] | Sequence[int] = 20,
    *,
    seed: int = 0,
    dofs: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> ForcedResponse: ...
def classify(
    model: Model,
    start: State | Mapping[str, float],
    *,
    observe: Iterable[str] | str | None = None,
    periods: int = 3000,
    tolerance: float = 1e-06,
    progress: Progress = None,
) -> MotionClass: ...
def damper_curve(
    model: Model,
    *,
    dof: str,
    common: Literal["value", "factor"] = "value",
    contacts: Contacts | None = None,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest", "bounds"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 255,
    measure: Literal["half_range", "max", "fundamental"] = "half_range",
    mode: int = 0,
    omega: tuple[float, float] | None = None,
    slip_force: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    level: ArrayLike | None = None,
    friction: ArrayLike | None = None,
    preload: ArrayLike | None = None,
    gap: ArrayLike | None = None,
    tangential_stiffness: ArrayLike | None = None,
    normal_stiffness: ArrayLike | None = None,
    progress: Progress = None,
) -> DamperCurve: ...
def exact_response(
    model: Model,
    omega: ArrayLike | tuple[float, float],
    *,
    observe: Iterable[str] | str | None = None,
    mass_scaling: float | None = None,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest", "bounds"] | float | None = None,
    harmonics: int = 32,
    tolerance: float = 0.001,
    progress: Progress = None,
) -> ExactResponse: ...
def fit(
    model: Model,
    measured: Iterable[Measured],
    *,
    parameters: Mapping[str, tuple[float, float]],
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.0001,
    max_harmonics: int = 255,
    starts: int = 16,
    intervals: Literal["profile", "covariance"] = "profile",
    confidence: float = 0.95,
    max_evaluations: int = 200,
    progress: Progress = None,
) -> Fit: ...
def flutter_map(
    disk: BladedDisk,
    aerodynamics: Aerodynamics,
    *,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 63,
    mode: int = 0,
    multipliers: bool = False,
    direct: bool = True,
    amplitude: ArrayLike | tuple[float, float] | None = None,
    points: int = 41,
    progress: Progress = None,
) -> FlutterMap: ...
def forced_response(
    model: Model,
    omega: ArrayLike | tuple[float, float],
    harmonics: int | Literal["auto"] = "auto",
    *,
    observe: Iterable[str] | str | None = None,
    stability: bool = True,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest", "bounds"] | float | None = None,
    tolerance: float = 0.001,
    max_harmonics: int = 255,
    method: Literal["newton", "broyden"] = "newton",
    jacobian: Literal["exact", "differences"] = "exact",
    evaluation: Literal["exact", "marched"] = "exact",
    samples: int | Literal["auto"] = "auto",
    max_samples: int = 16384,
    outputs: Iterable[str] | str = (),
    progress: Progress = None,
) -> ForcedResponse: ...
def limit_cycles(
    model: Model,
    negative_damping: ArrayLike | DampingLaw,
    *,
    common: Literal["value", "factor"] = "value",
    contacts: Contacts | None = None,
    mode: int = 0,
    harmonics: int | Literal["auto"] = 31,
    method: Literal["newton", "exact"] = "newton",
    tolerance: float = 0.001,
    stability: bool = True,
    max_harmonics: int = 255,
    max_points: int = 5000,
    ratio: ArrayLike | tuple[float, float] | None = None,
    stiffness: ArrayLike | tuple[float, float] | None = None,
    slip_force: ArrayLike | tuple[float, float] | None = None,
    progress: Progress = None,
) -> LimitCycles: ...
def mistuning_study(
    disk: BladedDisk,
    deviation: ArrayLike,
    *,
    omega: tuple[float, float],
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 255,
    measure: Literal["half_range", "max", "fundamental"] = "half_range",
    store: str | PathLike[str] | None = None,
    portion: tuple[int, int] = (0, 1),
    threads: int | None = None,
    patterns: int | ArrayLike = 1000,
    dofs: Iterable[str] | str | None = None,
    coupling_stiffness: ArrayLike | None = None,
    seed: int = 0,
    distribution: Literal["normal", "uniform"] = "normal",
    client: Client | None = None,
    progress: Progress = None,
) -> MistuningStudy: ...
def nonlinear_modes(
    model: Model,
    *,
    amplitude: ArrayLike | tuple[float, float],
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest", "bounds"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 63,
    mode: int = 0,
    method: Literal["periodic", "phase-resonance", "quasi-static"] = "periodic",
    max_points: int = 2000,
    nodal_diameter: int | None = None,
    progress: Progress = None,
) -> NonlinearModes: ...
def optimal_damper(
    model: Model,
    *,
    dof: str,
    common: Literal["value", "factor"] = "value",
    contacts: Contacts | None = None,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 255,
    measure: Literal["half_range", "max", "fundamental"] = "half_range",
    mode: int = 0,
    omega: tuple[float, float] | None = None,
    parameter: Literal[
        "slip_force",
        "stiffness",
        "level",
        "friction",
        "preload",
        "gap",
        "tangential_stiffness",
        "normal_stiffness",
    ] = "slip_force",
    bounds: tuple[float, float] | None = None,
    progress: Progress = None,
) -> OptimalDamper: ...
def single_harmonic(
    model: Model,
    omega: ArrayLike | tuple[float, float],
    *,
    observe: Iterable[str] | str | None = None,
    max_iterations: int = 100,
    estimate: bool = True,
    progress: Progress = None,
) -> ForcedResponse: ...
def speed_response(
    build: Model | Callable[[float], Model],
    speed: ArrayLike,
    *,
    dof: str,
    engine_order: float | None = None,
    harmonics: int = 7,
    progress: Progress = None,
) -> SpeedResponse: ...
def stability_map(
    model: Model,
    negative_damping: ArrayLike,
    *,
    common: Literal["value", "factor"] = "value",
    contacts: Contacts | None = None,
    mode: int = 0,
    harmonics: int | Literal["auto"] = 31,
    method: Literal["newton", "exact"] = "exact",
    stiffness: ArrayLike | None = None,
    slip_force: ArrayLike | None = None,
    progress: Progress = None,
) -> StabilityMap: ...
def static_response(
    model: Model,
    *,
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> StaticResponse: ...
def sweep(
    models: Model | Callable[[float], Model],
    analysis: Callable[[Model], Result],
    *,
    common: Literal["value", "factor"] = "value",
    contacts: Contacts | None = None,
    slip_force: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    level: ArrayLike | None = None,
    friction: ArrayLike | None = None,
    preload: ArrayLike | None = None,
    gap: ArrayLike | None = None,
    tangential_stiffness: ArrayLike | None = None,
    normal_stiffness: ArrayLike | None = None,
    normal_load: ArrayLike | None = None,
    engine_order: Sequence[int] | None = None,
    speed: ArrayLike | None = None,
    progress: Progress = None,
) -> Sweep: ...
def transient(
    model: Model,
    omega: float,
    periods: int = 200,
    scheme: Literal["exact", "rk4"] = "exact",
    *,
    observe: Iterable[str] | str | None = None,
    mass_scaling: float | None = None,
    tolerance: float | None = None,
    steps: int = 1000,
    samples: int = 128,
    keep: int | None = None,
    start: State | Mapping[str, float] | None = None,
    progress: Progress = None,
) -> Transient: ...
def uncertainty(
    model: Model,
    parameters: Mapping[str, object],
    quantity: HighestPeak | Optimum | Backbone,
    *,
    max_iterations: int = 100,
    residual: Literal["centred", "from_rest"] | float | None = None,
    harmonics: int | Literal["auto"] = "auto",
    tolerance: float = 0.001,
    max_harmonics: int = 255,
    samples: int = 512,
    sampling: Literal["sobol", "random"] = "sobol",
    seed: int = 0,
    store: str | PathLike[str] | None = None,
    portion: tuple[int, int] = (0, 1),
    threads: int | None = None,
    client: Client | None = None,
    progress: Progress = None,
) -> Uncertainty: ...

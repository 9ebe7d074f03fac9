"""The table [analysis] of a study file: its key `kind` chooses the class."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from stickslip.analyses.basin_map import basin_map
from stickslip.analyses.campbell import campbell
from stickslip.analyses.certify import certify
from stickslip.analyses.damper_curve import damper_curve
from stickslip.analyses.exact_response import exact_response
from stickslip.analyses.fit import fit
from stickslip.analyses.flutter_map import flutter_map
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.limit_cycles import limit_cycles
from stickslip.analyses.mistuning_study import mistuning_study
from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.analyses.optimal_damper import optimal_damper
from stickslip.analyses.run import Progress, share
from stickslip.analyses.single_harmonic import single_harmonic
from stickslip.analyses.speed_response import speed_response
from stickslip.analyses.static_response import static_response
from stickslip.analyses.transient import transient
from stickslip.analyses.uncertainty import uncertainty
from stickslip.checks import real_matrix
from stickslip.model import Model
from stickslip.model.measurement import Measured
from stickslip.results.result import Result
from stickslip.settings.balance import BalanceKeys
from stickslip.settings.cycles import CycleKeys
from stickslip.settings.entries import ByKey, Factor, Some, Table
from stickslip.settings.fit import FitKeys
from stickslip.settings.flutter import FlutterKeys
from stickslip.settings.modes import ModeKeys
from stickslip.settings.motion import BasinKeys, StaticKeys, TransientKeys
from stickslip.settings.orbits import CertifySettings, OrbitKeys, SingleHarmonicKeys
from stickslip.settings.peaks import DamperKeys, MistuningKeys, OptimumKeys
from stickslip.settings.speed import CampbellKeys, SpeedKeys
from stickslip.settings.uncertainty import UncertaintyKeys
from stickslip.study.flow_tables import FlowKeys
from stickslip.study.matrices import (
    DampingSource,
    ModalDampingTable,
    RayleighDamping,
    damping_of,
    matrix_of,
)
from stickslip.study.measurement_table import MeasurementTable

# Share of the progress that the balance is given before it is certified.
_BALANCE = 0.5


def level_name(level: float) -> str:
    """Return a level as the name of its curve has it."""
    return f"{level:.10g}"


class AnalysisTable(Table):
    """What to compute: the keys of an analysis."""

    analysis: ClassVar[Callable[..., Result]]
    """What takes the table as its settings."""
    dof_keys: ClassVar[tuple[str, ...]] = ("observe",)
    """Keys that name DOFs; the first names those that the result has."""
    of_speed: ClassVar[bool] = False
    """Whether it computes models of several speeds of rotation itself."""

    kind: str

    @property
    def levels(self) -> tuple[float, ...] | None:
        """Levels of the forces, one result each; None: there is one result."""
        return getattr(self, "level_factors", None)

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        given = {key: getattr(self, key) or () for key in self.dof_keys}
        return {
            key: (names,) if isinstance(names, str) else [n for n in names if isinstance(n, str)]
            for key, names in given.items()
        }

    @property
    def observed(self) -> Sequence[str]:
        """The DOFs that the result has; none are all that are no modal coordinates."""
        return next(iter(self.named_dofs.values()), ())

    def with_matrices(self, folder: Path) -> Self:
        """Return the table with the numbers of the files that it names."""
        return self

    def at_level(self, model: Model, level: float) -> Model:
        """Return the model at a level of the forces."""
        return model.scaled(force=level)

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Result:
        """Compute one result, accurate at the DOFs that the study shows."""
        return type(self).analysis(model, settings=self, progress=progress)


class LevelEntries(AnalysisTable):
    """The keys of every analysis with forces."""

    level_factors: Some[Factor] | None = Field(
        default=None,
        alias="levels",
        description='Factors on the forces that vary, of kind "static" on the static loads: one '
        "result each; left out: the forces as written.",
        examples=[[0.5, 1, 2]],
    )

    @model_validator(mode="after")
    def _require_distinct_levels(self) -> Self:
        names = [level_name(level) for level in self.levels or ()]
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"levels holds {twice} twice, to 10 digits; each level is one curve")
        return self


class ForcedResponseTable(BalanceKeys, LevelEntries):
    """Steady response to the forces, by harmonic balance."""

    kind: Literal["forced-response"] = Field(default="forced-response", description="The analysis.")

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Any:
        """Compute one curve."""
        return forced_response(model, settings=self, outputs=shown, progress=progress)


class CertifyTable(CertifySettings, ForcedResponseTable):
    """Steady response by harmonic balance, compared with exact orbits at some points."""

    kind: Literal["certify"] = Field(description="The analysis.")  # type: ignore[assignment]

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Any:
        """Compute one curve, and compare it."""
        balance = super().run(model, share(progress, 0.0, _BALANCE), shown)
        return certify(balance, settings=self, progress=share(progress, _BALANCE, 1.0))


class ExactTable(OrbitKeys, LevelEntries):
    """Steady response to the forces, by exact periodic orbits."""

    kind: Literal["exact"] = Field(description="The analysis.")
    analysis: ClassVar = exact_response


class SingleHarmonicTable(SingleHarmonicKeys, LevelEntries):
    """Steady response to harmonic forces, by a single harmonic."""

    kind: Literal["single-harmonic"] = Field(description="The analysis.")
    analysis: ClassVar = single_harmonic


class TransientTable(TransientKeys, LevelEntries):
    """Motion from rest or given displacements, period after period."""

    kind: Literal["transient"] = Field(description="The analysis.")
    analysis: ClassVar = transient
    dof_keys = ("observe", "start")


class StaticTable(StaticKeys, LevelEntries):
    """Equilibrium under the static loads, raised from nothing."""

    kind: Literal["static"] = Field(description="The analysis.")
    analysis: ClassVar = static_response

    def at_level(self, model: Model, level: float) -> Model:
        """Return the model at a level of the static loads."""
        return model.scaled(load=level)


class DamperCurveTable(DamperKeys, AnalysisTable):
    """Peak amplitude and frequency along a parameter of the contacts or the level of the forces."""

    kind: Literal["damper-curve"] = Field(description="The analysis.")
    analysis: ClassVar = damper_curve
    dof_keys = ("dof",)


class OptimalDamperTable(OptimumKeys, AnalysisTable):
    """The value of a parameter of the contacts at which a peak is least."""

    kind: Literal["optimal-damper"] = Field(description="The analysis.")
    analysis: ClassVar = optimal_damper
    dof_keys = ("dof",)


class FrequencyTable(CampbellKeys, AnalysisTable):
    """Natural frequencies, and what engine orders excite."""

    analysis: ClassVar = campbell
    of_speed: ClassVar = True
    dof_keys = ()


class CampbellTable(FrequencyTable):
    """Natural frequencies over the speed of rotation, and where engine orders meet them."""

    kind: Literal["campbell"] = Field(description="The analysis.")
    diagram: Literal["campbell"] = Field(default="campbell", description="What is drawn.")


class SafeTable(FrequencyTable):
    """Natural frequencies over the nodal diameter, and what engine orders excite at a speed."""

    kind: Literal["safe"] = Field(description="The analysis.")
    diagram: Literal["safe"] = Field(default="safe", description="What is drawn.")


class NodalDiametersTable(FrequencyTable):
    """Natural frequencies over the nodal diameter."""

    kind: Literal["nodal-diameters"] = Field(description="The analysis.")
    diagram: Literal["nodal-diameters"] = Field(
        default="nodal-diameters", description="What is drawn."
    )


class SpeedResponseTable(SpeedKeys, AnalysisTable):
    """Response along the speed of rotation, which changes the model itself."""

    kind: Literal["speed-response"] = Field(description="The analysis.")
    analysis: ClassVar = speed_response
    of_speed: ClassVar = True
    dof_keys = ("dof",)


class BasinMapTable(BasinKeys, AnalysisTable):
    """What becomes of free motions from many starts."""

    kind: Literal["basin-map"] = Field(description="The analysis.")
    analysis: ClassVar = basin_map
    dof_keys = ("observe", "axes", "base")

    @model_validator(mode="after")
    def _require_axes(self) -> Self:
        if self.axes is None:
            raise ValueError("'axes' is missing")
        return self


class MistuningStudyTable(MistuningKeys, AnalysisTable):
    """Amplification factors of many disks whose sectors deviate, and their distribution."""

    kind: Literal["mistuning-study"] = Field(description="The analysis.")
    analysis: ClassVar = mistuning_study
    dof_keys = ("dofs",)


class LimitCyclesTable(CycleKeys, AnalysisTable):
    """Limit cycles under the damping C + r C_neg, along the ratio r or a parameter of contacts."""

    kind: Literal["limit-cycles"] = Field(description="The analysis.")
    dof_keys = ()
    negative_damping: DampingSource = Field(
        description="C_neg: a matrix, Rayleigh damping or modal damping with negative numbers.",
        examples=[{"rayleigh": {"mass": -7.49, "stiffness": -2.6e-5}}, {"modal": [-0.01, 0.0]}],
    )

    def with_matrices(self, folder: Path) -> Self:
        """Return the table with the numbers of the file of its negative damping."""
        source = self.negative_damping
        if isinstance(source, RayleighDamping | ModalDampingTable | tuple):
            return self
        matrix = real_matrix(matrix_of(source, folder, "negative_damping"), "negative_damping")
        rows = tuple(tuple(map(float, row)) for row in matrix)
        return self.model_copy(update={"negative_damping": rows})

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Any:
        """Compute the branch."""
        negative = damping_of(self.negative_damping, Path())
        return limit_cycles(model, negative, settings=self, progress=progress)


class FitTable(FitKeys, AnalysisTable):
    """Parameters of contacts and damping, fitted to measurements."""

    kind: Literal["fit"] = Field(description="The analysis.")
    dof_keys = ()
    measurement: Some[MeasurementTable] = Field(
        description="The tests, one table [[analysis.measurement]] each.",
        examples=[[{"file": "level-1.csv", "dof": "tip", "relative_noise": 0.02}]],
    )
    _read: tuple[Measured, ...] = ()

    def with_matrices(self, folder: Path) -> Self:
        """Return the table with the numbers of the files of its measurements."""
        made = self.model_copy()
        made._read = tuple(one.read(folder) for one in self.measurement)
        return made

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Any:
        """Compute the fit."""
        pairs = zip(self._read, self.measurement, strict=True)
        tests = [table.test(read, model, self.parameters) for read, table in pairs]
        return fit(model, tests, settings=self, progress=progress)


class UncertaintyTable(UncertaintyKeys, AnalysisTable):
    """A peak, an optimum or a backbone of a model whose parameters are uncertain."""

    kind: Literal["uncertainty"] = Field(description="The analysis.")
    analysis: ClassVar = uncertainty
    dof_keys = ()


class NonlinearModesTable(ModeKeys, AnalysisTable):
    """Frequency, damping and shape of a mode against its amplitude."""

    kind: Literal["nonlinear-modes"] = Field(description="The analysis.")
    analysis: ClassVar = nonlinear_modes
    dof_keys = ()


class FlutterMapTable(FlutterKeys, FlowKeys, AnalysisTable):
    """Amplitude and stability of every travelling wave of a tuned disk in a flow."""

    kind: Literal["flutter-map"] = Field(description="The analysis.")
    dof_keys = ()

    def run(self, model: Model, progress: Progress, shown: Sequence[str] = ()) -> Any:
        """Compute all waves."""
        return flutter_map(model, self.flow, settings=self, progress=progress)


AnyAnalysis = Annotated[
    AnalysisTable,
    ByKey(
        "kind",
        ForcedResponseTable,
        ExactTable,
        TransientTable,
        StaticTable,
        CertifyTable,
        SingleHarmonicTable,
        DamperCurveTable,
        OptimalDamperTable,
        CampbellTable,
        SafeTable,
        NodalDiametersTable,
        SpeedResponseTable,
        BasinMapTable,
        MistuningStudyTable,
        LimitCyclesTable,
        FitTable,
        UncertaintyTable,
        NonlinearModesTable,
        FlutterMapTable,
        default="forced-response",
    ),
]
"""Each further analysis joins these with a table of its own."""

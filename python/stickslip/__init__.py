"""Steady vibration of structures damped by dry friction: fast, without tuning, with its error.

Everything named here is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stickslip import fe, plot, reference, study
    from stickslip._core import __version__
    from stickslip.analyses.basin_map import basin_map
    from stickslip.analyses.certify import certify
    from stickslip.analyses.classify import classify
    from stickslip.analyses.damper_curve import damper_curve
    from stickslip.analyses.exact_response import exact_response
    from stickslip.analyses.flutter_formulas import rigid_limit_cycle, single_harmonic_cycles
    from stickslip.analyses.forced_response import forced_response
    from stickslip.analyses.limit_cycles import limit_cycles
    from stickslip.analyses.mistuning_study import mistuning_study
    from stickslip.analyses.optimal_damper import optimal_damper
    from stickslip.analyses.single_harmonic import single_harmonic
    from stickslip.analyses.stability_map import stability_map
    from stickslip.analyses.transient import transient
    from stickslip.disk import (
        BladedDisk,
        Coupling,
        InfluenceCoefficients,
        Interface,
        MistunedDisk,
        aerodynamic_waves,
        cyclic_sector,
        mistuning_pattern,
    )
    from stickslip.errors import Interrupted, ModelError
    from stickslip.fe import Reduction, Solid, craig_bampton
    from stickslip.html.report import report
    from stickslip.io import Frf, read_dofs, read_frf, read_matrix, write_frf
    from stickslip.model import (
        Force,
        Jenkins,
        Model,
        ParallelJenkins,
        StructuralDamper,
        natural_frequencies,
        slip_configurations,
    )
    from stickslip.model.damping import modal_damping
    from stickslip.model.destabilised import destabilised
    from stickslip.model.state import State
    from stickslip.model.structure import ModalDamping, Rayleigh, Structure, join
    from stickslip.results import ForcedResponse
    from stickslip.results.basin_map import BasinMap
    from stickslip.results.damper_curve import DamperCurve
    from stickslip.results.diagnostic import Diagnostic, Severity
    from stickslip.results.exact_response import ExactResponse
    from stickslip.results.limit_cycles import LimitCycles
    from stickslip.results.mistuning import MistuningStudy
    from stickslip.results.motion_class import MotionClass
    from stickslip.results.optimal_damper import OptimalDamper
    from stickslip.results.stability_map import StabilityMap
    from stickslip.results.status import Status
    from stickslip.results.store import load
    from stickslip.results.transient import Transient

__all__ = [
    "BasinMap",
    "BladedDisk",
    "Coupling",
    "DamperCurve",
    "Diagnostic",
    "ExactResponse",
    "Force",
    "ForcedResponse",
    "Frf",
    "InfluenceCoefficients",
    "Interface",
    "Interrupted",
    "Jenkins",
    "LimitCycles",
    "MistunedDisk",
    "MistuningStudy",
    "ModalDamping",
    "Model",
    "ModelError",
    "MotionClass",
    "OptimalDamper",
    "ParallelJenkins",
    "Rayleigh",
    "Reduction",
    "Severity",
    "Solid",
    "StabilityMap",
    "State",
    "Status",
    "StructuralDamper",
    "Structure",
    "Transient",
    "__version__",
    "aerodynamic_waves",
    "basin_map",
    "certify",
    "classify",
    "craig_bampton",
    "cyclic_sector",
    "damper_curve",
    "destabilised",
    "exact_response",
    "fe",
    "forced_response",
    "join",
    "limit_cycles",
    "load",
    "mistuning_pattern",
    "mistuning_study",
    "modal_damping",
    "natural_frequencies",
    "optimal_damper",
    "plot",
    "read_dofs",
    "read_frf",
    "read_matrix",
    "reference",
    "report",
    "rigid_limit_cycle",
    "single_harmonic",
    "single_harmonic_cycles",
    "slip_configurations",
    "stability_map",
    "study",
    "transient",
    "write_frf",
]

_HOMES = {
    "BasinMap": "results.basin_map",
    "BladedDisk": "disk",
    "Coupling": "disk",
    "DamperCurve": "results.damper_curve",
    "Diagnostic": "results.diagnostic",
    "ExactResponse": "results.exact_response",
    "Force": "model",
    "ForcedResponse": "results",
    "InfluenceCoefficients": "disk",
    "Frf": "io",
    "Interrupted": "errors",
    "Interface": "disk",
    "Jenkins": "model",
    "LimitCycles": "results.limit_cycles",
    "MistunedDisk": "disk",
    "MistuningStudy": "results.mistuning",
    "ModalDamping": "model",
    "Model": "model",
    "ModelError": "errors",
    "MotionClass": "results.motion_class",
    "OptimalDamper": "results.optimal_damper",
    "Rayleigh": "model",
    "Reduction": "fe",
    "Solid": "fe",
    "StabilityMap": "results.stability_map",
    "Severity": "results.diagnostic",
    "State": "model.state",
    "Status": "results",
    "ParallelJenkins": "model",
    "StructuralDamper": "model",
    "Structure": "model",
    "Transient": "results.transient",
    "__version__": "_core",
    "aerodynamic_waves": "disk",
    "basin_map": "analyses.basin_map",
    "certify": "analyses.certify",
    "classify": "analyses.classify",
    "craig_bampton": "fe",
    "cyclic_sector": "disk",
    "damper_curve": "analyses.damper_curve",
    "destabilised": "model.destabilised",
    "exact_response": "analyses.exact_response",
    "forced_response": "analyses.forced_response",
    "join": "model",
    "limit_cycles": "analyses.limit_cycles",
    "load": "results.store",
    "mistuning_pattern": "disk",
    "modal_damping": "model.damping",
    "mistuning_study": "analyses.mistuning_study",
    "natural_frequencies": "model",
    "optimal_damper": "analyses.optimal_damper",
    "read_dofs": "io",
    "read_frf": "io",
    "read_matrix": "io",
    "report": "html.report",
    "rigid_limit_cycle": "analyses.flutter_formulas",
    "single_harmonic": "analyses.single_harmonic",
    "single_harmonic_cycles": "analyses.flutter_formulas",
    "stability_map": "analyses.stability_map",
    "slip_configurations": "model",
    "transient": "analyses.transient",
    "write_frf": "io",
}
_MODULES = ("fe", "plot", "reference", "study")


def __getattr__(name: str) -> object:
    if name in _MODULES:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    checked = import_module(f"{__name__}.calls").checked
    value = checked(getattr(import_module(f"{__name__}.{_HOMES[name]}"), name))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

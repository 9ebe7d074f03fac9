"""Steady vibration of structures damped by dry friction: fast, without tuning, with its error.

Everything named here is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stickslip import plot, reference, study
    from stickslip._core import __version__
    from stickslip.analyses.certify import certify
    from stickslip.analyses.damper_curve import damper_curve
    from stickslip.analyses.exact_response import exact_response
    from stickslip.analyses.forced_response import forced_response
    from stickslip.analyses.optimal_damper import optimal_damper
    from stickslip.analyses.single_harmonic import single_harmonic
    from stickslip.analyses.transient import transient
    from stickslip.disk import (
        BladedDisk,
        Coupling,
        Interface,
        MistunedDisk,
        cyclic_sector,
        mistuning_pattern,
    )
    from stickslip.errors import Interrupted, ModelError
    from stickslip.io import read_matrix
    from stickslip.model import (
        Force,
        Jenkins,
        Model,
        StructuralDamper,
        natural_frequencies,
        slip_configurations,
    )
    from stickslip.model.state import State
    from stickslip.model.structure import ModalDamping, Rayleigh, Structure, join
    from stickslip.results import ForcedResponse
    from stickslip.results.damper_curve import DamperCurve
    from stickslip.results.exact_response import ExactResponse
    from stickslip.results.optimal_damper import OptimalDamper
    from stickslip.results.status import Status
    from stickslip.results.store import load
    from stickslip.results.transient import Transient

__all__ = [
    "BladedDisk",
    "Coupling",
    "DamperCurve",
    "ExactResponse",
    "Force",
    "ForcedResponse",
    "Interface",
    "Interrupted",
    "Jenkins",
    "MistunedDisk",
    "ModalDamping",
    "Model",
    "ModelError",
    "OptimalDamper",
    "Rayleigh",
    "State",
    "Status",
    "StructuralDamper",
    "Structure",
    "Transient",
    "__version__",
    "certify",
    "cyclic_sector",
    "damper_curve",
    "exact_response",
    "forced_response",
    "join",
    "load",
    "mistuning_pattern",
    "natural_frequencies",
    "optimal_damper",
    "plot",
    "read_matrix",
    "reference",
    "single_harmonic",
    "slip_configurations",
    "study",
    "transient",
]

_HOMES = {
    "BladedDisk": "disk",
    "Coupling": "disk",
    "DamperCurve": "results.damper_curve",
    "ExactResponse": "results.exact_response",
    "Force": "model",
    "ForcedResponse": "results",
    "Interrupted": "errors",
    "Interface": "disk",
    "Jenkins": "model",
    "MistunedDisk": "disk",
    "ModalDamping": "model",
    "Model": "model",
    "ModelError": "errors",
    "OptimalDamper": "results.optimal_damper",
    "Rayleigh": "model",
    "State": "model.state",
    "Status": "results",
    "StructuralDamper": "model",
    "Structure": "model",
    "Transient": "results.transient",
    "__version__": "_core",
    "certify": "analyses.certify",
    "cyclic_sector": "disk",
    "damper_curve": "analyses.damper_curve",
    "exact_response": "analyses.exact_response",
    "forced_response": "analyses.forced_response",
    "join": "model",
    "load": "results.store",
    "mistuning_pattern": "disk",
    "natural_frequencies": "model",
    "optimal_damper": "analyses.optimal_damper",
    "read_matrix": "io",
    "single_harmonic": "analyses.single_harmonic",
    "slip_configurations": "model",
    "transient": "analyses.transient",
}
_MODULES = ("plot", "reference", "study")


def __getattr__(name: str) -> object:
    if name in _MODULES:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

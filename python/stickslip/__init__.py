"""Steady vibration of structures damped by dry friction: fast, without tuning, with its error.

Everything named here is loaded when it is first used. What editors and type checkers see of it is
written to `__init__.pyi` by `docs/make_stub.py`.
"""

from __future__ import annotations

from importlib import import_module

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
    "ParallelJenkins": "model",
    "Rayleigh": "model",
    "Reduction": "fe",
    "Solid": "fe",
    "StabilityMap": "results.limit_cycles",
    "Severity": "results.diagnostic",
    "State": "model.state",
    "Status": "results",
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

__all__ = sorted((*_HOMES, *_MODULES))


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

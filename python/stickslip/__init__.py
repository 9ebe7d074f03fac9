"""Steady vibration of structures damped by dry friction: fast, without tuning, with its error.

Everything named here is loaded when it is first used. What editors and type checkers see of it is
written to `__init__.pyi` by `docs/make_stub.py`.
"""

from __future__ import annotations

from importlib import import_module
from sys import modules

_NAMES = {
    "_core": "__version__",
    "analyses.basin_map": "basin_map",
    "analyses.campbell": "campbell",
    "analyses.certify": "certify",
    "analyses.classify": "classify",
    "analyses.static_response": "static_response",
    "analyses.damper_curve": "damper_curve",
    "analyses.fit": "fit",
    "analyses.design_map": "design_map spinning",
    "analyses.exact_response": "exact_response",
    "analyses.flutter_map": "flutter_map",
    "analyses.flutter_formulas": "rigid_limit_cycle single_harmonic_cycles",
    "analyses.forced_response": "forced_response",
    "analyses.limit_cycles": "limit_cycles",
    "analyses.mistuning_study": "mistuning_study",
    "analyses.nonlinear_modes": "nonlinear_modes",
    "analyses.optimal_damper": "optimal_damper",
    "analyses.single_harmonic": "single_harmonic",
    "analyses.speed_response": "speed_response",
    "analyses.stability_map": "stability_map",
    "analyses.stores": "merge_stores",
    "analyses.sweep": "sweep",
    "analyses.transient": "transient",
    "analyses.uncertainty": "uncertainty",
    "damper": "BodyDamper Centrifugal ContactPoint CylinderDamper Face FlexibleBody RigidBody "
    "SplitDamper StripDamper WedgeDamper",
    "disk": "AerodynamicDamping BladedDisk Coupling InfluenceCoefficients Interface MistunedDisk "
    "ModalForces "
    "aerodynamic_waves cyclic_sector frequency_pattern mistuning_pattern",
    "errors": "Interrupted ModelError",
    "fe": "ContactInterface Mesh Reduction Solid craig_bampton",
    "html.report": "report",
    "io": "Frf read_curve read_dofs read_frf read_matrix read_mesh write_frf",
    "model": "BoucWen ContactLaw Coulomb Cubic Force Iwan Jenkins Masing ModalDamping Model "
    "ParallelJenkins Rayleigh Stop StructuralDamper Structure Tangents join natural_frequencies "
    "slip_configurations",
    "model.destabilised": "destabilised modal_damping",
    "model.force": "engine_order_forces",
    "model.measurement": "MeasuredBackbone MeasuredLoop MeasuredPeak Measurement",
    "model.state": "State",
    "results": "ForcedResponse Status",
    "results.basin_map": "BasinMap",
    "results.campbell": "Campbell",
    "results.contact_map": "ContactMap slip_area",
    "results.damper_curve": "DamperCurve",
    "results.diagnostic": "Diagnostic Severity",
    "results.exact_response": "ExactResponse",
    "results.fit": "Fit FitComparison compare_fits",
    "results.flutter_map": "FlutterMap",
    "results.limit_cycles": "LimitCycles StabilityMap",
    "results.mistuning": "MistuningStudy",
    "results.motion_class": "MotionClass",
    "results.nonlinear_modes": "NonlinearModes",
    "results.synthesis": "SynthesizedCycles SynthesizedPeaks SynthesizedResponse",
    "results.optimal_damper": "OptimalDamper",
    "results.speed_response": "SpeedResponse",
    "results.store": "load",
    "results.sweep": "Sweep",
    "results.transient": "Transient",
    "results.uncertainty": "Uncertainty",
    "settings.quantities": "Backbone HighestPeak Optimum",
}
"""What each module holds of what is public."""

_HOMES = {name: home for home, names in _NAMES.items() for name in names.split()}
_MODULES = ("fe", "plot", "reference", "study")

__all__ = sorted((*_HOMES, *_MODULES))


def __getattr__(name: str) -> object:
    if name in _MODULES:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        # With name and object Python tells which name may have been meant.
        raise AttributeError(
            f"module {__name__!r} has no attribute {name!r}", name=name, obj=modules[__name__]
        )
    checked = import_module(f"{__name__}.calls").checked
    value = checked(getattr(import_module(f"{__name__}.{_HOMES[name]}"), name))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

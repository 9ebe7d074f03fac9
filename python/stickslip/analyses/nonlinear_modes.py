"""Nonlinear modes: frequency and damping of a structure with contacts against amplitude."""

from __future__ import annotations

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import require_lowest
from stickslip.analyses.doubts import few_modes, structure_doubts
from stickslip.analyses.mode_bounds import mode_bounds
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.texts import told
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, missed_tolerances, present
from stickslip.results.mode_shapes import ModeArrays
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.settings.modes import BackboneSettings, ModeKeys, ModeSettings
from stickslip.settings.settings import configured

_WHY = {
    "returned": "it turned back to small amplitudes",
    "stalled": "no point ahead was found",
    "points": "as many points as allowed",
    "evaluations": "steps became too short: contacts change what they do too often there",
    "interrupted": "interrupted",
}
_REMEDY = {
    "returned": "ask for smaller amplitudes",
    "stalled": "ask for smaller amplitudes, or try other harmonics",
    "points": "raise max_points",
    "evaluations": "ask for smaller amplitudes, or try other harmonics",
    "interrupted": "run it again",
}


_SOFTER = 0.02
"""Share of the frequency by which contacts soften a mode beyond reach from the linear one."""


@configured(ModeKeys)
def nonlinear_modes(
    model: Model, *, settings: ModeKeys, progress: Progress = None
) -> NonlinearModes:
    """Follow a mode of vibration from small amplitudes, where it is linear, to large ones.

    A nonlinear mode is a periodic motion without forces that a fictitious mass-proportional
    damping keeps up; what that has to feed is the modal damping of the structure and its contacts.
    Static loads stay. The branch is followed by arclength in the logarithm of the amplitude, around
    the turns that contacts make as they lift off.

    Parameters
    ----------
    model : Model
        Structure, contacts and static loads; other forces are left out but in phase resonance. A
        tuned `BladedDisk` moves in a travelling wave of one nodal diameter, with amplitudes of one
        sector.

    Returns
    -------
    NonlinearModes
        Along its branch, or at the amplitudes given in rising order.

    Raises
    ------
    ModelError
        If there is no such mode, or it is a rigid-body motion.
    Interrupted
        It holds the points so far.

    References
    ----------
    Krack (2015), Comput. Struct. 154, 59: the extended periodic motion concept. Lacayo and Allen
    (2019), Mech. Syst. Signal Process. 118, 133: quasi-static modes.
    """
    model = _of_diameter(model, settings.nodal_diameter)
    _check_method(model, settings.method)
    require_lowest(model, settings.mode)
    amplitude, bounded = settings.amplitude, settings.bounded
    if bounded and settings.method == "quasi-static":
        raise ModelError('residual = "bounds": not of a quasi-static mode; give a residual in N')
    kept = ModeSettings.of(
        **{
            **settings.nominal(model).suited(model).part(BackboneSettings),
            "amplitudes": tuple(map(float, np.atleast_1d(amplitude))),
            "whole": isinstance(amplitude, tuple),
            "bounds": bounded,
        }
    )
    with Run("nonlinear mode", progress, model) as run:
        with refusals(model):
            found = _core.nonlinear_mode(model.problem, kept, None, run)

        def result(look: Progress) -> NonlinearModes:
            solution = found.solution(look)
            with refusals(model):
                bounds = mode_bounds(model, kept, solution, run)
                slipping = _slipping(model, kept, solution, run)
            arrays = ModeArrays.of(
                solution, omega_bounds=bounds.omega, damping_bounds=bounds.damping
            )
            return NonlinearModes.of(
                solution,
                model=model,
                dofs=model.structure.dofs,
                settings=kept,
                arrays=arrays,
                interrupted=solution.interrupted or bounds.interrupted,
                diagnostics=(
                    *_assumptions(kept, arrays, solution, slipping),
                    *bounds.told,
                    *present(
                        (*structure_doubts(model), few_modes(model, arrays.omega, forced=False))
                    ),
                ),
            )

        if found.interrupted:
            return run.found(found, " amplitudes", result)
        return run.ended(result(run), f"{found.computed} amplitudes")


def _of_diameter(model: Model, diameter: int | None) -> Model:
    """Return the model in the wave of a nodal diameter."""
    if diameter is None:
        return model
    if not model.travels:
        raise ModelError(
            f"nodal_diameter: {diameter} of a model without cyclic symmetry; leave it out"
        )
    static = [force for force in model.forces if force.harmonic == 0]
    return model._like(engine_order=diameter, forces=tuple(static))


def _check_method(model: Model, method: str) -> None:
    """Refuse what a method does not take."""
    if method == "quasi-static" and model.travels:
        raise ModelError(
            'method = "quasi-static": a sector of a travelling wave has no static shape; compute '
            'it with method = "periodic"'
        )
    orders = {force.harmonic for force in model.forces if force.amplitude}
    if method == "phase-resonance" and (1 not in orders or orders - {0, 1}):
        raise ModelError(
            f'method = "phase-resonance": forces of harmonics {sorted(orders)}; give forces of '
            "harmonic 1, and static loads besides, alone"
        )


def _slipping(
    model: Model, settings: ModeSettings, solution: _core.NonlinearMode, run: Run
) -> Diagnostic | None:
    """Say that no mode was found because contacts slip much at the first amplitude already.

    The search begins at the linear mode. The quasi-static mode, which begins at the loop of the
    amplitude, tells how far away that is; a free structure and a sector of a wave have none.
    """
    end, reached = solution.end
    begun = end != "stalled" or np.isfinite(reached) or solution.interrupted
    if begun or settings.method != "periodic" or model.travels or model.problem.static_singular:
        return None
    update = {"method": "quasi-static", "amplitudes": settings.amplitudes[:1], "whole": False}
    static = _core.nonlinear_mode(
        model.problem, settings.model_copy(update=update | {"bounds": False}), None, run
    )
    if static.interrupted:
        raise KeyboardInterrupt
    columns = static.solution(run).columns
    omega, linear = float(columns["omega"][0]), float(solution.columns["linear"][0])
    if not abs(omega - linear) > _SOFTER * linear:
        return None
    several = len(model.structure) > 1
    return told(
        "mode-not-reached/microslip",
        amplitude=settings.amplitudes[0],
        omega=omega,
        linear=linear,
        _apart=", or a mode that stands apart from others" if several else "",
    )


def _assumptions(
    settings: ModeSettings,
    arrays: ModeArrays,
    solution: _core.NonlinearMode,
    slipping: Diagnostic | None,
) -> tuple[Diagnostic, ...]:
    """Say what a nonlinear mode took for granted."""
    omega, ratio = arrays.linear.tolist()
    end, amplitude = solution.end
    met = np.flatnonzero(arrays.resonance_order > 0)
    worst = met[np.argmax(arrays.resonance_share[met])] if met.size else 0
    most = int(arrays.harmonics.max(initial=0))
    kind = "" if settings.method == "periodic" else f"/{settings.method}"
    chosen = "" if settings.fixed_harmonics else f", chosen to {settings.tolerance:g}"
    return present(
        (
            told(f"mode-at-rest{kind}", mode=settings.mode, omega=omega, ratio=ratio),
            settings.method != "quasi-static"
            and most > 0
            and told(
                "harmonics/odd" if solution.half_wave else "harmonics", most=most, _chosen=chosen
            ),
            met.size > 0
            and told(
                "internal-resonance",
                points=int(met.size),
                order=int(arrays.resonance_order[worst]),
                frequency=float(arrays.resonance_omega[worst]),
                share=float(arrays.resonance_share[worst]),
                _first=float(arrays.amplitude[met[0]]),
            ),
            solution.met is not None and not met.size and _between(*solution.met),
            arrays.turns.size > 0
            and told("turns", _listed=", ".join(f"{one:.4g}" for one in arrays.turns[:6])),
            slipping or (end in _WHY and _ended(settings.method, end, amplitude)),
            missed_tolerances(arrays.status, "amplitudes") if arrays.status.size else None,
        )
    )


def _between(amplitude: float, order: int, frequency: float, share: float) -> Diagnostic:
    """Name an internal resonance that the branch has passed between the amplitudes asked for."""
    return told(
        "internal-resonance/between",
        amplitude=amplitude,
        order=order,
        frequency=frequency,
        share=share,
    )


def _ended(method: str, end: str, amplitude: float) -> Diagnostic | None:
    """Say where a branch ended before its largest amplitude, and why."""
    if end == "stalled" and np.isnan(amplitude):
        driven = method == "phase-resonance"
        remedy = ", or for forces that drive it more than others" if driven else ""
        return told("mode-not-reached/start", _driven=remedy)
    why, remedy = _WHY[end], _REMEDY[end]
    return told("mode-not-reached", amplitude=amplitude, _why=why, _remedy=remedy)

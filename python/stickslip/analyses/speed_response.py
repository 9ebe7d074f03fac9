"""The response along the speed of rotation, of a model that changes with it."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np

from stickslip.analyses.campbell import model_at
from stickslip.analyses.forced_response import begun_with
from stickslip.analyses.run import Progress, Run
from stickslip.checks import brief
from stickslip.disk.bladed_disk import rotor_order
from stickslip.errors import Interrupted, ModelError
from stickslip.model import Model
from stickslip.results.fields import Complex, Float
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.speed_response import SpeedArrays, SpeedResponse
from stickslip.results.sweep import told
from stickslip.settings.balance import BalanceKeys
from stickslip.settings.settings import configured
from stickslip.settings.speed import SpeedKeys, SpeedSettings

_TOLERANCE = 1e-2


@configured(SpeedKeys, "speed")
def speed_response(
    build: Model | Callable[[float], Model], *, settings: SpeedKeys, progress: Progress = None
) -> SpeedResponse:
    """Response along the speed of rotation, which changes the model itself.

    At a speed W the forces have the frequency of their engine order, E W; `build` makes the model
    there, with the centrifugal loads of dampers and the stiffness of the turning blades. Each speed
    begins with the motion of the speed before: where several motions exist the answer stays on its
    branch from speed to speed, upwards or downwards as they are given, until the branch ends or a
    step of the speed is too large for it.

    Parameters
    ----------
    build : Model or callable
        Makes the model of a speed [rad/s]; or the model, if it is the same at all speeds.

    Returns
    -------
    SpeedResponse
        Amplitude at every speed; nan where none was found.

    Raises
    ------
    ModelError
        If a speed is not positive, or makes no model, or a disk has another engine order.
    """
    if isinstance(settings.speed, tuple):
        raise ModelError("speed: a range needs 'points' here; give a list of speeds")
    if not settings.speed.all():
        raise ModelError(f"speed: {brief(settings.speed)}; give numbers above zero")
    speeds, start = settings.speed, perf_counter()
    found, models, order = list[ForcedResponse](), list[Model](), 0.0

    def result(*, interrupted: bool) -> SpeedResponse:
        speed = speeds[: len(found)]
        kept = settings.part(SpeedSettings) | {"engine_order": order}
        amplitude = [one.amplitude(settings.dof)[0] for one in found]
        error = [one.error_estimate(settings.dof)[0] for one in found]
        solved = np.array([one.converged[0] for one in found])
        columns: list[Float] = [np.where(solved, one, np.nan) for one in (amplitude, error)]
        return SpeedResponse(
            model=models[0],
            dofs=(settings.dof,),
            interrupted=interrupted,
            timings={"total": perf_counter() - start},
            counters={"speeds": len(found)},
            diagnostics=told(found, [f"{one * 30.0 / np.pi:.6g} rpm" for one in speed]),
            settings=SpeedSettings.of(**kept),
            arrays=SpeedArrays(
                speed=speed, omega=order * speed, amplitude=columns[0], error_estimate=columns[1]
            ),
        )

    with Run("speed response", progress) as run:
        try:
            for number, speed in enumerate(speeds.tolist()):
                with run.at_once():
                    model = model_at(build, speed)
                order = _order(model, settings.engine_order)
                models.append(model)
                point = BalanceKeys.of(
                    omega=[order * speed],
                    harmonics=settings.harmonics,
                    observe=[settings.dof],
                    stability=False,
                    tolerance=_TOLERANCE,
                )
                found.append(begun_with(_last_motion(found), model, point.suited(model)))
                run((number + 1) / speeds.size)
        except KeyboardInterrupt as stop:
            if not found:
                # What the curve of the first speed has come to is no response over the speed.
                reason = "speed response interrupted before a speed was complete"
                raise KeyboardInterrupt(reason) from None
            done = f"{len(found)} of {speeds.size} speeds are complete"
            message = f"speed response interrupted: {done}"
            raise Interrupted(message, result(interrupted=True)) from stop
        return run.completed(result(interrupted=False), "speed response")


def _last_motion(found: list[ForcedResponse]) -> Complex | None:
    """Return the contact displacements at the speed before, if it was solved."""
    if not found or not found[-1].converged[0]:
        return None
    last: Complex = found[-1].arrays.contact_displacement[0]
    return last.T


def _order(model: Model, given: float | None) -> float:
    """Return the engine order, which for a disk is its own."""
    own = rotor_order(model)
    if given is None and not own:
        raise ModelError(
            "engine_order: missing, and no disk says it; give engine_order=...",
            study="engine_order: missing, and no [disk] says it; add it to [analysis]",
        )
    if given is not None and own not in (0, given):
        raise ModelError(
            f"engine_order: {given:g}, but the forces on the disk have {own:g}; give that of the "
            "disk, or leave it out here"
        )
    return float(own if given is None else given)

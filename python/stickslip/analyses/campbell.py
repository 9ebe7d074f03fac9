"""Natural frequencies over the speed of rotation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stickslip.analyses.run import Progress, Run
from stickslip.checks import brief
from stickslip.disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.interruption import stopped
from stickslip.model import Model, natural_frequencies
from stickslip.model.configurations import every_point
from stickslip.results.campbell import Campbell, CampbellArrays
from stickslip.results.fields import Float
from stickslip.settings.settings import configured
from stickslip.settings.speed import CampbellKeys, CampbellSettings


@configured(CampbellKeys)
def campbell(
    models: Model | Callable[[float], Model], *, settings: CampbellKeys, progress: Progress = None
) -> Campbell:
    """Compute natural frequencies over speed and nodal diameter: Campbell and SAFE diagrams.

    With all contacts stuck, and with all slipping; the resonance with friction lies between.

    Parameters
    ----------
    models : Model or callable
        The model; or what makes that of a speed [rad/s], for stiffness K(W), as `spinning` gives
        it, and for the loads of dampers.

    Returns
    -------
    Campbell
        The frequencies, and where engine orders meet them.

    Raises
    ------
    ModelError
        If a speed makes no model, or the diagram needs a disk or a speed that is not there, or an
        engine order above 0.
    """
    speeds: Float = np.zeros(1) if settings.speed is None else np.asarray(settings.speed)
    if isinstance(settings.speed, tuple):
        raise ModelError("speed: a range needs 'points' here; give a list of speeds")
    if settings.speed is None and settings.diagram != "nodal-diameters":
        raise ModelError(
            f"speed: a {settings.diagram} diagram needs it; give speed=[...]",
            study=f"speed: a {settings.diagram} diagram needs it; give it",
        )
    if settings.diagram == "safe" and not speeds.all():
        raise ModelError("speed: nothing is excited at rest; give speeds above 0 rad/s")
    if settings.diagram == "campbell" and speeds.size == 1:
        raise ModelError("speed: one alone makes no line; give several")
    found, members = list[tuple[Float, Float]](), list[Model]()

    def result(*, interrupted: bool) -> Campbell:
        stuck, slipping = (np.array([pair[which] for pair in found]) for which in (0, 1))
        return Campbell(
            model=members[0],
            dofs=members[0].structure.dofs,
            interrupted=interrupted,
            timings={},
            counters={"speeds": len(found)},
            diagnostics=(),
            settings=CampbellSettings.of(**settings.part(CampbellSettings)),
            arrays=CampbellArrays(
                speed=speeds[: len(found)],
                diameter=np.arange(stuck.shape[1]),
                stuck=stuck,
                slipping=slipping,
            ),
        )

    with Run("campbell", progress) as run:
        try:
            for number, speed in enumerate(speeds.tolist()):
                with run.at_once():
                    model = model_at(models, speed)
                    if settings.diagram != "campbell" and not isinstance(model, BladedDisk):
                        reason = f"{settings.diagram} is that of a tuned disk"
                        raise ModelError(
                            f"diagram: {reason}; give ss.BladedDisk(...)",
                            study=f"kind: {reason}; add the table [disk]",
                        )
                members.append(model)
                found.append(_frequencies(model))
                run.reached((number + 1) / speeds.size)
        except KeyboardInterrupt:
            if not found:
                raise
            done = f"{len(found)} of {speeds.size} speeds"
            raise stopped("Campbell diagram", done, result(interrupted=True)) from None
        whole = result(interrupted=False)
        if settings.diagram != "nodal-diameters" and not all(whole.orders):
            reason = "orders: forces of engine order 0 have no frequency that goes with the speed"
            raise ModelError(f"{reason}; give orders=[...]", study=f"{reason}; give 'orders'")
        return run.completed(whole, "Campbell diagram")


def model_at(build: object, speed: float) -> Model:
    """Return the model at a speed; one that does not depend on it is returned as it is."""
    if isinstance(build, Model):
        return build
    model = require_models(build)(speed)
    if not isinstance(model, Model):
        raise ModelError(f"models: it returned {brief(model)}, no Model; return one")
    return model


def require_models(build: object) -> Callable[[float], object]:
    """Return what makes models of a speed, or refuse what makes none."""
    if not callable(build):
        raise ModelError(f"models: {brief(build)} is neither a Model nor a function of the speed")
    return build


def _frequencies(model: Model) -> tuple[Float, Float]:
    """Return natural frequencies by nodal diameter, stuck and slipping."""
    if isinstance(model, BladedDisk):
        table = model.nodal_diameters()
        return table.stuck, table.slipping
    return natural_frequencies(model)[None], natural_frequencies(model, every_point(model))[None]

"""Natural frequencies over the speed of rotation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stickslip.analyses.run import Progress, Run
from stickslip.checks import brief
from stickslip.disk import BladedDisk
from stickslip.errors import ModelError
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
    found, members = [], []
    with Run("campbell", progress) as run:
        for number, speed in enumerate(speeds.tolist()):
            model = model_at(models, speed)
            if settings.diagram != "campbell" and not isinstance(model, BladedDisk):
                raise ModelError(
                    f"diagram: {settings.diagram} is that of a tuned disk; give ss.BladedDisk(...)",
                    study=f"kind: {settings.diagram} is that of a tuned disk; add the table [disk]",
                )
            members.append(model)
            found.append(_frequencies(model))
            run.reached((number + 1) / speeds.size)
    diameters = np.arange(found[0][0].shape[0])
    stuck, slipping = (np.array([pair[which] for pair in found]) for which in (0, 1))
    result = Campbell(
        model=members[0],
        dofs=members[0].structure.dofs,
        interrupted=False,
        timings={},
        counters={"speeds": speeds.size},
        diagnostics=(),
        settings=CampbellSettings.of(**settings.part(CampbellSettings)),
        arrays=CampbellArrays(speed=speeds, diameter=diameters, stuck=stuck, slipping=slipping),
    )
    if settings.diagram != "nodal-diameters" and not all(result.orders):
        reason = "orders: forces of engine order 0 have no frequency that goes with the speed; give"
        raise ModelError(f"{reason} orders=[...]", study=f"{reason} 'orders'")
    return result


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

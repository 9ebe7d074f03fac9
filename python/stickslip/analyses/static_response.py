"""Structures under their static loads."""

from __future__ import annotations

from dataclasses import replace

from stickslip import _core
from stickslip.analyses.arguments import observed_dofs
from stickslip.analyses.doubts import static_doubts
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.model import Model
from stickslip.results.diagnostic import present
from stickslip.results.static_response import StaticArrays, StaticResponse
from stickslip.results.status import RestStatus
from stickslip.settings.motion import StaticKeys, StaticSettings
from stickslip.settings.settings import configured


@configured(StaticKeys)
def static_response(
    model: Model, settings: StaticKeys, *, progress: Progress = None
) -> StaticResponse:
    """Find the equilibrium that a structure comes to under its static loads.

    The loads, the forces of harmonic 0, are raised slowly and all together from nothing, and
    friction keeps its history: a wedge that is pressed in and let go again stays where it is.
    Between two load levels every contact goes along a straight line, in which its law is exact;
    where one changes its state, or sliding turns, steps become as short as the accuracy of 1e-10
    asks for. Motions computed with ``residual="from_rest"`` begin with this history.

    Returns
    -------
    StaticResponse
        Displacements, contact forces, and the range of normal forces that Coulomb allows.

    Raises
    ------
    ModelError
        If the structure moves as a rigid body though all contacts stick.
    Interrupted
        It holds the last equilibrium.

    References
    ----------
    Klarbring (1990) on static friction problems and what they leave open.
    """
    dofs = observed_dofs(settings, model)
    with Run("static response", progress, model) as run:
        with refusals(model):
            found = _core.static_response(
                model.problem, [model.structure.index(dof) for dof in dofs], run
            )
        result = StaticResponse(
            model=model,
            dofs=dofs,
            settings=StaticSettings(),
            arrays=StaticArrays.of(found),
            interrupted=False,
            timings={},
            counters={"steps": found.steps},
            diagnostics=present(static_doubts(model)),
        )
        result = replace(result, interrupted=result.status == RestStatus.NOT_COMPUTED)
        return run.ended(result, f"{result.share:.3g} of the loads")

"""Steady response to periodic forces, by exact periodic orbits."""

from __future__ import annotations

from stickslip import _core
from stickslip.analyses.arguments import columns_of, observed_dofs, points_of, require_held
from stickslip.analyses.assumptions import orbit_assumptions
from stickslip.analyses.branch_assumptions import stability_of_orbits
from stickslip.analyses.doubts import is_unique
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.free_flight import with_free_flight
from stickslip.analyses.mass_scaling import mass_scaled, pace_refused
from stickslip.analyses.run import Progress, Run, refusals, share
from stickslip.disk.wave_ring import moving
from stickslip.errors import Interrupted, ModelError
from stickslip.memory import require_memory
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.exact_response import ExactResponse, OrbitArrays
from stickslip.results.fields import Float
from stickslip.settings.entries import Span
from stickslip.settings.orbits import ExactSettings, OrbitKeys, OrbitSettings
from stickslip.settings.settings import configured

# Share of the progress that choosing the frequencies of a range is given.
_CHOOSING = 0.2


@configured(OrbitKeys, "omega")
def exact_response(
    model: Model, settings: OrbitKeys, *, progress: Progress = None
) -> ExactResponse:
    """Steady response over excitation frequency, by exact periodic orbits.

    Between two changes of stick and slip the structure is linear: the motion is a power series
    exact to rounding, and the instants of change are zeros of polynomials. The state that returns
    after a period is found by shooting with the analytic derivative of the flow. There is no
    truncation and nothing to choose.

    Of a tuned `BladedDisk` the orbit is that of all sectors that its travelling wave tells apart,
    sought on the part of a period after which they have changed their roles; the result shows
    sector 0, and others by `sector`. What breaks the symmetry of the wave is not followed: its
    multipliers are not-a-number, and its stability is not decided. `disk.mistuned(0)` has them.

    With ``residual="bounds"`` the harmonic balance finds, to `tolerance`, which residual tractions
    make the amplitudes least and largest; an orbit with each of these gives `lower` and `upper`.
    Where one of them is not found, `unique` says so and the two are not-a-number.

    Returns
    -------
    ExactResponse
        A `ForcedResponse` with events and Floquet multipliers. Points that failed say so in
        `status`.

    Raises
    ------
    ModelError
        If the model has a static load that nothing holds, or the bounds of a travelling wave are
        asked for.
    Interrupted
        While the frequencies of a range are chosen that is the harmonic balance.

    References
    ----------
    Guillen (1999), section 4.2, integrates the same motion step by step. For shooting with jumps
    see R. I. Leine, H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems"
    (Springer, 2004).
    """
    grid, bounded = settings.omega, settings.bounded
    if bounded and model.travels:
        raise ModelError(
            'residual: "bounds" of a travelling wave are not followed along orbits; give them to '
            "forced_response, or take the orbits of disk.mistuned(0)"
        )
    settings = settings.nominal(model)
    span = grid if isinstance(grid, tuple) else None
    kept = ExactSettings.of(**settings.part(OrbitSettings), span=span, bounds=bounded)
    dofs = observed_dofs(settings, model)
    require_held(model, kept.residual)
    with Run("exact response", progress, model) as run:
        part: Progress = run
        if isinstance(grid, tuple):
            grid = _frequencies(model, grid, kept, dofs, share(run, 0.0, _CHOOSING))
            part = share(run, _CHOOSING, 1.0)
        slowed, scaling = mass_scaled(model, grid, kept.mass_scaling)
        with pace_refused(model, grid, kept.mass_scaling):
            result = orbits_at(slowed, grid, dofs, kept, part, *scaling)
        return run.ended(with_free_flight(result), f"{result.omega.size} of {grid.size} points")


def orbits_at(
    model: Model,
    grid: Float,
    dofs: tuple[str, ...],
    settings: ExactSettings,
    progress: Progress,
    *assumed: Diagnostic,
) -> ExactResponse:
    """Return the exact orbits that are found before an interruption; of a wave, of sector 0.

    What was `assumed` of the model is said beside what the orbits take for granted.
    """
    problem, rotation = moving(model, half_wave=model.problem.half_wave(settings.residual))
    sectors = 1 if rotation is None else rotation.sectors
    points = sectors * points_of(model)
    further = 3 * (2 * sectors * len(model.structure) + points) + 2 * len(dofs) + 16
    require_memory(grid.size, settings.harmonics, len(dofs), points, extra=further)
    columns = columns_of(dofs, model)
    with refusals(model):
        solution = _core.exact_response(
            problem,
            grid,
            columns,
            settings.harmonics,
            settings,
            progress,
            rotation,
            (is_unique(model), settings.tolerance) if settings.bounds else None,
        )
    arrays = OrbitArrays.of(solution)
    if rotation is not None:
        arrays = arrays.of_sector(points // sectors, sectors)
    return ExactResponse.of(
        solution,
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        diagnostics=(
            *assumed,
            *orbit_assumptions(model, settings, dofs, arrays, solution, grid.size),
            *stability_of_orbits(model, arrays),
        ),
    )


def _frequencies(
    model: Model, span: Span, settings: ExactSettings, dofs: tuple[str, ...], progress: Progress
) -> Float:
    """Return the frequencies that an adaptive harmonic balance chooses in a range."""
    try:
        return forced_response(
            model,
            span,
            tolerance=settings.tolerance,
            residual=settings.residual,
            observe=dofs,
            progress=progress,
        ).omega
    except Interrupted as stop:
        raise Interrupted(
            "exact response interrupted while its frequencies were chosen; the result of this "
            "exception holds the harmonic balance so far",
            stop.result,
        ) from None

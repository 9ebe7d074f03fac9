"""Limit cycles in the form of reproductions, and what becomes of starts beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import product

import numpy as np

import stickslip as ss
from stickslip import ModelError
from stickslip.results.limit_cycles import Limit
from stickslip_reproduce.numbers import Axis, Series
from stickslip_reproduce.resolution import Float

__all__ = [
    "AMPLITUDES",
    "FORCES",
    "LOWEST",
    "MODES",
    "NEWTON",
    "OMEGA",
    "RATIO",
    "STARTS",
    "at",
    "beside",
    "held",
    "quantity",
    "sides",
    "smooth",
    "stable_share",
    "turn",
]

MODES = ("mode 1", "mode 2", "mode 3")
"""Names of the modes as the dissertation counts them."""

STARTS = {"unsigned": (1.0, 1.0, 1.0), "signed": (1.0, 1.0, -1.0)}
"""Signs of the displacements at the start: of the dissertation, and of mode 3."""

FORCES = {"zero": "f(0) = 0", "pulled": "f(0) = clip(k_d x₁)"}
"""Friction forces at starts given by displacements alone, which the dissertation leaves open."""

LOWEST = 0.01
"""Ratio at which the curves begin."""

PERIODS = 1000
"""Longest motion beside an orbit, in periods of mode 1."""

RATIO = Axis("negative viscous damping ratio r")
OMEGA = Axis("angular frequency ω", "rad/s")
AMPLITUDES = {
    "mass": Axis("amplitude of the mass", "m", "mm", 1e3, log=True),
    "damper": Axis("amplitude x₁ at the damper", "m", "mm", 1e3, log=True),
    "tip": Axis("amplitude x₂ of the tip", "m", "mm", 1e3, log=True),
    "mode": Axis("amplitude x₃", "m", "mm", 1e3, log=True),
}

NEWTON = "Newton's method instead of Broyden's: the equations solved are the same."


def quantity(result: ss.LimitCycles | ss.BasinMap, dof: str) -> Float:
    """Return amplitudes of a degree of freedom, or with "omega" the frequencies."""
    return result.omega if dof == "omega" else result.amplitude(dof)


def sides(cycles: ss.LimitCycles, dof: str) -> Iterator[Series]:
    """Return the two sides of a whole branch, which meet where it turns."""
    count = int(np.sum(cycles.branch == "sticking"))
    values = quantity(cycles, dof)
    # The sticking side includes the first point beyond the fold, so that no gap is left.
    yield Series("mostly sticking", cycles.values[: count + 1], values[: count + 1])
    yield Series("mostly slipping", cycles.values[count:], values[count:])


def turn(cycles: ss.LimitCycles) -> Limit:
    """Return where a branch turns for good; a `ModelError` if it does not."""
    if cycles.limit is None:
        raise ModelError(f"limit cycles: the branch of mode {cycles.settings.mode} does not turn")
    return cycles.limit


def stable_share(cycles: ss.LimitCycles, side: str) -> float:
    """Return how many of the cycles of a side are stable [%], without the fold itself.

    There a multiplier is 1, and rounding decides on which side of the unit circle it is found.
    """
    counted = (cycles.branch == side) & (cycles.values < (1.0 - 1e-6) * turn(cycles).value)
    return 100.0 * float((cycles.stability[counted] == "stable").mean())


def smooth(model: ss.Model, negative: Float, *, harmonics: int, mode: int = 0) -> ss.LimitCycles:
    """Return a branch of one fold at ratios so close to each other that its curve looks round."""
    whole = ss.limit_cycles(model, negative, mode=mode, harmonics=harmonics, stability=False)
    last = turn(whole).ratio
    # Towards the fold amplitude and frequency go with the root of the distance from it.
    near = last * (1.0 - np.linspace(1e-3, 0.95, 60) ** 2)
    ratios = np.union1d(near, np.geomspace(LOWEST, near.min(), 12))
    return ss.limit_cycles(
        model, negative, mode=mode, ratio=ratios, harmonics=harmonics, stability=False
    )


def at(cycles: ss.LimitCycles, value: float, branch: str) -> int:
    """Return the position of the cycle at a value that was asked for, on one side."""
    (place,) = np.flatnonzero(np.isclose(cycles.values, value) & (cycles.branch == branch))
    return int(place)


def held(model: ss.Model, start: Mapping[str, float], forces: str) -> ss.State:
    """Return displacements as a state with the friction force of a reading.

    Parameters
    ----------
    model : Model
        A model with one damper, at its first degree of freedom.
    start : mapping of str to float
        Displacements [m].
    forces : str
        A name in `FORCES`: none, or as if the damper had been pulled along from rest.
    """
    (damper,) = (contact.parameters() for contact in model.contacts)
    limit = damper["slip_force"]
    pulled = damper["stiffness"] * start[model.structure.dofs[0]]
    force = float(np.clip(pulled, -limit, limit)) if forces == "pulled" else 0.0
    return ss.State(model, start, contact_force=[force])


@cache
def beside(ratios: tuple[float, ...], kind: str, forces: str) -> tuple[ss.BasinMap, ...]:
    """Return what becomes of the eight starts around the sticking orbit of mode 3, per ratio.

    All displacements are 2 % above or below those of 5 harmonics, all velocities are zero. Four
    figures show the same motions, so that they are kept.

    Parameters
    ----------
    ratios : tuple of float
        Ratios of negative damping.
    kind : str
        Name of the signs in `STARTS`.
    forces : str
        Name of the friction forces in `FORCES`.
    """
    beam, negative = ss.reference.flutter_beam()
    cycles = ss.limit_cycles(beam, negative, mode=2, ratio=ratios, harmonics=5, stability=False)
    dofs = beam.structure.dofs
    maps = []
    for ratio in ratios:
        place = at(cycles, ratio, "sticking")
        sizes = [
            sign * float(cycles.amplitude(dof)[place])
            for dof, sign in zip(dofs, STARTS[kind], strict=True)
        ]
        starts = [
            {dof: size * factor for dof, size, factor in zip(dofs, sizes, factors, strict=True)}
            for factors in product((0.98, 1.02), repeat=3)
        ]
        driven = cycles.model_at(place)
        states = [held(driven, start, forces) for start in starts]
        maps.append(ss.basin_map(driven, starts=states, periods=PERIODS))
    return tuple(maps)

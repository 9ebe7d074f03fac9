"""Curves of results in the form of reproductions, and the axes that several figures share."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import stickslip as ss
from stickslip_reproduce.numbers import Axis, Kind, Series
from stickslip_reproduce.resolution import Float

__all__ = [
    "DAMPER",
    "FREQUENCY",
    "PERIOD",
    "PERIOD_SHARE",
    "PER_FORCE",
    "TIP",
    "curve",
    "largest_range",
    "maxima",
    "over_period",
    "settled",
]

SETTLED = 1e-6
"""Relative change over a period at which a motion counts as steady."""

PATIENCE = 5000
"""Periods after which a motion that is not steady is given up."""

FREQUENCY = Axis("angular frequency ω", "rad/s")
DAMPER = Axis("amplitude x₁ at the damper", "m", "µm", 1e6)
TIP = Axis("amplitude x₂ of the tip", "m", "mm", 1e3)
PER_FORCE = {
    "damper": Axis("x₁ / P at the damper", "m/N", "µm/N", 1e6),
    "tip": Axis("x₂ / P at the tip", "m/N", "µm/N", 1e6),
}
PERIOD = Axis("displacement", "m", "µm", 1e6)
PERIOD_SHARE = Axis("time over period ω t / 2π")


def curve(
    result: ss.ForcedResponse,
    dof: str,
    label: str,
    *,
    per: float = 1.0,
    kind: Kind = "line",
    pair: int | None = None,
) -> Series:
    """Return the amplitude of a degree of freedom over frequency, per unit of something."""
    return Series(label, result.omega, result.amplitude(dof) / per, kind, pair)


def over_period(
    label: str,
    values: Float,
    *,
    kind: Kind = "line",
    pair: int | None = None,
) -> Series:
    """Return values at equidistant instants of a period, closed to a whole one."""
    closed = np.append(values, values[0])
    return Series(label, np.linspace(0.0, 1.0, closed.size), closed, kind, pair)


def settled(model: ss.Model, omega: Iterable[float], dof: str) -> tuple[Float, Float]:
    """Return settled amplitudes by Runge-Kutta from rest, of a DOF and of its damper.

    Parameters
    ----------
    model : Model
        A model with one Jenkins contact.
    omega : iterable of float
        Angular frequencies [rad/s].
    dof : str
        The degree of freedom.

    Returns
    -------
    displacement, damper : ndarray of float64, shape (n,)
        Half ranges over the last period [m]; not-a-number where the motion did not settle.
    """
    (contact,) = model.contacts
    rows = []
    for frequency in omega:
        run = ss.transient(
            model,
            float(frequency),
            periods=PATIENCE,
            scheme="rk4",
            tolerance=SETTLED,
            keep=1,
            observe=dof,
        )
        spring = largest_range(run.contact_force(0)) / contact.parameters()["stiffness"]
        found = (run.amplitude(dof), spring)
        rows.append(found if run.status.name == "SETTLED" else (np.nan, np.nan))
    displacement, damper = np.array(rows).T
    return displacement, damper


def largest_range(values: Float) -> float:
    """Return half the range of sampled values."""
    return float(0.5 * (values.max() - values.min()))


def maxima(series: Series) -> list[tuple[float, float]]:
    """Return the local maxima of a curve, from the left, without its ends."""
    inner = series.y[1:-1]
    tops = np.flatnonzero((inner > series.y[:-2]) & (inner >= series.y[2:])) + 1
    return [(float(series.x[top]), float(series.y[top])) for top in tops]

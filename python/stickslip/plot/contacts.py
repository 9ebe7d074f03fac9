"""Figures of the forces at the contacts over a period."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import whole_number
from stickslip.errors import ModelError
from stickslip.model import ContactRef
from stickslip.plot.arguments import at, require_solved, result_of
from stickslip.plot.style import GREY, STUCK, new_axes
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Float

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["contact_forces"]

_SHADE = "#d8863b"
_SIZE = (8.2, 1.6)


def contact_forces(
    result: ForcedResponse,
    contact: ContactRef,
    index: int,
    *,
    stuck: bool = True,
    samples: int = 1024,
) -> list[Axes]:
    """Draw the forces of a contact over a period, one panel per point, and their sum.

    Parameters
    ----------
    result : ForcedResponse
        Harmonic balance or exact orbits.
    contact : int or str
        The contact.
    index : int
        Position of a solved point of the sweep; see `ForcedResponse.index`.
    stuck : bool, optional
        Whether to draw, dashed, the forces if no contact of the model ever slipped.
    samples : int, optional
        Number of instants.

    Returns
    -------
    list of matplotlib.axes.Axes
        One per point and, for several points, one for the sum. Shaded where the point slips; its
        slip limits are dotted.

    Raises
    ------
    ModelError
        If there is no such contact or no solved point of that position.
    """
    from matplotlib import pyplot

    result = result_of(result)
    require_solved(result, [index])
    number = result.model.contact_index(contact)
    count = whole_number(samples, "samples", smallest=8)
    one = result.model.contacts[number]
    time = np.linspace(0.0, 1.0, count + 1)
    forces = _closed(result.contact_force(number, index, count).reshape(count, -1))
    linear = _stuck_forces(result, number, index, time) if stuck else None
    states = result.contact_states(number, index)
    panels = one.points + (one.points > 1)
    _figure, grid = pyplot.subplots(
        panels,
        figsize=(_SIZE[0], 0.6 + _SIZE[1] * panels),
        sharex=True,
        layout="constrained",
        squeeze=False,
    )
    axes = [new_axes(ax) for ax in grid[:, 0]]
    for point, ax in enumerate(axes[: one.points]):
        if linear is not None:
            ax.plot(time, linear[:, point], color=GREY, ls=STUCK, lw=1.1, label="stuck, linear")
        ax.plot(time, forces[:, point], color="#31688e", lw=1.6, label="force")
        limit = one.limits[point]
        if np.isfinite(limit) and np.abs(forces[:, point]).max() > 0.3 * limit:
            for side in (-limit, limit):
                ax.axhline(side, color=GREY, lw=0.8, ls=":")
        slips = states.direction[:, point] != 0
        for start, length in zip(states.start[slips], states.length[slips], strict=True):
            ax.axvspan(start, start + length, color=_SHADE, alpha=0.25, lw=0.0)
        dof = one.dofs[point] if len(one.dofs) == one.points else " - ".join(map(str, one.dofs))
        ax.set_ylabel(f"{point}: {dof or 'ground'}\nforce [N]")
    if one.points > 1:
        axes[-1].plot(time, forces.sum(axis=1), color="#31688e", lw=1.6)
        largest = float(np.abs(forces).max())
        axes[-1].set_ylim(-0.05 * largest, 0.05 * largest)
        axes[-1].set_ylabel("sum\nforce [N]")
    for ax in axes:
        ax.grid(visible=True, color="0.9", lw=0.7)
        ax.set_axisbelow(True)
        ax.spines[["top", "right"]].set_visible(False)
    axes[0].legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.01), ncols=2, frameon=False, fontsize="small"
    )
    axes[-1].set_xlim(0.0, 1.0)
    axes[-1].set_xlabel("time over period t/T")
    name = result.model.contact_names[number]
    axes[0].set_title(f"{name}, {at(result, index)}", fontsize="medium", loc="left")
    return axes


def _closed(period: Float) -> Float:
    return np.concatenate([period, period[:1]])


def _stuck_forces(result: ForcedResponse, number: int, index: int, time: Float) -> Float:
    """Return the forces of a contact at the same frequency if nothing ever slipped."""
    from stickslip.analyses.forced_response import forced_response
    from stickslip.plot.limits import limit_model

    model = result.model
    omega = float(result.omega[index])
    linear = limit_model(model, stuck=True)
    own = model.contacts[number].linear_limit(stuck=True)
    if own is None:
        raise ModelError(
            f"contact {model.contact_names[number]!r}: without friction it never sticks; draw with "
            "stuck=False"
        )
    if model.travels:
        held = forced_response(linear, [omega], _orders(result))
        forces = held.contact_force(str(own.name), 0, len(time) - 1)
        return _closed(forces.reshape(len(time) - 1, -1))
    dofs = [dof for dof in dict.fromkeys(own.dofs) if dof is not None]
    moved = forced_response(linear, [omega], _orders(result), observe=dofs)
    motion = np.zeros((len(time), len(linear.structure)))
    for dof in dofs:
        period = moved.waveform(dof, 0, len(time) - 1)
        motion[:, linear.structure.index(dof)] = np.append(period, period[0])
    return motion @ own.rows(linear.structure).T @ own.stuck_stiffness


def _orders(result: ForcedResponse) -> int:
    return max((force.harmonic for force in result.model.forces), default=1) or 1

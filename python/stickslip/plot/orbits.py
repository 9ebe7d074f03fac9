"""Figures of exact orbits: Floquet multipliers, and when contacts stick and slip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.plot.arguments import at, require_solved, result_of
from stickslip.plot.style import GREY, OmegaUnit, finish, new_axes, omega_scale
from stickslip.results import ForcedResponse
from stickslip.results.dataset import point_names
from stickslip.results.exact_response import ExactResponse

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["MultiplierOptions", "events", "multipliers"]

_COLOURS = {"sticks": "0.85", "slips forward": "#31688e", "slips backward": "#d8863b"}
_KIND_OF = {0: "sticks", 1: "slips forward", -1: "slips backward"}
_STATES = {"sticks": "stuck", "slips forward": "slips forward", "slips backward": "slips backward"}


class MultiplierOptions(TypedDict, total=False):
    """Keywords of `multipliers`."""

    index: int | Sequence[int] | None
    ax: Axes | None
    omega_unit: OmegaUnit


def multipliers(
    result: ExactResponse,
    *,
    index: int | Sequence[int] | None = None,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "rad/s",
) -> Axes:
    """Draw Floquet multipliers in the complex plane, with the unit circle.

    Parameters
    ----------
    result : ExactResponse
        The orbits.
    index : int or sequence of int, optional
        Positions of points of the sweep. Default: all.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency by which the multipliers are coloured.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Neutral multipliers, of contacts that never slip, are hollow.

    Raises
    ------
    ModelError
        If the result has no orbits, there is no such unit, or no solved point of a position.
    """
    result, omega = _orbits_of(result), omega_scale(omega_unit)
    chosen = _chosen(result, index)
    made, ax = ax is None, new_axes(ax)
    values = result.multipliers[chosen]
    neutral = np.arange(values.shape[1]) < result.neutral[chosen][:, None]
    shade = np.broadcast_to(omega.factor * result.omega[chosen][:, None], values.shape)
    turn = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 361))
    ax.plot(turn.real, turn.imag, color=GREY, lw=0.9, zorder=1.5)
    moving = values[~neutral]
    cloud = ax.scatter(
        moving.real, moving.imag, c=shade[~neutral], cmap="viridis", s=14, lw=0.0, zorder=2.5
    )
    if neutral.any():
        kept = values[neutral]
        ax.plot(
            kept.real,
            kept.imag,
            ls="",
            marker="o",
            mfc="none",
            mec=GREY,
            label="neutral: a contact never slips",
        )
    if len(chosen) > 1:
        ax.figure.colorbar(cloud, ax=ax, label=omega.label)
    else:
        ax.set_title(at(result, int(chosen[0])), fontsize="medium")
    ax.set_aspect("equal")
    ax.set_xlabel("real part of the multiplier")
    ax.set_ylabel("imaginary part")
    finish(ax, made=made)
    if neutral.any():
        ax.legend(frameon=False, fontsize="small", loc="lower left")
    return ax


def events(result: ForcedResponse, index: int, *, ax: Axes | None = None) -> Axes:
    """Draw when contact points stick and slip, one strip each over the period.

    Parameters
    ----------
    result : ForcedResponse
        Harmonic balance, or exact orbits, whose events are drawn.
    index : int
        Position of a solved point of the sweep; see `ForcedResponse.index`.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no solved point of that position, or no contact.
    """
    result = result_of(result)
    require_solved(result, [index])
    names = point_names(result.model)
    if not names:
        raise ModelError("result: the model has no contact, so that nothing sticks or slips")
    made, ax = ax is None, new_axes(ax)
    shown: set[str] = set()
    count = 0
    for row, strips in enumerate(_strips(result, index)):
        # A phase may go on over the end of the period.
        count += len(strips) - (strips[0][2] == strips[-1][2])
        for begin, length, kind in strips:
            ax.broken_barh(
                [(begin, length)],
                (row - 0.35, 0.7),
                color=_COLOURS[kind],
                lw=0.0,
                label=None if kind in shown else _STATES[kind],
            )
            shown.add(kind)
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.set_yticks(range(len(names)), names)
    ax.set_xlabel("time over period t/T")
    ax.set_title(f"{at(result, index)}: {count} events per period", fontsize="medium")
    finish(ax, made=made)
    return ax


def _strips(result: ForcedResponse, index: int) -> Iterator[list[tuple[float, float, str]]]:
    """Give begin and length, in periods, and kind of the stick and slip phases of every point."""
    for contact in range(len(result.model.contacts)):
        states = result.contact_states(contact, index)
        for directions in states.direction.T:
            changed = np.flatnonzero(np.diff(directions, prepend=directions[0] - 1))
            starts = states.start[changed]
            lengths = np.diff(starts, append=1.0)
            kinds = [_KIND_OF[int(direction)] for direction in directions[changed]]
            yield list(zip(starts.tolist(), lengths.tolist(), kinds, strict=True))


def _orbits_of(result: object) -> ExactResponse:
    if not isinstance(result, ExactResponse):
        raise ModelError(
            f"result: {brief(result)} is not an ExactResponse; give what exact_response returned"
        )
    return result


def _chosen(result: ExactResponse, index: int | Sequence[int] | None) -> list[int]:
    if index is None:
        chosen = [int(place) for place in np.flatnonzero(result.arrays.solved)]
        if not chosen:
            raise ModelError("result: no point is solved, so that there are no multipliers")
        return chosen
    places = list(index) if isinstance(index, Sequence | np.ndarray) else [index]
    if not places:
        raise ModelError("index: empty; give the position of at least one point")
    require_solved(result, places)
    return [result.position(place) for place in places]

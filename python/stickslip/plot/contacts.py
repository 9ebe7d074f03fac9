"""One period of a response: motion, forces, loops and states at contacts; forces at rest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Unpack

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes

from stickslip.analyses.forced_response import forced_response
from stickslip.checks import whole_number
from stickslip.errors import ModelError
from stickslip.model import ContactRef, Coulomb, PointRef
from stickslip.model.contact import OPEN
from stickslip.plot import style
from stickslip.plot.arguments import at, dofs_of, solved_points
from stickslip.plot.figure import figure, keywords
from stickslip.plot.limits import limit_model
from stickslip.plot.options import Drawing, ForceOptions, HysteresisOptions, LoopOptions, Swept
from stickslip.plot.style import Looks
from stickslip.results import ForcedResponse
from stickslip.results.dataset import point_names
from stickslip.results.fields import Float
from stickslip.results.static_response import StaticResponse

_FORWARD, _BACKWARD = ("slips forward", style.BLUE), ("slips backward", style.ORANGE)
_STATES = {0: ("stuck", "0.85"), 1: _FORWARD, -1: _BACKWARD}
"""Name and colour by the direction of slip."""
_NODE_STATES = _STATES | {1: ("slips", style.BLUE), OPEN: ("open", style.GREY)}
"""Likewise of nodes, which slip in any direction of a plane."""


@figure
def waveform(
    ax: Axes,
    /,
    result: ForcedResponse,
    dof: str | Sequence[str],
    index: int,
    **options: Unpack[LoopOptions],
) -> None:
    """Draw one period of the motion of one or several degrees of freedom."""
    dofs, length = dofs_of(dof), style.LENGTH[options["length_unit"]]
    solved_points(result, index)
    waves = [result.waveform(one, index, options["samples"]) for one in dofs]
    time = np.linspace(0.0, 1.0, options["samples"] + 1)
    for one, wave, colour in zip(dofs, waves, style.colours(len(dofs)), strict=True):
        ax.plot(time, length.factor * _closed(wave), color=colour, lw=1.6, label=style.named(one))
    of = f" of {style.named(dofs[0])}" if len(dofs) == 1 else ""
    ax.set(xlim=(0.0, 1.0), xlabel="time over period t/T")
    ax.set_ylabel(f"displacement{of} [{length.label}]")
    ax.set_title(at(result, index, options["omega_unit"]), fontsize="medium")


@figure
def hysteresis(
    ax: Axes,
    /,
    result: ForcedResponse,
    contact: PointRef,
    index: int | Sequence[int],
    **options: Unpack[HysteresisOptions],
) -> None:
    """Draw the contact force against the relative displacement, over one period.

    Of a contact with components one loop for each tangential direction of each point.

    Parameters
    ----------
    index : int or sequence of int
        Positions of points of the sweep, one loop each; see `ForcedResponse.index`.
    """
    indices, length = solved_points(result, index), style.LENGTH[options["length_unit"]]
    places = [(one, at(result, one, options["omega_unit"])) for one in indices]
    if options["plane"]:
        _traction(ax, result, contact, places, options["samples"])
        return
    several = len(places) > 1
    loops = [
        (u, f, f"{where}: {label}" if several else label)
        for one, where in places
        for u, f, label in _loops(result, contact, one, options["samples"])
    ]
    for (u, f, label), colour in zip(loops, style.colours(len(loops)), strict=True):
        looks: Looks = {"color": colour, "lw": 1.6, "solid_joinstyle": "round", "label": label}
        ax.plot(length.factor * u, f, **looks)
    number, point = result.locate(contact)
    if result.model.contacts[number].core_phases:
        _draw_slip_limits(ax, result.model.contacts[number].limits, point)
    ax.set(xlabel=f"relative displacement u [{length.label}]", ylabel="contact force f [N]")
    title = style.named(result.model.contact_names[number]) + (
        "" if point is None else f"[{point}]"
    )
    if not several:
        title += f" at {places[0][1]}"
    if len(loops) == 1:
        title += f": {loops[0][2]}"
    ax.set_title(title, fontsize="medium")


def _traction(
    ax: Axes,
    result: ForcedResponse,
    contact: PointRef,
    places: Sequence[tuple[int, str]],
    samples: int,
) -> None:
    """Draw the traction in the plane of sliding."""
    number, point = result.locate(contact)
    one = result.model.contacts[number]
    if not isinstance(one, Coulomb) or len(one.components) == 1 or one.components[1] != "t2":
        raise ModelError(
            f"contact {result.model.contact_names[number]!r}: it has no two tangential directions; "
            "draw with plane=False"
        )
    nodes = one.points if point is None else 1
    shape = samples, nodes, len(one.components)
    loops = [
        (where if nodes == 1 else f"{where}: point {node}", force[:, node])
        for i, where in places
        for force in [_closed(result.contact_force(contact, i, samples).reshape(shape))]
        for node in range(nodes)
    ]
    for (label, force), colour in zip(loops, style.colours(len(loops)), strict=True):
        ax.plot(force[:, 0], force[:, 1], color=colour, lw=1.6, label=label)
        if len(loops) == 1:
            limit = one.friction_limit(np.repeat(force[:, None], one.points, axis=1))
            limit = limit[:, point or 0]
            turn = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 361))
            for radius in {float(limit.min()), float(limit.max())}:
                circle = radius * turn
                ax.plot(circle.real, circle.imag, color=style.GREY, lw=0.9, ls=":", zorder=1.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="traction t1 [N]", ylabel="traction t2 [N]")
    title = style.named(result.model.contact_names[number]) + (
        "" if point is None else f"[{point}]"
    )
    ax.set_title(title, fontsize="medium")


@figure
def events(ax: Axes, /, result: ForcedResponse, index: int, **options: Unpack[Swept]) -> None:
    """Draw when contact points stick, slip and are open, one strip each over the period.

    Of exact orbits the events themselves are drawn.
    """
    solved_points(result, index)
    names = point_names(result.model)
    if not names:
        raise ModelError("result: the model has no contact, so that nothing sticks or slips")
    nodal = [not one.core_phases for one in result.model.contacts for _ in range(one.points)]
    shown: set[str] = set()
    count = 0
    for row, strips in enumerate(_strips(result, index)):
        # A phase may go on over the end of the period.
        count += len(strips) - (strips[0][2] == strips[-1][2])
        for begin, length, direction in strips:
            label, colour = (_NODE_STATES if nodal[row] else _STATES)[direction]
            named = None if label in shown else label
            shown.add(label)
            strip = [(begin, length)], (row - 0.35, 0.7)
            ax.broken_barh(*strip, color=colour, lw=0.0, label=named)
    ax.set(xlim=(0.0, 1.0), ylim=(len(names) - 0.4, -0.6), xlabel="time over period t/T")
    ax.set_yticks(range(len(names)), [*map(style.named, names)])
    where = at(result, index, options["omega_unit"])
    ax.set_title(f"{where}: {count} events per period", fontsize="medium")


@keywords
def contact_forces(
    result: ForcedResponse, contact: ContactRef, index: int, **options: Unpack[ForceOptions]
) -> list[Axes]:
    """Draw the forces of a contact over a period, one panel per point, and their sum.

    Of a contact with components the panel of a point has them all, with the friction limit mu N.

    Returns
    -------
    list of matplotlib.axes.Axes
        One per point and, for several points, one for the sum. Shaded where the point slips, and
        darker where it is open; its slip limits are dotted.
    """
    solved_points(result, index)
    number = result.model.contact_index(contact)
    count = whole_number(options["samples"], "samples", smallest=8)
    one = result.model.contacts[number]
    where = at(result, index, options["omega_unit"])
    title = f"{style.named(result.model.contact_names[number])}, {where}"
    if one.components:
        return _node_forces(result, number, index, count, title)
    time = np.linspace(0.0, 1.0, count + 1)
    forces = _closed(result.contact_force(number, index, count).reshape(count, -1))
    linear = _stuck_forces(result, number, index, count) if options["stuck"] else None
    states = result.contact_states(number, index)
    rows = one.points + (one.points > 1)
    size = (8.2, 0.6 + 1.6 * rows)
    _, grid = pyplot.subplots(rows, figsize=size, sharex=True, layout="constrained", squeeze=False)
    axes = [style.new_axes(ax) for ax in grid[:, 0]]
    for point, ax in enumerate(axes[: one.points]):
        if linear is not None:
            looks: Looks = {"color": style.GREY, "ls": style.STUCK, "lw": 1.1}
            ax.plot(time, linear[:, point], label="stuck, linear", **looks)
        ax.plot(time, forces[:, point], color=style.BLUE, lw=1.6, label="force")
        limit = one.limits[point]
        if np.isfinite(limit) and np.abs(forces[:, point]).max() > 0.3 * limit:
            style.slip_limits(ax, limit, lw=0.8, ls=":")
        slips = states.direction[:, point] != 0
        label = "slips"
        for start, length in zip(states.start[slips], states.length[slips], strict=True):
            ax.axvspan(start, start + length, color=style.ORANGE, alpha=0.25, lw=0.0, label=label)
            label = "_"
        dof = one.dofs[point] if len(one.dofs) == one.points else " - ".join(map(str, one.dofs))
        ax.set_ylabel(f"{point}: {style.named(dof or 'ground')}\nforce [N]")
    if one.points > 1:
        whole = forces.sum(axis=1)
        axes[-1].plot(time, whole, color=style.BLUE, lw=1.6)
        # The rounding of a sum that vanishes is no motion.
        edge = max(0.05 * float(np.abs(forces).max()), 1.05 * float(np.abs(whole).max()))
        axes[-1].set(ylim=(-edge, edge), ylabel="sum\nforce [N]")
    _finish(axes, title, 3)
    return axes


def _finish(axes: list[Axes], title: str, columns: int) -> None:
    """Write legend, title and time at panels above each other."""
    for ax in axes:
        style.bare(ax)
    place: Looks = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.01)}
    # what one panel shows the others may lack
    found = [zip(*reversed(ax.get_legend_handles_labels()), strict=True) for ax in axes]
    named = {str(label): handle for pairs in found for label, handle in pairs}
    looks: Looks = {"ncols": columns, "frameon": False, "fontsize": "small"}
    axes[0].legend(named.values(), named.keys(), **place, **looks)
    axes[0].set_title(title, fontsize="medium", loc="left")
    axes[-1].set(xlim=(0.0, 1.0), xlabel="time over period t/T")


def _node_forces(
    result: ForcedResponse, number: int, index: int, count: int, title: str
) -> list[Axes]:
    """Draw the components of the force at every node, its friction limit, slip and opening."""
    one = result.model.contacts[number]
    time = np.linspace(0.0, 1.0, count + 1)
    shape = count, one.points, len(one.components)
    forces = _closed(result.contact_force(number, index, count).reshape(shape))
    states = one.states(forces) if isinstance(one, Coulomb) else np.zeros((count + 1, one.points))
    size = (8.2, 0.6 + 1.9 * one.points)
    _, grid = pyplot.subplots(
        one.points, figsize=size, sharex=True, layout="constrained", squeeze=False
    )
    axes = [style.new_axes(ax) for ax in grid[:, 0]]
    colours = style.colours(len(one.components))
    for node, ax in enumerate(axes):
        for part, colour in enumerate(colours):
            ax.plot(time, forces[:, node, part], color=colour, lw=1.5, label=one.components[part])
        if isinstance(one, Coulomb):
            limit = one.friction_limit(forces)[:, node]
            for side in (limit, -limit):
                ax.plot(time, side, color=style.GREY, lw=0.8, ls=":")
        for state, shaded, label in ((1, style.ORANGE, "slips"), (OPEN, style.GREY, "open")):
            there = states[:, node] == state
            shade: Looks = {"color": shaded, "alpha": 0.25, "lw": 0.0}
            shade["label"] = label if there.any() else "_"
            edge = ax.get_xaxis_transform()
            ax.fill_between(time, 0.0, 1.0, there, transform=edge, **shade)
        ax.set_ylabel(f"node {node}\nforce [N]" if one.points > 1 else "force [N]")
    _finish(axes, title, len(colours) + 2)
    return axes


def _closed(period: Float) -> Float:
    """Append the first instant, which the period ends with."""
    return np.concatenate([period, period[:1]])


def _loops(
    result: ForcedResponse, contact: PointRef, index: int, samples: int
) -> Iterator[tuple[Float, Float, str]]:
    """Give displacement, force and label of the loops of all points of a contact."""
    own = result.model.contacts[result.locate(contact)[0]]
    lost = np.atleast_1d(result.dissipation(contact)[index])
    sides = (result.contact_waveform, result.contact_force)
    u, f = (_closed(of(contact, index, samples).reshape(samples, len(lost), -1)) for of in sides)
    slips, opens = (
        np.atleast_1d(of(contact)[index]) for of in (result.slip_fraction, result.open_fraction)
    )
    for point, work in enumerate(lost):
        label = f"{style.prefixed(float(work), 'J')} per cycle"
        if not work:
            label = _idle(slips[point], opens[point]) if own.slips else "elastic"
        if work and own.tangential > 1:
            label += " in all directions"
        label = f"point {point}: {label}" if len(lost) > 1 else label
        for part in range(own.tangential):
            named = f"{own.components[part]}, {label}" if own.components else label
            yield u[:, point, part], f[:, point, part], named


def _idle(slips: float, opens: float) -> str:
    """Say what a point does that loses no work, by the shares of the period."""
    if opens >= 1.0:
        return "open"
    return ("slips without friction" if slips else "sticks") + (" and opens" if opens else "")


def _draw_slip_limits(ax: Axes, limits: Sequence[float], point: int | None) -> None:
    """Draw the forces that the contact cannot exceed, where the law has one such force."""
    limit = limits[point or 0] if point is not None or len(limits) == 1 else np.inf
    if not np.isfinite(limit):
        return
    style.slip_limits(ax, limit)
    looks: Looks = {"ha": "right", "va": "bottom", "color": style.GREY, "fontsize": "small"}
    frame = ax.get_yaxis_transform()
    place: Looks = {"xytext": (0.0, 2.0), "xycoords": frame, "textcoords": "offset points"}
    ax.annotate(f"$F_d$ = {limit:.4g} N", (1.0, limit), **place, **looks)
    ax.margins(y=0.08)


def _strips(result: ForcedResponse, index: int) -> Iterator[list[tuple[float, float, int]]]:
    """Give begin and length, in periods, and direction of the phases of every contact point."""
    for contact in range(len(result.model.contacts)):
        states = result.contact_states(contact, index)
        for directions in states.direction.T:
            changed = np.flatnonzero(np.diff(directions, prepend=directions[0] - 1))
            starts = states.start[changed]
            lengths = np.diff(starts, append=1.0)
            kinds = directions[changed].astype(int)
            yield list(zip(starts.tolist(), lengths.tolist(), kinds.tolist(), strict=True))


def _stuck_forces(result: ForcedResponse, number: int, index: int, count: int) -> Float:
    """Return the forces of a contact at the same frequency if nothing ever slipped."""
    model = result.model
    own = model.contacts[number].linear_limit(stuck=True)
    if own is None:
        raise ModelError(
            f"contact {model.contact_names[number]!r}: without friction it never sticks; draw with "
            "stuck=False"
        )
    linear = limit_model(model, stuck=True)
    orders = max((force.harmonic for force in model.forces), default=1) or 1
    omega = [float(result.omega[index])]
    if model.travels:
        held = forced_response(linear, omega, orders)
        return _closed(held.contact_force(str(own.name), 0, count).reshape(count, -1))
    dofs = [dof for dof in dict.fromkeys(own.dofs) if dof is not None]
    moved = forced_response(linear, omega, orders, observe=dofs)
    motion = np.zeros((count + 1, len(linear.structure)))
    for dof in dofs:
        motion[:, linear.structure.index(dof)] = _closed(moved.waveform(dof, 0, count))
    return motion @ own.rows(linear.structure).T @ own.stuck_stiffness


@figure
def static_forces(ax: Axes, /, result: StaticResponse, **options: Unpack[Drawing]) -> None:
    """Draw the traction of every contact point at rest, and what its friction allows, as bars."""
    names: list[str] = []
    tractions: list[float] = []
    allowed: list[float] = []
    for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
        forces = result.contact_force(name).reshape(contact.points, -1)
        tangential = forces[:, :-1] if "N" in contact.components else forces
        tractions.extend(np.linalg.norm(tangential, axis=1).tolist())
        allowed.extend(contact.friction_limit(forces).tolist())
        many = range(contact.points) if contact.points > 1 else [""]
        names.extend(f"{style.named(name)} {point}".rstrip() for point in many)
    if not names:
        raise ModelError("static_forces: the model has no contact")
    place = np.arange(len(names))
    finite = [one if np.isfinite(one) else np.nan for one in allowed]
    ax.bar(place, finite, 0.8, color="0.88", label="friction limit")
    ax.bar(place, tractions, 0.5, color=style.BLUE, label="traction")
    ax.set_xticks(place, names, rotation=30 if len(names) > 4 else 0)
    ax.set(ylabel="force [N]", ylim=(0.0, None))

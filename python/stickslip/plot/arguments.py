"""What the drawing functions are given, checked before anything is drawn."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TypeVar

from stickslip.checks import as_list, brief, text
from stickslip.errors import ModelError
from stickslip.plot.style import OmegaUnit, omega_scale
from stickslip.results import ForcedResponse
from stickslip.results.result import Result
from stickslip.settings.variation import Variation

_Kind = TypeVar("_Kind")
_SYMBOLS = {
    "slip_force": "slip force $F_d$",
    "stiffness": "contact stiffness $k_d$",
    "friction": "coefficient of friction $\\mu$",
    "preload": "preload $N_0$",
    "gap": "gap $g$",
    "tangential_stiffness": "tangential stiffness $k_t$",
    "normal_stiffness": "normal stiffness $k_n$",
}

_FREQUENCY = {"rad/s": "ω", "Hz": "f", "rpm": "n"}
"""Symbol of a frequency by its unit."""


def of_kind(kind: type[_Kind], result: object, entry: str = "result") -> _Kind:
    """Return a result, or refuse anything else."""
    if not isinstance(result, kind):
        name = kind.__name__
        # The function has the name of its result, but one.
        source = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
        source = source.replace("motion_class", "classify")
        article = "an" if name[0] in "AE" else "a"
        raise ModelError(
            f"{entry}: {brief(result)} is not {article} {name}; give what {source} returned"
        )
    return result


def several(
    kind: type[_Kind], results: object, over: Callable[[_Kind], str] = lambda _: ""
) -> list[_Kind]:
    """Return one or several results of a kind, all of one parameter, as a list."""
    found = as_list(results)
    if found is None:
        return [of_kind(kind, results, "results")]
    given = [of_kind(kind, one, f"results[{place}]") for place, one in enumerate(found)]
    if not given:
        raise ModelError(f"results: empty; give at least one {kind.__name__}")
    parameters = sorted({over(one) for one in given})
    if len(parameters) > 1:
        raise ModelError(f"results: over {' and '.join(parameters)}; draw one parameter at a time")
    return given


def dofs_of(dof: object) -> list[str]:
    """Return one or several names of degrees of freedom as a list that is not empty."""
    found = as_list(dof)
    if found is None:
        return [text(dof, "dof")]
    names = [text(one, f"dof[{place}]") for place, one in enumerate(found)]
    if not names:
        raise ModelError("dof: empty; name at least one")
    return names


def checked_labels(labels: object, default: Sequence[str]) -> Sequence[str]:
    """Return the labels of results, one each, or the default ones."""
    if labels is None:
        return default
    found = as_list(labels)
    if found is None:
        raise ModelError(f"labels: {brief(labels)} is not a list; give one text per result")
    given = [text(label, f"labels[{place}]") for place, label in enumerate(found)]
    if len(given) != len(default):
        raise ModelError(f"labels: {len(given)} for {len(default)} results; give one each")
    return given


def solved_points(result: ForcedResponse, index: int | Sequence[int]) -> list[int]:
    """Return one or several points of a sweep as a list; refuse those without a solution."""
    found = as_list(index)
    indices = (index,) if found is None else found
    if not indices:
        raise ModelError("index: empty; give the position of at least one point")
    points = [result.position(one) for one in indices]
    for point in points:
        status = result.status[point]
        if not status.solved:
            raise ModelError(
                f"index: {at(result, point)} has no solution to draw ({status}). {status.advice}"
            )
    return points


def at(result: ForcedResponse, index: int, unit: OmegaUnit = "rad/s") -> str:
    """Return the frequency of a point as it is written in figures."""
    return frequency(result, result.omega[index], unit)


def frequency(result: Result, omega: float, unit: OmegaUnit) -> str:
    """Return a frequency of a result, of rotors under rpm their speed, as figures write it."""
    return f"{_FREQUENCY[unit]} = {omega_scale(unit, result).factor * omega:.5g} {unit}"


def label_of(variation: Variation) -> str:
    """Return what the axis of a varied parameter of contacts is called."""
    if variation.common == "factor":
        return f"factor on the {variation.parameter.replace('_', ' ')}"
    unit = "" if variation.unit == "1" else f" [{variation.unit}]"
    return f"{_SYMBOLS[variation.parameter]}{unit}"

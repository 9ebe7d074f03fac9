"""Motions that are too fast to be followed in time: what makes them so, and what helps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip import _core
from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.model.model import Model


class TooFast(NamedTuple):
    """What the core refuses to follow."""

    dof: int
    """The degree of freedom that moves fastest."""
    ratio: float
    """How many times faster than `omega`."""
    omega: float
    """Frequency [rad/s]."""
    most: float
    """Highest ratio that is followed."""


def refusal(error: ValueError, model: Model) -> ModelError:
    """Return what the core refuses of a model, with the names that the core does not know."""
    if not isinstance(error, _core.TooFastError):
        return ModelError(str(error))
    return too_fast(TooFast(*error.args), model)


def _written(scaling: float) -> str:
    """Write a tolerance as users do: 1e-5."""
    return f"{scaling:g}".replace("e-0", "e-")


def too_fast(
    found: TooFast, model: Model, scaling: float | None = None, larger: float | None = 1e-5
) -> ModelError:
    """Return the refusal of a motion that is too fast, which names its cause.

    That is a contact whose stiffness alone makes an ordinary mass too fast, or else the mass.
    `scaling` is the `mass_scaling` in use, `larger` one that helps.
    """
    structure = model.structure
    # A travelling wave is computed on several sectors.
    dof = found.dof % len(structure)
    name, mass = brief(structure.dofs[dof]), float(structure.mass[dof, dof])
    pace = (
        f"moves {found.ratio:.2g} times faster than omega = {found.omega:.6g} rad/s, too fast to "
        "follow in time"
    )
    # What is as stiff as the structure elsewhere is not to blame: its mass is light.
    most = float(np.abs(structure.stiffness.diagonal()).max())
    damped = found.most * found.omega * float(abs(structure.damping[dof, dof]))
    contact, held = _stiffest(model, dof)
    if held > most and most + damped <= mass * (found.most * found.omega) ** 2:
        softer = held * (found.most / found.ratio) ** 2
        reason = (
            f"contact {brief(contact)}: on its {held:.3g} N/m dof {name} of {mass:.3g} kg {pace}; "
            f"make it softer than {softer:.2g} N/m"
        )
        return ModelError(
            f"{reason}, or balance harmonics with forced_response",
            study=f"{reason}, or balance harmonics with kind 'forced-response'",
        )
    slowed = "" if scaling is None else f", slowed by mass_scaling={_written(scaling)},"
    reason = (
        f"mass of dof {name}: with {mass:.3g} kg it{slowed} {pace}; condense this dof statically,"
    )
    call = study = ""
    if larger is not None:
        call = f" give mass_scaling={_written(larger)} to exact_response or transient,"
        study = (
            f" slow it with mass_scaling = {_written(larger)} in an analysis of kind 'exact' or "
            "'transient',"
        )
    return ModelError(
        f"{reason}{call} or balance harmonics with forced_response",
        study=f"{reason}{study} or balance harmonics with kind 'forced-response'",
    )


def _stiffest(model: Model, dof: int) -> tuple[str, float]:
    """Return the contact that holds a degree of freedom most stiffly, and its stiffness [N/m]."""
    held = [
        sum(
            float(rows[:, dof] @ one.stuck_stiffness @ rows[:, dof])
            for rows in model.contact_rows(one)
        )
        for one in model.contacts
    ]
    if not held:
        return "", 0.0
    stiffest = int(np.argmax(held))
    return model.contact_names[stiffest], held[stiffest]

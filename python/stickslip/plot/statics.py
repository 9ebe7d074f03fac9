"""Forces at rest."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Drawing
from stickslip.results.static_response import StaticResponse


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

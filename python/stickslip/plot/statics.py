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
    names, tractions, allowed = [], [], []
    for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
        for point in range(contact.points):
            force = np.atleast_1d(result.contact_force((name, point)))
            has_normal = "N" in contact.components
            names.append(name if contact.points == 1 else f"{name} {point}")
            tractions.append(float(np.linalg.norm(force[:-1] if has_normal else force)))
            allowed.append(contact.friction_at(point, force))
    if not names:
        raise ModelError("static_forces: the model has no contact")
    place = np.arange(len(names))
    finite = [one if np.isfinite(one) else np.nan for one in allowed]
    ax.bar(place, finite, 0.8, color="0.88", label="friction limit")
    ax.bar(place, tractions, 0.5, color=style.BLUE, label="traction")
    ax.set_xticks(place, names, rotation=30 if len(names) > 4 else 0)
    ax.set(ylabel="force [N]", ylim=(0.0, None))

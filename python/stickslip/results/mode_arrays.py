"""The columns of a nonlinear mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from stickslip.results.arrays import Float, Int, PeriodicArrays
from stickslip.results.dataset import Stored
from stickslip.results.fields import column


def _unbounded(file: Stored) -> Float:
    return np.full((*file["omega"].values.shape, 2), np.nan)


class ModeArrays(PeriodicArrays):
    """The numbers of a nonlinear mode, in the order of its branch.

    At amplitudes that were not reached all but the amplitude is not-a-number.
    """

    along = "mode_point"
    labels: ClassVar[Mapping[str, Sequence[str]]] = {"mode_entry": ("omega", "damping_ratio")}

    omega: Float = column("*", "rad/s", "angular frequency of the mode")
    amplitude: Float = column(
        "*",
        "m kg^(1/2)",
        "modal amplitude (X_1^H M X_1)^(1/2), of the mass-normalised fundamental",
        least=0.0,
        file_name="modal_amplitude",
    )
    damping_ratio: Float = column("*", "1", "modal damping ratio, viscous damping included")
    viscous_ratio: Float = column("*", "1", "part of it that is due to viscous damping")
    force_level: Float = column(
        "*",
        "1",
        "multiple of the forces of harmonic 1 that keep the motion up in quadrature",
        absent=np.nan,
    )
    relative_error: Float = column(
        "* mode_entry",
        "1",
        "what the discarded harmonics could still change, relative to frequency and damping",
        least=0.0,
    )
    residual: Float = column(
        "*", "1", "residual of the equations, relative to the motion", least=0.0
    )
    resonance_order: Int = column(
        "*", "1", "order of a harmonic in internal resonance, 0 if there is none", least=0
    )
    resonance_omega: Float = column(
        "*", "rad/s", "natural frequency of the stuck structure that it meets"
    )
    resonance_share: Float = column("*", "1", "modal amplitude of that harmonic over the amplitude")
    omega_bounds: Float = column(
        "* bound",
        "rad/s",
        "least and largest angular frequency over residual tractions",
        absent=_unbounded,
    )
    damping_bounds: Float = column(
        "* bound",
        "1",
        "least and largest damping ratio over residual tractions",
        absent=_unbounded,
    )
    turns: Float = column("turn", "m kg^(1/2)", "amplitudes at which the branch turns")
    linear: Float = column("mode_entry", "1", "natural frequency and damping ratio at rest")

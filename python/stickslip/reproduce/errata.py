"""What is wrong in the printed dissertation, as far as its tables and figures are concerned."""

from __future__ import annotations

__all__ = [
    "BLADE_FREQUENCIES",
    "BROYDEN",
    "ERROR_ROW",
    "MISPRINTED_LEVEL",
    "MISPRINTED_STIFFNESS",
    "OPTIMUM",
    "PHASES",
    "RETURN_MAP",
    "SINGLE_HARMONIC",
    "SLIPPING_FREQUENCY",
]

SINGLE_HARMONIC = (
    "Eq. (2.13) has the wrong sign in print; corrected: "
    "a = (A/π) (θ_C − sin(2 θ_C)/2), for A ≥ F_d/k_d."
)

PHASES = (
    "Eqs. (2.40)-(2.43) drop the phases between the dampers, which for travelling waves is wrong "
    "by up to a factor of two; corrected: complex amplitudes, 2 N_d real unknowns."
)

RETURN_MAP = (
    "Table 3.1 has no return map and, as printed, never unloads a contact, and Eq. (3.2) reverses "
    "the sign of slip; corrected: f_j = clip(f_(j-1) + k_d Δu, −F_d, F_d)."
)

BROYDEN = "Eq. (3.33): the denominator of Broyden's update is the squared norm of the step."

ERROR_ROW = (
    "The printed error row divides now by one, now by the other amplitude; corrected: all errors "
    "refer to the exact peak."
)

OPTIMUM = (
    "The optimal levels of the text hold among the eight printed loads only; over a continuous "
    "load the optimum lies elsewhere, see the numbers."
)

MISPRINTED_LEVEL = "The load of 16.653 N in the text on Fig. 2.10 is 16.563 N."

MISPRINTED_STIFFNESS = "The coupling stiffness 7.10^3 N/m of the caption is 7000 N/m."

SLIPPING_FREQUENCY = (
    "The slipping frequency of 159.39 rad/s in the text is that of the single DOF; corrected: "
    "159.5927 rad/s for the beam."
)

BLADE_FREQUENCIES = (
    "The text speaks of 7 % deviation of the frequencies, the formula E_i = (1 + S r_i) E_0 gives "
    "7 % to the stiffness; the formula is used."
)

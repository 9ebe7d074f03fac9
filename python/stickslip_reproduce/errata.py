"""What is wrong in the printed dissertation, as far as its tables and figures are concerned."""

from __future__ import annotations

__all__ = [
    "BLADE_FREQUENCIES",
    "BROYDEN",
    "CUT_LINKS",
    "ERROR_ROW",
    "FIRST_FOLD",
    "HARMONICS_OF_MODE_1",
    "MISPRINTED_LEVEL",
    "MISPRINTED_STIFFNESS",
    "MODAL_COEFFICIENTS",
    "OPTIMUM",
    "PHASES",
    "PRELOAD",
    "RETURN_MAP",
    "RIGID",
    "ROW_OF_MASS",
    "SEVERAL_HUNDREDS",
    "SINGLE_CYCLE",
    "SINGLE_HARMONIC",
    "SLIPPING_FREQUENCY",
    "TWO_ORBITS",
    "UNSIGNED",
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

SEVERAL_HUNDREDS = (
    "The text says that time integration takes several hundreds of times as long; by its own table "
    "it is 170 to 2000 times for the beam and 400 to 17000 times for the blade."
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

SINGLE_CYCLE = "Eq. (5.6) repeats the wrong sign of Eq. (2.13)."

RIGID = (
    "Eqs. (5.16) and (5.20) lack a minus sign, A = 0 does not satisfy (5.18), and 2.65e-4 m is not "
    "what (5.20) gives at r = 1: corrected 2.5527e-4 m, exactly 2.5533e-4 m."
)

ROW_OF_MASS = (
    "Row 1 of Table 5.3 belongs to the single DOF; corrected for the beam: 225.66 and 159.59 rad/s."
)

FIRST_FOLD = (
    "Mode 1 ends at 4.9 in print, where the exact branch has a local fold, r = 4.878; it dips to "
    "4.774 and turns for good at 5.169. That this fold is the printed end is not proven: 3 "
    "harmonics, as in print, fold at 5.288 only, too few as the 7th lies near mode 2."
)

UNSIGNED = (
    "That mode 3 is unstable below r = 2 comes from starts without the signs of mode 3 (+, +, −); "
    "corrected: its sticking orbits are stable up to r = 4.686."
)

HARMONICS_OF_MODE_1 = (
    "The 5th and 7th harmonics, said to be missing in the balance, are 4 % and 8 % of the "
    "fundamental of x₃ there."
)

MODAL_COEFFICIENTS = (
    "Eqs. (5.27)-(5.29): T is orthogonal with respect to M only, C = T^(−T) diag(c) T^(−1); (5.30) "
    "is printed in reverse order. Used as printed: c_3 = −12.095 r on the mode of 2167 rad/s."
)

TWO_ORBITS = "The solution is not unique: there are two orbits for every r below r_max."

PRELOAD = (
    "Section 6.3.4: f(0) = 0 with x(0) ≠ 0 freezes a spurious preload in contacts that never slip, "
    "which makes the printed offsets and slip sets; corrected: no force without displacement."
)

CUT_LINKS = (
    "The printed values delete the links of slipping contacts, against Eqs. (6.14)-(6.17); "
    "corrected: condensed. With 1 and 3 slipping the beams are not independent (547.54 rad/s)."
)

//! Describing functions: what a law does to the first harmonic of a harmonic displacement.

use faer::c64;
use std::f64::consts::PI;

/// The first harmonic of the force under u = Re U e^{iθ}, as a complex stiffness: `F_1 = K(A) U`
/// with A = |U|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Describing {
    /// K(A) [N/m]; its imaginary part dissipates.
    pub stiffness: c64,
    /// dK/dA [N/m²].
    pub slope: c64,
    /// Share of the period in slip.
    pub slip_fraction: f64,
}

impl Describing {
    /// Of an elastic, perfectly plastic element of stiffness k_d and slip force F_d under the
    /// amplitude A: `K = k_d (a − i b)/A` with a and b of Griffin (1980), that is Guillen (1999),
    /// eqs. (2.12)-(2.14), the sign of (2.13) corrected. The formulas hold for A >= F_d/k_d;
    /// below it the element sticks.
    #[must_use]
    pub fn of_jenkins(stiffness: f64, slip_force: f64, amplitude: f64) -> Self {
        if stiffness * amplitude <= slip_force && slip_force > 0.0 || stiffness == 0.0 {
            let zero = c64::new(0.0, 0.0);
            return Self { stiffness: c64::new(stiffness, 0.0), slope: zero, slip_fraction: 0.0 };
        }
        // δ/A; an element without slip force slips at rest already.
        let ratio = if slip_force == 0.0 { 0.0 } else { slip_force / (stiffness * amplitude) };
        let theta = (1.0 - 2.0 * ratio).acos();
        let sine = 2.0 * (ratio * (1.0 - ratio)).sqrt();
        let in_phase = (theta - sine * (1.0 - 2.0 * ratio)) / PI;
        let quadrature = 4.0 / PI * ratio * (1.0 - ratio);
        let by_ratio = c64::new(4.0 / PI * sine, 4.0 / PI * (1.0 - 2.0 * ratio));
        let slope = if ratio == 0.0 { 0.0 } else { -ratio / amplitude };
        Self {
            stiffness: c64::new(stiffness * in_phase, stiffness * quadrature),
            slope: by_ratio * (stiffness * slope),
            slip_fraction: 1.0 - theta / PI,
        }
    }
}

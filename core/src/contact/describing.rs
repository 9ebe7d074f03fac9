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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_stiffness_and_both_are_continuous_at_slip() {
        let (k, f) = (3.0, 1.2);
        let delta = f / k;
        for ratio in [1.001, 1.3, 2.0, 7.0, 900.0] {
            let (amplitude, h) = (ratio * delta, 1e-6 * delta);
            let at = |a| Describing::of_jenkins(k, f, a).stiffness;
            let slope = (at(amplitude + h) - at(amplitude - h)) / (2.0 * h);
            let exact = Describing::of_jenkins(k, f, amplitude).slope;
            assert!((slope - exact).norm() < 1e-5 * k / delta, "{ratio}: {slope} {exact}");
        }
        let (before, after) = (
            Describing::of_jenkins(k, f, delta),
            Describing::of_jenkins(k, f, delta * (1.0 + 1e-12)),
        );
        assert!((before.stiffness - after.stiffness).norm() < 1e-11 * k);
        assert_eq!((before.slip_fraction, before.stiffness.re), (0.0, k));
    }

    #[test]
    fn elements_without_friction_or_spring_carry_nothing() {
        let zero = c64::new(0.0, 0.0);
        for amplitude in [0.0, 2.0] {
            for (k, f) in [(3.0, 0.0), (0.0, 1.0)] {
                let found = Describing::of_jenkins(k, f, amplitude);
                assert_eq!((found.stiffness, found.slope), (zero, zero), "{k} {f} {amplitude}");
            }
        }
        let found = Describing::of_jenkins(3.0, f64::INFINITY, 1.0);
        assert_eq!(found.stiffness, c64::new(3.0, 0.0));
    }
}

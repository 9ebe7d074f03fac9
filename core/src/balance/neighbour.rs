//! What the error estimate at a point tells of those beside it on a curve.
//!
//! A solution that starts from its neighbour takes two Newton steps instead of six, and its estimate should
//! not take longer. How much the second step of an estimate adds to the first one changes slowly along a
//! curve: what was found at one point holds for a few after it, as long as the first step makes no contact
//! begin or cease to slip.

use super::solution::Point;

/// Points are beside one another up to this distance in frequency, relative to it.
const NEAR: f64 = 0.02;
/// Points in a row that the second step at one before them serves.
const SERVED: usize = 7;

/// The point at which an estimate made its second step last.
#[derive(Default)]
pub(super) struct Neighbour {
    omega: f64,
    harmonics: usize,
    /// Error after the second step over that after the first, of each observed DOF; empty where it is
    /// not known.
    growth: Vec<f64>,
    served: usize,
}

impl Neighbour {
    /// What the second step would add at a point beside.
    pub(super) fn growth(&mut self, point: &Point) -> Option<Vec<f64>> {
        let near = (self.omega - point.omega).abs() <= NEAR * self.omega;
        let suits = near && self.harmonics == point.harmonics && self.served < SERVED;
        self.served += 1;
        (suits && !self.growth.is_empty()).then(|| self.growth.clone())
    }

    /// Learns from a point at which the second step was made.
    pub(super) fn learn(&mut self, point: &Point, growth: Vec<f64>) {
        *self = Self { omega: point.omega, harmonics: point.harmonics, growth, served: 0 };
    }
}

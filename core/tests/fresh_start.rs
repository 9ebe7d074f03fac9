//! Balances that Newton's method fails to solve start afresh from exact orbits.

#![allow(clippy::unwrap_used)]

mod common;

use common::System;
use faer::{c64, mat, Mat};
use std::cell::Cell;
use stickslip_core::balance::{
    sweep, ExactOrbits, ForcedBalance, HarmonicChoice, Point, PointStatus, Settings,
};
use stickslip_core::contact::Residual;
use stickslip_core::orbit::OrbitInitialGuess;

/// Two masses with a damper between them, three hundred times as stiff as they are, and hardly any
/// viscous damping.
fn stiff_and_light() -> System {
    let mass = mat![[1.892_316_533_4, 0.0], [0.0, 0.605_630_864_3]];
    let stiffness = mat![[17_244.275_468_6, -5_294.091_667_5], [-5_294.091_667_5, 2_245.995_710_8]];
    System {
        damping: Mat::from_fn(2, 2, |i, j| 2e-6 * stiffness[(i, j)]),
        mass,
        stiffness,
        dampers: vec![(1, Some(0), 5.516_228_737e6, 0.307_28)],
        forces: vec![(0, 1, 1.0, 0.0)],
    }
}

/// Exact orbits, and how often they were asked for and found.
struct Counted<'a> {
    rescue: OrbitInitialGuess<'a>,
    asked: Cell<usize>,
    answered: Cell<usize>,
}

impl ExactOrbits for Counted<'_> {
    fn orbit(&self, omega: f64, highest: usize) -> Option<Point> {
        self.asked.set(self.asked.get() + 1);
        let start = self.rescue.orbit(omega, highest)?;
        self.answered.set(self.answered.get() + 1);
        assert_eq!(start.contact_displacement.len(), highest + 1);
        Some(start)
    }

    fn price(&self, omega: f64, events: usize, highest: usize) -> Option<f64> {
        self.rescue.price(omega, events, highest)
    }

    fn settled(&self, omega: f64, highest: usize) -> Option<Vec<c64>> {
        self.rescue.settled(omega, highest)
    }

    fn is_one_of_many(&self, omega: f64) -> bool {
        self.rescue.is_one_of_many(omega)
    }
}

#[test]
fn stiff_dampers_on_lightly_damped_structures_are_solved() {
    let model = stiff_and_light().model();
    let omega: Vec<f64> = (0..60).map(|i| 150.0 + 0.6 * f64::from(i)).collect();
    let progress = |_: f64| true;
    let rescue = OrbitInitialGuess::new(&model, Residual::Centred, &[], &progress);
    let counted = Counted { rescue, asked: Cell::new(0), answered: Cell::new(0) };
    for highest in [7, 9, 15] {
        let mut settings =
            Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() };
        // Enough from a good start alone.
        settings.newton.max_iterations = 12;
        let balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
        let solution = sweep(balance.rescued(&counted), &omega).unwrap();
        for point in &solution.points {
            assert_eq!(point.status, PointStatus::Converged, "{highest} {}", point.omega);
        }
    }
    assert!(counted.asked.get() > 0, "the case is too easy to need a fresh start");
    assert_eq!(counted.answered.get(), counted.asked.get());
}

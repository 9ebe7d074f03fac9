//! Balances that Newton's method fails to solve start afresh from exact orbits.

#![allow(clippy::unwrap_used)]

mod common;

use common::System;
use faer::{mat, Mat};
use std::cell::Cell;
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, PointStatus, Settings};
use stickslip_core::contact::Residual;
use stickslip_core::orbit::Rescue;

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

#[test]
fn stiff_dampers_on_lightly_damped_structures_are_solved() {
    let model = stiff_and_light().model();
    let omega: Vec<f64> = (0..60).map(|i| 150.0 + 0.6 * f64::from(i)).collect();
    let progress = |_: f64| true;
    let rescue = Rescue::new(&model, Residual::Centred, &progress);
    let (asked, answered) = (Cell::new(0), Cell::new(0));
    let fresh_start = |omega: f64, highest: usize| {
        asked.set(asked.get() + 1);
        let start = rescue.amplitudes(omega, highest)?;
        answered.set(answered.get() + 1);
        assert_eq!(start.len(), highest + 1);
        Some(start)
    };
    for highest in [7, 9, 15] {
        let mut settings =
            Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() };
        // Enough from a good start alone.
        settings.newton.max_iterations = 12;
        let balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
        let solution = sweep(balance.rescued(&fresh_start), &omega).unwrap();
        for point in &solution.points {
            assert_eq!(point.status, PointStatus::Converged, "{highest} {}", point.omega);
        }
    }
    assert!(asked.get() > 0, "the case is too easy to need a fresh start");
    assert_eq!(answered.get(), asked.get());
}

//! Random passive systems: solved, in energy balance, and the same from either direction.

#![allow(clippy::unwrap_used)]

mod common;

use common::passive::passive_system;
use proptest::prelude::*;
use std::f64::consts::PI;
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, PointStatus, Settings};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn converged_balanced_and_unique(system in passive_system()) {
        let model = system.model();
        let n = system.dofs();
        let observe: Vec<usize> = (0..n).collect();
        let settings = Settings { harmonics: HarmonicChoice::Fixed(9), ..Settings::default() };
        let omega: Vec<f64> = (1..9).map(|i| i as f64 * 4.1).collect();
        let back: Vec<f64> = omega.iter().rev().copied().collect();
        let run = |omega: &[f64]| {
            sweep(ForcedBalance::new(&model, settings, &observe).unwrap(), omega).unwrap()
        };
        let (up, down) = (run(&omega), run(&back));
        for (point, other) in up.points.iter().zip(down.points.iter().rev()) {
            prop_assert_eq!(point.status, PointStatus::Converged);
            prop_assert_eq!(other.status, PointStatus::Converged);
            let orders = point.harmonics + 1;
            let size = point.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
            for (a, b) in point.displacement.iter().zip(&other.displacement) {
                prop_assert!((a - b).norm() <= 1e-6 * size);
            }
            // Work of the forces = viscous + friction work, per period.
            let x = |dof: usize, k: usize| point.displacement[dof * orders + k];
            let input: f64 = system
                .forces
                .iter()
                .map(|&(dof, _, f, phase)| -PI * f * (x(dof, 1) * faer::c64::from_polar(1.0, -phase)).im)
                .sum();
            let viscous: f64 = (1..orders)
                .map(|k| {
                    let quadratic: f64 = (0..n)
                        .flat_map(|i| (0..n).map(move |j| (i, j)))
                        .map(|(i, j)| system.damping[(i, j)] * (x(i, k) * x(j, k).conj()).re)
                        .sum();
                    PI * (k * k) as f64 * point.omega * quadratic
                })
                .sum();
            let friction: f64 = point.contacts.iter().map(|c| c.dissipation).sum();
            prop_assert!(friction >= 0.0);
            let error = (input - viscous - friction).abs();
            prop_assert!(error <= 1e-7 * input.abs().max(viscous + friction), "{} {} {}", input, viscous, friction);
        }
    }
}

//! Random passive systems: every solver and evaluation finds the same motion.

#![allow(clippy::unwrap_used)]

mod common;

use common::passive::passive_system;
use proptest::prelude::*;
use stickslip_core::balance::{
    single_harmonic, sweep, ForcedBalance, HarmonicChoice, Method, PointStatus, Settings, Solution,
};
use stickslip_core::model::{MarchedLaws, Model};
use stickslip_core::solve::FirstJacobian;

fn observe(model: &Model) -> Vec<usize> {
    (0..model.compliance().dofs()).collect()
}

fn solve(model: &Model, highest: usize, method: Method, omega: &[f64]) -> Solution {
    let harmonics = HarmonicChoice::Fixed(highest);
    let settings = Settings { harmonics, method, ..Settings::default() };
    sweep(ForcedBalance::new(model, settings, &observe(model)).unwrap(), omega).unwrap()
}

/// Largest difference of any harmonic, relative to the largest harmonic of the point.
fn difference(one: &Solution, other: &Solution) -> Result<f64, TestCaseError> {
    let mut worst = 0.0_f64;
    for (p, q) in one.points.iter().zip(&other.points) {
        prop_assert_eq!(p.status, PointStatus::Converged);
        prop_assert_eq!(q.status, PointStatus::Converged);
        let size = q.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
        for (a, b) in p.displacement.iter().zip(&q.displacement) {
            worst = worst.max((a - b).norm() / size);
        }
    }
    Ok(worst)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_solver_finds_the_same_motion(system in passive_system()) {
        let model = system.model();
        let omega: Vec<f64> = (1..20).map(|i| f64::from(i) * 1.8).collect();
        let newton = solve(&model, 9, Method::Newton, &omega);
        for first in [FirstJacobian::Exact, FirstJacobian::Differences] {
            let broyden = solve(&model, 9, Method::Broyden(first), &omega);
            let worst = difference(&broyden, &newton)?;
            prop_assert!(worst < 1e-7, "{:?}: {}", first, worst);
        }
        // The march costs more: only where the lowest modes are.
        let few = &omega[4..9];
        let marched = solve(&model.marched(1024, MarchedLaws::All).unwrap(), 9, Method::Newton, few);
        let worst = difference(&marched, &solve(&model, 9, Method::Newton, few))?;
        prop_assert!(worst < 1e-3, "marched: {}", worst);
        prop_assert!(marched.points.iter().all(|p| p.contacts.iter().all(|c| c.dissipation >= 0.0)));
        let one = solve(&model, 1, Method::Newton, &omega);
        let settings = Settings { harmonics: HarmonicChoice::Fixed(1), ..Settings::default() };
        let observe = observe(&model);
        let balance = ForcedBalance::new(&model, settings, &observe).unwrap();
        let single = single_harmonic(balance, &omega, true).unwrap();
        let worst = difference(&single, &one)?;
        prop_assert!(worst < 1e-8, "single harmonic: {}", worst);
    }
}

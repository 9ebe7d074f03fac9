//! Broyden's method against Newton's, on every load and number of harmonics of the dissertation.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::grid;
use common::{beam_pair, snecma_beam};
use stickslip_core::balance::{
    sweep, sweep_range, ForcedBalance, HarmonicChoice, Method, PointStatus, Settings, Solution,
};
use stickslip_core::model::Model;
use stickslip_core::solve::FirstJacobian;

const LOADS: [f64; 8] = [0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438];
const BROYDEN: Method = Method::Broyden(FirstJacobian::Exact);

fn solve(model: &Model, highest: usize, method: Method, omega: &[f64]) -> Solution {
    let harmonics = HarmonicChoice::Fixed(highest);
    let settings = Settings { harmonics, method, ..Settings::default() };
    let observe: Vec<usize> = (0..model.compliance().dofs()).collect();
    sweep(ForcedBalance::new(model, settings, &observe).unwrap(), omega).unwrap()
}

/// Largest change of the harmonics of any DOF, relative to its largest one, and of its estimate.
fn difference(one: &Solution, other: &Solution) -> (f64, f64) {
    let (mut worst, mut of_estimates) = (0.0_f64, 0.0_f64);
    for (p, q) in one.points.iter().zip(&other.points) {
        assert_eq!(p.status, PointStatus::Converged, "{} rad/s", p.omega);
        assert_eq!(q.status, PointStatus::Converged, "{} rad/s", p.omega);
        let orders = p.harmonics + 1;
        for (a, b) in p.displacement.chunks(orders).zip(q.displacement.chunks(orders)) {
            let size = b.iter().map(|x| x.norm()).fold(0.0, f64::max);
            let change = a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            worst = worst.max(change / size);
        }
        for (dof, (a, b)) in p.error_estimate.iter().zip(&q.error_estimate).enumerate() {
            let size = q.displacement[dof * orders + 1].norm();
            of_estimates = of_estimates.max((a - b).abs() / size);
        }
    }
    (worst, of_estimates)
}

/// No point needs homotopy, and hardly any a second Jacobian.
#[test]
fn every_point_of_every_load_agrees_with_newton() {
    let omega = grid(20.0, 350.0, 400);
    for load in LOADS {
        let model = snecma_beam(load).model();
        for highest in [1, 3, 9, 15, 21] {
            let newton = solve(&model, highest, Method::Newton, &omega);
            for method in [BROYDEN, Method::Broyden(FirstJacobian::Differences)] {
                let broyden = solve(&model, highest, method, &omega);
                let (worst, of_estimates) = difference(&broyden, &newton);
                let case = format!("{load} N, H = {highest}, {method:?}");
                assert!(worst < 1e-9 && of_estimates < 1e-8, "{case}: {worst:e} {of_estimates:e}");
                let profile = broyden.profile;
                assert_eq!(profile.homotopies, 0, "{case}");
                assert!(profile.restarts <= 40, "{case}: {} restarts", profile.restarts);
                // One Jacobian per point and restart; all other steps are updates.
                assert!(profile.factorisations <= 400 + 2 * profile.restarts, "{case}");
                assert!(profile.updates < 4 * omega.len(), "{case}: {}", profile.updates);
            }
        }
    }
}

#[test]
fn coupled_contacts_stuck_ones_and_a_static_load() {
    let mut system = beam_pair(60.0);
    system.dampers[1].3 *= 4.0;
    let omega: Vec<f64> = (0..80).map(|i| 120.0 + 1.5 * f64::from(i)).collect();
    for static_load in [0.0, 400.0] {
        system.forces.push((3, 0, static_load, 0.0));
        let model = system.model();
        let newton = solve(&model, 7, Method::Newton, &omega);
        let stuck = |p: &stickslip_core::balance::Point| {
            p.contacts.iter().filter(|contact| contact.slip_fraction == 0.0).count()
        };
        assert!(newton.points.iter().any(|p| stuck(p) == 1 || stuck(p) == 2));
        for method in [BROYDEN, Method::Broyden(FirstJacobian::Differences)] {
            let (worst, _) = difference(&solve(&model, 7, method, &omega), &newton);
            assert!(worst < 1e-8, "{static_load} N, {method:?}: {worst:e}");
        }
    }
}

#[test]
fn a_range_and_automatic_harmonics_work_as_with_newton() {
    let model = snecma_beam(20.313).model();
    let settings = Settings { method: BROYDEN, ..Settings::default() };
    let run = |settings| {
        let balance = ForcedBalance::new(&model, settings, &[1]).unwrap();
        sweep_range(balance, 150.0, 230.0).unwrap()
    };
    let (broyden, newton) = (run(settings), run(Settings::default()));
    assert_eq!(broyden.points.len(), newton.points.len());
    let (worst, _) = difference(&broyden, &newton);
    assert!(worst < 1e-8, "{worst:e}");
}

/// Too few iterations for Broyden's method: homotopy, which is Newton's, finds the solution.
#[test]
fn a_failure_falls_back_to_homotopy() {
    let mut beam = snecma_beam(31.475);
    beam.dampers[0].2 = 2.4e10;
    let model = beam.model();
    let omega = [168.0];
    let harmonics = HarmonicChoice::Fixed(21);
    let mut settings = Settings { harmonics, method: BROYDEN, ..Settings::default() };
    settings.newton.max_iterations = 8;
    let run =
        |settings| sweep(ForcedBalance::new(&model, settings, &[1]).unwrap(), &omega).unwrap();
    let short = run(settings);
    settings.newton.max_iterations = 50;
    settings.method = Method::Newton;
    assert_eq!(short.profile.homotopies, 1);
    let (worst, _) = difference(&short, &run(settings));
    assert!(worst < 1e-8, "{worst:e}");
}

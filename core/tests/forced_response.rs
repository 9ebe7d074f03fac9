//! Forced responses against the dissertation's converged tables and fine Runge-Kutta.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{amplitude_of, fixed, grid, peak_of, solve};
use common::{beam_pair, runge_kutta, single_dof, snecma_beam, System};
use stickslip_core::balance::{sweep, sweep_range, ForcedBalance, PointStatus, Settings, Solution};
use stickslip_core::contact::Residual;
use stickslip_core::fourier::Measure;

fn largest(solution: &Solution, dof: usize) -> (f64, f64) {
    solution
        .points
        .iter()
        .map(|p| (amplitude_of(p, solution.half_wave, dof, Measure::HalfRange), p.omega))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
}

fn all_converged(solution: &Solution) -> bool {
    solution.points.iter().all(|p| p.status == PointStatus::Converged)
}

#[test]
fn tip_peaks_of_the_beam_by_harmonics() {
    let beam = snecma_beam(20.313);
    for (highest, peak) in
        [(1, 1.364684e-3), (3, 1.490380e-3), (9, 1.514972e-3), (15, 1.456342e-3), (21, 1.453190e-3)]
    {
        let curve = solve(&beam, fixed(highest), &grid(20.0, 350.0, 400));
        assert!(all_converged(&curve) && curve.half_wave);
        let (got, _) = largest(&curve, 1);
        assert!((got / peak - 1.0).abs() < 1e-4, "H = {highest}: {got}");
    }
}

#[test]
fn peaks_of_the_beam_by_load() {
    let table = [
        (0.938, 0.3709e-3, 225.58, 0.5700e-5, 225.60),
        (2.188, 0.6778e-3, 224.19, 1.1279e-5, 225.47),
        (6.563, 0.7216e-3, 216.49, 2.1158e-5, 221.64),
        (16.563, 1.2175e-3, 194.01, 6.2856e-5, 195.40),
        (20.313, 1.4548e-3, 192.93, 8.7471e-5, 191.49),
        (25.0, 1.8185e-3, 177.98, 13.0627e-5, 178.99),
        (31.475, 2.9847e-3, 169.05, 24.8364e-5, 168.78),
        (38.438, 6.0031e-3, 162.43, 50.9307e-5, 162.65),
    ];
    let omega = grid(20.0, 350.0, 400);
    for (load, tip, tip_omega, damper, damper_omega) in table {
        let beam = snecma_beam(load);
        let curve = solve(&beam, fixed(35), &omega);
        assert!(all_converged(&curve));
        let model = beam.model();
        for (dof, peak, at) in [(1, tip, tip_omega), (0, damper, damper_omega)] {
            let (height, guess) = largest(&curve, dof);
            let span = (guess - 1.0, guess + 1.0);
            let (omega, got) = peak_of(&model, fixed(35), dof, Measure::HalfRange, span);
            assert!(got >= height, "{load} N: refined below the grid");
            assert!((got / peak - 1.0).abs() < 2e-3, "{load} N, DOF {dof}: {got}");
            assert!((omega - at).abs() < 0.05, "{load} N, DOF {dof}: {omega}");
        }
    }
}

#[test]
fn peaks_by_damper_stiffness() {
    // Stiffer dampers hold the beam still for longer, which takes more harmonics.
    let table = [
        (2.4e4, 98.09e-5, 35),
        (2.4e5, 92.44e-5, 35),
        (2.4e6, 24.020e-5, 35),
        (2.4e8, 6.9825e-5, 101),
        (2.4e9, 6.7453e-5, 101),
    ];
    for (stiffness, peak, highest) in table {
        let mut beam = snecma_beam(20.313);
        beam.dampers[0].2 = stiffness;
        let curve = solve(&beam, fixed(highest), &grid(150.0, 230.0, 161));
        assert!(all_converged(&curve));
        let (height, guess) = largest(&curve, 0);
        let span = (guess - 0.5, guess + 0.5);
        let (_, got) = peak_of(&beam.model(), fixed(highest), 0, Measure::HalfRange, span);
        assert!(got >= height);
        assert!((got / peak - 1.0).abs() < 2e-3, "{stiffness:e}: {got}");
    }
}

#[test]
fn single_dof_with_its_subresonances() {
    for (ratio, peak, at) in
        [(0.5, 1.49967e-5, 209.21), (1.0, 2.93748e-5, 182.09), (2.0, 15.98269e-5, 161.24)]
    {
        let system = single_dof(ratio);
        let curve = solve(&system, fixed(35), &grid(20.0, 350.0, 400));
        assert!(all_converged(&curve));
        let (_, guess) = largest(&curve, 0);
        let span = (guess - 0.8, guess + 0.8);
        let (omega, got) = peak_of(&system.model(), fixed(35), 0, Measure::HalfRange, span);
        assert!((got / peak - 1.0).abs() < 2e-4, "{ratio}: {got}");
        assert!((omega - at).abs() < 0.02, "{ratio}: {omega}");
    }
    // Local maxima well below the resonance, fed by the higher harmonics of friction.
    let curve = solve(&single_dof(2.0), fixed(61), &grid(20.0, 90.0, 701));
    let heights: Vec<f64> = curve
        .points
        .iter()
        .map(|p| amplitude_of(p, curve.half_wave, 0, Measure::HalfRange))
        .collect();
    let maxima: Vec<f64> = (1..heights.len() - 1)
        .filter(|&i| heights[i] > heights[i - 1] && heights[i] > heights[i + 1])
        .map(|i| curve.points[i].omega)
        .collect();
    for subresonance in [66.1, 41.6, 30.3, 23.8] {
        assert!(
            maxima.iter().any(|omega| (omega - subresonance).abs() < 0.15),
            "{subresonance} not in {maxima:?}"
        );
    }
}

#[test]
fn two_coupled_beams_against_runge_kutta() {
    let pair = beam_pair(50.0);
    let omega = [154.0, 163.0, 175.0, 190.0];
    let curve = solve(&pair, fixed(51), &omega);
    assert!(all_converged(&curve));
    let slips: Vec<f64> =
        curve.points.iter().flat_map(|p| p.contacts.iter().map(|c| c.slip_fraction)).collect();
    assert!(slips.iter().filter(|s| **s > 0.0).count() >= 10, "{slips:?}");
    for point in &curve.points {
        let reference = runge_kutta(&pair, point.omega, 150, 8000);
        for dof in [0, 1, 3, 4] {
            let got = amplitude_of(point, curve.half_wave, dof, Measure::HalfRange);
            let error = (got / reference[dof] - 1.0).abs();
            assert!(error < 2e-3, "{} rad/s, DOF {dof}: {got} {}", point.omega, reference[dof]);
        }
    }
}

#[test]
fn several_forces_on_any_harmonic_and_a_static_load_against_runge_kutta() {
    let mut system = beam_pair(60.0);
    system.forces.push((4, 2, 6.0, -0.4));
    system.forces.push((1, 3, 4.0, 0.9));
    system.forces.push((3, 0, 400.0, 0.0));
    let settings = fixed(50);
    let curve = solve(&system, settings, &[158.0, 168.0]);
    assert!(all_converged(&curve) && !curve.half_wave);
    for point in &curve.points {
        assert!(point.contacts.iter().all(|c| c.slip_fraction > 0.0), "{:?}", point.contacts);
        let reference = runge_kutta(&system, point.omega, 150, 8000);
        for dof in [0, 1, 3, 4] {
            let got = amplitude_of(point, false, dof, Measure::HalfRange);
            let error = (got / reference[dof] - 1.0).abs();
            assert!(error < 2e-3, "{} rad/s, DOF {dof}: {got} {}", point.omega, reference[dof]);
        }
    }
}

/// Every load of the dissertation, every number of harmonics, both directions, and dampers from
/// hardly there to nearly rigid: every point converges, and to the same motion either way.
#[test]
fn every_case_converges_in_both_directions() {
    let up = grid(20.0, 350.0, 400);
    let down: Vec<f64> = up.iter().rev().copied().collect();
    let check = |load: f64| {
        for exponent in 4..=10 {
            let mut beam = snecma_beam(load);
            beam.dampers[0].2 = 2.4 * 10_f64.powi(exponent);
            for highest in [1, 3, 9, 15, 21, 35] {
                let case = format!("{load} N, {:e} N/m, H = {highest}", beam.dampers[0].2);
                let a = solve(&beam, fixed(highest), &up);
                let b = solve(&beam, fixed(highest), &down);
                assert!(all_converged(&a) && all_converged(&b), "{case}");
                for (p, q) in a.points.iter().zip(b.points.iter().rev()) {
                    let (x, y) = (
                        amplitude_of(p, true, 1, Measure::HalfRange),
                        amplitude_of(q, true, 1, Measure::HalfRange),
                    );
                    assert!((x / y - 1.0).abs() < 1e-6, "{case}, {} rad/s: {x} {y}", p.omega);
                }
            }
        }
    };
    std::thread::scope(|scope| {
        for load in [0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438] {
            let check = &check;
            scope.spawn(move || check(load));
        }
    });
}

#[test]
fn a_range_gets_its_steps_and_harmonics_from_the_tolerance() {
    let beam = snecma_beam(20.313);
    let model = beam.model();
    for tolerance in [1e-2, 1e-3] {
        let settings = Settings { tolerance, max_harmonics: 121, ..Settings::default() };
        for (from, to) in [(100.0, 350.0), (350.0, 100.0)] {
            let balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
            let curve = sweep_range(balance, from, to).unwrap();
            assert!(all_converged(&curve));
            assert_eq!(curve.points[0].omega, from);
            assert_eq!(curve.points[curve.points.len() - 1].omega, to);
            for pair in curve.points.windows(2) {
                assert!((pair[1].omega - pair[0].omega) * (to - from) > 0.0);
                // A straight line holds to a few times the tolerance in the middle of each step.
                let middle = 0.5 * (pair[0].omega + pair[1].omega);
                let between = solve(&beam, fixed(83), &[middle]);
                let exact = amplitude_of(&between.points[0], true, 1, Measure::HalfRange);
                let line = 0.5
                    * (amplitude_of(&pair[0], true, 1, Measure::HalfRange)
                        + amplitude_of(&pair[1], true, 1, Measure::HalfRange));
                assert!((line / exact - 1.0).abs() < 5.0 * tolerance, "{middle}: {line} {exact}");
            }
        }
    }
}

/// Three masses in a row with opposite forces on the outer ones: the middle one stays at rest.
fn antisymmetric_row() -> System {
    System {
        mass: faer::Mat::identity(3, 3),
        damping: faer::mat![[1.0, -0.3, 0.0], [-0.3, 0.9, -0.3], [0.0, -0.3, 1.0]],
        stiffness: faer::mat![[1e3, -3e2, 0.0], [-3e2, 9e2, -3e2], [0.0, -3e2, 1e3]],
        dampers: vec![(0, None, 500.0, 1.0), (2, None, 500.0, 1.0)],
        forces: vec![(0, 1, 2.0, 0.0), (2, 1, -2.0, 0.0)],
    }
}

#[test]
fn a_dof_that_symmetry_keeps_still_costs_nothing() {
    let system = antisymmetric_row();
    let model = system.model();
    let balance = ForcedBalance::new(&model, fixed(7), &[0, 1, 2]).unwrap();
    let curve = sweep_range(balance, 20.0, 50.0).unwrap();
    assert!(all_converged(&curve) && curve.points.len() < 400, "{}", curve.points.len());
    let curve = solve(&system, Settings::default(), &grid(20.0, 50.0, 60));
    assert!(all_converged(&curve));
    assert!(curve.points.iter().all(|p| p.harmonics <= 27));
}

#[test]
fn a_range_ends_even_where_nothing_converges_or_nothing_damps() {
    let model = snecma_beam(20.313).model();
    let mut hopeless = fixed(15);
    hopeless.newton.max_iterations = 1;
    let balance = ForcedBalance::new(&model, hopeless, &[1]).unwrap();
    let curve = sweep_range(balance, 150.0, 230.0).unwrap();
    assert!(curve.points.len() < 1000 && !all_converged(&curve));
    let mut undamped = snecma_beam(1.0);
    undamped.damping = faer::Mat::zeros(3, 3);
    let model = undamped.model();
    for (from, to) in [(100.0, 300.0), (300.0, 100.0)] {
        let balance = ForcedBalance::new(&model, fixed(3), &[1]).unwrap();
        let curve = sweep_range(balance, from, to).unwrap();
        assert_eq!(curve.points[curve.points.len() - 1].omega, to);
        assert!(curve.points.len() < 20_000, "{}", curve.points.len());
    }
}

#[test]
fn a_failed_point_does_not_raise_the_harmonics_of_those_after_it() {
    let system = System {
        mass: faer::mat![[1.0]],
        damping: faer::mat![[0.0]],
        stiffness: faer::mat![[1500.0]],
        dampers: vec![(0, None, 1000.0, 1.0)],
        forces: vec![(0, 1, 5.0, 0.0)],
    };
    // At 10 rad/s the fifth harmonic meets the undamped 50 rad/s of the stuck mass.
    let curve = solve(&system, Settings::default(), &[21.0, 22.0, 10.0, 23.0, 24.0]);
    assert_eq!(curve.points[2].status, PointStatus::Singular);
    assert!(curve.points[2].error_estimate[0].is_nan());
    assert!(curve.points[3..].iter().all(|p| p.harmonics <= 13));
    // A discarded harmonic on that resonance leaves no finite estimate.
    let curve = solve(&system, fixed(3), &[10.0]);
    assert_eq!(curve.points[0].error_estimate[0], f64::INFINITY);
}

#[test]
fn a_stuck_contact_holds_the_residual_it_is_told() {
    let mut beam = snecma_beam(0.938);
    beam.forces.push((0, 0, 100.0, 0.0));
    let stuck_force = |residual| {
        let settings = Settings { residual, ..fixed(5) };
        let curve = solve(&beam, settings, &[200.0]);
        assert!(all_converged(&curve));
        curve.points[0].contact_force[0].re
    };
    assert!(stuck_force(Residual::Centred).abs() < 1e-9);
    assert!((stuck_force(Residual::Value(40.0)) - 40.0).abs() < 1e-9);
    // From rest the stuck spring carries its share of the static load.
    let from_rest = stuck_force(Residual::FromRest);
    assert!(from_rest > 50.0 && from_rest < 100.0, "{from_rest}");
    // More than the slip limit leaves room for is cut back to it.
    assert!(stuck_force(Residual::Value(1e4)) < 246.048);
}

#[test]
fn an_interrupted_sweep_keeps_what_it_has() {
    let beam = snecma_beam(20.313);
    let model = beam.model();
    let balance = ForcedBalance::new(&model, fixed(9), &[1]).unwrap().watched(&|share| share < 0.5);
    let curve = sweep(balance, &grid(20.0, 350.0, 50)).unwrap();
    assert!(curve.interrupted);
    // Points that were not computed take no memory.
    assert_eq!(curve.points.len(), 25);
    assert!(curve.points.iter().all(|p| p.status == PointStatus::Converged));
    let balance = ForcedBalance::new(&model, fixed(9), &[1]).unwrap().watched(&|_| false);
    let curve = sweep(balance, &grid(20.0, 350.0, 50)).unwrap();
    assert_eq!(curve.points.len(), 1);
    assert!(curve.points[0].status == PointStatus::NotComputed);
    assert!(curve.points[0].displacement[0].re.is_nan());
}

#[test]
fn bad_requests_are_named() {
    let model = snecma_beam(1.0).model();
    let message = |settings: Settings, observe: &[usize], omega: &[f64]| {
        ForcedBalance::new(&model, settings, observe)
            .and_then(|balance| sweep(balance, omega))
            .unwrap_err()
            .to_string()
    };
    assert!(message(fixed(0), &[0], &[1.0]).contains("harmonics = 0"));
    assert!(message(fixed(3), &[7], &[1.0]).contains("observe = 7"));
    assert!(message(fixed(3), &[0], &[10.0, -2.0]).contains("omega[1] = -2"));
    let loose = Settings { tolerance: 2.0, ..Settings::default() };
    assert!(message(loose, &[0], &[1.0]).contains("tolerance = 2"));
    let mut undamped = snecma_beam(1.0);
    undamped.damping = faer::Mat::zeros(3, 3);
    let model = undamped.model();
    let resonance = model.natural_frequencies(&[]).unwrap()[0];
    let balance = ForcedBalance::new(&model, fixed(3), &[0]).unwrap();
    let refused = sweep(balance, &[resonance]).unwrap_err().to_string();
    assert!(refused.contains("undamped natural frequency 225.66"), "{refused}");
}

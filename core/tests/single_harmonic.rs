//! The single-harmonic balance against the balance of one harmonic and the dissertation's peaks.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::peak_of;
use common::{beam_pair, single_dof, snecma_beam};
use stickslip_core::balance::{
    single_harmonic, sweep, ForcedBalance, HarmonicChoice, PointStatus, Settings, Solution,
};
use stickslip_core::fourier::Measure;
use stickslip_core::model::Model;
use stickslip_core::Error;

/// Loads [N] of Guillen (1999), Table 2.3, with the single-harmonic peaks at the tip [1e-3 m] and
/// at the damper [1e-5 m]: the printed ones, with two digits more.
const TABLE_2_3: [(f64, f64, f64); 8] = [
    (0.938, 0.3709, 0.5700),
    (2.188, 0.7055, 1.1167),
    (6.563, 0.8722, 2.2520),
    (16.563, 1.1802, 6.2252),
    (20.313, 1.3648, 8.5232),
    (25.0, 1.7345, 12.7750),
    (31.475, 2.8231, 24.1648),
    (38.438, 5.2352, 47.8855),
];

fn settings() -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(1), ..Settings::default() }
}

fn grid(count: usize) -> Vec<f64> {
    (0..count).map(|i| 20.0 + 330.0 * i as f64 / (count - 1) as f64).collect()
}

fn single(model: &Model, omega: &[f64], estimate: bool) -> Result<Solution, Error> {
    let observe: Vec<usize> = (0..model.compliance().dofs()).collect();
    single_harmonic(ForcedBalance::new(model, settings(), &observe)?, omega, estimate)
}

fn balanced(model: &Model, omega: &[f64]) -> Solution {
    let observe: Vec<usize> = (0..model.compliance().dofs()).collect();
    sweep(ForcedBalance::new(model, settings(), &observe).unwrap(), omega).unwrap()
}

fn assert_equal(model: &Model, omega: &[f64], case: &str) {
    let (one, other) = (single(model, omega, true).unwrap(), balanced(model, omega));
    assert_eq!(one.profile.homotopies, 0, "{case}");
    for (p, q) in one.points.iter().zip(&other.points) {
        let case = format!("{case}, {} rad/s", p.omega);
        assert_eq!(p.status, PointStatus::Converged, "{case}");
        let close = |a: f64, b: f64, scale: f64| {
            assert!((a - b).abs() <= 1e-9 * scale, "{case}: {a:e} {b:e}");
        };
        for (a, b) in p.displacement.iter().zip(&q.displacement) {
            close((a - b).norm(), 0.0, b.norm());
        }
        for (a, b) in p.contact_force.iter().zip(&q.contact_force) {
            close((a - b).norm(), 0.0, b.norm().max(1e-3 * common::SLIP_FORCE));
        }
        for (a, b) in p.contacts.iter().zip(&q.contacts) {
            // The share grows with the root of the distance from the onset of slip.
            assert!((a.slip_fraction - b.slip_fraction).abs() < 1e-5, "{case}: {a:?} {b:?}");
            close(a.dissipation, b.dissipation, 1.0 + b.dissipation);
        }
        for (i, (a, b)) in p.error_estimate.iter().zip(&q.error_estimate).enumerate() {
            close(*a, *b, 100.0 * q.displacement[2 * i + 1].norm().max(*b));
        }
    }
}

#[test]
fn every_load_of_the_beam_agrees_with_one_harmonic_in_balance() {
    for (load, ..) in TABLE_2_3 {
        assert_equal(&snecma_beam(load).model(), &grid(400), &format!("{load} N"));
    }
    for ratio in [0.5, 1.0, 2.0] {
        assert_equal(&single_dof(ratio).model(), &grid(400), &format!("P/Fd = {ratio}"));
    }
    for exponent in [4, 5, 9, 10] {
        let mut beam = snecma_beam(20.313);
        beam.dampers[0].2 = 2.4 * 10_f64.powi(exponent);
        assert_equal(&beam.model(), &grid(200), &format!("2.4e{exponent} N/m"));
    }
}

#[test]
fn several_dampers_with_their_phases() {
    for force in [5.0, 20.0, 60.0] {
        let mut pair = beam_pair(force);
        assert_equal(&pair.model(), &grid(200), &format!("pair, {force} N"));
        // One that never slips, one without friction.
        pair.dampers[0].3 = f64::INFINITY;
        pair.dampers[1].3 = 0.0;
        assert_equal(&pair.model(), &grid(50), &format!("mixed pair, {force} N"));
    }
    let mut none = snecma_beam(3.0);
    none.dampers.clear();
    assert_equal(&none.model(), &grid(20), "no damper");
}

#[test]
fn peaks_of_table_2_3() {
    let settings = settings();
    for (load, tip, damper) in TABLE_2_3 {
        let model = snecma_beam(load).model();
        let curve = single(&model, &grid(400), false).unwrap();
        for (dof, want) in [(1, 1e-3 * tip), (0, 1e-5 * damper)] {
            let height = |i: usize| curve.points[i].displacement[2 * dof + 1].norm();
            let top = (0..400).map(height).fold(0.0, f64::max);
            let peak = peak_of(&model, settings, dof, Measure::Fundamental, (20.0, 350.0));
            assert!((peak.1 / want - 1.0).abs() < 1e-4, "{load} N: {peak:?} {want}");
            assert!(top <= peak.1 && top > 0.99 * peak.1, "{load} N");
            let there = single(&model, &[peak.0], false).unwrap();
            assert!((there.points[0].displacement[2 * dof + 1].norm() / peak.1 - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn estimates_are_left_out_on_request_and_a_failure_is_caught_by_homotopy() {
    let model = snecma_beam(20.313).model();
    let omega = [190.0, 195.0];
    let curve = single(&model, &omega, false).unwrap();
    assert!(curve.points.iter().all(|p| p.error_estimate.iter().all(|e| e.is_nan())));
    // At a load where Newton's method needs more steps from the stuck response than it is given.
    let model = snecma_beam(38.438).model();
    let mut short = settings();
    short.newton.max_iterations = 5;
    let balance = ForcedBalance::new(&model, short, &[0, 1, 2]).unwrap();
    let caught = single_harmonic(balance, &[162.5], false).unwrap();
    assert_eq!(caught.profile.homotopies, 1);
    let (a, b) = (&caught.points[0], &balanced(&model, &[162.5]).points[0]);
    assert_eq!(a.status, PointStatus::Converged);
    assert!((a.displacement[3] - b.displacement[3]).norm() < 1e-9 * b.displacement[3].norm());
    assert!(a.error_estimate.iter().all(|e| e.is_nan()));
}

#[test]
fn other_harmonics_and_undamped_resonances_are_refused() {
    for harmonic in [0, 3] {
        let mut beam = snecma_beam(1.0);
        beam.forces.push((0, harmonic, 1.0, 0.0));
        let model = beam.model();
        let three = Settings { harmonics: HarmonicChoice::Fixed(3), ..Settings::default() };
        let balance = ForcedBalance::new(&model, three, &[0]).unwrap();
        let message = single_harmonic(balance, &[100.0], true).unwrap_err().to_string();
        assert!(message.contains("takes forces of harmonic 1 alone"), "{message}");
    }
    let mut undamped = snecma_beam(1.0);
    undamped.damping = faer::Mat::zeros(3, 3);
    let resonance = undamped.model().natural_frequencies(&[]).unwrap()[0];
    let message = single(&undamped.model(), &[resonance], true).unwrap_err().to_string();
    assert!(message.contains("undamped natural frequency"), "{message}");
}

#[test]
fn without_a_force_nothing_moves() {
    let mut beam = snecma_beam(1.0);
    beam.forces.clear();
    let curve = single(&beam.model(), &[100.0], true).unwrap();
    assert_eq!(curve.points[0].status, PointStatus::Converged);
    assert!(curve.points[0].displacement.iter().all(|x| x.norm() == 0.0));
}

//! The error estimate of discarded harmonics against the true error.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{fixed, grid, solve};
use common::snecma_beam;
use std::cell::Cell;
use stickslip_core::balance::{ForcedBalance, Point, PointStatus};

/// Median ratio of the estimated to the true sum of harmonic changes, and the share of points at
/// which the estimate is less than a third of the truth.
fn estimate_against_truth(stiffness: f64, load: f64, highest: usize) -> (f64, f64) {
    let mut beam = snecma_beam(load);
    beam.dampers[0].2 = stiffness;
    let omega = grid(120.0, 290.0, 86);
    let (kept, exact) = (solve(&beam, fixed(highest), &omega), solve(&beam, fixed(121), &omega));
    let mut ratios = Vec::new();
    for (p, q) in kept.points.iter().zip(&exact.points) {
        let series = |p: &Point, k: usize| {
            if k <= p.harmonics {
                p.displacement[p.harmonics + 1 + k]
            } else {
                faer::c64::new(0.0, 0.0)
            }
        };
        let truth: f64 = (0..=121).map(|k| (series(p, k) - series(q, k)).norm()).sum();
        if truth > 1e-4 * series(q, 1).norm() {
            ratios.push(p.error_estimate[1] / truth);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let low = ratios.iter().filter(|r| **r < 1.0 / 3.0).count() as f64 / ratios.len() as f64;
    (ratios[ratios.len() / 2], low)
}

#[test]
fn error_estimates_match_true_errors_in_size() {
    for (stiffness, load) in [(2.4e7, 6.563), (2.4e7, 20.313), (2.4e7, 31.475), (2.4e9, 20.313)] {
        for highest in [3, 7, 15, 21] {
            let (median, low) = estimate_against_truth(stiffness, load, highest);
            let case = format!("{stiffness:e} N/m, {load} N, H = {highest}: {median:.2}, {low:.2}");
            // The tangent at few harmonics of a nearly rigid contact overshoots, and more of them would cost more than
            // the solution.
            let most = if stiffness > 1e9 { 7.0 } else { 4.0 };
            assert!(median > 0.7 && median < most, "{case}");
            assert!(low < 0.1, "{case}");
        }
    }
}

#[test]
fn an_analysis_can_be_ended_while_it_estimates() {
    let model = snecma_beam(20.313).model();
    let asked = Cell::new(0);
    let solved = |observe: &[usize], last: usize| {
        asked.set(0);
        let progress = |_: f64| {
            asked.set(asked.get() + 1);
            asked.get() < last
        };
        let mut balance = ForcedBalance::new(&model, fixed(7), observe).unwrap().watched(&progress);
        balance.solve(200.0, None).unwrap().status
    };
    // Without an observed DOF there is no estimate: what is asked beyond is asked by it.
    assert_eq!(solved(&[], usize::MAX), PointStatus::Converged);
    let of_solution = asked.get();
    assert_eq!(solved(&[1], usize::MAX), PointStatus::Converged);
    let of_both = asked.get();
    assert!(of_both > of_solution);
    for last in of_solution + 1..=of_both {
        assert_eq!(solved(&[1], last), PointStatus::NotComputed);
    }
}

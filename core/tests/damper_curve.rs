//! Damper curves and optima against sweeps over dense grids.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{amplitude_of, fixed, grid};
use common::{beam_pair, snecma_beam, System};
use stickslip_core::balance::{sweep, ForcedBalance, PointStatus, Settings};
use stickslip_core::design::{optimum, peak_curve, Target};
use stickslip_core::fourier::Measure;
use stickslip_core::model::{ParameterMode, Variation};
use stickslip_core::Model;

const SPAN: (f64, f64) = (150.0, 240.0);

fn slip_force(contacts: &[usize], common: ParameterMode) -> Variation {
    let contacts = contacts.iter().map(|&contact| (contact, None)).collect();
    Variation::Law { parameter: "slip_force".to_owned(), contacts, common }
}

fn geometric(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low * (high / low).powf(i as f64 / (count - 1) as f64)).collect()
}

/// Highest point of a dense sweep, and of ever denser ones about it.
fn dense_peak(model: &Model, settings: Settings, dof: usize, points: usize) -> (f64, f64) {
    let (mut span, mut points) = (SPAN, points);
    loop {
        let omega = grid(span.0, span.1, points);
        let curve = sweep(ForcedBalance::new(model, settings, &[dof]).unwrap(), &omega).unwrap();
        let size =
            |i: usize| amplitude_of(&curve.points[i], curve.half_wave, 0, Measure::HalfRange);
        let heights: Vec<f64> = (0..points).map(size).collect();
        let best = (0..points).max_by(|&a, &b| heights[a].total_cmp(&heights[b])).unwrap();
        span = (omega[best.saturating_sub(1)], omega[(best + 1).min(points - 1)]);
        if span.1 - span.0 < 1e-8 * span.1 {
            return (omega[best], heights[best]);
        }
        points = 11;
    }
}

fn compare(system: &System, dof: usize, values: &[f64], highest: usize) {
    let model = system.model();
    let target = Target { dof, measure: Measure::HalfRange, span: SPAN };
    let contacts: Vec<usize> = (0..system.dampers.len()).collect();
    let variation = slip_force(&contacts, ParameterMode::Value);
    let curve =
        peak_curve(&model, fixed(highest), &variation, values, &target, &|_| true, None).unwrap();
    for peak in &curve.peaks {
        assert_eq!(peak.status, PointStatus::Converged);
        let mut member = system.clone();
        member.dampers.iter_mut().for_each(|damper| damper.3 = peak.value);
        let (omega, amplitude) = dense_peak(&member.model(), fixed(highest), dof, 400);
        assert!(
            (peak.amplitude - amplitude).abs() <= 1e-8 * amplitude,
            "{}: {} at {} instead of {amplitude} at {omega}",
            peak.value,
            peak.amplitude,
            peak.omega
        );
    }
}

#[test]
fn every_peak_is_the_highest_of_a_dense_sweep() {
    for dof in [0, 1] {
        compare(&snecma_beam(20.313), dof, &geometric(1.0, 1e4, 60), 15);
    }
    compare(&beam_pair(20.313), 1, &geometric(5.0, 2e3, 12), 9);
}

#[test]
fn a_curve_costs_less_than_ten_sweeps() {
    let model = snecma_beam(20.313).model();
    let omega: Vec<f64> = (0..400).map(|i| 20.0 + 330.0 * i as f64 / 399.0).collect();
    for highest in [3, 15] {
        let target = Target { dof: 1, measure: Measure::HalfRange, span: SPAN };
        let values = geometric(1.0, 1e4, 60);
        let variation = slip_force(&[0], ParameterMode::Value);
        let curve =
            peak_curve(&model, fixed(highest), &variation, &values, &target, &|_| true, None)
                .unwrap();
        let balance = ForcedBalance::new(&model, fixed(highest), &[0, 1, 2]).unwrap();
        let sweep = sweep(balance, &omega).unwrap();
        println!(
            "H={highest}: {} points, {} evaluations, {:?}; sweep {} evaluations, {:?}",
            curve.points,
            curve.profile.evaluations,
            curve.profile.total,
            sweep.profile.evaluations,
            sweep.profile.total
        );
        assert!(curve.points < 10 * omega.len());
        assert!(curve.profile.evaluations < 10 * sweep.profile.evaluations);
    }
}

#[test]
fn slopes_of_the_curve_match_differences() {
    let model = beam_pair(20.313).model();
    let target = Target { dof: 1, measure: Measure::HalfRange, span: SPAN };
    let variations = [
        slip_force(&[0, 1, 2], ParameterMode::Value),
        slip_force(&[0, 2], ParameterMode::Factor),
        Variation::Law {
            parameter: "stiffness".to_owned(),
            contacts: vec![(1, None)],
            common: ParameterMode::Value,
        },
        Variation::Level,
    ];
    for (variation, value) in variations.iter().zip([80.0, 1.3, 3e6, 0.8]) {
        let values = [value * (1.0 - 1e-4), value, value * (1.0 + 1e-4)];
        let curve =
            peak_curve(&model, fixed(7), variation, &values, &target, &|_| true, None).unwrap();
        let [a, b, c] = [0, 1, 2].map(|i| curve.peaks[i]);
        let difference = (c.amplitude - a.amplitude) / (c.value - a.value);
        let scale = (b.amplitude / b.value).abs();
        assert!(
            (b.slope - difference).abs() < 1e-5 * scale,
            "{variation:?}: {} {difference}",
            b.slope
        );
    }
}

/// Guillen (1999), Figs 4.3 and 4.4, over continuous loads: least peak per force at the damper
/// near 10 N, at the tip near 14 N with a second, shallow minimum near 22 N.
#[test]
fn optima_of_the_beam() {
    let model = snecma_beam(1.0).model();
    let settings = Settings::default();
    for (dof, expected) in [(0, vec![(10.0, 3.02e-6)]), (1, vec![(14.0, 6.72e-5), (22.0, 6.99e-5)])]
    {
        let target = Target { dof, measure: Measure::HalfRange, span: SPAN };
        let run = |variation: &Variation, bounds: (f64, f64)| {
            optimum(&model, settings, variation, bounds, &target, &|_| true, None).unwrap()
        };
        let by_level = run(&Variation::Level, (0.5, 60.0));
        let by_force =
            run(&slip_force(&[0], ParameterMode::Value), (246.048 / 60.0, 246.048 / 0.5));
        for (position, (load, ratio)) in expected.into_iter().enumerate() {
            let (one, two) = (by_level.minima[position], by_force.minima[position]);
            println!("{dof}: level {one:?}\n  force {two:?}");
            assert!((one.value / load - 1.0).abs() < 0.1);
            assert!((one.amplitude / one.value / ratio - 1.0).abs() < 5e-3);
            assert!((246.048 / two.value / one.value - 1.0).abs() < 2e-2);
            assert!((two.amplitude / ratio - 1.0).abs() < 5e-3);
        }
    }
}

/// At a hundredth of the damping resonances are 0.08 rad/s wide, and slip cuts off their tops.
#[test]
fn narrow_resonances_are_found_from_afar() {
    let mut system = snecma_beam(20.313);
    system.damping = faer::Scale(0.01) * &system.damping;
    let model = system.model();
    let target = Target { dof: 1, measure: Measure::HalfRange, span: SPAN };
    let values = [300.0, 3e3, 1e4, 1e6];
    let variation = slip_force(&[0], ParameterMode::Value);
    let curve =
        peak_curve(&model, fixed(9), &variation, &values, &target, &|_| true, None).unwrap();
    assert!(curve.points < 40 * values.len(), "{}", curve.points);
    for peak in &curve.peaks {
        let mut member = system.clone();
        member.dampers[0].3 = peak.value;
        let (_, dense) = dense_peak(&member.model(), fixed(9), 1, 4000);
        assert!((peak.amplitude / dense - 1.0).abs() < 1e-9, "{peak:?} {dense}");
    }
}

#[test]
fn an_optimum_is_that_of_a_fine_grid() {
    for (system, dof) in [(snecma_beam(20.313), 0), (beam_pair(20.313), 1)] {
        let model = system.model();
        let target = Target { dof, measure: Measure::HalfRange, span: SPAN };
        let contacts: Vec<usize> = (0..system.dampers.len()).collect();
        let variation = slip_force(&contacts, ParameterMode::Factor);
        let found =
            optimum(&model, fixed(7), &variation, (0.05, 10.0), &target, &|_| true, None).unwrap();
        let grid = geometric(0.05, 10.0, 400);
        let curve =
            peak_curve(&model, fixed(7), &variation, &grid, &target, &|_| true, None).unwrap();
        let least = curve.peaks.iter().min_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap();
        let best = found.minima[0];
        assert!(best.amplitude <= least.amplitude * (1.0 + 1e-9));
        assert!((best.value / least.value).ln().abs() < (200.0_f64).ln() / 399.0);
    }
}

#[test]
fn an_ended_analysis_keeps_what_it_has() {
    let model = snecma_beam(20.313).model();
    let target = Target { dof: 1, measure: Measure::HalfRange, span: SPAN };
    let calls = std::cell::Cell::new(0);
    let progress = |_: f64| {
        calls.set(calls.get() + 1);
        calls.get() < 200
    };
    let values = geometric(1.0, 1e4, 60);
    let variation = slip_force(&[0], ParameterMode::Value);
    let curve =
        peak_curve(&model, fixed(7), &variation, &values, &target, &progress, None).unwrap();
    let done = curve.peaks.iter().filter(|p| p.status == PointStatus::Converged).count();
    assert!(curve.interrupted && done > 0 && done < values.len(), "{done}");
    assert_eq!(curve.peaks.len(), values.len());
    assert!(curve.peaks[done..].iter().all(|p| p.status == PointStatus::NotComputed));
}

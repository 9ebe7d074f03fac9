//! Ranges of frequencies cut into pieces, against the same ranges as a whole.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{amplitude_of, fixed, solve};
use common::passive::passive_system;
use common::{snecma_beam, System};
use faer::{c64, mat, Mat};
use proptest::prelude::*;
use std::sync::Mutex;
use stickslip_core::balance::{CurveEnd, Kept, Settings, Solution};
use stickslip_core::contact::{ContactLaw, Cubic, Jenkins};
use stickslip_core::fourier::Measure;
use stickslip_core::model::{Contact, Model};
use stickslip_core::orbit::{sweep_range_in_pieces, Balances};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// A curve in pieces if it takes so many operations, and what was kept of it.
fn curve(
    model: &Model,
    settings: Settings,
    observe: &[usize],
    range: (f64, f64),
    much: f64,
) -> (Solution, usize) {
    let kept = Kept::default();
    let balances = Balances::new(model, settings, (observe, &[]), &kept).unwrap().cut_from(much);
    let found = sweep_range_in_pieces(&balances, range, &|_| true).unwrap();
    let count = kept.lock().unwrap().len();
    (found, count)
}

fn frequencies(curve: &Solution) -> Vec<f64> {
    curve.points.iter().map(|point| point.omega).collect()
}

fn bits(curve: &Solution) -> Vec<u64> {
    let numbers = curve.points.iter().flat_map(|point| {
        let series = point.displacement.iter().flat_map(|x| [x.re, x.im]);
        series.chain(point.error_estimate.clone()).chain([point.omega])
    });
    numbers.map(f64::to_bits).collect()
}

/// Largest distance of the tip from straight lines in the middle of all steps, relative to it.
fn error_of_lines(beam: &System, curve: &Solution, harmonics: usize) -> f64 {
    let at = |omega: f64| {
        let solved = solve(beam, fixed(harmonics), &[omega]);
        amplitude_of(&solved.points[0], true, 1, Measure::HalfRange)
    };
    let errors = curve.points.windows(2).map(|pair| {
        let line: f64 = pair.iter().map(|one| amplitude_of(one, true, 1, Measure::HalfRange)).sum();
        (0.5 * line / at(0.5 * (pair[0].omega + pair[1].omega)) - 1.0).abs()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn straight_lines_hold_across_seams() {
    let beam = snecma_beam(20.313);
    let model = beam.model();
    let settings = Settings { tolerance: 1e-3, ..fixed(7) };
    for range in [(100.0, 350.0), (350.0, 100.0)] {
        let (whole, _) = curve(&model, settings, &[0, 1], range, f64::INFINITY);
        let (cut, kept) = curve(&model, settings, &[0, 1], range, 0.0);
        // It is another curve, with its ends and its order.
        assert_ne!(frequencies(&whole), frequencies(&cut));
        // What comes behind it may be given up, and leaves all of it.
        assert_eq!(kept, cut.points.len());
        assert_eq!((cut.points[0].omega, cut.end), (range.0, CurveEnd::Range));
        assert_eq!(cut.points[cut.points.len() - 1].omega, range.1);
        let ascending = (range.1 - range.0).signum();
        assert!(frequencies(&cut).windows(2).all(|pair| (pair[1] - pair[0]) * ascending > 0.0));
        assert!(cut.points.iter().all(|point| point.is_solved()));
        let [from_whole, from_cut] = [&whole, &cut].map(|one| error_of_lines(&beam, one, 7));
        assert!(from_cut < 5e-3, "{from_whole} {from_cut}");
        assert!(cut.points.len() < whole.points.len() + 60, "{}", cut.points.len());
    }
}

#[test]
fn a_range_of_the_last_digits_is_not_cut() {
    let model = snecma_beam(20.313).model();
    for range in [(100.0, 100.0 * (1.0 + 1e-9)), (100.0 * (1.0 + 1e-9), 100.0)] {
        let (cut, _) = curve(&model, fixed(3), &[0, 1], range, 0.0);
        assert_eq!(frequencies(&cut), [range.0, range.1]);
    }
}

#[test]
fn an_interrupted_curve_in_pieces_has_no_gap() {
    let model = snecma_beam(20.313).model();
    let settings = Settings { tolerance: 1e-4, ..fixed(7) };
    let (whole, _) = curve(&model, settings, &[0, 1], (100.0, 350.0), 0.0);
    let all = frequencies(&whole);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for share in [0.0, 0.05, 0.3, 0.6, 0.8] {
        let ended = || {
            let kept = Kept::default();
            let balances =
                Balances::new(&model, settings, (&[0, 1], &[]), &kept).unwrap().cut_from(0.0);
            let largest = Mutex::new(0.0_f64);
            let found = sweep_range_in_pieces(&balances, (100.0, 350.0), &|done| {
                let mut largest = largest.lock().unwrap();
                *largest = largest.max(done);
                done <= share
            })
            .unwrap();
            assert!(*largest.lock().unwrap() <= 1.0);
            let got = frequencies(&found);
            assert!(got == all[..got.len()], "{share}: {}", got.len());
            assert_eq!(found.interrupted, got.len() < all.len(), "{share}");
            assert_eq!(found.interrupted, found.end == CurveEnd::Interrupted, "{share}");
            found.interrupted
        };
        // Several threads may have done everything before they hear of it.
        ended();
        assert!(alone.install(ended), "{share}");
    }
}

/// Two masses on hardening springs: the curve folds.
fn hardening(contacts: Vec<Contact>) -> Model {
    let structure = Structure::new(
        mat![[1.0, 0.0], [0.0, 0.4]].as_ref(),
        mat![[0.06, -0.02], [-0.02, 0.05]].as_ref(),
        mat![[3.0, -1.0], [-1.0, 2.0]].as_ref(),
    )
    .unwrap();
    let load =
        HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(0.5, 0.0), c64::new(0.0, 0.0)] };
    Model::new(structure, contacts, vec![load]).unwrap()
}

fn to_ground(law: Box<dyn ContactLaw>, dof: usize) -> Contact {
    let rows = Mat::from_fn(1, 2, |_, j| f64::from(u8::from(j == dof)));
    Contact { law, rows }
}

#[test]
fn a_curve_that_turns_back_across_its_seams_is_followed_as_a_whole() {
    let model = hardening(vec![
        to_ground(Box::new(Cubic::new(0.3).unwrap()), 0),
        to_ground(Box::new(Jenkins::new(0.2, 0.05).unwrap()), 1),
    ]);
    for range in [(0.5, 4.0), (4.0, 0.5)] {
        let (whole, _) = curve(&model, fixed(3), &[0, 1], range, f64::INFINITY);
        let (cut, kept) = curve(&model, fixed(3), &[0, 1], range, 0.0);
        let folds = |one: &Solution| -> Vec<f64> {
            one.points.iter().filter(|point| point.fold).map(|point| point.omega).collect()
        };
        let (a, b) = (folds(&whole), folds(&cut));
        assert!(a.len() >= 2 && a.len() == b.len(), "{a:?} {b:?}");
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-4), "{a:?} {b:?}");
        assert_eq!((whole.end, cut.end), (CurveEnd::Range, CurveEnd::Range));
        assert_ne!(frequencies(&whole), frequencies(&cut));
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let (one, _) = alone.install(|| curve(&model, fixed(3), &[0, 1], range, 0.0));
        assert_eq!(bits(&one), bits(&cut));
        // Every point lies on the whole curve.
        let tip = |point| amplitude_of(point, whole.half_wave, 0, Measure::HalfRange);
        let line: Vec<[f64; 2]> =
            whole.points.iter().map(|point| [point.omega, tip(point)]).collect();
        for point in &cut.points {
            let here = [point.omega, tip(point)];
            let nearest =
                line.windows(2).map(|pair| distance(here, pair[0], pair[1])).fold(9.0, f64::min);
            assert!(nearest < 0.02, "{here:?} {nearest}");
        }
        assert!(kept <= cut.points.len() + 3, "{kept}");
    }
}

/// Distance of a point from a line between two others.
fn distance(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let along = (0..2).map(|i| way[i] * (point[i] - from[i])).sum::<f64>();
    let share = (along / (way[0].powi(2) + way[1].powi(2)).max(1e-300)).clamp(0.0, 1.0);
    (0..2).map(|i| (point[i] - from[i] - share * way[i]).powi(2)).sum::<f64>().sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn pieces_of_passive_systems_make_the_curve_of_the_whole(system in passive_system()) {
        let model = system.model();
        let observe: Vec<usize> = (0..system.dofs()).collect();
        let range = (5.0, 25.0);
        let settings = fixed(5);
        let (whole, _) = curve(&model, settings, &observe, range, f64::INFINITY);
        let (cut, _) = curve(&model, settings, &observe, range, 0.0);
        let all_solved = |one: &Solution| one.points.iter().all(|point| point.is_solved());
        prop_assume!(all_solved(&whole));
        prop_assert!(all_solved(&cut));
        for dof in observe {
            let peak = |one: &Solution| {
                let sizes = one.points.iter().map(|p| amplitude_of(p, one.half_wave, dof, Measure::HalfRange));
                sizes.fold(0.0, f64::max)
            };
            let (a, b) = (peak(&whole), peak(&cut));
            prop_assert!((a - b).abs() <= 5e-3 * a, "{a} {b}");
        }
    }
}

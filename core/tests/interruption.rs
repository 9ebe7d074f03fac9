//! Analyses that are ended on the way: what they have by then is what they would have had.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{fixed, grid};
use faer::{c64, mat, Mat};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::Arc;
use stickslip_core::balance::{
    sweep, sweep_range, Evaluation, ForcedBalance, Kept, Point, PointStatus, Progress,
    SampleChoice, Settings, Solution, Uniqueness,
};
use stickslip_core::contact::{BoucWen, Closure, ContactLaw, Coulomb, Cubic, Jenkins};
use stickslip_core::design::{bounded_peak_curve, Peak, Target};
use stickslip_core::fourier::Measure;
use stickslip_core::model::{Contact, Model, Variation};
use stickslip_core::orbit::decide_stability;
use stickslip_core::structure::{HarmonicLoad, Structure};

/// Two masses on a hardening spring and a law with friction: the curve folds.
fn model(law: Box<dyn ContactLaw>) -> Model {
    let structure = Structure::new(
        mat![[1.0, 0.0], [0.0, 0.4]].as_ref(),
        mat![[0.06, -0.02], [-0.02, 0.05]].as_ref(),
        mat![[3.0, -1.0], [-1.0, 2.0]].as_ref(),
    )
    .unwrap();
    let laws: [Box<dyn ContactLaw>; 2] = [Box::new(Cubic::new(0.3).unwrap()), law];
    let row = |dof: usize| Mat::from_fn(1, 2, |_, j| f64::from(u8::from(j == dof)));
    let contacts = laws.into_iter().enumerate().map(|(dof, law)| Contact { law, rows: row(dof) });
    let amplitude = vec![c64::new(0.5, 0.0), c64::new(0.0, 0.0)];
    let load = HarmonicLoad { harmonic: 1, amplitude };
    Model::new(structure, contacts.collect(), vec![load]).unwrap()
}

/// All that points hold.
fn bits(points: &[Arc<Point>]) -> Vec<Vec<u64>> {
    let numbers = |point: &Arc<Point>| {
        let series = point.displacement.iter().flat_map(|x| [x.re, x.im]);
        let all = series.chain(point.error_estimate.clone()).chain([point.omega]);
        let marks = [point.jump, point.fold, point.further].map(f64::from);
        all.chain(marks).map(f64::to_bits).collect()
    };
    points.iter().map(numbers).collect()
}

/// Ends an analysis at many of the moments at which it asks whether to go on.
fn ended_anywhere<T>(work: impl Fn(&Progress<'_>) -> T, moments: usize, mut see: impl FnMut(T)) {
    let asked = AtomicUsize::new(0);
    work(&|_| {
        asked.fetch_add(1, Relaxed);
        true
    });
    let all = asked.into_inner();
    assert!(all > moments, "{all}");
    for moment in (0..all).step_by(all / moments) {
        let asked = AtomicUsize::new(0);
        see(work(&|_| asked.fetch_add(1, Relaxed) < moment));
    }
}

fn assert_beginnings(
    model: &Model,
    evaluation: Evaluation,
    curve: impl Fn(ForcedBalance<'_>) -> Solution,
) {
    let settings = Settings { tolerance: 1e-2, evaluation, ..fixed(3) };
    let work = |look: &Progress<'_>| {
        let kept = Kept::default();
        let balance = ForcedBalance::new(model, settings, &[0, 1]).unwrap();
        let found = curve(balance.watched(look).keeping(&kept));
        let kept = kept.lock().unwrap().len();
        (found, kept)
    };
    let whole = bits(&work(&|_| true).0.points);
    ended_anywhere(work, 20, |(found, kept)| {
        let got = bits(&found.points);
        let none = found.points[0].status == PointStatus::NotComputed;
        assert!(none || got == whole[..got.len()], "{} of {}", got.len(), whole.len());
        assert!(found.interrupted && (none || kept == got.len()), "{kept} {}", got.len());
    });
}

#[test]
fn points_of_a_curve_that_is_ended_are_those_of_the_whole() {
    let rubbing = model(Box::new(Jenkins::new(0.2, 0.05).unwrap()));
    let marched = model(Box::new(BoucWen::new(0.2, 0.05, 1.0, 0.5).unwrap()));
    let coarse = Evaluation::Marched(SampleChoice::Fixed(64));
    for (model, evaluation) in [(&rubbing, Evaluation::Direct), (&marched, coarse)] {
        let grid = grid(1.2, 3.4, 12);
        assert_beginnings(model, evaluation, |balance| sweep(balance, &grid).unwrap());
        assert_beginnings(model, evaluation, |balance| sweep_range(balance, 1.6, 2.6).unwrap());
    }
}

#[test]
fn stability_that_was_not_asked_for_in_time_is_not_decided() {
    let model = model(Box::new(Jenkins::new(0.2, 0.05).unwrap()));
    let settings = Settings { tolerance: 1e-2, ..fixed(1) };
    let balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
    let curve = sweep_range(balance, 1.2, 3.4).unwrap();
    let decided = |look: &Progress<'_>| {
        let mut found = curve.clone();
        decide_stability(&model, settings, &mut found, look).unwrap();
        found
    };
    let whole = decided(&|_| true);
    assert!(!whole.interrupted && whole.points.iter().any(|point| point.stable == Some(false)));
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    alone.install(|| {
        ended_anywhere(decided, 10, |found| {
            assert!(found.interrupted);
            for (own, all) in found.points.iter().zip(&whole.points) {
                assert!(own.stable.is_none() || own.stable == all.stable);
            }
        });
    });
}

/// Two masses that rub on planes: the traction that one keeps shifts the load of the other.
fn rubbing() -> Model {
    let pad = |rows: [[f64; 3]; 2], preload: f64| Contact {
        law: Box::new(Coulomb::new(1, 0.5, 150.0, Some(200.0), Closure::Preload(preload)).unwrap()),
        rows: Mat::from_fn(2, 3, |i, j| rows[i][j]),
    };
    let structure = Structure::new(
        Mat::<f64>::identity(3, 3).as_ref(),
        (faer::Scale(0.25) * Mat::<f64>::identity(3, 3)).as_ref(),
        mat![[200.0, -60.0, 30.0], [-60.0, 180.0, -40.0], [30.0, -40.0, 220.0]].as_ref(),
    );
    let contacts = vec![
        pad([[1.0, 0.0, 0.0], [0.0, 0.6, 0.8]], 2.0),
        pad([[0.0, 1.0, 0.2], [0.3, 0.0, 1.0]], 3.0),
    ];
    let amplitude = vec![c64::new(2.0, 0.0), c64::new(0.5, 0.3), c64::new(1.0, 0.0)];
    let load = HarmonicLoad { harmonic: 1, amplitude };
    Model::new(structure.unwrap(), contacts, vec![load]).unwrap()
}

/// A bound that was ended in the middle of its search is not the bound; one that was found before is.
#[test]
fn bounds_of_peaks_that_are_ended_are_none() {
    let model = rubbing();
    let target = Target { dof: 0, measure: Measure::HalfRange, span: (8.0, 22.0) };
    let settings = Settings { tolerance: 1e-2, ..fixed(3) };
    let work = |look: &Progress<'_>| {
        let asked = (&[0.4, 0.6][..], false);
        let by = Variation::Level;
        bounded_peak_curve(&model, settings, &by, asked, &target, look, None).unwrap()
    };
    let whole = work(&|_| true).peaks;
    assert_ne!(whole[0].bounds.unwrap().unique, Uniqueness::Unique);
    let mut kept = [0, 0];
    ended_anywhere(work, 40, |found| {
        assert!(found.interrupted);
        for (own, all) in found.peaks.iter().zip(&whole) {
            let none = own.status == PointStatus::NotComputed;
            assert!(none || own.bounds == all.bounds, "{own:?}");
        }
        let solved = |peak: &&Peak| peak.status != PointStatus::NotComputed;
        kept[found.peaks.iter().filter(solved).count()] += 1;
    });
    assert!(kept[0] > 5 && kept[1] > 5, "{kept:?}");
}

//! Whole balances by the marched evaluation: sweeps, peaks, a law without closed form, bad requests.

#![allow(clippy::unwrap_used)]

mod common;

use common::coupled::Coupled;
use common::curves::peak_of;
use common::snecma_beam;
use faer::{mat, Mat};
use stickslip_core::balance::{
    single_harmonic, sweep, ForcedBalance, HarmonicChoice, Method, PointStatus, Settings, Solution,
};
use stickslip_core::contact::Jenkins;
use stickslip_core::fourier::Measure;
use stickslip_core::model::{Contact, MarchedLaws, Model};
use stickslip_core::motion::ModalSystem;
use stickslip_core::solve::FirstJacobian;
use stickslip_core::structure::{HarmonicLoad, Structure};

fn solve(model: &Model, settings: Settings) -> Solution {
    let omega: Vec<f64> = (0..80).map(|i| 150.0 + f64::from(i)).collect();
    let curve = sweep(ForcedBalance::new(model, settings, &[0, 1]).unwrap(), &omega).unwrap();
    assert!(curve.points.iter().all(|p| p.status == PointStatus::Converged));
    curve
}

/// Root mean square distance of the harmonics of the tip, relative to their largest.
fn apart(one: &Solution, other: &Solution) -> f64 {
    let mut sum = 0.0;
    for (p, q) in one.points.iter().zip(&other.points) {
        let size = q.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let change = p.displacement.iter().zip(&q.displacement).map(|(a, b)| (a - b).norm_sqr());
        sum += change.sum::<f64>() / size.powi(2);
    }
    (sum / one.points.len() as f64).sqrt()
}

#[test]
fn marched_sweeps_approach_the_exact_one() {
    let exact = snecma_beam(20.313).model();
    let fixed = Settings { harmonics: HarmonicChoice::Fixed(9), ..Settings::default() };
    let curve = solve(&exact, fixed);
    let errors = [64, 256, 1024].map(|samples| {
        let model = exact.marched(samples, MarchedLaws::All).unwrap();
        let marched = solve(&model, fixed);
        assert_eq!(marched.profile.homotopies, 0);
        if samples == 1024 {
            // The estimate sees the same discarded harmonics; beside the point at which a smooth piece ends one may still
            // go on where the other does not.
            let points = || marched.points.iter().zip(&curve.points);
            let parted = points().filter(|(p, q)| {
                let size = q.displacement[11].norm();
                let (a, b) = (p.error_estimate[1], q.error_estimate[1]);
                assert!(
                    a < 4.0 * b + 1e-3 * size && b < 4.0 * a + 1e-3 * size,
                    "{}: {a} {b}",
                    p.omega
                );
                (a - b).abs() >= 0.2 * b + 1e-3 * size
            });
            assert!(parted.count() <= 1);
            let broyden = Method::Broyden(FirstJacobian::Exact);
            assert!(apart(&solve(&model, Settings { method: broyden, ..fixed }), &marched) < 1e-9);
        }
        apart(&marched, &curve)
    });
    let rate = (errors[0] / errors[2]).log2() / 4.0;
    assert!((rate - 2.0).abs() < 0.3, "{errors:?}");
    assert!(errors[2] < 3e-5, "{errors:?}");
}

#[test]
fn a_peak_is_refined_with_the_same_evaluation() {
    let exact = snecma_beam(20.313).model();
    let fixed = Settings { harmonics: HarmonicChoice::Fixed(9), ..Settings::default() };
    let peak = |model: &Model| peak_of(model, fixed, 1, Measure::HalfRange, (185.0, 200.0));
    let (coarse, fine) = (
        peak(&exact.marched(40, MarchedLaws::All).unwrap()),
        peak(&exact.marched(4096, MarchedLaws::All).unwrap()),
    );
    assert!((fine.1 / peak(&exact).1 - 1.0).abs() < 1e-5);
    assert!((coarse.1 / peak(&exact).1 - 1.0).abs() > 1e-4);
}

/// A contact of two coupled points in a model, against the same two elements as two contacts.
#[test]
fn a_law_without_closed_form_runs_through_the_whole_balance() {
    let build = |coupled: bool| {
        let mass = mat![[2.0, 0.1], [0.1, 1.0]];
        let stiffness = mat![[30.0, -10.0], [-10.0, 15.0]];
        let damping = mat![[0.3, -0.1], [-0.1, 0.2]];
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let law = Coupled::new();
        let contacts = if coupled {
            vec![Contact { law: Box::new(law), rows: Mat::identity(2, 2) }]
        } else {
            let row = |i: usize| Mat::from_fn(1, 2, |_, j| law.transform[(i, j)]);
            let alone = |i: usize| Box::new(Jenkins::of(vec![law.elements[i]]).unwrap());
            (0..2).map(|i| Contact { law: alone(i), rows: row(i) }).collect()
        };
        let amplitude = [faer::c64::new(6.0, 0.0), faer::c64::new(0.0, 3.0)].to_vec();
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
        Model::new(structure, contacts, loads).unwrap()
    };
    let fixed = Settings { harmonics: HarmonicChoice::Fixed(7), ..Settings::default() };
    let omega: Vec<f64> = (0..40).map(|i| 1.0 + 0.15 * f64::from(i)).collect();
    let run =
        |model: &Model| sweep(ForcedBalance::new(model, fixed, &[0, 1]).unwrap(), &omega).unwrap();
    let sampled = |coupled| run(&build(coupled).marched(256, MarchedLaws::All).unwrap());
    let (one, two) = (sampled(true), sampled(false));
    // By itself it is sampled finely, and no motion from event to event can follow it.
    let alone = build(true);
    assert!(apart(&run(&alone), &run(&build(false))) < 1e-4);
    let refused = ModalSystem::new(&alone).unwrap_err().to_string();
    assert!(refused.contains("contact 1: the law coupled has no events"), "{refused}");
    let balance = ForcedBalance::new(&alone, fixed, &[0]).unwrap();
    let refused = single_harmonic(balance, &omega, false).unwrap_err().to_string();
    assert!(refused.contains("contact 1: expected a law with a describing function, got coupled"));
    assert!(two.points.iter().any(|p| p.contacts.iter().all(|c| c.slip_fraction > 0.0)));
    assert!(one.points.iter().all(|p| p.status == PointStatus::Converged));
    assert!(apart(&one, &two) < 1e-9);
    for (p, q) in one.points.iter().zip(&two.points) {
        let work = |p: &stickslip_core::balance::Point| -> f64 {
            p.contacts.iter().map(|contact| contact.dissipation).sum()
        };
        assert!((work(p) - work(q)).abs() <= 1e-8 * work(q).max(1e-3));
    }
}

#[test]
fn too_few_samples_are_named() {
    let refused =
        |samples: usize| snecma_beam(1.0).model().marched(samples, MarchedLaws::All).err().unwrap();
    assert!(refused(6).to_string().contains("samples = 6: must be an even number from 8"));
    assert!(refused(33).to_string().contains("samples = 33"));
    let model = snecma_beam(1.0).model().marched(60, MarchedLaws::All).unwrap();
    let ask = |highest: usize| {
        let harmonics = HarmonicChoice::Fixed(highest);
        let settings = Settings { harmonics, ..Settings::default() };
        ForcedBalance::new(&model, settings, &[0]).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(ask(14), Ok(()));
    let message = ask(15).unwrap_err();
    assert!(message.contains("harmonics = 15: needs at least 64 samples; lower it to 14"));
}

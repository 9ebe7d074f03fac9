//! What estimates may take.

#![allow(clippy::unwrap_used)]

use super::accuracy::Extension;
use super::effort::Effort;
use super::forced::ForcedBalance;
use super::neighbour::Neighbour;
use super::settings::{Evaluation, HarmonicChoice, Resolution, SampleChoice, Settings};
use super::solution::{Point, PointStatus};
use crate::contact::{BoucWen, Closure, ContactLaw, Coulomb, Jenkins};
use crate::fourier::Harmonics;
use crate::model::{Contact, Model};
use crate::structure::{HarmonicLoad, Structure};
use faer::{c64, mat, Mat};

fn model() -> Model {
    under(Box::new(Jenkins::new(80.0, 0.3).unwrap()), Vec::new())
}

fn under(law: Box<dyn ContactLaw>, loads: Vec<HarmonicLoad>) -> Model {
    let (mass, damping) = (mat![[2.0, 0.1], [0.1, 1.0]], mat![[0.5, -0.1], [-0.1, 0.4]]);
    let stiffness = mat![[300.0, -100.0], [-100.0, 15000.0]];
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let contact = Contact { law, rows: Mat::from_fn(1, 2, |_, j| [1.0, 0.0][j]) };
    Model::new(structure, vec![contact], loads).unwrap()
}

#[test]
fn an_extended_balance_reaches_as_far_as_the_solution_allows() {
    let (model, kept) = (model(), Harmonics::new(1, true));
    let effort = Effort::new(&model, true, 1, 2);
    let extended = |credit: f64| Extension::new(&effort, &kept, 2.0, credit);
    let [least, some, whole] = [0.0, effort.earned(1), f64::INFINITY].map(extended);
    assert!(least.highest == 3 && !least.has_two());
    assert!(some.has_two() && some.account.of(true) <= effort.earned(1));
    assert!(3 < some.highest && some.highest < whole.highest, "{}", some.highest);
}

/// Their laws and tangents take more than is reckoned.
#[test]
fn estimates_of_faces_are_allowed_less_than_those_of_sliders() {
    let face = Coulomb::new(1, 0.4, 80.0, Some(60.0), Closure::Preload(1.0)).unwrap();
    let structure = Structure::new(
        mat![[2.0, 0.1], [0.1, 1.0]].as_ref(),
        mat![[0.5, -0.1], [-0.1, 0.4]].as_ref(),
        mat![[300.0, -100.0], [-100.0, 15000.0]].as_ref(),
    )
    .unwrap();
    let contact = Contact { law: Box::new(face), rows: Mat::identity(2, 2) };
    let faces = Model::new(structure, vec![contact], Vec::new()).unwrap();
    let sliders = model();
    let [of_faces, of_sliders] =
        [&faces, &sliders].map(|model| Effort::new(model, false, 2, 2).allowed([1, 9]));
    assert!(of_faces < 0.7 * of_sliders, "{of_faces} {of_sliders}");
}

#[test]
fn estimates_beside_each_other_take_what_solutions_leave() {
    let at = |omega: f64| Point::empty(omega, PointStatus::Converged, 1, 1);
    let mut neighbour = Neighbour::default();
    // The first estimate follows from the model and the solution alone, …
    assert!(neighbour.credit(&at(100.0), Some(5.0)).is_infinite());
    neighbour.pay(3.0);
    assert!((neighbour.credit(&at(101.0), Some(4.0)) - 6.0).abs() < 1e-12);
    // … and a dear one leaves no debts.
    neighbour.pay(7.0);
    assert!((neighbour.credit(&at(102.0), Some(4.0)) - 4.0).abs() < 1e-12);
    assert!(neighbour.credit(&at(110.0), Some(4.0)).is_infinite());
    assert!(neighbour.credit(&at(110.5), None).is_infinite());
    assert!(neighbour.credit(&at(111.0), Some(4.0)).is_infinite());
}

#[test]
fn a_solution_that_lacks_samples_is_not_asked_for_its_harmonics() {
    let law = Box::new(BoucWen::new(80.0, 0.3, 1.0, 0.5).unwrap());
    let amplitude = vec![c64::new(2.0, 0.0), c64::new(0.0, 0.0)];
    let model = under(law, vec![HarmonicLoad { harmonic: 1, amplitude }]);
    let settings = Settings {
        harmonics: HarmonicChoice::Fixed(1),
        evaluation: Evaluation::Marched(SampleChoice::Auto),
        tolerance: 1e-4,
        ..Settings::default()
    };
    let mut balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
    let coarse = Resolution { harmonics: 1, samples: Some(32) };
    let mut point = balance.attempt(coarse, 9.0, None).unwrap();
    assert!(point.is_solved() && point.sampling_error[0] > 0.0);
    assert_eq!(point.error_estimate, point.sampling_error);
    // As the last one it has both errors all the same.
    let sampling = point.sampling_error.clone();
    balance.complete_estimate(&mut point).unwrap();
    assert_eq!(point.sampling_error, sampling);
    assert!(point.error_estimate[0] > 2.0 * sampling[0]);
    let last = balance.solve(9.0, None).unwrap();
    assert!(last.is_solved() && last.samples > Some(32));
    assert!(last.error_estimate[0] > 2.0 * last.sampling_error[0]);
}

/// A chain of 33 masses, 25 of them with a slider to ground, of stiffnesses over decades.
fn chain() -> Model {
    let number = |i: usize| (43758.5453 * (12.9898 * (i + 1) as f64).sin()).rem_euclid(1.0);
    let springs: Vec<f64> = (0..34).map(|i| 10_f64.powf(3.0 + 2.0 * number(i))).collect();
    let stiffness = Mat::from_fn(33, 33, |i, j| match i.abs_diff(j) {
        0 => springs[i] + springs[i + 1],
        1 => -springs[i.max(j)],
        _ => 0.0,
    });
    let damping = Mat::from_fn(33, 33, |i, j| if i == j { 0.5 } else { 0.0 });
    let mass = Mat::<f64>::identity(33, 33);
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let contact = |i: usize| {
        let stiffness = 10_f64.powf(3.0 + 2.5 * number(100 + i));
        let slip_force = 10_f64.powf(3.0 * number(200 + i) - 2.0);
        let law = Box::new(Jenkins::new(stiffness, slip_force).unwrap());
        Contact { law, rows: Mat::from_fn(1, 33, |_, j| if i == j { 1.0 } else { 0.0 }) }
    };
    let amplitude = (0..33).map(|i| c64::new(if i == 16 { 10.0 } else { 0.0 }, 0.0)).collect();
    let load = HarmonicLoad { harmonic: 1, amplitude };
    Model::new(structure, (0..25).map(contact).collect(), vec![load]).unwrap()
}

/// Where products with the modes do not lead to a step, fewer harmonics do.
#[test]
fn an_estimate_of_some_that_slip_among_many_forms_no_larger_jacobian_than_it_may() {
    let (model, kept) = (chain(), Harmonics::new(9, true));
    let effort = Effort::new(&model, true, 9, 33);
    let by_products = Extension::new(&effort, &kept, 5.45, f64::INFINITY);
    assert!(by_products.products.is_some_and(|most| most < 100), "{:?}", by_products.products);
    let formed = Extension::new(&effort.formed(), &kept, 5.45, f64::INFINITY);
    assert!(formed.formed && formed.products.is_none());
    let [least, most] = [formed.highest, by_products.highest];
    assert!(9 < least && 3 * least < 2 * most, "{least} {most}");
    let [least, most] = [&formed, &by_products].map(|one| one.account.of(true));
    assert!(least < 2.0 * most, "{least} {most}");
    // The estimate tells the error all the same.
    let solve = |harmonics| {
        let settings =
            Settings { harmonics: HarmonicChoice::Fixed(harmonics), ..Settings::default() };
        ForcedBalance::new(&model, settings, &[16]).unwrap().solve(5.45, None).unwrap()
    };
    let [few, many] = [9, 45].map(solve);
    assert!(few.is_solved() && many.is_solved());
    let error = (few.displacement[1] - many.displacement[1]).norm();
    let estimate = few.error_estimate[0];
    assert!(error > 0.0 && error < 5.0 * estimate && estimate < 20.0 * error, "{error} {estimate}");
}

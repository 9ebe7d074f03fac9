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

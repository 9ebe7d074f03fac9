//! What estimates may take.

#![allow(clippy::unwrap_used)]

use super::condensed::Condensed;
use super::effort::Effort;
use super::extension::{Extension, PAST_LAST_MODE};
use super::forced::ForcedBalance;
use super::neighbour::Neighbour;
use super::settings::{Evaluation, HarmonicChoice, Resolution, SampleChoice, Settings};
use super::solution::{Point, PointStatus};
use crate::contact::{BoucWen, ContactLaw, Cubic, Jenkins, Residual};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{Contact, Model};
use crate::solve::{norm, System as _};
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
    let earned = effort.earned(1);
    let [least, some, whole] = [0.0, earned, f64::INFINITY].map(extended);
    assert!(least.highest == 3 && !least.has_two());
    assert!(some.has_two() && some.account.of(true) <= earned);
    assert!(3 < some.highest && some.highest < whole.highest, "{}", some.highest);
}

/// A mode just below answers harmonic 7 as strongly as one just above.
#[test]
fn an_extended_balance_reaches_to_the_first_harmonic_past_the_last_mode() {
    let (model, kept) = (model(), Harmonics::new(3, true));
    let effort = Effort::new(&model, true, 1, 2);
    let past = PAST_LAST_MODE * model.compliance().highest_frequency();
    for (reach, highest) in [(4.9, 5), (5.1, 7), (6.9, 7), (7.1, 9), (8.9, 9)] {
        let extended = Extension::new(&effort, &kept, past / reach, f64::INFINITY);
        assert!(extended.highest == highest && extended.has_two(), "{reach}: {}", extended.highest);
        assert!((extended.unseen - 1.0).abs() < 1e-12);
    }
}

/// They are solved in fewer steps.
#[test]
fn estimates_of_laws_without_slip_take_less() {
    let models = [model(), under(Box::new(Cubic::new(80.0).unwrap()), Vec::new())];
    let [slips, smooth] = [&models[0], &models[1]].map(|model| Effort::new(model, true, 1, 2));
    let steps = |effort: &Effort<'_>| effort.steps(5) / effort.step(5);
    assert!(steps(&smooth) < 0.7 * steps(&slips));
    let reaches = |effort: &Effort<'_>| {
        Extension::new(effort, &Harmonics::new(1, true), 2.0, f64::INFINITY).highest
    };
    assert!(reaches(&smooth) < reaches(&slips));
}

/// The nearer a solution is to the motion without slip, the fewer steps lead to it; a point of which nobody knows is far.
#[test]
fn estimates_of_nearly_linear_motions_take_less() {
    let model = model();
    let effort = Effort::new(&model, true, 1, 2);
    let at = |from_stuck: f64| {
        effort.of(&Point { from_stuck, ..Point::empty(2.0, PointStatus::Converged, 2, 1) })
    };
    let steps = [0.0, 0.1, 1.0, 7.0, f64::NAN].map(|far| at(far).steps(5));
    assert!(steps[0] < steps[1] && steps[1] < 0.8 * steps[2]);
    // More harmonics need fewer steps to reach the modes above them.
    let of_step = |highest: usize| at(0.0).steps(highest) / effort.step(highest);
    assert!(of_step(7) < 0.8 * of_step(5));
    assert_eq!([steps[3], steps[4]], [steps[2], effort.steps(5)]);
    // The look at what the first step leaves is nearly all of the second one.
    assert!(at(0.0).of_second() < 0.5 && at(1.0).of_second() == 1.0);
}

#[test]
fn estimates_beside_each_other_take_what_solutions_leave() {
    let at = |omega: f64| Point::empty(omega, PointStatus::Converged, 1, 1);
    let mut neighbour = Neighbour::default();
    // The first two estimates follow from the model and the solution alone, …
    assert!(neighbour.credit(&at(99.0), Some(2.0)).is_infinite());
    assert!(neighbour.credit(&at(100.0), Some(3.0)).is_infinite());
    neighbour.pay(3.0);
    assert!((neighbour.credit(&at(101.0), Some(4.0)) - 6.0).abs() < 1e-12);
    // … and a dear one leaves no debts.
    neighbour.pay(7.0);
    assert!((neighbour.credit(&at(102.0), Some(4.0)) - 4.0).abs() < 1e-12);
    assert!(neighbour.credit(&at(110.0), Some(4.0)).is_infinite());
    assert!(neighbour.credit(&at(110.5), None).is_infinite());
    assert!(neighbour.credit(&at(111.0), Some(4.0)).is_infinite());
    assert!(neighbour.credit(&at(111.5), Some(4.0)).is_infinite());
    assert!((neighbour.credit(&at(112.0), Some(4.0)) - 12.0).abs() < 1e-12);
    // Points without slip leave all that they earn to those behind them, …
    neighbour.pay(12.0);
    neighbour.save(&at(113.0), Some(3.0));
    assert!(neighbour.credit(&at(114.0), Some(4.0)).is_infinite());
    assert!(neighbour.credit(&at(115.0), Some(4.0)).is_infinite());
    assert!((neighbour.credit(&at(116.0), Some(4.0)) - 15.0).abs() < 1e-12);
    // … but not far away.
    neighbour.save(&at(130.0), Some(3.0));
    assert!(neighbour.credit(&at(131.0), Some(4.0)).is_infinite());
    assert!(neighbour.credit(&at(132.0), Some(4.0)).is_infinite());
    assert!((neighbour.credit(&at(133.0), Some(4.0)) - 15.0).abs() < 1e-12);
}

#[test]
fn fewer_harmonics_are_raised_to_what_more_of_them_find_beside() {
    let at = |omega: f64, size: f64| {
        let displacement = vec![c64::new(0.0, size); 2];
        Point { displacement, ..Point::empty(omega, PointStatus::Converged, 1, 1) }
    };
    let mut neighbour = Neighbour::default();
    let mut raised = |omega: f64, size: f64, highest: usize, mut errors: [f64; 2]| {
        neighbour.raise(&at(omega, size), highest, &mut errors);
        errors
    };
    assert_eq!(raised(100.0, 1.0, 9, [3.0, 5.0]), [3.0, 5.0]);
    // As the motion grows; never downwards, …
    assert_eq!(raised(101.0, 2.0, 3, [1.0, 12.0]), [6.0, 12.0]);
    assert_eq!(raised(101.0, 2.0, 11, [1.0, 12.0]), [1.0, 12.0]);
    // … and not far away.
    assert_eq!(raised(104.0, 2.0, 3, [0.5, 0.5]), [0.5, 0.5]);
    assert_eq!(raised(104.5, 0.0, 2, [0.0, 0.1]), [0.0, 0.1]);
    assert_eq!(raised(105.0, 4.0, 2, [0.0, 0.1]), [1.0, 1.0]);
    // An infinite estimate stays alone, and a point at rest tells nothing.
    assert_eq!(raised(110.0, 1.0, 9, [f64::INFINITY, 2.0]), [f64::INFINITY, 2.0]);
    assert_eq!(raised(110.5, 1.0, 3, [1.0, 1.0]), [1.0, 2.0]);
    assert_eq!(raised(115.0, 0.0, 9, [0.0, 0.0]), [0.0, 0.0]);
    assert_eq!(raised(115.5, 1.0, 3, [1.0, 1.0]), [1.0, 1.0]);
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

/// The first step of its estimate says so; as the last one it has all of it.
#[test]
fn a_solution_that_lacks_harmonics_takes_no_second_step() {
    let law = || Box::new(Jenkins::new(80.0, 0.3).unwrap());
    let load =
        || HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(2.0, 0.0), c64::new(0.0, 0.0)] };
    let model = under(law(), vec![load()]);
    let point = |harmonics: HarmonicChoice| {
        let settings = Settings { harmonics, tolerance: 1e-6, ..Settings::default() };
        let mut balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
        let three = Resolution { harmonics: 3, samples: None };
        let point = balance.attempt(three, 9.0, None).unwrap();
        let mut whole = point.clone();
        balance.complete_estimate(&mut whole).unwrap();
        (point, whole)
    };
    let (given, same) = point(HarmonicChoice::Fixed(3));
    let (first, whole) = point(HarmonicChoice::Auto);
    assert!(given.is_solved() && !given.partial && first.partial && !whole.partial);
    assert_eq!(given.error_estimate, same.error_estimate);
    assert_eq!(whole.error_estimate, given.error_estimate);
    assert!(first.error_estimate.iter().zip(&given.error_estimate).all(|(a, b)| a <= b));
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

/// Receptances of loads at the points that slip, and at those that begin to slip, are all that the equations ask for.
#[test]
fn loads_at_points_that_slip_are_all_there_are() {
    let model = chain();
    let table = SampleTable::new(Harmonics::new(5, true));
    let mut equations = [false, true].map(|part| {
        let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
        equations.densify();
        if part {
            equations.answer(vec![3]);
        }
        equations.set_omega(5.45).unwrap();
        equations
    });
    let slots = table.harmonics().slots();
    for size in [1e-6, 1e-5, 1e-4] {
        let x: Vec<f64> = (0..25 * slots).map(|i| size * (1.7 * i as f64).sin()).collect();
        let [whole, part] = equations.each_mut().map(|equations| {
            let (mut residual, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
            equations.residual(&x, &mut residual);
            assert!(equations.solve(&residual, &mut step));
            (residual, step, equations.active_points())
        });
        assert_eq!(whole.2, part.2);
        assert!(!whole.2.is_empty() && whole.2.len() < 25, "{size}: {:?}", whole.2);
        for (whole, part) in [(whole.0, part.0), (whole.1, part.1)] {
            let left: Vec<f64> = whole.iter().zip(&part).map(|(a, b)| a - b).collect();
            assert!(norm(&left) < 1e-10 * norm(&whole), "{size}: {}", norm(&left) / norm(&whole));
        }
    }
}

/// Where few of many contacts slip, receptances of theirs reach as far as products with all modes, and take less.
#[test]
fn few_that_slip_among_many_form_their_own_jacobian() {
    let (model, kept) = (chain(), Harmonics::new(15, true));
    let [few, all] = [1, 25].map(|slipping| {
        let effort = Effort::new(&model, true, slipping, 33);
        Extension::new(&effort, &kept, 5.45, f64::INFINITY)
    });
    assert!(few.formed && few.part && few.has_two());
    assert!(!all.formed);
}

//! What estimates may take.

#![allow(clippy::unwrap_used)]

use super::accuracy::Extension;
use super::effort::Effort;
use super::neighbour::Neighbour;
use super::solution::{Point, PointStatus};
use crate::contact::Jenkins;
use crate::fourier::Harmonics;
use crate::model::{Contact, Model};
use crate::structure::Structure;
use faer::{mat, Mat};

fn model() -> Model {
    let (mass, damping) = (mat![[2.0, 0.1], [0.1, 1.0]], mat![[0.5, -0.1], [-0.1, 0.4]]);
    let stiffness = mat![[300.0, -100.0], [-100.0, 15000.0]];
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let law = Box::new(Jenkins::new(80.0, 0.3).unwrap());
    let contact = Contact { law, rows: Mat::from_fn(1, 2, |_, j| [1.0, 0.0][j]) };
    Model::new(structure, vec![contact], Vec::new()).unwrap()
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

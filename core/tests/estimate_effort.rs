//! What estimates take along curves, counted in evaluations of the contact laws.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{fixed, grid};
use common::damper::Random;
use common::node::{exact, motion, random_case, summary};
use faer::{c64, mat, Mat};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::Arc;
use stickslip_core::balance::{sweep, ForcedBalance, Point};
use stickslip_core::contact::{
    BoucWen, Closure, ContactLaw, Coulomb, HarmonicForce, Motion, Phase, PointSummary,
    ReturnMapJacobian, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// A law that counts what it is asked for in more harmonics than a solution keeps.
#[derive(Debug, Clone)]
struct Counted<L> {
    law: L,
    kept: usize,
    beyond: Arc<AtomicUsize>,
}

impl<L> Counted<L> {
    fn new(law: L, kept: usize) -> Self {
        Self { law, kept, beyond: Arc::default() }
    }
}

/// Methods that a law has from the one that it is made of.
macro_rules! of {
    ($to:ident: $($method:ident($($argument:ident: $type:ty),*) $(-> $returned:ty)?;)*) => {
        $(fn $method(&self, $($argument: $type),*) $(-> $returned)? {
            self.$to().$method($($argument),*)
        })*
    };
}

impl<L: ContactLaw + Clone + 'static> Counted<L> {
    fn law(&self) -> &L {
        &self.law
    }

    fn exact(&self) -> &dyn HarmonicForce {
        self.law.closed_form().unwrap()
    }
}

impl<L: ContactLaw + Clone + 'static> ContactLaw for Counted<L> {
    of! {
        law:
        name() -> &'static str;
        displacements() -> usize;
        state_size() -> usize;
        stiffness() -> Mat<f64>;
        state_stiffness() -> Mat<f64>;
        is_odd() -> bool;
        is_monotone() -> bool;
        limits() -> Vec<f64>;
        surely_slips(motion: Motion<'_>) -> Option<bool>;
        return_map(before: &[f64], after: &[f64], state: &mut [f64], force: &mut [f64],
            jacobian: Option<&mut ReturnMapJacobian>);
        with_scaled_forces(factor: f64) -> Box<dyn ContactLaw>;
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        assert!((share - 1.0).abs() < f64::EPSILON, "no homotopy is expected");
        Box::new(self.clone())
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }
}

impl<L: ContactLaw + Clone + 'static> HarmonicForce for Counted<L> {
    of! {
        exact:
        summary(motion: Motion<'_>, out: &mut [PointSummary]);
        state_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        force_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        phases(motion: Motion<'_>) -> Vec<Phase>;
        parameter_slope(motion: Motion<'_>, index: usize, out: &mut [f64]);
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let beyond = motion.table.harmonics().highest() > self.kept;
        self.beyond.fetch_add(usize::from(beyond), Relaxed);
        self.exact().slip_load(motion, tangent, out);
    }
}

/// Two directions of a mass, the first beside a lighter one, on one law.
fn model(law: impl ContactLaw + 'static, load: f64) -> Model {
    let mass = mat![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.2]];
    let damping = mat![[12.0, 0.0, -2.0], [0.0, 16.0, 0.0], [-2.0, 0.0, 4.0]];
    let stiffness = mat![[9e4, 0.0, -5e4], [0.0, 1.6e5, 0.0], [-5e4, 0.0, 9e4]];
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let rows = Mat::from_fn(law.displacements(), 3, |i, j| f64::from(u8::from(i == j)));
    let amplitude = vec![c64::new(load, 0.0), c64::new(0.0, 0.7 * load), c64::new(0.3 * load, 0.0)];
    let contact = Contact { law: Box::new(law), rows };
    Model::new(structure, vec![contact], vec![HarmonicLoad { harmonic: 1, amplitude }]).unwrap()
}

fn pad() -> Coulomb {
    Coulomb::new(1, 0.4, 5e4, Some(8e4), Closure::Preload(40.0)).unwrap()
}

/// Points of a curve from 220 to 228 rad/s with one harmonic, and how often the law was asked for more.
fn along(load: f64) -> (Vec<Arc<Point>>, usize) {
    let law = Counted::new(pad(), 1);
    let beyond = Arc::clone(&law.beyond);
    let model = model(law, load);
    let balance = ForcedBalance::new(&model, fixed(1), &[0, 1, 2]).unwrap();
    let points = sweep(balance, &grid(220.0, 228.0, 41)).unwrap().points;
    (points, beyond.load(Relaxed))
}

#[test]
fn estimates_of_planar_contacts_are_few_and_short_along_a_fine_curve() {
    let (points, beyond) = along(30.0);
    assert!(points.iter().all(|point| point.contacts[0].slip_fraction > 0.1));
    assert!(points.iter().all(|point| point.error_estimate.iter().all(|error| *error > 0.0)));
    // Where every other point estimates and asks for the state by another evaluation, they are as many as points.
    assert!(beyond > 5 && 3 * beyond <= 2 * points.len(), "{beyond} of {} points", points.len());
}

#[test]
fn contacts_that_are_springs_have_no_error_and_no_estimate() {
    let (points, beyond) = along(3.0);
    assert_eq!(beyond, 0);
    assert!(points.iter().all(|point| point.error_estimate.iter().all(|error| *error == 0.0)));
}

#[test]
fn what_surely_slips_slips() {
    let mut random = Random(5);
    for directions in [1, 2] {
        let (mut told, mut slipping) = (0, 0);
        for _ in 0..300 {
            let case = random_case(&mut random, directions, 3);
            let motion = motion(&case.table, &case.displacement);
            let shares = summary(exact(&case.law), motion);
            slipping += usize::from(shares.iter().any(|share| share.slip_fraction > 0.0));
            if case.law.surely_slips(motion) == Some(true) {
                let mut load = SlipLoad::default();
                exact(&case.law).slip_load(motion, true, &mut load);
                assert!(load.active, "{:?}", case.law);
                assert!(shares.iter().any(|share| share.slip_fraction > 0.0), "{:?}", case.law);
                told += 1;
            }
        }
        assert!(4 * told > 3 * slipping && slipping > 100, "{told} of {slipping}");
    }
    let law = BoucWen::new(5e4, 16.0, 1.0, 0.5).unwrap();
    let table = SampleTable::new(Harmonics::new(1, true));
    let slips = |displacement: &[f64]| law.surely_slips(motion(&table, displacement));
    assert_eq!([slips(&[1e-9, 0.0]), slips(&[0.0, 0.0])], [Some(true), None]);
}

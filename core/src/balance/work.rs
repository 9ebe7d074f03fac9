//! The work that the equations of a point take, as reckoned while it is done: what may be spent on a point is
//! counted so, not by the clock, and every point ends in the same way everywhere.

use super::account::Account;
use super::condensed::Condensed;
use super::forced::ForcedBalance;
use super::modal_work::suits;
use crate::contact::{ContactLaw, SlipLoad};

/// Work that a point with automatic harmonics may take beside exact orbits: some seconds, …
const OF_POINT: f64 = 4e9;
/// … or so many Newton steps of the lowest level, if these take more.
const STEPS: f64 = 600.0;
/// Of a march, per sample, and per sample and coefficient, of values and of every row of a tangent \[ns\].
const PER_SAMPLE: f64 = 300.0;
const PER_PRODUCT: f64 = 1.5;
/// Of the Fourier transform of its tangent, per sample and entry \[ns\].
const PER_PROJECTION: f64 = 0.05;
/// Of a factorisation and what leads to it, over the third power of its size \[ns\].
const PER_CUBE: f64 = 0.06;

impl Condensed<'_> {
    /// Of an evaluation of the laws, with their tangents or without \[ns\].
    pub(super) fn work_of_laws(&self, loads: &[SlipLoad], tangent: bool) -> f64 {
        let slots = self.table.harmonics().slots();
        let laws = self.model.laws().iter().zip(loads);
        laws.map(|(law, load)| of_law(&**law, slots, load, tangent)).sum()
    }

    /// Of a factorisation of the equations of all points that yield \[ns\].
    pub(super) fn work_of_factors(&self) -> f64 {
        PER_CUBE * ((self.active_points().len() * self.table.harmonics().slots()) as f64).powi(3)
    }
}

/// Of a law in so many coefficients per component, and of the rounds of its march \[ns\].
fn of_law(law: &dyn ContactLaw, slots: usize, load: &SlipLoad, tangent: bool) -> f64 {
    let Some(form) = law.closed_form() else { return 0.0 };
    let resolved = form.resolves();
    if resolved == usize::MAX {
        return form.effort(slots, load, load.active && tangent);
    }
    let components = law.displacements() as f64;
    let coefficients = components * slots as f64;
    let rows = if load.active && tangent { components } else { 0.0 };
    let samples = 2.0 * (resolved as f64 + 1.0);
    let [rounds, derived] = [load.rounds, load.derived].map(|rounds| rounds.max(1) as f64);
    let values = PER_PRODUCT * coefficients + rounds * PER_SAMPLE;
    let steps = values + derived * rows * (PER_SAMPLE + PER_PRODUCT * coefficients);
    samples * (steps + PER_PROJECTION * rows / components * coefficients.powi(2))
}

impl ForcedBalance<'_> {
    /// Grants every point so much work \[ns\].
    #[must_use]
    pub(crate) fn granting(mut self, work: f64) -> Self {
        self.granted = work;
        self
    }

    /// Grants a point its work, from here on. Points whose harmonics are given may take whatever they need, and so
    /// may rings and many contacts, whose prices are known before.
    pub(super) fn grant(&mut self) {
        let order = self.control.lowest_order();
        let table = self.table(order);
        let compliance = self.model.compliance();
        let chosen = !self.control.is_fixed() && compliance.ring().is_none();
        let work = if self.granted.is_finite() {
            self.granted
        } else if chosen && !suits(compliance, table.harmonics()) {
            let unknowns = (compliance.contacts() * table.harmonics().slots()) as f64;
            OF_POINT.max(STEPS * PER_CUBE * unknowns.powi(3))
        } else {
            f64::INFINITY
        };
        self.account = Account::open(work, &self.profile);
    }

    /// What is left of it.
    pub(super) fn left(&self) -> f64 {
        self.account.left(&self.profile)
    }

    /// Whether nothing is.
    pub(super) fn is_spent(&self) -> bool {
        self.left() <= 0.0
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::balance::settings::{Evaluation, HarmonicChoice, SampleChoice, Settings};
    use crate::balance::solution::{Point, PointStatus};
    use crate::balance::unknowns::Unknowns;
    use crate::balance::ExactOrbits;
    use crate::contact::{
        Aft, BoucWen, Closure, Coulomb, Cubic, HarmonicForce as _, Motion, Residual,
    };
    use crate::fourier::{Harmonics, SampleTable};
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};
    use std::cell::Cell;

    /// A mass on a hardening spring.
    fn model() -> Model {
        let one = mat![[1.0]];
        let structure = Structure::new(one.as_ref(), mat![[0.1]].as_ref(), one.as_ref());
        let row = Mat::from_fn(1, 1, |_, _| 1.0);
        let contacts = vec![Contact { law: Box::new(Cubic::new(0.3).unwrap()), rows: row }];
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(0.2, 0.0)] }];
        Model::new(structure.unwrap(), contacts, loads).unwrap()
    }

    /// Searches for orbits that take long and find nothing.
    #[derive(Default)]
    struct Vain {
        work: Cell<f64>,
        allowed: Cell<f64>,
    }

    impl ExactOrbits for Vain {
        fn orbit(&self, _: f64, _: usize) -> Option<Point> {
            self.work.set(self.work.get() + 1e9);
            None
        }

        fn orbit_of(&self, _: &Unknowns, omega: f64, highest: usize) -> Option<Point> {
            self.orbit(omega, highest)
        }

        fn price(&self, _: f64, _: usize, _: usize) -> Option<f64> {
            Some(1.0)
        }

        fn is_one_of_many(&self, _: f64) -> bool {
            false
        }

        fn settled(&self, _: f64, _: usize) -> Option<Vec<c64>> {
            None
        }

        fn work(&self) -> f64 {
            self.work.get()
        }

        fn allow(&self, work: f64) {
            self.allowed.set(work);
        }
    }

    #[test]
    fn a_point_without_work_says_so() {
        let model = model();
        let balance = || ForcedBalance::new(&model, Settings::default(), &[0]).unwrap();
        let enough = balance().granting(1e9).solve(0.7, None).unwrap();
        assert_eq!(enough.status, PointStatus::Converged);
        let none = balance().granting(1.0).solve(0.7, None).unwrap();
        assert_eq!(none.status, PointStatus::WorkLimit);
        assert!(!none.is_solved());
    }

    /// So are error estimates: those of the harmonics, and those of the samples.
    #[test]
    fn estimates_are_paid_for() {
        let model = model();
        for evaluation in [Evaluation::Direct, Evaluation::Marched(SampleChoice::Fixed(64))] {
            let harmonics = HarmonicChoice::Fixed(5);
            let settings = Settings { harmonics, evaluation, ..Settings::default() };
            let taken = |observe: &[usize]| {
                let mut balance = ForcedBalance::new(&model, settings, observe).unwrap();
                assert!(balance.solve(0.7, None).unwrap().is_solved());
                balance.profile.work
            };
            assert!(taken(&[0]) > 1.2 * taken(&[]));
        }
    }

    /// A march is paid for by its rounds.
    #[test]
    fn rounds_are_paid_for() {
        let law = BoucWen::new(1.0, 1.0, 1.5, 0.6).unwrap();
        let law = Aft::new(Box::new(law), 64).unwrap();
        let of = |rounds: usize| {
            let load = SlipLoad { rounds, derived: rounds, active: true, ..SlipLoad::default() };
            [false, true].map(|tangent| of_law(&law, 11, &load, tangent))
        };
        let ([value, tangent], [values, tangents]) = (of(1), of(50));
        assert!(values > 20.0 * value && tangents > 40.0 * tangent);
    }

    /// A contact in space that slips is paid for by what its slip takes.
    #[test]
    fn panels_are_paid_for() {
        let law = Coulomb::new(2, 0.4, 80.0, Some(100.0), Closure::Preload(10.0)).unwrap();
        let table = SampleTable::new(Harmonics::new(15, false));
        let slots = table.harmonics().slots();
        let of = |size: f64| {
            let mut displacement = vec![0.0; 3 * slots];
            for (at, u) in [(1, size), (slots + 2, 0.5 * size), (2 * slots + 1, 0.02)] {
                displacement[at] = u;
            }
            let residual = Residual::Centred;
            let motion = Motion { table: &table, displacement: &displacement, residual };
            let mut load = SlipLoad::default();
            law.slip_load(motion, true, &mut load);
            (load.panels, of_law(&law, slots, &load, true))
        };
        let ((none, stuck), (panels, slipping)) = (of(0.01), of(0.2));
        assert!(none == 0 && panels > 10);
        assert!(slipping > 5.0 * stuck, "{slipping} {stuck}");
    }

    /// So is slip that has ended before the period that repeats.
    #[test]
    fn laps_are_paid_for() {
        let law = Coulomb::new(2, 0.4, 80.0, Some(100.0), Closure::Preload(10.0)).unwrap();
        let of = |solved: usize| {
            let load = SlipLoad { solved, ..SlipLoad::default() };
            of_law(&law, 31, &load, false)
        };
        assert!(of(100) > 10.0 * of(0));
    }

    /// A search is on the account of the point, and hears what is left of it.
    #[test]
    fn searches_for_orbits_are_paid_for() {
        let model = model();
        let orbits = Vain::default();
        let balance = ForcedBalance::new(&model, Settings::default(), &[0]).unwrap();
        let mut balance = balance.granting(3e9).rescued(&orbits);
        balance.grant();
        for left in [3e9, 2e9] {
            assert!(balance.orbit_to_start_from(0.7, 9).is_none());
            assert_eq!((orbits.allowed.get(), balance.left()), (left, left - 1e9));
        }
    }
}

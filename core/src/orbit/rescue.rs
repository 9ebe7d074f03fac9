//! Exact orbits for a harmonic balance: a start where Newton's method fails, and the answer where
//! more harmonics would cost more. A passive system always has one.

use super::periodic::{PeriodicOrbits, FASTEST};
use super::price::{orbit_price, steps_for};
use super::settings::OrbitSettings;
use super::settled::Settled;
use crate::balance::{ExactOrbits, Point, PointStatus, Progress};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::State;
use faer::c64;
use std::cell::{Cell, RefCell};

/// Operations that one search may take, transition matrices included: a second or two.
const PATIENCE: f64 = 2e9;

/// Finds exact orbits on demand.
pub struct OrbitInitialGuess<'a> {
    model: &'a Model,
    residual: Residual,
    observe: &'a [usize],
    progress: &'a Progress<'a>,
    /// Prepared when they are first needed; `None` inside if there is nothing to prepare.
    orbits: RefCell<Option<Option<PeriodicOrbits<'a>>>>,
    /// Frequency and start of the last orbit, which may be asked for again with more harmonics, and whether
    /// it is one of many.
    last: RefCell<Option<(f64, State, bool)>>,
    /// Frequency at which no orbit was found last: a longer search is not granted, and none is repeated.
    missed: Cell<f64>,
    /// Frequency and motion that settled last, if one did: it is asked for with many numbers of harmonics.
    settled: RefCell<Option<(f64, Option<Settled>)>>,
}

impl<'a> OrbitInitialGuess<'a> {
    /// Orbits of a model, with the DOFs `observe`, under the residual assumed by its balance;
    /// `progress` may end a search.
    #[must_use]
    pub fn new(
        model: &'a Model,
        residual: Residual,
        observe: &'a [usize],
        progress: &'a Progress<'a>,
    ) -> Self {
        Self {
            model,
            residual,
            observe,
            progress,
            orbits: RefCell::new(None),
            last: RefCell::new(None),
            missed: Cell::new(f64::NAN),
            settled: RefCell::new(None),
        }
    }

    fn with<T>(&self, work: impl FnOnce(&mut PeriodicOrbits<'a>) -> Option<T>) -> Option<T> {
        let mut prepared = self.orbits.borrow_mut();
        let orbits = prepared.get_or_insert_with(|| {
            let settings = OrbitSettings { residual: self.residual, ..OrbitSettings::default() };
            let orbits = PeriodicOrbits::new(self.model, settings, self.observe).ok()?;
            let steps = steps_for(orbits.system(), PATIENCE);
            Some(orbits.watched(self.progress).granted(steps))
        });
        work(orbits.as_mut()?)
    }
}

impl ExactOrbits for OrbitInitialGuess<'_> {
    fn orbit(&self, omega: f64, highest: usize) -> Option<Point> {
        if self.missed.get() == omega {
            return None;
        }
        let found = self.with(|orbits| {
            orbits.report_up_to(highest);
            let last = self.last.take().filter(|(known, ..)| *known == omega);
            let found = orbits.solve(omega, last.as_ref().map(|(_, start, _)| start)).ok()?;
            // Of laws with constant limits sliders at rest leave the vibration as it is.
            let many = orbits.depends_on_sliders() && found.neutral > 0;
            self.last.replace(found.start().cloned().map(|start| (omega, start, many)));
            (found.response.status == PointStatus::Converged).then_some(found.response)
        });
        if found.is_none() {
            self.missed.set(omega);
        }
        found
    }

    fn price(&self, omega: f64, events: usize, highest: usize) -> Option<f64> {
        self.with(|orbits| {
            let system = orbits.system();
            system.check_pace(self.model, omega, FASTEST).ok()?;
            Some(orbit_price(system, orbits.half_wave(), omega, events, highest))
        })
    }

    fn settled(&self, omega: f64, highest: usize) -> Option<Vec<c64>> {
        if self.with(|_| Some(())).is_some() {
            return None;
        }
        let mut settled = self.settled.borrow_mut();
        if settled.as_ref().is_none_or(|(known, _)| *known != omega) {
            let found = Settled::of(self.model, omega, PATIENCE, self.progress);
            *settled = Some((omega, found));
        }
        let (_, found) = settled.as_ref()?;
        found.as_ref().map(|motion| motion.amplitudes(highest))
    }

    fn is_one_of_many(&self, omega: f64) -> bool {
        self.last.borrow().as_ref().is_some_and(|(known, _, many)| *known == omega && *many)
    }
}

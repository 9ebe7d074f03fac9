//! Exact orbits for a harmonic balance: a start where Newton's method fails, and the answer where
//! more harmonics would cost more. A passive system always has one.

use super::closed::Orbit;
use super::periodic::PeriodicOrbits;
use super::price::{orbit_price, steps_for, PER_OPERATION};
use super::settings::OrbitSettings;
use super::settled::Settled;
use crate::balance::{ExactOrbits, Point, PointStatus, Progress, Unknowns};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::{walks, State, FASTEST_EXACT};
use faer::c64;
use std::cell::{Cell, RefCell};

/// Operations that one search may take, transition matrices included: a second or two.
const PATIENCE: f64 = 2e9;
/// Operations that one may take in any case: where a balance has spent the work of a point, an orbit may be near.
const LEAST: f64 = 5e8;

/// Where an orbit began.
struct Known {
    omega: f64,
    start: State,
    /// Whether it is one of many.
    many: bool,
}

/// Finds exact orbits on demand.
pub struct OrbitInitialGuess<'a> {
    model: &'a Model,
    residual: Residual,
    observe: &'a [usize],
    progress: &'a Progress<'a>,
    /// Prepared when they are first needed; `None` inside if there is nothing to prepare.
    orbits: RefCell<Option<Option<PeriodicOrbits<'a>>>>,
    /// The last orbit, which may be asked for again with more harmonics, and the last that began with a motion.
    last: RefCell<Option<Known>>,
    of_motion: RefCell<Option<Known>>,
    /// Frequency at which no orbit was found last: a longer search is not granted, and none is repeated.
    missed: Cell<f64>,
    /// Frequency at which a search has begun with a given motion last, and whether it led to an orbit.
    begun: Cell<(f64, bool)>,
    /// Frequency and motion that settled last, if one did: it is asked for with many numbers of harmonics.
    settled: RefCell<Option<(f64, Option<Settled>)>>,
    /// Frequency at which it was last found out whether a body walks, and whether it does.
    walked: Cell<(f64, bool)>,
    /// Operations of motions that were to settle, or to walk.
    followed: Cell<f64>,
    /// Operations that the point at hand leaves for a search.
    allowed: Cell<f64>,
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
            of_motion: RefCell::new(None),
            missed: Cell::new(f64::NAN),
            begun: Cell::new((f64::NAN, false)),
            settled: RefCell::new(None),
            walked: Cell::new((f64::NAN, false)),
            followed: Cell::new(0.0),
            allowed: Cell::new(PATIENCE),
        }
    }

    fn with<T>(&self, work: impl FnOnce(&mut PeriodicOrbits<'a>) -> Option<T>) -> Option<T> {
        let mut prepared = self.orbits.borrow_mut();
        let orbits = prepared.get_or_insert_with(|| {
            let settings = OrbitSettings { residual: self.residual, ..OrbitSettings::default() };
            let orbits = PeriodicOrbits::new(self.model, settings, self.observe).ok()?;
            Some(orbits.watched(self.progress))
        });
        work(orbits.as_mut()?)
    }

    /// Operations that a search may take.
    fn patience(&self) -> f64 {
        self.allowed.get().clamp(LEAST, PATIENCE)
    }

    /// The orbit from where the last one of its kind at the same frequency began, if there was one.
    fn search(&self, known: &RefCell<Option<Known>>, omega: f64, highest: usize) -> Option<Point> {
        self.with(|orbits| {
            orbits.report_up_to(highest);
            orbits.grant(steps_for(orbits.system(), self.patience()));
            let last = known.take().filter(|last| last.omega == omega);
            let found = orbits.solve(omega, last.as_ref().map(|last| &last.start)).ok()?;
            // Of laws with constant limits sliders at rest leave the vibration as it is.
            let many = orbits.depends_on_sliders() && found.neutral > 0;
            let start = found.start().cloned();
            known.replace(start.map(|start| Known { omega, start, many }));
            (found.response.status == PointStatus::Converged).then(|| with_unseen(found))
        })
    }
}

/// The harmonics of an orbit, with what those above them change in its half ranges: contacts may ring there.
fn with_unseen(orbit: Orbit) -> Point {
    let (exact, mut response) = (orbit.half_ranges(), orbit.response);
    let seen = response.half_ranges();
    let unseen = exact.iter().zip(&seen).map(|(exact, seen)| (exact - seen).abs());
    response.error_estimate.iter_mut().zip(unseen).for_each(|(error, unseen)| *error += unseen);
    response
}

impl ExactOrbits for OrbitInitialGuess<'_> {
    fn orbit(&self, omega: f64, highest: usize) -> Option<Point> {
        if self.missed.get() == omega {
            return None;
        }
        let found = self.search(&self.last, omega, highest);
        if found.is_none() {
            self.missed.set(omega);
        }
        found
    }

    fn orbit_of(&self, motion: &Unknowns, omega: f64, highest: usize) -> Option<Point> {
        let (begun, led) = self.begun.get();
        if begun == omega && !led {
            return None;
        }
        if begun != omega {
            self.of_motion.take();
            self.with(|orbits| {
                orbits.begin_with(motion.clone());
                Some(())
            });
        }
        let found = self.search(&self.of_motion, omega, highest);
        self.begun.set((omega, found.is_some()));
        found
    }

    fn price(&self, omega: f64, events: usize, highest: usize) -> Option<f64> {
        self.with(|orbits| {
            let system = orbits.system();
            system.check_pace(self.model, omega, FASTEST_EXACT).ok()?;
            Some(orbit_price(system, orbits.half_wave(), omega, events, highest))
        })
    }

    fn settled(&self, omega: f64, highest: usize) -> Option<Vec<c64>> {
        if self.with(|_| Some(())).is_some() {
            return None;
        }
        let mut settled = self.settled.borrow_mut();
        if settled.as_ref().is_none_or(|(known, _)| *known != omega) {
            let (found, taken) = Settled::of(self.model, omega, self.patience(), self.progress);
            self.followed.set(self.followed.get() + taken);
            *settled = Some((omega, found));
        }
        let (_, found) = settled.as_ref()?;
        found.as_ref().map(|motion| motion.amplitudes(highest))
    }

    fn walks(&self, omega: f64) -> bool {
        let (known, walked) = self.walked.get();
        if known == omega {
            return walked;
        }
        let (walked, taken) = walks(self.model, omega, self.patience(), self.progress);
        self.followed.set(self.followed.get() + taken);
        self.walked.set((omega, walked));
        walked
    }

    fn work(&self) -> f64 {
        let orbits = self.orbits.borrow();
        let orbits = orbits.iter().flatten().map(|orbits| orbits.profile.work).sum::<f64>();
        orbits + PER_OPERATION * self.followed.get()
    }

    fn allow(&self, work: f64) {
        self.allowed.set(work / PER_OPERATION);
    }

    fn is_one_of_many(&self, omega: f64) -> bool {
        self.last.borrow().as_ref().is_some_and(|last| last.omega == omega && last.many)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::BoucWen;
    use crate::model::Contact;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::mat;

    /// A motion that settles is followed no further than its work allows, and is on the account.
    #[test]
    fn motions_that_settle_are_paid_for() {
        let one = mat![[1.0]];
        let structure = Structure::new(one.as_ref(), mat![[0.02]].as_ref(), one.as_ref());
        let law = Box::new(BoucWen::new(1.0, 0.3, 1.0, 0.5).unwrap());
        let contacts = vec![Contact { law, rows: mat![[1.0]] }];
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(1.0, 0.0)] }];
        let model = Model::new(structure.unwrap(), contacts, loads).unwrap();
        let orbits = OrbitInitialGuess::new(&model, Residual::Centred, &[], &|_| true);
        orbits.allow(0.0);
        assert!(orbits.settled(0.1, 5).is_some());
        let taken = orbits.work();
        assert!(taken > 0.0 && taken <= PER_OPERATION * LEAST);
        // The same motion is not followed again.
        assert!(orbits.settled(0.1, 9).is_some());
        assert_eq!(orbits.work(), taken);
        assert!(orbits.settled(1e-5, 5).is_none());
        assert_eq!(orbits.work(), taken);
    }
}

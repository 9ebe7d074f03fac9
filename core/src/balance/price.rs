//! What a balance costs, in floating-point operations: by it automatic harmonics are given up for
//! an exact orbit, or for good.
//!
//! The price follows from the model and the solution below, not from the clock or from the work
//! already done: the same point is solved in the same way everywhere.

use super::modal_work::{of_step, suits};
use super::settings::{Evaluation, HarmonicChoice, Settings};
use crate::fourier::Harmonics;
use crate::model::Model;

/// Newton iterations with a new Jacobian that one more level usually takes.
const ITERATIONS: f64 = 10.0;
/// What an operation of a factorisation counts among those of scalars: it works in blocks.
const IN_BLOCKS: f64 = 0.2;
/// Operations of a law and its tangent, line searches included, over the square of the slots.
const PER_LAW: f64 = 40.0;
/// Operations that nobody waits for, about a hundredth of a second: below them harmonics climb.
pub(super) const TRIFLE: f64 = 1e7;
/// Operations of a sweep from which it is cut into pieces, some tenths of a second.
pub(crate) const MUCH: f64 = 2e9;
/// Operations that a point may ask for at once, some seconds, …
const AFFORDABLE: f64 = 5e9;
/// … or this multiple of the lowest level, if already that is much: four times its harmonics.
const MULTIPLE: f64 = 64.0;
/// A homotopy takes as much as so many levels: it must be affordable, …
const HOMOTOPY: f64 = 200.0;
/// … or belong to less than twice the harmonics of the lowest level.
const TWICE: f64 = 8.0;
/// Operations of one that is asked for, about ten seconds; its Newton iterations are at least and at most so
/// many.
const LONG: f64 = 5e10;
const FEWEST: f64 = 500.0;
const MOST: f64 = 5000.0;

/// Price of the balance equations of a model with some slipping points.
pub(super) struct Price<'a> {
    pub(super) model: &'a Model,
    pub(super) half_wave: bool,
    pub(super) slipping: usize,
    /// Lowest order with which a point begins.
    pub(super) lowest: usize,
}

impl Price<'_> {
    /// Operations of a solution with harmonics up to `order`.
    pub(super) fn of(&self, order: usize) -> f64 {
        let slots = if self.half_wave { order + 1 } else { 2 * order + 1 } as f64;
        let cube = |points: usize| (points as f64 * slots).powi(3);
        let factors = match self.model.compliance().ring() {
            // Contacts are eliminated inside their sectors, then sectors from neighbour to neighbour.
            Some(ring) => {
                let layout = ring.layout();
                let (own, between) = (layout.contacts, layout.between.len());
                let inside = 3.0 * cube(own - between);
                ring.sectors() as f64 * (inside + 20.0 * cube(layout.ports() - own + 2 * between))
            }
            None if suits(self.model.compliance(), &Harmonics::new(order, self.half_wave)) => {
                of_step(self.model.compliance(), slots, self.slipping as f64, 1.0) / IN_BLOCKS
            }
            None => 2.0 / 3.0 * cube(self.slipping),
        };
        let laws = PER_LAW * self.slipping as f64 * slots.powi(2);
        ITERATIONS * (IN_BLOCKS * factors + laws)
    }

    /// Operations that a point may ask for.
    pub(super) fn affordable(&self) -> f64 {
        AFFORDABLE.max(MULTIPLE * self.of(self.lowest))
    }

    /// Newton iterations that a homotopy with harmonics up to `order` may take.
    pub(super) fn budget_of_homotopy(&self, order: usize) -> usize {
        self.homotopy(order).clamp(FEWEST, MOST) as usize
    }

    /// Whether the fewest iterations of a homotopy take no longer than they may.
    pub(super) fn ends_homotopy(&self, order: usize) -> bool {
        self.homotopy(order) >= FEWEST
    }

    /// Newton iterations of a homotopy that takes as long as it may.
    fn homotopy(&self, order: usize) -> f64 {
        LONG * ITERATIONS / self.of(order)
    }

    /// Whether a homotopy to harmonics up to `order` is affordable.
    pub(super) fn allows_homotopy(&self, order: usize) -> bool {
        self.of(order) <= (AFFORDABLE / HOMOTOPY).max(TWICE * self.of(self.lowest))
    }
}

/// Operations of a solution in which all points slip; nothing if harmonics or samples are chosen.
pub(crate) fn work_of_given(model: &Model, settings: &Settings) -> Option<f64> {
    let HarmonicChoice::Fixed(order) = settings.harmonics else { return None };
    if settings.evaluation != Evaluation::Direct {
        return None;
    }
    let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
    let slipping = model.compliance().contacts();
    Some(Price { model, half_wave, slipping, lowest: order }.of(order))
}

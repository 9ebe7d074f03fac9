//! What a balance costs, in floating-point operations: by it automatic harmonics are given up for
//! an exact orbit, or for good.
//!
//! The price follows from the model and the solution below, not from the clock or from the work
//! already done: the same point is solved in the same way everywhere.

use crate::model::Model;

/// Newton iterations with a new Jacobian that one more rung usually takes.
const ITERATIONS: f64 = 10.0;
/// Rungs that a homotopy is worth.
pub(super) const HOMOTOPY: f64 = 30.0;
/// Operations that nobody waits for, some hundredths of a second: below them harmonics climb.
pub(super) const TRIFLE: f64 = 1e7;
/// Operations that a point may ask for at once, some seconds to half a minute, …
const AFFORDABLE: f64 = 2e10;
/// … or this multiple of the lowest rung, if already that is much: three to four times its harmonics.
const MULTIPLE: f64 = 64.0;

/// Price of the balance equations of a model with some slipping points.
pub(super) struct Price<'a> {
    pub(super) model: &'a Model,
    pub(super) half_wave: bool,
    pub(super) slipping: usize,
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
            None => 2.0 / 3.0 * cube(self.slipping),
        };
        ITERATIONS * factors
    }

    /// What a point may cost; `lowest` is the lowest rung.
    pub(super) fn affordable(&self, lowest: usize) -> f64 {
        AFFORDABLE.max(MULTIPLE * self.of(lowest))
    }
}

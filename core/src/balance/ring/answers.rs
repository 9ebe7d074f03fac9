//! One harmonic of a ring of sectors, with its motions that are known: that of the loads, and those of
//! slip loads at the few points that yield.
//!
//! All else follows by superposition. A point is asked for once at a frequency, however many Newton
//! steps, harmonics and error estimates make use of it.

use crate::structure::{RingMotion, RingOrder};
use faer::c64;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The answers of a ring at one harmonic.
#[derive(Clone)]
pub(crate) struct RingAnswers {
    order: Arc<RingOrder>,
    /// Under the external loads alone, if there are some.
    loaded: Option<Arc<RingMotion>>,
    /// Under a unit slip load at a point.
    units: BTreeMap<usize, Arc<RingMotion>>,
}

impl RingAnswers {
    pub(crate) fn new(order: RingOrder, contacts: usize) -> Self {
        let rest = || vec![c64::new(0.0, 0.0); contacts];
        let loaded = order.is_loaded().then(|| Arc::new(order.respond(true, &rest())));
        Self { order: Arc::new(order), loaded, units: BTreeMap::new() }
    }

    pub(crate) fn order(&self) -> &RingOrder {
        &self.order
    }

    /// Contact displacements under the external loads alone; nothing where there are none.
    pub(crate) fn loaded(&self) -> &[c64] {
        self.loaded.as_ref().map_or(&[], |motion| &motion.contact)
    }

    /// Asks for the motions under unit slip loads at some points.
    pub(crate) fn ask(&mut self, points: &[usize], contacts: usize) {
        let mut unit = vec![c64::new(0.0, 0.0); contacts];
        for point in points {
            let order = &self.order;
            self.units.entry(*point).or_insert_with(|| {
                unit[*point] = c64::new(1.0, 0.0);
                let motion = order.respond(false, &unit);
                unit[*point] = c64::new(0.0, 0.0);
                Arc::new(motion)
            });
        }
    }

    /// Displacement of a point under a unit slip load at another one that was asked for.
    pub(crate) fn between(&self, point: usize, source: usize) -> c64 {
        self.units.get(&source).map_or(c64::new(f64::NAN, 0.0), |motion| motion.contact[point])
    }

    /// Motion under slip loads and, if `loaded`, the external loads.
    pub(crate) fn motion(&self, loaded: bool, slip_load: &[c64]) -> RingMotion {
        let zero = c64::new(0.0, 0.0);
        let slips = || slip_load.iter().enumerate().filter(|(_, q)| **q != zero);
        if !slips().all(|(point, _)| self.units.contains_key(&point)) {
            return self.order.respond(loaded, slip_load);
        }
        let size = self.order.sectors() * self.order.ports();
        let base = self.loaded.as_deref().filter(|_| loaded).cloned();
        let mut sum = base.unwrap_or_else(|| RingMotion {
            port: vec![zero; size],
            force: vec![zero; size],
            contact: vec![zero; slip_load.len()],
        });
        for (point, q) in slips() {
            let Some(unit) = self.units.get(&point) else { continue };
            let parts = [
                (&mut sum.port, &unit.port),
                (&mut sum.force, &unit.force),
                (&mut sum.contact, &unit.contact),
            ];
            for (sum, part) in parts {
                sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part * q);
            }
        }
        sum
    }
}

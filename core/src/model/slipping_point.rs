//! How far the points that slip move a resonance, at the amplitude at which friction leaves it.

use crate::contact::Describing;
use faer::c64;

/// Bisections of an amplitude over up to twelve decades.
const BISECTIONS: usize = 30;
/// A point that slips in a resonance: the effect of its force, what it shows of the motion, its slip
/// limit and its stiffness.
pub(super) struct SlippingPoint {
    pub(super) effect: f64,
    pub(super) seen: f64,
    pub(super) limit: f64,
    pub(super) stiffness: f64,
}

impl SlippingPoint {
    /// Its effect as the complex stiffness of a Jenkins element at an amplitude of the resonance.
    fn carried(&self, amplitude: f64) -> c64 {
        let own = Describing::of_jenkins(self.stiffness, self.limit, self.seen * amplitude);
        own.stiffness * (self.effect * self.seen)
    }
}

/// By how much friction moves a resonance that a load drives with the rate `driven` against its
/// `decay`: at the amplitude at which the load makes up for what is lost. To first order in what
/// the points still carry; the neighbours of a state are states by themselves.
pub(super) fn shift<I>(driven: f64, decay: f64, points: &dyn Fn() -> I) -> Option<f64>
where
    I: Iterator<Item = SlippingPoint>,
{
    let slips = |point: &SlippingPoint| point.effect > 0.0 && point.seen > 0.0 && point.limit > 0.0;
    let points: Vec<SlippingPoint> = points().filter(slips).collect();
    let stuck = points.iter().map(|one| one.limit / (one.stiffness * one.seen));
    let (mut low, mut high) = (stuck.fold(f64::INFINITY, f64::min), driven / decay);
    let starts = low < high;
    if !starts {
        return None;
    }
    high = high.min(1e12 * low);
    let lost = |a: f64| a * (decay + points.iter().map(|one| one.carried(a).im).sum::<f64>());
    for _ in 0..BISECTIONS {
        let middle = (low * high).sqrt();
        if lost(middle) < driven {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(points.iter().map(|one| one.carried(low).re).sum())
}

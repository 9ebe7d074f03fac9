//! A motion beside one that is known, by the difference of both.
//!
//! Between events the difference follows the equations without loads, and exponentials that are known take it along.
//! An event comes a little earlier or later. From the instant of the one that is known the motion goes on in the
//! regime before it, or back, to its own event, and from there in the regime behind it to the same instant again:
//! what it is then is no motion that has been, but one that comes to the same. Events that only one of both motions
//! meets are not seen: whoever goes by what is found here looks at the motion itself in the end.

use super::linear_phase::{Crossing, LinearPhase};
use super::propagator::{Propagators, Reach};
use super::regime_rates::Rates;
use super::transition::Transition;
use crate::contact::PointState;
use crate::solve::dot;
use faer::Mat;

/// By how much an event may come earlier or later, in units of the fastest rate: further off the series of the
/// motion loses digits.
const FARTHEST: f64 = 4.0;
/// Step of Newton's method towards its instant, in the same units, that leaves nothing, and most steps.
const FOUND: f64 = 1e-7;
const STEPS: usize = 8;

impl Transition<'_> {
    /// Difference at the end of the phases of a motion at `omega` [rad/s] from that at their start; nothing where
    /// an event changes its place among the others, or something is not known.
    pub(crate) fn beside(
        &self,
        phases: &[LinearPhase],
        omega: f64,
        difference: &[f64],
        known: &mut Propagators,
    ) -> Option<Vec<f64>> {
        let roots = self.roots();
        let mut own = difference.to_vec();
        // By how long the difference lags behind, and by how much later the last event was.
        let (mut lag, mut last) = (0.0, 0.0);
        for (number, phase) in phases.iter().enumerate() {
            let before = self.rates(&phase.regime, &roots);
            let mut total = Mat::from_fn(own.len(), 1, |i, _| own[i]);
            let (reach, duration) = (Reach::LAGGING, lag + phase.duration);
            lag = self.advance_as_known(&phase.regime, duration, reach, &mut total, known)?;
            own.copy_from_slice(total.col_as_slice(0));
            before.lag(lag, &mut own);
            let Some(next) = phases.get(number + 1) else {
                // Behind the end nothing has happened yet.
                return (last <= phase.duration).then_some(own);
            };
            let end = phase.crossing.as_ref();
            let end = end.filter(|end| end.after.points == next.regime.points)?;
            let after = self.rates(&next.regime, &roots);
            let late = self.cross([&before, &after], phase, end, omega, &mut own)?;
            if phase.duration + late < last {
                return None;
            }
            last = late;
            after.lag(-lag, &mut own);
        }
        None
    }

    /// Takes the difference at an event to the regime behind it; by how much later the motion meets it.
    fn cross(
        &self,
        [before, after]: [&Rates<'_>; 2],
        phase: &LinearPhase,
        end: &Crossing,
        omega: f64,
        difference: &mut [f64],
    ) -> Option<f64> {
        let (system, modes, point) = (self.system(), self.weight().len(), end.event.point);
        let own = system.bodies().iter().find(|body| body.points.contains(&point))?;
        let strain = 2 * modes + own.strains.start;
        let begins = end.event.state != PointState::Stuck;
        // A strain grows on its side, a slip velocity falls.
        let way = if begins { end.event.state.sign() } else { -phase.regime.points[point].sign() };
        let (shape, fastest) = (system.contact_shape(point), system.rate(omega));
        let motion = self.coordinates(&end.state);
        let beside = |difference: &[f64]| -> Vec<f64> {
            motion.iter().zip(difference).map(|(y, d)| y + d).collect()
        };
        let (mut late, mut found) = (0.0, false);
        for _ in 0..STEPS {
            let (y, at) = (beside(difference), [omega, end.event.time + late]);
            let rate = before.rate(y.clone(), at);
            let [miss, slope] = if begins {
                [difference[strain], rate[strain]]
            } else {
                [&y, &rate].map(|all| dot(shape, &all[modes..2 * modes]))
            };
            let step = -miss / slope;
            let near = (late + step).abs() * fastest <= FARTHEST;
            if !near || slope * way <= 0.0 {
                return None;
            }
            before.go_on(y, Some(at), step, difference);
            late += step;
            if step.abs() * fastest <= FOUND {
                found = true;
                break;
            }
        }
        if begins {
            difference[strain] = 0.0;
        }
        let at = [omega, end.event.time + late];
        after.go_on(beside(difference), Some(at), -late, difference);
        found.then_some(late)
    }
}

impl Rates<'_> {
    /// Takes a difference on by a lag, or back.
    fn lag(&self, lag: f64, difference: &mut [f64]) {
        if lag != 0.0 {
            self.go_on(difference.to_vec(), None, lag, difference);
        }
    }
}

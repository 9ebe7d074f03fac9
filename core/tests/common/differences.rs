//! Multipliers of an orbit by differences of the period map.
//!
//! The map is smooth as long as no event comes, goes or changes places with another: a difference counts
//! where the motion from the displaced state meets the events of the orbit. Next to an event that the
//! orbit all but meets one side is left, or short steps. Extrapolated differences tell their own error.

use faer::{c64, Mat};
use stickslip_core::contact::PointState;
use stickslip_core::model::Model;
use stickslip_core::motion::{transient, Event, Scheme, TransientSettings};
use stickslip_core::orbit::Orbit;

/// Steps in units of the state, of falling length.
const STEPS: [f64; 8] = [1e-3, 2.5e-4, 6e-5, 1.5e-5, 4e-6, 1e-6, 2.5e-7, 6e-8];
/// Angle up to which an event belongs to the start.
const START: f64 = 1e-9;
/// Share of a period below which what slips or opens touches.
const TOUCH: f64 = 1e-4;
/// Change by the last extrapolation that is small enough.
const ENOUGH: f64 = 1e-9;

/// Largest difference between the multipliers and those by differences, and by how much the latter move if
/// the last extrapolation is left out. Nothing where no step meets the events of the orbit, or contacts touch
/// their limits.
pub fn multiplier_error(model: &Model, found: &Orbit) -> Option<[f64; 2]> {
    let (omega, size) = (found.response.omega, found.state.len());
    let map = PeriodMap { model, omega };
    let scale = scales(model, &found.state);
    let held = map.held(found);
    let (end, events) = map.after(&found.state, &held);
    // What has slipped until it sticks touches its limit, where the map has no derivative.
    let share = |point: usize| found.response.contacts[point].slip_fraction;
    let touches = |&(point, state): &(usize, PointState)| state.slips() && share(point) < TOUCH;
    let grazes = |point: usize| (0.0..TOUCH).contains(&share(point)) && share(point) > 0.0;
    if events.iter().any(touches) || (0..found.response.contacts.len()).any(grazes) {
        return None;
    }
    let [mut best, mut next] = [Mat::<f64>::zeros(size, size), Mat::zeros(size, size)];
    for j in 0..size {
        let quotient = |step: f64| -> Option<Vec<f64>> {
            let mut state = found.state.clone();
            state[j] += step * scale[j];
            let (after, met) = map.after(&state, &held);
            // In units of the state the matrix has the same eigenvalues.
            let of = |i: usize| (after[i] - end[i]) / (step * scale[i]);
            (met == events).then(|| (0..size).map(of).collect())
        };
        let mut least = extrapolated(1.0, &quotient);
        if least.as_ref().is_none_or(|(change, _)| *change > ENOUGH) {
            let other = extrapolated(-1.0, &quotient);
            let changes =
                [&least, &other].map(|one| one.as_ref().map_or(f64::INFINITY, |one| one.0));
            least = if changes[1] < changes[0] { other } else { least };
        }
        let (_, [one, other]) = least?;
        for i in 0..size {
            (best[(i, j)], next[(i, j)]) = (one[i], other[i]);
        }
    }
    let expected = best.eigenvalues().unwrap();
    Some([apart(&found.multipliers, &expected), apart(&next.eigenvalues().unwrap(), &expected)])
}

/// The multipliers are those by differences, to 1e-6.
pub fn assert_multipliers(model: &Model, found: &Orbit) {
    let [error, own] = multiplier_error(model, found).unwrap();
    assert!(error < 1e-6 && own < 1e-7, "{error:e} {own:e} {:?}", found.multipliers);
}

/// Largest difference between sums of equal powers, per change of a value in them. Next to a multiple
/// multiplier, as 0 is of contacts that slip, the values themselves go with a root of the matrix's error.
fn apart(one: &[c64], other: &[c64]) -> f64 {
    let largest = one.iter().fold(1.0_f64, |most, value| most.max(value.norm()));
    let sum = |values: &[c64], power: i32| values.iter().map(|m| m.powi(power)).sum::<c64>();
    (1..=one.len() as i32)
        .map(|k| (sum(one, k) - sum(other, k)).norm() / (f64::from(k) * largest.powi(k - 1)))
        .fold(0.0, f64::max)
}

/// Slopes at no step, by the polynomial through those of neighbouring steps that changes least, with this
/// change, and by the one before it.
fn extrapolated(
    sign: f64,
    quotient: &dyn Fn(f64) -> Option<Vec<f64>>,
) -> Option<(f64, [Vec<f64>; 2])> {
    let mut best: Option<(f64, [Vec<f64>; 2])> = None;
    let mut row: Vec<Vec<f64>> = Vec::new();
    let mut steps: Vec<f64> = Vec::new();
    for step in STEPS {
        let Some(slopes) = quotient(sign * step) else { continue };
        let mut fresh = vec![slopes];
        for (before, wider) in row.iter().zip(steps.iter().rev()) {
            let finer = fresh[fresh.len() - 1].clone();
            let pairs = finer.iter().zip(before);
            let better: Vec<f64> =
                pairs.map(|(fine, coarse)| fine + (fine - coarse) / (wider / step - 1.0)).collect();
            let change = [&finer, before].map(|other| {
                better.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            });
            let change = change[0].max(change[1]);
            fresh.push(better.clone());
            if best.as_ref().is_none_or(|(least, _)| change < *least) {
                best = Some((change, [better, finer]));
            }
        }
        steps.push(step);
        row = fresh;
        if best.as_ref().is_some_and(|(change, _)| *change < ENOUGH) {
            break;
        }
    }
    best
}

/// Units of displacements, velocities and tractions.
fn scales(model: &Model, state: &[f64]) -> Vec<f64> {
    let n = model.compliance().dofs();
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    (0..state.len())
        .map(|i| {
            let part = [0..n, n..2 * n, 2 * n..state.len()][(i / n).min(2)].clone();
            largest(&state[part]).max(1e-6 * largest(state)).max(1e-12)
        })
        .collect()
}

struct PeriodMap<'a> {
    model: &'a Model,
    omega: f64,
}

impl PeriodMap<'_> {
    /// State after a period, and which events it has met.
    fn after(&self, state: &[f64], held: &[bool]) -> (Vec<f64>, Vec<(usize, PointState)>) {
        let wanted = TransientSettings {
            omega: self.omega,
            scheme: Scheme::Exact,
            periods: 1,
            tolerance: None,
            samples: 1,
            keep: None,
        };
        let state = self.admitted(state, held);
        let mut all = transient(self.model, &wanted, Some(&state), &[0], &|_| true).unwrap();
        // At the very start rounding decides who is at a limit already.
        let later = |event: &&Event| event.time * self.omega > START;
        let met = all.events.iter().filter(later).map(|event| (event.point, event.state)).collect();
        (all.poincare.pop().unwrap(), met)
    }

    /// Which contacts slip at the start: their tractions are at their limit.
    fn held(&self, found: &Orbit) -> Vec<bool> {
        let slip = |first: usize| found.response.contacts[first].slip_fraction > 0.0;
        let mut slips = self.model.points().iter().map(|points| slip(points.start));
        let mut out = Vec::new();
        self.each(&found.state, |own, limit| {
            out.push(slips.next().unwrap() && size(own) >= (1.0 - 1e-9) * limit);
        });
        out
    }

    /// Tractions beyond their limits are taken back to them, and those of contacts that slip go with them.
    fn admitted(&self, state: &[f64], held: &[bool]) -> Vec<f64> {
        let mut held = held.iter();
        self.each(state, |own, limit| {
            let now = size(own);
            if *held.next().unwrap() || now > limit {
                own.iter_mut().for_each(|t| *t *= if now > 0.0 { limit / now } else { 0.0 });
            }
        })
    }

    /// Calls a function with the traction of each law in its state and the limit there.
    fn each(&self, state: &[f64], mut call: impl FnMut(&mut [f64], f64)) -> Vec<f64> {
        let (model, n) = (self.model, self.model.compliance().dofs());
        let mut state = state.to_vec();
        let (displacement, tractions) = state.split_at_mut(2 * n);
        let mut next = 0;
        for (law, points) in model.laws().iter().zip(model.points()) {
            let at: Vec<f64> = points
                .clone()
                .map(|i| (0..n).map(|j| model.ports().rows[(i, j)] * displacement[j]).sum())
                .collect();
            let own = &mut tractions[next..next + law.state_size()];
            next += own.len();
            // A traction beyond all limits is taken back to its own.
            let mut most = vec![1e9; own.len()];
            let mut force = vec![0.0; at.len()];
            law.return_map(&at, &at, &mut most, &mut force, None);
            call(own, size(&most));
        }
        state
    }
}

fn size(traction: &[f64]) -> f64 {
    traction.iter().map(|t| t * t).sum::<f64>().sqrt()
}

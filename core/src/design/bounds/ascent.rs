//! The way of one DOF to its largest or least amplitude over the positions of the sliders.
//!
//! In units of its range every slider counts alike. The first step goes to the corner to which the
//! gradient points; from then on steps are those of a quasi-Newton method (BFGS), shortened by the
//! cubic through two heights and slopes where they lead too far.

use crate::balance::HeldMotion;
use crate::design::held_pool::HeldPool;

/// Steps of a climb.
const STEPS: usize = 8;
/// Steps that may be shortened one after the other.
const SHORTENED: usize = 3;
/// What the slopes still promise, relative to the amplitude, that is nothing.
const ENOUGH: f64 = 1e-5;
/// Share of the largest slope below which the first step leaves a slider where it is.
const SMALL: f64 = 1e-3;
/// Distance from a limit, relative to the range, at which a slider is at it.
const AT_LIMIT: f64 = 1e-6;

/// A climb, with what it has learnt of the curvature.
#[derive(Debug, Clone)]
pub(super) struct Ascent {
    dof: usize,
    sign: f64,
    /// Inverse of the curvature, row by row; empty before it is known.
    curvature: Vec<f64>,
}

/// Height and slopes at a motion, in units of the ranges.
struct Place {
    height: f64,
    /// Slopes, zero where a slider touches its limit and is drawn against it.
    slopes: Vec<f64>,
    /// What they promise as far as the limits.
    promise: f64,
}

/// Raises every DOF to its largest and lowers it to its least amplitude, with what neighbours have learnt.
pub(super) fn climb(pool: &mut HeldPool<'_>, before: &[Ascent]) -> Vec<Ascent> {
    let dofs = pool.motions[0].amplitude.len();
    let mut ascents = Vec::with_capacity(2 * dofs);
    for (dof, sign) in (0..dofs).flat_map(|dof| [(dof, 1.0), (dof, -1.0)]) {
        let known = before.iter().find(|ascent| ascent.dof == dof && ascent.sign == sign);
        let mut ascent = known.cloned().unwrap_or_else(|| Ascent::new(dof, sign));
        ascent.climb(pool);
        ascents.push(ascent);
    }
    ascents
}

impl Ascent {
    fn new(dof: usize, sign: f64) -> Self {
        Self { dof, sign, curvature: Vec::new() }
    }

    /// Climbs from the best motion of a pool, and from one that holds more sliders.
    fn climb(&mut self, pool: &mut HeldPool<'_>) {
        let best = pool.best(self.dof, self.sign);
        self.climb_from(pool, best);
        // Where that one leaves fewer sliders to vary, others may still pass it.
        let best = pool.best(self.dof, self.sign);
        let (held, height) =
            (pool.motions[best].held().count(), self.place(&pool.motions[best]).height);
        let hope = |from: &usize| {
            let place = self.place(&pool.motions[*from]);
            place.height + place.promise
        };
        let others = (0..pool.motions.len()).filter(|&from| {
            pool.motions[from].held().count() > held && hope(&from) > height + ENOUGH * height.abs()
        });
        if let Some(other) = others.max_by(|a, b| hope(a).total_cmp(&hope(b)).then(b.cmp(a))) {
            self.climb_from(pool, other);
        }
    }

    fn climb_from(&mut self, pool: &mut HeldPool<'_>, mut from: usize) {
        for _ in 0..STEPS {
            let place = self.place(&pool.motions[from]);
            if place.promise <= ENOUGH * place.height.abs() {
                return;
            }
            let Some(next) = self.step(pool, from, &place) else { return };
            from = next;
        }
    }

    fn place(&self, motion: &HeldMotion) -> Place {
        let mut slopes = vec![0.0; motion.range.len()];
        let mut promise = 0.0;
        for (slider, [low, high]) in motion.held() {
            let width = high - low;
            let slope = self.sign * motion.slopes[self.dof][slider] * width;
            let at = motion.sliders[slider];
            let room = if slope > 0.0 { (high - at) / width } else { (at - low) / width };
            if room > AT_LIMIT {
                slopes[slider] = slope;
                promise += slope.abs() * room.min(1.0);
            }
        }
        Place { height: self.sign * motion.amplitude[self.dof], slopes, promise }
    }

    /// The next better motion, if there is one.
    fn step(&mut self, pool: &mut HeldPool<'_>, from: usize, place: &Place) -> Option<usize> {
        let origin = pool.motions[from].clone();
        let widths = |slider: usize| origin.range[slider].map_or(0.0, |[low, high]| high - low);
        let direction = self.direction(&place.slopes);
        let mut target: Vec<f64> = origin.sliders.clone();
        for (slider, [low, high]) in origin.held() {
            let at = target[slider] + direction[slider] * (high - low);
            target[slider] = at.clamp(low, high);
        }
        for _ in 0..=SHORTENED {
            let Some(tried) = pool.reach(from, &target) else {
                // There may be no such motion so far away.
                for (slider, _) in origin.held() {
                    target[slider] += 0.5 * (origin.sliders[slider] - target[slider]);
                }
                continue;
            };
            let motion = &pool.motions[tried];
            let way: Vec<f64> = (0..origin.sliders.len())
                .map(|i| match widths(i) {
                    0.0 => 0.0,
                    width => (motion.sliders[i] - origin.sliders[i]) / width,
                })
                .collect();
            let other = self.place(motion);
            let inwards = self.slopes(motion, &origin);
            self.learn(&way, &self.slopes(&origin, &origin), &inwards);
            if other.height > place.height {
                return Some(tried);
            }
            let along = |slopes: &[f64]| slopes.iter().zip(&way).map(|(s, w)| s * w).sum::<f64>();
            let share =
                summit([place.height, along(&place.slopes)], [other.height, along(&inwards)]);
            for (slider, _) in origin.held() {
                target[slider] = origin.sliders[slider] + share * way[slider] * widths(slider);
            }
        }
        None
    }

    /// All slopes of a motion in units of the ranges of another one.
    fn slopes(&self, motion: &HeldMotion, origin: &HeldMotion) -> Vec<f64> {
        let own = &motion.slopes[self.dof];
        let range = |i: usize| origin.range[i].map_or(0.0, |[low, high]| high - low);
        (0..own.len()).map(|i| self.sign * own[i] * range(i)).collect()
    }

    fn direction(&self, slopes: &[f64]) -> Vec<f64> {
        let count = slopes.len();
        if self.curvature.len() == count * count {
            let free = |i: usize| slopes[i] != 0.0;
            let step: Vec<f64> = (0..count)
                .map(|i| match free(i) {
                    true => (0..count).map(|j| self.curvature[i * count + j] * slopes[j]).sum(),
                    false => 0.0,
                })
                .collect();
            let rises = step.iter().zip(slopes).map(|(s, g)| s * g).sum::<f64>() > 0.0;
            if rises && step.iter().all(|s| s.is_finite()) {
                return step;
            }
        }
        let largest = slopes.iter().fold(0.0_f64, |most, slope| most.max(slope.abs()));
        let corner = |slope: &f64| if slope.abs() > SMALL * largest { slope.signum() } else { 0.0 };
        slopes.iter().map(corner).collect()
    }

    /// Takes up how the slopes have changed along a way.
    fn learn(&mut self, way: &[f64], before: &[f64], after: &[f64]) {
        let count = way.len();
        let change: Vec<f64> = before.iter().zip(after).map(|(b, a)| b - a).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (bend, size) = (dot(way, &change), dot(&change, &change));
        if bend <= 1e-8 * (dot(way, way) * size).sqrt() || bend.is_nan() {
            // Not concave: nothing is learnt of a summit.
            self.curvature.clear();
            return;
        }
        if self.curvature.len() != count * count {
            self.curvature = vec![0.0; count * count];
            (0..count).for_each(|i| self.curvature[i * count + i] = bend / size);
        }
        let turned: Vec<f64> =
            (0..count).map(|i| dot(&self.curvature[i * count..(i + 1) * count], &change)).collect();
        let own = (bend + dot(&change, &turned)) / (bend * bend);
        for i in 0..count {
            for j in 0..count {
                self.curvature[i * count + j] +=
                    own * way[i] * way[j] - (turned[i] * way[j] + way[i] * turned[j]) / bend;
            }
        }
    }
}

/// Where between 0 and 1 the cubic through two heights with their slopes is highest.
fn summit([h0, s0]: [f64; 2], [h1, s1]: [f64; 2]) -> f64 {
    let (a, b) = (2.0 * (h0 - h1) + s0 + s1, 3.0 * (h1 - h0) - 2.0 * s0 - s1);
    let root = (b * b - 3.0 * a * s0).sqrt();
    // The root with a negative second derivative, without cancellation.
    let share = if b <= 0.0 { s0 / (root - b) } else { -(b + root) / (3.0 * a) };
    if share.is_finite() {
        share.clamp(0.05, 0.8)
    } else {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summit_of_a_cubic_is_found() {
        // h = t − 2 t² + t³/2: h' = 0 at (4 − √10)/3.
        let h = |t: f64| t - 2.0 * t * t + 0.5 * t.powi(3);
        let s = |t: f64| 1.0 - 4.0 * t + 1.5 * t * t;
        let share = summit([h(0.0), s(0.0)], [h(1.0), s(1.0)]);
        assert!((share - (4.0 - 10.0_f64.sqrt()) / 3.0).abs() < 1e-12);
        assert!((summit([0.0, 1.0], [0.0, -1.0]) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_curvature_of_a_parabola_leads_to_its_top() {
        // −(x − a)ᵀ A (x − a)/2, learnt along the two axes of A.
        let mut ascent = Ascent::new(0, 1.0);
        let slope =
            |x: [f64; 2]| [-4.0 * (x[0] - 0.3) - (x[1] - 0.6), -(x[0] - 0.3) - 2.0 * (x[1] - 0.6)];
        let points = [[0.0, 0.0], [0.5, 0.1], [0.2, 0.9], [0.7, 0.3]];
        for pair in points.windows(2) {
            let way = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            ascent.learn(&way, &slope(pair[0]), &slope(pair[1]));
        }
        let mut x = [0.7, 0.3];
        for _ in 0..6 {
            let before = slope(x);
            let step = ascent.direction(&before);
            let next = [x[0] + step[0], x[1] + step[1]];
            ascent.learn(&step, &before, &slope(next));
            x = next;
        }
        assert!((x[0] - 0.3).abs() < 1e-6 && (x[1] - 0.6).abs() < 1e-6, "{x:?}");
    }
}

//! A straight step of the elastic Coulomb contact.
//!
//! One step of the return map takes the displacements along a straight line and is exact there. The
//! slider lets go where |t| = μN, a quadratic equation; from there on the traction turns towards the
//! line of motion, `tan(φ/2) ∝ exp(−∫ k_t |du|/(μN))` with φ the angle between the two. So the only
//! error of a sampled evaluation is that of the straight lines, of second order in their length.

use super::dual::{Dual, Real};
use super::law::{squared, Coulomb};
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::ContactLaw as _;

/// Numbers that a step depends on: traction before (2), tangential change (2), N before and after.
const INPUTS: usize = 6;
/// Distance from the cone, relative to it, that is none.
const ON_CONE: f64 = 1e-12;
/// Least share of an angle that is told from none.
const FADED: f64 = 1e-100;

/// How a step went.
pub(super) struct Passage<T> {
    pub(super) traction: [T; 2],
    /// Shares of the step in which the contact is open, and slips.
    pub(super) open: f64,
    pub(super) slipping: f64,
}

impl Coulomb {
    /// Takes the traction along a straight step: see the head of this file.
    pub(super) fn step<T: Real>(
        &self,
        traction: [T; 2],
        du: [T; 2],
        before: T,
        after: T,
    ) -> Passage<T> {
        let (mu, k) = (T::from(self.friction), T::from(self.tangential_stiffness));
        let zero = T::from(0.0);
        if after.value() <= 0.0 {
            let closed = before.value().max(0.0) / (before.value() - after.value());
            let open = if closed.is_finite() { 1.0 - closed } else { 1.0 };
            return Passage { traction: [zero; 2], open, slipping: 0.0 };
        }
        let stuck =
            |start: [T; 2], share: T| [start[0] + k * du[0] * share, start[1] + k * du[1] * share];
        let limit = mu * after;
        if before.value() <= 0.0 {
            // It closes within the step. The slider has followed until then: the contact sticks as
            // long as |k_t u'| < μ k_n v', or slips along u'.
            let closed = after / (after - before);
            let trial = stuck([zero; 2], closed);
            let size = squared(trial);
            let open = 1.0 - closed.value();
            if size.value() <= limit.value().powi(2) {
                return Passage { traction: trial, open, slipping: 0.0 };
            }
            let by = limit / size.sqrt();
            let slipping = closed.value();
            return Passage { traction: [by * trial[0], by * trial[1]], open, slipping };
        }
        let trial = stuck(traction, T::from(1.0));
        // The distance from the cone is convex along the line: outside at its end alone.
        if squared(trial).value() <= limit.value().powi(2) {
            return Passage { traction: trial, open: 0.0, slipping: 0.0 };
        }
        let at_start = mu * before;
        let growth = mu * (after - before);
        let rate = [k * du[0], k * du[1]];
        let c = squared(traction) - at_start * at_start;
        let b = traction[0] * rate[0] + traction[1] * rate[1] - at_start * growth;
        let a = squared(rate) - growth * growth;
        let on_cone = c.value() >= -ON_CONE * at_start.value().powi(2);
        let stick = if on_cone && b.value() >= 0.0 {
            zero
        } else {
            let c = if on_cone { zero } else { c };
            let root = (b * b - a * c).sqrt();
            if b.value() > 0.0 {
                -c / (b + root)
            } else {
                (root - b) / a
            }
        };
        // Of a step of the size of rounding the root is anywhere.
        let stick = match stick.value() {
            late if late >= 1.0 => T::from(1.0),
            inside if inside > 0.0 => stick,
            _ => zero,
        };
        let share = stick.value();
        let from = stuck(traction, stick);
        let size = squared(from);
        let way = squared(du);
        let rest = T::from(1.0) - stick;
        let turned = if way.value() == 0.0 || size.value() == 0.0 {
            let by = if size.value() > 0.0 { limit / size.sqrt() } else { zero };
            [by * from[0], by * from[1]]
        } else {
            let (way, size) = (way.sqrt(), size.sqrt());
            let along = [du[0] / way, du[1] / way];
            let cos = (from[0] * along[0] + from[1] * along[1]) / size;
            let sin = (from[1] * along[0] - from[0] * along[1]) / size;
            let begun = before + stick * (after - before);
            // ∫ ds/N along the rest of the line.
            let inverse = ((after - begun) / begun).log_ratio() / begun;
            let fade = (-(k * way * rest * inverse / mu)).exp();
            // A traction straight against the motion stays there, however small this becomes.
            let fade = if fade.value() > FADED { fade } else { T::from(FADED) };
            // The half angle φ/2 as a vector, without loss where φ is near 0 or π.
            let (x, y) = if cos.value() >= 0.0 {
                (T::from(1.0) + cos, sin * fade)
            } else if sin.value() >= 0.0 {
                (sin, (T::from(1.0) - cos) * fade)
            } else {
                (-sin, (cos - T::from(1.0)) * fade)
            };
            let norm = x * x + y * y;
            let (cos, sin) = ((x * x - y * y) / norm, T::from(2.0) * x * y / norm);
            [limit * (cos * along[0] - sin * along[1]), limit * (cos * along[1] + sin * along[0])]
        };
        Passage { traction: turned, open: 0.0, slipping: 1.0 - share }
    }

    /// Takes a step that sticks from end to end; nothing of any other. The distance from the cone is convex
    /// along the step: inside at its end, it is so throughout.
    pub(super) fn spring_step(
        &self,
        [before, after]: [&[f64]; 2],
        state: &mut [f64],
        force: &mut [f64],
    ) -> bool {
        let (k, to) = (self.tangential_stiffness, self.pressing(after));
        let trial = self.pair(|i| state[i] + k * (after[i] - before[i]));
        let limit = self.friction * to;
        let inside = squared(trial) <= limit * limit;
        if self.pressing(before) <= 0.0 || to <= 0.0 || !inside {
            return false;
        }
        // Numbers one by one: so few are not worth a call.
        for ((state, force), trial) in state.iter_mut().zip(&mut *force).zip(trial) {
            (*state, *force) = (trial, trial);
        }
        if let Some(normal) = force.get_mut(self.directions) {
            *normal = to - self.balanced();
        }
        true
    }

    /// Takes any step with its derivative.
    pub(super) fn differentiated_step(
        &self,
        [before, after]: [&[f64]; 2],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: &mut ReturnMapJacobian,
    ) {
        let (count, directions) = (self.displacements(), self.directions);
        jacobian.reset(count, directions);
        if self.spring_step([before, after], state, force) {
            return self.differentiate_spring(jacobian);
        }
        let (from, to) = (self.pressing(before), self.pressing(after));
        if let Some(normal) = force.get_mut(directions) {
            *normal = to.max(0.0) - self.balanced();
        }
        let du = |i: usize| after[i] - before[i];
        let input = |value: f64, index: usize| Dual::<INPUTS>::variable(value, index);
        let passage = self.step(
            self.pair(|i| input(state[i], i)),
            self.pair(|i| input(du(i), 2 + i)),
            input(from, 4),
            input(to, 5),
        );
        // Slip that begins with the end of the step is none.
        if from > 0.0 && passage.open == 0.0 && passage.slipping == 0.0 {
            for (i, traction) in passage.traction[..directions].iter().enumerate() {
                (state[i], force[i]) = (traction.value(), traction.value());
            }
            return self.differentiate_spring(jacobian);
        }
        let normal = self.normal_stiffness.unwrap_or(0.0);
        for (i, traction) in passage.traction[..directions].iter().enumerate() {
            let slopes = &traction.slopes;
            (state[i], force[i]) = (traction.value(), traction.value());
            for j in 0..directions {
                jacobian.by_state[i * directions + j] = slopes[j];
                jacobian.by_after[i * count + j] = slopes[2 + j];
                jacobian.by_before[i * count + j] = -slopes[2 + j];
            }
            if count > directions {
                jacobian.by_before[i * count + directions] = normal * slopes[4];
                jacobian.by_after[i * count + directions] = normal * slopes[5];
            }
            jacobian.force_by_state[i * directions + i] = 1.0;
            jacobian.slipping[i] = passage.slipping;
        }
        if count > directions {
            jacobian.slipping[directions] = passage.open;
            if to > 0.0 {
                jacobian.force_by_after[directions * count + directions] = normal;
            }
        }
    }

    /// Writes the derivative of a step that sticks from end to end into one that is blank.
    fn differentiate_spring(&self, jacobian: &mut ReturnMapJacobian) {
        let (count, directions) = (self.displacements(), self.directions);
        for i in 0..directions {
            jacobian.by_state[i * directions + i] = 1.0;
            jacobian.by_after[i * count + i] = self.tangential_stiffness;
            jacobian.by_before[i * count + i] = -self.tangential_stiffness;
            jacobian.force_by_state[i * directions + i] = 1.0;
        }
        if let (true, Some(normal)) = (count > directions, self.normal_stiffness) {
            jacobian.force_by_after[directions * count + directions] = normal;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::Closure;
    use crate::test_numbers::random;

    /// A step of the spring is that of the return map, to the last digit and with one derivative for
    /// all; of any other nothing is taken.
    #[test]
    fn steps_of_the_spring_are_those_that_stick() {
        let mut taken = [0, 0];
        for directions in [1, 2] {
            let law = Coulomb::new(directions, 0.4, 150.0, Some(200.0), Closure::Preload(20.0));
            let law = law.unwrap();
            let mut spring: Option<ReturnMapJacobian> = None;
            for case in 0..500 {
                let number = |i: usize| 0.25 * random(31 * case + i);
                let before: Vec<f64> = (0..=directions).map(number).collect();
                let after: Vec<f64> =
                    before.iter().enumerate().map(|(i, u)| u + 0.3 * number(7 + i)).collect();
                // Within the cone at the begin.
                let limit = 0.4 * law.pressing(&before).max(0.0);
                let begun: Vec<f64> =
                    (0..directions).map(|i| limit * random(case + 3 * i)).collect();
                let (mut state, mut force) = (begun.clone(), vec![0.0; directions + 1]);
                let springs = law.springs(&before, &after, &mut state, &mut force);
                let (mut plain, mut other) = (begun.clone(), vec![0.0; directions + 1]);
                let mut jacobian = ReturnMapJacobian::default();
                let (mut own, mut same) = (begun.clone(), other.clone());
                law.return_map(&before, &after, &mut own, &mut same, Some(&mut jacobian));
                assert_eq!(springs, jacobian.sticks(), "{case}");
                law.return_map(&before, &after, &mut plain, &mut other, None);
                taken[usize::from(springs)] += 1;
                if !springs {
                    assert_eq!((state, force), (begun, vec![0.0; directions + 1]));
                    continue;
                }
                assert_eq!((state, force), (plain, other), "{case}");
                let known = spring.get_or_insert_with(|| jacobian.clone());
                let parts = |j: &ReturnMapJacobian| {
                    [&j.by_state, &j.by_before, &j.by_after, &j.force_by_state, &j.force_by_after]
                        .map(Clone::clone)
                };
                assert_eq!(parts(known), parts(&jacobian), "{case}");
            }
        }
        assert!(taken.iter().all(|count| *count > 150), "{taken:?}");
    }
}

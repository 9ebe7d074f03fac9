//! The memory of a Masing law from instant to instant: the reversals that no later loop has closed.
//!
//! The state holds the steps `k (u_i − u_{i−1})` from one remembered reversal to the next, the first from
//! zero; their signs alternate and their sizes fall, and unused places are zero. With `v = k u` and the
//! loss Λ the force is `f = v − Λ(z_0) − Σ 2 Λ(z_i/2) − 2 Λ((v − v_n)/2)`, or `v − Λ(v)` at first loading.
//! Where a motion has more reversals than there are places, the two go whose loss changes the force
//! least.

use crate::contact::backbone::LoadingCurve;
use crate::contact::return_map::ReturnMapJacobian;

/// The remembered steps, each a sum of neighbours among those before and the new one.
struct Steps {
    size: Vec<f64>,
    made_of: Vec<[usize; 2]>,
}

impl Steps {
    fn of(state: &[f64]) -> Self {
        let size: Vec<f64> = state.iter().copied().take_while(|z| *z != 0.0).collect();
        let made_of = (0..size.len()).map(|i| [i, i + 1]).collect();
        Self { size, made_of }
    }

    fn drop_last(&mut self, count: usize) {
        let left = self.size.len() - count;
        self.size.truncate(left);
        self.made_of.truncate(left);
    }

    /// Joins the three steps whose loop is missed least.
    fn thin(&mut self, loss: impl Fn(f64) -> f64) {
        let missed = |i: usize| {
            let [a, b, c] = [self.size[i], self.size[i + 1], self.size[i + 2]];
            let kept = loss(0.5 * a) + loss(0.5 * b) + loss(0.5 * c);
            (kept - loss(0.5 * (a + b + c))).abs()
        };
        let least = (1..self.size.len() - 2).min_by(|a, b| missed(*a).total_cmp(&missed(*b)));
        let Some(at) = least else { return };
        self.size[at] += self.size[at + 1] + self.size[at + 2];
        self.made_of[at][1] = self.made_of[at + 2][1];
        self.size.drain(at + 1..at + 3);
        self.made_of.drain(at + 1..at + 3);
    }
}

/// Takes the state from one displacement to another, and gives the force there.
pub(super) fn step(
    curve: &LoadingCurve,
    before: f64,
    after: f64,
    state: &mut [f64],
    force: &mut f64,
    jacobian: Option<&mut ReturnMapJacobian>,
) {
    let k = curve.stiffness;
    let loss = |v: f64| if k == 0.0 { 0.0 } else { curve.loss((v / k).abs()).value.copysign(v) };
    let slope = |v: f64| if k == 0.0 { 0.0 } else { curve.loss((v / k).abs()).slope / k };
    let (from, to) = (k * before, k * after);
    let mut steps = Steps::of(state);
    let known = steps.size.len();
    let origin: f64 = steps.size.iter().sum();
    let ahead = steps.size.last().map_or(from, |last| -last);
    if (to - from) * ahead < 0.0 {
        if known > 0 && (from - origin) * ahead <= 0.0 {
            // It has not moved since, but for rounding: the branch before goes on.
            steps.drop_last(1);
        } else {
            steps.size.push(from - origin);
            steps.made_of.push([known, known + 1]);
        }
    }
    loop {
        let distance = (to - steps.size.iter().sum::<f64>()).abs();
        match steps.size[..] {
            [first] if distance >= 2.0 * first.abs() => steps.drop_last(1),
            [.., _, last] if distance >= last.abs() => steps.drop_last(2),
            _ => break,
        }
    }
    if steps.size.len() > state.len() {
        steps.thin(loss);
    }
    let last = to - steps.size.iter().sum::<f64>();
    let inner = |(i, z): (usize, &f64)| if i == 0 { loss(*z) } else { 2.0 * loss(0.5 * z) };
    let first = steps.size.is_empty();
    let lost: f64 = steps.size.iter().enumerate().map(inner).sum();
    let lost = lost + if first { loss(last) } else { 2.0 * loss(0.5 * last) };
    state.fill(0.0);
    state[..steps.size.len()].copy_from_slice(&steps.size);
    *force = to - lost;
    let Some(jacobian) = jacobian else { return };
    let size = state.len();
    jacobian.reset(1, size);
    let own = slope(if first { last } else { 0.5 * last });
    for (i, [from, to]) in steps.made_of.iter().copied().enumerate() {
        for j in from..to.min(known) {
            jacobian.by_state[i * size + j] += 1.0;
        }
        if to > known {
            // The new reversal: k u less all steps before.
            jacobian.by_before[i] = k;
            (0..known).for_each(|j| jacobian.by_state[i * size + j] -= 1.0);
        }
        let held = slope(if i == 0 { steps.size[0] } else { 0.5 * steps.size[i] });
        jacobian.force_by_state[i] = own - held;
    }
    jacobian.force_by_after[0] = k * (1.0 - own);
    jacobian.slipping[0] = own;
}

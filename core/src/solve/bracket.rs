//! A bracket of a change of sign that is narrowed where each value is dear.
//!
//! Where the values are smooth the secant leads to the zero in a few steps; where they jump, no more are
//! taken than halving takes and one (interpolate, truncate, project: Oliveira and Takahashi 2020).

/// How far beyond the secant's zero a value is taken, relative to the square of the width: the zero comes to lie
/// between two values.
const BEYOND: f64 = 0.2;
/// Steps more than halving takes.
const MORE: i32 = 1;

/// A bracket of length one at first.
#[derive(Debug, Clone)]
pub(crate) struct Bracket {
    values: [f64; 2],
    width: f64,
    halvings: i32,
    steps: i32,
}

impl Bracket {
    /// Of the values at its ends, to be narrowed as much as so many halvings do.
    pub(crate) fn new(values: [f64; 2], halvings: i32) -> Self {
        Self { values, width: 1.0, halvings, steps: 0 }
    }

    /// Where to look next, as a share of the bracket at hand; nothing once it is narrow enough.
    pub(crate) fn next(&self) -> Option<f64> {
        let least = 0.5_f64.powi(self.halvings);
        if self.width <= least {
            return None;
        }
        let [low, high] = self.values;
        let zero = low / (low - high);
        let inner = 0.5 - zero;
        if low.is_nan() || high.is_nan() || !(0.0..=1.0).contains(&zero) {
            return Some(0.5);
        }
        let beyond = (BEYOND * self.width * self.width).max(0.25 * least) / self.width;
        let off = if beyond < inner.abs() { inner - beyond.copysign(inner) } else { 0.0 };
        // As far from the middle as leaves the steps that halving takes.
        let room = (0.5 * 0.5_f64.powi(self.steps - MORE) / self.width - 0.5).max(0.0);
        Some(0.5 - off.clamp(-room, room))
    }

    /// Takes the value at a share for the one at its lower or upper end.
    pub(crate) fn narrow(&mut self, share: f64, value: f64, lower: bool) {
        self.width *= if lower { 1.0 - share } else { share };
        self.values[usize::from(!lower)] = value;
        self.steps += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALVINGS: i32 = 26;

    /// Steps until a function's change of sign is located, and where.
    fn located(f: impl Fn(f64) -> f64) -> (usize, [f64; 2]) {
        let (mut ends, mut steps) = ([0.0, 1.0], 0);
        let below = f(0.0) > 0.0;
        let mut bracket = Bracket::new(ends.map(&f), HALVINGS);
        while let Some(share) = bracket.next() {
            let x = ends[0] + share * (ends[1] - ends[0]);
            let lower = (f(x) > 0.0) == below;
            ends[usize::from(!lower)] = x;
            bracket.narrow(share, f(x), lower);
            steps += 1;
        }
        (steps, ends)
    }

    #[test]
    fn smooth_changes_of_sign_take_a_few_steps() {
        let cases: [(&dyn Fn(f64) -> f64, f64); 4] = [
            (&|x| x - 0.3, 0.3),
            (&|x| 3.0 - (2.0 * x).exp(), 0.5 * 3.0_f64.ln()),
            (&|x| x.powi(3) - 0.2, 0.2_f64.cbrt()),
            (&|x| (50.0 * (x - 0.4)).tanh(), 0.4),
        ];
        for (f, zero) in cases {
            let (steps, [low, high]) = located(f);
            assert!(low <= zero && zero <= high && high - low <= 0.5_f64.powi(HALVINGS));
            assert!(steps <= 10, "{steps}");
        }
    }

    /// Jumps, corners and what is no number take as many steps as halving, and one.
    #[test]
    fn no_change_of_sign_takes_many_more_steps_than_halving() {
        let cases: [(&dyn Fn(f64) -> f64, f64); 3] = [
            (&|x| if x < 0.37 { -1.0 } else { 1.0 + x }, 0.37),
            (&|x| if x < 0.3 { x - 0.3 } else { 1e4 * (x - 0.3) }, 0.3),
            (&|x| if x < 0.9 { f64::NEG_INFINITY } else { 1.0 }, 0.9),
        ];
        for (f, zero) in cases {
            let (steps, [low, high]) = located(f);
            assert!(low <= zero && zero <= high && high - low <= 0.5_f64.powi(HALVINGS));
            assert!(steps <= 27, "{steps}");
        }
    }
}

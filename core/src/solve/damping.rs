//! Damped Newton steps, judged by the error that they leave (Deuflhard 2004, Newton Methods for
//! Nonlinear Problems, section 3.3).
//!
//! Where contacts change what they do the residual has kinks, and its norm weighs stiff and soft
//! directions so unevenly that it may fall along none but the shortest steps. The step that would
//! follow with the same Jacobian weighs them as the error does. How far it differs from Newton's
//! own next step says how long that one may be.

use super::{norm, System};

/// Below this length a direction leads nowhere.
const SHORTEST: f64 = 1e-4;
/// Share of the length at which the error would fall most: the path to the solution bends at every
/// kink, and shorter steps stay close to it.
const CAUTION: f64 = 0.5;
/// Decrease, relative to the length, that counts as one: full steps that leave nearly all of themselves
/// go to and fro.
const DECREASE: f64 = 0.25;
/// Steps in one solution that may leave more than was there: right at a kink the Jacobian of one
/// side leads nowhere on the other.
const STRIDES: usize = 4;

/// What a damped step has done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Damped {
    /// The full step was taken, and leaves this share of itself.
    Full(f64),
    /// A part of the step was taken.
    Part,
    /// No length will do.
    Stuck,
}

/// Steps from iterate to iterate, with what the last one has taught.
#[derive(Debug, Default)]
pub(super) struct Damping {
    /// Size and length of the last step.
    last: Option<[f64; 2]>,
    /// The step that would have followed with its Jacobian.
    following: Vec<f64>,
    strides: usize,
    x: Vec<f64>,
    residual: Vec<f64>,
}

impl Damping {
    pub(super) fn new(size: usize) -> Self {
        let zeros = || vec![0.0; size];
        Self { following: zeros(), x: zeros(), residual: zeros(), ..Self::default() }
    }

    /// Forgets the last step: the next one is tried at its full length.
    pub(super) fn forget(&mut self) {
        self.last = None;
    }

    /// Takes x along `−step` to where the step that would follow is smaller. The system holds the
    /// Jacobian of `step`, before and after.
    pub(super) fn advance(
        &mut self,
        system: &mut impl System,
        x: &mut [f64],
        step: &[f64],
    ) -> Damped {
        let size = norm(step);
        let mut length = self.first_length(step, size);
        let mut least = (f64::INFINITY, length);
        while length >= SHORTEST {
            for ((trial, x), s) in self.x.iter_mut().zip(&*x).zip(step) {
                *trial = x - length * s;
            }
            system.value(&self.x, &mut self.residual);
            if system.solve(&self.residual, &mut self.following) {
                let left = norm(&self.following);
                if left <= (1.0 - DECREASE * length) * size {
                    x.copy_from_slice(&self.x);
                    self.last = Some([size, length]);
                    return if length < 1.0 { Damped::Part } else { Damped::Full(left / size) };
                }
                if left < least.0 {
                    least = (left, length);
                }
            }
            length *= 0.5;
        }
        if self.strides == STRIDES || least.0.is_infinite() {
            return Damped::Stuck;
        }
        self.strides += 1;
        self.forget();
        x.iter_mut().zip(step).for_each(|(x, s)| *x -= least.1 * s);
        Damped::Part
    }

    /// Length from the curvature that the last two steps show.
    fn first_length(&self, step: &[f64], size: f64) -> f64 {
        let Some([before, length]) = self.last else { return 1.0 };
        let turned: Vec<f64> = self.following.iter().zip(step).map(|(a, b)| a - b).collect();
        let best = length * before * norm(&self.following) / (norm(&turned) * size);
        // Of two steps of the same direction and size nothing is learnt.
        if best.is_nan() {
            return 1.0;
        }
        (CAUTION * best).clamp(SHORTEST, 1.0)
    }
}

//! Newton's method. Full steps are taken as long as the residual falls, damped ones where it does
//! not; the last steps, which are small, share one Jacobian.

use super::damping::{Damped, Damping};
use super::line_search::falls;
use super::{norm, System};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSettings {
    /// Relative error of the unknowns at which a solution is accepted.
    pub tolerance: f64,
    /// Iterations before giving up.
    pub max_iterations: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self { tolerance: 1e-11, max_iterations: 100 }
    }
}

/// How a solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The estimated error is below the tolerance.
    Converged,
    /// No step along the Newton direction leaves a smaller one, or too many iterations.
    Stalled,
    /// The Jacobian is singular, or the residual is not a number.
    Singular,
    /// The caller ended the analysis.
    Interrupted,
}

/// Outcome and effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// How it ended.
    pub outcome: Outcome,
    /// Newton steps taken.
    pub iterations: usize,
    /// Norm of the last residual, relative to that of the unknowns.
    pub residual: f64,
}

/// A small step that leaves no more than this share of itself needs no damping any more.
const CONTRACTS: f64 = 0.1;

/// Behind a step this small the Jacobian has hardly changed, and serves for another step: one with
/// it leaves about this share of the error.
const SERVES_AGAIN: f64 = 1e-3;

/// Share of the tolerance that steps with a kept Jacobian have to reach: displacements beside very
/// stiff contacts are small differences, which an error of the unknowns reaches many times over.
const OF_KEPT: f64 = 1e-2;

/// Share of a step that a further one would not leave but by rounding.
const ROUNDED: f64 = 0.3;

/// Most further steps that are taken with one Jacobian.
const MOST_KEPT: f64 = 8.0;

/// Relative step at which rounding hides what a step leaves.
const CLOSE: f64 = 1e-9;

/// Solves `system = 0` from `x`, which holds the best point found on return.
pub fn newton(system: &mut impl System, x: &mut [f64], settings: NewtonSettings) -> Report {
    let mut newton = Newton::init(system, x, settings);
    for iteration in 1..=settings.max_iterations {
        let Some(checkpoint) = newton.step() else { continue };
        if let Some(outcome) = newton.terminate(checkpoint) {
            // A direction that the caller has ended is none.
            let failed = matches!(outcome, Outcome::Stalled | Outcome::Singular);
            let ended = failed && newton.system.interrupted();
            return newton.report(if ended { Outcome::Interrupted } else { outcome }, iteration);
        }
    }
    newton.report(Outcome::Stalled, settings.max_iterations)
}

/// Where an iteration stands that does not simply go on with the next step.
enum Checkpoint {
    /// The caller asks to end.
    Interrupted,
    /// There is no Newton direction.
    NoDirection,
    /// No part of the step leaves a smaller one.
    NoLength,
    /// The full step does not lower the residual.
    Rejected,
    /// The full step was taken, and leaves about this error; the residual fell by this factor.
    Accepted { left: f64, contraction: f64 },
}

/// Newton's method on its way.
struct Newton<'a, S> {
    system: &'a mut S,
    x: &'a mut [f64],
    tolerance: f64,
    residual: Vec<f64>,
    size_of_residual: f64,
    step: Vec<f64>,
    relative_step: f64,
    /// The point that a full step leads to, and its residual.
    trial: [Vec<f64>; 2],
    damping: Damping,
    /// Whether a full step has failed, so that steps are damped.
    damped: bool,
    /// Whether the Jacobian is that at x.
    fresh: bool,
    /// Whether the tolerance is met, and only rounding may be in the way of more.
    within: bool,
}

impl<'a, S: System> Newton<'a, S> {
    fn init(system: &'a mut S, x: &'a mut [f64], settings: NewtonSettings) -> Self {
        let size = system.size();
        let zeros = || vec![0.0; size];
        let mut newton = Self {
            system,
            x,
            tolerance: settings.tolerance,
            residual: zeros(),
            size_of_residual: f64::NAN,
            step: zeros(),
            relative_step: f64::INFINITY,
            trial: [zeros(), zeros()],
            damping: Damping::new(size),
            damped: false,
            fresh: true,
            within: false,
        };
        newton.linearise();
        newton
    }

    /// Residual and Jacobian at x.
    fn linearise(&mut self) {
        self.system.residual(self.x, &mut self.residual);
        self.size_of_residual = norm(&self.residual);
        self.fresh = true;
    }

    /// Whether the step is so small that its Jacobian serves again.
    fn serves_again(&self) -> bool {
        self.relative_step <= SERVES_AGAIN
    }

    /// Takes the Newton step, or a part of it; nothing is to be decided behind a damped one.
    fn step(&mut self) -> Option<Checkpoint> {
        if self.system.interrupted() {
            return Some(Checkpoint::Interrupted);
        }
        if self.system.is_spent() {
            return Some(Checkpoint::NoLength);
        }
        let solvable = self.size_of_residual.is_finite()
            && self.system.solve(&self.residual, &mut self.step)
            && norm(&self.step).is_finite();
        if !solvable {
            return Some(Checkpoint::NoDirection);
        }
        self.relative_step = self.system.relative_size(&self.step, self.x);
        if self.damped && self.relative_step > CLOSE {
            return self.damped_step();
        }
        Some(self.full_step())
    }

    fn damped_step(&mut self) -> Option<Checkpoint> {
        let taken = self.damping.advance(self.system, self.x, &self.step);
        self.linearise();
        match taken {
            Damped::Full(left) => self.damped = !self.serves_again() || left > CONTRACTS,
            Damped::Part => {}
            Damped::Stuck => return Some(Checkpoint::NoLength),
        }
        None
    }

    fn full_step(&mut self) -> Checkpoint {
        let serves_again = self.serves_again();
        let [x, residual] = &mut self.trial;
        for ((trial, x), s) in x.iter_mut().zip(&*self.x).zip(&self.step) {
            *trial = x - s;
        }
        if serves_again {
            self.system.value(x, residual);
        } else {
            self.system.residual(x, residual);
        }
        let size = norm(residual);
        // At rounding level the residual need not fall any more.
        if self.relative_step > CLOSE && !falls(size, self.size_of_residual, 1.0) {
            return Checkpoint::Rejected;
        }
        // Where Newton's method converges, the error shrinks as the residual does: the error left
        // is the step times the contraction just seen.
        let contraction = size / self.size_of_residual.max(f64::MIN_POSITIVE);
        self.x.copy_from_slice(x);
        std::mem::swap(&mut self.residual, residual);
        self.size_of_residual = size;
        Checkpoint::Accepted { left: self.relative_step * contraction.min(1.0), contraction }
    }

    /// Ends the iteration, or chooses the Jacobian and the kind of the next step.
    fn terminate(&mut self, checkpoint: Checkpoint) -> Option<Outcome> {
        match checkpoint {
            Checkpoint::Interrupted => Some(Outcome::Interrupted),
            Checkpoint::NoDirection => Some(Outcome::Singular),
            Checkpoint::NoLength => Some(Outcome::Stalled),
            Checkpoint::Rejected => {
                // The Jacobian at x again, for damped steps if it was not to blame.
                let blameless = self.fresh;
                self.linearise();
                if blameless && self.within {
                    return Some(Outcome::Converged);
                }
                if blameless {
                    self.damping.forget();
                    self.damped = true;
                }
                None
            }
            Checkpoint::Accepted { left, contraction } => self.judge(left, contraction),
        }
    }

    /// Whether the error left by a full step is small enough.
    fn judge(&mut self, left: f64, contraction: f64) -> Option<Outcome> {
        let kept = self.serves_again();
        // Rounding hides the contraction of the last steps; behind one with a Jacobian of its own
        // the error is that of rounding.
        if self.relative_step <= CLOSE && self.fresh {
            return Some(Outcome::Converged);
        }
        let before = std::mem::replace(&mut self.within, left <= self.tolerance);
        // Within the tolerance a step that leaves as much as it takes is rounding.
        if before && kept && !self.within && contraction > ROUNDED {
            return Some(Outcome::Converged);
        }
        // One more with the same Jacobian would contract as this one.
        let enough = OF_KEPT * self.tolerance;
        if kept && self.system.is_seen_again() && left * contraction <= enough {
            let known = self.system.solve(&self.residual, &mut self.step);
            let step = self.system.relative_size(&self.step, self.x);
            if known && step <= CLOSE && step * contraction <= enough {
                self.x.iter_mut().zip(&self.step).for_each(|(x, step)| *x -= step);
                return Some(Outcome::Converged);
            }
        }
        if self.within {
            // Newton's own last step would leave hardly more than rounding. One with a Jacobian
            // kept leaves what the step that would follow tells, at the price of a substitution;
            // it is taken once.
            let known = kept && !before && self.system.solve(&self.residual, &mut self.step);
            if !kept || before || (known && self.system.relative_size(&self.step, self.x) <= enough)
            {
                return Some(Outcome::Converged);
            }
        }
        self.fresh = !kept;
        // As many more steps with the same Jacobian as a new one costs are worth it.
        let steps = self.system.price().clamp(2.0, MOST_KEPT);
        if kept && left * contraction.powf(steps) > self.tolerance {
            self.linearise();
        }
        None
    }

    fn report(&self, outcome: Outcome, iterations: usize) -> Report {
        let residual = self.size_of_residual / norm(self.x).max(f64::MIN_POSITIVE);
        Report { outcome, iterations, residual }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x² = 2, with work for so many evaluations.
    struct Granted {
        left: usize,
        slope: f64,
    }

    impl System for Granted {
        fn size(&self) -> usize {
            1
        }

        fn residual(&mut self, x: &[f64], out: &mut [f64]) {
            self.slope = 2.0 * x[0];
            self.value(x, out);
        }

        fn value(&mut self, x: &[f64], out: &mut [f64]) {
            self.left = self.left.saturating_sub(1);
            out[0] = x[0] * x[0] - 2.0;
        }

        fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
            step[0] = rhs[0] / self.slope;
            true
        }

        fn is_spent(&self) -> bool {
            self.left == 0
        }
    }

    #[test]
    fn an_iteration_ends_when_its_work_is_spent() {
        for (left, outcome) in [(100, Outcome::Converged), (3, Outcome::Stalled)] {
            let mut system = Granted { left, slope: f64::NAN };
            let report = newton(&mut system, &mut [30.0], NewtonSettings::default());
            assert_eq!(report.outcome, outcome);
            assert!(report.iterations <= left);
        }
    }
}

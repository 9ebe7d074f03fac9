//! Newton's and Broyden's method on equations with known roots, or none.
#![allow(clippy::unwrap_used, clippy::panic)]

use stickslip_core::solve::{broyden, newton, FirstJacobian, NewtonSettings, Outcome, System};

struct Arctangent(f64);

impl System for Arctangent {
    fn size(&self) -> usize {
        1
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.0 = 1.0 / (1.0 + x[0] * x[0]);
        self.value(x, out);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        out[0] = x[0].atan() - 0.5;
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        step[0] = rhs[0] / self.0;
        true
    }
}

#[test]
fn damping_saves_a_start_from_which_full_steps_diverge() {
    let mut x = [8.0];
    let report = newton(&mut Arctangent(0.0), &mut x, NewtonSettings::default());
    assert_eq!(report.outcome, Outcome::Converged);
    assert!((x[0] - 0.5_f64.tan()).abs() < 1e-12);
}

/// A narrow valley along a parabola: the first equation weighs a million times the second.
struct Valley(f64);

impl System for Valley {
    fn size(&self) -> usize {
        2
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.0 = x[0];
        self.value(x, out);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        out[0] = 1e6 * (x[1] - x[0] * x[0]);
        out[1] = x[0] - 1.0;
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        step[0] = rhs[1];
        step[1] = 1e-6 * rhs[0] + 2.0 * self.0 * rhs[1];
        true
    }
}

/// Along steps that lower the residual the way takes three million iterations.
#[test]
fn steps_are_judged_by_the_error_and_not_by_the_residual() {
    let mut x = [-5.0, 25.0];
    let report = newton(&mut Valley(0.0), &mut x, NewtonSettings::default());
    assert_eq!(report.outcome, Outcome::Converged);
    assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12, "{x:?}");
    assert!(report.iterations <= 5, "{}", report.iterations);
}

struct Rootless;

impl System for Rootless {
    fn size(&self) -> usize {
        1
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.value(x, out);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        out[0] = 1.0 + x[0] * x[0];
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        step[0] = rhs[0];
        true
    }
}

#[test]
fn a_system_without_root_is_reported_by_newtons_method() {
    let report = newton(&mut Rootless, &mut [0.3], NewtonSettings::default());
    assert_ne!(report.outcome, Outcome::Converged);
}

/// Two coupled equations with the roots (±1, ±1) of equal sign.
struct Pair;

impl System for Pair {
    fn size(&self) -> usize {
        2
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.value(x, out);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        out[0] = x[0] * x[0] + x[1] * x[1] - 2.0;
        out[1] = x[0] - x[1].powi(3);
    }

    fn solve(&mut self, _: &[f64], _: &mut [f64]) -> bool {
        false
    }
}

#[test]
fn a_pair_of_equations_is_solved_from_one_jacobian() {
    let mut x = [1.4, 1.2];
    let settings = NewtonSettings::default();
    let (report, effort) = broyden(&mut Pair, &mut x, settings, FirstJacobian::Differences);
    assert_eq!(report.outcome, Outcome::Converged);
    assert_eq!(effort.jacobians, 1);
    assert_eq!(effort.updates, report.iterations - 1);
    assert!((x[0] - 1.0).abs() < 1e-10 && (x[1] - 1.0).abs() < 1e-10, "{x:?}");
}

#[test]
fn a_far_start_is_damped_and_restarted() {
    let mut x = [8.0, 3.0];
    let settings = NewtonSettings::default();
    let (report, effort) = broyden(&mut Pair, &mut x, settings, FirstJacobian::Exact);
    assert_eq!(report.outcome, Outcome::Converged);
    assert!(effort.jacobians > 1);
    assert!((x[0].abs() - 1.0).abs() < 1e-9, "{x:?}");
}

#[test]
fn a_system_without_root_is_reported_by_broydens_method() {
    let settings = NewtonSettings::default();
    let (report, _) = broyden(&mut Rootless, &mut [0.3], settings, FirstJacobian::Exact);
    assert_ne!(report.outcome, Outcome::Converged);
}

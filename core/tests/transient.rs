//! Time integration: both schemes against each other, start states, settling, growth.

#![allow(clippy::unwrap_used)]

mod common;

use common::passive::passive_system;
use common::{beam_pair, chain, snecma_beam, System};
use faer::{mat, Mat};
use proptest::prelude::*;
use stickslip_core::motion::{transient, Halt, History, Scheme, TransientSettings};
use stickslip_core::orbit::{OrbitSettings, PeriodicOrbits};

fn settings(omega: f64, scheme: Scheme, periods: usize) -> TransientSettings {
    TransientSettings { omega, scheme, periods, tolerance: None, samples: 64, keep: None }
}

fn run(system: &System, settings: &TransientSettings, start: Option<&[f64]>) -> History {
    let observe: Vec<usize> = (0..system.dofs()).collect();
    transient(&system.model(), settings, start, &observe, &|_| true).unwrap()
}

/// Largest difference of two traces, relative to the largest value.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let size = a.iter().map(|v| v.abs()).fold(0.0, f64::max);
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

#[test]
fn runge_kutta_approaches_the_exact_flow_from_rest() {
    for system in [snecma_beam(25.0), beam_pair(40.0)] {
        let exact = run(&system, &settings(190.0, Scheme::Exact, 10), None);
        let mut errors = Vec::new();
        for steps in [1000, 4000] {
            let other = run(&system, &settings(190.0, Scheme::RungeKutta(steps), 10), None);
            assert_eq!(exact.trace.time.len(), 641);
            errors.push(difference(&exact.trace.displacement, &other.trace.displacement));
            assert!(difference(&exact.trace.velocity, &other.trace.velocity) < 1e-2);
            assert!(difference(&exact.trace.force, &other.trace.force) < 1e-2);
        }
        // Kinks of the force cost all but two orders.
        assert!(errors[1] < 1e-5 && errors[1] < errors[0] / 8.0, "{errors:?}");
    }
}

/// Without slip the error falls with the fourth power of the step, whatever number of modes there is and
/// however they damp each other.
#[test]
fn runge_kutta_is_of_fourth_order_while_contacts_stick() {
    for dofs in [1, 3, 4, 6, 9] {
        let mass = Mat::from_fn(dofs, dofs, |i, j| f64::from(u8::from(i == j)));
        let stiffness = chain::stiffness(&vec![100.0; dofs]);
        let mut damping = faer::Scale(0.2) * &mass;
        damping[(0, 0)] = 2.0;
        let dampers = vec![(0, None, 50.0, f64::INFINITY), (dofs - 1, None, 20.0, f64::INFINITY)];
        let forces = vec![(dofs - 1, 1, 1.0, 0.3)];
        let system = System { mass, damping, stiffness, dampers, forces };
        let exact = run(&system, &settings(7.0, Scheme::Exact, 3), None);
        let errors = [128, 256].map(|steps| {
            let other = run(&system, &settings(7.0, Scheme::RungeKutta(steps), 3), None);
            difference(&exact.trace.displacement, &other.trace.displacement)
                .max(difference(&exact.trace.force, &other.trace.force))
        });
        let order = (errors[0] / errors[1]).log2();
        assert!(errors[1] < 1e-5 && (3.5..4.5).contains(&order), "{dofs}: {errors:?}, {order}");
    }
}

#[test]
fn a_motion_continues_from_its_last_state() {
    let system = snecma_beam(25.0);
    let whole = run(&system, &settings(200.0, Scheme::Exact, 7), None);
    let first = run(&system, &settings(200.0, Scheme::Exact, 3), None);
    let rest =
        run(&system, &settings(200.0, Scheme::Exact, 4), first.poincare.last().map(|s| &s[..]));
    assert!(difference(whole.poincare.last().unwrap(), rest.poincare.last().unwrap()) < 1e-12);
}

#[test]
fn a_start_on_the_orbit_stays_there() {
    let system = snecma_beam(31.475);
    let model = system.model();
    let observe = [0, 1];
    let mut orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
    let orbit = orbits.solve(168.0, None).unwrap();
    let history = run(&system, &settings(168.0, Scheme::Exact, 5), Some(&orbit.state));
    assert!(history.change.iter().all(|change| *change < 1e-11), "{:?}", history.change);
    for (dof, range) in orbit.range.iter().enumerate() {
        let last = history.range[4 * 3 + dof];
        assert!((last[1] / range[1] - 1.0).abs() < 1e-10);
    }
    assert_eq!(history.events.len(), 5 * orbit.events.len());
}

#[test]
fn settling_ends_the_run_and_keeps_the_last_periods() {
    let system = snecma_beam(20.313);
    let wanted = TransientSettings {
        tolerance: Some(1e-8),
        keep: Some(2),
        ..settings(200.0, Scheme::Exact, 1000)
    };
    let history = run(&system, &wanted, None);
    assert!(history.settled && history.change.len() < 1000);
    assert!(history.change.last().unwrap() <= &1e-8);
    assert_eq!(history.trace.time.len(), 2 * 64 + 1);
    let period = std::f64::consts::TAU / 200.0;
    let periods = history.change.len() as f64;
    assert!((history.trace.time.last().unwrap() - periods * period).abs() < 1e-9);
    assert!(history.events.iter().all(|event| event.time >= (periods - 2.0) * period));
    assert_eq!(history.poincare.len(), history.change.len() + 1);
}

#[test]
fn negative_damping_beyond_the_damper_grows_without_bound() {
    let system = System {
        mass: mat![[1.0]],
        damping: mat![[-1.0]],
        stiffness: mat![[100.0]],
        dampers: vec![(0, None, 100.0, 0.1)],
        forces: vec![(0, 1, 1.0, 0.0)],
    };
    for scheme in [Scheme::Exact, Scheme::RungeKutta(200)] {
        let history = run(&system, &settings(10.0, scheme, 100_000), None);
        assert_eq!(history.halt, Some(Halt::Unbounded));
        assert!(history.trace.displacement.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn a_run_that_is_ended_keeps_whole_periods() {
    let system = snecma_beam(20.0);
    let calls = std::cell::Cell::new(0);
    let patience = |_: f64| {
        calls.set(calls.get() + 1);
        calls.get() < 8
    };
    let settings = settings(200.0, Scheme::RungeKutta(10_000), 100);
    let history = transient(&system.model(), &settings, None, &[0], &patience).unwrap();
    assert!(history.interrupted);
    let periods = history.change.len();
    assert!(periods > 0 && periods < 100);
    assert_eq!(history.trace.time.len(), 64 * periods + 1);
    assert_eq!(history.range.len(), periods);
    assert_eq!(history.poincare.len(), periods + 1);
}

#[test]
fn bad_settings_and_states_are_refused() {
    let system = snecma_beam(20.0);
    let model = system.model();
    let refuse = |settings: &TransientSettings, start: Option<&[f64]>| {
        transient(&model, settings, start, &[0], &|_| true).unwrap_err().to_string()
    };
    let good = settings(100.0, Scheme::Exact, 1);
    assert!(refuse(&settings(-1.0, Scheme::Exact, 1), None).contains("omega"));
    assert!(refuse(&settings(1.0, Scheme::Exact, 0), None).contains("periods"));
    assert!(refuse(&settings(1.0, Scheme::RungeKutta(0), 1), None).contains("steps"));
    assert!(refuse(&good, Some(&[0.0; 3])).contains("7 values"));
    assert!(refuse(&good, Some(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 300.0])).contains("slip limit"));
    assert!(refuse(&good, Some(&[f64::NAN; 7])).contains("finite"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn schemes_agree_on_random_systems(system in passive_system(), omega in 2.0_f64..20.0) {
        let exact = run(&system, &settings(omega, Scheme::Exact, 3), None);
        let other = run(&system, &settings(omega, Scheme::RungeKutta(4000), 3), None);
        let error = difference(&exact.trace.displacement, &other.trace.displacement);
        prop_assert!(error < 1e-4, "{}", error);
        let limits: Vec<f64> = system.dampers.iter().map(|d| d.3).collect();
        for forces in exact.trace.force.chunks_exact(limits.len()) {
            prop_assert!(forces.iter().zip(&limits).all(|(f, limit)| f.abs() <= *limit));
        }
    }
}

//! A motion from a start state, period after period.

use super::flow::Flow;
use super::history::{History, Scheme, TransientSettings};
use super::modal_system::ModalSystem;
use super::output::Output;
use super::pace::FASTEST_EXACT;
use super::runge_kutta::RungeKutta;
use super::state::State;
use super::transition::Transition;
use crate::model::Model;
use crate::progress::Progress;
use crate::solve::norm;
use crate::Error;
use std::cell::Cell;
use std::f64::consts::TAU;
use std::time::Instant;

/// Highest rate of a motion over the frequency of its period that steps of their own choice follow: faster
/// is what hardly has a mass.
const FASTEST: f64 = 1e6;
/// The same of the exact flow, over the number of periods, if that is more: it takes about so many steps in all, …
const STEPS: f64 = 5e5;
/// … and within a period at most so many.
pub(super) const PER_PERIOD: usize = 1 << 20;

/// Follows a motion from `start`, or from rest, over periods of the excitation.
///
/// # Errors
/// Settings outside their range, a DOF that does not exist, a start state that does not fit.
pub fn transient(
    model: &Model,
    settings: &TransientSettings,
    start: Option<&[f64]>,
    observe: &[usize],
    progress: &Progress<'_>,
) -> Result<History, Error> {
    let began = Instant::now();
    settings.check()?;
    let system = match settings.scheme {
        Scheme::Exact => ModalSystem::new(model)?,
        Scheme::RungeKutta(_) => ModalSystem::marched(model)?,
    };
    let fastest = match settings.scheme {
        Scheme::Exact => (STEPS / settings.periods as f64).max(FASTEST_EXACT),
        Scheme::RungeKutta(_) => FASTEST,
    };
    system.check_pace(model, settings.omega, fastest)?;
    Error::check_dofs(observe, system.modes())?;
    let mut state = match start {
        Some(values) => State::from_dofs(&system, values)?,
        None => State::rest(&system),
    };
    let output = Output::new(&system, settings, observe);
    let share = Cell::new(0.0);
    let go_on = || progress(share.get());
    let ended = || !go_on();
    let mut integrator = match settings.scheme {
        Scheme::Exact => Integrator::Exact(Flow::new(&system, settings.omega).watched(&ended)),
        Scheme::RungeKutta(steps) => {
            let scheme = RungeKutta::new(&system, settings.omega, steps, &state);
            scheme.end().write(&mut state);
            Integrator::RungeKutta(scheme)
        }
    };
    let coordinates = Transition::new(&system, settings.omega);
    let mut history = History::default();
    history.poincare.push(state.to_dofs(&system));
    output.push(0.0, &state.displacement, &state.velocity, &state.force, &mut history.trace);
    let mut before = coordinates.coordinates(&state);
    for number in 0..settings.periods {
        share.set(number as f64 / settings.periods as f64);
        if !go_on() {
            history.interrupted = true;
            break;
        }
        let begin = number as f64 * TAU / settings.omega;
        state.time = 0.0;
        let passed = match &mut integrator {
            Integrator::Exact(flow) => {
                flow.grant(flow.steps + PER_PERIOD);
                output.follow(flow, &mut state, begin, &mut history)
            }
            Integrator::RungeKutta(scheme) => {
                let passed = output.step_through(scheme, begin, &mut history, &go_on);
                scheme.end().write(&mut state);
                passed
            }
        };
        match passed {
            Ok(true) => {}
            Ok(false) => {
                history.interrupted = true;
                break;
            }
            Err(halt) => {
                history.halt = Some(halt);
                break;
            }
        }
        let after = coordinates.coordinates(&state);
        let size = norm(&before).max(norm(&after));
        let difference: Vec<f64> = before.iter().zip(&after).map(|(a, b)| b - a).collect();
        let change = if size > 0.0 { norm(&difference) / size } else { 0.0 };
        history.change.push(change);
        history.poincare.push(state.to_dofs(&system));
        before = after;
        history.settled = settings.tolerance.is_some_and(|tolerance| change <= tolerance);
        if history.settled {
            break;
        }
        output.forget(&mut history, 2);
    }
    output.forget(&mut history, 1);
    (history.steps, history.events_met) = match &integrator {
        Integrator::Exact(flow) => (flow.steps, flow.events),
        Integrator::RungeKutta(scheme) => (scheme.taken, 0),
    };
    history.total = began.elapsed();
    Ok(history)
}

enum Integrator<'a> {
    Exact(Flow<'a>),
    RungeKutta(RungeKutta<'a>),
}

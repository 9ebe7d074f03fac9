//! What an exact orbit costs, in floating-point operations, before it is sought.
//!
//! The price follows from the model, the frequency and the number of events that a balance expects,
//! not from the clock: the same point is solved in the same way everywhere.

use crate::motion::ModalSystem;
use std::f64::consts::TAU;

/// Length of a usual step of the flow, in units of the fastest rate.
const REACH: f64 = 9.0;
/// Powers of a step, and operations per power beside the products of modes and contacts.
const POWERS: f64 = 33.0;
const PER_MODE: f64 = 10.0;
/// Passes along the orbit until shooting has converged.
const PASSES: f64 = 10.0;
/// Products of matrices per transition between two events, beside the squarings.
const PRODUCTS: f64 = 8.0;
/// Operations of products of matrices in the time of one of the flow.
const SPEED: f64 = 4.0;
/// Operations of eigenvalues over the third power of the size.
const EIGENVALUES: f64 = 25.0;
/// Operations in the time that series of a plane, or of a contact that slips little by little, take besides.
const PER_PLANE: f64 = 1e4;
const PER_LOOP: f64 = 6e4;
/// Nodes of a quadrature per step, and operations per node and harmonic.
const NODES: f64 = 20.0;
const PER_HARMONIC: f64 = 2.0;

/// Operations of a cold orbit at `omega` [rad/s] with `events` changes of contact states per period, whose
/// harmonics are reported up to `highest`.
pub(super) fn orbit_price(
    system: &ModalSystem,
    half_wave: bool,
    omega: f64,
    events: usize,
    highest: usize,
) -> f64 {
    let share = if half_wave { 0.5 } else { 1.0 };
    let turn = share * TAU * system.rate(omega) / omega;
    let events = share * events as f64;
    let steps = turn / REACH + events;
    let size = (2 * system.modes() + system.strains()) as f64;
    let cube = size.powi(3);
    let squarings = (turn / (events + 1.0)).log2().max(0.0);
    let transition = (events + 1.0) * 2.0 * cube * (PRODUCTS + squarings);
    let nodes = NODES * steps + share * TAU * highest as f64;
    let rows = (system.modes() + system.points()) as f64;
    let survey = nodes * rows * PER_HARMONIC * share * highest as f64;
    let pass = steps * step_price(system) + transition + cube;
    PASSES * pass + EIGENVALUES * cube + survey
}

/// Time of an operation \[ns\].
pub(super) const PER_OPERATION: f64 = 0.75;

/// Steps of the flow that `operations` pay for.
pub(super) fn steps_for(system: &ModalSystem, operations: f64) -> usize {
    (operations / operations_of_step(system)) as usize
}

/// Work that so many steps of the flow are \[ns\].
pub(super) fn work_of_steps(system: &ModalSystem, steps: usize) -> f64 {
    PER_OPERATION * operations_of_step(system) * steps as f64
}

/// Steps of the flow that an orbit may take …
const STEPS_OF_LOOPS: usize = 1 << 14;
/// … or the work, if that is more, where a contact slips little by little: some seconds \[ns\].
const WORK_OF_LOOPS: f64 = 6e9;

/// Steps of the flow that an orbit may take for what its loops cost.
pub(super) fn affordable_steps(system: &ModalSystem) -> usize {
    if system.microslips().is_empty() {
        return usize::MAX;
    }
    steps_for(system, WORK_OF_LOOPS / PER_OPERATION).max(STEPS_OF_LOOPS)
}

/// Operations in the time of a step. What follows a loop or the slip in a plane takes many times as long as its
/// products tell.
fn operations_of_step(system: &ModalSystem) -> f64 {
    let slow =
        PER_PLANE * system.planes().len() as f64 + PER_LOOP * system.microslips().len() as f64;
    step_price(system) + slow
}

/// What a transition matrix over so many stretches costs, in passes along an orbit of so many steps.
pub(super) fn matrix_price(
    system: &ModalSystem,
    size: usize,
    stretches: usize,
    steps: usize,
) -> f64 {
    let products = stretches as f64 * 2.0 * (size as f64).powi(3) * PRODUCTS / SPEED;
    products / (steps as f64 * step_price(system)).max(1.0)
}

/// Operations of a step of the flow.
fn step_price(system: &ModalSystem) -> f64 {
    let (modes, points) = (system.modes() as f64, system.points() as f64);
    let damping = if system.is_diagonally_damped() { PER_MODE } else { PER_MODE + 2.0 * modes };
    // Modes give displacements and take forces; every point looks for its next event among all.
    let elements = 4.0 * modes * points + damping * modes + 4.0 * points * points;
    // Slip in a plane is nine products of series.
    POWERS * (elements + 9.0 * POWERS * system.planes().len() as f64)
}

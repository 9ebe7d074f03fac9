//! The mean forces of contacts that never slip, which an orbit leaves open.
//!
//! Constant forces move the structure statically and change nothing else: a slipping contact
//! answers to changes of its displacement alone. So the assumed residual is reached by one linear
//! solution after the orbit has closed.

use crate::contact::Residual;
use crate::motion::{ModalSystem, State};
use faer::linalg::solvers::Solve as _;
use faer::Mat;

/// Static stiffness relative to the largest below which rigid-body motion cannot carry a force.
const RIGID_BODY: f64 = 1e-13;

/// Shifts a state so that the points `neutral` hold the assumed force at mid-range; `middle` and
/// `half_range` are those of all contact displacements over the orbit. `None` if nothing has to
/// change or the structure floats.
pub(super) fn shifted(
    system: &ModalSystem,
    residual: Residual,
    neutral: &[usize],
    middle: &[f64],
    half_range: &[f64],
    state: &State,
) -> Option<State> {
    let stiffness = system.omega_squared();
    let largest = stiffness.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if neutral.is_empty() || stiffness.iter().any(|w| w.abs() <= RIGID_BODY * largest) {
        return None;
    }
    let spring = |i: usize| system.contact_stiffness()[i];
    let u = system.contact_displacement(&state.displacement);
    // Static displacement of one contact per force on another.
    let flexibility = |i: usize, j: usize| -> f64 {
        let (row, column) = (system.contact_shape(i), system.contact_shape(j));
        row.iter().zip(column).zip(stiffness).map(|((a, b), w)| a * b / w).sum()
    };
    let at_middle: Vec<f64> =
        neutral.iter().map(|&i| state.force[i] + spring(i) * (middle[i] - u[i])).collect();
    let room: Vec<f64> = neutral
        .iter()
        .map(|&i| (system.limits()[i] - spring(i) * half_range[i]).max(0.0))
        .collect();
    // Which points are held back by their limit is found by repetition; it is rare.
    let mut held = vec![0.0; neutral.len()];
    let mut added = vec![0.0; neutral.len()];
    for _ in 0..=neutral.len() {
        let size = neutral.len();
        let mut matrix = Mat::<f64>::identity(size, size);
        let mut right = Mat::zeros(size, 1);
        for (row, &i) in neutral.iter().enumerate() {
            if held[row] != 0.0 {
                right[(row, 0)] = held[row] * room[row] - at_middle[row];
                continue;
            }
            match residual {
                Residual::Centred => right[(row, 0)] = -at_middle[row],
                Residual::Value(force) => right[(row, 0)] = force - at_middle[row],
                Residual::FromRest => {
                    right[(row, 0)] = spring(i) * middle[i] - at_middle[row];
                    for (column, &j) in neutral.iter().enumerate() {
                        matrix[(row, column)] += spring(i) * flexibility(i, j);
                    }
                }
            }
        }
        matrix.partial_piv_lu().solve_in_place(&mut right);
        added = (0..size).map(|row| right[(row, 0)]).collect();
        let mut settled = true;
        for row in 0..size {
            let force = at_middle[row] + added[row];
            if held[row] == 0.0 && force.abs() > room[row] * (1.0 + 1e-12) {
                held[row] = force.signum();
                settled = false;
            }
        }
        if settled {
            break;
        }
    }
    let mut shifted = state.clone();
    for (&i, force) in neutral.iter().zip(&added) {
        shifted.force[i] += force;
        for ((x, b), w) in
            shifted.displacement.iter_mut().zip(system.contact_shape(i)).zip(stiffness)
        {
            *x -= b * force / w;
        }
    }
    Some(shifted)
}

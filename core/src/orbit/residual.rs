//! The mean forces of contacts that never slip, which an orbit leaves open.
//!
//! Constant forces move the structure statically and change nothing else: a slipping contact
//! answers to changes of its displacement alone. So the assumed residual is reached by one linear
//! solution after the orbit has closed. Laws of several points keep the slip that they have: their
//! motion starts without any.

use crate::contact::Residual;
use crate::motion::{ModalSystem, State};
use faer::linalg::solvers::Solve as _;
use faer::Mat;

/// A constant force that an orbit leaves open: of a spring, or of a strain of a coupled law.
struct Open {
    /// Points that it acts on, each with its share.
    forces: Vec<(usize, f64)>,
    /// Displacement that works against it, per modal coordinate.
    shape: Vec<f64>,
    spring: f64,
    /// Force at mid-range and room within the limit; `None` if the slip is to stay.
    at_middle: Option<(f64, f64)>,
    /// Elastic force at mid-range of the displacement.
    elastic: f64,
}

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
    if !system.rigid_modes().is_empty() {
        // Rigid-body motion cannot carry a force.
        return None;
    }
    if system.has_normals() {
        // A constant force changes slip limits, or opens contacts: sliders stay where they are.
        return None;
    }
    let open = open_forces(system, neutral, middle, half_range, state);
    if open.iter().all(|one| one.at_middle.is_none()) {
        return None;
    }
    // Static displacement against one force per another.
    let flexibility = |i: usize, j: usize| -> f64 {
        let pairs = open[i].shape.iter().zip(&open[j].shape);
        pairs.zip(stiffness).map(|((a, b), w)| a * b / w).sum()
    };
    // Which points are held back by their limit is found by repetition; it is rare.
    let size = open.len();
    let mut held = vec![0.0; size];
    let mut added = vec![0.0; size];
    for _ in 0..=size {
        let mut matrix = Mat::<f64>::identity(size, size);
        let mut right = Mat::zeros(size, 1);
        for (row, one) in open.iter().enumerate() {
            let follows = match (one.at_middle, residual) {
                (Some((force, room)), _) if held[row] != 0.0 => {
                    right[(row, 0)] = held[row] * room - force;
                    false
                }
                (Some((force, _)), Residual::Centred) => {
                    right[(row, 0)] = -force;
                    false
                }
                (Some((force, _)), Residual::Value(value)) => {
                    right[(row, 0)] = value - force;
                    false
                }
                (Some((force, _)), Residual::FromRest) => {
                    right[(row, 0)] = one.elastic - force;
                    true
                }
                (None, _) => true,
            };
            for column in 0..if follows { size } else { 0 } {
                matrix[(row, column)] += one.spring * flexibility(row, column);
            }
        }
        matrix.partial_piv_lu().solve_in_place(&mut right);
        added = (0..size).map(|row| right[(row, 0)]).collect();
        let mut settled = true;
        for (row, one) in open.iter().enumerate() {
            let Some((force, room)) = one.at_middle else { continue };
            let force = force + added[row];
            if held[row] == 0.0 && force.abs() > room * (1.0 + 1e-12) {
                held[row] = force.signum();
                settled = false;
            }
        }
        if settled {
            break;
        }
    }
    let mut shifted = state.clone();
    for (one, force) in open.iter().zip(&added) {
        for &(point, share) in &one.forces {
            shifted.force[point] += share * force;
        }
        for ((x, b), w) in shifted.displacement.iter_mut().zip(&one.shape).zip(stiffness) {
            *x -= b * force / w;
        }
    }
    // Contacts without sliders slip about the middle of their motion, wherever that is.
    let moved: Vec<f64> =
        shifted.displacement.iter().zip(&state.displacement).map(|(to, from)| to - from).collect();
    for (own, reversals) in system.microslips().iter().zip(&mut shifted.reversals) {
        let shape = system.contact_shape(own.point).iter();
        let by = shape.zip(&moved).map(|(b, x)| b * x).sum();
        reversals.shift(by, residual.follows_middle());
    }
    Some(shifted)
}

/// The constant forces that are open, contact after contact.
fn open_forces(
    system: &ModalSystem,
    neutral: &[usize],
    middle: &[f64],
    half_range: &[f64],
    state: &State,
) -> Vec<Open> {
    let u = system.contact_displacement(&state.displacement);
    let mut open = Vec::new();
    for body in system.bodies() {
        if let [point] = body.remembered[..] {
            if body.elastic.rank() == 0 || !neutral.contains(&point) {
                continue;
            }
            let spring = body.elastic.root()[(point - body.points.start, 0)].powi(2);
            let force = state.force[point] + spring * (middle[point] - u[point]);
            let room = (system.limits()[point] - spring * half_range[point]).max(0.0);
            open.push(Open {
                forces: vec![(point, 1.0)],
                shape: system.contact_shape(point).to_vec(),
                spring,
                at_middle: Some((force, room)),
                elastic: spring * middle[point],
            });
            continue;
        }
        let held: Vec<bool> = body.points.clone().map(|i| !neutral.contains(&i)).collect();
        for strains in body.elastic.unmoved(&held) {
            let forces: Vec<(usize, f64)> =
                body.points.clone().zip(body.elastic.forces(&strains)).collect();
            let mut shape = vec![0.0; system.modes()];
            for (point, share) in &forces {
                let own = system.contact_shape(*point);
                shape.iter_mut().zip(own).for_each(|(shape, b)| *shape += share * b);
            }
            open.push(Open { forces, shape, spring: 1.0, at_middle: None, elastic: 0.0 });
        }
    }
    open
}

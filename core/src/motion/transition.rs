//! The derivative of the flow in its start state: the transition matrix, through events.
//!
//! Between events it is the exponential of the linear equations. At an event the vector field
//! jumps in the contact forces alone: at the onset of slip the force of the point loses its
//! dependence on everything, at the return to stick nothing jumps (Leine and Nijmeijer 2004,
//! saltation matrix).

use super::flow::Passage;
use super::modal_system::{Damping, ModalSystem, Regime};
use super::state::State;
use crate::contact::PointState;
use faer::Mat;

/// Norm of a matrix times time to which the truncated exponential is applied.
const SMALL: f64 = 0.5;

/// A stretch of the motion in one regime, and what ends it.
#[derive(Debug, Clone)]
pub(crate) struct Leg {
    regime: Regime,
    /// Duration [s].
    duration: f64,
    /// Point that begins to slip at the end, with the jump of all forces per force of that point.
    onset: Option<(usize, Vec<f64>)>,
}

impl Leg {
    /// Adds what an observer of the flow sees to the legs so far.
    pub(crate) fn record(legs: &mut Vec<Self>, passage: &Passage<'_>) {
        match passage {
            Passage::Arc(arc) => match legs.last_mut() {
                Some(leg) if leg.onset.is_none() && leg.regime.points == arc.regime.points => {
                    leg.duration += arc.duration();
                }
                _ => legs.push(Self {
                    regime: arc.regime.clone(),
                    duration: arc.duration(),
                    onset: None,
                }),
            },
            Passage::Event { event, speed, before, after } => {
                if event.state == PointState::Stuck {
                    return;
                }
                let rate = |regime: &Regime, i: usize| -> f64 {
                    speed.iter().enumerate().map(|(j, v)| regime.tangent[(i, j)] * v).sum()
                };
                let own = rate(before, event.point);
                let jump = (0..speed.len())
                    .map(|i| {
                        if i == event.point {
                            -1.0
                        } else if own == 0.0 {
                            0.0
                        } else {
                            (rate(after, i) - rate(before, i)) / own
                        }
                    })
                    .collect();
                let onset = Some((event.point, jump));
                match legs.last_mut() {
                    Some(leg) if leg.onset.is_none() && leg.regime.points == before.points => {
                        leg.onset = onset;
                    }
                    _ => legs.push(Self { regime: (*before).clone(), duration: 0.0, onset }),
                }
            }
        }
    }
}

/// Transition matrices in the coordinates `(w η, η', f/√k)`, in whose norm passive systems
/// contract: kinetic and elastic energy.
pub(crate) struct Transition<'a> {
    system: &'a ModalSystem,
    /// w per mode [rad/s].
    weight: Vec<f64>,
    /// √k per contact point.
    root: Vec<f64>,
}

impl<'a> Transition<'a> {
    /// Coordinates that suit a motion at `omega` [rad/s].
    pub(crate) fn new(system: &'a ModalSystem, omega: f64) -> Self {
        let weight = system.omega_squared().iter().map(|w| w.abs().sqrt().max(omega)).collect();
        let root = system
            .contact_stiffness()
            .iter()
            .map(|k| if *k > 0.0 { k.sqrt() } else { 1.0 })
            .collect();
        Self { system, weight, root }
    }

    /// Number of coordinates, 2N + points.
    pub(crate) fn size(&self) -> usize {
        2 * self.weight.len() + self.root.len()
    }

    /// Coordinates of a state.
    pub(crate) fn coordinates(&self, state: &State) -> Vec<f64> {
        let displacement = state.displacement.iter().zip(&self.weight).map(|(x, w)| w * x);
        let force = state.force.iter().zip(&self.root).map(|(f, root)| f / root);
        displacement.chain(state.velocity.iter().copied()).chain(force).collect()
    }

    /// Rate of change of the coordinates of a state without loads, in its regime.
    pub(crate) fn rate(&self, state: &State, regime: &Regime) -> Vec<f64> {
        let system = self.system;
        let speed = system.contact_displacement(&state.velocity);
        let displacement = state.velocity.iter().zip(&self.weight).map(|(v, w)| w * v);
        let velocity = system.acceleration(&state.displacement, &state.velocity, &state.force);
        let force = self.root.iter().enumerate().map(|(i, root)| {
            speed.iter().enumerate().map(|(j, v)| regime.tangent[(i, j)] * v).sum::<f64>() / root
        });
        displacement.chain(velocity).chain(force).collect()
    }

    /// State of coordinates, and whether the force of each point is free to vary there.
    pub(crate) fn state(&self, y: &[f64]) -> (State, Vec<bool>) {
        let modes = self.weight.len();
        let mut state = State::rest(self.system);
        for j in 0..modes {
            state.displacement[j] = y[j] / self.weight[j];
            state.velocity[j] = y[modes + j];
        }
        for (i, root) in self.root.iter().enumerate() {
            state.force[i] = y[2 * modes + i] * root;
        }
        let wanted = state.force.clone();
        state.settle_points(self.system);
        let free = (0..wanted.len())
            .map(|i| state.points[i] == PointState::Stuck && wanted[i] == state.force[i])
            .collect();
        (state, free)
    }

    /// Coordinates of the slip loads `q_i = (D u)_i − f_i`: rows whose product with the
    /// coordinates is q over √k.
    pub(crate) fn slip_load_row(&self, point: usize, stuck: &Regime) -> Vec<f64> {
        let modes = self.weight.len();
        let mut row = vec![0.0; self.size()];
        for other in 0..self.root.len() {
            let stiffness = stuck.tangent[(point, other)] / self.root[point];
            if stiffness == 0.0 {
                continue;
            }
            let shape = self.system.contact_shape(other);
            for j in 0..modes {
                row[j] += stiffness * shape[j] / self.weight[j];
            }
        }
        row[2 * modes + point] = -1.0;
        row
    }

    /// Derivative of the end state in the start state along the legs of a motion.
    pub(crate) fn along(&self, legs: &[Leg], free: &[bool]) -> Mat<f64> {
        let (size, modes) = (self.size(), self.weight.len());
        let mut total = Mat::<f64>::identity(size, size);
        for (i, free) in free.iter().enumerate() {
            total[(2 * modes + i, 2 * modes + i)] = f64::from(u8::from(*free));
        }
        for leg in legs {
            if leg.duration > 0.0 {
                total = self.exponential(&leg.regime, leg.duration) * total;
            }
            if let Some((point, jump)) = &leg.onset {
                self.jump(*point, jump, &mut total);
            }
        }
        total
    }

    /// `S = I + Δf' e_iᵀ / f_i'` from the left.
    fn jump(&self, point: usize, jump: &[f64], total: &mut Mat<f64>) {
        let first = 2 * self.weight.len();
        for column in 0..total.ncols() {
            let own = total[(first + point, column)];
            for (i, jump) in jump.iter().enumerate() {
                total[(first + i, column)] += jump * self.root[point] / self.root[i] * own;
            }
        }
    }

    /// Exponential of the linear equations over a duration [s], by scaling and squaring.
    fn exponential(&self, regime: &Regime, duration: f64) -> Mat<f64> {
        let (size, modes, points) = (self.size(), self.weight.len(), self.root.len());
        let mut a = Mat::<f64>::zeros(size, size);
        for j in 0..modes {
            a[(j, modes + j)] = duration * self.weight[j];
            a[(modes + j, j)] = -duration * self.system.omega_squared()[j] / self.weight[j];
        }
        match &self.system.damping {
            Damping::Diagonal(damping) => {
                for (j, c) in damping.iter().enumerate() {
                    a[(modes + j, modes + j)] = -duration * c;
                }
            }
            Damping::Full(damping) => {
                for j in 0..modes {
                    for i in 0..modes {
                        a[(modes + i, modes + j)] = -duration * damping[(i, j)];
                    }
                }
            }
        }
        for i in 0..points {
            let shape = self.system.contact_shape(i);
            for (j, b) in shape.iter().enumerate() {
                a[(modes + j, 2 * modes + i)] = -duration * b * self.root[i];
            }
            for other in 0..points {
                let tangent = duration * regime.tangent[(i, other)] / self.root[i];
                if tangent == 0.0 {
                    continue;
                }
                for (j, b) in self.system.contact_shape(other).iter().enumerate() {
                    a[(2 * modes + i, modes + j)] += tangent * b;
                }
            }
        }
        exponential(&a)
    }
}

/// Exponential of a matrix: Taylor polynomial of degree 15 in blocks of four, scaled and squared.
fn exponential(a: &Mat<f64>) -> Mat<f64> {
    let size = a.nrows();
    let norm = a.norm_l2();
    let squarings = (norm / SMALL).log2().ceil().max(0.0);
    let scaled = faer::Scale(0.5_f64.powf(squarings)) * a;
    let second = &scaled * &scaled;
    let third = &second * &scaled;
    let fourth = &second * &second;
    let mut factorials = [1.0; 16];
    for k in 1..16 {
        factorials[k] = factorials[k - 1] / k as f64;
    }
    let block = |first: usize| {
        let mut sum = faer::Scale(factorials[first + 1]) * &scaled
            + faer::Scale(factorials[first + 2]) * &second
            + faer::Scale(factorials[first + 3]) * &third;
        for i in 0..size {
            sum[(i, i)] += factorials[first];
        }
        sum
    };
    let mut value = block(12);
    for first in [8, 4, 0] {
        value = &fourth * &value + block(first);
    }
    for _ in 0..squarings as usize {
        value = &value * &value;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_is_exact() {
        let angle = 7.3_f64;
        let a = Mat::from_fn(2, 2, |i, j| angle * (i as f64 - j as f64));
        let e = exponential(&a);
        assert!((e[(0, 0)] - angle.cos()).abs() < 1e-13);
        assert!((e[(1, 0)] - angle.sin()).abs() < 1e-13);
    }
}

//! Reference systems and an independent time integration, shared by all tests.
#![allow(dead_code, clippy::unwrap_used)]

pub mod chain;
pub mod coupled;
pub mod curves;
pub mod damper;
pub mod differences;
pub mod masing;
pub mod node;
pub mod passive;
pub mod planar;
pub mod tangents;

use faer::{c64, mat, Mat};
use stickslip_core::contact::Jenkins;
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// Slip force of Guillen (1999), eq. (2.32) [N].
pub const SLIP_FORCE: f64 = 246.048;
/// Damper stiffness of Guillen (1999), eq. (2.32) [N/m].
pub const STIFFNESS: f64 = 2.4e7;

/// A system in plain numbers: matrices, dampers `(one end, other end, k_d, F_d)` and forces
/// `(DOF, harmonic, amplitude, phase)`.
#[derive(Debug, Clone)]
pub struct System {
    pub mass: Mat<f64>,
    pub damping: Mat<f64>,
    pub stiffness: Mat<f64>,
    pub dampers: Vec<(usize, Option<usize>, f64, f64)>,
    pub forces: Vec<(usize, usize, f64, f64)>,
}

impl System {
    pub fn dofs(&self) -> usize {
        self.mass.nrows()
    }

    pub fn rows(&self, damper: usize) -> Mat<f64> {
        let (one, other, ..) = self.dampers[damper];
        Mat::from_fn(1, self.dofs(), |_, j| {
            f64::from(u8::from(j == one)) - f64::from(u8::from(Some(j) == other))
        })
    }

    pub fn model(&self) -> Model {
        let structure =
            Structure::new(self.mass.as_ref(), self.damping.as_ref(), self.stiffness.as_ref())
                .unwrap();
        let contacts = (0..self.dampers.len())
            .map(|i| Contact {
                law: Box::new(Jenkins::new(self.dampers[i].2, self.dampers[i].3).unwrap()),
                rows: self.rows(i),
            })
            .collect();
        let mut loads: Vec<HarmonicLoad> = Vec::new();
        for &(dof, harmonic, amplitude, phase) in &self.forces {
            let at = loads.iter().position(|l| l.harmonic == harmonic).unwrap_or_else(|| {
                let amplitude = vec![c64::new(0.0, 0.0); self.dofs()];
                loads.push(HarmonicLoad { harmonic, amplitude });
                loads.len() - 1
            });
            loads[at].amplitude[dof] += c64::from_polar(amplitude, phase);
        }
        Model::new(structure, contacts, loads).unwrap()
    }
}

/// The three-DOF beam of Guillen (1999), eq. (2.32): damper on DOF 0, force on the tip.
pub fn snecma_beam(force: f64) -> System {
    let mass = mat![
        [6.67959, 1.02115, 0.6343],
        [1.02115, 1.22168, 0.232108],
        [0.6343, 0.232108, 0.121809],
    ];
    let stiffness =
        mat![[4.43203e6, -3.77514e5, 0.0], [-3.77514e5, 6.9626e4, 0.0], [0.0, 0.0, 1.85323e5],];
    let damping = faer::Scale(2.6e-5) * &stiffness + faer::Scale(7.49) * &mass;
    System {
        mass,
        damping,
        stiffness,
        dampers: vec![(0, None, STIFFNESS, SLIP_FORCE)],
        forces: vec![(1, 1, force, 0.0)],
    }
}

/// The single-DOF system of Guillen (1999), Table 2.2, forced with `ratio * F_d`.
pub fn single_dof(ratio: f64) -> System {
    System {
        mass: mat![[944.6]],
        damping: mat![[7700.0]],
        stiffness: mat![[2.4e7]],
        dampers: vec![(0, None, STIFFNESS, SLIP_FORCE)],
        forces: vec![(0, 1, ratio * SLIP_FORCE, 0.0)],
    }
}

/// Two beams with dampers to ground and one between their tips.
pub fn beam_pair(force: f64) -> System {
    let beam = snecma_beam(force);
    let twice = |a: &Mat<f64>| {
        Mat::from_fn(6, 6, |i, j| if i / 3 == j / 3 { a[(i % 3, j % 3)] } else { 0.0 })
    };
    System {
        mass: twice(&beam.mass),
        damping: twice(&beam.damping),
        stiffness: twice(&beam.stiffness),
        dampers: vec![
            (0, None, STIFFNESS, SLIP_FORCE),
            (3, None, STIFFNESS, SLIP_FORCE),
            (1, Some(4), 1e5, 15.0),
        ],
        forces: vec![(1, 1, force, 0.0), (4, 1, 0.7 * force, 1.1)],
    }
}

/// Half peak-to-peak range of every DOF over the last of `periods` periods of classical
/// fourth-order Runge-Kutta from rest, the dampers as rate equations `f' = k_d u'` within ±F_d.
pub fn runge_kutta(system: &System, omega: f64, periods: usize, steps: usize) -> Vec<f64> {
    let n = system.dofs();
    let dampers = system.dampers.len();
    let inverse = {
        use faer::linalg::solvers::DenseSolveCore as _;
        system.mass.partial_piv_lu().inverse()
    };
    let of_x = &inverse * &system.stiffness;
    let of_v = &inverse * &system.damping;
    let of_f: Vec<Mat<f64>> = (0..dampers).map(|i| &inverse * system.rows(i).transpose()).collect();
    let rate = |t: f64, y: &[f64], dy: &mut [f64]| {
        for i in 0..n {
            dy[i] = y[n + i];
            let mut acceleration = 0.0;
            for j in 0..n {
                acceleration -= of_x[(i, j)] * y[j] + of_v[(i, j)] * y[n + j];
            }
            for (d, column) in of_f.iter().enumerate() {
                acceleration -= column[(i, 0)] * y[2 * n + d];
            }
            for &(dof, harmonic, amplitude, phase) in &system.forces {
                let load = amplitude * (harmonic as f64 * omega * t + phase).cos();
                acceleration += inverse[(i, dof)] * load;
            }
            dy[n + i] = acceleration;
        }
        for (d, &(one, other, k, limit)) in system.dampers.iter().enumerate() {
            let speed = y[n + one] - other.map_or(0.0, |dof| y[n + dof]);
            let f = y[2 * n + d];
            let slips = (f >= limit && speed > 0.0) || (f <= -limit && speed < 0.0);
            dy[2 * n + d] = if slips { 0.0 } else { k * speed };
        }
    };
    let size = 2 * n + dampers;
    let mut y = vec![0.0; size];
    let mut stages = vec![vec![0.0; size]; 4];
    let mut at = vec![0.0; size];
    let h = std::f64::consts::TAU / omega / steps as f64;
    let (mut low, mut high) = (vec![f64::MAX; n], vec![f64::MIN; n]);
    let mut before = y.clone();
    for step in 0..periods * steps {
        let t = step as f64 * h;
        before.clone_from(&y);
        rate(t, &y, &mut stages[0]);
        for (stage, share) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
            for i in 0..size {
                at[i] = y[i] + share * h * stages[stage - 1][i];
            }
            let (_, rest) = stages.split_at_mut(stage);
            rate(t + share * h, &at, &mut rest[0]);
        }
        for i in 0..size {
            y[i] += h / 6.0 * (stages[0][i] + 2.0 * (stages[1][i] + stages[2][i]) + stages[3][i]);
        }
        for (d, &(.., limit)) in system.dampers.iter().enumerate() {
            y[2 * n + d] = y[2 * n + d].clamp(-limit, limit);
        }
        if step >= (periods - 1) * steps {
            for i in 0..n {
                let turn = turning_value(before[i], h * before[n + i], y[i], h * y[n + i]);
                low[i] = low[i].min(turn);
                high[i] = high[i].max(turn);
            }
        }
    }
    low.iter().zip(&high).map(|(l, h)| 0.5 * (h - l)).collect()
}

/// Extreme of the cubic with these values and slopes at the ends of a step, or its last value.
fn turning_value(x_0: f64, v_0: f64, x_1: f64, v_1: f64) -> f64 {
    if v_0 * v_1 >= 0.0 {
        return x_1;
    }
    let rise = x_1 - x_0;
    let (square, cube) = (3.0 * rise - 2.0 * v_0 - v_1, v_0 + v_1 - 2.0 * rise);
    let mut s = v_0 / (v_0 - v_1);
    for _ in 0..3 {
        let slope = v_0 + s * (2.0 * square + 3.0 * s * cube);
        s -= slope / (2.0 * square + 6.0 * s * cube);
    }
    x_0 + s * (v_0 + s * (square + s * cube))
}

//! Systems with planar Coulomb contacts, and their motion by short steps.

use super::chain;
use faer::linalg::solvers::DenseSolveCore as _;
use faer::{c64, Mat};
use proptest::prelude::*;
use std::f64::consts::TAU;
use stickslip_core::contact::{Closure, Coulomb};
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// A contact: one tangential row and one normal row over the DOFs, μ, k_t, k_n, preload or gap.
#[derive(Debug, Clone)]
pub struct Pad {
    pub rows: Mat<f64>,
    pub friction: f64,
    pub tangential: f64,
    pub normal: f64,
    pub closure: Closure,
}

impl Pad {
    pub fn law(&self) -> Coulomb {
        Coulomb::new(1, self.friction, self.tangential, Some(self.normal), self.closure).unwrap()
    }

    /// `N₀ + k_n v`.
    pub fn pressing(&self, v: f64) -> f64 {
        match self.closure {
            Closure::Preload(force) => force + self.normal * v,
            Closure::Gap(gap) => self.normal * (v - gap),
        }
    }

    /// What of N the structure does not feel.
    pub fn balanced(&self) -> f64 {
        match self.closure {
            Closure::Preload(force) => force,
            Closure::Gap(_) => 0.0,
        }
    }
}

/// A system in plain numbers; loads are `(DOF, harmonic, amplitude, phase)`.
#[derive(Debug, Clone)]
pub struct Planar {
    pub mass: Mat<f64>,
    pub damping: Mat<f64>,
    pub stiffness: Mat<f64>,
    pub pads: Vec<Pad>,
    pub loads: Vec<(usize, usize, f64, f64)>,
}

impl Planar {
    pub fn dofs(&self) -> usize {
        self.mass.nrows()
    }

    pub fn model(&self) -> Model {
        let structure =
            Structure::new(self.mass.as_ref(), self.damping.as_ref(), self.stiffness.as_ref())
                .unwrap();
        let contacts = self
            .pads
            .iter()
            .map(|pad| Contact { law: Box::new(pad.law()), rows: pad.rows.clone() });
        let mut loads: Vec<HarmonicLoad> = Vec::new();
        for &(dof, harmonic, amplitude, phase) in &self.loads {
            let mut along = vec![c64::new(0.0, 0.0); self.dofs()];
            along[dof] = c64::from_polar(amplitude, phase);
            match loads.iter_mut().find(|load| load.harmonic == harmonic) {
                Some(load) => load.amplitude[dof] += along[dof],
                None => loads.push(HarmonicLoad { harmonic, amplitude: along }),
            }
        }
        Model::new(structure, contacts.collect(), loads).unwrap()
    }

    /// Displacements after every one of `instants` equal parts of `periods` periods from rest, by
    /// `steps` classical Runge-Kutta steps in each: the sliders w give the tractions, and are dragged
    /// along where these exceed μN.
    pub fn by_steps(&self, omega: f64, periods: f64, instants: usize, steps: usize) -> Vec<f64> {
        let n = self.dofs();
        let inverse = self.mass.partial_piv_lu().inverse();
        let mut y = vec![0.0; 2 * n];
        let mut sliders = vec![[0.0; 3]; self.pads.len()];
        let h = TAU / omega * periods / (instants * steps) as f64;
        let mut out = Vec::new();
        for number in 0..instants * steps {
            let t = number as f64 * h;
            let rate = |t: f64, y: &[f64]| -> Vec<f64> {
                let mut sliders = sliders.clone();
                let mut force = self.contact_forces(y, &mut sliders);
                for (i, force) in force.iter_mut().enumerate() {
                    let own =
                        |j: usize| self.stiffness[(i, j)] * y[j] + self.damping[(i, j)] * y[n + j];
                    *force += (0..n).map(own).sum::<f64>();
                }
                for &(dof, harmonic, amplitude, phase) in &self.loads {
                    force[dof] -= amplitude * (harmonic as f64 * omega * t + phase).cos();
                }
                let mut rate = y[n..].to_vec();
                rate.extend(
                    (0..n).map(|i| -(0..n).map(|j| inverse[(i, j)] * force[j]).sum::<f64>()),
                );
                rate
            };
            let moved = |by: f64, rate: &[f64]| -> Vec<f64> {
                y.iter().zip(rate).map(|(y, rate)| y + by * rate).collect()
            };
            let a = rate(t, &y);
            let b = rate(t + 0.5 * h, &moved(0.5 * h, &a));
            let c = rate(t + 0.5 * h, &moved(0.5 * h, &b));
            let d = rate(t + h, &moved(h, &c));
            for i in 0..2 * n {
                y[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
            }
            self.contact_forces(&y, &mut sliders);
            if (number + 1) % steps == 0 {
                out.extend_from_slice(&y[..n]);
            }
        }
        out
    }

    /// Forces on the DOFs after a step, and where the sliders come to; with them u and v before it.
    fn contact_forces(&self, y: &[f64], sliders: &mut [[f64; 3]]) -> Vec<f64> {
        let n = self.dofs();
        let mut force = vec![0.0; n];
        for (pad, [slider, last_u, last_v]) in self.pads.iter().zip(sliders) {
            let along = |row: usize| -> f64 { (0..n).map(|j| pad.rows[(row, j)] * y[j]).sum() };
            let (u, v) = (along(0), along(1));
            let (before, after) = (pad.pressing(*last_v), pad.pressing(v));
            if before <= 0.0 && after > 0.0 {
                // The slider has followed until it closed.
                *slider = *last_u + (u - *last_u) * before / (before - after);
            }
            let normal = after.max(0.0);
            let most = pad.friction * normal;
            let traction = (pad.tangential * (u - *slider)).clamp(-most, most);
            (*slider, *last_u, *last_v) = (u - traction / pad.tangential, u, v);
            for (j, force) in force.iter_mut().enumerate() {
                *force +=
                    pad.rows[(0, j)] * traction + pad.rows[(1, j)] * (normal - pad.balanced());
            }
        }
        force
    }
}

/// Two masses, the first one on a frictional support: normal and tangential motion of one body.
pub fn block(static_load: f64, loads: [f64; 2]) -> Planar {
    let diagonal = |a: f64, b: f64| faer::mat![[a, 0.0], [0.0, b]];
    Planar {
        mass: diagonal(1.0, 1.0),
        damping: diagonal(0.346_410_162, 2.0),
        stiffness: diagonal(12.0, 21.0),
        pads: vec![Pad {
            rows: diagonal(1.0, 1.0),
            friction: 0.85,
            tangential: 5.0,
            normal: 21.0,
            closure: Closure::Gap(0.0),
        }],
        loads: vec![(0, 1, loads[0], 0.0), (1, 1, loads[1], 0.0), (1, 0, static_load, 0.0)],
    }
}

/// Chains of masses with contacts in random directions, under preload or behind a gap.
pub fn planar_system() -> impl Strategy<Value = Planar> {
    let pad = |dofs: usize| {
        (
            prop::collection::vec(-1.0_f64..1.0, 2 * dofs),
            0.0_f64..1.2,
            50.0_f64..500.0,
            50.0_f64..500.0,
            prop::bool::ANY,
            -0.005_f64..0.01,
        )
    };
    chain::chains(1..5, pad).prop_map(|(masses, springs, pads, loads, damping)| {
        let n = masses.len();
        let mass = Mat::from_fn(n, n, |i, j| if i == j { masses[i] } else { 0.0 });
        let pad = |(rows, friction, tangential, normal, preloaded, size): (
            Vec<f64>,
            f64,
            f64,
            f64,
            bool,
            f64,
        )| Pad {
            rows: Mat::from_fn(2, n, |i, j| rows[i * n + j]),
            friction,
            tangential,
            normal,
            closure: if preloaded {
                Closure::Preload(100.0 * f64::abs(size))
            } else {
                Closure::Gap(size)
            },
        };
        Planar {
            damping: faer::Scale(damping) * &mass,
            mass,
            stiffness: chain::stiffness(&springs),
            pads: pads.into_iter().map(pad).collect(),
            loads,
        }
    })
}

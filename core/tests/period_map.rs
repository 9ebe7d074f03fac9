//! Floquet multipliers of the linearised period map against differences of a period of fine time
//! integration, and against those of exact orbits.

#![allow(clippy::unwrap_used)]

mod common;

use common::{single_dof, snecma_beam};
use faer::linalg::solvers::Solve as _;
use faer::{c64, mat, Mat};
use stickslip_core::balance::{ForcedBalance, HarmonicChoice, Point, Settings};
use stickslip_core::contact::{ContactLaw, Cubic, Stop};
use stickslip_core::model::{Contact, Model};
use stickslip_core::orbit::{OrbitSettings, PeriodMap, PeriodicOrbits};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// Springs of a system: DOF, stiffness and gap of a stop, or stiffness of a cubic spring.
#[derive(Debug, Clone, Copy)]
enum Spring {
    Stop(usize, f64, f64),
    Cubic(usize, f64),
}

/// A structure with springs to ground under one load.
struct Sprung {
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    springs: Vec<Spring>,
    load: Vec<f64>,
}

impl Sprung {
    fn model(&self) -> Model {
        let structure =
            Structure::new(self.mass.as_ref(), self.damping.as_ref(), self.stiffness.as_ref());
        let size = self.load.len();
        let contact = |spring: &Spring| {
            let (dof, law): (usize, Box<dyn ContactLaw>) = match *spring {
                Spring::Stop(dof, k, gap) => (dof, Box::new(Stop::new(k, gap).unwrap())),
                Spring::Cubic(dof, k) => (dof, Box::new(Cubic::new(k).unwrap())),
            };
            let rows = Mat::from_fn(1, size, |_, j| f64::from(u8::from(j == dof)));
            Contact { law, rows }
        };
        let amplitude = self.load.iter().map(|p| c64::new(*p, 0.0)).collect();
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
        Model::new(structure.unwrap(), self.springs.iter().map(contact).collect(), loads).unwrap()
    }

    /// Rate of (x, v), with the stops closed or open as told.
    fn rate(&self, inverse: &Mat<f64>, z: &[f64], closed: &[bool], phase: f64, out: &mut [f64]) {
        let size = self.load.len();
        let mut force: Vec<f64> = self.load.iter().map(|p| p * phase.cos()).collect();
        for (i, force) in force.iter_mut().enumerate() {
            for j in 0..size {
                *force -= self.stiffness[(i, j)] * z[j] + self.damping[(i, j)] * z[size + j];
            }
        }
        for (spring, closed) in self.springs.iter().zip(closed) {
            match *spring {
                Spring::Stop(dof, k, gap) if *closed => force[dof] -= k * (z[dof] - gap),
                Spring::Stop(..) => {}
                Spring::Cubic(dof, k) => force[dof] -= k * z[dof].powi(3),
            }
        }
        for i in 0..size {
            out[i] = z[size + i];
            out[size + i] = (0..size).map(|j| inverse[(i, j)] * force[j]).sum();
        }
    }

    fn runge_kutta(
        &self,
        inverse: &Mat<f64>,
        z: &[f64],
        closed: &[bool],
        [omega, t, h]: [f64; 3],
    ) -> Vec<f64> {
        let size = z.len();
        let mut stages = vec![vec![0.0; size]; 4];
        for stage in 0..4 {
            let share = [0.0, 0.5, 0.5, 1.0][stage];
            let mut at = z.to_vec();
            if stage > 0 {
                at.iter_mut().zip(&stages[stage - 1]).for_each(|(z, k)| *z += share * h * k);
            }
            let phase = omega * (t + share * h);
            self.rate(inverse, &at, closed, phase, &mut stages[stage]);
        }
        let sum = |i: usize| stages[0][i] + 2.0 * (stages[1][i] + stages[2][i]) + stages[3][i];
        (0..size).map(|i| z[i] + h / 6.0 * sum(i)).collect()
    }

    /// A period of fine steps, which end where a stop opens or closes.
    fn period(&self, z: &[f64], omega: f64, steps: usize) -> Vec<f64> {
        let size = self.load.len();
        let inverse = self.mass.partial_piv_lu().solve(Mat::<f64>::identity(size, size));
        let depth = |spring: &Spring, z: &[f64]| match *spring {
            Spring::Stop(dof, _, gap) => z[dof] - gap,
            Spring::Cubic(..) => -1.0,
        };
        let mut z = z.to_vec();
        let mut closed: Vec<bool> = self.springs.iter().map(|s| depth(s, &z) > 0.0).collect();
        let step = std::f64::consts::TAU / omega / steps as f64;
        for n in 0..steps {
            let (mut t, end) = (n as f64 * step, (n + 1) as f64 * step);
            while t < end {
                let wrong = |z: &[f64]| {
                    let mut pairs = self.springs.iter().zip(&closed);
                    pairs.position(|(s, closed)| (depth(s, z) > 0.0) != *closed)
                };
                let trial = self.runge_kutta(&inverse, &z, &closed, [omega, t, end - t]);
                if wrong(&trial).is_none() {
                    z = trial;
                    break;
                }
                let (mut low, mut high) = (0.0, end - t);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let at = self.runge_kutta(&inverse, &z, &closed, [omega, t, middle]);
                    if wrong(&at).is_none() {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                z = self.runge_kutta(&inverse, &z, &closed, [omega, t, high]);
                t += high;
                let passed = wrong(&z).unwrap();
                closed[passed] = !closed[passed];
            }
        }
        z
    }

    /// Multipliers by fourth-order differences of the period about a solution.
    fn differences(&self, point: &Point, steps: usize) -> Vec<c64> {
        let size = self.load.len();
        let orders = point.harmonics + 1;
        let mut start = vec![0.0; 2 * size];
        for dof in 0..size {
            for (k, x) in point.displacement[dof * orders..][..orders].iter().enumerate() {
                start[dof] += x.re;
                start[size + dof] -= k as f64 * point.omega * x.im;
            }
        }
        let largest = start.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let step = 1e-5 * largest;
        let mut matrix = Mat::zeros(2 * size, 2 * size);
        // Shooting takes the motion from that of the balance to the one that repeats.
        for shot in 0..4 {
            let back = self.period(&start, point.omega, steps);
            let gap = Mat::from_fn(2 * size, 1, |i, _| back[i] - start[i]);
            assert!(gap.norm_max() < [1e-3, 1e-6, 1e-9, 1e-11][shot] * largest, "{gap:?}");
            for j in 0..2 * size {
                let moved = |by: f64| {
                    let mut z = start.clone();
                    z[j] += by;
                    self.period(&z, point.omega, steps)
                };
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|n| moved(n * step));
                for i in 0..2 * size {
                    matrix[(i, j)] = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step);
                }
            }
            if gap.norm_max() < 1e-11 * largest {
                break;
            }
            let unit = Mat::<f64>::identity(2 * size, 2 * size);
            let way = (unit - &matrix).partial_piv_lu().solve(gap);
            start.iter_mut().enumerate().for_each(|(i, z)| *z += way[(i, 0)]);
        }
        sorted(matrix.eigenvalues().unwrap())
    }
}

fn sorted(mut values: Vec<c64>) -> Vec<c64> {
    values.sort_by(|a, b| (b.norm(), b.im).partial_cmp(&(a.norm(), a.im)).unwrap());
    values
}

/// Largest distance of multipliers from the nearest others.
fn apart(a: &[c64], b: &[c64]) -> f64 {
    let nearest = |one: &c64| b.iter().map(|other| (one - other).norm()).fold(f64::MAX, f64::min);
    a.iter().map(nearest).fold(0.0, f64::max)
}

fn solution(model: &Model, omega: f64, harmonics: usize) -> Point {
    let observe: Vec<usize> = (0..model.structure().dofs()).collect();
    let harmonics = HarmonicChoice::Fixed(harmonics);
    let settings = Settings { harmonics, ..Settings::default() };
    let point = ForcedBalance::new(model, settings, &observe).unwrap().solve(omega, None).unwrap();
    assert!(point.is_solved());
    point
}

fn one_mass(spring: Spring, load: f64) -> Sprung {
    Sprung {
        mass: mat![[1.0]],
        damping: mat![[0.08]],
        stiffness: mat![[1.0]],
        springs: vec![spring],
        load: vec![load],
    }
}

fn three_masses(springs: Vec<Spring>) -> Sprung {
    Sprung {
        mass: mat![[2.0, 0.1, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 0.5]],
        damping: mat![[0.2, -0.05, 0.0], [-0.05, 0.2, -0.02], [0.0, -0.02, 0.1]],
        stiffness: mat![[8.0, -3.0, 0.0], [-3.0, 5.0, -2.0], [0.0, -2.0, 4.0]],
        springs,
        load: vec![1.0, 0.4, 0.0],
    }
}

#[test]
fn multipliers_of_springs_are_differences_of_the_period() {
    let systems = [
        (one_mass(Spring::Cubic(0, 1.0), 1.0), vec![0.7, 1.5, 2.2], 61),
        (one_mass(Spring::Cubic(0, -0.01), 0.3), vec![0.7, 0.95], 41),
        (one_mass(Spring::Stop(0, 20.0, 1.0), 0.3), vec![0.9, 1.2, 1.35], 400),
        (one_mass(Spring::Stop(0, 20.0, -0.2), 0.3), vec![0.9, 3.0], 400),
        (three_masses(vec![Spring::Cubic(0, 2.0), Spring::Cubic(2, 1.0)]), vec![1.9, 2.6], 61),
        (
            three_masses(vec![Spring::Stop(0, 15.0, 0.2), Spring::Cubic(2, 1.0)]),
            vec![1.8, 2.4],
            200,
        ),
        (three_masses(vec![Spring::Stop(0, 15.0, 0.2), Spring::Stop(2, 9.0, 0.1)]), vec![2.0], 200),
    ];
    for (system, frequencies, harmonics) in systems {
        let model = system.model();
        let map = PeriodMap::new(&model).unwrap();
        for omega in frequencies {
            let point = solution(&model, omega, harmonics);
            let found = map.multipliers(omega, point.unknowns().unwrap(), Some(1e-9)).unwrap();
            let expected = system.differences(&point, 4000);
            let error = apart(&found.values, &expected).max(apart(&expected, &found.values));
            // Multipliers of unstable motions are compared relative to the largest.
            let error = error / expected[0].norm().max(1.0);
            assert!(error < 1e-6, "{:?} {omega}: {error:e}", system.springs);
            assert!(found.error <= 1e-9);
        }
    }
}

/// A chain of as many masses on cubic springs, with more damping at one end.
fn many_masses(size: usize) -> Sprung {
    let chain = |i: usize, j: usize| match i.abs_diff(j) {
        0 => 5.0 + 0.1 * i as f64,
        1 => -2.0,
        _ => 0.0,
    };
    Sprung {
        mass: Mat::identity(size, size),
        damping: Mat::from_fn(size, size, |i, j| if i == j { 0.1 + 0.02 * i as f64 } else { 0.0 }),
        stiffness: Mat::from_fn(size, size, chain),
        springs: (0..size).map(|dof| Spring::Cubic(dof, 1.0)).collect(),
        load: vec![0.5; size],
    }
}

/// Of many contacts the map is made by products of matrices, of few column by column.
#[test]
fn multipliers_of_many_springs_are_differences_of_the_period() {
    let system = many_masses(12);
    let model = system.model();
    let point = solution(&model, 1.4, 41);
    let map = PeriodMap::new(&model).unwrap();
    let found = map.multipliers(1.4, point.unknowns().unwrap(), Some(1e-9)).unwrap();
    let expected = system.differences(&point, 1000);
    let error = apart(&found.values, &expected).max(apart(&expected, &found.values));
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn multipliers_of_friction_are_those_of_exact_orbits() {
    for (system, omega, harmonics) in [
        (single_dof(2.0), 140.0, 301),
        (snecma_beam(20.313), 170.0, 601),
        (snecma_beam(25.0), 200.0, 601),
    ] {
        let model = system.model();
        let observe: Vec<usize> = (0..system.dofs()).collect();
        let mut orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
        let orbit = orbits.solve(omega, None).unwrap();
        let point = solution(&model, omega, harmonics);
        let map = PeriodMap::new(&model).unwrap();
        let found = map.multipliers(omega, point.unknowns().unwrap(), Some(1e-9)).unwrap();
        let expected: Vec<c64> = orbit.multipliers[orbit.neutral..].to_vec();
        let (a, b) = (apart(&found.values, &expected), apart(&expected, &found.values));
        assert!(a.max(b) < 1e-6, "{omega}: {a:e} {b:e}");
        assert_eq!(found.stable(), Some(true));
    }
}

//! The single-harmonic balance (Griffin 1980; Guillen 1999, chapter II, corrected): complex
//! describing functions instead of series, for any number of dampers.
//!
//! Printed, (2.40)-(2.43) drop the relative phases of the dampers. With complex amplitudes
//! `sum_j m_ij X_j + k_i (a_i − i b_i) X_i/A_i = r_i` keeps them. As everywhere it is condensed
//! onto the stuck structure: `U = U^stuck + G Q`, `Q_i = (k_i − K_i(|U_i|)) U_i`.

use super::forced::{is_bounded, ForcedBalance};
use super::jacobian::contactwise;
use super::solution::{Point, PointStatus, Solution};
use super::sweep::sweep_with;
use super::unknowns::{gather, scatter, Unknowns};
use crate::contact::Describing;
use crate::fourier::Harmonics;
use crate::model::Model;
use crate::solve::{newton, Outcome, Report, System};
use crate::structure::{Quantity, Receptance, Request};
use crate::timing::Profile;
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};
use std::f64::consts::PI;

/// Solves at the frequencies `omega` [rad/s] in the order given, from a balance of one harmonic.
/// Without `estimate` the error estimates, which take most of the time, are not-a-number.
///
/// # Errors
/// As for a sweep; a force of another harmonic than the first, or a contact whose law has no
/// describing function.
pub fn single_harmonic(
    balance: ForcedBalance<'_>,
    omega: &[f64],
    estimate: bool,
) -> Result<Solution, Error> {
    let model = balance.model;
    if let Some(other) = model.compliance().forced_harmonics().into_iter().find(|&k| k != 1) {
        let remedy = "the single-harmonic method takes forces of harmonic 1 alone; balance several harmonics instead";
        return Err(Error::value("force: harmonic", other as f64, remedy));
    }
    if let Some(index) = model.laws().iter().position(|law| law.describing(1.0).is_none()) {
        return Err(Error::shape(
            &format!("contact {}", index + 1),
            "a law with a describing function",
            "one without; balance several harmonics instead",
        ));
    }
    let mut equations = Equations::new(model);
    sweep_with(balance, omega, |balance, omega, start| {
        let point = equations.solve(balance, omega, start, estimate);
        balance.add_profile(&std::mem::take(&mut equations.profile));
        point
    })
}

/// The equations at one frequency.
struct Equations<'a> {
    model: &'a Model,
    harmonics: Harmonics,
    receptance: Receptance,
    /// Real and negative imaginary part of U^stuck, contact after contact, as all unknowns.
    stuck: Vec<f64>,
    /// Describing function of every contact at the last amplitudes, and the amplitudes.
    describing: Vec<(Describing, c64)>,
    slip_load: Vec<f64>,
    /// Contacts that slip.
    active: Vec<usize>,
    profile: Profile,
}

impl<'a> Equations<'a> {
    fn new(model: &'a Model) -> Self {
        let size = 2 * model.compliance().contacts();
        Self {
            model,
            harmonics: Harmonics::new(1, true),
            receptance: Receptance::default(),
            stuck: vec![0.0; size],
            describing: Vec::new(),
            slip_load: vec![0.0; size],
            active: Vec::new(),
            profile: Profile::default(),
        }
    }

    fn solve(
        &mut self,
        balance: &mut ForcedBalance<'_>,
        omega: f64,
        start: Option<&Unknowns>,
        estimate: bool,
    ) -> Result<Point, Error> {
        let (compliance, receptance) = (self.model.compliance(), &mut self.receptance);
        let received = Profile::time(&mut self.profile.compliance, || {
            compliance.receptance(1, omega, receptance)
        });
        let mut x = Vec::new();
        let report = received.is_ok().then(|| {
            scatter(&self.harmonics, 1, &self.receptance.stuck, &mut self.stuck);
            x = start.map_or_else(|| self.stuck.clone(), |start| start.recast(&self.harmonics));
            newton(self, &mut x, balance.settings.newton)
        });
        let solved =
            |report: &Report| report.outcome == Outcome::Converged && is_bounded(&x, &self.stuck);
        let Some(report) = report.filter(solved) else {
            // The same equations with homotopy at hand, or the word for why there is no solution.
            let mut point = balance.solve(omega, start)?;
            if !estimate {
                point.error_estimate.fill(f64::NAN);
            }
            return Ok(point);
        };
        let start = std::time::Instant::now();
        // The describing functions at the solution, and not where the last Jacobian was.
        let mut residual = vec![0.0; x.len()];
        self.residual(&x, &mut residual);
        let mut point = self.recover(balance, omega, &x)?;
        (point.residual, point.iterations) = (report.residual, report.iterations);
        balance.profile.recovery += start.elapsed();
        if estimate {
            let start = std::time::Instant::now();
            let done = balance.estimate_truncation(&self.harmonics, &x, None, &mut point)?;
            balance.profile.estimate += start.elapsed();
            if !done {
                return Ok(balance.not_computed(omega));
            }
        }
        point.unknowns = Some(Unknowns { harmonics: self.harmonics.clone(), values: x });
        Ok(point)
    }

    /// Displacements, forces and slip of a solution.
    fn recover(&self, balance: &ForcedBalance<'_>, omega: f64, x: &[f64]) -> Result<Point, Error> {
        let zero = c64::new(0.0, 0.0);
        let (observe, contacts) = (balance.observe, self.describing.len());
        let mut point = Point::empty(omega, PointStatus::Converged, observe.len(), contacts);
        point.keep(1);
        let (mut u, mut q) = (Vec::new(), Vec::new());
        gather(&self.harmonics, 1, x, &mut u);
        gather(&self.harmonics, 1, &self.slip_load, &mut q);
        let mut observed = vec![zero; observe.len()];
        let (contact, slip_load, quantity) = (&u[..], &q[..], Quantity::Whole);
        let request = Request { harmonic: 1, omega, quantity, contact, slip_load, observe };
        self.model.compliance().displacement(&request, &mut observed)?;
        for (i, value) in observed.into_iter().enumerate() {
            point.displacement[2 * i + 1] = value;
        }
        for (i, (describing, _)) in self.describing.iter().enumerate() {
            point.contact_displacement[2 * i + 1] = u[i];
            point.contact_force[2 * i + 1] = describing.stiffness * u[i];
            point.contacts[i].slip_fraction = describing.slip_fraction;
            point.contacts[i].dissipation = PI * describing.stiffness.im * u[i].norm_sqr();
        }
        Ok(point)
    }

    /// Derivatives of the slip load of contact i in its two unknowns: with U = p − i s,
    /// `dQ = (k − K) dU − K' U (p dp + s ds)/A`.
    fn tangent(&self, i: usize) -> [c64; 2] {
        let (describing, u) = self.describing[i];
        let loss = self.model.contact_stiffness()[(i, i)] - describing.stiffness;
        let amplitude = u.norm();
        let turn =
            if amplitude > 0.0 { describing.slope * u / amplitude } else { c64::new(0.0, 0.0) };
        [loss - turn * u.re, -c64::i() * loss + turn * u.im]
    }

    /// Jacobian of the contacts that slip, `I − G ∂Q`.
    fn jacobian_of_active(&self) -> Mat<f64> {
        let contacts = self.describing.len();
        let mut matrix = Mat::identity(2 * self.active.len(), 2 * self.active.len());
        for (column, &from) in self.active.iter().enumerate() {
            for (side, dq) in self.tangent(from).into_iter().enumerate() {
                for (row, &to) in self.active.iter().enumerate() {
                    let du = self.receptance.contact[from * contacts + to] * dq;
                    matrix[(2 * row, 2 * column + side)] -= du.re;
                    matrix[(2 * row + 1, 2 * column + side)] += du.im;
                }
            }
        }
        matrix
    }
}

impl System for Equations<'_> {
    fn size(&self) -> usize {
        self.stuck.len()
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        let contacts = x.len() / 2;
        let laws = self.model.laws();
        let start = std::time::Instant::now();
        self.describing.clear();
        self.active.clear();
        for (i, law) in laws.iter().enumerate() {
            let u = c64::new(x[2 * i], -x[2 * i + 1]);
            // That every law has one is known.
            let Some(describing) = law.describing(u.norm()) else { continue };
            let stiffness = self.model.contact_stiffness()[(i, i)];
            let q = (stiffness - describing.stiffness) * u;
            (self.slip_load[2 * i], self.slip_load[2 * i + 1]) = (q.re, -q.im);
            if describing.stiffness != c64::new(stiffness, 0.0) {
                self.active.push(i);
            }
            self.describing.push((describing, u));
        }
        self.profile.law += start.elapsed();
        self.profile.evaluations += 1;
        for ((r, x), stuck) in out.iter_mut().zip(x).zip(&self.stuck) {
            *r = x - stuck;
        }
        for &from in &self.active {
            let q = c64::new(self.slip_load[2 * from], -self.slip_load[2 * from + 1]);
            for (to, r) in out.chunks_exact_mut(2).enumerate() {
                let u = self.receptance.contact[from * contacts + to] * q;
                r[0] -= u.re;
                r[1] += u.im;
            }
        }
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        let (describing, active) = (self.describing.clone(), self.active.clone());
        self.residual(x, out);
        (self.describing, self.active) = (describing, active);
    }

    fn relative_size(&self, step: &[f64], x: &[f64]) -> f64 {
        contactwise(self.model, 2, &self.slip_load, step, x)
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        step.copy_from_slice(rhs);
        if self.active.is_empty() {
            return true;
        }
        let start = std::time::Instant::now();
        let contacts = self.describing.len();
        let matrix = self.jacobian_of_active();
        let mut block =
            Mat::from_fn(2 * self.active.len(), 1, |i, _| rhs[2 * self.active[i / 2] + i % 2]);
        if self.active.len() == 1 {
            let [a, b, c, d] = [matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 0)], matrix[(1, 1)]];
            let (p, s) = (block[(0, 0)], block[(1, 0)]);
            let determinant = a * d - b * c;
            block[(0, 0)] = (d * p - b * s) / determinant;
            block[(1, 0)] = (a * s - c * p) / determinant;
        } else {
            matrix.partial_piv_lu().solve_in_place(&mut block);
        }
        self.profile.factorisations += 1;
        // The step of the others follows from step = rhs + G ∂Q step.
        for (index, &from) in self.active.iter().enumerate() {
            let [by_p, by_s] = self.tangent(from);
            let dq = by_p * block[(2 * index, 0)] + by_s * block[(2 * index + 1, 0)];
            for (to, own) in step.chunks_exact_mut(2).enumerate() {
                let u = self.receptance.contact[from * contacts + to] * dq;
                own[0] += u.re;
                own[1] -= u.im;
            }
        }
        self.profile.linear_solve += start.elapsed();
        step.iter().all(|s| s.is_finite())
    }
}

//! Where a nonlinear mode begins: the linear mode of the structure at rest.

use super::equations::ModeEquations;
use crate::balance::{static_response, RestStatus};
use crate::model::{ModalBases, Model};
use crate::solve::hermitian_eigen;
use crate::Error;
use faer::{c64, Mat};

/// A linear mode in the coordinates of the stuck modes.
#[derive(Debug, Clone)]
pub(super) struct Linear {
    /// Natural frequency [rad/s].
    pub(super) omega: f64,
    /// `φᴴ C φ` [1/s].
    pub(super) damping: f64,
    /// Its shape.
    pub(super) shape: Vec<c64>,
}

impl Linear {
    /// The unknowns of the linear motion at an amplitude.
    pub(super) fn point(&self, equations: &ModeEquations<'_>, log: f64) -> Vec<f64> {
        let mut z = vec![0.0; equations.size()];
        let (range, modes) = (equations.range(1), self.shape.len());
        let turn = equations.feed.turn(&self.shape);
        for (i, value) in z[range].iter_mut().enumerate() {
            let own = turn * self.shape[i % modes];
            *value = if i < modes { own.re } else { -own.im };
        }
        let size = z.len();
        z[size - 3] = self.omega / equations.unit;
        z[size - 2] = equations.feed.share(self.damping / equations.unit, &self.shape);
        z[size - 1] = log;
        z
    }
}

/// Modal displacements of the equilibrium under the static loads, or of one without friction history if
/// raising the loads finds none.
///
/// # Errors
/// A rigid-body motion that the loads or the contacts drive.
pub(super) fn at_rest(model: &Model, bases: &ModalBases) -> Result<Vec<f64>, Error> {
    let basis = bases.at(0);
    let stiff = |j: usize| !basis.free[j];
    let lowest = (0..basis.modes()).filter(|&j| stiff(j)).map(|j| basis.squared[j]);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    if lowest <= 1e-14 * basis.squared.last().copied().unwrap_or(0.0) {
        return Err(Error::SingularStiffness { lowest: lowest.max(0.0).sqrt() });
    }
    let contacts = model.compliance().contacts();
    let mut load = vec![0.0; contacts];
    // Free rigid bodies have no static receptance.
    if !basis.free.contains(&true) {
        let found = static_response(model, &[], &|_| true)?;
        if found.status == RestStatus::Converged {
            let stiffness = model.contact_stiffness();
            for (i, q) in load.iter_mut().enumerate() {
                let stuck: f64 =
                    (0..contacts).map(|j| stiffness[(i, j)] * found.contact_displacement[j]).sum();
                *q = stuck - found.contact_force[i];
            }
        }
    }
    let load = faer::Mat::from_fn(contacts, 1, |i, _| load[i]);
    let force = basis.contacts.adjoint_times(load.as_ref());
    let at = |j: usize| (basis.load[j] + force[(j, 0)]) / basis.squared[j];
    Ok((0..basis.modes()).map(|j| if stiff(j) { at(j) } else { 0.0 }).collect())
}

/// The mode of a number, counted from 0 by rising frequency, of the structure with its contacts as they are
/// at rest: an open one is left out.
///
/// # Errors
/// No such mode, or one without frequency.
pub(super) fn linear_mode(equations: &mut ModeEquations<'_>, mode: usize) -> Result<Linear, Error> {
    let count = equations.modes();
    if mode >= count {
        let remedy = format!("the structure has modes 0 to {}", count - 1);
        return Err(Error::value("mode", mode as f64, &remedy));
    }
    let mut squared = equations.basis(1).squared.clone();
    let mut shapes = Mat::<c64>::identity(count, count);
    if let Some(softening) = softening(equations) {
        let own = Mat::from_fn(count, count, |i, j| {
            let stuck = if i == j { squared[i] } else { 0.0 };
            c64::new(stuck, 0.0) - 0.5 * (softening[(i, j)] + softening[(j, i)].conj())
        });
        let failed = || Error::Eigenvalues("stiffness at rest".to_owned());
        (squared, shapes) = hermitian_eigen(own.as_ref()).ok_or_else(failed)?;
    }
    let highest = squared.last().copied().unwrap_or(0.0);
    if squared[mode] <= 1e-12 * highest {
        let remedy = "is a rigid-body motion without frequency; choose a higher one";
        return Err(Error::value("mode", mode as f64, remedy));
    }
    let shape: Vec<c64> = (0..count).map(|j| shapes[(j, mode)]).collect();
    let basis = equations.basis(1);
    let part = Mat::from_fn(count, 2, |j, c| if c == 0 { shape[j].re } else { -shape[j].im });
    let coupled = basis.coupling.as_ref().map(|coupling| coupling.times(part.as_ref()));
    let damping: f64 = (0..count)
        .map(|j| {
            let own = basis.damping[j] * shape[j].norm_sqr();
            let of = |c: &Mat<f64>| c[(j, 0)] * part[(j, 0)] + c[(j, 1)] * part[(j, 1)];
            own + coupled.as_ref().map_or(0.0, of)
        })
        .sum();
    Ok(Linear { omega: squared[mode].sqrt(), damping, shape })
}

/// Modal stiffness that contacts lack at rest against the stuck ones; nothing if all stick.
fn softening(equations: &mut ModeEquations<'_>) -> Option<Mat<c64>> {
    let count = equations.modes();
    let mut z = vec![0.0; equations.size()];
    let size = z.len();
    (z[size - 3], z[size - 1]) = (1.0, f64::MIN_POSITIVE.sqrt().ln());
    equations.hold(&z);
    equations.evaluate(&z);
    if !equations.loads.iter().any(|load| load.active) {
        return None;
    }
    let (slots, slot) = (equations.harmonics().slots(), equations.harmonics().slot(1)?);
    let contacts = equations.model.compliance().contacts();
    let mut tangent = Mat::<f64>::zeros(contacts, contacts);
    for (load, points) in equations.loads.iter().zip(equations.model.points()) {
        if !load.active {
            continue;
        }
        let size = points.len() * slots;
        for i in 0..points.len() {
            for j in 0..points.len() {
                tangent[(points.start + i, points.start + j)] =
                    load.tangent[(i * slots + slot) * size + j * slots + slot];
            }
        }
    }
    if tangent.norm_max() == 0.0 {
        return None;
    }
    let basis = equations.basis(1);
    let mut out = Mat::<c64>::zeros(count, count);
    for j in 0..count {
        let unit = Mat::from_fn(count, 2, |i, c| f64::from(u8::from(i == j && c == 0)));
        let moved = basis.contacts.times(unit.as_ref());
        let force = basis.contacts.adjoint_times((&tangent * &moved).as_ref());
        for i in 0..count {
            out[(i, j)] = c64::new(force[(i, 0)], -force[(i, 1)]);
        }
    }
    Some(out)
}

//! The structure-like damper: a massless elastic body that touches its neighbours at several
//! points, each of which slips (Guillen 1999, chapter VI).
//!
//! `f = D (u − s)`, `|f_i| ≤ F_i`, and the slip s_i moves along `f_i = ±F_i` alone. The dissertation's
//! explicit update finds the slip of a step from the states of the step before; it is of first
//! order and overshoots the limits. Here a periodic motion is followed from transition to
//! transition, each located exactly (`periodic_march`), and an increment solves the implicit problem
//! (`increment`).

use super::increment::Increment;
use crate::contact::elastic::{Elastic, ReducedStiffness};
use crate::contact::parameter::numbers;
use crate::contact::slip_element::SlipElement;
use crate::contact::{Parameters, PointState};
use crate::Error;
use faer::{Mat, MatRef, Side};

/// Asymmetry, and negative eigenvalues, relative to the largest entry, that printed digits may
/// leave in a stiffness.
const PRINTED: f64 = 1e-6;
/// The same that rounding may leave.
const ROUNDING: f64 = 1e-12;

/// A massless elastic damper with several slipping contacts.
#[derive(Debug, Clone)]
pub struct StructuralDamper {
    pub(crate) stiffness: Mat<f64>,
    pub(crate) limits: Vec<f64>,
    pub(crate) elastic: Elastic,
    /// The stiffness that it was built with, and the factor on it.
    pub(super) unit: Mat<f64>,
    pub(super) factor: f64,
}

impl StructuralDamper {
    /// A damper of stiffness D [N/m], points × points, and slip limits F \[N\]; infinite ones never
    /// slip, those of 0 are without friction.
    ///
    /// # Errors
    /// D not square, finite, symmetric and positive semidefinite; other than one limit per point,
    /// negative or NaN limits.
    pub fn new(stiffness: MatRef<'_, f64>, limits: &[f64]) -> Result<Self, Error> {
        let points = stiffness.nrows();
        if points == 0 || stiffness.ncols() != points {
            let got = format!("{points} x {}", stiffness.ncols());
            return Err(Error::shape("structural: stiffness", "a square matrix", got));
        }
        if limits.len() != points {
            let expected = format!("{points}, one per contact");
            return Err(Error::shape("structural: slip_forces", expected, limits.len()));
        }
        let limits = Self::checked(limits)?;
        let at = |i: usize, j: usize| stiffness[(i, j)];
        let pairs = || (0..points).flat_map(|i| (0..points).map(move |j| (i, j)));
        if let Some((i, j)) = pairs().find(|&(i, j)| !at(i, j).is_finite()) {
            let entry = format!("structural: stiffness[{i}, {j}]");
            return Err(Error::value(entry, at(i, j), "must be finite"));
        }
        let largest = pairs().fold(0.0_f64, |m, (i, j)| m.max(at(i, j).abs()));
        let skew = |(i, j): (usize, usize)| (at(i, j) - at(j, i)).abs() > PRINTED * largest;
        if let Some((i, j)) = pairs().find(|&pair| skew(pair)) {
            let remedy = format!("must equal stiffness[{j}, {i}] = {}", at(j, i));
            let entry = format!("structural: stiffness[{i}, {j}]");
            return Err(Error::value(entry, at(i, j), &remedy));
        }
        let symmetric = Mat::from_fn(points, points, |i, j| 0.5 * (at(i, j) + at(j, i)));
        let lowest = symmetric
            .self_adjoint_eigenvalues(Side::Lower)
            .map_err(|_| Error::Eigenvalues("structural: stiffness".to_owned()))?
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        if lowest < -PRINTED * largest {
            return Err(Error::value(
                "structural: lowest eigenvalue of stiffness",
                lowest,
                "must not be negative, for the damper would give energy away; check its signs and digits",
            ));
        }
        let elastic = Elastic::new(symmetric.as_ref())?;
        // What printed digits have left of negative eigenvalues is not in the elastic forces.
        let symmetric = if lowest < -ROUNDING * largest {
            elastic.root() * elastic.root().transpose()
        } else {
            symmetric
        };
        Ok(Self { unit: symmetric.clone(), stiffness: symmetric, limits, elastic, factor: 1.0 })
    }

    /// Slip limits as they may be.
    pub(super) fn checked(limits: &[f64]) -> Result<Vec<f64>, Error> {
        let bad = limits.iter().position(|limit| limit.is_nan() || *limit < 0.0);
        bad.map_or_else(
            || Ok(limits.to_vec()),
            |i| {
                Err(Error::value(
                    format!("structural: slip_forces[{i}]"),
                    limits[i],
                    "must not be negative; infinity means that the contact never slips",
                ))
            },
        )
    }

    pub(crate) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let limits = numbers("structural", parameters, "slip_forces")?;
        let entries = numbers("structural", parameters, "stiffness")?;
        let points = limits.len();
        if entries.len() != points * points {
            let expected = format!("{points} x {points} numbers, row by row");
            return Err(Error::shape("structural: stiffness", expected, entries.len()));
        }
        let stiffness = Mat::from_fn(points, points, |i, j| entries[i * points + j]);
        Self::new(stiffness.as_ref(), limits)
    }

    fn reduced(&self, states: &[PointState]) -> ReducedStiffness {
        let moves = states.iter().zip(&self.limits);
        let slips: Vec<bool> =
            moves.map(|(state, limit)| *state != PointState::Stuck || *limit == 0.0).collect();
        self.elastic.reduced(&slips)
    }
}

impl SlipElement for StructuralDamper {
    fn stiffness(&self) -> Mat<f64> {
        self.stiffness.clone()
    }

    fn limits(&self) -> Vec<f64> {
        self.limits.clone()
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        self.reduced(points).tangent
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        self.reduced(points).slip_rate
    }

    fn increment(
        &self,
        before: &[f64],
        after: &[f64],
        force: &mut [f64],
        gain: Option<&mut [f64]>,
    ) {
        let known = force.to_vec();
        let du = || after.iter().zip(before).map(|(after, before)| after - before).enumerate();
        for (i, force) in force.iter_mut().enumerate() {
            *force += du().map(|(j, du)| self.stiffness[(i, j)] * du).sum::<f64>();
        }
        let mut increment = Increment::new(&self.stiffness, &self.limits);
        increment.solve(&known, force);
        if let Some(gain) = gain {
            increment.gain(gain);
        }
    }
}

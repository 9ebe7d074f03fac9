//! What a solution of the condensed equations means: displacements, forces, slip and errors.

use super::accuracy::{errors, Extension};
use super::condensed::Condensed;
use super::forced::ForcedBalance;
use super::sampling::{finer_than, sampling_errors};
use super::settings::Method;
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use crate::contact::PointSummary;
use crate::fourier::Harmonics;
use crate::solve::System as _;
use crate::Error;
use faer::c64;

impl ForcedBalance<'_> {
    /// Displacements, contact forces and slip shares of a solution.
    pub(super) fn recover(
        &self,
        equations: &Condensed<'_>,
        omega: f64,
        x: &[f64],
        status: PointStatus,
    ) -> Result<Point, Error> {
        let harmonics = equations.harmonics();
        let model = equations.model;
        let contacts = model.compliance().contacts();
        let orders = harmonics.highest() + 1;
        let mut point = Point::empty(omega, status, self.observe.len(), contacts);
        point.harmonics = harmonics.highest();
        let zero = c64::new(0.0, 0.0);
        point.displacement = vec![zero; self.observe.len() * orders];
        point.contact_displacement = vec![zero; contacts * orders];
        point.contact_force = vec![zero; contacts * orders];
        let slip_load = equations.slip_load();
        let stiffness = model.contact_stiffness();
        equations.displacements(x, &slip_load, self.observe, |order, observed, u, q| {
            for (i, value) in observed.iter().enumerate() {
                point.displacement[i * orders + order] = *value;
            }
            // A contact's stiffness couples its own points alone.
            let points = model.points().iter().flat_map(|p| p.clone().map(move |i| (i, p)));
            for (i, own) in points {
                let stuck: c64 = own.clone().map(|j| u[j] * stiffness[(i, j)]).sum();
                point.contact_displacement[i * orders + order] = u[i];
                point.contact_force[i * orders + order] = stuck - q[i];
            }
        })?;
        let mut summaries = vec![PointSummary::default(); contacts];
        for (index, law) in model.laws().iter().enumerate() {
            let range = model.points()[index].clone();
            law.summary(equations.motion(index, x), &mut summaries[range]);
        }
        point.contacts = summaries;
        Ok(point)
    }

    /// Writes the error estimate of a solution `x` of these equations; `false` if the analysis is to
    /// end.
    pub(super) fn estimate(
        &mut self,
        equations: &mut Condensed<'_>,
        x: &[f64],
        point: &mut Point,
    ) -> Result<bool, Error> {
        let done = self.estimate_truncation(equations.harmonics(), x, Some(&*equations), point)?;
        let Some(samples) = point.samples.filter(|_| done) else { return Ok(done) };
        if self.settings.method != Method::Newton {
            // Broyden's method leaves no tangent at the solution.
            equations.residual(x, &mut vec![0.0; x.len()]);
        }
        let finer = self.evaluated(Some(finer_than(samples)))?;
        point.sampling_error = sampling_errors(equations, &finer, x, self.observe, point)?;
        let errors = point.error_estimate.iter_mut().zip(&point.sampling_error);
        errors.for_each(|(error, sampling)| *error += sampling);
        Ok(true)
    }

    /// Writes what the discarded harmonics could change in a solution `x`, of these equations if
    /// they are at hand; `false` if the analysis is to end.
    pub(super) fn estimate_truncation(
        &mut self,
        harmonics: &Harmonics,
        x: &[f64],
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
    ) -> Result<bool, Error> {
        point.error_estimate = vec![0.0; self.observe.len()];
        point.sampling_error = vec![0.0; self.observe.len()];
        let slipping = point.contacts.iter().filter(|c| c.slip_fraction > 0.0).count();
        if slipping == 0 {
            return Ok(true);
        }
        // Few samples, as long as nobody insists on them, must not hide harmonics.
        let climb = self.ladder.samples_climb();
        let resolved = if climb { usize::MAX } else { self.evaluated(point.samples)?.resolves() };
        let observed = self.observe.len();
        let extension = Extension::new(harmonics, point.omega, self.model, slipping, observed);
        let extension = extension.within(resolved);
        let order = extension.highest;
        let least = if climb { (8 * (order + 1)).next_power_of_two() } else { 0 };
        let model = self.evaluated(point.samples.map(|samples| samples.max(least)))?;
        let table = self.table(order);
        let solution = Unknowns { harmonics: harmonics.clone(), values: x.to_vec() };
        let residual = self.settings.residual;
        let ask = self.interruption();
        let errors = errors(
            &model,
            &table,
            residual,
            &solution,
            self.observe,
            point,
            solved,
            &extension,
            &ask,
        )?;
        let done = errors.is_some();
        point.error_estimate = errors.unwrap_or_else(|| vec![f64::NAN; observed]);
        Ok(done)
    }
}

//! A point of a balance whose harmonics are those of the exact orbit: where stiff contacts or low
//! frequencies ask for so many that the balance equations cost more than the orbit.

use super::condensed::Condensed;
use super::forced::ForcedBalance;
use super::ladder::Resolution;
use super::scale::OF_HARMONICS;
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use super::ContactHarmonics;
use crate::solve::{norm, System as _};
use crate::Error;
use faer::c64;

impl ForcedBalance<'_> {
    /// The point at `omega` [rad/s] from the exact orbit, with at least the harmonics of `least`
    /// and as many as the tolerance asks for; `None` if there is no orbit.
    pub(super) fn from_orbit(
        &mut self,
        omega: f64,
        least: Resolution,
    ) -> Result<Option<Point>, Error> {
        let highest = self.settings.max_harmonics;
        let Some(orbit) = (self.rescue)(omega, highest) else { return Ok(None) };
        let mut order = least.harmonics;
        loop {
            let Some(mut point) = self.point_of(omega, order, &orbit)? else {
                return Ok(None);
            };
            let errors = point.error_estimate.iter().copied();
            let error = self.scale.relative(&point, OF_HARMONICS, errors);
            if error <= self.settings.tolerance || order >= highest {
                if error > self.settings.tolerance {
                    point.status = PointStatus::HarmonicsLimit;
                }
                self.profile.orbits += 1;
                self.scale.include(&point);
                return Ok(Some(point));
            }
            order = (order + order / 2).min(highest);
        }
    }

    /// The point with the harmonics up to `order` of an orbit that is known up to the highest one.
    fn point_of(
        &mut self,
        omega: f64,
        order: usize,
        orbit: &ContactHarmonics,
    ) -> Result<Option<Point>, Error> {
        let table = self.table(order);
        let model = self.evaluated(None)?;
        let mut equations = Condensed::new(&model, &table, self.settings.residual, false);
        if equations.set_omega(omega).is_err() {
            return Ok(None);
        }
        let harmonics = equations.harmonics();
        let mut x = vec![0.0; equations.size()];
        let all = self.settings.max_harmonics + 1;
        let points = orbit.displacement.chunks_exact(all);
        for (amplitudes, series) in points.zip(x.chunks_exact_mut(harmonics.slots())) {
            harmonics.write_series(amplitudes, series);
        }
        let mut left = vec![0.0; x.len()];
        equations.value(&x, &mut left);
        let mut point = self.recover(&equations, omega, &x, PointStatus::Converged)?;
        // The forces of stiff contacts are those of the orbit: the displacements that are left out
        // would change them.
        let contacts = model.compliance().contacts();
        let forces = &orbit.force;
        let mut load = vec![0.0; x.len()];
        for (row, series) in load.chunks_exact_mut(harmonics.slots()).enumerate() {
            let slip_load: Vec<c64> = (0..=order)
                .map(|k| {
                    let stuck: c64 = (0..contacts)
                        .map(|j| {
                            orbit.displacement[j * all + k] * model.contact_stiffness()[(row, j)]
                        })
                        .sum();
                    stuck - forces[row * all + k]
                })
                .collect();
            harmonics.write_series(&slip_load, series);
            point.contact_force[row * (order + 1)..(row + 1) * (order + 1)]
                .copy_from_slice(&forces[row * all..=row * all + order]);
        }
        equations.displacements(&x, &load, self.observe, |k, observed, _, _| {
            for (dof, value) in observed.iter().enumerate() {
                point.displacement[dof * (order + 1) + k] = *value;
            }
        })?;
        point.residual = norm(&left) / norm(&x).max(f64::MIN_POSITIVE);
        // Slip loads fall with the square of the order, and beyond the last mode the compliance does
        // so too: all harmonics beyond H move a DOF less than those from H/2 to H do.
        let beyond = |series: &[c64]| series[order / 2 + 1..].iter().map(|x| x.norm()).sum();
        point.error_estimate = point.displacement.chunks_exact(order + 1).map(beyond).collect();
        point.sampling_error = vec![0.0; point.error_estimate.len()];
        point.unknowns = Some(Unknowns { harmonics: harmonics.clone(), values: x });
        Ok(Some(point))
    }
}

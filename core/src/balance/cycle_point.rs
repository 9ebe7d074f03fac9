//! What is read off a limit cycle of the harmonic balance: displacements, forces, error.

use super::limit_cycle::CycleBalance;
use super::solution::{Point, PointStatus};
use super::unknowns::gather;
use crate::contact::PointSummary;
use crate::fourier::{Harmonics, SampleTable};
use crate::solve::Curve as _;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};

impl CycleBalance<'_> {
    /// Motion, forces and friction work at a point of the curve, with t = 0 at the maximum of the
    /// DOF `phase`.
    pub fn point(&mut self, z: &[f64], phase: usize) -> Point {
        let (dofs, contacts) = {
            let compliance = self.family.destabilised();
            (compliance.dofs(), compliance.contacts())
        };
        let [.., omega, _] = z else {
            return Point::empty(f64::NAN, PointStatus::Stalled, dofs, contacts);
        };
        if !self.evaluate(z) {
            return Point::empty(*omega, PointStatus::Stalled, dofs, contacts);
        }
        let harmonics = self.table.harmonics();
        let orders = harmonics.highest() + 1;
        let mut point = Point::empty(*omega, PointStatus::Converged, dofs, contacts);
        point.harmonics = harmonics.highest();
        point.displacement = vec![c64::new(0.0, 0.0); dofs * orders];
        point.contact_displacement = vec![c64::new(0.0, 0.0); contacts * orders];
        point.contact_force = vec![c64::new(0.0, 0.0); contacts * orders];
        point.error_estimate = vec![f64::NAN; dofs];
        let u = &z[..z.len() - 2];
        let load = self.slip_load();
        for (order, x, u, f) in self.amplitudes(*omega, u, &load) {
            for (series, values) in [
                (&mut point.displacement, x),
                (&mut point.contact_displacement, u),
                (&mut point.contact_force, f),
            ] {
                for (row, value) in values.into_iter().enumerate() {
                    series[row * orders + order] = value;
                }
            }
        }
        if let Some(at) = &self.at {
            for (index, law) in at.laws.iter().enumerate() {
                let range = self.family.model().points()[index].clone();
                let mut summary = vec![PointSummary::default(); range.len()];
                law.summary(self.motion(index, u), &mut summary);
                point.contacts[range].copy_from_slice(&summary);
            }
        }
        point.unknowns = Some(self.series(z));
        turn(&mut point, self.table, phase);
        point
    }

    /// Displacements of the DOFs and the contacts and contact forces, harmonic by harmonic.
    #[allow(clippy::type_complexity)]
    fn amplitudes(
        &self,
        omega: f64,
        u: &[f64],
        load: &[f64],
    ) -> Vec<(usize, Vec<c64>, Vec<c64>, Vec<c64>)> {
        let Some(at) = &self.at else { return Vec::new() };
        let harmonics = self.table.harmonics();
        let compliance = self.family.destabilised();
        let (mut own, mut q) = (Vec::new(), Vec::new());
        let mut out = Vec::new();
        for order in harmonics.orders() {
            gather(harmonics, order, u, &mut own);
            gather(harmonics, order, load, &mut q);
            let stiffness = at.stiffness.as_ref();
            let x = compliance.displacement(order, omega, at.ratio, stiffness, &own, &q);
            let force = |i: usize| -> c64 {
                let stuck: c64 = (0..own.len()).map(|j| own[j] * stiffness[(i, j)]).sum();
                stuck - q[i]
            };
            let f = (0..own.len()).map(force).collect();
            out.push((order, x, own.clone(), f));
        }
        out
    }

    /// What harmonics above those kept would change at every DOF [m]: one Newton step of a balance
    /// extended by them, across the curve.
    pub fn errors(&self, z: &[f64], along: &[f64], extended: &SampleTable) -> Vec<f64> {
        let dofs = self.family.destabilised().dofs();
        let infinite = vec![f64::INFINITY; dofs];
        let (from, to) = (self.table.harmonics(), extended.harmonics());
        let recast = |z: &[f64]| -> Vec<f64> {
            let (u, rest) = z.split_at(z.len() - 2);
            let mut values = recast(from, to, u);
            values.extend_from_slice(rest);
            values
        };
        let (start, direction) = (recast(z), recast(along));
        let mut curve = CycleBalance::new(self.family, extended, &start, &|| false);
        let size = curve.unknowns();
        let mut right = vec![0.0; size];
        curve.residual(&start, &mut right[..size - 1]);
        let mut matrix = Mat::<f64>::zeros(size, size);
        curve.jacobian(&start, &mut matrix);
        let weights = curve.weights(&start);
        for j in 0..size {
            matrix[(size - 1, j)] = weights[j].powi(2) * direction[j];
            for i in 0..size {
                matrix[(i, j)] /= weights[j];
            }
        }
        let mut step = Mat::from_fn(size, 1, |i, _| -right[i]);
        matrix.partial_piv_lu().solve_in_place(&mut step);
        let step: Vec<f64> = (0..size).map(|i| step[(i, 0)] / weights[i]).collect();
        if !step.iter().all(|s| s.is_finite()) {
            return infinite;
        }
        let before = curve.displacements(&start);
        let moved: Vec<f64> = start.iter().zip(&step).map(|(z, s)| z + s).collect();
        let after = curve.displacements(&moved);
        let mut errors = vec![0.0; dofs];
        for ((order, before), (_, after)) in before.iter().zip(&after) {
            // The extended motion at the kept unknowns is already that of more harmonics.
            let kept = *order <= from.highest();
            for (dof, error) in errors.iter_mut().enumerate() {
                let known = if kept { before[dof] } else { c64::new(0.0, 0.0) };
                *error += (after[dof] - known).norm();
            }
        }
        errors
    }

    fn displacements(&mut self, z: &[f64]) -> Vec<(usize, Vec<c64>)> {
        let [u @ .., omega, _] = z else { return Vec::new() };
        if !self.evaluate(z) {
            return Vec::new();
        }
        let load = self.slip_load();
        self.amplitudes(*omega, u, &load).into_iter().map(|(order, x, ..)| (order, x)).collect()
    }
}

/// ParameterMode harmonics of a series laid out for one set, in another.
pub(super) fn recast(from: &Harmonics, to: &Harmonics, values: &[f64]) -> Vec<f64> {
    super::Unknowns::new(from.clone(), values.to_vec()).recast(to)
}

/// Moves t = 0 to the maximum of a DOF.
fn turn(point: &mut Point, table: &SampleTable, phase: usize) {
    let harmonics = table.harmonics();
    let orders = point.harmonics + 1;
    let mut series = vec![0.0; harmonics.slots()];
    harmonics.write_series(&point.displacement[phase * orders..][..orders], &mut series);
    let mut turns = Vec::new();
    table.turning_points(&series, &mut turns);
    let mirrored = harmonics.half_wave();
    let highest = turns
        .iter()
        .map(|t| {
            let below = mirrored && t.value < 0.0;
            let shift = if below { std::f64::consts::PI } else { 0.0 };
            (t.theta + shift, if below { -t.value } else { t.value })
        })
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((theta, _)) = highest else { return };
    for series in
        [&mut point.displacement, &mut point.contact_displacement, &mut point.contact_force]
    {
        for row in series.chunks_exact_mut(orders) {
            for (order, value) in row.iter_mut().enumerate() {
                *value *= c64::from_polar(1.0, order as f64 * theta);
            }
        }
    }
}

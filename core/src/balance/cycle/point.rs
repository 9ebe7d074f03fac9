//! What is read off a limit cycle of the harmonic balance: displacements, forces, error.

use super::balance::{CycleBalance, Evaluation};
use crate::balance::attempts::is_balanced;
use crate::balance::solution::{Point, PointStatus};
use crate::fourier::{Harmonics, SampleTable};
use crate::solve::{norm, Curve as _, NewtonSettings};
use crate::structure::Quantity;
use faer::c64;

impl CycleBalance<'_> {
    /// Motion, forces and friction work at a point of the curve, with t = 0 at the maximum of the
    /// DOF `phase`; it says so if its equations do not hold.
    pub fn point(&mut self, z: &[f64], phase: usize) -> Point {
        let compliance = self.family.compliance();
        let observe: Vec<usize> = (0..compliance.dofs()).collect();
        let (u, omega) = (&z[..z.len() - 2], z[z.len() - 2]);
        let recovered = self.evaluate(z).and_then(|at| {
            let residual = norm(&at.residual) / norm(u).max(f64::MIN_POSITIVE);
            let balanced = is_balanced(residual, NewtonSettings::default());
            let status = if balanced { PointStatus::Converged } else { PointStatus::Stalled };
            let point = at.equations.recover(u, &observe, status).ok()?;
            Some(Point { residual, ..point })
        });
        let Some(mut point) = recovered else {
            let contacts = compliance.contacts();
            return Point::empty(omega, PointStatus::Stalled, observe.len(), contacts);
        };
        point.unknowns = Some(self.series(z));
        turn(&mut point, self.table, phase);
        point
    }

    /// What harmonics above those kept would change at every DOF \[m\]: one Newton step of a balance
    /// extended by them, across the curve.
    pub fn errors(&self, z: &[f64], along: &[f64], extended: &SampleTable) -> Vec<f64> {
        let dofs = self.family.compliance().dofs();
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
        right.iter_mut().for_each(|r| *r = -*r);
        let weights = curve.weights(&start);
        let border: Vec<f64> = weights.iter().zip(&direction).map(|(w, d)| w.powi(2) * d).collect();
        let Some((step, _)) = curve.solve_bordered(&start, &border, &right, &weights) else {
            return infinite;
        };
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
        let dofs: Vec<usize> = (0..self.family.compliance().dofs()).collect();
        let Some(Evaluation { equations, .. }) = self.evaluate(z) else { return Vec::new() };
        let motion = [&z[..z.len() - 2], &equations.slip_load()];
        let mut out = Vec::new();
        let store = |order: usize, x: &[c64], _: &[c64], _: &[c64]| out.push((order, x.to_vec()));
        match equations.displacements(Quantity::Whole, motion, &dofs, store) {
            Ok(()) => out,
            Err(_) => Vec::new(),
        }
    }
}

/// Common harmonics of a series laid out for one set, in another.
pub(super) fn recast(from: &Harmonics, to: &Harmonics, values: &[f64]) -> Vec<f64> {
    crate::balance::Unknowns::new(from.clone(), values.to_vec()).recast(to)
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

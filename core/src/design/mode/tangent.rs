//! The tangent of the equations of a nonlinear mode: they are those of a curve.

use super::condensed::Condensed;
use super::equations::{dynamic, ModeEquations};
use super::feed::Feed;
use crate::solve::{norm, Curve};
use std::time::Instant;

impl ModeEquations<'_> {
    /// Rates of the rows of modes in ω, ξ or the force, and ln a, in their units, at the point evaluated last.
    pub(super) fn scalar_rates(&self, z: &[f64]) -> [Vec<f64>; 3] {
        let [omega, excess, _] = self.scalars(z);
        let size = z.len() - 3;
        let unit = self.unit;
        let mut rates = [(); 3].map(|()| vec![0.0; size]);
        let by_omega = |order: usize| {
            let k = order as f64 * unit;
            [0.0, 2.0 * k * order as f64 * omega, k, k * excess]
        };
        let by_excess = |order: usize| [0.0, 0.0, 0.0, order as f64 * omega * unit];
        self.add_structure(&z[..size], by_omega, &mut rates[0]);
        match &self.feed {
            Feed::Damping => self.add_structure(&z[..size], by_excess, &mut rates[1]),
            Feed::Force(shape, _) => {
                Feed::add_force(shape, -unit.powi(2), &mut rates[1][self.range(1)]);
            }
        }
        // All amplitudes grow alike, and the residual counts in units of a.
        self.add_modal_product(z, &z[..size], &mut rates[2]);
        if let Feed::Force(shape, _) = &self.feed {
            let force = -z[size + 1] * unit.powi(2);
            Feed::add_force(shape, force, &mut rates[2][self.range(1)]);
        }
        rates
    }

    /// Adds the product of the rows of modes with a change of the amplitudes.
    fn add_modal_product(&self, z: &[f64], change: &[f64], rows: &mut [f64]) {
        let [omega, excess, _] = self.scalars(z);
        self.add_structure(change, |order| dynamic(order, omega, excess), rows);
        let load = self.load_change(&self.at_contacts(change, 1.0, false));
        self.subtract_forces(&load, 1.0, rows);
        if self.harmonics().has_mean() {
            let (basis, range) = (self.basis(0), self.range(0));
            for (j, row) in rows[range].iter_mut().enumerate() {
                *row = if basis.free[j] { change[j] } else { *row };
            }
        }
    }

    /// Change of the slip loads by one of the contact displacements, both point after point.
    pub(super) fn load_change(&self, moved: &[f64]) -> Vec<f64> {
        let slots = self.harmonics().slots();
        let mut load = vec![0.0; moved.len()];
        for (own, points) in self.loads.iter().zip(self.model.points()) {
            if own.active {
                let range = points.start * slots..points.end * slots;
                let rows = own.tangent.chunks_exact(range.len());
                for (q, row) in load[range.clone()].iter_mut().zip(rows) {
                    *q = row.iter().zip(&moved[range.clone()]).map(|(t, u)| t * u).sum();
                }
            }
        }
        load
    }
}

impl Curve for ModeEquations<'_> {
    fn unknowns(&self) -> usize {
        self.size()
    }

    /// The parameter is a logarithm, which vanishes somewhere: all unknowns are compared as a whole.
    fn scalars(&self, z: &[f64]) -> usize {
        z.len()
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.evaluate(z));
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        _weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        if self.at != z {
            self.evaluate(z);
        }
        let start = Instant::now();
        let mut right = right.to_vec();
        right.iter_mut().zip(&self.scales).for_each(|(row, scale)| *row /= scale);
        let mut preconditioner = self.preconditioner.take();
        let solved = Condensed::new(self, border).solve(&right, &mut preconditioner);
        self.preconditioner = preconditioner;
        self.profile.linear_solve += start.elapsed();
        let solved = solved?;
        self.profile.products += solved.products;
        self.profile.factorisations += solved.factorisations;
        Some((solved.step, solved.sign))
    }

    /// The mean counts in units of the amplitude, but may be as large as the displacement at rest.
    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let mut weights = vec![1.0; z.len()];
        if self.harmonics().has_mean() {
            let [.., amplitude] = self.scalars(z);
            let range = self.range(0);
            let mean = norm(&z[range.clone()]).max(norm(&self.rest) / amplitude);
            weights[range].fill(mean.max(1.0).recip());
        }
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.hold(z);
    }

    fn interrupted(&self) -> bool {
        self.is_interrupted()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, Coulomb, Jenkins, Residual};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::model::Contact;
    use crate::model::Model;
    use crate::solve::factorised;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};
    use std::sync::Arc;

    #[test]
    fn tangents_match_differences() {
        let structure = Structure::new(
            mat![[2.0, 0.1], [0.1, 1.0]].as_ref(),
            mat![[0.5, -0.1], [0.2, 0.4]].as_ref(),
            mat![[300.0, -100.0], [-100.0, 150.0]].as_ref(),
        )
        .unwrap();
        let pad = Coulomb::new(1, 0.4, 80.0, Some(120.0), Closure::Preload(0.5)).unwrap();
        let contacts = vec![
            Contact { law: Box::new(pad), rows: mat![[1.0, 0.0], [0.0, 1.0]] },
            Contact { law: Box::new(Jenkins::new(60.0, 0.2).unwrap()), rows: mat![[1.0, -1.0]] },
        ];
        let load = vec![c64::new(0.1, 0.0), c64::new(-0.2, 0.0)];
        let load = HarmonicLoad { harmonic: 0, amplitude: load };
        let model = Model::new(structure, contacts, vec![load]).unwrap();
        let table = Arc::new(SampleTable::new(Harmonics::new(3, false)));
        let bases = model.modal_bases(3).unwrap();
        let residuals = vec![Residual::Centred; 2];
        let force = vec![c64::new(0.6, 0.0), c64::new(0.0, 0.8)];
        for feed in [Feed::Damping, Feed::Force(force, 1.0)] {
            let (bases, residuals) = (bases.clone(), residuals.clone());
            let rest = vec![1e-3, -2e-3];
            let table = Arc::clone(&table);
            let mut equations =
                ModeEquations::new(&model, bases, table, residuals, rest, feed, &|_| true);
            equations.unit = 10.0;
            check(equations);
        }
    }

    fn jacobian(equations: &mut ModeEquations<'_>, z: &[f64]) -> Mat<f64> {
        let size = z.len() - 3;
        equations.evaluate(z);
        let mut out = Mat::zeros(z.len(), z.len());
        for j in 0..size {
            let (mut unit, mut column) = (vec![0.0; size], vec![0.0; size]);
            unit[j] = 1.0;
            equations.add_modal_product(z, &unit, &mut column);
            (0..size).for_each(|i| out[(i, j)] = equations.scales[i] * column[i]);
        }
        for (j, rate) in equations.scalar_rates(z).iter().enumerate() {
            (0..size).for_each(|i| out[(i, size + j)] = equations.scales[i] * rate[i]);
        }
        for (j, row) in equations.range(1).zip(&equations.phase) {
            (out[(size, j)], out[(size + 1, j)]) = (z[j], *row);
        }
        out
    }

    fn check(mut equations: ModeEquations<'_>) {
        let size = equations.size();
        let mut z: Vec<f64> = (0..size).map(|i| 0.3 * (1.0 + 1.7 * i as f64).sin()).collect();
        (z[size - 3], z[size - 2], z[size - 1]) = (1.1, 0.03, 0.01_f64.ln());
        let mut other = z.clone();
        other[3] += 0.2;
        equations.hold(&other);
        let residual = equations.evaluate(&z);
        assert!(equations.loads.iter().all(|load| load.active));
        let mut matrix = jacobian(&mut equations, &z);
        for j in 0..size {
            let h = 1e-6;
            let mut at = |by: f64| {
                let mut moved = z.clone();
                moved[j] += by;
                equations.evaluate(&moved)
            };
            let (ahead, behind) = (at(h), at(-h));
            for i in 0..size - 1 {
                let mut difference = (ahead[i] - behind[i]) / (2.0 * h);
                if j == size - 1 && i < size - 3 {
                    // The rate in ln a leaves out what vanishes with the residual.
                    difference += residual[i];
                }
                let (own, scale) = (matrix[(i, j)], matrix[(i, j)].abs().max(1.0));
                assert!((difference - own).abs() < 1e-6 * scale, "{i} {j} {difference} {own}");
            }
        }
        // The condensed equations have the solution and the orientation of the whole.
        let border: Vec<f64> = (0..size).map(|i| (0.4 + 0.9 * i as f64).cos()).collect();
        let right: Vec<f64> = (0..size).map(|i| (2.0 + 1.3 * i as f64).sin()).collect();
        border.iter().enumerate().for_each(|(j, entry)| matrix[(size - 1, j)] = *entry);
        let ones = vec![1.0; size];
        let (whole, orientation) = factorised(&mut matrix, &right, &ones).unwrap();
        let (step, sign) = equations.solve_bordered(&z, &border, &right, &ones).unwrap();
        assert_eq!(sign, orientation);
        for (a, b) in step.iter().zip(&whole) {
            assert!((a - b).abs() < 1e-9 * norm(&whole), "{a} {b}");
        }
    }
}

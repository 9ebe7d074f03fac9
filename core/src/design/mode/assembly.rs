//! The matrices of the condensed equations of a nonlinear mode: of all slip loads that change, or of those of
//! one harmonic. The tangents of the contacts meet the receptances of the stuck structure, harmonic by
//! harmonic.

use super::condensed::{Condensed, Inverse};
use super::preconditioner::Preconditioner;
use faer::{c64, Mat};

impl Condensed<'_, '_> {
    /// The tangents within each harmonic, factorised.
    pub(super) fn preconditioner(&self) -> Preconditioner {
        let mut blocks = Vec::new();
        for (order, inverse) in &self.inverses {
            let places = self.places(*order);
            let responses = self.responses(*order, inverse, [&places, &places]);
            let matrix = Mat::<f64>::identity(places.len(), places.len()) - responses;
            let loads = places.iter().map(|place| self.active[*place]).collect();
            blocks.push((loads, matrix.partial_piv_lu()));
        }
        Preconditioner { blocks, products: 0 }
    }

    /// The matrix of the condensed equations.
    pub(super) fn matrix(&self) -> Mat<f64> {
        let (size, split) = (self.size(), self.active.len());
        let mut matrix = Mat::<f64>::zeros(size, size);
        (0..split).for_each(|i| matrix[(i, i)] = 1.0);
        let rows: Vec<usize> = (0..split).collect();
        for (order, inverse) in &self.inverses {
            let places = self.places(*order);
            let responses = self.responses(*order, inverse, [&rows, &places]);
            for (j, at) in places.iter().enumerate() {
                let column = matrix.col_mut(*at).subrows_mut(0, split);
                column.iter_mut().zip(responses.col(j).iter()).for_each(|(entry, r)| *entry -= r);
            }
        }
        for j in split..size {
            let mut unit = vec![0.0; size];
            unit[j] = 1.0;
            let column = self.product(&unit);
            matrix.col_mut(j).iter_mut().zip(&column).for_each(|(entry, row)| *entry = *row);
        }
        for (i, row) in self.last_rows().iter().enumerate() {
            row.iter().enumerate().for_each(|(j, entry)| matrix[(split + i, j)] = *entry);
        }
        matrix
    }

    /// What κ, amplitude, phase and border make of the slip loads: their rows, by adjoint solutions.
    pub(super) fn last_rows(&self) -> Vec<Vec<f64>> {
        let (equations, modes) = (self.equations, self.border.len() - 3);
        let range = equations.range(1);
        let mut functionals = vec![vec![0.0; modes]; self.kept.len() + 2];
        for (functional, (at, _)) in functionals.iter_mut().zip(&self.kept) {
            functional[*at] = -1.0;
        }
        for (i, own) in [&equations.at[range.clone()], &equations.phase].into_iter().enumerate() {
            functionals[self.kept.len() + i][range.clone()].copy_from_slice(own);
        }
        functionals.push(self.border[..modes].to_vec());
        let row = |mut functional: Vec<f64>| {
            self.divide(&mut functional, Inverse::apply_adjoint);
            if equations.harmonics().has_mean() {
                let free = &equations.basis(0).free;
                (0..free.len()).filter(|j| free[*j]).for_each(|j| functional[j] = 0.0);
            }
            let moved = equations.at_contacts(&functional, 1.0, false);
            self.active.iter().map(|at| moved[*at]).collect()
        };
        functionals.into_iter().map(row).collect()
    }

    /// Positions of the slip loads of an order.
    fn places(&self, order: usize) -> Vec<usize> {
        let harmonics = self.equations.harmonics();
        let (slots, Some(slot)) = (harmonics.slots(), harmonics.slot(order)) else {
            return Vec::new();
        };
        let width = if order > 0 { 2 } else { 1 };
        let own = |place: &usize| (slot..slot + width).contains(&(self.active[*place] % slots));
        (0..self.active.len()).filter(own).collect()
    }

    /// What slip loads of an order, the columns, change in those of the rows, by its receptance.
    fn responses(
        &self,
        order: usize,
        inverse: &Inverse,
        [rows, columns]: [&[usize]; 2],
    ) -> Mat<f64> {
        let equations = self.equations;
        let slots = equations.harmonics().slots();
        let slot = equations.harmonics().slot(order).unwrap_or(0);
        let points = equations.model.points();
        // Points of these contacts, and those that the columns load.
        let moving: Vec<usize> =
            self.own.iter().flat_map(|(index, _)| points[*index].clone()).collect();
        let mut loaded: Vec<usize> = columns.iter().map(|at| self.active[*at] / slots).collect();
        loaded.dedup();
        let receptance = self.receptance(order, inverse, [&moving, &loaded]);
        let width = if order > 0 { 2 } else { 1 };
        let mut out = Mat::<f64>::zeros(rows.len(), columns.len());
        let (mut row, mut first) = (0, 0);
        for (index, range) in &self.own {
            let begin = row;
            while row < rows.len() && range.contains(&rows[row]) {
                row += 1;
            }
            let (start, count) = (points[*index].start * slots, points[*index].len());
            let tangent = &equations.loads[*index].tangent;
            let size = count * slots;
            // The tangent at this order, row after row.
            let own: Vec<f64> = rows[begin..row]
                .iter()
                .flat_map(|at| {
                    let line = &tangent[(self.active[*at] - start) * size..][..size];
                    (0..count)
                        .flat_map(move |q| (0..width).map(move |b| line[q * slots + slot + b]))
                })
                .collect();
            let mut moved = vec![0.0; count * width];
            let mut load = 0;
            for (j, at) in columns.iter().enumerate() {
                let (point, part) = (self.active[*at] / slots, self.active[*at] % slots - slot);
                while loaded[load] != point {
                    load += 1;
                }
                for (q, moved) in moved.chunks_exact_mut(width).enumerate() {
                    let value = receptance[(first + q, load)];
                    // Cosines before sines: c − i s.
                    moved[0] = if part == 0 { value.re } else { value.im };
                    if let Some(sine) = moved.get_mut(1) {
                        *sine = if part == 0 { -value.im } else { value.re };
                    }
                }
                let changes = out.col_mut(j).subrows_mut(begin, row - begin);
                for (change, line) in changes.iter_mut().zip(own.chunks_exact(count * width)) {
                    *change = line.iter().zip(&moved).map(|(t, u)| t * u).sum();
                }
            }
            first += count;
        }
        out
    }

    /// `Ψ D⁻¹ Ψᴴ` between points.
    fn receptance(&self, order: usize, inverse: &Inverse, points: [&[usize]; 2]) -> Mat<c64> {
        let contacts = &self.equations.basis(order).contacts;
        match (contacts.as_real(), inverse) {
            (Some(shapes), Inverse::Diagonal(inverse)) => {
                let modes = shapes.ncols();
                let at = |of: &[usize]| Mat::from_fn(of.len(), modes, |i, j| shapes[(of[i], j)]);
                let [moving, loaded] = points.map(at);
                let part = |of: fn(&c64) -> f64| {
                    let scaled = Mat::from_fn(loaded.nrows(), modes, |i, j| {
                        loaded[(i, j)] * of(&inverse[j])
                    });
                    &moving * scaled.transpose()
                };
                let [real, imaginary] = [part(|d| d.re), part(|d| d.im)];
                Mat::from_fn(real.nrows(), real.ncols(), |i, j| {
                    c64::new(real[(i, j)], imaginary[(i, j)])
                })
            }
            _ => {
                let shapes = contacts.matrix();
                let at = |of: &[usize]| {
                    Mat::from_fn(of.len(), shapes.ncols(), |i, j| shapes[(of[i], j)])
                };
                let [moving, loaded] = points.map(at);
                let mut moved = loaded.adjoint().to_owned();
                inverse.apply(&mut moved);
                moving * moved
            }
        }
    }
}

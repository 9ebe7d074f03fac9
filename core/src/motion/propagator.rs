//! Disturbances over a stretch in which the equations are linear: the exponential of their matrix.

use super::exponential::exponential;
use super::modal_system::ContactState;
use super::transition::Transition;
use faer::Mat;

impl Transition<'_> {
    /// Takes disturbances, column by column, over a duration \[s\]. Strains that neither move nor are
    /// disturbed, those of contacts that slip under a constant limit, take no part.
    pub(super) fn advance(&self, regime: &ContactState, duration: f64, total: &mut Mat<f64>) {
        let first = 2 * self.weight.len();
        let rates = self.strain_rates(regime);
        let mut disturbed = vec![false; total.nrows()];
        let mut columns = Vec::with_capacity(total.ncols());
        for j in 0..total.ncols() {
            let column = total.col_as_slice(j);
            disturbed.iter_mut().zip(column).for_each(|(row, x)| *row |= *x != 0.0);
            if column.iter().any(|x| *x != 0.0) {
                columns.push(j);
            }
        }
        let moves =
            |row: usize| row < first || rates.iter().any(|(strain, _, _)| first + strain == row);
        let rows: Vec<usize> =
            (0..total.nrows()).filter(|&row| disturbed[row] || moves(row)).collect();
        let propagator = exponential(&self.generator(regime, &rates, &rows, duration));
        let before = Mat::from_fn(rows.len(), columns.len(), |i, j| total[(rows[i], columns[j])]);
        let after = propagator * before;
        for (j, &column) in columns.iter().enumerate() {
            for (i, &row) in rows.iter().enumerate() {
                total[(row, column)] = after[(i, j)];
            }
        }
    }

    /// `g' = L⁺ T u'` as strains, points and factors that are not 0.
    fn strain_rates(&self, regime: &ContactState) -> Vec<(usize, usize, f64)> {
        let mut all = Vec::new();
        for body in self.system.bodies() {
            for i in body.points.clone() {
                let column: Vec<f64> =
                    body.points.clone().map(|r| regime.tangent[(r, i)]).collect();
                let rates = body.elastic.strains(&column);
                let own = body.strains.clone().zip(rates).map(|(strain, rate)| (strain, i, rate));
                all.extend(own.filter(|(_, _, rate)| *rate != 0.0));
            }
        }
        all
    }

    /// Matrix of the linear equations, of the given rows alone, times a duration \[s\].
    fn generator(
        &self,
        regime: &ContactState,
        rates: &[(usize, usize, f64)],
        rows: &[usize],
        duration: f64,
    ) -> Mat<f64> {
        let (size, modes) = (rows.len(), self.weight.len());
        // All coordinates of the motion are rows, and stand first.
        let place = |strain: usize| rows[2 * modes..].binary_search(&(2 * modes + strain)).ok();
        let mut a = Mat::<f64>::zeros(size, size);
        for j in 0..modes {
            a[(j, modes + j)] = duration * self.weight[j];
            a[(modes + j, j)] = -duration * self.system.omega_squared()[j] / self.weight[j];
        }
        for j in 0..modes {
            for i in 0..modes {
                a[(modes + i, modes + j)] = -duration * self.system.damping.entry(i, j);
            }
        }
        for &point in &self.system.normals {
            let slope = duration * regime.tangent[(point, point)];
            let shape = self.system.contact_shape(point);
            for (j, b) in shape.iter().enumerate().filter(|_| slope != 0.0) {
                for (i, own) in shape.iter().enumerate() {
                    a[(modes + i, j)] -= own * slope * b / self.weight[j];
                }
            }
        }
        for body in self.system.bodies() {
            let strains = body.strains.clone().enumerate();
            for (own, place) in strains.filter_map(|(own, strain)| Some((own, place(strain)?))) {
                let column = &mut a.col_as_slice_mut(2 * modes + place)[modes..2 * modes];
                for (row, i) in body.points.clone().enumerate() {
                    let root = duration * body.elastic.root()[(row, own)];
                    let shape = self.system.contact_shape(i);
                    column.iter_mut().zip(shape).for_each(|(a, b)| *a -= b * root);
                }
            }
        }
        for (strain, i, rate) in rates {
            let Some(place) = place(*strain) else { continue };
            for (j, b) in self.system.contact_shape(*i).iter().enumerate() {
                a[(2 * modes + place, modes + j)] += duration * rate * b;
            }
        }
        a
    }
}

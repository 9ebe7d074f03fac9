//! Polynomials of the matrix of a few states in arrays: in matrices of such sizes most of the time goes into making
//! room for them.

use super::exponential::{Driven, Function};
use faer::Mat;

/// States and inputs that there is room for.
const STATES: usize = 8;
const INPUTS: usize = 4;

/// As [`Driven`], filled up with zeros.
#[derive(Debug, Clone, Copy)]
pub(super) struct FewStates {
    states: usize,
    /// Of states and inputs.
    count: usize,
    columns: [[f64; STATES]; STATES + INPUTS],
    kept: f64,
}

impl FewStates {
    /// Takes a polynomial over; nothing where there is no room.
    pub(super) fn of(driven: &Driven) -> Option<Self> {
        let (states, count) = (driven.rows.nrows(), driven.rows.ncols());
        if states > STATES || count - states > INPUTS {
            return None;
        }
        let mut columns = [[0.0; STATES]; STATES + INPUTS];
        for (j, column) in columns[..count].iter_mut().enumerate() {
            column[..states].copy_from_slice(driven.rows.col_as_slice(j));
        }
        Some(Self { states, count, columns, kept: driven.kept })
    }

    pub(super) fn driven(&self) -> Driven {
        let rows = Mat::from_fn(self.states, self.count, |i, j| self.columns[j][i]);
        Driven { rows, kept: self.kept }
    }

    fn columns(&self) -> &[[f64; STATES]] {
        &self.columns[..self.count]
    }
}

impl Function for FewStates {
    fn times(&self, other: &Self) -> Self {
        let mut product = Self { columns: [[0.0; STATES]; STATES + INPUTS], ..*self };
        product.kept = self.kept * other.kept;
        let own = &self.columns[..self.states];
        for (j, out) in product.columns[..self.count].iter_mut().enumerate() {
            for (own, factor) in own.iter().zip(&other.columns[j]) {
                out.iter_mut().zip(own).for_each(|(out, a)| *out += factor * a);
            }
            if j >= self.states {
                let own = &self.columns[j];
                out.iter_mut().zip(own).for_each(|(out, a)| *out += other.kept * a);
            }
        }
        product
    }

    fn combined<const N: usize>(constant: f64, factors: [f64; N], functions: [&Self; N]) -> Self {
        let none = [[0.0; STATES]; STATES + INPUTS];
        let mut sum = Self { columns: none, kept: constant, ..*functions[0] };
        (0..sum.states).for_each(|j| sum.columns[j][j] = constant);
        for (factor, own) in factors.iter().zip(functions).filter(|(factor, _)| **factor != 0.0) {
            sum.kept += factor * own.kept;
            let columns = sum.columns[..own.count].as_flattened_mut().iter_mut();
            columns.zip(own.columns().as_flattened()).for_each(|(out, a)| *out += factor * a);
        }
        sum
    }

    fn norm(&self) -> f64 {
        self.columns().as_flattened().iter().map(|a| a * a).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::exponential::exponential;
    use super::*;

    fn matrix(states: usize, inputs: usize, size: f64) -> Driven {
        let entry = |i: usize, j: usize| (1.3 + 3.1 * (i * (states + inputs) + j) as f64).sin();
        Driven::new(Mat::from_fn(states, states + inputs, |i, j| size * entry(i, j)))
    }

    #[test]
    fn exponentials_are_those_of_matrices() {
        for (states, inputs) in [(2, 0), (4, 1), (6, 2), (8, 4)] {
            for size in [1e-3, 0.1, 2.0] {
                let own = matrix(states, inputs, size);
                let few = FewStates::of(&own).unwrap();
                let found = exponential(&few, few.squared(), |power| few.times(power));
                let found = found.driven();
                let expected = exponential(&own, own.squared(), |power| own.times(power));

                let error = (&found.rows - &expected.rows).norm_max();
                assert!(error <= 1e-14 * expected.rows.norm_max(), "{states} {size} {error:e}");
                assert!((found.kept - expected.kept).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn more_states_or_inputs_have_no_room() {
        assert!(FewStates::of(&matrix(9, 0, 1.0)).is_none());
        assert!(FewStates::of(&matrix(4, 5, 1.0)).is_none());
    }
}

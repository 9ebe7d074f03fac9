//! Sums of multiples of the rows of a table, many samples at once.

use pulp::{Simd, WithSimd};

/// Samples that are summed together.
const LANES: usize = 16;

/// Length of a row of the table: whole vectors.
pub(super) fn padded(length: usize) -> usize {
    length.next_multiple_of(LANES)
}

/// Sums of multiples of rows that begin at the given positions, with the vector instructions there
/// are: one block of samples after the other, so that its sums stay in registers.
pub(super) struct RowSums<'a> {
    pub(super) tables: [&'a [f64]; 2],
    pub(super) rows: &'a [(usize, [f64; 2])],
    pub(super) sums: [&'a mut [f64]; 2],
}

impl WithSimd for RowSums<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (table, (i, sums)) in self.tables.into_iter().zip(self.sums.into_iter().enumerate()) {
            for (block, out) in sums.chunks_exact_mut(LANES).enumerate() {
                let (out, _) = S::as_mut_simd_f64s(out);
                let mut sum = [simd.splat_f64s(0.0); LANES];
                for (first, factors) in self.rows {
                    let factor = simd.splat_f64s(factors[i]);
                    let at = first + block * LANES;
                    let (row, _) = S::as_simd_f64s(&table[at..at + LANES]);
                    for (sum, value) in sum.iter_mut().zip(row) {
                        *sum = simd.mul_add_e_f64s(factor, *value, *sum);
                    }
                }
                out.copy_from_slice(&sum[..out.len()]);
            }
        }
    }
}

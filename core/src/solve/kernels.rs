//! Kernels of small dense matrices, with the vector instructions the processor has.
//!
//! Rows are padded to a multiple of [`PAD`] numbers, so that no loop has a remainder.

use pulp::{Arch, Simd, WithSimd};

/// Rows hold a multiple of this many numbers.
pub(super) const PAD: usize = 4;

/// Length of a row of `columns` numbers with its padding.
pub(super) fn padded(columns: usize) -> usize {
    columns.next_multiple_of(PAD)
}

/// `out −= a b` of padded matrices; `b` has `k` rows, as long as those of `out`.
pub(super) fn subtract_product(
    out: &mut [f64],
    a: &[f64],
    b: &[f64],
    [a_stride, k, stride]: [usize; 3],
) {
    if k > 0 && stride > 0 {
        Arch::new().dispatch(Product { out, a, b, a_stride, k, stride });
    }
}

/// Solves with LU factors in rows of `lu_stride` for a right-hand side in rows of `stride`, in
/// place, after its rows have been permuted.
pub(super) fn substitute(lu: &[f64], right: &mut [f64], [lu_stride, size, stride]: [usize; 3]) {
    if stride > 0 {
        Arch::new().dispatch(Substitution { lu, right, lu_stride, size, stride });
    }
}

/// LU factors of a square matrix in rows of `stride`, with row pivoting, in place; `pivots[i]` is
/// the row swapped with row i. A singular matrix gives factors that are not finite.
pub(super) fn factorise(a: &mut [f64], stride: usize, pivots: &mut [usize]) {
    Arch::new().dispatch(Factorisation { a, stride, pivots });
}

struct Product<'a> {
    out: &'a mut [f64],
    a: &'a [f64],
    b: &'a [f64],
    a_stride: usize,
    k: usize,
    stride: usize,
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { out, a, b, a_stride, k, stride } = self;
        let (out, _) = S::as_mut_simd_f64s(out);
        let (b, _) = S::as_simd_f64s(b);
        let width = stride / S::F64_LANES;
        let mut out = out.chunks_exact_mut(4 * width);
        let mut a = a.chunks_exact(4 * a_stride);
        for (out, a) in (&mut out).zip(&mut a) {
            rows::<S, 4>(simd, out, a, b, [a_stride, k, width]);
        }
        let left = out.into_remainder().chunks_exact_mut(width);
        for (out, a) in left.zip(a.remainder().chunks_exact(a_stride)) {
            rows::<S, 1>(simd, out, a, b, [a_stride, k, width]);
        }
    }
}

/// `out −= a b` of R rows.
#[inline(always)]
fn rows<S: Simd, const R: usize>(
    simd: S,
    out: &mut [S::f64s],
    a: &[f64],
    b: &[S::f64s],
    [a_stride, k, width]: [usize; 3],
) {
    let mut column = 0;
    while column < width {
        match width - column {
            1 => tile::<S, R, 1>(simd, out, a, b, [a_stride, k, width, column]),
            2 | 4 => tile::<S, R, 2>(simd, out, a, b, [a_stride, k, width, column]),
            _ => tile::<S, R, 3>(simd, out, a, b, [a_stride, k, width, column]),
        }
        column += match width - column {
            1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
    }
}

/// `out −= a b` of R rows and C vectors from a column on, summed in registers.
#[inline(always)]
fn tile<S: Simd, const R: usize, const C: usize>(
    simd: S,
    out: &mut [S::f64s],
    a: &[f64],
    b: &[S::f64s],
    [a_stride, k, width, column]: [usize; 4],
) {
    let mut sums = [[simd.splat_f64s(0.0); C]; R];
    let factors: [&[f64]; R] = std::array::from_fn(|r| &a[r * a_stride..r * a_stride + k]);
    for (p, row) in b.chunks_exact(width).take(k).enumerate() {
        let row = &row[column..column + C];
        for r in 0..R {
            let factor = simd.splat_f64s(factors[r][p]);
            for c in 0..C {
                sums[r][c] = simd.mul_add_e_f64s(factor, row[c], sums[r][c]);
            }
        }
    }
    for (out, sums) in out.chunks_exact_mut(width).zip(&sums) {
        for (out, sum) in out[column..column + C].iter_mut().zip(sums) {
            *out = simd.sub_f64s(*out, *sum);
        }
    }
}

struct Substitution<'a> {
    lu: &'a [f64],
    right: &'a mut [f64],
    lu_stride: usize,
    size: usize,
    stride: usize,
}

impl WithSimd for Substitution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { lu, right, lu_stride, size, stride } = self;
        let (right, _) = S::as_mut_simd_f64s(right);
        let width = stride / S::F64_LANES;
        for i in 1..size {
            let (above, below) = right.split_at_mut(i * width);
            let factors = &lu[i * lu_stride..][..i];
            rows::<S, 1>(simd, &mut below[..width], factors, above, [i, i, width]);
        }
        for i in (0..size).rev() {
            let (above, below) = right.split_at_mut((i + 1) * width);
            let row = &mut above[i * width..];
            let (from, left) = (i * lu_stride, size - i - 1);
            let factors = &lu[from + i + 1..from + size];
            if left > 0 {
                rows::<S, 1>(simd, row, factors, below, [left, left, width]);
            }
            let inverse = simd.splat_f64s(1.0 / lu[from + i]);
            row.iter_mut().for_each(|x| *x = simd.mul_f64s(*x, inverse));
        }
    }
}

struct Factorisation<'a> {
    a: &'a mut [f64],
    stride: usize,
    pivots: &'a mut [usize],
}

impl WithSimd for Factorisation<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { a, stride, pivots } = self;
        let size = pivots.len();
        for i in 0..size {
            let mut pivot = i;
            for p in i + 1..size {
                if a[p * stride + i].abs() > a[pivot * stride + i].abs() {
                    pivot = p;
                }
            }
            pivots[i] = pivot;
            let (above, below) = a.split_at_mut((i + 1) * stride);
            let row = &mut above[i * stride..];
            if pivot != i {
                let at = (pivot - i - 1) * stride;
                row.swap_with_slice(&mut below[at..at + stride]);
            }
            let inverse = 1.0 / row[i];
            // Columns up to i of other rows hold factors: whole vectors begin behind them.
            let first = (i + 1).next_multiple_of(PAD).min(stride);
            let (row_head, row_tail) = row.split_at(first);
            let (row_tail, _) = S::as_simd_f64s(row_tail);
            for other in below.chunks_exact_mut(stride).take(size - i - 1) {
                let factor = other[i] * inverse;
                other[i] = factor;
                let (head, tail) = other.split_at_mut(first);
                for (x, r) in head[i + 1..].iter_mut().zip(&row_head[i + 1..]) {
                    *x -= factor * r;
                }
                let minus = simd.splat_f64s(-factor);
                let (tail, _) = S::as_mut_simd_f64s(tail);
                for (x, r) in tail.iter_mut().zip(row_tail) {
                    *x = simd.mul_add_e_f64s(minus, *r, *x);
                }
            }
        }
    }
}

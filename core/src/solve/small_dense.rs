//! Dense kernels for the small blocks of banded systems: a general library spends more on getting
//! started than these blocks take. Matrices are row by row in slices.

/// `out −= a b`, with a: m × k and b: k × n.
pub(super) fn subtract_product(out: &mut [f64], a: &[f64], b: &[f64], k: usize, n: usize) {
    if k == 0 || n == 0 {
        return;
    }
    for (out, a) in out.chunks_exact_mut(n).zip(a.chunks_exact(k)) {
        for (a, b) in a.iter().zip(b.chunks_exact(n)) {
            if *a != 0.0 {
                for (out, b) in out.iter_mut().zip(b) {
                    *out -= a * b;
                }
            }
        }
    }
}

/// LU factors of a square matrix with row pivoting, in place; `pivots[i]` is the row swapped with
/// row i. A singular matrix gives factors that are not finite.
pub(super) fn factorise(a: &mut [f64], size: usize, pivots: &mut [usize]) {
    for i in 0..size {
        let pivot = (i..size)
            .max_by(|&p, &q| a[p * size + i].abs().total_cmp(&a[q * size + i].abs()))
            .unwrap_or(i);
        pivots[i] = pivot;
        if pivot != i {
            for j in 0..size {
                a.swap(i * size + j, pivot * size + j);
            }
        }
        let inverse = 1.0 / a[i * size + i];
        let (above, below) = a.split_at_mut((i + 1) * size);
        let row = &above[i * size..];
        for other in below.chunks_exact_mut(size) {
            let factor = other[i] * inverse;
            other[i] = factor;
            if factor != 0.0 {
                for (x, r) in other[i + 1..].iter_mut().zip(&row[i + 1..]) {
                    *x -= factor * r;
                }
            }
        }
    }
}

/// Solves with the factors for `columns` right-hand sides, size × columns, in place.
pub(super) fn solve(lu: &[f64], size: usize, pivots: &[usize], right: &mut [f64], columns: usize) {
    for (i, &pivot) in pivots.iter().enumerate() {
        if pivot != i {
            for j in 0..columns {
                right.swap(i * columns + j, pivot * columns + j);
            }
        }
    }
    for i in 1..size {
        let (above, below) = right.split_at_mut(i * columns);
        eliminate(&mut below[..columns], &lu[i * size..i * size + i], above, columns);
    }
    for i in (0..size).rev() {
        let (above, below) = right.split_at_mut((i + 1) * columns);
        let row = &mut above[i * columns..];
        eliminate(row, &lu[i * size + i + 1..(i + 1) * size], below, columns);
        let inverse = 1.0 / lu[i * size + i];
        row.iter_mut().for_each(|x| *x *= inverse);
    }
}

/// `row −= Σ factors_j rows_j`.
fn eliminate(row: &mut [f64], factors: &[f64], rows: &[f64], columns: usize) {
    for (factor, other) in factors.iter().zip(rows.chunks_exact(columns)) {
        for (x, y) in row.iter_mut().zip(other) {
            *x -= factor * y;
        }
    }
}

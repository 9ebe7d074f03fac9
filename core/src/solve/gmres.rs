//! The generalised minimal residual method (Saad and Schultz 1986): linear equations from products
//! alone, to the few digits that an estimate needs.

/// Approximate solution of `A x = rhs`, where `apply` writes `A x`: the residual, weighed entry by
/// entry, falls to `tolerance` times that of zero, as far as `iterations` products suffice.
pub fn gmres(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    rhs: &[f64],
    weights: &[f64],
    tolerance: f64,
    iterations: usize,
) -> Vec<f64> {
    let inner = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(weights).map(|((a, b), w)| w * w * a * b).sum()
    };
    let mut solution = vec![0.0; rhs.len()];
    let start = inner(rhs, rhs).sqrt();
    if start == 0.0 || !start.is_finite() {
        return rhs.to_vec();
    }
    let mut basis = vec![rhs.iter().map(|r| r / start).collect::<Vec<f64>>()];
    // Columns of the triangular factor, the rotations that made it, and the rotated right side.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<[f64; 2]> = Vec::new();
    let mut rotated = vec![start];
    for step in 0..iterations.min(rhs.len()) {
        let mut next = vec![0.0; rhs.len()];
        apply(&basis[step], &mut next);
        let mut column = Vec::with_capacity(step + 2);
        for vector in &basis {
            let part = inner(vector, &next);
            next.iter_mut().zip(vector).for_each(|(n, v)| *n -= part * v);
            column.push(part);
        }
        let left = inner(&next, &next).sqrt();
        if !left.is_finite() {
            break;
        }
        for (i, [c, s]) in rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
        }
        let size = column[step].hypot(left);
        if size <= 1e-14 * start.min(1.0) {
            break;
        }
        let [c, s] = [column[step] / size, left / size];
        column[step] = size;
        rotations.push([c, s]);
        columns.push(column);
        rotated.push(-s * rotated[step]);
        rotated[step] *= c;
        if rotated[step + 1].abs() <= tolerance * start {
            break;
        }
        next.iter_mut().for_each(|n| *n /= left);
        basis.push(next);
    }
    let mut factors = rotated[..columns.len()].to_vec();
    for i in (0..columns.len()).rev() {
        factors[i] /= columns[i][i];
        let factor = factors[i];
        (0..i).for_each(|j| factors[j] -= factor * columns[i][j]);
    }
    for (factor, vector) in factors.iter().zip(&basis) {
        solution.iter_mut().zip(vector).for_each(|(x, v)| *x += factor * v);
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_products_as_unknowns_solve_the_equations() {
        let size = 6;
        let entry = |i: usize, j: usize| {
            f64::from(u8::from(i == j)) * 2.0 + (1.3 * i as f64 - 0.7 * (j * j) as f64).sin()
        };
        let product = |x: &[f64], out: &mut [f64]| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = (0..size).map(|j| entry(i, j) * x[j]).sum();
            }
        };
        let expected: Vec<f64> = (0..size).map(|i| 1.0 - 0.4 * i as f64).collect();
        let mut rhs = vec![0.0; size];
        product(&expected, &mut rhs);
        let weights: Vec<f64> = (0..size).map(|i| 10f64.powi(i as i32 % 3)).collect();
        let solution = gmres(product, &rhs, &weights, 1e-14, size);
        for (x, e) in solution.iter().zip(&expected) {
            assert!((x - e).abs() < 1e-10, "{x} {e}");
        }
    }
}

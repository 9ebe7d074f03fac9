//! The method of generalised minimal residuals (Saad and Schultz 1986): linear equations of which
//! nothing is known but products with their matrix.

use super::norm;

/// What a solution has taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KrylovReport {
    /// Norm of the residual over that of the right-hand side.
    pub residual: f64,
    /// Products with the matrix.
    pub products: usize,
}

/// Solves `A x = rhs` from zero to the relative residual `tolerance`, by at most `most` products; there
/// is no restart, so that as many products as unknowns make it a direct method.
pub fn gmres(
    mut product: impl FnMut(&[f64], &mut [f64]),
    rhs: &[f64],
    tolerance: f64,
    most: usize,
    x: &mut [f64],
) -> KrylovReport {
    x.fill(0.0);
    let size = norm(rhs);
    if size == 0.0 || !size.is_finite() {
        return KrylovReport { residual: size, products: 0 };
    }
    let mut basis = vec![rhs.iter().map(|r| r / size).collect::<Vec<f64>>()];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut turns: Vec<(f64, f64)> = Vec::new();
    let mut right: Vec<f64> = vec![1.0];
    let mut image = vec![0.0; rhs.len()];
    while columns.len() < most.min(rhs.len()) && right[columns.len()].abs() > tolerance {
        let step = columns.len();
        product(&basis[step], &mut image);
        let mut column = vec![0.0; step + 2];
        // Twice is enough.
        for _ in 0..2 {
            for (known, entry) in basis.iter().zip(&mut column) {
                let along: f64 = known.iter().zip(&image).map(|(a, b)| a * b).sum();
                image.iter_mut().zip(known).for_each(|(image, known)| *image -= along * known);
                *entry += along;
            }
        }
        let rest = norm(&image);
        column[step + 1] = rest;
        for (i, &(cos, sin)) in turns.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (cos * a + sin * b, cos * b - sin * a);
        }
        let length = column[step].hypot(rest);
        if !(length > 0.0 && length.is_finite()) {
            break;
        }
        let (cos, sin) = (column[step] / length, rest / length);
        column[step] = length;
        turns.push((cos, sin));
        right.push(-sin * right[step]);
        right[step] *= cos;
        columns.push(column);
        if rest <= f64::EPSILON * length {
            break;
        }
        basis.push(image.iter().map(|v| v / rest).collect());
    }
    let products = columns.len();
    let mut share = right[..products].to_vec();
    for i in (0..products).rev() {
        let known: f64 = (i + 1..products).map(|j| columns[j][i] * share[j]).sum();
        share[i] = (share[i] - known) / columns[i][i];
    }
    for (known, share) in basis.iter().zip(&share) {
        x.iter_mut().zip(known).for_each(|(x, known)| *x += size * share * known);
    }
    KrylovReport { residual: right[products].abs(), products }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_an_unsymmetric_system_in_as_many_products_as_unknowns() {
        let size = 12;
        let entry = |i: usize, j: usize| {
            ((3 * i + 7 * j) as f64).sin() + if i == j { 4.0 } else { 0.0 } + 0.3 * i as f64
        };
        let exact: Vec<f64> = (0..size).map(|i| (i as f64 - 3.3).cos()).collect();
        let product = |v: &[f64], out: &mut [f64]| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = (0..size).map(|j| entry(i, j) * v[j]).sum();
            }
        };
        let mut rhs = vec![0.0; size];
        product(&exact, &mut rhs);
        let mut x = vec![0.0; size];
        let report = gmres(product, &rhs, 1e-14, 100, &mut x);
        assert!(report.products <= size && report.residual < 1e-13, "{report:?}");
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-11, "{x} {exact}");
        }
    }
}

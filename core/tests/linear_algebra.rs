//! Eigenpairs in any unit, and cyclic block tridiagonal systems.
#![allow(clippy::unwrap_used, clippy::panic)]

use faer::linalg::solvers::Solve as _;
use faer::traits::ComplexField;
use faer::{c64, Mat};
use std::f64::consts::{PI, TAU};
use stickslip_core::solve::{
    hermitian_eigen, Block, BlockRow, CyclicScalars, CyclicTridiagonal, ScalarRow,
};

/// Largest error of the eigenvalues, of `Vᴴ V = I` and of `Vᴴ A V = Λ`, the first and the last
/// relative to the largest eigenvalue.
fn errors<T: ComplexField<Real = f64>>(matrix: &Mat<T>, mut exact: Vec<f64>) -> f64 {
    exact.sort_by(f64::total_cmp);
    let (values, vectors) = hermitian_eigen(matrix.as_ref()).unwrap();
    let largest = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let diagonal = |values: &[f64]| {
        let entry = |i, j| if i == j { values[i] } else { 0.0 };
        Mat::from_fn(values.len(), values.len(), |i, j| T::from_f64_impl(entry(i, j)))
    };
    let ones = diagonal(&vec![1.0; values.len()]);
    let scaled = (vectors.adjoint() * (matrix * &vectors) - diagonal(&values)).norm_max();
    let of_values = values.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    let of_vectors = (vectors.adjoint() * &vectors - ones).norm_max();
    of_vectors.max(scaled / largest).max(of_values / largest)
}

#[test]
fn long_chains_in_any_unit() {
    for (size, stiffness) in [(129, 1e8), (300, 1e7), (300, 3.0), (400, 1e-12), (400, 1e150)] {
        let chain = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 2.0 * stiffness,
            1 => -stiffness,
            _ => 0.0,
        });
        let angle = |j: usize| PI * (j + 1) as f64 / (size + 1) as f64;
        let exact = (0..size).map(|j| 2.0 * stiffness * (1.0 - angle(j).cos())).collect();
        let error = errors(&chain, exact);
        assert!(error < 1e-13, "{size} masses, {stiffness} N/m: {error:.1e}");
    }
}

#[test]
fn double_eigenvalues_of_rings_real_and_complex() {
    let (size, stiffness) = (240, 1e8);
    for turn in [0.0, 0.7] {
        let ahead = c64::new(0.0, turn).exp() * stiffness;
        let ring = Mat::from_fn(size, size, |i, j| match (j + size - i) % size {
            0 => c64::new(2.1 * stiffness, 0.0),
            1 => -ahead,
            other if other == size - 1 => -ahead.conj(),
            _ => c64::new(0.0, 0.0),
        });
        let angle = |j: usize| TAU * j as f64 / size as f64 + turn;
        let exact: Vec<f64> = (0..size).map(|j| stiffness * (2.1 - 2.0 * angle(j).cos())).collect();
        let error = errors(&ring, exact.clone());
        assert!(error < 1e-13, "{error:.1e}");
        if turn == 0.0 {
            let error = errors(&Mat::from_fn(size, size, |i, j| ring[(i, j)].re), exact);
            assert!(error < 1e-13, "{error:.1e}");
        }
    }
}

#[test]
fn nothing_and_one_number() {
    let (values, vectors) = hermitian_eigen(Mat::<f64>::zeros(150, 150).as_ref()).unwrap();
    assert!(values.iter().all(|value| *value == 0.0));
    assert!((vectors.transpose() * &vectors - Mat::<f64>::identity(150, 150)).norm_max() == 0.0);
    let one = Mat::from_fn(1, 1, |_, _| -5.0);
    assert_eq!(hermitian_eigen(one.as_ref()).unwrap().0, [-5.0]);
}

#[test]
fn every_number_of_blocks_agrees_with_the_dense_solution() {
    for count in 1..8 {
        let size = 3;
        let mut seed = 0.3_f64;
        let mut random = |shift: f64| {
            let mut block = Block::zeros(size, size);
            for at in 0..size * size {
                seed = (seed * 997.0 + 0.123).fract();
                let diagonal = if at % (size + 1) == 0 { shift } else { 0.0 };
                block[(at / size, at % size)] = seed - 0.5 + diagonal;
            }
            block
        };
        let rows: Vec<BlockRow> = (0..count)
            .map(|_| BlockRow { lower: random(0.0), own: random(4.0), upper: random(0.0) })
            .collect();
        let mut dense = Mat::<f64>::zeros(count * size, count * size);
        for (i, row) in rows.iter().enumerate() {
            let parts = [
                (&row.lower, (i + count - 1) % count),
                (&row.own, i),
                (&row.upper, (i + 1) % count),
            ];
            for (part, j) in parts {
                for at in 0..size * size {
                    let (row, column) = (at / size, at % size);
                    dense[(i * size + row, j * size + column)] += part[(row, column)];
                }
            }
        }
        let right = Mat::from_fn(count * size, 1, |i, _| (1.0 + i as f64).sin());
        let expected = dense.partial_piv_lu().solve(&right);
        let mut found: Vec<f64> = (0..count * size).map(|i| right[(i, 0)]).collect();
        CyclicTridiagonal::new(rows).solve(&mut found);
        for (i, found) in found.iter().enumerate() {
            assert!((expected[(i, 0)] - found).abs() < 1e-12, "{count}");
        }
    }
}

#[test]
fn every_number_of_scalars_agrees_with_the_dense_solution() {
    for count in 1..8 {
        let mut seed = 0.3_f64;
        let mut random = |shift: f64| {
            let mut next = || {
                seed = (seed * 997.0 + 0.123).fract();
                seed - 0.5
            };
            c64::new(next() + shift, next())
        };
        let rows: Vec<ScalarRow> = (0..count)
            .map(|_| ScalarRow { lower: random(0.0), own: random(3.0), upper: random(0.0) })
            .collect();
        let mut dense = Mat::<c64>::zeros(count, count);
        for (i, row) in rows.iter().enumerate() {
            dense[(i, (i + count - 1) % count)] += row.lower;
            dense[(i, i)] += row.own;
            dense[(i, (i + 1) % count)] += row.upper;
        }
        let right = Mat::from_fn(count, 1, |i, _| c64::new((1.0 + i as f64).sin(), i as f64));
        let expected = dense.partial_piv_lu().solve(&right);
        let mut found: Vec<c64> = (0..count).map(|i| right[(i, 0)]).collect();
        CyclicScalars::new(&rows).solve(&mut found);
        for (i, found) in found.iter().enumerate() {
            assert!((expected[(i, 0)] - found).norm() < 1e-12, "{count}");
        }
    }
}

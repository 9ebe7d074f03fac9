//! Factors of sparse matrices, for reductions in Python.

use crate::arrays::{matrix, table, Array1, Array2};
use crate::watch::whole;
use numpy::PyArray2;
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::structure::{self, Unfactored};

/// Cholesky's factor of a sparse matrix.
#[pyclass(frozen, module = "stickslip._core")]
pub struct SparseCholesky(Arc<structure::SparseCholesky>);

#[pymethods]
impl SparseCholesky {
    /// Of a symmetric matrix in compressed columns; a `ValueError` if it is not positive definite, a `MemoryError` if
    /// the factor does not fit into memory.
    #[new]
    fn new(
        py: Python<'_>,
        begins: Array1<'_, i64>,
        rows: Array1<'_, i32>,
        numbers: Array1<'_, f64>,
    ) -> PyResult<Self> {
        // A place that is none is beyond every array.
        let place = |at: i64| usize::try_from(at).unwrap_or(usize::MAX);
        let begins = begins.as_array().iter().map(|&at| place(at)).collect();
        let rows = rows.as_array().iter().map(|&row| place(row.into())).collect();
        let numbers = numbers.as_array().to_vec();
        let factor = whole(py, move |_| Ok(structure::SparseCholesky::new(begins, rows, numbers)))?;
        let refused = |why| match why {
            Unfactored::NotDefinite => PyValueError::new_err("matrix: not positive definite"),
            Unfactored::TooLarge => PyMemoryError::new_err("matrix: its factor is too large"),
        };
        Ok(Self(Arc::new(factor.map_err(refused)?)))
    }

    /// Numbers that the factor has, some of them zero.
    fn numbers(&self) -> usize {
        self.0.numbers()
    }

    /// The solutions of some right-hand sides, shape (N, columns).
    fn solve<'py>(
        &self,
        py: Python<'py>,
        right: Array2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (own, right) = (Arc::clone(&self.0), matrix(&right));
        let (size, columns) = right.shape();
        if size != own.size() {
            return Err(PyValueError::new_err(format!("right: {size} rows for {}", own.size())));
        }
        let found = whole(py, move |_| Ok(own.solve(right)))?;
        let rows = (0..size).flat_map(|i| (0..columns).map(move |j| (i, j)));
        table(py, size, columns, rows.map(|at| found[at]).collect())
    }
}

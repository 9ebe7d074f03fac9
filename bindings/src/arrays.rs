//! NumPy arrays to matrices and series, and back.

use numpy::{Complex64, PyArray1, PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stickslip_core::fourier::Harmonics;

/// A core error as a Python `ValueError`.
pub fn refused(error: stickslip_core::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A dense matrix from a two-dimensional array.
pub fn matrix(array: &PyReadonlyArray2<'_, f64>) -> faer::Mat<f64> {
    let view = array.as_array();
    faer::Mat::from_fn(view.nrows(), view.ncols(), |i, j| view[[i, j]])
}

/// Real coefficients of complex amplitudes `X_0, X_1, …`.
pub fn series(harmonics: &Harmonics, amplitudes: impl Fn(usize) -> Complex64) -> Vec<f64> {
    let mut series = vec![0.0; harmonics.slots()];
    for order in harmonics.orders() {
        let Some(slot) = harmonics.slot(order) else { continue };
        let amplitude = amplitudes(order);
        series[slot] = amplitude.re;
        if order > 0 {
            series[slot + 1] = -amplitude.im;
        }
    }
    series
}

/// Whether amplitudes `X_0, X_1, …` have half-wave symmetry.
pub fn is_half_wave(orders: usize, amplitudes: impl Fn(usize) -> Complex64) -> bool {
    (0..orders).step_by(2).all(|k| amplitudes(k) == Complex64::new(0.0, 0.0))
}

/// A one-dimensional array.
pub fn vector<'py, T: numpy::Element>(
    py: Python<'py>,
    values: impl IntoIterator<Item = T>,
) -> Bound<'py, PyArray1<T>> {
    PyArray1::from_iter(py, values)
}

/// A two-dimensional array from rows of equal length.
pub fn table<'py, T: numpy::Element + Clone>(
    py: Python<'py>,
    rows: usize,
    columns: usize,
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    use numpy::PyArrayMethods as _;
    PyArray1::from_vec(py, values).reshape([rows, columns])
}

/// A three-dimensional array.
pub fn block<'py>(
    py: Python<'py>,
    shape: [usize; 3],
    values: Vec<Complex64>,
) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
    use numpy::PyArrayMethods as _;
    PyArray1::from_vec(py, values).reshape(shape)
}

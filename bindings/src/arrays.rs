//! NumPy arrays to matrices and series, and back.

use numpy::ndarray::{ArrayView2, Dimension};
use numpy::{
    Complex64, Element, Ix1, Ix2, Ix3, PyArray1, PyArray2, PyReadonlyArray, PyUntypedArray,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::ops::Deref;
use stickslip_core::fourier::Harmonics;
use stickslip_core::structure::Matrix;

/// Most instants of a history, over all of its columns: more do not fit into memory.
const MOST_VALUES: usize = 1 << 28;

/// An array that Python gives, to be read; anything else is refused in one line.
pub struct Given<'py, T: Element, D: Dimension>(PyReadonlyArray<'py, T, D>);

pub type Array1<'py, T> = Given<'py, T, Ix1>;
pub type Array2<'py, T> = Given<'py, T, Ix2>;
pub type Array3<'py, T> = Given<'py, T, Ix3>;

impl<'py, T: Element, D: Dimension> Deref for Given<'py, T, D> {
    type Target = PyReadonlyArray<'py, T, D>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a, 'py, T: Element + 'a, D: Dimension + 'a> FromPyObject<'a, 'py> for Given<'py, T, D> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(array) = given.extract() {
            return Ok(Self(array));
        }
        let got = given.cast::<PyUntypedArray>().map_or_else(
            |_| given.get_type().to_string(),
            |array| format!("{} in {}", array.dtype(), array.ndim()),
        );
        let (numbers, dimensions) = (T::get_dtype(given.py()), D::NDIM.unwrap_or_default());
        Err(PyTypeError::new_err(format!(
            "expected an array of {numbers} in {dimensions} dimensions, got {got}"
        )))
    }
}

/// Checks that a history of `samples` instants fits into memory.
pub fn check_samples(samples: usize, columns: usize) -> PyResult<()> {
    let most = MOST_VALUES / columns.max(1);
    if (1..=most).contains(&samples) {
        return Ok(());
    }
    let text = format!("samples = {samples}: must lie between 1 and {most}, which memory can hold");
    Err(PyValueError::new_err(text))
}

/// A core error as a Python `ValueError`; one of a DOF that hardly has a mass carries its position,
/// its rate over the frequency, the frequency and the highest ratio, since the core knows no names.
pub fn refused(error: stickslip_core::Error) -> PyErr {
    match error {
        stickslip_core::Error::TooFast { dof, ratio, omega, fastest } => {
            TooFastError::new_err((dof, ratio, omega, fastest))
        }
        other => PyValueError::new_err(other.to_string()),
    }
}

pyo3::create_exception!(_core, TooFastError, PyValueError);

/// A dense matrix from a two-dimensional array.
pub fn matrix(array: &Array2<'_, f64>) -> faer::Mat<f64> {
    dense(array.as_array())
}

/// A matrix from a two-dimensional array, by its numbers if they are few.
pub fn sparse(array: &Array2<'_, f64>) -> Matrix {
    let view = array.as_array();
    let (rows, columns) = view.dim();
    let mut entries = Vec::new();
    for (i, row) in view.outer_iter().enumerate() {
        if !Matrix::is_few(rows, columns, entries.len()) {
            return dense(view).into();
        }
        let numbers = row.into_iter().enumerate().filter(|(_, x)| **x != 0.0);
        entries.extend(numbers.map(|(j, x)| (i, j, *x)));
    }
    Matrix::of_entries(rows, columns, &entries)
}

/// Dense matrices from the first dimension of a three-dimensional array.
pub fn matrices<T: Element + Copy>(array: &Array3<'_, T>) -> Vec<faer::Mat<T>> {
    array.as_array().outer_iter().map(dense).collect()
}

fn dense<T: Copy>(view: ArrayView2<'_, T>) -> faer::Mat<T> {
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

/// Real coefficients of displacements `(points, H+1)`, point after point, with their harmonics: odd ones
/// alone if no other is there and the motion is `odd`.
pub fn coefficients(
    displacement: &Array2<'_, Complex64>,
    odd: bool,
) -> PyResult<(Harmonics, Vec<f64>)> {
    let view = displacement.as_array();
    if !view.iter().all(|amplitude| amplitude.is_finite()) {
        return Err(PyValueError::new_err("displacement: every amplitude must be finite"));
    }
    let (points, orders) = (view.nrows(), view.ncols());
    let half_wave = odd && (0..points).all(|n| is_half_wave(orders, |k| view[[n, k]]));
    let harmonics = Harmonics::new(orders.saturating_sub(1), half_wave);
    let values = (0..points).flat_map(|n| series(&harmonics, |k| view[[n, k]])).collect();
    Ok((harmonics, values))
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

//! Limit cycles: negative damping and settings in, cycles along a branch out.

use crate::arrays::{either, matrix, padded, refused, table, vector, Array2, Array3};
use crate::problem::Problem;
use crate::response::{counters, status_code, timings};
use crate::variation::Varied;
use crate::watch::{given_up, watched};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::balance::{HarmonicChoice, Point};
use stickslip_core::model::{NegativeDamping, Variation};
use stickslip_core::orbit::{self, ChangeKind, Cycle, CycleSettings};
use stickslip_core::solve::End;

/// Limit cycles along a branch.
#[pyclass(frozen, module = "stickslip._core")]
pub struct LimitCycles {
    inner: orbit::LimitCycles,
    dofs: usize,
    contacts: usize,
    states: usize,
}

impl LimitCycles {
    fn cycles(&self) -> &[Cycle] {
        &self.inner.cycles
    }

    fn amplitudes<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Point) -> &[Complex64],
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        let cycles = self.cycles().iter();
        padded(py, columns, cycles.map(|c| (c.response.harmonics, of(&c.response))))
    }

    /// Rows of numbers, not-a-number where a cycle has none.
    fn rows<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Cycle) -> Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let filled = |cycle: &Cycle| {
            let mut row = of(cycle);
            row.resize(columns, f64::NAN);
            row
        };
        let values = self.cycles().iter().flat_map(filled).collect();
        table(py, self.cycles().len(), columns, values)
    }
}

#[pymethods]
impl LimitCycles {
    #[getter]
    fn value<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.cycles().iter().map(|c| c.value))
    }

    #[getter]
    fn ratio<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.cycles().iter().map(|c| c.ratio))
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.cycles().iter().map(|c| c.response.omega))
    }

    #[getter]
    fn slipping<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        vector(py, self.cycles().iter().map(|c| c.slipping))
    }

    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        vector(py, self.cycles().iter().map(|c| status_code(c.response.status)))
    }

    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.cycles().iter().map(|c| c.response.harmonics as i64))
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.dofs, |p| &p.displacement)
    }

    #[getter]
    fn contact_displacement<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.contacts, |p| &p.contact_displacement)
    }

    #[getter]
    fn contact_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.contacts, |p| &p.contact_force)
    }

    #[getter]
    fn error_estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.dofs, |c| c.response.error_estimate.clone())
    }

    #[getter]
    fn slip_fraction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let share = |c: &Cycle| c.response.contacts.iter().map(|p| p.slip_fraction).collect();
        self.rows(py, self.contacts, share)
    }

    #[getter]
    fn dissipation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let work = |c: &Cycle| c.response.contacts.iter().map(|p| p.dissipation).collect();
        self.rows(py, self.contacts, work)
    }

    /// Lowest and highest displacement `(n, dofs, 2)`, not-a-number without exact orbits.
    #[getter]
    fn range<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        use numpy::PyArrayMethods as _;
        let rows = self.rows(py, 2 * self.dofs, |c| c.range.iter().flatten().copied().collect())?;
        rows.reshape([self.cycles().len(), self.dofs, 2])
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.states, |c| c.state.clone())
    }

    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let columns = self.states.saturating_sub(1);
        let filled = |cycle: &Cycle| {
            let mut row = cycle.multipliers.clone();
            row.resize(columns, Complex64::new(f64::NAN, f64::NAN));
            row
        };
        let values = self.cycles().iter().flat_map(filled).collect();
        table(py, self.cycles().len(), columns, values)
    }

    #[getter]
    fn neutral<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.cycles().iter().map(|c| c.neutral as i64))
    }

    #[getter]
    fn closed<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        vector(py, self.cycles().iter().map(|c| c.closed))
    }

    /// Value and frequency where the branch turns for good, if it does.
    #[getter]
    fn limit(&self) -> Option<(f64, f64)> {
        self.inner.limit.map(|turn| (turn.value, turn.omega))
    }

    /// Values and frequencies where the branch turns.
    #[getter]
    fn folds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let values: Vec<f64> = self.inner.folds.iter().flat_map(|t| [t.value, t.omega]).collect();
        table(py, self.inner.folds.len(), 2, values)
    }

    /// Value, frequency, position of the cycle before, kind, and unstable multipliers before and
    /// after of every change of stability.
    #[getter]
    #[allow(clippy::type_complexity)]
    fn changes(&self) -> Vec<(f64, f64, usize, &'static str, usize, usize)> {
        let kind = |kind| match kind {
            ChangeKind::Fold => "fold",
            ChangeKind::ComplexPair => "complex pair",
            ChangeKind::Symmetry => "symmetry",
            ChangeKind::Grazing => "grazing",
        };
        let row = |c: &orbit::Change| {
            (c.value, c.omega, c.after, kind(c.kind), c.unstable.0, c.unstable.1)
        };
        self.inner.changes.iter().map(row).collect()
    }

    /// How either side ended, and at which value.
    #[getter]
    fn ends(&self) -> Vec<(&'static str, f64)> {
        let name = |end| match end {
            End::Range => "range",
            End::Condition => "unbounded",
            End::Points => "points",
            End::Stalled => "stalled",
            End::Returned => "returned",
            End::Interrupted => "interrupted",
        };
        self.inner.ends.iter().zip(self.inner.end_values).map(|(e, v)| (name(*e), v)).collect()
    }

    /// r at which the stuck mode loses its damping, and its natural frequency.
    #[getter]
    fn onset(&self) -> (f64, f64) {
        (self.inner.onset, self.inner.stuck_omega)
    }

    #[getter]
    fn phase_dof(&self) -> usize {
        self.inner.phase_dof
    }

    #[getter]
    fn jumps(&self) -> usize {
        self.inner.jumps
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.inner.interrupted
    }

    #[getter]
    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        timings(py, &self.inner.profile)
    }

    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        counters(py, &self.inner.profile, 0)
    }
}

/// Negative damping: one matrix, or complex ones by nodal diameter of a travelling wave.
pub enum Negative<'py> {
    Whole(Array2<'py, f64>),
    Wave(Array3<'py, Complex64>),
}

impl<'a, 'py: 'a> FromPyObject<'a, 'py> for Negative<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let expected = "an array of float64 in 2 dimensions, or of complex128 in 3";
        either(given, expected, Self::Whole, Self::Wave)
    }
}

impl Negative<'_> {
    fn damping(&self, proportional: bool) -> NegativeDamping {
        match self {
            Self::Whole(array) if proportional => NegativeDamping::Proportional(matrix(array)),
            Self::Whole(array) => NegativeDamping::Whole(matrix(array)),
            Self::Wave(array) => {
                let each = |one: numpy::ndarray::ArrayView2<'_, Complex64>| {
                    faer::Mat::from_fn(one.nrows(), one.ncols(), |i, j| one[[i, j]])
                };
                NegativeDamping::Wave(array.as_array().outer_iter().map(each).collect())
            }
        }
    }
}

/// Which cycles are sought and how: `CycleSettings` of Python.
#[derive(FromPyObject)]
pub struct Settings {
    mode: usize,
    ratio: f64,
    values: Option<Vec<f64>>,
    span: (f64, f64),
    method: String,
    fixed_harmonics: Option<usize>,
    max_harmonics: usize,
    tolerance: f64,
    stability: bool,
    max_points: usize,
}

/// Limit cycles of a mode along what is varied, the ratio if nothing is; `proportional` says that a
/// law made the negative damping, one that couples none of the modes without contacts.
#[pyfunction]
pub fn limit_cycles(
    py: Python<'_>,
    problem: &Problem,
    negative_damping: Negative<'_>,
    proportional: bool,
    variation: Option<Varied>,
    settings: Settings,
    progress: Option<Py<PyAny>>,
) -> PyResult<LimitCycles> {
    if settings.max_points < 2 {
        return Err(PyValueError::new_err("max_points: must be at least 2"));
    }
    let negative = negative_damping.damping(proportional);
    let variation = variation.map_or(Variation::Ratio, Variation::from);
    let ratio = settings.ratio;
    let harmonics = settings.fixed_harmonics;
    let settings = CycleSettings {
        mode: settings.mode,
        values: settings.values,
        range: settings.span,
        exact: settings.method == "exact",
        harmonics: harmonics.map_or(HarmonicChoice::Auto, HarmonicChoice::Fixed),
        max_harmonics: settings.max_harmonics,
        tolerance: settings.tolerance,
        reported: harmonics.unwrap_or(settings.max_harmonics),
        stability: settings.stability,
        most: settings.max_points,
    };
    let model = &problem.model;
    let own = Arc::clone(model);
    let (inner, raised) = watched(py, progress.as_ref(), move |look| {
        orbit::limit_cycles(&own, &negative, &variation, ratio, &settings, look)
    })?;
    raised.raise_unless_interrupt(py)?;
    Ok(LimitCycles {
        inner: inner.ok_or_else(given_up)?.map_err(refused)?,
        dofs: model.compliance().dofs(),
        contacts: model.compliance().contacts(),
        states: model.states(),
    })
}

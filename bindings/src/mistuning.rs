//! Mistuned disks: the highest blade of one, and of many patterns in parallel threads.

use crate::arrays::{matrix, refused, Array2};
use crate::problem::{
    harmonic_loads, ring_coupling, sector_contacts, Forces, Problem, SectorContactSpec, Table,
};
use crate::settings::{self, get, harmonic, measure};
use crate::watch::{followed, raise_unless_interrupt, watched_parts};
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{Progress, Settings};
use stickslip_core::design::{self, study, GlobalPeak, Pattern, PeakQuery};
use stickslip_core::fourier::Measure;

/// A tuned disk, from which rings of deviating sectors are made.
#[pyclass(frozen, module = "stickslip._core")]
pub struct TunedDisk {
    disk: Arc<design::TunedDisk>,
}

#[pymethods]
impl TunedDisk {
    /// Builds the disk from the matrices of a sector: mass with what couplings add; stiffness
    /// without, and what they add; damping that does not deviate, that goes with the stiffness and
    /// that goes with its root; the blocks of mass, damping and stiffness to the next sector;
    /// contacts of every sector, and forces sector by sector; whether a law made all of the damping.
    #[new]
    fn new(
        mass: Table<'_>,
        stiffness: Table<'_>,
        coupled_stiffness: Table<'_>,
        damping: (Table<'_>, Table<'_>, Table<'_>),
        coupling: (Table<'_>, Table<'_>, Table<'_>),
        contacts: Vec<SectorContactSpec<'_>>,
        forces: Vec<Forces<'_>>,
        proportional: bool,
    ) -> PyResult<Self> {
        let disk = design::TunedDisk {
            mass: matrix(&mass),
            stiffness: matrix(&stiffness),
            coupled_stiffness: matrix(&coupled_stiffness),
            damping: [matrix(&damping.0), matrix(&damping.1), matrix(&damping.2)],
            proportional,
            coupling: ring_coupling([coupling.0, coupling.1, coupling.2]),
            contacts: sector_contacts(contacts)?,
            loads: forces.into_iter().map(harmonic_loads).collect(),
        };
        Ok(Self { disk: Arc::new(disk) })
    }

    /// The ring whose sectors' stiffnesses deviate.
    fn mistuned(&self, py: Python<'_>, deviations: Vec<f64>) -> PyResult<Problem> {
        let disk = Arc::clone(&self.disk);
        Problem::of(py, move || disk.mistuned(&deviations))
    }
}

/// Frequency, amplitude, DOF by its position in the group, status, harmonics kept, error estimate,
/// whether it lies at an end of the range.
type Row = (f64, f64, usize, u8, usize, f64, bool);

fn row(summit: &GlobalPeak) -> Row {
    let GlobalPeak { omega, amplitude, member, harmonics, error_estimate, at_edge, .. } = *summit;
    (omega, amplitude, member, summit.status as u8, harmonics, error_estimate, at_edge)
}

/// The highest point of every group of DOFs, of each of which the highest.
#[pyfunction]
#[pyo3(signature = (problem, groups, measure, span, settings, evaluation=None, progress=None))]
pub fn summits(
    py: Python<'_>,
    problem: &Problem,
    groups: Vec<Vec<usize>>,
    #[pyo3(from_py_with = measure)] measure: Measure,
    span: (f64, f64),
    #[pyo3(from_py_with = harmonic)] settings: Settings,
    evaluation: Option<&Bound<'_, PyAny>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<Row>> {
    let model = Arc::clone(&problem.model);
    let query = PeakQuery { groups, measure, span };
    let settings =
        evaluation.map_or(Ok(settings), |given| settings::evaluation(given, settings))?;
    let find = move |look: &Progress<'_>| design::summits(&model, settings, &query, None, look);
    let found = followed(py, progress, find)?;
    Ok(found.summits.iter().map(row).collect())
}

/// The highest blade of every pattern, one row of `deviations` each, of the disk at its position in
/// `disks`; groups hold DOFs of a sector. `deliver(index, rows, points)` is called as they come,
/// `progress` from time to time.
/// Whether all were computed: Ctrl-C ends the study early.
#[pyfunction]
pub fn mistuning_study(
    py: Python<'_>,
    disks: Vec<PyRef<'_, TunedDisk>>,
    which: Vec<usize>,
    deviations: Array2<'_, f64>,
    groups: Vec<Vec<usize>>,
    peak: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = harmonic)] settings: Settings,
    orders: Vec<usize>,
    threads: usize,
    deliver: Py<PyAny>,
    progress: Py<PyAny>,
) -> PyResult<bool> {
    let measure = measure(&peak.getattr("measure")?)?;
    let query = PeakQuery { groups, measure, span: get(peak, "span")? };
    let disks: Vec<Arc<design::TunedDisk>> =
        disks.iter().map(|one| Arc::clone(&one.disk)).collect();
    let rows: Vec<Vec<f64>> = deviations.as_array().outer_iter().map(|row| row.to_vec()).collect();
    let orders: Vec<Option<usize>> = orders.into_iter().map(Some).collect();
    let deliver = |py: Python<'_>, (index, rows, points): (usize, Vec<Row>, usize)| {
        deliver.call1(py, (index, rows, points)).map(drop)
    };
    let (left, raised) = watched_parts(py, Some(progress), deliver, move |look, hand_over| {
        let disks: Vec<&design::TunedDisk> = disks.iter().map(AsRef::as_ref).collect();
        let patterns: Vec<Pattern<'_>> =
            rows.iter().zip(which).map(|(deviations, disk)| Pattern { disk, deviations }).collect();
        let mut deliver = |index: usize, found: design::Summits| {
            hand_over((index, found.summits.iter().map(row).collect(), found.points))
        };
        let mut wait = || look(0.0);
        study(&disks, &patterns, settings, &query, &orders, threads, &mut deliver, &mut wait)
    })?;
    let complete = raised.is_none();
    raise_unless_interrupt(py, raised)?;
    left.ended().map_or(Ok(()), |ended| ended.map_err(refused))?;
    Ok(complete)
}

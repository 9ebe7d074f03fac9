//! Columns of a result: NumPy arrays by name, of which Python takes those that it knows.

use numpy::ndarray::IntoDimension;
use numpy::{Complex64, Element, PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyDict};
use stickslip_core::balance::{AmplitudeBounds, Point, Uniqueness};
use stickslip_core::contact::PointState;
use stickslip_core::motion::Event;
use stickslip_core::timing::Profile;

/// Columns that are being written, and what is told besides.
pub struct Columns<'py> {
    columns: Bound<'py, PyDict>,
    told: Bound<'py, PyDict>,
}

impl<'py> Columns<'py> {
    pub fn new(py: Python<'py>) -> Self {
        Self { columns: PyDict::new(py), told: PyDict::new(py) }
    }

    /// An attribute beside the columns.
    pub fn tell(&self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<()> {
        self.told.set_item(name, value)
    }

    /// Seconds by stage and work by kind, of which `first` is counted elsewhere.
    pub fn effort(&self, profile: &Profile, first: (&str, usize)) -> PyResult<()> {
        let timings = [
            ("compliance", profile.compliance),
            ("law", profile.law),
            ("linear_solve", profile.linear_solve),
            ("recovery", profile.recovery),
            ("estimate", profile.estimate),
            ("stability", profile.stability),
            ("total", profile.total),
        ]
        .map(|(stage, time)| (stage, time.as_secs_f64()));
        let counters = [
            first,
            ("evaluations", profile.evaluations),
            ("factorisations", profile.factorisations),
            ("products", profile.products),
            ("updates", profile.updates),
            ("restarts", profile.restarts),
            ("homotopies", profile.homotopies),
            ("orbits", profile.orbits),
        ];
        self.tell("timings", timings.into_py_dict(self.told.py())?)?;
        self.tell("counters", counters.into_py_dict(self.told.py())?)
    }

    /// An object with the columns and all that was told.
    pub fn end(self) -> PyResult<Bound<'py, PyAny>> {
        self.told.set_item("columns", &self.columns)?;
        self.told.py().import("types")?.getattr("SimpleNamespace")?.call((), Some(&self.told))
    }

    /// One entry per row.
    pub fn one<T: Element>(&self, name: &str, values: impl IntoIterator<Item = T>) -> PyResult<()> {
        self.columns.set_item(name, PyArray1::from_iter(self.columns.py(), values))
    }

    /// An array of any shape.
    pub fn shaped<T: Element, const N: usize>(
        &self,
        name: &str,
        shape: [usize; N],
        mut values: Vec<T>,
    ) -> PyResult<()>
    where
        [usize; N]: IntoDimension,
    {
        // Python keeps the vector itself, not the room that it grew in.
        values.shrink_to_fit();
        self.columns.set_item(name, PyArray1::from_vec(self.columns.py(), values).reshape(shape)?)
    }

    /// Rows of `width` entries; rows that end earlier are filled up.
    pub fn rows<T: Element + Clone, R: IntoIterator<Item = T>>(
        &self,
        name: &str,
        width: usize,
        missing: T,
        rows: impl IntoIterator<Item = R>,
    ) -> PyResult<()> {
        let (count, values) = filled(width, missing, rows);
        self.shaped(name, [count, width], values)
    }

    /// Real numbers, not-a-number where a row has none.
    pub fn numbers<'a>(
        &self,
        name: &str,
        width: usize,
        rows: impl IntoIterator<Item = &'a [f64]>,
    ) -> PyResult<()> {
        self.rows(name, width, f64::NAN, rows.into_iter().map(|row| row.iter().copied()))
    }

    /// Lowest and highest values `(rows, width, 2)`.
    pub fn ranges<'a>(
        &self,
        width: usize,
        rows: impl IntoIterator<Item = &'a [[f64; 2]]>,
    ) -> PyResult<()> {
        let flat = rows.into_iter().map(|row| row.iter().flatten().copied());
        let (count, values) = filled(2 * width, f64::NAN, flat);
        self.shaped("range", [count, width, 2], values)
    }

    /// Floquet multipliers, of which the neutral ones come first.
    pub fn multipliers<'a>(
        &self,
        width: usize,
        rows: impl Iterator<Item = (&'a [Complex64], usize)> + Clone,
    ) -> PyResult<()> {
        let values = rows.clone().map(|(values, _)| values.iter().copied());
        let missing = Complex64::new(f64::NAN, f64::NAN);
        self.rows("multipliers", width, missing, values)?;
        self.one("neutral", rows.map(|(_, neutral)| neutral as i64))
    }

    /// Amplitudes `(points, orders, width)` of points that each have their own highest order,
    /// padded with zeros to the highest of all.
    fn amplitudes<'a>(
        &self,
        name: &str,
        width: usize,
        points: impl ExactSizeIterator<Item = (usize, &'a [Complex64])> + Clone,
    ) -> PyResult<()> {
        let count = points.len();
        let orders = 1 + points.clone().map(|(highest, _)| highest).max().unwrap_or(0);
        let mut values = vec![Complex64::new(0.0, 0.0); count * orders * width];
        let size = (orders * width).max(1);
        for (own, (highest, amplitudes)) in values.chunks_exact_mut(size).zip(points) {
            for (i, series) in amplitudes.chunks_exact(highest + 1).take(width).enumerate() {
                series.iter().enumerate().for_each(|(order, a)| own[order * width + i] = *a);
            }
        }
        self.shaped(name, [count, orders, width], values)
    }

    /// What every periodic motion has.
    pub fn responses<'a>(
        &self,
        points: impl ExactSizeIterator<Item = &'a Point> + Clone,
        observed: usize,
        contacts: usize,
    ) -> PyResult<()> {
        let all = || points.clone();
        self.one("omega", all().map(|p| p.omega))?;
        self.one("harmonics", all().map(|p| p.harmonics as i64))?;
        self.one("samples", all().map(|p| p.samples.unwrap_or(0) as i64))?;
        self.one("status", all().map(|p| p.status as u8))?;
        self.one("residual", all().map(|p| p.residual))?;
        self.one("iterations", all().map(|p| p.iterations as i64))?;
        let series = |of: fn(&Point) -> &[Complex64]| all().map(move |p| (p.harmonics, of(p)));
        self.amplitudes("displacement", observed, series(|p| &p.displacement))?;
        self.amplitudes("contact_displacement", contacts, series(|p| &p.contact_displacement))?;
        self.amplitudes("contact_force", contacts, series(|p| &p.contact_force))?;
        self.bounds(points.clone(), observed)?;
        self.numbers("error_estimate", observed, all().map(|p| p.error_estimate.as_slice()))?;
        self.numbers("sampling_error", observed, all().map(|p| p.sampling_error.as_slice()))?;
        let share = all().map(|p| p.contacts.iter().map(|c| c.slip_fraction));
        self.rows("slip_fraction", contacts, f64::NAN, share)?;
        let work = all().map(|p| p.contacts.iter().map(|c| c.dissipation));
        self.rows("dissipation", contacts, f64::NAN, work)
    }

    /// Bounds over the residual tractions, not-a-number where they were not asked for.
    fn bounds<'a>(
        &self,
        points: impl Iterator<Item = &'a Point> + Clone,
        observed: usize,
    ) -> PyResult<()> {
        let all = || points.clone().map(|p| p.bounds.as_ref());
        let values = |of: fn(&AmplitudeBounds) -> &[f64]| all().map(move |b| b.map_or(&[][..], of));
        self.numbers("lower", observed, values(|bounds| &bounds.lower))?;
        self.numbers("upper", observed, values(|bounds| &bounds.upper))?;
        let unique = all().map(|bounds| uniqueness_code(bounds.map(|bounds| bounds.unique)));
        self.one("unique", unique)?;
        self.one("guaranteed", all().map(|bounds| bounds.is_some_and(|bounds| bounds.proved)))
    }

    /// Events between stick, slip and separation.
    pub fn events<'a>(&self, events: impl Iterator<Item = &'a Event> + Clone) -> PyResult<()> {
        let kind = |event: &Event| match event.state {
            PointState::Stuck => 0_u8,
            PointState::Forward => 1,
            PointState::Backward => 2,
            PointState::Open => 3,
            PointState::Sliding => 4,
        };
        self.one("event_time", events.clone().map(|event| event.time))?;
        self.one("event_point", events.clone().map(|event| event.point as i64))?;
        self.one("event_kind", events.map(kind))
    }
}

/// How many rows there are, and their entries, each row filled up to `width` of them.
fn filled<T: Clone, R: IntoIterator<Item = T>>(
    width: usize,
    missing: T,
    rows: impl IntoIterator<Item = R>,
) -> (usize, Vec<T>) {
    let (mut count, mut values) = (0, Vec::new());
    for row in rows {
        count += 1;
        values.extend(row);
        values.resize(count * width, missing.clone());
    }
    (count, values)
}

/// Number of what is known of residual tractions, as Python knows it; `None` where it was not asked.
pub fn uniqueness_code(unique: Option<Uniqueness>) -> u8 {
    match unique {
        Some(Uniqueness::Unique) => 0,
        Some(Uniqueness::Residual) => 1,
        Some(Uniqueness::Shakedown) => 2,
        None => 3,
        Some(Uniqueness::NotFound) => 4,
        Some(Uniqueness::NotDecided) => 5,
    }
}

/// Number of what is known of the stability of a motion, as Python knows it.
pub fn stability_code(stable: Option<bool>) -> u8 {
    match stable {
        Some(false) => 0,
        Some(true) => 1,
        None => 2,
    }
}

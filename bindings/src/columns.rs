//! Columns of a result: arrays by name, of which Python takes those that it knows.

use numpy::ndarray::IntoDimension;
use numpy::{Complex64, Element, PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyDict};
use pyo3::IntoPyObjectExt as _;
use stickslip_core::balance::{AmplitudeBounds, Point, Uniqueness};
use stickslip_core::contact::PointState;
use stickslip_core::motion::Event;
use stickslip_core::timing::Profile;

/// Something that becomes an object of Python, which takes no time.
type Make = Box<dyn FnOnce(Python<'_>) -> PyResult<Py<PyAny>> + Send>;

/// Columns that are being written, and what is told besides. Python is needed for `end` alone.
#[derive(Default)]
pub struct Columns {
    columns: Vec<(String, Make)>,
    told: Vec<(String, Make)>,
}

impl Columns {
    /// An attribute beside the columns.
    pub fn tell<T>(&mut self, name: &str, value: T)
    where
        T: for<'py> IntoPyObject<'py> + Send + 'static,
    {
        self.told.push((name.to_owned(), Box::new(move |py| value.into_py_any(py))));
    }

    /// Numbers by name, as an attribute beside the columns.
    pub fn tell_by_name<T, const N: usize>(&mut self, name: &str, values: [(&'static str, T); N])
    where
        T: for<'py> IntoPyObject<'py> + Send + 'static,
    {
        let dict = move |py: Python<'_>| Ok(values.into_py_dict(py)?.into_any().unbind());
        self.told.push((name.to_owned(), Box::new(dict)));
    }

    /// Seconds by stage and work by kind, of which `first` is counted elsewhere.
    pub fn effort(&mut self, profile: &Profile, first: (&'static str, usize)) {
        let timings = [
            ("compliance", profile.compliance),
            ("law", profile.law),
            ("linear_solve", profile.linear_solve),
            ("recovery", profile.recovery),
            ("estimate", profile.estimate),
            ("stability", profile.stability),
            ("total", profile.total),
        ];
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
        self.tell_by_name("timings", timings.map(|(stage, time)| (stage, time.as_secs_f64())));
        self.tell_by_name("counters", counters);
    }

    /// An object with the columns and all that was told.
    pub fn end(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let told = objects(py, self.told)?;
        told.set_item("columns", objects(py, self.columns)?)?;
        py.import("types")?.getattr("SimpleNamespace")?.call((), Some(&told))
    }

    /// One entry per row.
    pub fn one<T: Element + 'static>(&mut self, name: &str, values: impl IntoIterator<Item = T>) {
        let values: Vec<T> = values.into_iter().collect();
        self.shaped(name, [values.len()], values);
    }

    /// An array of any shape, of as many entries.
    pub fn shaped<T: Element + 'static, const N: usize>(
        &mut self,
        name: &str,
        shape: [usize; N],
        mut values: Vec<T>,
    ) where
        [usize; N]: IntoDimension,
        <[usize; N] as IntoDimension>::Dim: 'static,
    {
        // Python keeps the vector itself, not the room that it grew in.
        values.shrink_to_fit();
        let array = move |py: Python<'_>| {
            let made = PyArray1::from_vec(py, values).reshape(shape)?;
            Ok(made.into_any().unbind())
        };
        self.columns.push((name.to_owned(), Box::new(array)));
    }

    /// Rows of `width` entries; rows that end earlier are filled up.
    pub fn rows<T: Element + Clone + 'static, R: IntoIterator<Item = T>>(
        &mut self,
        name: &str,
        width: usize,
        missing: T,
        rows: impl IntoIterator<Item = R>,
    ) {
        let (count, values) = filled(width, missing, rows);
        self.shaped(name, [count, width], values);
    }

    /// Real numbers, not-a-number where a row has none.
    pub fn numbers<'a>(
        &mut self,
        name: &str,
        width: usize,
        rows: impl IntoIterator<Item = &'a [f64]>,
    ) {
        self.rows(name, width, f64::NAN, rows.into_iter().map(|row| row.iter().copied()));
    }

    /// Lowest and highest values `(rows, width, 2)`.
    pub fn ranges<'a>(&mut self, width: usize, rows: impl IntoIterator<Item = &'a [[f64; 2]]>) {
        let flat = rows.into_iter().map(|row| row.iter().flatten().copied());
        let (count, values) = filled(2 * width, f64::NAN, flat);
        self.shaped("range", [count, width, 2], values);
    }

    /// Floquet multipliers, of which the neutral ones come first.
    pub fn multipliers<'a>(
        &mut self,
        width: usize,
        rows: impl Iterator<Item = (&'a [Complex64], usize)> + Clone,
    ) {
        let values = rows.clone().map(|(values, _)| values.iter().copied());
        let missing = Complex64::new(f64::NAN, f64::NAN);
        self.rows("multipliers", width, missing, values);
        self.one("neutral", rows.map(|(_, neutral)| neutral as i64));
    }

    /// Amplitudes `(points, orders, width)` of points that each have their own highest order,
    /// padded with zeros to the highest of all.
    fn amplitudes<'a>(
        &mut self,
        name: &str,
        width: usize,
        points: impl ExactSizeIterator<Item = (usize, &'a [Complex64])> + Clone,
    ) {
        let count = points.len();
        let orders = 1 + points.clone().map(|(highest, _)| highest).max().unwrap_or(0);
        let mut values = vec![Complex64::new(0.0, 0.0); count * orders * width];
        let size = (orders * width).max(1);
        for (own, (highest, amplitudes)) in values.chunks_exact_mut(size).zip(points) {
            for (i, series) in amplitudes.chunks_exact(highest + 1).take(width).enumerate() {
                series.iter().enumerate().for_each(|(order, a)| own[order * width + i] = *a);
            }
        }
        self.shaped(name, [count, orders, width], values);
    }

    /// What every periodic motion has.
    pub fn responses<'a>(
        &mut self,
        points: impl ExactSizeIterator<Item = &'a Point> + Clone,
        observed: usize,
        contacts: usize,
    ) {
        let all = || points.clone();
        self.one("omega", all().map(|p| p.omega));
        self.one("harmonics", all().map(|p| p.harmonics as i64));
        self.one("samples", all().map(|p| p.samples.unwrap_or(0) as i64));
        self.one("status", all().map(|p| p.status as u8));
        self.one("residual", all().map(|p| p.residual));
        self.one("iterations", all().map(|p| p.iterations as i64));
        let series = |of: fn(&Point) -> &[Complex64]| all().map(move |p| (p.harmonics, of(p)));
        self.amplitudes("displacement", observed, series(|p| &p.displacement));
        self.amplitudes("contact_displacement", contacts, series(|p| &p.contact_displacement));
        self.amplitudes("contact_force", contacts, series(|p| &p.contact_force));
        self.bounds(points.clone(), observed);
        self.numbers("error_estimate", observed, all().map(|p| p.error_estimate.as_slice()));
        self.numbers("sampling_error", observed, all().map(|p| p.sampling_error.as_slice()));
        let share = all().map(|p| p.contacts.iter().map(|c| c.slip_fraction));
        self.rows("slip_fraction", contacts, f64::NAN, share);
        let work = all().map(|p| p.contacts.iter().map(|c| c.dissipation));
        self.rows("dissipation", contacts, f64::NAN, work);
    }

    /// Bounds over the residual tractions, not-a-number where they were not asked for.
    fn bounds<'a>(&mut self, points: impl Iterator<Item = &'a Point> + Clone, observed: usize) {
        let all = || points.clone().map(|p| p.bounds.as_ref());
        let values = |of: fn(&AmplitudeBounds) -> &[f64]| all().map(move |b| b.map_or(&[][..], of));
        self.numbers("lower", observed, values(|bounds| &bounds.lower));
        self.numbers("upper", observed, values(|bounds| &bounds.upper));
        let unique = all().map(|bounds| uniqueness_code(bounds.map(|bounds| bounds.unique)));
        self.one("unique", unique);
        self.one("guaranteed", all().map(|bounds| bounds.is_some_and(|bounds| bounds.proved)));
    }

    /// Events between stick, slip and separation.
    pub fn events<'a>(&mut self, events: impl Iterator<Item = &'a Event> + Clone) {
        let kind = |event: &Event| match event.state {
            PointState::Stuck => 0_u8,
            PointState::Forward => 1,
            PointState::Backward => 2,
            PointState::Open => 3,
            PointState::Sliding => 4,
        };
        self.one("event_time", events.clone().map(|event| event.time));
        self.one("event_point", events.clone().map(|event| event.point as i64));
        self.one("event_kind", events.map(kind));
    }
}

/// Objects of Python by their names.
fn objects(py: Python<'_>, made: Vec<(String, Make)>) -> PyResult<Bound<'_, PyDict>> {
    let objects = PyDict::new(py);
    made.into_iter().try_for_each(|(name, make)| objects.set_item(name, make(py)?))?;
    Ok(objects)
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

//! The problem: structure, contacts and loads in numbers.

use crate::arrays::{matrices, matrix, refused, sparse, Array1, Array2, Array3};
use crate::python_law::PythonLaw;
use crate::settings::residual;
use crate::watch::whole;
use numpy::{Complex64, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Arc, OnceLock};
use stickslip_core::balance::with_history;
use stickslip_core::contact::{law as registered, ContactLaw, Parameters, Residual};
use stickslip_core::model::{Contact, Model, SectorContact};
use stickslip_core::structure::{
    CyclicMatrix, CyclicStructure, HarmonicLoad, RingCoupling, Structure,
};
use stickslip_core::Error;

pub type Table<'py> = Array2<'py, f64>;
/// A law by its name, or as an object of Python that is one; rows of B; parameters.
type ContactSpec<'py> = (Bound<'py, PyAny>, Table<'py>, Bound<'py, PyDict>);
pub type SectorContactSpec<'py> = (Bound<'py, PyAny>, Table<'py>, Table<'py>, Bound<'py, PyDict>);
pub type Forces<'py> = Vec<(usize, Array1<'py, Complex64>)>;

/// A structure with its contacts and loads, decomposed once.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Problem {
    pub model: Arc<Model>,
    loaded: OnceLock<Arc<Model>>,
}

impl Problem {
    /// The problem of a model that is built without the interpreter.
    pub fn of(
        py: Python<'_>,
        model: impl FnOnce() -> Result<Model, Error> + Send + 'static,
    ) -> PyResult<Self> {
        let model = Arc::new(whole(py, move |_| model())?);
        Ok(Self { model, loaded: OnceLock::new() })
    }

    /// The model by which contacts that keep a residual answer to their motion: by
    /// [`Residual::FromRest`] that with the history of its static loads.
    ///
    /// # Errors
    /// As [`with_history`].
    pub fn assuming(&self, residual: Residual) -> Result<&Arc<Model>, Error> {
        if residual != Residual::FromRest {
            return Ok(&self.model);
        }
        if let Some(known) = self.loaded.get() {
            return Ok(known);
        }
        let made = with_history(&self.model)?.map(Arc::new);
        Ok(self.loaded.get_or_init(|| made.unwrap_or_else(|| Arc::clone(&self.model))))
    }
}

#[pymethods]
impl Problem {
    /// Whether x(t + T/2) = -x(t) in the steady motion.
    fn half_wave(&self, #[pyo3(from_py_with = residual)] residual: Residual) -> bool {
        self.model.is_symmetric() && residual.is_symmetric()
    }

    /// Whether what contacts do in free motions depends on the state at rest.
    fn biased(&self) -> bool {
        self.model.is_biased()
    }

    /// Builds the problem from matrices, an iterable of contacts `(law, rows, parameters)`, which are many
    /// and not kept, and forces
    /// `(harmonic, amplitude per DOF)`; `proportional` says that a law made the damping, one that
    /// couples none of the modes without contacts.
    #[new]
    fn new(
        py: Python<'_>,
        mass: Table<'_>,
        damping: Table<'_>,
        stiffness: Table<'_>,
        contacts: &Bound<'_, PyAny>,
        forces: Forces<'_>,
        proportional: bool,
    ) -> PyResult<Self> {
        let (mass, damping, stiffness) = (sparse(&mass), sparse(&damping), sparse(&stiffness));
        let contact = |given: PyResult<Bound<'_, PyAny>>| {
            let (name, rows, given): ContactSpec<'_> = given?.extract()?;
            Ok(Contact { law: law_of(&name, &given)?, rows: sparse(&rows) })
        };
        let contacts = contacts.try_iter()?.map(contact).collect::<PyResult<Vec<_>>>()?;
        let loads = harmonic_loads(forces);
        Self::of(py, move || {
            let structure = Structure::of(mass, damping, stiffness)?;
            Model::new(structure.with_law(proportional), contacts, loads)
        })
    }

    /// Builds one sector of a tuned disk in a travelling wave. Matrices are `(block of the sector,
    /// block that couples it to the next)`, contacts `(law, rows on the sector, rows on the next,
    /// parameters)`, forces those on sector 0.
    #[staticmethod]
    fn travelling_wave(
        py: Python<'_>,
        mass: (Table<'_>, Table<'_>),
        damping: (Table<'_>, Table<'_>),
        stiffness: (Table<'_>, Table<'_>),
        sectors: usize,
        engine_order: usize,
        contacts: Vec<SectorContactSpec<'_>>,
        forces: Forces<'_>,
        proportional: bool,
    ) -> PyResult<Self> {
        let [mass, damping, stiffness] = [mass, damping, stiffness]
            .map(|(own, next)| CyclicMatrix::new(matrix(&own), matrix(&next)));
        let cyclic = CyclicStructure {
            mass,
            damping,
            stiffness,
            sectors,
            engine_order,
            proportional,
            massless: Vec::new(),
        };
        let contacts = sector_contacts(contacts)?;
        let loads = harmonic_loads(forces);
        Self::of(py, move || Model::travelling_wave(cyclic, contacts, loads))
    }

    /// Builds a ring of sectors that may differ. Matrices are `(blocks of the sectors, block that
    /// couples each to the next)`; contacts and forces are given sector by sector, as of a wave.
    #[staticmethod]
    fn ring(
        py: Python<'_>,
        mass: (Array3<'_, f64>, Table<'_>),
        damping: (Array3<'_, f64>, Table<'_>),
        stiffness: (Array3<'_, f64>, Table<'_>),
        contacts: Vec<Vec<SectorContactSpec<'_>>>,
        forces: Vec<Forces<'_>>,
        proportional: bool,
    ) -> PyResult<Self> {
        let coupling = ring_coupling([mass.1, damping.1, stiffness.1]);
        let blocks = [mass.0, damping.0, stiffness.0].map(|stack| matrices(&stack));
        let contacts = contacts.into_iter().map(sector_contacts).collect::<PyResult<Vec<_>>>()?;
        let loads = forces.into_iter().map(harmonic_loads).collect();
        Self::of(py, move || {
            let [mass, damping, stiffness] = &blocks;
            let sector = |n: usize| {
                let matrices = (mass[n].as_ref(), damping[n].as_ref(), stiffness[n].as_ref());
                let sector = Structure::new(matrices.0, matrices.1, matrices.2)?;
                Ok(sector.with_law(proportional))
            };
            let structures = (0..mass.len()).map(sector).collect::<Result<Vec<_>, Error>>()?;
            Model::ring(structures, coupling, contacts, loads)
        })
    }

    /// Natural frequencies [rad/s] with the points `(contact, point)` slipping, others stuck; of a
    /// travelling wave those of a nodal diameter.
    #[pyo3(signature = (slipping, diameter=None))]
    fn natural_frequencies<'py>(
        &self,
        py: Python<'py>,
        slipping: Vec<(usize, usize)>,
        diameter: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let model = Arc::clone(&self.model);
        let found = whole(py, move |_| match diameter {
            Some(diameter) => model.wave_frequencies(diameter, &slipping),
            None => model.natural_frequencies(&slipping),
        })?;
        Ok(PyArray1::from_vec(py, found))
    }

    /// The lowest frequency of a range at which nothing bounds each DOF, where there is one [rad/s].
    fn unbounded(&self, py: Python<'_>, span: (f64, f64)) -> PyResult<Vec<Option<f64>>> {
        let model = Arc::clone(&self.model);
        whole(py, move |look| model.unbounded(span, look))
    }

    /// Names of the contact laws that are no monotone operators of the motion.
    #[getter]
    fn laws_not_monotone(&self) -> Vec<&'static str> {
        let open = self.model.laws().iter().filter(|law| !law.is_monotone());
        open.map(|law| law.name()).collect()
    }

    /// Names of the contact laws whose harmonics are those of samples.
    #[getter]
    fn laws_sampled(&self) -> Vec<&'static str> {
        let sampled = self.model.laws().iter().filter(|law| law.closed_form().is_none());
        sampled.map(|law| law.name()).collect()
    }

    /// Which modes carry the compliance.
    #[getter]
    fn modal_base(&self) -> &'static str {
        self.model.modal_base()
    }

    /// Whether a frequency costs a factorisation per harmonic, of the whole or of a sector.
    #[getter]
    fn is_direct(&self) -> bool {
        self.model.compliance().is_direct()
    }

    /// Whether rigid-body motion remains with all contacts stuck.
    #[getter]
    fn static_singular(&self) -> bool {
        self.model.static_singular()
    }
}

/// A law by its name and its parameters, numbers, or lists of numbers, by name; or a law in Python.
fn law_of(law: &Bound<'_, PyAny>, given: &Bound<'_, PyDict>) -> PyResult<Box<dyn ContactLaw>> {
    let Ok(name) = law.extract::<String>() else { return Ok(Box::new(PythonLaw::new(law)?)) };
    let mut parameters = Parameters::new();
    for (key, value) in given.iter() {
        let values = value.extract().map(|number| vec![number]).or_else(|_| value.extract())?;
        parameters.insert(key.extract()?, values);
    }
    registered(&name, &parameters).map_err(refused)
}

pub fn sector_contacts(contacts: Vec<SectorContactSpec<'_>>) -> PyResult<Vec<SectorContact>> {
    let contact = |(name, own, next, given): SectorContactSpec<'_>| {
        Ok(SectorContact { law: law_of(&name, &given)?, own: matrix(&own), next: matrix(&next) })
    };
    contacts.into_iter().map(contact).collect()
}

/// Blocks of mass, damping and stiffness to the next sector.
pub fn ring_coupling(blocks: [Table<'_>; 3]) -> RingCoupling {
    let [mass, damping, stiffness] = blocks.map(|block| matrix(&block));
    RingCoupling { mass, damping, stiffness }
}

pub fn harmonic_loads(forces: Forces<'_>) -> Vec<HarmonicLoad> {
    let load = |(harmonic, amplitude): (usize, Array1<'_, Complex64>)| HarmonicLoad {
        harmonic,
        amplitude: amplitude.as_array().iter().copied().collect(),
    };
    forces.into_iter().map(load).collect()
}

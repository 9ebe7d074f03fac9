//! The problem: structure, contacts and loads in numbers.

use crate::arrays::{matrix, refused, vector};
use numpy::{Complex64, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::contact::{law, Parameters};
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

type ContactSpec<'py> = (String, PyReadonlyArray2<'py, f64>, Bound<'py, PyDict>);

/// A structure with its contacts and loads, decomposed once.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Problem {
    pub model: Arc<Model>,
}

#[pymethods]
impl Problem {
    /// Builds the problem from matrices, contacts `(law, rows, parameters)` and forces
    /// `(harmonic, amplitude per DOF)`.
    #[new]
    fn new(
        py: Python<'_>,
        mass: PyReadonlyArray2<'_, f64>,
        damping: PyReadonlyArray2<'_, f64>,
        stiffness: PyReadonlyArray2<'_, f64>,
        contacts: Vec<ContactSpec<'_>>,
        forces: Vec<(usize, PyReadonlyArray1<'_, Complex64>)>,
    ) -> PyResult<Self> {
        let (mass, damping, stiffness) = (matrix(&mass), matrix(&damping), matrix(&stiffness));
        let mut specs = Vec::with_capacity(contacts.len());
        for (name, rows, dictionary) in contacts {
            let mut parameters = Parameters::new();
            for (key, value) in dictionary.iter() {
                let values = value
                    .extract::<f64>()
                    .map(|v| vec![v])
                    .or_else(|_| value.extract::<Vec<f64>>())?;
                parameters.insert(key.extract()?, values);
            }
            specs.push((name, matrix(&rows), parameters));
        }
        let loads = forces
            .into_iter()
            .map(|(harmonic, amplitude)| HarmonicLoad {
                harmonic,
                amplitude: amplitude.as_array().iter().copied().collect(),
            })
            .collect();
        let model = py
            .detach(|| {
                let contacts = specs
                    .into_iter()
                    .map(|(name, rows, parameters)| {
                        Ok(Contact { law: law(&name, &parameters)?, rows })
                    })
                    .collect::<Result<Vec<_>, stickslip_core::Error>>()?;
                let structure =
                    Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref())?;
                Model::new(structure, contacts, loads)
            })
            .map_err(refused)?;
        Ok(Self { model: Arc::new(model) })
    }

    /// Natural frequencies [rad/s] with the points `(contact, point)` slipping, others stuck.
    fn natural_frequencies<'py>(
        &self,
        py: Python<'py>,
        slipping: Vec<(usize, usize)>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let frequencies =
            py.detach(|| self.model.natural_frequencies(&slipping)).map_err(refused)?;
        Ok(vector(py, frequencies))
    }

    /// Which modes carry the compliance.
    #[getter]
    fn modal_base(&self) -> &'static str {
        self.model.modal_base()
    }

    /// Whether rigid-body motion remains with all contacts stuck.
    #[getter]
    fn static_singular(&self) -> bool {
        self.model.static_singular()
    }
}

//! The problem: structure, contacts and loads in numbers.

use crate::arrays::{matrices, matrix, refused, vector, Array1, Array2, Array3};
use crate::settings::ResidualArgument;
use crate::watch::whole;
use numpy::{Complex64, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::contact::{law, Parameters};
use stickslip_core::model::{Contact, Model, SectorContact};
use stickslip_core::structure::{
    CyclicMatrix, CyclicStructure, HarmonicLoad, RingCoupling, Structure,
};

pub type Matrix<'py> = Array2<'py, f64>;
type ContactSpec<'py> = (String, Matrix<'py>, Bound<'py, PyDict>);
pub type SectorContactSpec<'py> = (String, Matrix<'py>, Matrix<'py>, Bound<'py, PyDict>);
type SectorMatrices<'py> = Array3<'py, f64>;
pub type Forces<'py> = Vec<(usize, Array1<'py, Complex64>)>;

/// A structure with its contacts and loads, decomposed once.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Problem {
    pub model: Arc<Model>,
}

#[pymethods]
impl Problem {
    /// Whether x(t + T/2) = -x(t) in the steady motion.
    fn half_wave(&self, residual: ResidualArgument) -> PyResult<bool> {
        Ok(self.model.is_symmetric() && residual.parse()?.is_symmetric())
    }

    /// Builds the problem from matrices, contacts `(law, rows, parameters)` and forces
    /// `(harmonic, amplitude per DOF)`; `proportional` says that a law made the damping, one that
    /// couples none of the modes without contacts.
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        mass: Array2<'_, f64>,
        damping: Array2<'_, f64>,
        stiffness: Array2<'_, f64>,
        contacts: Vec<ContactSpec<'_>>,
        forces: Forces<'_>,
        proportional: bool,
    ) -> PyResult<Self> {
        let (mass, damping, stiffness) = (matrix(&mass), matrix(&damping), matrix(&stiffness));
        let specs = contacts
            .into_iter()
            .map(|(name, rows, dictionary)| Ok((name, matrix(&rows), parameters(&dictionary)?)))
            .collect::<PyResult<Vec<_>>>()?;
        let loads = harmonic_loads(forces);
        let model = whole(py, move |_| {
            let contacts = specs
                .into_iter()
                .map(|(name, rows, parameters)| Ok(Contact { law: law(&name, &parameters)?, rows }))
                .collect::<Result<Vec<_>, stickslip_core::Error>>()?;
            let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref())?;
            Model::new(structure.with_law(proportional), contacts, loads)
        })?
        .map_err(refused)?;
        Ok(Self { model: Arc::new(model) })
    }

    /// Builds one sector of a tuned disk in a travelling wave. Matrices are `(block of the sector,
    /// block that couples it to the next)`, contacts `(law, rows on the sector, rows on the next,
    /// parameters)`, forces those on sector 0.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn travelling_wave(
        py: Python<'_>,
        mass: (Matrix<'_>, Matrix<'_>),
        damping: (Matrix<'_>, Matrix<'_>),
        stiffness: (Matrix<'_>, Matrix<'_>),
        sectors: usize,
        engine_order: usize,
        contacts: Vec<SectorContactSpec<'_>>,
        forces: Forces<'_>,
        proportional: bool,
    ) -> PyResult<Self> {
        let [mass, damping, stiffness] = [mass, damping, stiffness]
            .map(|(own, next)| CyclicMatrix::new(matrix(&own), matrix(&next)));
        let cyclic =
            CyclicStructure { mass, damping, stiffness, sectors, engine_order, proportional };
        let contacts = sector_contacts(contacts)?;
        let loads = harmonic_loads(forces);
        let model = whole(py, move |_| Model::travelling_wave(cyclic, contacts, loads))?
            .map_err(refused)?;
        Ok(Self { model: Arc::new(model) })
    }

    /// Builds a ring of sectors that may differ. Matrices are `(blocks of the sectors, block that
    /// couples each to the next)`; contacts and forces are given sector by sector, as of a wave.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn ring(
        py: Python<'_>,
        mass: (SectorMatrices<'_>, Matrix<'_>),
        damping: (SectorMatrices<'_>, Matrix<'_>),
        stiffness: (SectorMatrices<'_>, Matrix<'_>),
        contacts: Vec<Vec<SectorContactSpec<'_>>>,
        forces: Vec<Forces<'_>>,
        proportional: bool,
    ) -> PyResult<Self> {
        let coupling = RingCoupling {
            mass: matrix(&mass.1),
            damping: matrix(&damping.1),
            stiffness: matrix(&stiffness.1),
        };
        let [mass, damping, stiffness] =
            [mass.0, damping.0, stiffness.0].map(|stack| matrices(&stack));
        let contacts = contacts.into_iter().map(sector_contacts).collect::<PyResult<Vec<_>>>()?;
        let loads = forces.into_iter().map(harmonic_loads).collect();
        let model = whole(py, move |_| {
            let structures = mass
                .iter()
                .zip(&damping)
                .zip(&stiffness)
                .map(|((m, c), k)| {
                    let sector = Structure::new(m.as_ref(), c.as_ref(), k.as_ref())?;
                    Ok(sector.with_law(proportional))
                })
                .collect::<Result<Vec<_>, stickslip_core::Error>>()?;
            Model::ring(structures, coupling, contacts, loads)
        })?
        .map_err(refused)?;
        Ok(Self { model: Arc::new(model) })
    }

    /// Natural frequencies [rad/s] of a travelling wave of a nodal diameter, with the points
    /// `(contact, point)` slipping, others stuck.
    fn wave_frequencies<'py>(
        &self,
        py: Python<'py>,
        diameter: usize,
        slipping: Vec<(usize, usize)>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let model = Arc::clone(&self.model);
        let frequencies =
            whole(py, move |_| model.wave_frequencies(diameter, &slipping))?.map_err(refused)?;
        Ok(vector(py, frequencies))
    }

    /// Natural frequencies [rad/s] with the points `(contact, point)` slipping, others stuck.
    fn natural_frequencies<'py>(
        &self,
        py: Python<'py>,
        slipping: Vec<(usize, usize)>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let model = Arc::clone(&self.model);
        let frequencies =
            whole(py, move |_| model.natural_frequencies(&slipping))?.map_err(refused)?;
        Ok(vector(py, frequencies))
    }

    /// Names of the contact laws that are no monotone operators of the motion.
    #[getter]
    fn laws_not_monotone(&self) -> Vec<&'static str> {
        let open = self.model.laws().iter().filter(|law| !law.is_monotone());
        open.map(|law| law.name()).collect()
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

/// Parameters of a law: numbers, or lists of numbers, by name.
fn parameters(dictionary: &Bound<'_, PyDict>) -> PyResult<Parameters> {
    let mut parameters = Parameters::new();
    for (key, value) in dictionary.iter() {
        let values =
            value.extract::<f64>().map(|v| vec![v]).or_else(|_| value.extract::<Vec<f64>>())?;
        parameters.insert(key.extract()?, values);
    }
    Ok(parameters)
}

pub fn sector_contacts(contacts: Vec<SectorContactSpec<'_>>) -> PyResult<Vec<SectorContact>> {
    contacts
        .into_iter()
        .map(|(name, own, next, dictionary)| {
            let law = law(&name, &parameters(&dictionary)?).map_err(refused)?;
            Ok(SectorContact { law, own: matrix(&own), next: matrix(&next) })
        })
        .collect()
}

pub fn harmonic_loads(forces: Forces<'_>) -> Vec<HarmonicLoad> {
    let load = |(harmonic, amplitude): (usize, Array1<'_, Complex64>)| HarmonicLoad {
        harmonic,
        amplitude: amplitude.as_array().iter().copied().collect(),
    };
    forces.into_iter().map(load).collect()
}

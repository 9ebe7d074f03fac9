//! A model in the modes of its stuck structure, harmonic by harmonic: nothing is truncated, and no
//! frequency is needed before there is one.

use super::body::Body;
use super::Model;
use crate::structure::{HermitianModes, Modes};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::sync::Arc;

/// Stuck frequencies below this share of the highest are those of rigid-body modes.
const RIGID: f64 = 1e-7;
/// Contact displacement of a rigid-body mode, relative to the largest of all modes, that counts as none.
const STILL: f64 = 1e-8;
/// Damping between two modes, relative to the largest, that is rounding.
const UNCOUPLED: f64 = 1e-13;

/// A complex matrix as real and imaginary part; the latter is missing if it vanishes.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    real: Mat<f64>,
    imaginary: Option<Mat<f64>>,
}

impl Parts {
    fn new(matrix: MatRef<'_, c64>) -> Self {
        let (rows, columns) = (matrix.nrows(), matrix.ncols());
        let part = |of: fn(c64) -> f64| Mat::from_fn(rows, columns, |i, j| of(matrix[(i, j)]));
        let imaginary = part(|z| z.im);
        Self { real: part(|z| z.re), imaginary: (imaginary.norm_max() > 0.0).then_some(imaginary) }
    }

    /// The matrix as one.
    pub(crate) fn matrix(&self) -> Mat<c64> {
        let imaginary = |i, j| self.imaginary.as_ref().map_or(0.0, |part| part[(i, j)]);
        Mat::from_fn(self.real.nrows(), self.real.ncols(), |i, j| {
            c64::new(self.real[(i, j)], imaginary(i, j))
        })
    }

    /// The matrix, if it is real.
    pub(crate) fn as_real(&self) -> Option<MatRef<'_, f64>> {
        self.imaginary.is_none().then(|| self.real.as_ref())
    }

    /// The product with the amplitudes `a − i b`; a mean has no b.
    pub(crate) fn times(&self, series: MatRef<'_, f64>) -> Mat<f64> {
        let mut out = &self.real * series;
        if let (Some(imaginary), 2) = (&self.imaginary, series.ncols()) {
            let turned = imaginary * series;
            for i in 0..out.nrows() {
                out[(i, 0)] += turned[(i, 1)];
                out[(i, 1)] -= turned[(i, 0)];
            }
        }
        out
    }

    /// The same with the adjoint matrix.
    pub(crate) fn adjoint_times(&self, series: MatRef<'_, f64>) -> Mat<f64> {
        let mut out = self.real.transpose() * series;
        if let (Some(imaginary), 2) = (&self.imaginary, series.ncols()) {
            let turned = imaginary.transpose() * series;
            for i in 0..out.nrows() {
                out[(i, 0)] -= turned[(i, 1)];
                out[(i, 1)] += turned[(i, 0)];
            }
        }
        out
    }
}

/// The modes of the stuck structure, of unit modal mass, as one harmonic sees them.
#[derive(Debug)]
pub(crate) struct ModalBasis {
    /// Squared natural frequencies [1/s²].
    pub(crate) squared: Vec<f64>,
    /// Displacements of the DOFs, N × modes.
    pub(crate) shapes: Mat<c64>,
    /// Displacements of the contacts, contacts × modes.
    pub(crate) contacts: Parts,
    /// Modal damping, modes × modes [1/s]: its diagonal, …
    pub(crate) damping: Vec<f64>,
    /// … and the rest of it, if it couples modes.
    pub(crate) coupling: Option<Parts>,
    /// Modal static load, of the mean [N/√kg].
    pub(crate) load: Vec<f64>,
    /// Rigid-body modes that move no contact and bear no static load: their mean is free.
    pub(crate) free: Vec<bool>,
}

impl ModalBasis {
    fn new(
        modes: HermitianModes,
        damping: &Mat<c64>,
        rows: &Mat<c64>,
        load: Option<&[c64]>,
    ) -> Self {
        let Modes { omega_squared: squared, shapes } = modes;
        let modal = shapes.adjoint().to_owned() * damping * &shapes;
        let size = squared.len();
        let diagonal = (0..size).map(|j| modal[(j, j)].re).collect();
        let rest =
            Mat::from_fn(
                size,
                size,
                |i, j| {
                    if i == j {
                        c64::new(0.0, 0.0)
                    } else {
                        modal[(i, j)]
                    }
                },
            );
        let coupled = rest.norm_max() > UNCOUPLED * modal.norm_max();
        let contacts = rows * &shapes;
        let load: Vec<f64> = (0..size)
            .map(|j| {
                let along =
                    |load: &[c64]| (0..load.len()).map(|i| shapes[(i, j)].re * load[i].re).sum();
                load.map_or(0.0, along)
            })
            .collect();
        let highest = squared.last().copied().unwrap_or(0.0);
        let loaded = load.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let free = (0..size).map(|j| {
            let seen = (0..contacts.nrows())
                .any(|i| contacts[(i, j)].norm() > STILL * contacts.norm_max());
            squared[j] <= RIGID * RIGID * highest && !seen && load[j].abs() <= STILL * loaded
        });
        Self {
            free: free.collect(),
            contacts: Parts::new(contacts.as_ref()),
            coupling: coupled.then(|| Parts::new(rest.as_ref())),
            damping: diagonal,
            squared,
            shapes,
            load,
        }
    }

    /// Number of modes.
    pub(crate) fn modes(&self) -> usize {
        self.squared.len()
    }
}

/// The bases of the harmonics 0 to a highest one; harmonics that see the same share one.
#[derive(Debug, Clone)]
pub(crate) struct ModalBases {
    by_diameter: Vec<Option<Arc<ModalBasis>>>,
    engine_order: usize,
    /// That of the fundamental.
    first: Arc<ModalBasis>,
}

impl ModalBases {
    /// The basis of a harmonic, one of those that were asked for.
    pub(crate) fn at(&self, harmonic: usize) -> &ModalBasis {
        let diameter = (harmonic * self.engine_order) % self.by_diameter.len();
        self.by_diameter[diameter].as_deref().unwrap_or(&self.first)
    }

    /// Displacements of the contacts, if all harmonics see the same real ones.
    pub(crate) fn common(&self) -> Option<MatRef<'_, f64>> {
        let shapes = self.first.contacts.as_real();
        shapes.filter(|_| self.by_diameter.len() == 1)
    }
}

impl Model {
    /// The model in the modes of its stuck structure, for harmonics up to `highest`. Loads but static
    /// ones are left out.
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub(crate) fn modal_bases(&self, highest: usize) -> Result<ModalBases, Error> {
        let stiffness = crate::structure::complex(self.ports.stiffness.as_ref());
        let load = self.ports.loads.iter().find(|load| load.harmonic == 0);
        let load = load.map(|load| load.amplitude.as_slice());
        let of = |[mass, damping, stiff]: [Mat<c64>; 3], rows: Mat<c64>, load: Option<&[c64]>| {
            let restrained = stiff + rows.adjoint() * (&stiffness * &rows);
            let modes = crate::structure::modes(mass.as_ref(), restrained.as_ref())?;
            Ok(Arc::new(ModalBasis::new(modes, &damping, &rows, load)))
        };
        if let Body::Wave { cyclic, next } = &self.body {
            let mut by_diameter = vec![None; cyclic.sectors];
            for harmonic in 0..=highest {
                let diameter = cyclic.diameter(harmonic);
                if by_diameter[diameter].is_none() {
                    let rows =
                        cyclic.rows_at(diameter, self.ports.rows.as_ref(), next.as_ref().as_ref());
                    let load = load.filter(|_| diameter == 0);
                    by_diameter[diameter] = Some(of(cyclic.at_diameter(diameter), rows, load)?);
                }
            }
            let first = by_diameter[cyclic.diameter(1)].clone();
            let first =
                first.ok_or_else(|| Error::value("harmonics", 0.0, "must be at least 1"))?;
            let engine_order = cyclic.engine_order % cyclic.sectors;
            return Ok(ModalBases { by_diameter, engine_order, first });
        }
        // Real modes keep their digits and their price.
        let structure = &self.structure;
        let rows = self.ports.rows.as_ref();
        let restrained = structure.restrained_stiffness(&self.ports.rows, &self.ports.stiffness);
        let modes = crate::structure::modes(structure.mass(), restrained.as_ref())?;
        let modes = Modes {
            shapes: crate::structure::complex(modes.shapes.as_ref()),
            omega_squared: modes.omega_squared,
        };
        let [damping, rows] = [structure.damping(), rows].map(crate::structure::complex);
        let first = Arc::new(ModalBasis::new(modes, &damping, &rows, load));
        Ok(ModalBases { by_diameter: vec![Some(Arc::clone(&first))], engine_order: 0, first })
    }
}

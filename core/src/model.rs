//! A structure with its contacts and loads: the problem, before any setting or solver.

use crate::contact::{FrictionLaw, Marched};
use crate::structure::{
    compliance, natural_frequencies, Compliance, HarmonicLoad, Ports, Structure,
};
use crate::Error;
use faer::{Mat, Side};
use std::ops::Range;
use std::sync::Arc;

/// One contact: its law and the rows of B that give its relative displacements.
#[derive(Debug)]
pub struct Contact {
    /// The friction law.
    pub law: Box<dyn FrictionLaw>,
    /// Rows of B, points × N.
    pub rows: Mat<f64>,
}

/// Structure, contacts and loads, with the compliance of the stuck structure at hand.
pub struct Model {
    structure: Arc<Structure>,
    ports: Arc<Ports>,
    laws: Vec<Box<dyn FrictionLaw>>,
    points: Vec<Range<usize>>,
    compliance: Arc<dyn Compliance>,
    modal_base: &'static str,
}

impl Model {
    /// Assembles the problem and decomposes the structure once.
    ///
    /// # Errors
    /// Shapes that do not fit the structure, numbers that are not finite, an eigenvalue iteration
    /// that fails.
    pub fn new(
        structure: Structure,
        contacts: Vec<Contact>,
        loads: Vec<HarmonicLoad>,
    ) -> Result<Self, Error> {
        let total: usize = contacts.iter().map(|contact| contact.law.points()).sum();
        let mut rows = Mat::zeros(total, structure.dofs());
        let mut stiffness = Mat::zeros(total, total);
        let (mut laws, mut points, mut first) = (Vec::new(), Vec::new(), 0);
        for (index, Contact { law, rows: own }) in contacts.into_iter().enumerate() {
            let size = law.points();
            let entry = format!("contact {}", index + 1);
            if (own.nrows(), own.ncols()) != (size, structure.dofs()) {
                return Err(Error::shape(
                    &entry,
                    format!("rows of shape {size} x {}", structure.dofs()),
                    format!("{} x {}", own.nrows(), own.ncols()),
                ));
            }
            if (0..size).any(|i| (0..own.ncols()).any(|j| !own[(i, j)].is_finite())) {
                return Err(Error::value(entry, f64::NAN, "its rows must be finite"));
            }
            let own_stiffness = law.stiffness();
            rows.get_mut(first..first + size, ..).copy_from(&own);
            stiffness.get_mut(first..first + size, first..first + size).copy_from(&own_stiffness);
            points.push(first..first + size);
            laws.push(law);
            first += size;
        }
        let ports = Ports { rows, stiffness, loads };
        let (compliance, modal_base) = compliance(&structure, &ports)?;
        let (structure, ports) = (Arc::new(structure), Arc::new(ports));
        Ok(Self { structure, ports, laws, points, compliance: compliance.into(), modal_base })
    }

    /// The same structure, contacts and loads under other laws. The decomposition is shared if the
    /// stiffness of the contacts is the same.
    ///
    /// # Errors
    /// Laws that do not fit the contacts, an eigenvalue iteration that fails.
    pub fn with_laws(&self, laws: Vec<Box<dyn FrictionLaw>>) -> Result<Self, Error> {
        let sizes = |laws: &[Box<dyn FrictionLaw>]| laws.iter().map(|l| l.points()).collect();
        let (expected, got): (Vec<usize>, Vec<usize>) = (sizes(&self.laws), sizes(&laws));
        if expected != got {
            return Err(Error::shape("laws", format!("{expected:?} points"), format!("{got:?}")));
        }
        let mut ports = Ports::clone(&self.ports);
        for (law, range) in laws.iter().zip(&self.points) {
            ports.stiffness.get_mut(range.clone(), range.clone()).copy_from(&law.stiffness());
        }
        let (compliance, modal_base) = if ports.stiffness == self.ports.stiffness {
            (Arc::clone(&self.compliance), self.modal_base)
        } else {
            let (compliance, base) = compliance(&self.structure, &ports)?;
            (Arc::from(compliance), base)
        };
        let (structure, points) = (Arc::clone(&self.structure), self.points.clone());
        let ports = Arc::new(ports);
        Ok(Self { structure, ports, laws, points, compliance, modal_base })
    }

    /// The same problem with every law evaluated by marching through `samples` instants per period
    /// (see [`Marched`]), on the same decomposition.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub fn marched(&self, samples: usize) -> Result<Self, Error> {
        let mut laws: Vec<Box<dyn FrictionLaw>> = Vec::with_capacity(self.laws.len());
        for law in &self.laws {
            laws.push(Box::new(Marched::new(law.softened(1.0), samples)?));
        }
        Ok(Self {
            structure: Arc::clone(&self.structure),
            ports: Arc::clone(&self.ports),
            laws,
            points: self.points.clone(),
            compliance: Arc::clone(&self.compliance),
            modal_base: self.modal_base,
        })
    }

    /// Highest harmonic that the evaluation of every law resolves.
    #[must_use]
    pub fn resolves(&self) -> usize {
        self.laws.iter().map(|law| law.resolves()).min().unwrap_or(usize::MAX)
    }

    /// The structure without its contacts.
    #[must_use]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Contacts and loads of the structure.
    #[must_use]
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// The friction laws, in the order of the contacts.
    #[must_use]
    pub fn laws(&self) -> &[Box<dyn FrictionLaw>] {
        &self.laws
    }

    /// Rows of B that belong to each contact.
    #[must_use]
    pub fn points(&self) -> &[Range<usize>] {
        &self.points
    }

    /// Compliance of the stuck structure.
    #[must_use]
    pub fn compliance(&self) -> &dyn Compliance {
        self.compliance.as_ref()
    }

    /// Which modes carry the compliance, in words.
    #[must_use]
    pub fn modal_base(&self) -> &'static str {
        self.modal_base
    }

    /// Contact stiffness D of all points [N/m].
    #[must_use]
    pub fn contact_stiffness(&self) -> &Mat<f64> {
        &self.ports.stiffness
    }

    /// Whether rigid-body motion remains with all contacts stuck.
    #[must_use]
    pub fn static_singular(&self) -> bool {
        let mut receptance = crate::structure::Receptance::default();
        self.compliance.receptance(0, 0.0, &mut receptance).is_err()
    }

    /// Whether the motion has half-wave symmetry: odd laws under odd harmonics alone.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.laws.iter().all(|law| law.is_odd())
            && self.compliance.forced_harmonics().iter().all(|k| k % 2 == 1)
    }

    /// Natural frequencies [rad/s] with the contact points `slipping` at constant force and all
    /// others stuck: slipping points are condensed statically, `D_TT − D_TS D_SS⁻¹ D_ST`
    /// (Guillen 1999, eqs. 6.14-6.17).
    ///
    /// # Errors
    /// A point that does not exist, or an eigenvalue iteration that fails.
    pub fn natural_frequencies(&self, slipping: &[(usize, usize)]) -> Result<Vec<f64>, Error> {
        let total = self.ports.rows.nrows();
        let mut slips = vec![false; total];
        for &(contact, point) in slipping {
            let index = self
                .points
                .get(contact)
                .filter(|range| point < range.len())
                .map(|range| range.start + point)
                .ok_or_else(|| {
                    Error::shape(
                        &format!("slipping: ({contact}, {point})"),
                        "an existing contact and point",
                        format!("{} contacts with {total} points", self.points.len()),
                    )
                })?;
            slips[index] = true;
        }
        let (slip, stick): (Vec<usize>, Vec<usize>) = (0..total).partition(|&i| slips[i]);
        let stiffness = condensed(&self.ports.stiffness, &stick, &slip)?;
        let rows =
            Mat::from_fn(stick.len(), self.structure.dofs(), |i, j| self.ports.rows[(stick[i], j)]);
        let restrained = self.structure.restrained_stiffness(rows.as_ref(), stiffness.as_ref());
        natural_frequencies(self.structure.mass(), restrained.as_ref())
    }
}

/// `D_TT − D_TS D_SS⁺ D_ST`: directions in which the slipping points meet no stiffness among
/// themselves carry no force and drop out.
fn condensed(stiffness: &Mat<f64>, stick: &[usize], slip: &[usize]) -> Result<Mat<f64>, Error> {
    let part = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |i, j| stiffness[(rows[i], columns[j])])
    };
    let stuck = part(stick, stick);
    if slip.is_empty() || stick.is_empty() {
        return Ok(stuck);
    }
    let eigen = part(slip, slip)
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| Error::Eigenvalues("contact stiffness".to_owned()))?;
    let largest = (0..slip.len()).map(|j| eigen.S()[j]).fold(0.0, f64::max);
    let mut modal = eigen.U().transpose() * part(slip, stick);
    let mut weighted = modal.clone();
    for i in 0..slip.len() {
        let value = eigen.S()[i];
        let inverse = if value > 1e-12 * largest { 1.0 / value } else { 0.0 };
        for j in 0..stick.len() {
            weighted[(i, j)] *= inverse;
            modal[(i, j)] *= f64::from(u8::from(inverse > 0.0));
        }
    }
    Ok(stuck - modal.transpose() * weighted)
}

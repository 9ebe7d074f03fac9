//! A structure with its contacts and loads: the problem, before any setting or solver.

use crate::contact::{FrictionLaw, Marched};
use crate::structure::{
    compliance, natural_frequencies, Compliance, CyclicCompliance, CyclicPorts, CyclicStructure,
    HarmonicLoad, Ports, Ring, RingCoupling, RingSector, Structure,
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
    /// The cyclic structure of a travelling wave, with the rows of B on the next sector.
    wave: Option<(CyclicStructure, Mat<f64>)>,
}

/// One contact of a sector: its law and the rows of B on the sector itself and on the next one.
#[derive(Debug)]
pub struct SectorContact {
    /// The friction law.
    pub law: Box<dyn FrictionLaw>,
    /// Rows on the sector itself, points × N.
    pub own: Mat<f64>,
    /// Rows on the next sector, points × N.
    pub next: Mat<f64>,
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
        let dofs = structure.dofs();
        let gathered = Gathered::new(dofs, contacts.into_iter().map(|c| (c.law, vec![c.rows])))?;
        let Gathered { laws, points, rows: [rows, _], stiffness } = gathered;
        let ports = Ports { rows, stiffness, loads };
        let (compliance, modal_base) = compliance(&structure, &ports)?;
        Ok(Self {
            structure: Arc::new(structure),
            ports: Arc::new(ports),
            laws,
            points,
            compliance: compliance.into(),
            modal_base,
            wave: None,
        })
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
            wave: self.wave.clone(),
        })
    }

    /// Highest harmonic that the evaluation of every law resolves.
    #[must_use]
    pub fn resolves(&self) -> usize {
        self.laws.iter().map(|law| law.resolves()).min().unwrap_or(usize::MAX)
    }

    /// One sector of a tuned bladed disk in a travelling wave; `loads` are those on sector 0.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn travelling_wave(
        cyclic: CyclicStructure,
        contacts: Vec<SectorContact>,
        loads: Vec<HarmonicLoad>,
    ) -> Result<Self, Error> {
        let dofs = cyclic.dofs();
        let parts = contacts.into_iter().map(|c| (c.law, vec![c.own, c.next]));
        let Gathered { laws, points, rows: [own, next], stiffness } = Gathered::new(dofs, parts)?;
        let sector = CyclicPorts {
            own: own.clone(),
            next: next.clone(),
            stiffness: stiffness.clone(),
            loads: loads.clone(),
        };
        let structure = cyclic.sector()?;
        let compliance = CyclicCompliance::new(cyclic.clone(), sector)?;
        Ok(Self {
            structure: Arc::new(structure),
            ports: Arc::new(Ports { rows: own, stiffness, loads }),
            laws,
            points,
            compliance: Arc::new(compliance),
            modal_base: "waves",
            wave: Some((cyclic, next)),
        })
    }

    /// A disk of sectors that may differ, each coupled to the next one and the last to the first;
    /// contacts and loads are given sector by sector.
    ///
    /// # Errors
    /// As [`Model::new`]; other numbers of contacts than in sector 0.
    pub fn ring(
        structures: Vec<Structure>,
        coupling: RingCoupling,
        contacts: Vec<Vec<SectorContact>>,
        loads: Vec<Vec<HarmonicLoad>>,
    ) -> Result<Self, Error> {
        let count = structures.len();
        if (contacts.len(), loads.len()) != (count, count) {
            return Err(Error::shape(
                "sectors",
                format!("contacts and loads of {count} sectors"),
                format!("{} and {}", contacts.len(), loads.len()),
            ));
        }
        let mut parts = Vec::with_capacity(count);
        let (mut laws, mut points) = (Vec::new(), Vec::new());
        for ((structure, contacts), loads) in structures.into_iter().zip(contacts).zip(loads) {
            let rows = contacts.into_iter().map(|c| (c.law, vec![c.own, c.next]));
            let own = Gathered::new(structure.dofs(), rows)?;
            let first = points.last().map_or(0, |last: &Range<usize>| last.end);
            points.extend(own.points.iter().map(|r| first + r.start..first + r.end));
            laws.extend(own.laws);
            let [own_rows, next] = own.rows;
            parts.push(RingSector {
                structure,
                own: own_rows,
                next,
                stiffness: own.stiffness,
                loads,
            });
        }
        let ring = Ring::new(parts, coupling)?;
        let (structure, ports) = ring.assembled()?;
        Ok(Self {
            structure: Arc::new(structure),
            ports: Arc::new(ports),
            laws,
            points,
            compliance: Arc::new(ring),
            modal_base: "sectors",
            wave: None,
        })
    }

    /// Whether this is one sector of a disk in a travelling wave.
    #[must_use]
    pub fn is_travelling_wave(&self) -> bool {
        self.wave.is_some()
    }

    /// The structure without its contacts; of a travelling wave, the sector by itself.
    #[must_use]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Contacts and loads of the structure; of a travelling wave, without the next sector.
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
        let (stick, stiffness) = self.partition(slipping)?;
        let rows = picked(&self.ports.rows, &stick);
        let restrained = self.structure.restrained_stiffness(rows.as_ref(), stiffness.as_ref());
        natural_frequencies(self.structure.mass(), restrained.as_ref())
    }

    /// The same for a travelling wave, at a nodal diameter of its disk.
    ///
    /// # Errors
    /// As [`Model::natural_frequencies`]; a model that is no travelling wave.
    pub fn wave_frequencies(
        &self,
        diameter: usize,
        slipping: &[(usize, usize)],
    ) -> Result<Vec<f64>, Error> {
        let Some((cyclic, next)) = &self.wave else {
            return Err(Error::shape("model", "a travelling wave", "a structure without symmetry"));
        };
        let (stick, stiffness) = self.partition(slipping)?;
        let (own, next) = (picked(&self.ports.rows, &stick), picked(next, &stick));
        cyclic.natural_frequencies(diameter, own.as_ref(), next.as_ref(), stiffness.as_ref())
    }

    /// The points that stick, and their stiffness with the slipping ones condensed.
    fn partition(&self, slipping: &[(usize, usize)]) -> Result<(Vec<usize>, Mat<f64>), Error> {
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
        Ok((stick, stiffness))
    }
}

fn picked(rows: &Mat<f64>, which: &[usize]) -> Mat<f64> {
    Mat::from_fn(which.len(), rows.ncols(), |i, j| rows[(which[i], j)])
}

/// Contacts one after the other, their rows and their stiffness.
struct Gathered {
    laws: Vec<Box<dyn FrictionLaw>>,
    points: Vec<Range<usize>>,
    /// Rows of B, one matrix per part of the structure that they act on.
    rows: [Mat<f64>; 2],
    stiffness: Mat<f64>,
}

impl Gathered {
    fn new(
        dofs: usize,
        contacts: impl Iterator<Item = (Box<dyn FrictionLaw>, Vec<Mat<f64>>)>,
    ) -> Result<Self, Error> {
        let contacts: Vec<_> = contacts.collect();
        let total: usize = contacts.iter().map(|(law, _)| law.points()).sum();
        let mut rows = [Mat::zeros(total, dofs), Mat::zeros(total, dofs)];
        let mut stiffness = Mat::zeros(total, total);
        let (mut laws, mut points, mut first) = (Vec::new(), Vec::new(), 0);
        for (index, (law, parts)) in contacts.into_iter().enumerate() {
            let size = law.points();
            let entry = format!("contact {}", index + 1);
            for (part, rows) in parts.iter().zip(&mut rows) {
                if (part.nrows(), part.ncols()) != (size, dofs) {
                    return Err(Error::shape(
                        &entry,
                        format!("rows of shape {size} x {dofs}"),
                        format!("{} x {}", part.nrows(), part.ncols()),
                    ));
                }
                if (0..size).any(|i| (0..dofs).any(|j| !part[(i, j)].is_finite())) {
                    return Err(Error::value(entry, f64::NAN, "its rows must be finite"));
                }
                rows.get_mut(first..first + size, ..).copy_from(part);
            }
            let own = law.stiffness();
            stiffness.get_mut(first..first + size, first..first + size).copy_from(&own);
            points.push(first..first + size);
            laws.push(law);
            first += size;
        }
        Ok(Self { laws, points, rows, stiffness })
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

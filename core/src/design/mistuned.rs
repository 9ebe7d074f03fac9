//! The rings that a tuned disk becomes when the stiffness of its sectors deviates.

use crate::contact::ContactLaw;
use crate::model::{Model, SectorContact};
use crate::structure::{HarmonicLoad, RingCoupling, Structure};
use crate::Error;
use faer::Mat;

/// A tuned disk, from which rings of deviating sectors are made: sector i has the stiffness
/// `(1 + d_i) K + K_c` and the damping `C_0 + (1 + d_i) C_1 + √(1 + d_i) C_½ + C_c`.
///
/// C_1 is the part of a damping law that is proportional to the stiffness, C_½ that of given
/// damping ratios; couplings (index c) do not deviate.
#[derive(Debug)]
pub struct TunedDisk {
    /// Mass M of a sector with what couplings add \[kg\].
    pub mass: Mat<f64>,
    /// Stiffness K of a sector by itself [N/m].
    pub stiffness: Mat<f64>,
    /// What couplings add to it [N/m].
    pub coupled_stiffness: Mat<f64>,
    /// Damping that does not deviate, couplings included; that goes with the stiffness; that goes
    /// with its root [kg/s].
    pub damping: [Mat<f64>; 3],
    /// Whether a law made all of the damping, see [`Structure::with_law`].
    pub proportional: bool,
    /// What couples a sector to the next one.
    pub coupling: RingCoupling,
    /// Contacts of every sector.
    pub contacts: Vec<SectorContact>,
    /// Loads of each sector; there are as many sectors as entries.
    pub loads: Vec<Vec<HarmonicLoad>>,
}

impl TunedDisk {
    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.loads.len()
    }

    /// Degrees of freedom of a sector.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.stiffness.nrows()
    }

    /// The ring whose sectors deviate.
    ///
    /// # Errors
    /// Not one deviation per sector, one that is not above −1, or as [`Model::ring`].
    pub fn mistuned(&self, deviations: &[f64]) -> Result<Model, Error> {
        if deviations.len() != self.sectors() {
            let expected = format!("{} deviations", self.sectors());
            return Err(Error::shape("pattern", expected, format!("{}", deviations.len())));
        }
        let mut structures = Vec::with_capacity(deviations.len());
        for &deviation in deviations {
            if !(deviation > -1.0 && deviation.is_finite()) {
                return Err(Error::value("pattern", deviation, "must be a deviation above -1"));
            }
            structures.push(self.sector(1.0 + deviation)?);
        }
        let contacts = deviations.iter().map(|_| self.own_contacts()).collect();
        let RingCoupling { mass, damping, stiffness } = &self.coupling;
        let coupling = RingCoupling {
            mass: mass.clone(),
            damping: damping.clone(),
            stiffness: stiffness.clone(),
        };
        Model::ring(structures, coupling, contacts, self.loads.clone())
    }

    fn sector(&self, factor: f64) -> Result<Structure, Error> {
        let size = self.dofs();
        let stiffness = Mat::from_fn(size, size, |i, j| {
            factor * self.stiffness[(i, j)] + self.coupled_stiffness[(i, j)]
        });
        let [constant, proportional, root] = &self.damping;
        let damping = Mat::from_fn(size, size, |i, j| {
            constant[(i, j)] + factor * proportional[(i, j)] + factor.sqrt() * root[(i, j)]
        });
        let structure = Structure::new(self.mass.as_ref(), damping.as_ref(), stiffness.as_ref())?;
        Ok(structure.with_law(self.proportional))
    }

    fn own_contacts(&self) -> Vec<SectorContact> {
        self.contacts
            .iter()
            .map(|contact| {
                // The same law: no other method copies one.
                let law: Box<dyn ContactLaw> = contact.law.with_scaled_forces(1.0);
                SectorContact { law, own: contact.own.clone(), next: contact.next.clone() }
            })
            .collect()
    }
}

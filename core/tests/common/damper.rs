//! The structure-like damper between two beams (Guillen 1999, section 6.4), and random ones.

use super::{snecma_beam, System};
use faer::{c64, mat, Mat};
use stickslip_core::contact::{ContactLaw, StructuralDamper};
use stickslip_core::fourier::SampleTable;
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// DOFs of the contacts: damper and tip of either beam, of three DOFs each.
pub const DOFS: [usize; 4] = [0, 3, 1, 4];
/// Slip limits of Table 6.3 [N].
pub const LIMITS: [f64; 4] = [24.6, 100.0, 246.05, f64::INFINITY];

/// Eq. (6.26) [N/m].
pub fn stiffness() -> Mat<f64> {
    mat![
        [2.88e7, -2.4e7, 0.0, -4.8e6],
        [-2.4e7, 2.64e7, -2.4e6, 0.0],
        [0.0, -2.4e6, 2.64e6, -2.4e5],
        [-4.8e6, 0.0, -2.4e5, 5.04e6],
    ]
}

/// Two free beams, forced at their tips in opposition.
pub fn beams(force: f64) -> System {
    let beam = snecma_beam(force);
    let twice = |a: &Mat<f64>| {
        Mat::from_fn(6, 6, |i, j| if i / 3 == j / 3 { a[(i % 3, j % 3)] } else { 0.0 })
    };
    System {
        mass: twice(&beam.mass),
        damping: twice(&beam.damping),
        stiffness: twice(&beam.stiffness),
        dampers: Vec::new(),
        forces: vec![(1, 1, force, 0.0), (4, 1, force, std::f64::consts::PI)],
    }
}

/// A model of `system` with further laws, each on the DOFs `dofs`.
pub fn with_laws(system: &System, laws: Vec<(Box<dyn ContactLaw>, Vec<usize>)>) -> Model {
    let n = system.dofs();
    let structure =
        Structure::new(system.mass.as_ref(), system.damping.as_ref(), system.stiffness.as_ref())
            .unwrap();
    let contacts = laws
        .into_iter()
        .map(|(law, dofs)| Contact {
            law,
            rows: Mat::from_fn(dofs.len(), n, |i, j| f64::from(u8::from(dofs[i] == j))),
        })
        .collect();
    let mut loads: Vec<HarmonicLoad> = Vec::new();
    for &(dof, harmonic, amplitude, phase) in &system.forces {
        let at = loads.iter().position(|l| l.harmonic == harmonic).unwrap_or_else(|| {
            loads.push(HarmonicLoad { harmonic, amplitude: vec![c64::new(0.0, 0.0); n] });
            loads.len() - 1
        });
        loads[at].amplitude[dof] += c64::from_polar(amplitude, phase);
    }
    Model::new(structure, contacts, loads).unwrap()
}

/// The dissertation's system.
pub fn damped_beams(force: f64) -> Model {
    let law = StructuralDamper::new(stiffness().as_ref(), &LIMITS).unwrap();
    with_laws(&beams(force), vec![(Box::new(law), DOFS.to_vec())])
}

/// Numbers in [-1, 1] from a seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        // SplitMix64 (Steele, Lea and Flood 2014).
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        2.0 * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 1.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + 0.5 * (self.next() + 1.0) * (high - low)
    }

    /// Displacements whose harmonics fall off, about `size` large.
    pub fn series(&mut self, table: &SampleTable, points: usize, size: f64) -> Vec<f64> {
        let slots = table.harmonics().slots();
        (0..points * slots)
            .map(|i| size * self.next() / (1.0 + (i % slots) as f64 / 2.0).powi(2))
            .collect()
    }

    /// A random damper of some points: links between them, now and then to the ground, limits
    /// over two decades, some of them infinite.
    pub fn damper(&mut self, points: usize, stiffness: f64, limit: f64) -> StructuralDamper {
        let mut d = Mat::zeros(points, points);
        for i in 0..points {
            for j in 0..i {
                let k = stiffness * 10f64.powf(self.between(-1.5, 0.0));
                d[(i, i)] += k;
                d[(j, j)] += k;
                d[(i, j)] -= k;
                d[(j, i)] -= k;
            }
            if self.next() > 0.7 {
                d[(i, i)] += 0.3 * stiffness;
            }
        }
        let limits: Vec<f64> = (0..points)
            .map(|_| {
                let limit = limit * 10f64.powf(self.between(-1.0, 1.0));
                if self.next() > 0.8 {
                    f64::INFINITY
                } else {
                    limit
                }
            })
            .collect();
        StructuralDamper::new(d.as_ref(), &limits).unwrap()
    }
}

//! Where loads enter and displacements leave a structure.

use super::Matrix;
use crate::Error;
use faer::c64;

/// The load `Re P_k exp(ikωt)` on all DOFs.
#[derive(Debug, Clone)]
pub struct HarmonicLoad {
    /// Harmonic k; 0 is a static load.
    pub harmonic: usize,
    /// Complex amplitude per DOF \[N\].
    pub amplitude: Vec<c64>,
}

/// Contacts and loads of a structure.
#[derive(Debug, Clone)]
pub struct Ports {
    /// B, contacts × N: relative contact displacements are `u = B x`.
    pub rows: Matrix,
    /// Contact stiffness D of the stuck contacts, contacts × contacts [N/m].
    pub stiffness: Matrix,
    /// External loads, one entry per harmonic.
    pub loads: Vec<HarmonicLoad>,
}

impl Ports {
    pub(super) fn check(&self, dofs: usize) -> Result<(), Error> {
        if self.rows.ncols() != dofs {
            return Err(Error::shape("contact rows", format!("{dofs} columns"), self.rows.ncols()));
        }
        for (index, load) in self.loads.iter().enumerate() {
            let entry = format!("load at harmonic {}", load.harmonic);
            if load.amplitude.len() != dofs {
                return Err(Error::shape(&entry, format!("{dofs} entries"), load.amplitude.len()));
            }
            if load.amplitude.iter().any(|p| !p.re.is_finite() || !p.im.is_finite()) {
                return Err(Error::value(entry, f64::NAN, "every entry must be finite"));
            }
            if self.loads[..index].iter().any(|l| l.harmonic == load.harmonic) {
                return Err(Error::value(
                    entry,
                    load.harmonic as f64,
                    "give one load per harmonic",
                ));
            }
        }
        Ok(())
    }

    pub(super) fn load(&self, harmonic: usize) -> Option<&[c64]> {
        self.loads
            .iter()
            .find(|load| load.harmonic == harmonic)
            .map(|load| load.amplitude.as_slice())
    }
}

/// Harmonics with a load that is not zero, ascending.
pub(super) fn forced_harmonics(loads: &[HarmonicLoad]) -> Vec<usize> {
    let mut harmonics: Vec<usize> = loads
        .iter()
        .filter(|load| load.amplitude.iter().any(|p| p.norm() > 0.0))
        .map(|load| load.harmonic)
        .collect();
    harmonics.sort_unstable();
    harmonics
}

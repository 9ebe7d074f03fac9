//! How the structure of a model is given.

use crate::structure::{
    compliance, Compliance, CyclicCompliance, CyclicPorts, CyclicStructure, Ports, Ring, Structure,
};
use crate::Error;
use faer::Mat;
use std::sync::Arc;

/// How the structure of a model is given.
#[derive(Clone)]
pub(super) enum Body {
    /// By its matrices.
    Whole,
    /// As one sector of a disk in a travelling wave, with the rows of B on the next sector.
    Wave { cyclic: Arc<CyclicStructure>, next: Arc<Mat<f64>> },
    /// As a ring of sectors that may differ.
    Ring(Arc<Ring>),
}

impl Body {
    /// The compliance of the body with contacts of the stiffness in `ports`, and its name.
    pub(super) fn compliance(
        &self,
        structure: &Structure,
        ports: &Ports,
    ) -> Result<(Arc<dyn Compliance>, &'static str), Error> {
        match self {
            Self::Whole => {
                let (compliance, name) = compliance(structure, ports)?;
                Ok((compliance.into(), name))
            }
            Self::Wave { cyclic, next } => {
                let ports = CyclicPorts {
                    own: Mat::clone(&ports.rows),
                    next: Mat::clone(next),
                    stiffness: Mat::clone(&ports.stiffness),
                    loads: ports.loads.clone(),
                };
                Ok((
                    Arc::new(CyclicCompliance::new(CyclicStructure::clone(cyclic), ports)?),
                    "waves",
                ))
            }
            Self::Ring(ring) => Ok((Arc::new(ring.with_ports(ports)?), "sectors")),
        }
    }
}

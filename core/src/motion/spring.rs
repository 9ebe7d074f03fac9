//! Laws without memory as elements of a motion that is sampled: their force is that of the displacement.

use crate::contact::{ContactLaw, PointState, SlipElement};
use faer::Mat;

/// A law without memory.
#[derive(Debug)]
pub(super) struct Spring {
    pub(super) law: Box<dyn ContactLaw>,
    /// What its forces are measured by where motions are compared [N/m].
    pub(super) unit: f64,
}

impl SlipElement for Spring {
    fn stiffness(&self) -> Mat<f64> {
        let size = self.law.displacements();
        Mat::from_fn(size, size, |i, j| if i == j { self.unit } else { 0.0 })
    }

    fn limits(&self) -> Vec<f64> {
        self.law.limits()
    }

    fn tangent(&self, _points: &[PointState]) -> Mat<f64> {
        self.stiffness()
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        Mat::zeros(points.len(), points.len())
    }

    fn increment(&self, _du: &[f64], _force: &mut [f64], gain: Option<&mut [f64]>) {
        let size = self.law.displacements();
        if let Some(gain) = gain {
            gain.fill(0.0);
            gain.iter_mut().step_by(size + 1).for_each(|gain| *gain = 1.0);
        }
    }

    fn carry(&self, from: &[f64], du: &[f64], force: &mut [f64]) {
        let to: Vec<f64> = from.iter().zip(du).map(|(u, du)| u + du).collect();
        self.law.return_map(from, &to, &mut [], force, None);
    }
}

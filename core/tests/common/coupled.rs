//! A law of two points that couple.

use faer::{mat, Mat};
use stickslip_core::contact::{FrictionLaw, Jenkins, Motion, PointState, PointSummary, SlipLoad};

/// Stiffness of the first element [N/m].
pub const STIFFNESS: f64 = 2.0;
/// Slip force of the first element [N].
pub const SLIP_FORCE: f64 = 1.0;

/// Two elements in other coordinates, v = T u: a law of two points that couple.
#[derive(Debug)]
pub struct Coupled {
    pub transform: Mat<f64>,
    pub elements: [Jenkins; 2],
}

impl Coupled {
    pub fn new() -> Self {
        let element = |k, f| Jenkins::new(k, f).unwrap();
        Self {
            transform: mat![[1.0, -0.6], [0.3, 0.9]],
            elements: [element(STIFFNESS, SLIP_FORCE), element(1.3, 0.7)],
        }
    }

    fn inverse(&self) -> Mat<f64> {
        use faer::linalg::solvers::DenseSolveCore as _;
        self.transform.partial_piv_lu().inverse()
    }
}

impl FrictionLaw for Coupled {
    fn points(&self) -> usize {
        2
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn stiffness(&self) -> Mat<f64> {
        let own = mat![[STIFFNESS, 0.0], [0.0, 1.3]];
        self.transform.transpose() * own * &self.transform
    }

    fn softened(&self, _: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self::new())
    }

    fn magnified(&self, _: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self::new())
    }

    fn slip_load(&self, _: Motion<'_>, _: bool, _: &mut SlipLoad) {}

    fn advance(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>) {
        let (t, inverse) = (&self.transform, self.inverse());
        let mut own = [0.0; 2];
        let mut sticks = [0.0; 2];
        for i in 0..2 {
            let dv = t[(i, 0)] * du[0] + t[(i, 1)] * du[1];
            let mut g = [inverse[(0, i)] * force[0] + inverse[(1, i)] * force[1]];
            self.elements[i].advance(&[dv], &mut g, Some(&mut sticks[i..=i]));
            own[i] = g[0];
        }
        for i in 0..2 {
            force[i] = t[(0, i)] * own[0] + t[(1, i)] * own[1];
        }
        if let Some(gain) = gain {
            if sticks == [1.0; 2] {
                // Rounding must not look like slip.
                gain.copy_from_slice(&[1.0, 0.0, 0.0, 1.0]);
                return;
            }
            for i in 0..2 {
                for j in 0..2 {
                    gain[2 * i + j] = (0..2).map(|l| t[(l, i)] * sticks[l] * inverse[(j, l)]).sum();
                }
            }
        }
    }

    fn limits(&self) -> Vec<f64> {
        vec![f64::INFINITY; 2]
    }

    fn tangent(&self, _: &[PointState]) -> Mat<f64> {
        self.stiffness()
    }

    fn slip_rate(&self, _: &[PointState]) -> Mat<f64> {
        Mat::zeros(2, 2)
    }

    fn summary(&self, _: Motion<'_>, _: &mut [PointSummary]) {}

    fn force_history(&self, _: Motion<'_>, _: usize) -> Vec<f64> {
        Vec::new()
    }
}

//! A law of two displacements that couple, which has a return map and nothing else.

use faer::{mat, Mat};
use stickslip_core::contact::{ContactLaw, ReturnMapJacobian, Slider, SlipElement as _};

/// Stiffness of the first element [N/m].
pub const STIFFNESS: f64 = 2.0;
/// Slip force of the first element [N].
pub const SLIP_FORCE: f64 = 1.0;

/// Two elements in other coordinates, v = T u: they remember their own forces, `f = Tᵀ z`.
#[derive(Debug)]
pub struct Coupled {
    pub transform: Mat<f64>,
    pub elements: [Slider; 2],
}

impl Coupled {
    pub fn new() -> Self {
        let element = |k, f| Slider::new(k, f).unwrap();
        Self {
            transform: mat![[1.0, -0.6], [0.3, 0.9]],
            elements: [element(STIFFNESS, SLIP_FORCE), element(1.3, 0.7)],
        }
    }
}

impl ContactLaw for Coupled {
    fn name(&self) -> &'static str {
        "coupled"
    }

    fn displacements(&self) -> usize {
        2
    }

    fn state_size(&self) -> usize {
        2
    }

    fn stiffness(&self) -> Mat<f64> {
        self.transform.transpose() * self.state_stiffness()
    }

    fn state_stiffness(&self) -> Mat<f64> {
        Mat::from_fn(2, 2, |i, j| self.elements[i].stiffness * self.transform[(i, j)])
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        vec![f64::INFINITY; 2]
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let t = &self.transform;
        let mut sticks = [0.0; 2];
        for i in 0..2 {
            let dv = (0..2).map(|j| t[(i, j)] * (after[j] - before[j])).sum();
            self.elements[i].increment(&[0.0], &[dv], &mut state[i..=i], Some(&mut sticks[i..=i]));
        }
        for i in 0..2 {
            force[i] = t[(0, i)] * state[0] + t[(1, i)] * state[1];
        }
        let Some(jacobian) = jacobian else { return };
        jacobian.reset(2, 2);
        let stiffness = self.state_stiffness();
        for i in 0..2 {
            jacobian.by_state[2 * i + i] = sticks[i];
            for j in 0..2 {
                jacobian.by_after[2 * i + j] = sticks[i] * stiffness[(i, j)];
                jacobian.by_before[2 * i + j] = -sticks[i] * stiffness[(i, j)];
                jacobian.force_by_state[2 * i + j] = t[(j, i)];
            }
            jacobian.slipping[i] = 1.0 - sticks[i];
        }
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        let mut scaled = Self::new();
        scaled.elements.iter_mut().for_each(|element| element.stiffness *= share);
        Box::new(scaled)
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let mut scaled = Self::new();
        scaled.elements.iter_mut().for_each(|element| element.slip_force *= factor);
        Box::new(scaled)
    }
}

//! What bounds the contact forces of a motion: slip limits, constant or under a normal force, and
//! normal forces, which cannot pull.

use super::modal_system::{dot, ContactState, ModalSystem};
use crate::contact::Bound;

impl ModalSystem {
    /// Slip limit of a point under these forces, none where it is open \[N\].
    pub(super) fn limit(&self, point: usize, force: &[f64]) -> f64 {
        match self.bounds[point] {
            Bound::Friction { friction, normal } => friction * self.normal_force(normal, force),
            _ => self.limits[point],
        }
    }

    /// N of a point that is bounded on one side.
    fn normal_force(&self, point: usize, force: &[f64]) -> f64 {
        (force[point] + self.balanced(point)).max(0.0)
    }

    /// What of N the structure does not feel \[N\].
    pub(super) fn balanced(&self, point: usize) -> f64 {
        match self.bounds[point] {
            Bound::Unilateral { balanced, .. } => balanced,
            _ => 0.0,
        }
    }

    /// `N₀ + k u` of a point that is bounded on one side: negative while it is open \[N\].
    pub(super) fn pressing(&self, point: usize, modal: &[f64]) -> f64 {
        match self.bounds[point] {
            Bound::Unilateral { at_rest, stiffness, .. } => {
                at_rest + stiffness * dot(self.contact_shape(point), modal)
            }
            _ => 0.0,
        }
    }

    /// Keeps forces within their bounds.
    pub(super) fn confine(&self, force: &mut [f64]) {
        for point in 0..force.len() {
            if let Bound::Unilateral { balanced, .. } = self.bounds[point] {
                force[point] = force[point].max(-balanced);
            } else {
                let limit = self.limit(point, force);
                force[point] = force[point].clamp(-limit, limit);
            }
        }
    }

    /// Whether the displacement of a point has anything to do with forces.
    pub(super) fn is_felt(&self, point: usize) -> bool {
        let bound = self.bounds[point];
        !matches!(bound, Bound::Unilateral { stiffness, .. } if stiffness == 0.0)
    }

    /// Whether slip limits vary, or contacts may open.
    pub(crate) fn has_normals(&self) -> bool {
        !self.normals.is_empty()
    }

    /// Derivative of the slip limit of a point in the modal displacements while it is closed; empty
    /// if it is constant.
    pub(crate) fn limit_slope(&self, point: usize) -> Vec<f64> {
        let Bound::Friction { friction, normal } = self.bounds[point] else { return Vec::new() };
        let slope = friction * self.normal_stiffness(normal);
        self.contact_shape(normal).iter().map(|b| slope * b).collect()
    }

    /// Slip limit of a point without any displacement while it is closed \[N\].
    pub(crate) fn limit_at_rest(&self, point: usize) -> f64 {
        match self.bounds[point] {
            Bound::Friction { friction, normal } => match self.bounds[normal] {
                Bound::Unilateral { at_rest, .. } => friction * at_rest,
                _ => 0.0,
            },
            _ => self.limits[point],
        }
    }

    /// k_n of a point that is bounded on one side [N/m].
    pub(super) fn normal_stiffness(&self, point: usize) -> f64 {
        match self.bounds[point] {
            Bound::Unilateral { stiffness, .. } => stiffness,
            _ => 0.0,
        }
    }

    /// Rates of the force of a point and of its slip limit in given states [N/s].
    pub(super) fn loading(&self, regime: &ContactState, point: usize, speed: &[f64]) -> [f64; 2] {
        let rate = |i: usize| -> f64 {
            speed.iter().enumerate().map(|(j, v)| regime.tangent[(i, j)] * v).sum()
        };
        match self.bounds[point] {
            Bound::Friction { friction, normal } => [rate(point), friction * rate(normal)],
            _ => [rate(point), 0.0],
        }
    }

    /// Points whose slip limit follows the force of a point.
    pub(super) fn pressed_by(&self, point: usize) -> impl Iterator<Item = usize> + '_ {
        let pressed = move |bound: &Bound| match *bound {
            Bound::Friction { normal, .. } => normal == point,
            _ => false,
        };
        (0..self.points()).filter(move |i| pressed(&self.bounds[*i]))
    }
}

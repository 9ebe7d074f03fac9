//! What bounds the contact forces of a motion: slip limits, constant or under a normal force, and
//! normal forces, which cannot pull.

use super::contact_state::ContactState;
use super::modal_system::{dot, ModalSystem};
use crate::contact::{Bound, PointState, SlipPlane};
use std::ops::Range;

/// Modes up to which a pass along a motion is as cheap as a way beside one.
const FEW: usize = 8;

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
        for (bound, force) in self.bounds.iter().zip(&mut *force) {
            if let Bound::Unilateral { balanced, .. } = bound {
                *force = force.max(-balanced);
            }
        }
        for point in 0..force.len() {
            if !matches!(self.bounds[point], Bound::Unilateral { .. }) {
                let limit = self.limit(point, force);
                force[point] = force[point].clamp(-limit, limit);
            }
        }
        for plane in &self.planes {
            let limit = self.limit(plane.points[0], force);
            if self.traction(plane, force) > limit {
                self.lengthen(plane, force);
            }
        }
    }

    /// The pairs of points that slip in a plane.
    pub(crate) fn planes(&self) -> &[SlipPlane] {
        &self.planes
    }

    /// The plane in which a point slips, if it does so in one.
    pub(super) fn plane_of(&self, point: usize) -> Option<&SlipPlane> {
        self.planes.iter().find(|plane| plane.points.contains(&point))
    }

    /// Length of the traction in a plane \[N\].
    pub(super) fn traction(&self, plane: &SlipPlane, force: &[f64]) -> f64 {
        force[plane.points[0]].hypot(force[plane.points[1]])
    }

    /// Gives the traction in a plane the length of its limit.
    pub(super) fn lengthen(&self, plane: &SlipPlane, force: &mut [f64]) {
        let length = self.traction(plane, force);
        let limit = self.limit(plane.points[0], force);
        for point in plane.points.into_iter().filter(|_| length > 0.0) {
            force[point] *= limit / length;
        }
    }

    /// What the slip rate of a contact that slides, `λ/k_t`, is made of: traction over its length and
    /// the rate λ \[N/s\] at which the stuck contact would leave its limit.
    pub(crate) fn pull(&self, plane: &SlipPlane, force: &[f64], speed: &[f64]) -> ([f64; 2], f64) {
        let length = self.traction(plane, force);
        let along = plane.points.map(|i| if length > 0.0 { force[i] / length } else { speed[i] });
        let size = along[0].hypot(along[1]).max(f64::MIN_POSITIVE);
        let along = along.map(|e| e / size);
        let [u, v] = plane.points.map(|i| speed[i]);
        let growth = match self.bounds[plane.points[0]] {
            Bound::Friction { friction, normal } => {
                friction * self.normal_stiffness(normal) * speed[normal]
            }
            _ => 0.0,
        };
        (along, plane.stiffness * (along[0] * u + along[1] * v) - growth)
    }

    /// Rates of all forces in given states [N/s].
    pub(super) fn force_rates(
        &self,
        regime: &ContactState,
        force: &[f64],
        speed: &[f64],
    ) -> Vec<f64> {
        let mut rates: Vec<f64> =
            (0..speed.len()).map(|i| regime.tangent.times(i, speed)).collect();
        let slides = |plane: &&SlipPlane| regime.points[plane.points[0]] == PointState::Sliding;
        for plane in self.planes.iter().filter(slides) {
            let (along, pull) = self.pull(plane, force, speed);
            for (i, e) in plane.points.into_iter().zip(along) {
                rates[i] = plane.stiffness * speed[i] - pull * e;
            }
        }
        rates
    }

    /// What the rounding of a normal force counts against.
    pub(super) fn normal_size(&self, point: usize, modal: &[f64]) -> f64 {
        let Bound::Unilateral { at_rest, stiffness, .. } = self.bounds[point] else { return 0.0 };
        let parts = self.contact_shape(point).iter().zip(modal).map(|(b, x)| (b * x).abs());
        at_rest.abs() + stiffness * parts.sum::<f64>()
    }

    /// What the rounding of a slip limit counts against.
    pub(super) fn limit_size(&self, point: usize, modal: &[f64]) -> f64 {
        match self.bounds[point] {
            Bound::Friction { friction, normal } => friction * self.normal_size(normal, modal),
            _ => self.limits[point],
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

    /// Whether a motion can be followed beside another one: all contacts are single springs under constant limits,
    /// and modes so many that the way is worth it.
    pub(crate) fn is_followed_beside(&self) -> bool {
        let single = self.bodies().iter().all(|body| body.points.len() == 1);
        let constant = |bound: &Bound| matches!(bound, Bound::Constant(_));
        self.modes() > FEW && single && self.bounds.iter().all(constant)
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
        let rate = |i: usize| regime.tangent.times(i, speed);
        match self.bounds[point] {
            Bound::Friction { friction, normal } => [rate(point), friction * rate(normal)],
            _ => [rate(point), 0.0],
        }
    }

    /// The points of the element that a point belongs to.
    pub(crate) fn together_with(&self, point: usize) -> Range<usize> {
        let bodies = self.bodies();
        let own = bodies.partition_point(|body| body.points.end <= point);
        bodies.get(own).map_or(0..0, |body| body.points.clone())
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

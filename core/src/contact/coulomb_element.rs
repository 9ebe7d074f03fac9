//! The planar Coulomb contact between two events.
//!
//! | | traction | normal force |
//! |---|---|---|
//! | sticks | `t' = k_t u'` | `N = N₀ + k_n v` |
//! | slips forward, backward | `t = ±μN` | `N = N₀ + k_n v` |
//! | is open | `t = 0` | `N = 0` |
//!
//! All of it is linear in u and v. What slips moves with `w' = u' − t'/k_t`, in the direction of t:
//! where that vanishes the contact sticks again (Yang, Chu and Menq 1998).

use super::law::{Bound, SlipElement};
use super::{ContactLaw, Coulomb, PointState};
use faer::Mat;

impl Coulomb {
    /// k_n, 0 without a normal displacement [N/m].
    fn normal(&self) -> f64 {
        self.normal_stiffness.unwrap_or(0.0)
    }

    /// Whether there is never any friction.
    fn is_smooth(&self) -> bool {
        self.friction * self.tangential_stiffness == 0.0
            || (self.is_odd() && self.normal_at_rest() <= 0.0)
    }
}

impl SlipElement for Coulomb {
    fn stiffness(&self) -> Mat<f64> {
        ContactLaw::stiffness(self)
    }

    fn limits(&self) -> Vec<f64> {
        let limit = match (self.is_smooth(), self.is_odd()) {
            (true, _) => 0.0,
            (_, true) => self.friction * self.normal_at_rest(),
            _ => f64::MAX,
        };
        let mut limits = vec![f64::INFINITY; self.displacements()];
        limits[0] = limit;
        limits
    }

    fn bounds(&self) -> Vec<Bound> {
        let limit = SlipElement::limits(self)[0];
        let friction = match limit == f64::MAX {
            true => Bound::Friction { friction: self.friction, normal: 1 },
            false => Bound::Constant(limit),
        };
        let normal = Bound::Unilateral {
            at_rest: self.normal_at_rest(),
            stiffness: self.normal(),
            balanced: self.balanced(),
        };
        [friction, normal].into_iter().take(self.displacements()).collect()
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let size = self.displacements();
        let sticks = points[0] == PointState::Stuck && !self.is_smooth();
        let open = points.get(1) == Some(&PointState::Open);
        Mat::from_fn(size, size, |i, j| match (i, j) {
            (0, 0) if sticks => self.tangential_stiffness,
            (0, 1) => points[0].sign() * self.friction * self.normal(),
            (1, 1) if !open => self.normal(),
            _ => 0.0,
        })
    }

    fn slider_at_rest(&self) -> f64 {
        self.slider()[0]
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        let (size, sign) = (self.displacements(), points[0].sign());
        let by_normal = self.friction * self.normal() / self.tangential_stiffness;
        Mat::from_fn(size, size, |i, j| match (i, j) {
            _ if sign == 0.0 => 0.0,
            (0, 0) => 1.0,
            (0, 1) => -sign * by_normal,
            _ => 0.0,
        })
    }

    fn increment(
        &self,
        before: &[f64],
        after: &[f64],
        force: &mut [f64],
        gain: Option<&mut [f64]>,
    ) {
        let most = self.friction * self.pressing(before).max(0.0);
        let mut traction = [force[0].clamp(-most, most)];
        let trial = force[0] + self.tangential_stiffness * (after[0] - before[0]);
        self.return_map(before, after, &mut traction, force, None);
        if let Some(gain) = gain {
            gain.fill(0.0);
            let most = self.friction * self.pressing(after).max(0.0);
            gain[0] = f64::from(u8::from(most > 0.0 && trial.abs() <= most));
        }
    }
}

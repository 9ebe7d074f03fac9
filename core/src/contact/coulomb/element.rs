//! The Coulomb contact between two events.
//!
//! | | traction | normal force |
//! |---|---|---|
//! | sticks | `t' = k_t u'` | `N = N₀ + k_n v` |
//! | slips forward, backward | `t = ±μN` | `N = N₀ + k_n v` |
//! | slides in a plane | `t = μN e(φ)`, `μN φ' = k_t u'·e⊥` | `N = N₀ + k_n v` |
//! | is open | `t = 0` | `N = 0` |
//!
//! All of it but the turning of the traction in a plane is linear in u and v. What slips moves with
//! `w' = u' − t'/k_t`, in the direction of t: where that vanishes the contact sticks again (Yang, Chu and
//! Menq 1998).

use crate::contact::slip_element::{Bound, SlipElement, SlipPlane};
use crate::contact::{ContactLaw, Coulomb, Held, Motion, PointState, Residual};
use crate::fourier::SampleTable;
use faer::Mat;

impl Coulomb {
    /// k_n, 0 without a normal displacement [N/m].
    fn normal(&self) -> f64 {
        self.normal_stiffness.unwrap_or(0.0)
    }

    /// Whether there is never any friction.
    pub(super) fn is_smooth(&self) -> bool {
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
        limits[..self.directions].fill(limit);
        limits
    }

    fn bounds(&self) -> Vec<Bound> {
        let limit = SlipElement::limits(self)[0];
        let friction = match limit == f64::MAX {
            true => Bound::Friction { friction: self.friction, normal: self.directions },
            false => Bound::Constant(limit),
        };
        let normal = Bound::Unilateral {
            at_rest: self.normal_at_rest(),
            stiffness: self.normal(),
            balanced: self.balanced(),
        };
        let tangential = std::iter::repeat_n(friction, self.directions);
        tangential.chain([normal]).take(self.displacements()).collect()
    }

    fn planes(&self) -> Vec<SlipPlane> {
        let slides = self.directions == 2 && !self.is_smooth();
        let plane = SlipPlane { points: [0, 1], stiffness: self.tangential_stiffness };
        slides.then_some(plane).into_iter().collect()
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let (size, normal) = (self.displacements(), self.directions);
        let sticks = points[0] == PointState::Stuck && !self.is_smooth();
        let open = points.get(normal) == Some(&PointState::Open);
        Mat::from_fn(size, size, |i, j| match (i == j, i < normal) {
            (true, true) if sticks => self.tangential_stiffness,
            (true, false) if !open => self.normal(),
            (false, true) if j == normal => points[i].sign() * self.friction * self.normal(),
            _ => 0.0,
        })
    }

    fn slider_at_rest(&self) -> [f64; 2] {
        self.slider()
    }

    fn held(
        &self,
        table: &SampleTable,
        displacement: &[f64],
        residual: Residual,
    ) -> Vec<Option<Held>> {
        self.held_sliders(Motion { table, displacement, residual })
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        let (size, sign) = (self.displacements(), points[0].sign());
        let by_normal = self.friction * self.normal() / self.tangential_stiffness;
        Mat::from_fn(size, size, |i, j| match (i, j) {
            _ if sign == 0.0 || self.directions == 2 => 0.0,
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
        let (size, directions) = (self.displacements(), self.directions);
        let mut traction = [0.0; 2];
        traction[..directions].copy_from_slice(&force[..directions]);
        let trial: [f64; 2] = std::array::from_fn(|i| {
            let du = if i < directions { after[i] - before[i] } else { 0.0 };
            traction[i] + self.tangential_stiffness * du
        });
        let most = self.friction * self.pressing(before).max(0.0);
        let length = traction[0].hypot(traction[1]);
        if length > most {
            traction =
                traction
                    .map(|t| if directions == 1 { most.copysign(t) } else { t * most / length });
        }
        self.return_map(before, after, &mut traction[..directions], force, None);
        if let Some(gain) = gain {
            gain.fill(0.0);
            let most = self.friction * self.pressing(after).max(0.0);
            let length = trial[0].hypot(trial[1]);
            for i in 0..directions {
                for j in 0..directions {
                    let unit = f64::from(u8::from(i == j));
                    gain[i * size + j] = match (most > 0.0, length <= most) {
                        (false, _) => 0.0,
                        (_, true) => unit,
                        (_, false) if directions == 1 => 0.0,
                        // The traction keeps its direction: what is beyond the circle is taken off.
                        _ => most / length * (unit - trial[i] * trial[j] / (length * length)),
                    };
                }
            }
        }
    }
}

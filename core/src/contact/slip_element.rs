//! What the equations of motion see of a law whose force is linear between events: its points, their limits
//! and how they move on.

use super::point_state::PointState;
use super::residual::{Held, Residual};
use crate::fourier::SampleTable;
use faer::Mat;
use std::sync::Arc;

/// A part of a law that exact motions follow from event to event.
#[derive(Debug, Clone)]
pub struct Element {
    /// Components of the law's relative displacement that it acts on.
    pub components: Vec<usize>,
    /// What it does.
    pub law: Arc<dyn SlipElement>,
}

/// What bounds the force of a point of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// A slip limit that does not change: `|f| ≤ F`. The force is remembered.
    Constant(f64),
    /// Friction under a normal force: `|f| ≤ μN`, and `f = 0` while it is open. The force is
    /// remembered.
    Friction {
        /// μ.
        friction: f64,
        /// The point of the element whose force presses.
        normal: usize,
    },
    /// A normal force `N = N₀ + k u ≥ 0`, of which the structure feels `f = N − balanced`. The
    /// displacement alone determines it, and whether the contact is open.
    Unilateral {
        /// N₀ \[N\].
        at_rest: f64,
        /// k [N/m].
        stiffness: f64,
        /// What of N the structure does not feel \[N\].
        balanced: f64,
    },
    /// A force that follows from the displacement and the reversals before, and stays within a limit.
    Backbone(f64),
}

/// Two points of an element whose forces are one traction: the length of the vector is bounded by the
/// limit that both points have, and what slips moves along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipPlane {
    /// The points, in directions across each other.
    pub points: [usize; 2],
    /// Stiffness against each other while they stick, the same in all directions [N/m].
    pub stiffness: f64,
}

/// An element that is linear between events: each of its points sticks, or slips at its limit, or is
/// open. Forces that are bounded by slip are its state. Slip in a plane alone is not linear: there the
/// traction turns, as the slip equation says.
pub trait SlipElement: Send + Sync + std::fmt::Debug {
    /// Stiffness of the stuck element, points × points [N/m].
    fn stiffness(&self) -> Mat<f64>;

    /// Slip limit of every point \[N\]: 0 if it never carries a force, infinite if it never slips;
    /// of a limit that varies the largest number.
    fn limits(&self) -> Vec<f64>;

    /// What bounds the force of every point: constant limits, unless an element has others.
    fn bounds(&self) -> Vec<Bound> {
        self.limits().into_iter().map(Bound::Constant).collect()
    }

    /// Pairs of points that slip in a plane.
    fn planes(&self) -> Vec<SlipPlane> {
        Vec::new()
    }

    /// `∂f/∂u` while the points are in these states, points × points [N/m]; rows of points that slip in a
    /// plane are zero.
    fn tangent(&self, points: &[PointState]) -> Mat<f64>;

    /// Displacements at which the forces of its first points vanish, where it has not slipped since the
    /// static loads were raised \[m\].
    fn slider_at_rest(&self) -> [f64; 2] {
        [0.0; 2]
    }

    /// The sliders that a periodic motion of given coefficients leaves where they are, as a contact law tells
    /// them. It is asked of elements that slip in a plane.
    fn held(
        &self,
        _table: &SampleTable,
        _displacement: &[f64],
        _residual: Residual,
    ) -> Vec<Option<Held>> {
        Vec::new()
    }

    /// Slip per relative displacement, `s' = R u'`, while the points are in these states,
    /// points × points; rows of points that do not slip are zero.
    fn slip_rate(&self, points: &[PointState]) -> Mat<f64>;

    /// Takes the forces through a straight change of the displacements. `gain`, if asked for, is the
    /// derivative of the new forces in the trial forces `f + D Δu`, points × points, row by row.
    fn increment(&self, before: &[f64], after: &[f64], force: &mut [f64], gain: Option<&mut [f64]>);

    /// [`SlipElement::increment`] of an element that remembers something else than its forces.
    fn march(&self, before: &[f64], after: &[f64], _memory: &mut [f64], force: &mut [f64]) {
        self.increment(before, after, force, None);
    }
}

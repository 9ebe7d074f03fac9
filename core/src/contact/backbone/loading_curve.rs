//! First loading of a Masing law, with units: the backbone between a stiffness and a slip force.

use super::curve::Backbone;
use super::loss::Loss;
use crate::fourier::Lanes;
use std::sync::Arc;

/// Reversals that a state tells of a contact without sliders, behind its origin.
pub(crate) const REVERSALS: usize = 12;

/// Most steps to where it has a force.
const WAYS: usize = 60;
/// Share of the stiffness at which next to nothing is left of it.
const EXHAUSTED: f64 = 1e-9;

/// The force of first loading, and what slip takes off the elastic one.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadingCurve {
    /// k [N/m].
    pub(crate) stiffness: f64,
    /// S \[N\].
    pub(crate) slip_force: f64,
    pub(crate) backbone: Arc<Backbone>,
}

impl LoadingCurve {
    /// Displacement without units; infinite without slip force.
    pub(crate) fn x(&self, u: f64) -> f64 {
        self.stiffness * u / self.slip_force
    }

    /// What slip takes off the elastic force at first loading to u >= 0: its integral \[J\], its value
    /// \[N\] and its slope [N/m].
    pub(crate) fn loss(&self, u: f64) -> Loss {
        let (k, s) = (self.stiffness, self.slip_force);
        if k == 0.0 || s == f64::INFINITY {
            return Loss::default();
        }
        if s == 0.0 {
            return Loss { integral: 0.5 * k * u * u, value: k * u, slope: k };
        }
        let own = self.backbone.loss(self.x(u));
        Loss { integral: s / k * s * own.integral, value: s * own.value, slope: k * own.slope }
    }

    /// Value \[N\] and slope [N/m] of the loss at many displacements.
    pub(crate) fn losses(&self, u: &Lanes) -> [Lanes; 2] {
        let (k, s) = (self.stiffness, self.slip_force);
        if k == 0.0 || s == 0.0 || s == f64::INFINITY {
            return [u.map(|u| self.loss(u).value), u.map(|u| self.loss(u).slope)];
        }
        let [value, slope] = self.backbone.losses(&u.map(|u| self.x(u)));
        [value.map(|own| s * own), slope.map(|own| k * own)]
    }

    /// Stiffness at rest [N/m].
    pub(crate) fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Force that is never exceeded \[N\].
    pub(crate) fn limit(&self) -> f64 {
        if self.stiffness == 0.0 {
            0.0
        } else {
            self.slip_force
        }
    }

    /// [`Self::loss`] and its slope by the formula that holds behind so many breaks, wherever u lies.
    pub(crate) fn loss_on(&self, piece: usize, u: f64) -> [f64; 2] {
        if let Some([at_rest, slope]) = self.line(piece) {
            return [at_rest + slope * u, slope];
        }
        let own = self.backbone.loss_on(piece, self.x(u));
        [self.slip_force * own.value, self.stiffness * own.slope]
    }

    /// Value at no displacement \[N\] and slope [N/m] of the loss behind so many breaks, if it is a straight
    /// line there.
    pub(crate) fn line(&self, piece: usize) -> Option<[f64; 2]> {
        let (k, s) = (self.stiffness, self.slip_force);
        if k == 0.0 || s == f64::INFINITY {
            return Some([0.0, 0.0]);
        }
        if s == 0.0 {
            return Some([0.0, k]);
        }
        self.backbone.line(piece).map(|[value, slope]| [s * value, k * slope])
    }

    /// Displacements where the backbone is not analytic \[m\].
    pub(crate) fn breaks(&self) -> Vec<f64> {
        let unit = self.slip_force / self.stiffness;
        if unit > 0.0 && unit.is_finite() {
            self.backbone.breaks().iter().map(|x| x * unit).collect()
        } else {
            Vec::new()
        }
    }

    /// How far beyond a displacement u >= 0 first loading leads to a force greater by `more` \[N\], or next
    /// to all that it ever gives, and the derivative of that way in u.
    pub(crate) fn way_to(&self, u: f64, more: f64) -> [f64; 2] {
        let force = |u: f64| self.stiffness * u - self.loss(u).value;
        let slope = |u: f64| self.stiffness - self.loss(u).slope;
        let wanted = force(u) + more;
        if let Some(exhausted) = self.exhausted().filter(|at| force(*at) <= wanted) {
            return if exhausted > u { [exhausted - u, -1.0] } else { [0.0, 0.0] };
        }
        let mut at = u;
        // The curve is concave: each step falls short of what is left.
        for _ in 0..WAYS {
            let by = ((wanted - force(at)) / slope(at)).max(0.0);
            at += by;
            if by <= f64::EPSILON * at {
                break;
            }
        }
        [at - u, slope(u) / slope(at) - 1.0]
    }

    /// Displacement at which next to nothing is left of the stiffness, if there is one.
    fn exhausted(&self) -> Option<f64> {
        let left = |u: f64| self.stiffness - self.loss(u).slope > EXHAUSTED * self.stiffness;
        let unit = self.slip_force / self.stiffness;
        let beyond = (0..WAYS as i32).map(|n| unit * 2.0_f64.powi(n)).find(|u| !left(*u))?;
        let mut range = [0.0, beyond];
        for _ in 0..WAYS {
            let middle = 0.5 * (range[0] + range[1]);
            range[usize::from(!left(middle))] = middle;
        }
        Some(range[1])
    }

    /// Work of a closed loop \[J\]: `8 ∫ F du − 4 a F(a)` with half its range a.
    pub(crate) fn work(&self, half_range: f64) -> f64 {
        let loss = self.loss(half_range);
        4.0 * half_range * loss.value - 8.0 * loss.integral
    }

    /// Derivative of the backbone in a parameter, at u >= 0.
    pub(crate) fn by_parameter(&self, index: usize, u: f64) -> f64 {
        let (k, s) = (self.stiffness, self.slip_force);
        if s == 0.0 || s == f64::INFINITY {
            // Without slip force only that acts, without limit only the stiffness.
            let acts = if s == 0.0 { index == 1 && k * u > 0.0 } else { index == 0 };
            let slope = if index == 0 { u } else { 1.0 };
            return if acts { slope } else { 0.0 };
        }
        let x = self.x(u);
        let loss = self.backbone.loss(x);
        match index {
            0 => u * (1.0 - loss.slope),
            1 => x * loss.slope - loss.value,
            _ => s * self.backbone.by_number(index - 2, x),
        }
    }
}
